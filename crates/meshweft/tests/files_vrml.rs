//! VRML files: polygons and points are permuted with all that goes by their numbers.
#![cfg(feature = "files")]
#![expect(clippy::cast_possible_truncation, reason = "test meshes are small")]

#[path = "files_vrml/broken.rs"]
mod broken;
#[path = "data/folder.rs"]
mod data;
#[path = "files_errors/mod.rs"]
mod errors;
#[path = "files_text/follow.rs"]
mod follow;
#[path = "files_vrml/plain.rs"]
mod plain;
#[path = "files_random/mod.rs"]
mod random;
#[path = "../../../fuzz/fuzz_targets/round_trip/mod.rs"]
mod round_trip;
#[path = "files_vrml/transparent.rs"]
mod transparent;
#[path = "files_vrml/values.rs"]
mod values;

use std::path::Path;

use meshweft::files::{Document, Edit, Format, Place};
use meshweft::{FaceOrder, Limits, Permutation, VertexOrder};
use plain::FaceSet;
use random::Random;

const NAME: &str = "mesh.wrl";
const BINDINGS: &str = include_str!("../../../fuzz/corpus/vrml/bindings.wrl");
const SHARING: &str = include_str!("../../../fuzz/corpus/vrml/sharing.wrl");

fn open(text: &[u8]) -> Document {
    let limits = Limits::default();
    Document::from_bytes(text.to_vec(), Format::Vrml, Path::new(NAME), limits).unwrap()
}

fn written(document: &Document) -> String {
    String::from_utf8(document.to_main_bytes().unwrap()).unwrap()
}

fn notes(text: &str) -> Vec<String> {
    let document = open(text.as_bytes());
    let notes = document.notes().iter();
    let notes = notes.map(|note| match note.place {
        Place::Line(line) => format!("{line}: {}", note.text),
        _ => note.text.clone(),
    });
    notes.collect()
}

/// The faces of `sets` in the order that was applied, resolved as a player resolves them.
fn expected(set: &FaceSet, order: &FaceOrder) -> FaceSet {
    let mut faces = Vec::new();
    for (new, &old) in order.new_to_old().iter().enumerate() {
        let mut face = set.faces[old as usize].clone();
        let rotation = usize::from(order.rotation(new));
        if !face.corners.is_empty() {
            face.corners.rotate_left(rotation);
        }
        faces.push(face);
    }
    FaceSet { faces }
}

/// Puts all face sets in random orders, twice, and compares what the plain reader sees.
fn check(text: &str, seed: u64) {
    let mut random = Random(seed);
    let mut document = open(text.as_bytes());
    assert_eq!(written(&document), text);
    let count = document.meshes().len();
    for mesh in 0..count {
        let entry = &document.meshes()[mesh];
        let stay = FaceOrder::identity(entry.record_count());
        let vertices = VertexOrder::identity(entry.mesh.vertex_count());
        document.edit(Edit::order(mesh, &stay, &vertices)).unwrap();
    }
    assert_eq!(written(&document), text, "orders that move nothing");
    for _ in 0..2 {
        let before = plain::read(&written(&document));
        let mut wanted = before.clone();
        for mesh in 0..count {
            let entry = document.meshes()[mesh].clone();
            let (order, vertices) = random.orders(&entry);
            document
                .edit(Edit::order(mesh, &order, vertices.as_ref()))
                .unwrap();
            // Entries come in the order of the file; those that stay have no entry.
            let place = before.entries[mesh];
            wanted.sets[place] = expected(&before.sets[place], &order);
        }
        let text = written(&document);
        let after = plain::read(&text);
        assert_eq!(after.sets, wanted.sets);
        assert_eq!(after.outside, before.outside, "bytes outside the lists");
        assert_eq!(after.between, before.between, "bytes between records");
        let again = open(text.as_bytes());
        assert_eq!(again.meshes(), document.meshes());
        assert_eq!(written(&again), text);
    }
}

