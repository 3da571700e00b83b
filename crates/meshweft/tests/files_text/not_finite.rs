//! Numbers that are not finite, in the spellings of C libraries, wherever numbers stand.

use meshweft::attribute::{AttributeInfo, Semantic};
use meshweft::files::{Document, Edit, Format};
use meshweft::{Permutation, VertexOrder};

use super::{check, open, written};

/// The first attribute of this meaning, as floats.
fn numbers(document: &Document, semantic: &Semantic) -> Vec<f32> {
    let mut infos = document.attributes(0).into_iter();
    let info: AttributeInfo = infos.find(|info| info.semantic == *semantic).unwrap();
    document.attribute(0, &info).unwrap().to_f32()
}

fn swapped(document: &mut Document, vertices: usize) -> String {
    let last_first = (0..u32::try_from(vertices).unwrap()).rev().collect();
    let order = VertexOrder::from(Permutation::new(last_first).unwrap());
    document.edit(Edit::order(0, None, &order)).unwrap();
    String::from_utf8(written(document)).unwrap()
}

#[test]
fn records_with_them_move() {
    let rows = "-nan(ind) 0 0\n1 nan(snan) 0\n0 1 -nan\n";
    let obj = rows
        .lines()
        .map(|row| format!("v {row}\n"))
        .collect::<String>();
    let ply = format!(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty double y\n\
         property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n\
         {rows}3 0 1 2\n3 2 1 0\n"
    );
    for (text, format) in [
        (format!("{obj}f 1 2 3\nf 3 2 1\n"), Format::Obj),
        (format!("OFF\n3 2 0\n{rows}3 0 1 2\n3 2 1 0\n"), Format::Off),
        (ply, Format::Ply),
    ] {
        for seed in 1..8 {
            check(text.as_bytes(), format, seed);
        }
        let values = numbers(&open(text.as_bytes(), format), &Semantic::Position);
        let are_nan: Vec<bool> = values.iter().map(|number| number.is_nan()).collect();
        let expected = [true, false, false, false, true, false, false, false, true];
        assert_eq!(are_nan, expected, "{format}");
    }
}

#[test]
fn a_mark_in_a_number_is_no_comment() {
    // The second line goes on, and has a comment.
    let obj = "v -1.#IND 1.#INF 0\nv 1 1.#QNAN0 \\\n -1.#INF#c\nv 1 2 3\nf 1 2 3\n";
    let mut document = open(obj.as_bytes(), Format::Obj);
    let values = numbers(&document, &Semantic::Position);
    assert!(values[0].is_nan() && values[4].is_nan());
    assert_eq!((values[1], values[5]), (f32::INFINITY, f32::NEG_INFINITY));
    let moved = "v 1 2 3\nv 1 1.#QNAN0 \\\n -1.#INF#c\nv -1.#IND 1.#INF 0\nf 3 2 1\n";
    assert_eq!(swapped(&mut document, 3), moved);

    let off = "OFF\n2 1 0\n1.#INF 0 -1.#IND# one\n0 1.#QNAN 0 # two\n3 0 1 0\n";
    let mut document = open(off.as_bytes(), Format::Off);
    assert_eq!(
        numbers(&document, &Semantic::Position)[0].to_bits(),
        f32::INFINITY.to_bits()
    );
    let moved = "OFF\n2 1 0\n0 1.#QNAN 0# one\n1.#INF 0 -1.#IND # two\n3 1 0 1\n";
    assert_eq!(swapped(&mut document, 2), moved);
}

#[test]
fn values_of_any_kind_may_be_so() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n\
        property float z\nproperty double quality\nelement face 1\nproperty float nx\n\
        property float ny\nproperty float nz\nproperty list uchar int vertex_indices\nend_header\n\
        1.#INF 0 0 -1.#INF\n-1.#IND 1.#INF 0 3 0 0 0\n";
    let document = open(ply.as_bytes(), Format::Ply);
    let quality = numbers(&document, &Semantic::Other("quality".into()));
    assert_eq!(quality, [f32::NEG_INFINITY]);
    let normal = numbers(&document, &Semantic::Normal);
    assert!(normal[0].is_nan() && normal[1].is_infinite());

    let stl = "solid\nfacet normal -1.#IND -nan(ind) 0\nouter loop\nvertex 1.#INF 0 0\n\
        vertex 1.#QNAN 0 0\nvertex 1.#QNAN 0 0\nendloop\nendfacet\nendsolid\n";
    let document = open(stl.as_bytes(), Format::Stl);
    assert_eq!(document.meshes()[0].mesh.vertex_count(), 2);
    let normal = numbers(&document, &Semantic::Normal);
    assert!(normal[0].is_nan() && normal[1].is_nan() && normal[2] == 0.0);

    let obj = "v 0 0 0\nvt 1.#IND 0\nvn nan(ind) 1.#INF 0\nf 1/1/1 1/1/1 1/1/1\n";
    let document = open(obj.as_bytes(), Format::Obj);
    assert!(numbers(&document, &Semantic::TexCoord(0))[0].is_nan());
    assert!(numbers(&document, &Semantic::Normal)[1].is_infinite());
}
