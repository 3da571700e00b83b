//! Attributes of STL: positions of welded vertices, normals and bytes of facets.

use meshweft::attribute::{AttributeInfo, ComponentType, Domain, Semantic, Values};
use meshweft::files::{Document, Edit, Format, Place};
use meshweft::{FaceOrder, Permutation};

use super::open;
use super::stl::{ASCII, binary};

fn position() -> AttributeInfo {
    AttributeInfo::new(Semantic::Position, Domain::Vertex, 3, ComponentType::F32)
}

fn normal() -> AttributeInfo {
    AttributeInfo::new(Semantic::Normal, Domain::Face, 3, ComponentType::F32)
}

fn bytes() -> AttributeInfo {
    let name = Semantic::Other("attribute".into());
    AttributeInfo::new(name, Domain::Face, 1, ComponentType::U16)
}

/// The bits of the position of each corner.
fn corners(document: &Document) -> Vec<[[u32; 3]; 3]> {
    let positions = document.positions(0).unwrap().unwrap();
    let faces = document.meshes()[0].mesh.faces().iter();
    let of_vertex = |vertex: u32| positions[vertex as usize].map(f32::to_bits);
    faces.map(|face| face.map(of_vertex)).collect()
}

const TWO: &str = "solid\n\
    facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n\
    facet normal 0 0 -2 outer loop vertex 1 0 0 vertex -0 .5 nan vertex 0 1 0 endloop endfacet\n\
    endsolid\n";

#[test]
fn positions_and_normals_of_ascii_follow_their_facets() {
    let mut document = open(TWO.as_bytes(), Format::Stl);
    assert_eq!(document.attributes(0), [position(), normal()]);
    let bits = |corners: [[f32; 3]; 3]| corners.map(|corner| corner.map(f32::to_bits));
    let first = bits([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let second = bits([[1.0, 0.0, 0.0], [-0.0, 0.5, f32::NAN], [0.0, 1.0, 0.0]]);
    assert_eq!(corners(&document), [first, second]);
    let normals = |document: &Document| document.attribute(0, &normal()).unwrap().values;
    assert_eq!(
        normals(&document),
        Values::F32(vec![0.0, 0.0, 1.0, 0.0, 0.0, -2.0])
    );

    let order = FaceOrder::new(Permutation::new(vec![1, 0]).unwrap(), vec![2, 1]).unwrap();
    for _ in 0..3 {
        let before = corners(&document);
        document.edit(Edit::order(0, &order, None)).unwrap();
        assert_eq!(corners(&document), order.apply(&before));
    }
    assert_eq!(
        normals(&document),
        Values::F32(vec![0.0, 0.0, -2.0, 0.0, 0.0, 1.0])
    );
}

#[test]
fn numbers_of_binary_follow_their_facets() {
    let mut document = open(&binary("made by hand", 9, b""), Format::Stl);
    assert_eq!(document.attributes(0), [position(), normal(), bytes()]);
    let before = corners(&document);
    assert_eq!(before[3][2], [2.0, -0.0, f32::NAN].map(f32::to_bits));
    let order: Vec<u32> = vec![4, 0, 8, 1, 7, 2, 6, 3, 5];
    let order = FaceOrder::new(Permutation::new(order).unwrap(), vec![2; 9]).unwrap();
    document.edit(Edit::order(0, &order, None)).unwrap();
    assert_eq!(corners(&document), order.apply(&before));

    // The builder writes the number of the facet in all bytes of its normal, and in the last.
    let facets = order.new_to_old().iter().map(|&old| old as u8);
    let expected = facets
        .clone()
        .map(|facet| u16::from_le_bytes([0xff, facet]));
    let stored = document.attribute(0, &bytes()).unwrap().values;
    assert_eq!(stored, Values::U16(expected.collect()));
    let expected = facets.flat_map(|facet| [f32::from_le_bytes([facet; 4]); 3]);
    let stored = document.attribute(0, &normal()).unwrap().values;
    assert_eq!(stored, Values::F32(expected.collect()));
}

#[test]
fn a_normal_that_is_no_number_is_told_when_it_is_read() {
    // That of a facet without an area is one.
    let document = open(ASCII.as_bytes(), Format::Stl);
    let normals = document.attribute(0, &normal()).unwrap().to_f32();
    assert!(normals[5].is_nan());
    let text = ASCII.replace("-1.#IND", "-1.#UP");
    let document = open(text.as_bytes(), Format::Stl);
    assert!(document.attribute(0, &position()).is_ok());
    let error = document.attribute(0, &normal()).unwrap_err();
    assert_eq!(error.place, Place::Line(9));
    assert_eq!(
        error.to_string(),
        "mesh.stl: line 9: facet 1: \"-1.#UP\" is not part of a normal: write a number. Fix it \
         there, or re-export the file"
    );
    let error = document.attribute(0, &bytes()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "mesh.stl: this mesh has no attribute attribute: take one of those that are listed"
    );
}