#[test]
fn everything_goes_with_its_faces_and_vertices() {
    for seed in 1..40 {
        check(BINDINGS, seed);
    }
    let document = open(BINDINGS.as_bytes());
    assert!(document.notes().is_empty(), "{:?}", document.notes());
    let [house, second] = document.meshes() else {
        panic!("two face sets");
    };
    assert_eq!((&*house.name, &*second.name), ("House", "mesh 1"));
    // The last texture polygon has no -1.
    assert_eq!(house.runs, [0, 2]);
    assert_eq!(house.polygons, Some(vec![0, 2, 3, 4]));
    assert!(house.vertices_movable && !house.corners_turnable);
    assert!(second.vertices_movable && second.corners_turnable);
    assert_ne!(house.vertex_group, second.vertex_group);
}

#[test]
fn a_file_is_changed_to_the_byte() {
    let text = "#VRML V2.0 utf8\r\nIndexedFaceSet{coord Coordinate{point[0 0 0,,1\t0 0 # one\r\n 2 0 0,]}\r\n\
                coordIndex[0,1,2,-1 # a\n 2 +1\n0 -1]color Color{color[0 0 1 0 1 0]}colorPerVertex FALSE}#end";
    let mut document = open(text.as_bytes());
    let order = FaceOrder::new(Permutation::new(vec![1, 0]).unwrap(), vec![1, 0]).unwrap();
    let vertices = VertexOrder::from(Permutation::new(vec![1, 0, 2]).unwrap());
    document.edit(Edit::order(0, &order, &vertices)).unwrap();
    let expected = "#VRML V2.0 utf8\r\nIndexedFaceSet{coord Coordinate{point[1\t0 0,,0 0 0 # one\r\n 2 0 0,]}\r\n\
                coordIndex[0 1\n2 -1 # a\n 1,0,2,-1]color Color{color[0 1 0 0 0 1]}colorPerVertex FALSE}#end";
    assert_eq!(written(&document), expected);
}

#[test]
fn what_is_shared_stays() {
    for seed in 1..10 {
        check(SHARING, seed);
    }
    let document = open(SHARING.as_bytes());
    let stay = "the vertices stay where they are: its Coordinate is";
    assert_eq!(
        notes(SHARING),
        [
            "2: the mesh stays as it is: its coordIndex IS one of a PROTO".to_owned(),
            format!("4: {stay} named by a USE or a ROUTE"),
            format!("5: {stay} shared with another node"),
        ]
    );
    let counts = document.meshes().iter().map(|e| e.mesh.vertex_count());
    assert_eq!(counts.collect::<Vec<_>>(), [3, 2]);
}

/// A face set with two triangles, the fields of `more`, and what comes `after` it.
fn face_set(more: &str, after: &str) -> String {
    format!(
        "#VRML V2.0 utf8\nShape {{ geometry IndexedFaceSet {{\n\
         coord Coordinate {{ point [ 0 0 0, 1 0 0, 0 1 0 ] }}\n\
         coordIndex [ 0 1 2 -1 2 1 0 -1 ]\n{more} }} }}\n{after}"
    )
}

