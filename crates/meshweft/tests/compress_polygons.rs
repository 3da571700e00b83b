//! Polygons of documents through archives.

#![cfg(feature = "files")]

#[path = "data/folder.rs"]
mod data;
#[path = "data/files.rs"]
mod files;

use std::collections::BTreeMap;

use meshweft::Limits;
use meshweft::connectivity::FirstVertex;
use meshweft::files::{Document, Format, MeshEntry, NewMesh, ReadOptions};
use meshweft::operations::{
    CompressOptions, DecodedOrder, DecompressOptions, DecompressedMesh, KeepOrder, PolygonCounts,
    compress, decompress,
};

fn options() -> CompressOptions {
    let mut options = CompressOptions::default();
    options.first_vertex = FirstVertex::Given(0);
    options.drop_attributes = true;
    options
}

/// The corners of each polygon, and where its faces start.
fn polygons(faces: &[[u32; 3]], starts: Option<&[u32]>) -> Vec<Vec<u32>> {
    let each: Vec<u32> = (0..=u32::try_from(faces.len()).unwrap()).collect();
    let ends = starts.unwrap_or(&each).windows(2);
    let polygon = |ends: &[u32]| {
        let fan = &faces[ends[0] as usize..ends[1] as usize];
        let mut corners = vec![fan[0][0], fan[0][1]];
        for face in fan {
            assert_eq!([face[0], face[1]], [corners[0], corners[corners.len() - 1]]);
            corners.push(face[2]);
        }
        corners
    };
    ends.map(polygon).collect()
}

/// Polygons by the positions of their corners, each begun with the least corner that it can begin with, sorted.
fn by_position(positions: &[[f32; 3]], polygons: &[Vec<u32>]) -> Vec<Vec<[u32; 3]>> {
    let cyclic = |polygon: &Vec<u32>| {
        let corner = |&vertex: &u32| positions[vertex as usize].map(f32::to_bits);
        let corners: Vec<_> = polygon.iter().map(corner).collect();
        let turns = 0..corners.len();
        let turned = turns.map(|turn| [&corners[turn..], &corners[..turn]].concat());
        turned.min().unwrap()
    };
    let mut all: Vec<_> = polygons.iter().map(cyclic).collect();
    all.sort_unstable();
    all
}

/// All files at hand that have polygons.
fn documents() -> Vec<(String, Document)> {
    let Some(folder) = data::folder() else {
        return Vec::new();
    };
    let mut documents = Vec::new();
    for path in files::mesh_files(&folder) {
        let document = Document::open(&path, ReadOptions::default()).unwrap();
        if document.meshes().iter().any(|mesh| mesh.polygons.is_some()) {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            documents.push((name, document));
        }
    }
    assert!(documents.len() > 5, "{} files", documents.len());
    documents
}

/// The polygons of a mesh of a file; those that are stored as their triangles, cut.
fn expected(entry: &MeshEntry) -> Vec<Vec<u32>> {
    // The faces at each edge with two vertices, by whether they go up.
    let mut at_edge: BTreeMap<[u32; 2], [usize; 2]> = BTreeMap::new();
    let is_flat = |&[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
    for &[a, b, c] in entry.mesh.faces().iter().filter(|face| !is_flat(face)) {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let counts = at_edge.entry([from.min(to), from.max(to)]).or_default();
            counts[usize::from(from < to)] += 1;
        }
    }
    let mut all = Vec::new();
    for corners in polygons(entry.mesh.faces(), entry.polygons.as_deref()) {
        let triangles: Vec<[u32; 3]> = (2..corners.len())
            .map(|last| [corners[0], corners[last - 1], corners[last]])
            .collect();
        let is_plain = |&corner: &u32| {
            let edge = [corner.min(corners[0]), corner.max(corners[0])];
            at_edge.get(&edge) == Some(&[1, 1])
        };
        let diagonals = &corners[2..corners.len() - 1];
        match diagonals.is_empty()
            || (diagonals.iter().all(is_plain) && !triangles.iter().any(is_flat))
        {
            true => all.push(corners),
            false => all.extend(triangles.iter().map(|triangle| triangle.to_vec())),
        }
    }
    all
}

/// How many polygons of more than three corners there are.
fn larger(polygons: &[Vec<u32>]) -> usize {
    polygons.iter().filter(|corners| corners.len() > 3).count()
}

