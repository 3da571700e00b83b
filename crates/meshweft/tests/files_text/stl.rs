//! STL: facets move with their normals and attributes, within their solid.

use meshweft::files::{Edit, Format};
use meshweft::{FaceOrder, Permutation};

use super::{check, entry_of, open, round_trip, written};

/// Two solids, a name in no known encoding, words on lines of all kinds.
pub(crate) const ASCII: &str = "solid  first thing \r\n facet normal 0 0 1\r\n  outer loop\r\n\
    vertex 0 0 0\r\n    vertex 1e0 0 0\r\n    vertex 0 1 0\r\n  endloop\r\n endfacet\r\n\
 FACET Normal 0 0 -1.#IND outer loop vertex 0.0 0 0 vertex\t0 1\t 0 vertex -1 0\n\n0 EndLoop\rendfacet\n\
 facet normal 0 0 1 outer loop vertex 1 0 0 vertex 1 1 0 vertex 0 1 0 endloop endfacet endsolid first\n\
solid\nendsolid\nSolid ü\nfacet normal 0 0 1 outer loop vertex nan 0 0 vertex -0 1 0 vertex 0 1 0 endloop endfacet\n\
facet normal 0 0 1 outer loop vertex nan 0 0 vertex -0 1 0 vertex 0 1 .5e-3 endloop endfacet\nENDSOLID\n";

/// A binary file of `count` facets whose header starts with `header`.
pub(crate) fn binary(header: &str, count: u32, tail: &[u8]) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend(count.to_le_bytes());
    for facet in 0..count {
        bytes.extend([facet as u8; 12]);
        for corner in 0..3 {
            let coordinate = ((facet + corner) / 2) as f32;
            let position = [coordinate, -0.0, f32::NAN].map(f32::to_le_bytes);
            bytes.extend(position.concat());
        }
        bytes.extend([0xff, facet as u8]);
    }
    bytes.extend(tail);
    bytes
}

#[test]
fn facets_of_ascii_move_within_their_solid() {
    for seed in 1..40 {
        check(ASCII.as_bytes(), Format::Stl, seed);
    }
    let entry = entry_of(ASCII.as_bytes(), Format::Stl);
    assert_eq!(entry.name, "first thing");
    assert_eq!(entry.runs, [0, 3]);
    assert!(entry.corners_turnable && !entry.vertices_movable);
    assert!(entry.polygons.is_none());
    // 0 0 0 is one vertex however it is written, 0 and -0 are two.
    assert_eq!(entry.mesh.vertex_count(), 8);
}

#[test]
fn facets_of_binary_move_with_their_attributes() {
    for header in ["made by hand", "solid made by hand", "solid\nfacet\0"] {
        for tail in [&b""[..], b"tail"] {
            let bytes = binary(header, 9, tail);
            for seed in 1..10 {
                check(&bytes, Format::Stl, seed);
            }
            let entry = entry_of(&bytes, Format::Stl);
            assert_eq!((entry.mesh.vertex_count(), entry.record_count()), (6, 9));
        }
    }
}

#[test]
fn corners_are_turned_by_exchanging_positions() {
    let text = "solid\nfacet normal 7 8 9 outer loop vertex 0 0\t0 vertex 1 0 0\nvertex 2.50 0 0 endloop endfacet endsolid";
    let mut document = open(text.as_bytes(), Format::Stl);
    let order = FaceOrder::new(Permutation::identity(1), vec![1]).unwrap();
    document.edit(Edit::order(0, &order, None)).unwrap();
    let expected = "solid\nfacet normal 7 8 9 outer loop vertex 1 0 0 vertex 2.50 0 0\nvertex 0 0\t0 endloop endfacet endsolid";
    assert_eq!(String::from_utf8(written(&document)).unwrap(), expected);
}

#[test]
fn a_solid_of_one_facet_is_whole() {
    for text in ["solid", "", "facet normal"] {
        round_trip::check(text.as_bytes(), Format::Stl, "mesh.stl");
    }
    let empty = open(b"solid\nendsolid", Format::Stl);
    assert!(empty.meshes().is_empty());
    assert_eq!(empty.notes()[0].text, "no faces: there is nothing to order");
}
