//! Walks around small meshes: what the card has is the front, and figures add up.

use std::cell::Cell;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;

use super::detail_front::LoadedFront;
use super::options::{LodError, LodWalkOptions};
use super::paths::CameraPath;
use super::walk::{Walker, lod_walk};
use crate::files::{Document, Format, ReadOptions};
use crate::lod::geometry_cache::EvictionPolicy;
use crate::operations::walks::{WalkFrame, WalkQuantity};
use crate::progress::Progress;

/// Cells on a side of a hill.
const SIDE: u32 = 40;

/// A bumpy hill of squares above another one: its vertices and faces.
fn hill(number: u32) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let place = |i: u32| {
        let [x, y] = [i % (SIDE + 1), i / (SIDE + 1)].map(|at| f64::from(at) / 4.0);
        let height = 5.0 * f64::from(number) + (2.1 * x).sin() * (1.7 * y).cos();
        [x, height, y]
    };
    let cell = |i: u32| {
        let corner = i / SIDE * (SIDE + 1) + i % SIDE;
        let above = corner + SIDE + 1;
        [[corner, above, corner + 1], [corner + 1, above, above + 1]]
    };
    let places = (0..(SIDE + 1) * (SIDE + 1)).map(place);
    (places.collect(), (0..SIDE * SIDE).flat_map(cell).collect())
}

