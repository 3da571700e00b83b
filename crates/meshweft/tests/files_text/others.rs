//! What other programs write beside the letter of a format, and what fills the ends of files.

use meshweft::Limits;
use meshweft::files::{Document, Edit, Format, Place};
use meshweft::{FaceOrder, Permutation};

use super::stl::ASCII;
use super::{OBJ, PLY, entry_of, error, open, round_trip, written};

#[test]
fn the_end_of_a_solid_may_be_two_words() {
    let facet = |x: u32| {
        format!(
            "Facet normal 0 0 {x}\n outer loop\n  vertex {x} 0 0\n  vertex 0 1 0\n  vertex 0 0 1\n \
             END Loop\nend\tfacet\n"
        )
    };
    let text = format!(
        "solid a\n{}{}end solid a\nsolid end\n{}End Solid",
        facet(1),
        facet(2),
        facet(3)
    );
    let mut document = open(text.as_bytes(), Format::Stl);
    assert_eq!(document.meshes()[0].runs, [0, 2]);
    round_trip::check(text.as_bytes(), Format::Stl, "mesh.stl");
    let order = FaceOrder::new(Permutation::new(vec![1, 0, 2]).unwrap(), vec![0, 0, 1]).unwrap();
    document.edit(Edit::order(0, &order, None)).unwrap();
    let again = String::from_utf8(written(&document)).unwrap();
    assert!(
        again.starts_with(&format!("solid a\n{}{}end solid a\n", facet(2), facet(1))),
        "{again}"
    );
    assert_eq!(
        entry_of(again.as_bytes(), Format::Stl).mesh.faces(),
        document.meshes()[0].mesh.faces()
    );

    let cut = error(b"solid\nend facet\n", Format::Stl);
    assert_eq!(
        cut,
        "mesh.stl: line 2: \"end\" where \"facet\" or \"endsolid\" is expected"
    );
}

#[test]
fn zero_bytes_and_ctrl_z_fill_the_ends_of_text_files() {
    let off = "OFF 3 2 0 0 0 0 1 0 0 0 1 0 3 0 1 2 3 2 1 0\n";
    let wrl = "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0, \
               1 0 0, 0 1 0 ] } coordIndex [ 0 1 2 -1 0 2 1 -1 ] } }\n";
    for (text, format, name) in [
        (ASCII, Format::Stl, "mesh.stl"),
        (OBJ, Format::Obj, "mesh.obj"),
        (PLY, Format::Ply, "mesh.ply"),
        (off, Format::Off, "mesh.off"),
        (wrl, Format::Vrml, "mesh.wrl"),
    ] {
        for tail in ["\0\0\0\0", "\u{1a}", "\r\n\u{1a}", " \0 \0\n", "\n\n \t\n"] {
            let bytes = format!("{text}{tail}").into_bytes();
            let read = |bytes: &[u8]| {
                let limits = Limits::default();
                Document::from_bytes(bytes.to_vec(), format, name.as_ref(), limits).unwrap()
            };
            let (whole, filled) = (read(text.as_bytes()), read(&bytes));
            assert_eq!(whole.notes(), filled.notes(), "{format} {tail:?}");
            let [a, b] = [&whole, &filled].map(|document| &document.meshes()[0]);
            assert_eq!(a.mesh.faces(), b.mesh.faces());
            assert_eq!(a.vertices_movable, b.vertices_movable);
            round_trip::check(&bytes, format, name);
        }
    }
    // Zero bytes are not blanks.
    assert!(error(b"solid\nend\0solid\n", Format::Stl).contains("line 2: "));
}

#[test]
fn a_line_that_is_not_of_a_ply_header_is_a_comment() {
    let text = PLY.replacen(
        "format ascii 1.0\r\n",
        "format ascii 1.0\r\nCreated by Blender3D 247 - www.blender.org, source file: \r\nand more\r\n\
         \r\nOBJ_INFO x\r\nComment y\r\n",
        1,
    );
    let document = open(text.as_bytes(), Format::Ply);
    let [note] = document.notes() else {
        panic!("{:?}", document.notes());
    };
    assert_eq!(
        note.text,
        "the header line \"Created by Blender3D 247\"… is not of PLY: taken for a comment"
    );
    assert_eq!((&note.place, note.more), (&Place::Line(3), 1));
    let expected = entry_of(PLY.as_bytes(), Format::Ply);
    assert_eq!(document.meshes()[0].mesh.faces(), expected.mesh.faces());
    round_trip::check(text.as_bytes(), Format::Ply, "mesh.ply");

    // Later it may be meant for an element: the rows might be longer than is known.
    let later = PLY.replacen("element face", "proprety float w\r\nelement face", 1);
    assert!(
        error(later.as_bytes(), Format::Ply).contains("\"proprety\" is not a word of a PLY header")
    );
}

#[test]
fn ply_headers_of_every_line_end_may_have_empty_lines() {
    for end in ["\n", "\r\n", "\r"] {
        let text =
            PLY.replace("\r\n", "\n")
                .replacen("element face", "\n \nobj_info a\nelement face", 1);
        let text = text.replace('\n', end);
        let expected = entry_of(PLY.as_bytes(), Format::Ply);
        let entry = entry_of(text.as_bytes(), Format::Ply);
        assert_eq!(entry.mesh.faces(), expected.mesh.faces(), "{end:?}");
        round_trip::check(text.as_bytes(), Format::Ply, "mesh.ply");
    }
}
