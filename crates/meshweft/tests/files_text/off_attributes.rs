//! Attributes of OFF: what lines hold, before and after their order changes.

use meshweft::attribute::{AttributeInfo, ComponentType, Domain, Semantic, Values};
use meshweft::files::{Document, Edit, Format, Place};
use meshweft::{FaceOrder, Permutation, VertexOrder};

use super::open;

const ALL: &str = "STCNOFF # all there is\n4 3 0\n\
0 0 5  0 0 1  10 0 0 255  0 .5\n\
1 0 5  0 1 0  11 0 0 255  1 .5 # here\n\n\
2 0 5  1 0 0  12 0 0 255  2 .5\n\
3 0 5  0 0 -1  13 0 0 255  3 .5\n\
4 0 1 2 3 1 0 0\n3 2 1 0 .25 1 0 # a colour\n2 0 1 1 1 1\n";

fn off(text: &str) -> Document {
    open(text.as_bytes(), Format::Off)
}

fn color(domain: Domain, components: usize, component_type: ComponentType) -> AttributeInfo {
    let mut info = AttributeInfo::new(Semantic::Color(0), domain, components, component_type);
    info.is_normalized = component_type == ComponentType::U8;
    info
}

fn of_vertices(semantic: Semantic, components: usize) -> AttributeInfo {
    AttributeInfo::new(semantic, Domain::Vertex, components, ComponentType::F32)
}

fn values(document: &Document, info: &AttributeInfo) -> Values {
    document.attribute(0, info).unwrap().values
}

/// Asserts what vertices hold that had these numbers.
fn check_vertices(document: &Document, ids: [u8; 4]) {
    let floats = |of: fn(f32) -> Vec<f32>| {
        let ids = ids.iter().map(|&id| f32::from(id));
        Values::F32(ids.flat_map(of).collect())
    };
    let position = floats(|id| vec![id, 0.0, 5.0]);
    assert_eq!(
        values(document, &of_vertices(Semantic::Position, 3)),
        position
    );
    let normals = [
        [0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 0.0, -1.0],
    ];
    let normals = ids.iter().flat_map(|&id| normals[usize::from(id)]);
    let normals = Values::F32(normals.collect());
    assert_eq!(values(document, &of_vertices(Semantic::Normal, 3)), normals);
    let texture = floats(|id| vec![id, 0.5]);
    assert_eq!(
        values(document, &of_vertices(Semantic::TexCoord(0), 2)),
        texture
    );
    let colors = ids.iter().flat_map(|&id| [10 + id, 0, 0, 255]);
    let info = color(Domain::Vertex, 4, ComponentType::U8);
    assert_eq!(values(document, &info), Values::U8(colors.collect()));
}

#[test]
fn values_of_lines_follow_their_order() {
    let mut document = off(ALL);
    let face_colors = color(Domain::Face, 3, ComponentType::F32);
    assert_eq!(
        document.attributes(0),
        [
            of_vertices(Semantic::Position, 3),
            of_vertices(Semantic::Normal, 3),
            color(Domain::Vertex, 4, ComponentType::U8),
            of_vertices(Semantic::TexCoord(0), 2),
            face_colors.clone(),
        ]
    );
    check_vertices(&document, [0, 1, 2, 3]);
    // The line with two corners is not a face, the one with four is two faces.
    let (quad, triangle) = ([1.0, 0.0, 0.0], [0.25, 1.0, 0.0]);
    let expected = Values::F32([quad, quad, triangle].concat());
    assert_eq!(values(&document, &face_colors), expected);

    let faces = FaceOrder::from(Permutation::new(vec![1, 2, 0]).unwrap());
    let vertices = VertexOrder::from(Permutation::new(vec![3, 1, 0, 2]).unwrap());
    document.edit(Edit::order(0, &faces, &vertices)).unwrap();
    check_vertices(&document, [3, 1, 0, 2]);
    let expected = Values::F32([triangle, quad, quad].concat());
    assert_eq!(values(&document, &face_colors), expected);

    document.edit(Edit::order(0, &faces, &vertices)).unwrap();
    check_vertices(&document, [2, 1, 3, 0]);
}

