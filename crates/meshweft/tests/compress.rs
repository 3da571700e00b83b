//! Documents as archives, and back.

#![cfg(feature = "files")]

#[path = "data/folder.rs"]
mod data;
#[path = "data/files.rs"]
mod files;

use meshweft::attribute::{Attribute, Semantic};
use meshweft::cache;
use meshweft::connectivity::FirstVertex;
use meshweft::files::{Document, Format, NewMesh, NewVertices, ReadOptions};
use meshweft::operations::{
    CompressError, CompressOptions, DecodedOrder, DecompressOptions, DecompressedMesh, KeepOrder,
    PositionPrecision, compress, decompress,
};
use meshweft::{CacheModel, Limits, Mesh};

/// What leaves out whatever cannot be compressed.
fn leaving_out() -> CompressOptions {
    let mut options = CompressOptions::default();
    options.first_vertex = FirstVertex::Given(0);
    options.drop_attributes = true;
    options.triangles = true;
    options
}

/// The corners of a mesh's faces by the bits of their positions, each face turned so that its least corner is first,
/// sorted.
fn corners(positions: &[[f32; 3]], faces: &[[u32; 3]]) -> Vec<[[u32; 3]; 3]> {
    let corners = faces.iter().map(|face| {
        let corners = face.map(|vertex| positions[vertex as usize].map(f32::to_bits));
        let turns = [0, 1, 2].map(|turn| [0, 1, 2].map(|corner| corners[(corner + turn) % 3]));
        turns.into_iter().min().expect("three turns")
    });
    let mut corners: Vec<_> = corners.collect();
    corners.sort_unstable();
    corners
}

#[test]
fn every_file_at_hand_comes_back_from_either_precision() {
    let Some(folder) = data::folder() else { return };
    let mut done = 0;
    for path in files::mesh_files(&folder) {
        let document = Document::open(&path, ReadOptions::default()).unwrap();
        let faces: usize = document
            .meshes()
            .iter()
            .map(|entry| entry.mesh.face_count())
            .sum();
        // The largest ones take minutes without optimisation.
        if faces > 150_000 {
            continue;
        }
        for positions in [PositionPrecision::Lossless, PositionPrecision::Bits(14)] {
            let mut options = leaving_out();
            options.positions = positions;
            let (bytes, report) = match compress(&document, &options) {
                Err(CompressError::WidePositions { .. }) => continue,
                compressed => compressed.unwrap(),
            };
            assert_eq!(report.bytes_after, bytes.len() as u64);
            let meshes = decompress(&bytes, &DecompressOptions::default()).unwrap();
            assert_eq!(meshes.len(), document.meshes().len());
            for (number, DecompressedMesh { name, mesh, .. }) in meshes.iter().enumerate() {
                let entry = &document.meshes()[number];
                assert_eq!(
                    (name, mesh.face_count()),
                    (&entry.name, entry.mesh.face_count())
                );
                if positions == PositionPrecision::Lossless {
                    let source = document.positions(number).unwrap().unwrap();
                    assert_eq!(
                        corners(mesh.positions(), mesh.faces()),
                        corners(&source, entry.mesh.faces()),
                        "{}",
                        path.display()
                    );
                }
            }
            done += 1;
        }
    }
    assert!(done > 10, "{done} files");
}

#[test]
fn what_comes_back_is_good_to_draw() {
    let Some(folder) = data::folder() else { return };
    for name in ["bunny_clean.obj.gz", "horse.obj.gz", "fandisk.off.gz"] {
        let path = folder.join("meshes").join(name);
        let document = Document::open(&path, ReadOptions::default()).unwrap();
        let (bytes, _) = compress(&document, &leaving_out()).unwrap();
        let mut options = DecompressOptions::default();
        options.order = DecodedOrder::Stored;
        let stored = decompress(&bytes, &options).unwrap().remove(0).mesh;
        options.order = DecodedOrder::Window;
        let drawn = decompress(&bytes, &options).unwrap().remove(0).mesh;
        let [before, after] = [&stored, &drawn].map(|mesh| cache::acmr(mesh, CacheModel::fifo(16)));
        assert!(before > 0.9 && after <= 0.75, "{name}: {before} {after}");

        // The same triangles, and vertices in the order of their first use.
        let of = |mesh: &Mesh| corners(mesh.positions(), mesh.faces());
        assert!(of(&stored) == of(&drawn), "{name}");
        let mut next = 0;
        for &vertex in drawn.faces().as_flattened() {
            assert!(vertex <= next, "{name}: {vertex} after {next}");
            next = next.max(vertex + 1);
        }

        // What is stored gives the same bytes again.
        let again = |mesh: &Mesh| {
            let new = [NewMesh::plain("mesh", mesh.positions(), mesh.faces())];
            let document = Document::create(Format::Glb, "made".as_ref(), &new).unwrap();
            compress(&document, &leaving_out()).unwrap().1.meshes[0].bytes
        };
        let size = bytes.len() as f64;
        assert!(((again(&stored) as f64) - size).abs() < 100.0);
        assert!(((again(&drawn) as f64) / size - 1.0).abs() < 0.05);
    }
}

