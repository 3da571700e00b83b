//! What is refused, and files of odd forms.

use meshweft::files::{Edit, Format, SelectedFace, SelectedFaces, SelectedVertices};

use crate::choice::Choice;
use crate::{assert_read_again, check, error, open, written};

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n\
1 1 0\n3 0 1 2\n3 1 3 2\n";

fn face(face: u32, corners: [u32; 3]) -> SelectedFace {
    SelectedFace { face, corners }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let choice = |faces: &[SelectedFace], vertices: Option<&[u32]>| Choice {
        faces: faces.to_vec(),
        vertices: vertices.map(<[u32]>::to_vec),
    };
    let first = face(0, [0, 1, 2]);
    for (choice, expected) in [
        (
            choice(&[], None),
            "no face is selected, and it needs one at least",
        ),
        (choice(&[first, first], None), "face 0 is selected twice"),
        (
            choice(&[face(2, [0, 1, 2])], None),
            "there is no face 2: it has 2",
        ),
        (
            choice(&[face(0, [0, 1, 4])], None),
            "face 0, corner 2: index 4 is past the last vertex (3)",
        ),
        (
            choice(&[first], Some(&[])),
            "no vertex is selected, and it needs one at least",
        ),
        (
            choice(&[first], Some(&[0, 1])),
            "face 0 uses vertex 2, which is left out",
        ),
        (
            choice(&[first], Some(&[0, 1, 2, 2])),
            "vertex 2 is selected twice",
        ),
        (
            choice(&[first], Some(&[0, 1, 2, 4])),
            "there is no vertex 4: it has 4",
        ),
    ] {
        let mut document = open(PLY.as_bytes(), Format::Ply);
        let found = error(&mut document, &[(0, choice)]);
        assert!(found.contains(expected), "{found}");
    }

    let mut document = open(PLY.as_bytes(), Format::Ply);
    let faces = [first];
    let twice = [SelectedFaces::new(0, &faces); 2];
    let found = document.edit(Edit::select(&twice, &[])).unwrap_err();
    assert!(
        found.to_string().contains("it is selected twice"),
        "{found}"
    );
    let vertices = [SelectedVertices {
        vertex_group: 0,
        vertices: &[1, 2, 3],
    }; 2];
    let found = document.edit(Edit::select(&[], &vertices)).unwrap_err();
    assert!(found.to_string().contains("is selected twice"), "{found}");
    let found = document
        .edit(Edit::select(&[], &vertices[..1]))
        .unwrap_err();
    assert!(
        found.to_string().contains("face 0 uses vertex 0"),
        "{found}"
    );
    assert_eq!(written(&document), PLY.as_bytes());
}

#[test]
fn unused_vertices_leave_alone() {
    let mut document = open(PLY.replace("3 1 3 2", "3 0 2 1").as_bytes(), Format::Ply);
    let vertices = [SelectedVertices {
        vertex_group: 0,
        vertices: &[2, 0, 1],
    }];
    document.edit(Edit::select(&[], &vertices)).unwrap();
    assert_read_again(&document);
    let text = String::from_utf8(written(&document)).unwrap();
    assert!(
        text.ends_with("0 1 0\n0 0 0\n1 0 0\n3 1 2 0\n3 1 0 2\n"),
        "{text}"
    );
    assert!(text.contains("element vertex 3\n"));
}

#[test]
fn what_names_vertices_or_faces_keeps_them() {
    let edges = PLY.replace(
        "end_header\n",
        "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n",
    ) + "0 3\n";
    let mut document = open(edges.as_bytes(), Format::Ply);
    let choice = Choice::of_faces(&document.meshes()[0], [0]);
    let found = error(&mut document, &[(0, choice.clone().with_used())]);
    assert!(
        found.contains("none can be left out: the vertices stay where they are"),
        "{found}"
    );
    // Faces alone may leave.
    check(&mut document, 0, &choice, true);

    let named = edges.replace("element edge", "element face_names");
    let mut document = open(named.as_bytes(), Format::Ply);
    let found = error(&mut document, &[(0, choice)]);
    assert!(
        found.contains("none can be left out: the faces stay where they are"),
        "{found}"
    );
    // Their corners may change.
    let mut choice = Choice::all(&document.meshes()[0]);
    choice.faces[1].corners = [1, 3, 0];
    check(&mut document, 0, &choice, true);

    let vrml = b"#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0, 0 1 0] } \
                 coordIndex [0 1 2 -1 2 1 0 -1] } }\n";
    let mut document = open(vrml, Format::Vrml);
    let choice = Choice::of_faces(&document.meshes()[0], [0]);
    let found = error(&mut document, &[(0, choice)]);
    assert!(
        found.contains("convert it to .ply or .glb first"),
        "{found}"
    );
}

#[test]
fn indices_that_are_too_narrow_are_told() {
    let mut text = PLY
        .replace("uchar int", "uchar uchar")
        .replace("vertex 4", "vertex 301");
    let more = "2 2 2\n".repeat(297);
    text = text.replace("1 1 0\n3", &format!("1 1 0\n{more}3"));
    let mut document = open(text.as_bytes(), Format::Ply);
    let mut choice = Choice::of_faces(&document.meshes()[0], [0, 1]);
    choice.faces[0].corners = [0, 1, 300];
    let found = error(&mut document, &[(0, choice)]);
    assert!(
        found.contains("stored in 1 bytes, which cannot name vertex 300"),
        "{found}"
    );
}

