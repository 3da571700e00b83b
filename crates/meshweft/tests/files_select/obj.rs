//! OBJ: lines leave, statements stay, and corners at seams take what is on their side.

use meshweft::files::{Document, Edit, Format, SelectedFace, SelectedFaces};

use crate::choice::Choice;
use crate::random::Random;
use crate::{assert_read_again, assert_selected, check, error, open, select, written};

fn text(document: &Document) -> String {
    String::from_utf8(written(document)).unwrap()
}

fn face(face: u32, corners: [u32; 3]) -> SelectedFace {
    SelectedFace { face, corners }
}

const GROUPS: &str = "# top\r\nmtllib a.mtl\r\nv 0 0 0\r\nv 1 0 0 # one\r\nv 0 1 0\r\nv 1 1 0\r\nv 2 2 2\r\n\
vt 0 0\r\nvt 1 0\r\nvn 0 0 1\r\no thing\r\nusemtl red\r\nf 1/1/1 2/2/1 3/1/1 # first\r\n  # between\r\n\
s 1\r\nf 2/2 4 3/1\r\nusemtl blue\r\ng last\r\nf -5//1 -3//1 -2//1\r\nl 1 2\r\nf 1 2 3 4\r\n";

#[test]
fn lines_leave_and_statements_stay() {
    let mut document = open(GROUPS.as_bytes(), Format::Obj);
    let choice = Choice {
        // The quad's second face, the first face, and the face of the last group as it is.
        faces: vec![face(0, [0, 1, 2]), face(2, [0, 2, 3]), face(4, [0, 2, 3])],
        vertices: Some(vec![0, 1, 2, 3]),
    };
    check(&mut document, 0, &choice, true);
    assert_eq!(
        text(&document),
        GROUPS
            .replace("v 2 2 2\r\n", "")
            .replace("f 2/2 4 3/1\r\n", "")
            .replace("f -5//1 -3//1 -2//1", "f 1//1 3//1 4//1")
            .replace("f 1 2 3 4", "f 1 3 4")
    );

    // Without vertices that leave, what counts back stays.
    let mut document = open(GROUPS.as_bytes(), Format::Obj);
    let choice = Choice::of_faces(&document.meshes()[0], [0, 2]);
    check(&mut document, 0, &choice, true);
    let left = GROUPS
        .replace("f 2/2 4 3/1\r\n", "")
        .replace("f 1 2 3 4\r\n", "");
    assert_eq!(text(&document), left);
}

#[test]
fn a_polygon_is_cut_where_it_has_to_be() {
    let quads = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                 g a\nf 1/1 2/2 3/3 4/4 # one\nf 2/1 5/2 6/3 3/4\n";
    let mut document = open(quads.as_bytes(), Format::Obj);
    let choice = Choice {
        // Vertex 5 collapses onto vertex 2.
        faces: vec![face(0, [0, 1, 2]), face(1, [0, 2, 3]), face(2, [1, 4, 2])],
        vertices: Some(vec![0, 1, 2, 3, 4]),
    };
    check(&mut document, 0, &choice, true);
    let expected = quads
        .replace("v 2 1 0\n", "")
        .replace("f 2/1 5/2 6/3 3/4", "f 2/1 5/2 3/4");
    assert_eq!(text(&document), expected);

    // Both of its faces are left, but one has another corner.
    let mut document = open(quads.as_bytes(), Format::Obj);
    let mut choice = Choice::all(&document.meshes()[0]);
    choice.faces[1].corners = [0, 2, 1];
    select(&mut document, &[(0, choice)]).unwrap();
    let expected = "f 1/1 2/2 3/3 # one\nf 1/1 3/3 2/2 # one\nf 2/1";
    let expected = quads.replace("f 1/1 2/2 3/3 4/4 # one\nf 2/1", expected);
    assert_eq!(text(&document), expected);
}