/// A document of meshes by name, a square each.
fn document(format: Format, meshes: &[(&str, &[Attribute])]) -> Document {
    let faces = [[0, 1, 2], [2, 1, 3]];
    let new = meshes.iter();
    let new: Vec<_> = new
        .map(|(name, attributes)| NewMesh::new(name, NewVertices::Stored(attributes), &faces))
        .collect();
    Document::create(format, "made".as_ref(), &new).unwrap()
}

fn square(x: f32) -> Attribute {
    let positions = [
        [x, 0.0, 0.0],
        [x + 1.0, 0.0, 0.0],
        [x, 1.0, 0.3],
        [x + 1.0, 1.0, 0.3],
    ];
    Attribute::of_vertices(Semantic::Position, &positions)
}

#[test]
fn what_cannot_be_compressed_is_named_and_left_out_on_request() {
    let normals = Attribute::of_vertices(Semantic::Normal, &[[0.0, 0.0, 1.0]; 4]);
    let document = document(Format::Ply, &[("one", &[square(0.0), normals])]);
    let error = compress(&document, &CompressOptions::default()).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("NORMAL") && text.contains("drop_attributes"),
        "{text}"
    );
    compress(&document, &leaving_out()).unwrap();
}

#[test]
fn polygons_are_triangles_on_request() {
    let text = b"OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n".to_vec();
    let document =
        Document::from_bytes(text, Format::Off, "square.off".as_ref(), Limits::default()).unwrap();
    let (bytes, report) = compress(&document, &leaving_out()).unwrap();
    assert_eq!(report.meshes[0].polygons.kept, 0);
    let meshes = decompress(&bytes, &DecompressOptions::default()).unwrap();
    assert_eq!(meshes[0].polygons, None);
    assert_eq!(meshes[0].mesh.face_count(), 2);
}

#[test]
fn meshes_that_meet_still_meet_on_their_lattice() {
    let document = document(
        Format::Glb,
        &[("left", &[square(0.0)]), ("right", &[square(1.0)])],
    );
    let mut options = CompressOptions::default();
    for positions in [PositionPrecision::Bits(5), PositionPrecision::Step(0.125)] {
        options.positions = positions;
        let (bytes, report) = compress(&document, &options).unwrap();
        let meshes = decompress(&bytes, &DecompressOptions::default()).unwrap();
        let has = |mesh: &Mesh| {
            let mut points: Vec<_> = mesh
                .positions()
                .iter()
                .map(|it| it.map(f32::to_bits))
                .collect();
            points.sort_unstable();
            points
        };
        let [left, right] = [has(&meshes[0].mesh), has(&meshes[1].mesh)];
        let shared = left.iter().filter(|point| right.contains(point));
        assert_eq!(shared.count(), 2, "{:?}", report.step);
    }
    for positions in [PositionPrecision::Bits(31), PositionPrecision::Step(0.3)] {
        options.positions = positions;
        let error = compress(&document, &options).unwrap_err();
        assert!(matches!(error, CompressError::Precision(_)), "{error}");
    }
}

#[test]
fn index_buffers_are_the_same_where_the_order_is_kept() {
    let Some(folder) = data::folder() else { return };
    for name in ["fandisk.off.gz", "teapot_utah.obj.gz", "eight.off.gz"] {
        let path = folder.join("meshes").join(name);
        let document = Document::open(&path, ReadOptions::default()).unwrap();
        let mut options = leaving_out();
        options.first_vertex = FirstVertex::MinBuffer;
        options.keep_order = KeepOrder::Both;
        let (bytes, report) = compress(&document, &options).unwrap();
        assert!(report.meshes[0].sizes.order > 0.0);
        let back = decompress(&bytes, &DecompressOptions::default()).unwrap();
        let mesh = &back[0].mesh;
        assert_eq!(mesh.faces(), document.meshes()[0].mesh.faces(), "{name}");
        assert_eq!(mesh.positions(), document.positions(0).unwrap().unwrap());

        // Without the vertices, the faces are in their order, vertices by their first use.
        options.keep_order = KeepOrder::Faces;
        let (bytes, _) = compress(&document, &options).unwrap();
        let back = decompress(&bytes, &DecompressOptions::default()).unwrap();
        let positions = |mesh: &Mesh| -> Vec<_> {
            let corners = mesh.faces().as_flattened().iter();
            let position = |&vertex: &u32| mesh.positions()[vertex as usize];
            corners.map(position).collect()
        };
        assert_eq!(positions(&back[0].mesh), positions(mesh), "{name}");
    }
}

#[test]
fn limits_hold_for_all_meshes_together() {
    let document = document(
        Format::Glb,
        &[("left", &[square(0.0)]), ("right", &[square(1.0)])],
    );
    let (bytes, report) = compress(&document, &CompressOptions::default()).unwrap();
    assert!(report.to_json().contains("\"connectivity_bits_per_face\""));
    let mut options = DecompressOptions::default();
    options.limits.file_bytes = 12 * 6;
    decompress(&bytes, &options).unwrap_err();
    options.limits.file_bytes = 12 * 12;
    decompress(&bytes, &options).unwrap();
}
