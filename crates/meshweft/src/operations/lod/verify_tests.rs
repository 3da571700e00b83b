//! What is measured, against loops over all triangles.

use std::io::Cursor;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::options::LodError;
use super::paths::CameraPath;
use super::source::LodSource;
use super::stored_walk_tests::{bumpy, bytes_of};
use super::verify::lod_verify;
use super::verify_options::LodVerifyOptions;
use super::verify_report::LodVerifyReport;
use super::walk_tests::{from_obj, hills};
use crate::files::Document;
use crate::limits::Limits;
use crate::lod::Camera;
use crate::lod::fast_mesh::{FastMesh, Front};
use crate::mesh::Mesh;
use crate::progress::Progress;

type Vector = [f64; 3];

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn product(a: Vector, b: Vector) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn outer(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn length(a: Vector) -> f64 {
    product(a, a).sqrt()
}

/// How far a point is from a triangle: from its plane above the inside, else from the nearest side.
fn distance(point: Vector, corners: [Vector; 3]) -> f64 {
    let normal = outer(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    let is_inside = (0..3).all(|i| {
        let side = minus(corners[(i + 1) % 3], corners[i]);
        product(outer(side, minus(point, corners[i])), normal) > 0.0
    });
    if is_inside {
        return product(minus(point, corners[0]), normal).abs() / length(normal);
    }
    let to_side = |i: usize| {
        let side = minus(corners[(i + 1) % 3], corners[i]);
        let way = minus(point, corners[i]);
        let part = (product(way, side) / product(side, side)).clamp(0.0, 1.0);
        length(minus(way, side.map(|x| x * part)))
    };
    (0..3).map(to_side).fold(f64::INFINITY, f64::min)
}

/// Faces, turned ones, and the error of each vertex in pixels.
struct Naive {
    faces: usize,
    turned: usize,
    pixels: Vec<f64>,
}

/// The same as is measured, without a tree, a point or a normal of the library's.
fn naive(mesh: &Mesh, front: &Front, camera: &Camera) -> Naive {
    let place = |vertex: u32| mesh.positions()[vertex as usize].map(f64::from);
    let mut normals = vec![[0.0; 3]; mesh.vertex_count()];
    for face in mesh.faces() {
        let [a, b, c] = face.map(place);
        let area = outer(minus(b, a), minus(c, a));
        for vertex in face {
            let sum = &mut normals[*vertex as usize];
            *sum = [0, 1, 2].map(|i| sum[i] + area[i]);
        }
    }
    for normal in &mut normals {
        *normal = normal.map(|x| x / length(*normal));
    }

    let sources = front.hierarchy().source_vertices();
    let faces: Vec<[u32; 3]> = front
        .faces()
        .map(|(_, face)| face.map(|vertex| sources[vertex as usize]))
        .collect();
    let is_turned = |face: &&[u32; 3]| {
        let [a, b, c] = face.map(place);
        let area = outer(minus(b, a), minus(c, a));
        let parts = face.map(|vertex| product(area, normals[vertex as usize]));
        parts.iter().sum::<f64>() < 0.0
    };

    // A picture whose sides are seen under the angles that the camera says.
    let ahead = minus(camera.target, camera.eye);
    let right = outer(ahead, camera.up);
    let up = outer(right, ahead);
    let [width, height] = camera.size.map(f64::from);
    let tall = (camera.field_of_view / 2.0).to_radians().tan();
    let mut pixels = Vec::new();
    for vertex in 0..u32::try_from(mesh.vertex_count()).unwrap() {
        let way = minus(place(vertex), camera.eye);
        let depth = product(way, ahead) / length(ahead);
        let x = product(way, right) / length(right) / depth / (tall * width / height);
        let y = product(way, up) / length(up) / depth / tall;
        let is_shown = depth > 0.0 && x.abs() <= 1.0 && y.abs() <= 1.0;
        if is_shown && product(normals[vertex as usize], way) < 0.0 {
            let off = faces
                .iter()
                .map(|face| distance(place(vertex), face.map(place)));
            let off = off.fold(f64::INFINITY, f64::min);
            pixels.push(off / length(way) * height / (2.0 * tall));
        }
    }
    pixels.sort_by(f64::total_cmp);
    Naive {
        faces: faces.len(),
        turned: faces.iter().filter(is_turned).count(),
        pixels,
    }
}

fn verify(document: &Document, options: &LodVerifyOptions) -> LodVerifyReport {
    lod_verify(document, options, &()).unwrap()
}

#[test]
fn errors_are_those_of_all_triangles() {
    let document = bumpy();
    let positions = document.positions(0).unwrap().unwrap();
    let mesh = Mesh::new(positions, document.meshes()[0].mesh.faces().to_vec()).unwrap();
    let hierarchy = FastMesh::default().build(&mesh, &[]).unwrap();
    let ball = hierarchy.ball().unwrap();
    let mut seen = Vec::new();
    for path in [CameraPath::Circle, CameraPath::Fly] {
        for tolerance in [1.0, 20.0] {
            let options = LodVerifyOptions {
                path: path.clone(),
                frames: Some(2),
                size: [400, 300],
                tolerance,
                ..LodVerifyOptions::default()
            };
            let report = verify(&document, &options);
            assert_eq!(report.frames.len(), 2);
            let mut all = Vec::new();
            for (number, frame) in report.frames.iter().enumerate() {
                let camera = path.camera(ball, number, 2, options.size);
                let mut front = Front::new(hierarchy.clone());
                front.update(&camera.view(tolerance).unwrap(), 1.0);
                let found = naive(&mesh, &front, &camera);
                assert_eq!((frame.number, frame.faces), (number, found.faces));
                assert_eq!(frame.vertices, front.vertex_count());
                assert_eq!(frame.turned_faces, found.turned);
                assert_eq!(frame.errors.seen, found.pixels.len());
                let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * (1.0 + b);
                let worst = found.pixels.last().unwrap() / tolerance;
                assert!(
                    near(frame.errors.worst, worst),
                    "{} {worst}",
                    frame.errors.worst
                );
                let within = found.pixels.iter().filter(|&&it| it <= tolerance).count();
                assert_eq!(frame.errors.within, within);
                let p999 = found.pixels[found.pixels.len() - 1 - found.pixels.len() / 1000];
                assert!(near(frame.errors.p999, p999 / tolerance));
                all.extend(found.pixels);
            }
            assert_eq!(report.errors.seen, all.len());
            seen.push(all.len());
        }
    }
    assert!(seen.iter().all(|&it| it > 100), "{seen:?}");
}

#[test]
fn a_file_is_measured_as_its_mesh_is() {
    for document in [hills(), bumpy()] {
        let bytes = bytes_of(&document);
        for hysteresis in [1.0, 0.5] {
            let options = LodVerifyOptions {
                path: CameraPath::Fly,
                tolerance: 5.0,
                hysteresis,
                ..LodVerifyOptions::default()
            };
            let expected = verify(&document, &options);
            let cursor = Cursor::new(bytes.clone());
            let source = LodSource::stored(Path::new("a.mwl"), cursor, Limits::default());
            let found = lod_verify(source.unwrap(), &options, &()).unwrap();
            assert_eq!(found.frames, expected.frames);
            assert_eq!((found.errors, found.mesh), (expected.errors, expected.mesh));
            assert_eq!(found.file_bytes, Some(bytes.len() as u64));
            assert_eq!(expected.frames.len(), 9);
        }
    }
}

/// A tetrahedron stays as it is: nothing is off, also at sizes at which areas are out of range.
#[test]
fn what_is_drawn_as_it_is_has_no_error() {
    let strict = LodVerifyOptions {
        min_share: Some(100.0),
        max_error: Some(1e-9),
        ..LodVerifyOptions::default()
    };
    for size in ["1", "1e-30", "1e30"] {
        let places = format!("v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nv 0 0 {size}\n");
        let text = places + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
        let report = verify(&from_obj(&text), &strict);
        assert!(report.errors.seen > 8, "{size}: {report:?}");
        assert_eq!((report.errors.share(), report.errors.worst), (100.0, 0.0));
        assert_eq!(report.face_counts(), [9 * 4, 0]);
        assert_eq!(report.failures(), Vec::<String>::new());
    }
}

#[test]
fn what_does_not_hold_is_told() {
    let document = hills();
    let coarse = LodVerifyOptions {
        tolerance: 60.0,
        ..LodVerifyOptions::default()
    };
    let found = verify(&document, &coarse);
    assert_eq!(found.failures(), Vec::<String>::new());
    assert!(found.errors.worst > 0.01);
    let asked = |min_share, max_error| LodVerifyOptions {
        min_share,
        max_error,
        ..coarse.clone()
    };
    let half = Some(found.errors.worst / 2.0);
    let failures = verify(&document, &asked(Some(0.0), half)).failures();
    assert_eq!(failures.len(), 1);
    assert!(
        failures[0].starts_with("the worst vertex is "),
        "{failures:?}"
    );
    let enough = Some(found.errors.worst);
    let report = verify(&document, &asked(Some(found.errors.share()), enough));
    assert_eq!(report.failures(), Vec::<String>::new());

    // Nothing is seen.
    let away = Camera {
        eye: [0.0, 0.0, 1e3],
        target: [0.0, 0.0, 2e3],
        up: [0.0, 1.0, 0.0],
        field_of_view: 20.0,
        size: [9, 9],
    };
    let options = LodVerifyOptions {
        path: CameraPath::Given([away; 20].into()),
        ..asked(Some(0.0), None)
    };
    let report = verify(&document, &options);
    assert_eq!((report.errors.seen, report.errors.share()), (0, 100.0));
    assert!(report.failures()[0].starts_with("no vertex is in the picture"));
    let numbers: Vec<usize> = report.frames.iter().map(|frame| frame.number).collect();
    assert_eq!(numbers, [0, 2, 4, 6, 8, 11, 13, 15, 17]);
    let json: serde_json::Value = serde_json::from_str(&report.to_json()).unwrap();
    assert_eq!(
        (&json["command"], &json["frame_count"]),
        (&"lod verify".into(), &9.into())
    );
    assert_eq!(json["frames"][3]["frame"], 6);
    assert_eq!(json["failures"].as_array().unwrap().len(), 1);

    // Numbers out of range.
    let error = |options: &LodVerifyOptions| options.check().unwrap_err().to_string();
    assert!(error(&asked(Some(101.0), None)).starts_with("min-share 101: give a part"));
    assert!(error(&asked(None, Some(0.0))).starts_with("max-error 0: give a number"));
    let none = LodVerifyOptions {
        frames: Some(0),
        ..coarse
    };
    assert!(error(&none).starts_with("frames 0: give 1 to"));
    let found = lod_verify(&document, &none, &()).unwrap_err();
    assert!(matches!(found, LodError::Option(_)));
}

#[test]
fn measuring_can_be_stopped() {
    struct StopAt(f64, AtomicUsize);
    impl Progress for StopAt {
        fn report(&self, fraction: f64) -> ControlFlow<()> {
            self.1.fetch_add(1, Ordering::Relaxed);
            assert!((0.0..=1.0).contains(&fraction));
            match fraction < self.0 {
                true => ControlFlow::Continue(()),
                false => ControlFlow::Break(()),
            }
        }
    }
    let options = LodVerifyOptions::default();
    let document = hills();
    for (at, frames) in [(0.0, 0), (0.75, 5), (1.0, 9)] {
        let stop = StopAt(at, AtomicUsize::new(0));
        let report = lod_verify(&document, &options, &stop).unwrap();
        assert_eq!(
            (report.is_stopped, report.frames.len()),
            (frames < 9, frames)
        );
        assert!(stop.1.into_inner() > 0);
    }
}
