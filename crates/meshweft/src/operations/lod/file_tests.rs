//! Documents that become `.mwl` files, and meshes taken from these.

use std::io::Cursor;
use std::path::Path;

use super::build::{LodBuildOptions, lod_build};
use super::extract::{ExtractedMesh, LodDetail, LodExtractOptions, lod_extract};
use super::options::LodError;
use crate::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use crate::files::{Document, Format, NewMesh, NewVertices, ReadOptions};
use crate::geometry::normalized;
use crate::lod::Camera;
use crate::lod::fast_mesh::{Front, VertexHierarchy};

/// Waves over a square, with normals and colours; `start` is where it begins.
fn waves(start: f32) -> (Vec<Attribute>, Vec<[u32; 3]>) {
    let side = 24;
    let place = |i: u32| [i % (side + 1), i / (side + 1)].map(|at| at as f32 / 4.0);
    let all = || (0..(side + 1) * (side + 1)).map(place);
    let positions = all().map(|[x, y]| [start + x, y, (2.1 * x).sin() * (1.7 * y).cos()]);
    let positions: Vec<[f32; 3]> = positions.collect();
    let normals: Vec<_> = all()
        .map(|[x, y]| normalized([x.cos(), y.sin(), 1.0]))
        .collect();
    let mut info = AttributeInfo::new(Semantic::Color(0), Domain::Vertex, 4, ComponentType::U8);
    info.is_normalized = true;
    let red = |x: f32| if x < 3.0 { 255 } else { 0 };
    let colors = all().flat_map(|[x, _]| [red(x), 10, 20, 255]);
    let attributes = vec![
        Attribute::of_vertices(Semantic::Position, &positions),
        Attribute::of_vertices(Semantic::Normal, &normals),
        Attribute::new(info, Values::U8(colors.collect())),
    ];
    let cell = |i: u32| {
        let corner = i / side * (side + 1) + i % side;
        let above = corner + side + 1;
        [[corner, above, corner + 1], [corner + 1, above, above + 1]]
    };
    (attributes, (0..side * side).flat_map(cell).collect())
}

fn document(format: Format, meshes: &[(&[Attribute], &[[u32; 3]])]) -> Document {
    let new = meshes
        .iter()
        .map(|(attributes, faces)| NewMesh::new("waves", NewVertices::Stored(attributes), faces));
    Document::create(format, Path::new("waves"), &new.collect::<Vec<_>>()).unwrap()
}

fn extract(bytes: &[u8], detail: LodDetail) -> Result<ExtractedMesh, LodError> {
    let options = LodExtractOptions::new(detail);
    lod_extract(Cursor::new(bytes), Path::new("waves.mwl"), &options)
}

/// What stands at the corners of each face, from the least one on; sorted.
fn corners(attributes: &[Attribute], faces: &[[u32; 3]]) -> Vec<[Vec<u8>; 3]> {
    let columns: Vec<_> = attributes
        .iter()
        .map(|it| (it.values.to_le_bytes(), it.len()))
        .collect();
    let row = |vertex: u32| {
        let parts = columns.iter().map(|(bytes, len)| {
            let size = bytes.len() / len;
            bytes[vertex as usize * size..][..size].to_vec()
        });
        parts.collect::<Vec<_>>().concat()
    };
    let mut all: Vec<[Vec<u8>; 3]> = faces
        .iter()
        .map(|face| {
            let mut corners = face.map(row);
            let least = (0..3).min_by_key(|&slot| corners[slot].clone()).unwrap();
            corners.rotate_left(least);
            corners
        })
        .collect();
    all.sort_unstable();
    all
}

#[test]
fn all_detail_is_the_mesh_with_its_attributes() {
    let (attributes, faces) = waves(0.0);
    for format in [Format::Ply, Format::Glb] {
        let document = document(format, &[(&attributes, &faces)]);
        let (bytes, report) = lod_build(&document, &LodBuildOptions::default()).unwrap();
        assert_eq!((report.vertices, report.faces), (625, 1152));
        assert_eq!(report.attributes.len(), 2);
        let found = extract(&bytes, LodDetail::Error(0.0)).unwrap();
        assert_eq!(found.report.error, 0.0);
        assert_eq!(found.report.bytes_read, bytes.len() as u64);
        assert_eq!(found.name, document.meshes()[0].name);
        let mut stored = vec![attributes[0].clone()];
        let infos = found.report.attributes.iter();
        stored.extend(infos.map(|info| document.attribute(0, info).unwrap()));
        assert_eq!(stored.len(), 3);
        let is_same = corners(&found.attributes, found.mesh.faces()) == corners(&stored, &faces);
        assert!(is_same, "{format}");

        // It can be a file again, and that the same hierarchy.
        let mesh = (&found.attributes[..], found.mesh.faces());
        let again = self::document(format, &[mesh]);
        let (again, _) = lod_build(&again, &LodBuildOptions::default()).unwrap();
        let back = extract(&again, LodDetail::Error(0.0)).unwrap();
        assert!(corners(&back.attributes, back.mesh.faces()) == corners(&stored, &faces));
    }
}