/// A strip of quads along x with a seam at x = 2, and texture coordinates of their own on both sides.
fn seam() -> String {
    let mut text = String::new();
    for x in 0..5 {
        text += &format!("v {x} 0 0\nv {x} 1 0\n");
    }
    for x in 0..6 {
        text += &format!("vt 0.{x} 0\nvt 0.{x} 1\n");
    }
    text += "vn 0 0 1\n";
    for quad in 0..4 {
        let v = |i: usize| 2 * quad + 1 + i;
        let t = |i: usize| v(i) + if quad >= 2 { 2 } else { 0 };
        let c = |i: usize| format!("{}/{}/1", v(i), t(i));
        text += &format!(
            "f {} {} {}\nf {} {} {}\n",
            c(0),
            c(2),
            c(3),
            c(0),
            c(3),
            c(1)
        );
    }
    text
}

#[test]
fn a_corner_takes_the_side_of_the_seam_that_it_comes_from() {
    let text_of = seam();
    let mut document = open(text_of.as_bytes(), Format::Obj);
    // Vertices 2 and 6 (at x = 1 and x = 3) collapse onto vertex 4, at the seam.
    let onto = |vertex: u32| if matches!(vertex, 2 | 6) { 4 } else { vertex };
    let mut choice = Choice::all(&document.meshes()[0]);
    for face in &mut choice.faces {
        face.corners = face.corners.map(onto);
    }
    choice.faces.retain(|face| {
        let [a, b, c] = face.corners;
        a != b && b != c && a != c
    });
    let choice = choice.with_used();
    check(&mut document, 0, &choice, true);
    let left = text(&document);
    // From the left with the texture coordinate of the left, from the right with that of the right.
    assert!(left.contains("f 1/1/1 4/5/1"), "{left}");
    assert!(left.contains("/7/1 ") || left.contains(" 4/7/1"), "{left}");
    for line in left.lines().filter(|line| line.starts_with('f')) {
        let sides: Vec<bool> = line
            .split(' ')
            .skip(1)
            .map(|corner| corner.split('/').nth(1).unwrap().parse::<usize>().unwrap() > 6)
            .collect();
        assert!(sides.windows(2).all(|pair| pair[0] == pair[1]), "{line}");
    }
}

#[test]
fn what_cannot_be_told_or_named_is_refused() {
    // Every corner has a texture coordinate of its own.
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 2 0\nvt 3 0\nvt 4 0\nvt 5 0\n\
                   vt 6 0\nvt 7 0\nvt 8 0\nf 1/1 2/2 3/3\nf 2/4 4/5 3/6\nf 1/7 4/8 3/9\n";
    let mut document = open(corners.as_bytes(), Format::Obj);
    let choice = Choice {
        faces: vec![face(0, [0, 1, 3])],
        vertices: None,
    };
    let found = error(&mut document, &[(0, choice)]);
    assert!(
        found.contains("vertex 3, where corners store 2 different"),
        "{found}"
    );

    let cases = [
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nf 1 2 4\nl 1 4\n",
            "names vertex 3",
        ),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nf 1 2 4\nsurf 0 1 0 1 1\n",
            "none can be left out: the vertices stay where they are: the statement \"surf\"",
        ),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\n#age 1\n#age 2\n#age 3\n#age 4\nf 1 2 3\nf 1 2 4\n",
            "the comments \"age\" may go by their order",
        ),
    ];
    for (text, expected) in cases {
        let mut document = open(text.as_bytes(), Format::Obj);
        let choice = Choice::of_faces(&document.meshes()[0], [0]).with_used();
        let found = error(&mut document, &[(0, choice)]);
        assert!(found.contains(expected), "{found}");
    }

    // A vertex that stands below the face.
    let below = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 5 5 5\nf 1 2 4\n";
    let mut document = open(below.as_bytes(), Format::Obj);
    let choice = Choice {
        faces: vec![face(0, [0, 1, 3])],
        vertices: None,
    };
    let found = error(&mut document, &[(0, choice)]);
    assert!(found.contains("stand below this face"), "{found}");
}

