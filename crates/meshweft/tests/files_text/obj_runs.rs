//! Which faces of an OBJ may change places, and what goes with them.

use meshweft::files::{Document, Edit, Format, ReadOptions};
use meshweft::{FaceOrder, Permutation};

use super::obj_values::check_values;
use super::{check, name_of, open, written};

const POINTS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

fn runs(text: &str) -> Vec<u32> {
    open(text.as_bytes(), Format::Obj).meshes()[0].runs.clone()
}

/// The text with its faces in this order.
fn ordered(text: &str, new_to_old: &[u32]) -> String {
    let mut document = open(text.as_bytes(), Format::Obj);
    let order = FaceOrder::from(Permutation::new(new_to_old.to_vec()).unwrap());
    document.edit(Edit::order(0, &order, None)).unwrap();
    String::from_utf8(written(&document)).unwrap()
}

#[test]
fn what_says_nothing_new_of_faces_ends_no_run() {
    for between in [
        "\n",
        "# usemtl b\n",
        "usemtl a\n",
        "usemtl  a \n",
        "usemtl b\nusemtl a\n",
        "s 1\n",
        "g one two\n",
        "o thing\n",
        "mtllib more.mtl\n",
        "vt 0 0\n",
        "vn 0 0 1\n",
        "vp 0\n",
        "v 2 2 2\n",
        "vt 0 0\nusemtl a\nvt 1 1\nvn 0 0 1\n",
        "l -1 2\np -3\nvt 1\n",
        "lod 3\n",
    ] {
        let state = "mtllib a.mtl\no thing\ng one two\nusemtl a\ns 1\nlod 3\n";
        let text = format!("{POINTS}{state}f 1 2 3\n{between}f 2 3 4\n{between}f 4 3 1\n");
        assert_eq!(runs(&text), [0], "{between}");
        for seed in 1..9 {
            check(text.as_bytes(), Format::Obj, seed);
        }
    }
}

#[test]
fn what_says_something_of_faces_ends_a_run() {
    for between in [
        "usemtl b\n",
        "mtllib more.mtl\nusemtl a\n",
        "s off\n",
        "g two one\n",
        "g\n",
        "o\n",
        "o other\n",
        "bevel on\n",
        "mg 1 .5\n",
        "usemap x\n",
        "l -1 -2\nv 2 2 2\n",
        "vt 1\np 1/-1\nvt 2\n",
        "what 1\n",
        "o thing\nv 2 2 2\n",
        "f 1/-1 2/1 3/1\n",
    ] {
        let state = "mtllib a.mtl\no thing\ng one two\nusemtl a\ns 1\n";
        let text = format!("{POINTS}{state}f 1 2 3\n{between}f 2 3 4\n");
        let ends = runs(&text).len();
        assert_eq!(
            ends,
            if between.starts_with('f') { 3 } else { 2 },
            "{between}"
        );
        check(text.as_bytes(), Format::Obj, 7);
    }
    // What holds after a face of another state holds for a new run.
    let back = "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\nusemtl a\nf 2 3 4\nf 1 2 4\n";
    assert_eq!(runs(&format!("{POINTS}{back}")), [0, 1, 2]);
}

#[test]
fn no_face_comes_to_a_place_of_another_state() {
    for (state, other) in [
        ("usemtl a", "usemtl b"),
        ("s 1", "s off"),
        ("g a", "g b"),
        ("o a", "o b"),
    ] {
        for definition in ["vt 1 1", "vn 0 0 1"] {
            let text = format!(
                "{POINTS}vt 0 0\n{state}\nf 1 2 3\n{other}\n{definition}\n{state}\nf 3 4 2\nf 2 4 1\n"
            );
            assert_eq!(runs(&text), [0, 1], "{text}");
            let moved = ordered(&text, &[0, 2, 1]);
            assert_eq!(
                moved,
                text.replace("f 3 4 2\nf 2 4 1\n", "f 2 4 1\nf 3 4 2\n")
            );
        }
    }
}

#[test]
fn lines_that_faces_name_go_above_those_that_move() {
    let head = format!("{POINTS}vt 9\nusemtl a\n");
    let text = format!(
        "{head}f 1/-1 2/1 3/1 # one\n# stays\n  vt 1 \\\n 1\r\nusemtl a\nvt 2\nf -1/-1 -2/-2 2/1\nvn 1 0 0\n\
         v 5 5 5\nf -1/-1/-1 2/3/1 -2/-3\nvt 3\n"
    );
    let expected = format!(
        "{head}vt 1 \\\n 1\n# stays\n  vt 2\r\nusemtl a\nvn 1 0 0\nv 5 5 5\nf 5/3/1 2/3/1 4/1\n\
         f 1/1 2/1 3/1 # one\nf 4/3 3/2 2/1\nvt 3\n"
    );
    assert_eq!(ordered(&text, &[2, 0, 1]), expected);
    assert_eq!(ordered(&text, &[0, 1, 2]), text, "nothing moves");
    for seed in 1..40 {
        check(text.replace("\\\n", "").as_bytes(), Format::Obj, seed);
    }
}

/// Faces of several runs, with lines of every kind between and numbers of every kind.
#[test]
fn values_stay_with_faces_whose_lines_are_between_them() {
    let mut text = POINTS.to_owned();
    for face in 0..60 {
        if face % 20 == 0 {
            text += &format!("usemtl {face}\nusemtl {face}\n");
        }
        for corner in 0..3 {
            text += &format!("vt {face} {corner}\n");
        }
        if face % 3 == 0 {
            text += &format!("vn {face} 0 1\nv {face} 1 2\n");
        }
        let [a, b, c] = [face % 4 + 1, (face + 1) % 4 + 1, -1 - face % 3];
        text += &match face % 2 {
            0 => format!("f {a}/-3/-1 {b}/-2/1 {c}/-1/-1\n"),
            _ => format!(
                "f {a}/{0}/-1 {b}/{1}/1 {c}/{2}/-1\n",
                face * 3 + 1,
                face * 3 + 2,
                face * 3 + 3
            ),
        };
    }
    assert_eq!(runs(&text), [0, 20, 40]);
    for seed in 1..20 {
        check(text.as_bytes(), Format::Obj, seed);
        assert_eq!(check_values(text.as_bytes(), Format::Obj, seed), 3);
    }
}

#[test]
fn groups_are_crossed_where_the_caller_wishes() {
    let mut options = ReadOptions::default();
    options.across_groups = true;
    let runs = |text: String| {
        let name = name_of(Format::Obj);
        let document = Document::from_bytes(text.into_bytes(), Format::Obj, name, options.clone());
        document.unwrap().meshes()[0].runs.clone()
    };
    let faces = |between: &str| format!("{POINTS}g a\nf 1 2 3\n{between}f 2 3 4\n");
    assert_eq!(runs(faces("g b\no c\no\nvt 1\n")), [0]);
    assert_eq!(
        runs(faces("g b\nv 1 2 3\n")),
        [0, 1],
        "vertices of another group"
    );
    assert_eq!(runs(faces("usemtl c\n")), [0, 1]);
}