#[test]
fn coarse_meshes_have_vertices_of_the_input() {
    let (attributes, faces) = waves(0.0);
    let document = document(Format::Glb, &[(&attributes, &faces)]);
    let (bytes, report) = lod_build(&document, &LodBuildOptions::default()).unwrap();
    let rows = corners(&attributes, &faces).concat();
    let check = |found: &ExtractedMesh| {
        let mut stored: Vec<Attribute> = vec![attributes[0].clone()];
        let infos = found.report.attributes.iter();
        stored.extend(infos.map(|info| document.attribute(0, info).unwrap()));
        let mut known = corners(&stored, &faces).concat();
        known.sort_unstable();
        for row in corners(&found.attributes, found.mesh.faces()).concat() {
            assert!(known.binary_search(&row).is_ok());
        }
        let used: std::collections::BTreeSet<_> =
            found.mesh.faces().as_flattened().iter().collect();
        assert_eq!(used.len(), found.mesh.vertex_count());
        assert_eq!(found.report.faces, found.mesh.face_count());
    };
    assert_eq!(rows.len(), 3 * faces.len());

    // By an error.
    let mut before = 0;
    for error in [10.0, 0.3, 0.05] {
        let found = extract(&bytes, LodDetail::Error(error)).unwrap();
        check(&found);
        assert!(f64::from(found.report.error) <= error);
        assert!(found.mesh.face_count() >= before);
        before = found.mesh.face_count();
    }
    assert!(before < faces.len());

    // By a number, no more and few less.
    for most in [report.roots + 20, 200, 400] {
        let found = extract(&bytes, LodDetail::Vertices(most)).unwrap();
        check(&found);
        let vertices = found.mesh.vertex_count();
        assert!(
            vertices <= most && vertices + 20 >= most,
            "{vertices} of {most}"
        );
    }
    let all = extract(&bytes, LodDetail::Vertices(625)).unwrap();
    assert_eq!(all.mesh.face_count(), faces.len());
    let error = extract(&bytes, LodDetail::Vertices(report.roots - 1)).unwrap_err();
    let expected = format!(
        "waves.mwl: there is no mesh of {} vertices or fewer: the coarsest has {1}, so give {1} or more",
        report.roots - 1,
        report.roots
    );
    assert_eq!(error.to_string(), expected);

    // By a camera, as a front has it.
    let camera = Camera {
        eye: [3.0, 3.0, 9.0],
        target: [2.0, 3.0, 0.0],
        up: [0.0, 1.0, 0.0],
        field_of_view: 30.0,
        size: [300, 200],
    };
    let tolerance = 4.0;
    let found = extract(&bytes, LodDetail::Camera { camera, tolerance }).unwrap();
    check(&found);
    let hierarchy = VertexHierarchy::from_bytes(&bytes, crate::Limits::default()).unwrap();
    let mut front = Front::new(hierarchy);
    front.update(&camera.view(tolerance).unwrap(), 1.0);
    assert_eq!(found.mesh.face_count(), front.face_count());
    assert!(front.face_count() < faces.len());
}