#[test]
fn what_is_listed_is_what_every_line_has() {
    let position = of_vertices(Semantic::Position, 3);
    let normal = of_vertices(Semantic::Normal, 3);
    let texture = of_vertices(Semantic::TexCoord(0), 2);
    let of_vertex = |components, component_type| color(Domain::Vertex, components, component_type);
    let of_face = |components, component_type| color(Domain::Face, components, component_type);
    let (byte, real) = (ComponentType::U8, ComponentType::F32);
    let cases: [(&str, Vec<AttributeInfo>); 15] = [
        (
            "3 1\n0 0 0 1 1 1\n0 0 0 1 1 1\n0 0 0 1 1 1\n3 0 1 2\n",
            vec![],
        ),
        ("COFF 1 1\n0 0 0 1 0 255\n1 0\n", vec![of_vertex(3, byte)]),
        ("COFF 1 1\n0 0 0 1. 0 255\n1 0\n", vec![of_vertex(3, real)]),
        ("COFF 1 1\n0 0 0 1 0 256 0\n1 0\n", vec![of_vertex(4, real)]),
        ("COFF 1 1\n0 0 0 1 0 0 0 0\n1 0\n", vec![]),
        ("COFF 2 1\n0 0 0 1 0 0 0\n0 0 0 1 0 0\n1 0\n", vec![]),
        (
            "STCOFF 2 1\n0 0 0 1 0 0 0 0 0\n0 0 0 1 0 0 0 0\n1 0\n",
            vec![],
        ),
        (
            "STCOFF 1 1\n0 0 0 1 0 0 0 0\n1 0\n",
            vec![of_vertex(3, byte), texture.clone()],
        ),
        ("STOFF 1 1\n0 0 0 1 0 0 0\n1 0\n", vec![texture]),
        ("NnOFF 2 1 1\n1 2 3 4\n1 0\n", vec![normal.clone()]),
        ("N4OFF 1 1\n1 2 3 4 5 6 7 8\n1 0\n", vec![normal.clone()]),
        ("OFF 1 1\n0 0 0\n1 0 7\n", vec![]),
        (
            "OFF 1 2\n0 0 0\n1 0 7 8 9\n0 1 2 3\n",
            vec![of_face(3, byte)],
        ),
        (
            "OFF 1 2\n0 0 0\n1 0 7 8 9 -1\n1 0 1 2 3 4\n",
            vec![of_face(4, real)],
        ),
        ("OFF 1 2\n0 0 0\n1 0 7 8 9\n1 0 1 2 3 4\n", vec![]),
    ];
    for (text, expected) in cases {
        let document = off(text);
        let expected: Vec<_> = [position.clone()].into_iter().chain(expected).collect();
        assert_eq!(document.attributes(0), expected, "{text}");
        for info in expected {
            document.attribute(0, &info).unwrap();
        }
    }
    let plane = off("NnOFF 2 1 1\n1 2 3 4\n1 0\n");
    assert_eq!(values(&plane, &position), Values::F32(vec![1.0, 2.0, 0.0]));
    assert_eq!(values(&plane, &normal), Values::F32(vec![3.0, 4.0, 0.0]));
    let four = off("N4OFF 1 1\n1 2 3 4 5 6 7 8\n1 0\n");
    assert_eq!(values(&four, &normal), Values::F32(vec![5.0, 6.0, 7.0]));
}

#[test]
fn what_is_no_number_is_told_when_it_is_read() {
    let text = "NOFF\n3 1\n0 0 0 0 0 1\n\n0 0 0 0 up 1\n0 0 0 0 0 1\n3 0 1 2 r g b\n";
    let document = off(text);
    let error = |info: &AttributeInfo| document.attribute(0, info).unwrap_err();
    let normal = error(&of_vertices(Semantic::Normal, 3));
    assert_eq!(normal.place, Place::Line(5));
    assert_eq!(
        normal.to_string(),
        "mesh.off: line 5: vertex 1: \"up\" is not part of NORMAL: write a number. Fix it there, \
         or re-export the file"
    );
    let color = error(&color(Domain::Face, 3, ComponentType::F32));
    assert_eq!(color.place, Place::Line(7));
    let other = error(&of_vertices(Semantic::Tangent, 4));
    assert_eq!(
        other.to_string(),
        "mesh.off: this mesh has no attribute TANGENT: take one of those that are listed"
    );
}