#[test]
fn objects_with_vertices_between_lose_faces_and_vertices() {
    let text_of = "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf -4 -3 -2\nf -3 -1 -2\no b\nv 5 0 0\nv 6 0 0\n\
                   v 5 1 0\nv 6 1 0\nf 5 6 7\nf -3 -1 -2\n";
    let mut document = open(text_of.as_bytes(), Format::Obj);
    assert!(!document.meshes()[0].vertices_movable);
    let choice = Choice::of_faces(&document.meshes()[0], [1, 3]).with_used();
    check(&mut document, 0, &choice, true);
    let left = "o a\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 3 2\no b\nv 6 0 0\nv 5 1 0\nv 6 1 0\nf 4 6 5\n";
    assert_eq!(text(&document), left);

    // They leave, but they do not move.
    let mut document = open(text_of.as_bytes(), Format::Obj);
    let mut choice = Choice::of_faces(&document.meshes()[0], [1, 3]).with_used();
    choice.vertices.as_mut().unwrap().swap(0, 1);
    let found = error(&mut document, &[(0, choice)]);
    assert!(
        found.contains("its vertices must stay where they are"),
        "{found}"
    );
}

#[test]
fn colors_in_comments_leave_with_their_vertices() {
    let text_of = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n#MRGB aa000000bb000000cc000000dd000000\nf 1 2 3\nf 2 4 3\n";
    let mut document = open(text_of.as_bytes(), Format::Obj);
    let choice = Choice::of_faces(&document.meshes()[0], [1]).with_used();
    check(&mut document, 0, &choice, true);
    let left = "v 1 0 0\nv 0 1 0\nv 1 1 0\n#MRGB bb000000cc000000dd000000\nf 1 3 2\n";
    assert_eq!(text(&document), left);
}

#[test]
fn random_selections() {
    let mut texts = vec![seam()];
    texts.push(seam().replace("f 5", "g x\nf 5"));
    let mut refused = 0;
    let mut done = 0;
    for text in &texts {
        for seed in 1..60 {
            let mut random = Random(seed);
            let mut document = open(text.as_bytes(), Format::Obj);
            for _ in 0..4 {
                let choice = Choice::random(&document.meshes()[0], &mut random);
                let before = open(&written(&document), Format::Obj);
                match select(&mut document, &[(0, choice.clone())]) {
                    Ok(()) => {
                        assert_selected(&before, &document, 0, &choice, true);
                        assert_read_again(&document);
                        done += 1;
                    }
                    Err(error) => {
                        let error = error.to_string();
                        assert!(error.contains("cannot be told"), "{error}");
                        refused += 1;
                        break;
                    }
                }
            }
        }
    }
    println!("{done} selections done, {refused} refused");
    assert!(done > 4 * refused, "{done} done, {refused} refused");
}

/// Of which corner a moved one takes texture coordinates can be said, also where seams do not tell.
#[test]
fn what_a_moved_corner_takes_can_be_said() {
    let fan = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nvt 0 0\nvt 1 0\nvt 2 0\nvt 3 0\n\
               f 1/1 2/1 3/1\nf 1/2 3/2 4/2\nf 2/3 1/3 4/4\n";
    let faces = [face(0, [0, 1, 3]), face(1, [0, 2, 3])];
    let selected = |corner_sources: &[[u32; 3]]| {
        let mut document = open(fan.as_bytes(), Format::Obj);
        let faces = SelectedFaces {
            corner_sources,
            ..SelectedFaces::new(0, &faces)
        };
        let done = document.edit(Edit::select(&[faces], &[]));
        done.map(|()| text(&document))
    };
    let refused = selected(&[]).unwrap_err().to_string();
    assert!(refused.contains("cannot be told"), "{refused}");
    let found = selected(&[[0, 1, 8], [3, 4, 5]]).unwrap();
    assert!(found.ends_with("f 1/1 2/1 4/4\nf 1/2 3/2 4/2\n"), "{found}");

    let refused = selected(&[[0, 1, 7], [3, 4, 5]]).unwrap_err().to_string();
    assert!(
        refused.contains("corner 7 of the source is not at vertex 3"),
        "{refused}"
    );
    let refused = selected(&[[0, 1, 8]]).unwrap_err().to_string();
    assert!(refused.contains("corner sources"), "{refused}");
}