#[test]
fn several_meshes_keep_what_all_have() {
    let (first, faces) = waves(0.0);
    let (second, _) = waves(6.0);
    let both = [(&first[..], &faces[..]), (&second, &faces)];
    let glb = document(Format::Glb, &both);
    let error = lod_build(&glb, &LodBuildOptions::default())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("the file also has 2 meshes, which become one. Leave"),
        "{error}"
    );
    let options = LodBuildOptions {
        drop_attributes: true,
        ..LodBuildOptions::default()
    };
    let (bytes, report) = lod_build(&glb, &options).unwrap();
    assert_eq!((report.faces, report.meshes), (2304, 2));
    let found = extract(&bytes, LodDetail::Error(0.0)).unwrap();
    assert_eq!((found.attributes.len(), found.name.as_str()), (3, ""));
    let infos = found.report.attributes.iter();
    let joined: Vec<[Vec<u8>; 3]> = (0..2)
        .flat_map(|mesh| {
            let mut stored = vec![both[mesh].0[0].clone()];
            stored.extend(infos.clone().map(|info| glb.attribute(mesh, info).unwrap()));
            corners(&stored, &faces)
        })
        .collect();
    let mut joined = joined;
    joined.sort_unstable();
    assert!(corners(&found.attributes, found.mesh.faces()) == joined);

    // What one of them does not have, none keeps; the others are kept.
    let glb = document(Format::Glb, &[(&first, &faces), (&second[..2], &faces)]);
    let error = lod_build(&glb, &LodBuildOptions::default())
        .unwrap_err()
        .to_string();
    assert!(error.contains("also stores COLOR_0;"), "{error}");
    let (bytes, report) = lod_build(&glb, &options).unwrap();
    let names = |infos: &[AttributeInfo]| -> Vec<String> {
        infos.iter().map(|it| it.semantic.to_string()).collect()
    };
    assert_eq!(names(&report.attributes), ["NORMAL"]);
    let found = extract(&bytes, LodDetail::Error(1.0)).unwrap();
    let found: Vec<AttributeInfo> = found.attributes.into_iter().map(|it| it.info).collect();
    assert_eq!(names(&found), ["POSITION", "NORMAL"]);

    // Positions alone, if asked for.
    let options = LodBuildOptions {
        positions_only: true,
        ..LodBuildOptions::default()
    };
    let plain = lod_build(&document(Format::Glb, &both[..1]), &options)
        .unwrap()
        .1;
    assert_eq!((plain.attributes.len(), plain.vertices), (0, 625));
}

#[test]
fn primitives_that_share_vertices_have_their_own() {
    let text = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAACAPwAAgD8AAAAAAAABAAIAAQADAAIA"}],
        "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
            {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},
            {"bufferView":1,"byteOffset":6,"componentType":5123,"count":3,"type":"SCALAR"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0,"_PLACE":0},"indices":1},{"attributes":{"POSITION":0,"_PLACE":0},"indices":2}]}],
        "nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0}"#;
    let name = Path::new("two.gltf");
    let gltf =
        Document::from_bytes(text.into(), Format::Gltf, name, ReadOptions::default()).unwrap();
    let options = LodBuildOptions {
        drop_attributes: true,
        ..LodBuildOptions::default()
    };
    let (bytes, report) = lod_build(&gltf, &options).unwrap();
    assert_eq!(
        (report.faces, report.vertices, report.attributes.len()),
        (2, 4, 1)
    );
    let found = extract(&bytes, LodDetail::Error(0.0)).unwrap();
    let places = found.attributes[1].to_f32();
    assert_eq!(places, found.mesh.positions().as_flattened());
}

#[test]
fn what_is_asked_for_is_checked() {
    let (attributes, faces) = waves(0.0);
    let document = document(Format::Ply, &[(&attributes[..1], &faces)]);
    let (bytes, _) = lod_build(&document, &LodBuildOptions::default()).unwrap();
    let error = |detail| extract(&bytes, detail).unwrap_err().to_string();
    let expected = "error -1: give a length in units of the positions, 0 for all detail";
    assert_eq!(error(LodDetail::Error(-1.0)), expected);
    assert!(error(LodDetail::Error(f64::NAN)).starts_with("error NaN"));
    let camera = Camera {
        eye: [0.0; 3],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        field_of_view: 45.0,
        size: [9, 9],
    };
    let blind = |tolerance| error(LodDetail::Camera { camera, tolerance });
    assert!(blind(0.0).starts_with("tolerance 0: give a number of pixels"));
    assert!(blind(1.0).starts_with("frame 0: the camera has no direction"));

    let mut options = LodExtractOptions::new(LodDetail::Error(0.0));
    options.limits.file_bytes = 100;
    let long = lod_extract(Cursor::new(&bytes), Path::new("a.mwl"), &options).unwrap_err();
    let expected = format!(
        "a.mwl: {} bytes, more than the limit of 100: raise limits.file_bytes",
        bytes.len()
    );
    assert_eq!(long.to_string(), expected);
    let mut damaged = bytes;
    let last = damaged.len() - 1;
    damaged[last] ^= 1;
    let error = extract(&damaged, LodDetail::Error(0.0))
        .unwrap_err()
        .to_string();
    assert!(error.starts_with("waves.mwl: byte "), "{error}");
    assert!(
        error.contains("the file is damaged: copy it again"),
        "{error}"
    );
}
