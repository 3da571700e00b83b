//! OFF as the free format that it is: records over several lines, several records on a line.

use meshweft::files::{Edit, Format};
use meshweft::{FaceOrder, Permutation, VertexOrder};

use super::{check, entry_of, open, round_trip, written};
use crate::random::Random;

const POINTS: [[u32; 3]; 5] = [[0, 0, 7], [1, 0, 7], [1, 1, 7], [0, 1, 7], [5, 5, 7]];
const FACES: [&[u32]; 5] = [
    &[0, 1, 2],
    &[2, 3, 0],
    &[0, 1, 2, 3],
    &[4, 3, 2],
    &[1, 4, 2],
];

/// The file, with what `between` gives before each number: whether it starts a vertex, a face.
fn text(head: &str, mut between: impl FnMut(bool, bool) -> &'static str) -> String {
    let mut text = format!("{head}{} {} 0", POINTS.len(), FACES.len());
    for point in POINTS {
        for (i, number) in point.iter().enumerate() {
            text += between(i == 0, false);
            text += &number.to_string();
        }
    }
    for face in FACES {
        text += between(false, true);
        text += &face.len().to_string();
        for corner in face {
            text += between(false, false);
            text += &corner.to_string();
        }
    }
    text
}

/// Asserts that the file holds these points and faces, and that they follow any order.
fn assert_read(text: &str) {
    let document = open(text.as_bytes(), Format::Off);
    let entry = &document.meshes()[0];
    let fan = |face: &&[u32]| {
        let face = face.to_vec();
        (2..face.len()).map(move |last| [face[0], face[last - 1], face[last]])
    };
    let faces: Vec<[u32; 3]> = FACES.iter().flat_map(fan).collect();
    assert_eq!(entry.mesh.faces(), faces, "{text}");
    let points = POINTS.map(|point| point.map(|number| number as f32));
    assert_eq!(document.positions(0).unwrap().unwrap(), points, "{text}");
    round_trip::check(text.as_bytes(), Format::Off, "mesh.off");
}

#[test]
fn line_ends_are_blanks() {
    // One number a line, all on one line, two vertices a line, faces over lines, lines of any length.
    assert_read(&text("OFF\n", |_, _| "\n"));
    assert_read(&text("OFF ", |_, _| " "));
    assert_read(&text("", |_, _| "\t"));
    let mut vertices = 0;
    assert_read(&text("OFF\n", |starts_vertex, starts_face| {
        vertices += usize::from(starts_vertex);
        let ends_line = starts_face || starts_vertex && vertices % 2 == 1;
        if ends_line { "\r\n" } else { " " }
    }));
    assert_read(&text("OFF # of lines\n", |vertex, face| {
        match (vertex, face) {
            (true, _) => "\n",
            (_, true) => "\n# a face\n",
            _ => " ",
        }
    }));
    for length in 2..30 {
        let mut count = 0;
        let flowing = text("OFF\n", |vertex, _| {
            count += 1;
            match count % length {
                0 if !vertex => "\n",
                1 if count > 1 => "  # flows\n",
                _ => " ",
            }
        });
        round_trip::check(flowing.as_bytes(), Format::Off, "mesh.off");
    }
}

#[test]
fn vertices_on_lines_leave_faces_free() {
    let faces_over_lines = text("OFF\n", |vertex, face| match (vertex, face) {
        (true, _) | (_, true) => "\n",
        _ => " ",
    });
    assert_read(&faces_over_lines);
    let (head, _) = faces_over_lines.split_once("\n3 0 1 2\n").unwrap();
    let over_lines = "\n3\n0 1\n2\n3\n2 3 0\n4\n\n0 1 2 3\n3 4 3 2\n3\n1\n4\n2\n";
    assert_read(&format!("{head}{over_lines}"));
    assert_read(&format!("{head}{}", over_lines.replace('\n', "\r\n")));
    assert_read(&format!("{head}{}", over_lines.replace('\n', " # c\n")));
    // Two faces on each line.
    assert_read(&format!(
        "{head}\n3 0 1 2 3 2 3 0\n4 0 1 2 3 3 4 3 2\n3 1 4 2\n"
    ));
}

#[test]
fn the_word_may_touch_the_first_count() {
    for head in ["OFF", "off", "Off ", "OFF\n"] {
        assert_read(&text(
            head,
            |vertex, face| if vertex || face { "\n" } else { " " },
        ));
    }
    for text in [
        "COFF1 1 0\n0 0 0 1 1 1 1\n3 0 0 0\n",
        "nOFF2 1 1 0\n0 0\n3 0 0 0\n",
    ] {
        assert_eq!(
            entry_of(text.as_bytes(), Format::Off).mesh.vertex_count(),
            1
        );
        check(text.as_bytes(), Format::Off, 1);
    }
}

#[test]
fn records_move_with_their_comments_and_line_ends() {
    let text = "OFF 3 3 0 0 0 0 1 0 0 # both\n0 1\n# in the last\n0 # after\n\
                3 0 1 2 2 0 1\n1 2# end";
    let mut document = open(text.as_bytes(), Format::Off);
    let order = |order: &[u32]| Permutation::new(order.to_vec()).unwrap();
    let faces = FaceOrder::from(order(&[2, 0, 1]));
    let vertices = VertexOrder::from(order(&[2, 1, 0]));
    document.edit(Edit::order(0, &faces, &vertices)).unwrap();
    let expected = "OFF 3 3 0 0 1\n# in the last\n0 1 0 0 # both\n0 0 0 # after\n\
                    1 0 3 2 1 0\n2 2 1# end";
    assert_eq!(String::from_utf8(written(&document)).unwrap(), expected);
}

#[test]
fn colours_of_faces_end_with_their_line() {
    let text = "OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n3\n2 1\n0 0 255 0 # green\n\
                3 0 2\n1 0 0 255\n";
    let document = open(text.as_bytes(), Format::Off);
    let infos = document.attributes(0);
    let colours = document.attribute(0, infos.last().unwrap()).unwrap();
    let (red, green, blue) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    assert_eq!(colours.to_f32(), [red, green, blue].concat());
    round_trip::check(text.as_bytes(), Format::Off, "mesh.off");
}

/// Whatever lies between the numbers, the file is read, and what was moved is read as it was moved.
#[test]
fn any_layout_is_read_and_lasts() {
    let mut random = Random(5);
    let (mut moved, mut stayed) = (0, 0);
    for round in 0..3000 {
        let (of_records, of_numbers) = (round % 7, round % 11);
        let text = text("OFF\n", |vertex, face| {
            let chance = if vertex || face {
                of_records
            } else {
                of_numbers
            };
            match random.below(12) {
                number if number > chance => " ",
                0 => " # c\n",
                _ => "\n",
            }
        });
        let entry = entry_of(text.as_bytes(), Format::Off);
        assert_eq!(entry.record_count(), FACES.len(), "{text}");
        match entry.faces_movable {
            true => moved += 1,
            false => stayed += 1,
        }
        round_trip::check(text.as_bytes(), Format::Off, "mesh.off");
    }
    assert!(moved > 1000 && stayed > 0, "{moved} {stayed}");
}