#[test]
fn lists_of_corners_follow_them() {
    let text = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
                element face 3\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n\
                property uchar red\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n2 1 0\n\
                4  0 1 2 3  8 0 .1 1 .1 1 .9 0 .9 7\n3 1 4 5  6 1 .1 2 .1 2 .9 8\n3 1 5 2 6 1 .1 2 .9 1 .9 9\n";
    let mut document = open(text.as_bytes(), Format::Ply);
    let choice = Choice {
        // The quad loses its first face; vertex 4 collapses onto vertex 2.
        faces: vec![face(1, [0, 2, 3]), face(2, [1, 2, 5])],
        vertices: None,
    }
    .with_used();
    check(&mut document, 0, &choice, true);
    let left = String::from_utf8(written(&document)).unwrap();
    let expected = "3  0 2 3  6 0 .1 1 .9 0 .9 7\n3 1 2 4  6 1 .1 1 .9 2 .9 8\n";
    assert!(left.ends_with(expected), "{left}");

    // Rows that go with the faces, entry by entry.
    let rows = PLY.replace(
        "end_header\n",
        "element multi_texture_vertex 6\nproperty float u\nelement multi_texture_face 2\nproperty uchar tx\n\
         property list uchar int texture_vertex_indices\nend_header\n",
    ) + "0\n1\n2\n3\n4\n5\n7 3 0 1 2\n8 3 3 4 5\n";
    let mut document = open(rows.as_bytes(), Format::Ply);
    let choice = Choice::of_faces(&document.meshes()[0], [1]).with_used();
    check(&mut document, 0, &choice, true);
    let left = String::from_utf8(written(&document)).unwrap();
    assert!(left.contains("multi_texture_face 1\n") && left.contains("multi_texture_vertex 6\n"));
    assert!(
        left.ends_with("1 0 0\n0 1 0\n1 1 0\n3 0 2 1\n0\n1\n2\n3\n4\n5\n8 3 3 4 5\n"),
        "{left}"
    );
}

#[test]
fn records_without_lines_leave_too() {
    let text = "OFF 4 3 6 0 0 0 1 0 0 0 1 0 1 1 0 3 0 1 2 3 2 1 3 3 0 1 3";
    let mut document = open(text.as_bytes(), Format::Off);
    let choice = Choice::of_faces(&document.meshes()[0], [1]).with_used();
    check(&mut document, 0, &choice, true);
    let left = String::from_utf8(written(&document)).unwrap();
    assert_eq!(
        left.split_whitespace().collect::<Vec<_>>().join(" "),
        "OFF 3 1 3 1 0 0 0 1 0 1 1 0 3 1 0 2"
    );

    // A number of edges that is not theirs stays.
    let wrong = text.replace("4 3 6", "4 3 7");
    let mut document = open(wrong.as_bytes(), Format::Off);
    let choice = Choice::of_faces(&document.meshes()[0], [1]);
    check(&mut document, 0, &choice, true);
    assert!(written(&document).starts_with(b"OFF 4 1 7 0"));
}

#[test]
fn a_file_of_any_length_is_answered() {
    for (text, format) in [
        (PLY, Format::Ply),
        (
            "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2",
            Format::Off,
        ),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3",
            Format::Obj,
        ),
    ] {
        for length in 0..=text.len() {
            let bytes = text.as_bytes()[..length].to_vec();
            let name = crate::name_of(format);
            let limits = meshweft::Limits::default();
            let read = meshweft::files::Document::from_bytes(bytes, format, name, limits);
            if let Ok(mut document) = read
                && let Some(entry) = document.meshes().first()
                && entry.mesh.face_count() > 0
            {
                let choice =
                    Choice::of_faces(entry, [entry.mesh.face_count() as u32 - 1]).with_used();
                check(&mut document, 0, &choice, true);
            }
        }
    }
}

#[test]
fn a_damaged_file_is_answered() {
    let pieces: [&[u8]; 9] = [
        b"3",
        b"\n",
        b" ",
        b"-1",
        b"#",
        b"4 0 1 2 3",
        b"\r\n",
        b"element face 1\n",
        b"\\\n",
    ];
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nv 1 1 0\nf 1/1 2/1 3/1 # c\nusemtl a\nf -3 -1 -2\nl 1 2\n";
    let off = "OFF\n4 2 5\n0 0 0\n1 0 0\n0 1 0 # c\n1 1 0\n3 0 1 2 255 0 0\n3 1 3 2 0 0 1\n";
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
               endfacet\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n\
               endfacet\nendsolid\n";
    let mut random = crate::random::Random(77);
    let (mut done, mut refused) = (0, 0);
    for (text, format) in [
        (PLY, Format::Ply),
        (obj, Format::Obj),
        (off, Format::Off),
        (stl, Format::Stl),
    ] {
        for _ in 0..1500 {
            let bytes = random.spoilt(text.as_bytes(), &pieces, 4);
            let limits = meshweft::Limits::default();
            let name = crate::name_of(format);
            let read = meshweft::files::Document::from_bytes(bytes, format, name, limits);
            let Ok(mut document) = read else { continue };
            let Some(entry) = document.meshes().first() else {
                continue;
            };
            if entry.mesh.face_count() == 0 {
                continue;
            }
            let choice = Choice::random(entry, &mut random);
            match crate::select(&mut document, &[(0, choice)]) {
                Ok(()) => done += 1,
                Err(_) => refused += 1,
            }
            assert_read_again(&document);
        }
    }
    println!("{done} selections done, {refused} refused");
    assert!(done > refused);
}
