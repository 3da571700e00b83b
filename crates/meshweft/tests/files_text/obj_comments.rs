//! Comments of an OBJ that hold data for each vertex or face.

use meshweft::files::{Document, Edit, Format, ReadOptions};
use meshweft::{FaceOrder, Permutation, VertexOrder};

use super::{check, name_of, open, written};

const POINTS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const FACES: &str = "f 1 2 3\nf 2 3 4\nf 1 3 4\n";

/// The text with its vertices last first, and what is said of it.
fn last_first(text: &str) -> (String, Vec<String>) {
    let mut document = open(text.as_bytes(), Format::Obj);
    if document.meshes()[0].vertices_movable {
        let order = VertexOrder::from(Permutation::new(vec![3, 2, 1, 0]).unwrap());
        document.edit(Edit::order(0, None, &order)).unwrap();
    }
    let notes = document.notes().iter().map(|note| note.text.clone());
    let notes = notes.collect();
    (String::from_utf8(written(&document)).unwrap(), notes)
}

#[test]
fn colors_in_comments_go_where_their_vertices_go() {
    let text = |points: [&str; 4], colors: [&str; 4], faces: &str| {
        let [a, b, c, d] = colors;
        let points = points.map(|point| format!("v {point}\n")).concat();
        let colors = format!("#MRGB {a}{b} \r\n#\n  #MRGB\t{c}\r\n#MRGB \n# End\n#MRGB {d}\n");
        format!("# block\n{points}{colors}{faces}#")
    };
    let points = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"];
    let colors = ["ff000000", "ffFF0000", "0000ff00", "000000ff"];
    let before = text(points, colors, FACES);
    let turned = |mut four: [&'static str; 4]| {
        four.reverse();
        four
    };
    let faces = "f 4 3 2\nf 3 2 1\nf 4 2 1\n";
    let after = text(turned(points), turned(colors), faces);
    assert_eq!(last_first(&before), (after, Vec::new()));
}

#[test]
fn colors_that_do_not_fit_keep_the_vertices() {
    let stay = "the vertices stay where they are:";
    for (colors, why) in [
        (
            "#MRGB ff000000ff000000\n",
            "the #MRGB lines hold 2 colors, and there are 4 vertices",
        ),
        (
            "#MRGB\n",
            "the #MRGB lines hold 0 colors, and there are 4 vertices",
        ),
        (
            "#MRGB ff000000ff000000ff000000ff0000\n",
            "this #MRGB line holds something else than colors of 8 digits in base 16",
        ),
        (
            "#MRGB ff000000ff000000ff000000ff000000 end\n",
            "this #MRGB line holds something else than colors of 8 digits in base 16",
        ),
    ] {
        let text = format!("{POINTS}{colors}{FACES}");
        let (after, notes) = last_first(&text);
        assert_eq!((after, notes), (text, vec![format!("{stay} {why}")]));
    }
}

#[test]
fn comments_with_as_many_numbers_as_records_keep_these() {
    let stay = |what: &str, word: &str| {
        vec![format!(
            "the {what} stay where they are: the comments {word:?} may go by their order"
        )]
    };
    let each = "#vcolor 1 .5 0\n";
    let among = POINTS.replace("v ", &format!("{each}v "));
    for (text, notes) in [
        (among + FACES, stay("vertices", "vcolor")),
        (
            format!("# weights 1 2 3e1 -.4\n{POINTS}{FACES}"),
            stay("vertices", "weights"),
        ),
        (
            format!("{POINTS}#rgb 0a0b0c0d0e0f 0000000a0b0c\n{FACES}"),
            stay("vertices", "rgb"),
        ),
        (
            format!("{POINTS}# 1 2\n# 3 4\n{FACES}"),
            stay("vertices", ""),
        ),
        (
            POINTS.to_owned() + &FACES.replace("f ", "# face 1 2 3 4 5\nf "),
            stay("faces", "face"),
        ),
        (
            format!("# made by hand\n# 4 vertices\n# 3 faces\n# scale 2\n{POINTS}# all 9\n{FACES}"),
            Vec::new(),
        ),
        (
            format!("{POINTS}# a b c d\n# of 1 2 3 and 4\n{FACES}"),
            Vec::new(),
        ),
    ] {
        check(text.as_bytes(), Format::Obj, 3);
        let document = open(text.as_bytes(), Format::Obj);
        let found: Vec<String> = document
            .notes()
            .iter()
            .map(|note| note.text.clone())
            .collect();
        assert_eq!(found, notes, "{text}");
        let entry = &document.meshes()[0];
        let stays = |what: &str| found.iter().any(|note| note.contains(what));
        assert_eq!(entry.vertices_movable, !stays("the vertices stay"));
        assert_eq!(entry.faces_movable, !stays("the faces stay"));
    }
}

#[test]
fn the_caller_may_vouch_for_comments_or_refuse_them() {
    let text = format!("#vcolor 1\n#vcolor 2\n{POINTS}#vcolor 3\n#vcolor 4\n{FACES}");
    let read = |options: ReadOptions| {
        Document::from_bytes(
            text.clone().into_bytes(),
            Format::Obj,
            name_of(Format::Obj),
            options,
        )
    };
    let mut options = ReadOptions::default();
    options.strict = true;
    let error = read(options.clone()).unwrap_err().to_string();
    let expected =
        "the comment vcolor is not known and may depend on the order of vertices or faces";
    assert!(error.contains(expected), "{error}");
    options.assume_order_safe.push("vcolor".into());
    assert!(read(options).unwrap().meshes()[0].vertices_movable);
}

#[test]
fn faces_that_comments_count_take_no_order() {
    let text = format!("{POINTS}{}", FACES.replace("f ", "# face 0 0\nf "));
    let mut document = open(text.as_bytes(), Format::Obj);
    let order = FaceOrder::from(Permutation::new(vec![2, 1, 0]).unwrap());
    let error = document.edit(Edit::order(0, &order, None)).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("its faces must stay in their order")
    );
}