#[test]
fn the_polygons_of_every_file_at_hand_come_back() {
    for (name, document) in documents() {
        let (bytes, report) = compress(&document, &options()).unwrap();
        let (mut kept, mut bits) = (0, 0.0);
        for order in [DecodedOrder::Source, DecodedOrder::Stored] {
            let mut options = DecompressOptions::default();
            options.order = order;
            let meshes = decompress(&bytes, &options).unwrap();
            for (number, decoded) in meshes.iter().enumerate() {
                let entry = &document.meshes()[number];
                let positions = document.positions(number).unwrap().unwrap();
                let DecompressedMesh {
                    mesh,
                    polygons: starts,
                    ..
                } = decoded;
                let found = polygons(mesh.faces(), starts.as_deref());
                let (found_there, expected) =
                    (by_position(mesh.positions(), &found), expected(entry));
                assert!(found_there == by_position(&positions, &expected), "{name}");

                // What the report says.
                let counts = report.meshes[number].polygons;
                assert_eq!(counts.kept, larger(&found), "{name}");
                let source = polygons(entry.mesh.faces(), entry.polygons.as_deref());
                assert_eq!(counts.kept + counts.cut, larger(&source), "{name}");
                kept += counts.kept;
                bits += report.meshes[number].sizes.polygons * 8.0;
            }
        }
        println!(
            "{name}: {} polygons, {:.2} bits each",
            kept / 2,
            bits / kept.max(1) as f64
        );
    }
}

#[test]
fn polygons_come_back_corner_by_corner_where_the_order_is_kept() {
    for (name, document) in documents() {
        let mut options = options();
        options.keep_order = KeepOrder::Both;
        let (bytes, report) = compress(&document, &options).unwrap();
        let meshes = decompress(&bytes, &DecompressOptions::default()).unwrap();
        for (number, decoded) in meshes.iter().enumerate() {
            let entry = &document.meshes()[number];
            assert_eq!(decoded.mesh.faces(), entry.mesh.faces(), "{name}");
            let found = polygons(decoded.mesh.faces(), decoded.polygons.as_deref());
            assert_eq!(found, expected(entry), "{name}");
            if report.meshes[number].polygons.cut == 0 && decoded.polygons.is_some() {
                assert_eq!(decoded.polygons, entry.polygons, "{name}");
            }
        }
    }
}

#[test]
fn the_stored_order_with_its_polygons_has_the_same_bytes_again() {
    for (name, document) in documents() {
        let (bytes, report) = compress(&document, &options()).unwrap();
        let mut order = DecompressOptions::default();
        order.order = DecodedOrder::Stored;
        let decoded = decompress(&bytes, &order).unwrap().remove(0);
        let mut new = NewMesh::plain(
            &decoded.name,
            decoded.mesh.positions(),
            decoded.mesh.faces(),
        );
        if let Some(starts) = &decoded.polygons {
            new = new.with_polygons(starts);
        }
        let again = Document::create(Format::Obj, "made".as_ref(), &[new]).unwrap();
        let (again, report_again) = compress(&again, &options()).unwrap();
        assert_eq!(
            report_again.meshes[0].bytes, report.meshes[0].bytes,
            "{name}"
        );
        if document.meshes().len() == 1 {
            assert_eq!(again.len(), bytes.len(), "{name}");
        }
    }
}

#[test]
fn triangles_are_all_that_is_stored_on_request() {
    for (name, document) in documents().into_iter().take(3) {
        let mut triangles = options();
        triangles.triangles = true;
        let (bytes, report) = compress(&document, &triangles).unwrap();
        assert_eq!(report.meshes[0].polygons, PolygonCounts::default());
        let meshes = decompress(&bytes, &DecompressOptions::default()).unwrap();
        assert!(meshes.iter().all(|mesh| mesh.polygons.is_none()), "{name}");

        // Or given.
        let (bytes, _) = compress(&document, &options()).unwrap();
        let mut options = DecompressOptions::default();
        options.triangles = true;
        assert_eq!(decompress(&bytes, &options).unwrap(), meshes, "{name}");
    }
}

#[test]
fn faces_of_two_corners_are_left_out_on_request_only() {
    let text = b"OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n2 0 1\n".to_vec();
    let document =
        Document::from_bytes(text, Format::Off, "square.off".as_ref(), Limits::default()).unwrap();
    let error = compress(&document, &options()).unwrap_err();
    assert!(
        error.to_string().contains("fewer than three corners"),
        "{error}"
    );
    let mut options = options();
    options.triangles = true;
    compress(&document, &options).unwrap();
}