#[test]
fn every_reason_to_stay_is_said() {
    let mesh = [
        (
            "colorIndex [ 0 1 2 -1 ]",
            "its colorIndex has other faces than coordIndex",
        ),
        (
            "texCoordIndex [ 0 1 -1 1 2 1 0 -1 ]",
            "its texCoordIndex has other faces than coordIndex",
        ),
        (
            "colorPerVertex FALSE color Color { color 1 0 0 }",
            "its color goes by face and has fewer entries than there are faces",
        ),
        (
            "colorPerVertex FALSE colorIndex 0",
            "its colorIndex goes by face and has fewer entries than there are faces",
        ),
        (
            "colorPerVertex FALSE colorIndex [ 0 -1 ]",
            "its colorIndex goes by face and has other entries",
        ),
        (
            "normalPerVertex FALSE normal DEF N Normal { vector [ 0 0 1 0 0 1 ] } } } Shape { geometry ElevationGrid { normal USE N",
            "its normal goes by face and is shared with another node",
        ),
        ("coordIndex 0", "it has two fields coordIndex"),
        (
            "texCoordIndex [] texCoordIndex []",
            "it has two fields texCoordIndex",
        ),
        ("coord NULL", "it has two fields coord"),
        ("coord USE Nothing", "it has two fields coord"),
        (
            "normal Normal { vector IS x }",
            "its normal holds more than a list of numbers",
        ),
        (
            "normal Normals { vector [] }",
            "it contains a node of type \"Normals\"",
        ),
        ("skin [ 1 2 ]", "its field \"skin\" may go by numbers"),
        ("colorPerVertex IS x", "a field IS one of a PROTO"),
        ("ccw IS x", "it contains IS"),
        (
            "} Script { field SFNode n NULL",
            "a Script that is handed nodes may read it by number",
        ),
    ];
    for (more, why) in mesh {
        let text = face_set(more, "");
        assert_eq!(notes(&text), [format!("2: the mesh stays as it is: {why}")]);
        assert!(open(text.as_bytes()).meshes().is_empty());
        check(&text, 3);
    }
    let vertices = [
        (
            "color Color { color [ 1 0 0 0 1 0 ] }",
            "its color goes by vertex and has another number of entries",
        ),
        (
            "color USE C",
            "its color goes by vertex and is shared with another node",
        ),
        (
            "texCoord DEF T TextureCoordinate { point [ 0 0 1 1 2 2 ] }",
            "its texCoord goes by vertex and is shared with another node",
        ),
    ];
    for (more, why) in vertices {
        let text = face_set(more, "ROUTE a.x TO T . point");
        let expected = format!("2: the vertices stay where they are: {why}");
        assert_eq!(notes(&text), [expected]);
        check(&text, 3);
    }
    let whole = |text: &str| notes(&format!("#VRML V2.0 utf8\n{text}"));
    assert_eq!(
        whole(
            "DEF F IndexedFaceSet { coord Coordinate { point 0 0 0 } coordIndex 0 } ROUTE a.b TO F.set_coordIndex"
        ),
        ["2: the mesh stays as it is: a ROUTE may replace its fields"]
    );
    assert_eq!(
        whole(
            "PROTO P [ ] { IndexedFaceSet { coord Coordinate { point 0 0 0 } coordIndex [0 -1 0 -1] } }"
        ),
        ["2: the vertices stay where they are: it stands in a PROTO"]
    );
    assert_eq!(
        whole(
            "IndexedFaceSet { coord Coordinate { point 0 0 0 } coordIndex [ 0 -1 -1 ] normal Normal { vector [ 0 0 1 0 0 1 ] } normalPerVertex FALSE }"
        ),
        [
            "2: the mesh stays as it is: its normal goes by face, and there are faces without corners"
        ]
    );
    assert_eq!(
        whole("IndexedFaceSet { coord NULL coordIndex 0 }"),
        ["2: the mesh stays as it is: it has no coord"]
    );
    // A name given again within a PROTO is another one.
    let shadow = "Group { children [ DEF C Coordinate { point 0 0 0 } ] }\n\
                  PROTO P [ ] { IndexedFaceSet { coord USE C coordIndex 0 } }\n";
    assert_eq!(
        whole(shadow),
        ["3: the mesh stays as it is: no Coordinate above it has the name of its coord"]
    );
    for nothing in ["", "Group { }", "IndexedFaceSet { }"] {
        assert_eq!(whole(nothing), ["no faces: there is nothing to order"]);
    }
}

#[test]
fn the_real_file_keeps_its_faces() {
    let Some(folder) = data::folder() else { return };
    let path = folder.join("meshes/sextant.wrl.gz");
    let document = Document::open(&path, Limits::default()).unwrap();
    let total = |count: fn(&meshweft::files::MeshEntry) -> usize| {
        document.meshes().iter().map(count).sum::<usize>()
    };
    let counts = [
        total(|e| e.mesh.vertex_count()),
        total(|e| e.mesh.face_count()),
        total(|e| e.record_count()),
    ];
    // 116 more vertices are of face sets without faces.
    assert_eq!(counts, [2993 - 116, 3920, 1989]);
    assert!(document.notes().is_empty());
    assert!(document.meshes().iter().all(|entry| entry.vertices_movable));
    check(&written(&document), 1);
    eprintln!("1 file read, permuted and compared; none skipped");
}