/// Two hills, in two objects of an OBJ.
pub(super) fn hills() -> Document {
    let mut text = String::new();
    let mut first = 1;
    for number in 0..2 {
        let (places, faces) = hill(number);
        writeln!(text, "o hill{number}").unwrap();
        for [x, y, z] in &places {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        for face in faces {
            let [a, b, c] = face.map(|vertex| vertex + first);
            writeln!(text, "f {a} {b} {c}").unwrap();
        }
        first += u32::try_from(places.len()).unwrap();
    }
    from_obj(&text)
}

/// The same hills as two meshes of a VRML file.
fn hills_apart() -> Document {
    let mut text = String::from("#VRML V2.0 utf8\n");
    for number in 0..2 {
        let (places, faces) = hill(number);
        let places = places.iter().map(|[x, y, z]| format!("{x} {y} {z}, "));
        let faces = faces.iter().map(|[a, b, c]| format!("{a} {b} {c} -1 "));
        let (places, faces) = (places.collect::<String>(), faces.collect::<String>());
        writeln!(
            text,
            "Shape {{ geometry IndexedFaceSet {{ coord Coordinate {{ point [ {places} ] }} coordIndex [ {faces} ] }} }}"
        )
        .unwrap();
    }
    let name = Path::new("hills.wrl");
    Document::from_bytes(text.into(), Format::Vrml, name, ReadOptions::default()).unwrap()
}

pub(super) fn from_obj(text: &str) -> Document {
    let name = Path::new("hills.obj");
    Document::from_bytes(text.into(), Format::Obj, name, ReadOptions::default()).unwrap()
}

pub(super) fn options(path: CameraPath, slots: usize) -> LodWalkOptions {
    LodWalkOptions {
        path,
        slots,
        frames: Some(60),
        tolerance: 3.0,
        optimum: true,
        ..LodWalkOptions::default()
    }
}

fn report(document: &Document, options: &LodWalkOptions) -> super::report::LodWalkReport {
    lod_walk(document, options, &|| 0.0, &()).unwrap()
}

#[test]
fn the_card_has_the_front_in_every_frame() {
    let document = hills();
    for path in CameraPath::SHAPES {
        for (slots, passes) in [(65_536, false), (400, false), (400, true), (3, true)] {
            let options = LodWalkOptions {
                passes,
                ..options(path.clone(), slots)
            };
            let loaded = LoadedFront::new((&document).into(), &()).unwrap();
            let mut walker = Walker::new(loaded.detail, &options).unwrap();
            let mut active = walker.detail.front().vertex_count();
            assert!(active > 0);
            for frame in 0..30 {
                let camera = path.camera(loaded.ball, frame, 30, [800, 600]);
                let view = camera.view(options.tolerance).unwrap();
                let row = walker.frame(&view, frame, &|| 0.0).unwrap();
                active = active + row.added - row.removed;
                assert_eq!(row.vertices, active);
                assert_eq!(walker.detail.front().vertices().count(), active);
                assert_eq!(walker.cache.active().len(), active);
                assert!(walker.indices.is_true_to(&walker.cache));
                check(&walker, &row, &options);
            }
        }
    }
}

/// What is drawn is the front, and costs what it has to.
fn check(walker: &Walker, row: &WalkFrame, options: &LodWalkOptions) {
    let is_overfull = row.vertices > options.slots;
    assert_eq!(row.is_streamed, is_overfull && !options.passes);
    assert_eq!(row.passes > 1, is_overfull && options.passes);
    assert_eq!(row.vertex_bytes, 36 * row.inserts as u64);
    if row.is_streamed {
        assert_eq!(row.inserts, row.vertices);
    }
    if row.passes > 1 {
        assert!(row.inserts + options.slots >= row.vertices);
    }

    // Faces that live in the index buffer are those of the front, with the same corners.
    let mut living = 0;
    for (face, corners) in walker.detail.front().faces() {
        let place = walker.indices.place(face).unwrap() as usize;
        assert_eq!(walker.indices.corners()[place], corners);
        living += 1;
    }
    assert_eq!(living, row.faces);
    let places = walker.indices.corners().iter();
    let is_face = |&&[a, b, _]: &&[u32; 3]| a != b;
    assert_eq!(places.filter(is_face).count(), row.faces);
}

#[test]
fn figures_add_up() {
    let document = hills();
    for path in CameraPath::SHAPES {
        let most = report(&document, &options(path.clone(), 65_536));
        let largest = most
            .frames
            .iter()
            .map(|frame| frame.vertices)
            .max()
            .unwrap();
        let small = largest + largest / 10;
        let mut fewest = None;
        for policy in EvictionPolicy::ALL {
            let options = LodWalkOptions {
                policy,
                ..options(path.clone(), small)
            };
            let report = report(&document, &options);
            let total = |quantity| report.summary(quantity).total;
            let optimum = report.optimum.unwrap();
            let inserts = total(WalkQuantity::Inserts);
            assert!(inserts >= optimum.fewest_inserts.unwrap() as f64);
            assert!(optimum.fewest_inserts.unwrap() >= optimum.distinct_vertices as u64);
            assert_eq!(
                *fewest.get_or_insert(optimum),
                optimum,
                "it is of the path alone"
            );
            if policy == EvictionPolicy::Nothing {
                assert_eq!(inserts, total(WalkQuantity::Vertices));
            } else {
                assert!(inserts < total(WalkQuantity::Vertices) / 4.0);
            }
            assert_eq!(total(WalkQuantity::VertexBytes), 36.0 * inserts);
            assert_eq!(report.frames.len(), 60);
            assert!(most.mesh.roots < largest && largest < most.mesh.vertices);
        }
        // With slots for all, each vertex is sent once.
        let optimum = most.optimum.unwrap();
        let inserts = most.summary(WalkQuantity::Inserts).total;
        assert_eq!(inserts, optimum.distinct_vertices as f64);
        assert_eq!(
            optimum.fewest_inserts,
            Some(optimum.distinct_vertices as u64)
        );
    }
}

#[test]
fn meshes_are_one_mesh() {
    let (one, apart) = (hills(), hills_apart());
    assert_eq!((one.meshes().len(), apart.meshes().len()), (1, 2));
    let options = options(CameraPath::Zoom, 9000);
    let [one, apart] = [one, apart].map(|document| report(&document, &options));
    let mesh = apart.mesh;
    assert_eq!((mesh.vertices, mesh.faces), (2 * 41 * 41, 2 * 2 * 40 * 40));
    assert_eq!((mesh, apart.frames), (one.mesh, one.frames));
}

#[test]
fn summaries_have_the_first_frame_apart() {
    let mut report = report(&hills(), &options(CameraPath::Circle, 9000));
    let frame = |added| WalkFrame {
        added,
        ..WalkFrame::default()
    };
    report.frames = [1000, 1, 7, 2, 4].map(frame).to_vec();
    let found = report.summary(WalkQuantity::Added);
    let found = [
        found.first,
        found.mean,
        found.median,
        found.worst,
        found.total,
    ];
    assert_eq!(found, [1000.0, 3.5, 3.0, 7.0, 1014.0]);
    report.frames.truncate(4);
    assert_eq!(report.summary(WalkQuantity::Added).median, 2.0);
    report.frames.truncate(1);
    let found = report.summary(WalkQuantity::Added);
    let found = [
        found.first,
        found.mean,
        found.median,
        found.worst,
        found.total,
    ];
    assert_eq!(found, [1000.0, 0.0, 0.0, 0.0, 1000.0]);
}

#[test]
fn hysteresis_changes_less() {
    let document = hills();
    let changes = |hysteresis| {
        let options = LodWalkOptions {
            hysteresis,
            ..options(CameraPath::Rotate, 9000)
        };
        report(&document, &options)
            .summary(WalkQuantity::Removed)
            .total
    };
    assert!(changes(0.5) < 0.7 * changes(1.0));
}

/// Times are of the caller's clock: here each look at it takes a second.
#[test]
fn times_are_those_of_the_clock() {
    let now = Cell::new(0.0);
    let clock = || {
        now.set(now.get() + 1.0);
        now.get()
    };
    let options = options(CameraPath::Fly, 9000);
    let report = lod_walk(&hills(), &options, &clock, &()).unwrap();
    assert_eq!(report.build_seconds, 1.0);
    for quantity in WalkQuantity::ALL.into_iter().filter(|it| it.is_time()) {
        assert_eq!(report.summary(quantity).total, 60.0 * 1000.0);
    }
}

#[test]
fn the_report_is_json() {
    let options = options(CameraPath::Fly, 300);
    let report = report(&hills(), &options);
    let json: serde_json::Value = serde_json::from_str(&report.to_json()).unwrap();
    assert_eq!(json["command"], "lod walk");
    assert_eq!(json["path"], "fly");
    let frames = json["frames"].as_array().unwrap();
    assert_eq!((frames.len(), &json["frame_count"]), (60, &60.into()));
    let number = |value: &serde_json::Value| value.as_u64().unwrap();
    for name in ["vertices", "inserts", "index_bytes"] {
        let sum: u64 = frames.iter().map(|frame| number(&frame[name])).sum();
        assert_eq!(number(&json["summary"][name]["total"]), sum);
    }
    let inserts = number(&json["summary"]["inserts"]["total"]);
    assert!(inserts >= number(&json["optimum"]["distinct_vertices"]));
}

#[test]
fn a_walk_can_be_stopped() {
    struct StopFrom(f64);
    impl Progress for StopFrom {
        fn report(&self, fraction: f64) -> ControlFlow<()> {
            assert!((0.0..=1.0).contains(&fraction));
            match fraction < self.0 {
                true => ControlFlow::Continue(()),
                false => ControlFlow::Break(()),
            }
        }
    }
    // Half of the work is the hierarchy.
    let (document, options) = (hills(), options(CameraPath::Zoom, 9000));
    for (part, frames, is_stopped) in [
        (0.1, 0, true),
        (0.75, 30, true),
        (1.0, 60, false),
        (2.0, 60, false),
    ] {
        let found = lod_walk(&document, &options, &|| 0.0, &StopFrom(part)).unwrap();
        assert_eq!(
            (found.frames.len(), found.is_stopped),
            (frames, is_stopped),
            "{part}"
        );
        assert_eq!(found.mesh.faces, 2 * 2 * 40 * 40);
    }
}

#[test]
fn what_cannot_be_walked_around_is_told() {
    let walk = |text: &str, options: &LodWalkOptions| {
        let found = lod_walk(&from_obj(text), options, &|| 0.0, &());
        found
            .map(|report| report.frames.len())
            .map_err(|error| error.to_string())
    };
    let usual = options(CameraPath::Circle, 9000);
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(walk(triangle, &usual), Ok(60));
    let flat = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n";
    for text in ["v 0 0 0\n", flat] {
        let error = walk(text, &usual).unwrap_err();
        assert!(
            error.starts_with("hills.obj: no face has three different corners"),
            "{error}"
        );
    }
    let none = LodWalkOptions {
        slots: 2,
        ..usual.clone()
    };
    let error = walk(triangle, &none).unwrap_err();
    assert_eq!(error, "slots 2: give 3, which a face needs, to 1073741824");

    // A camera that sees nothing.
    let document = hills();
    let loaded = LoadedFront::new((&document).into(), &()).unwrap();
    let camera = CameraPath::Circle.camera(loaded.ball, 0, 9, [9, 9]);
    let blind = crate::lod::Camera {
        target: camera.eye,
        ..camera
    };
    let options = LodWalkOptions {
        path: CameraPath::Given([camera, blind].into()),
        frames: None,
        ..usual
    };
    let error = lod_walk(&document, &options, &|| 0.0, &()).unwrap_err();
    assert!(matches!(error, LodError::View { frame: 1, .. }), "{error}");
}
