//! Documents with fewer faces: every format, seams and primitives, real scenes, random ones.
#![cfg(feature = "files")]
#![expect(clippy::cast_possible_truncation, reason = "test meshes are small")]

#[path = "../files_gltf/builder.rs"]
#[expect(dead_code, reason = "shared with other tests")]
mod builder;
#[path = "../data/folder.rs"]
mod data;
mod laws;
mod made;
mod random;
mod real;

use std::path::Path;

use meshweft::Limits;
use meshweft::files::{Document, Format};
use meshweft::operations::{ErrorLimit, SimplifyOptions, SimplifyReport, simplify};
use meshweft::progressive::StopReason;

use made::Sheet;

pub(crate) fn open(bytes: &[u8], format: Format) -> Document {
    let name = Path::new("mesh");
    Document::from_bytes(bytes.to_vec(), format, name, Limits::default()).unwrap()
}

pub(crate) fn ratio(ratio: f64) -> SimplifyOptions {
    SimplifyOptions {
        ratio: Some(ratio),
        samples: 500,
        ..SimplifyOptions::default()
    }
}

/// The document with fewer faces, read again, after all laws were checked.
pub(crate) fn simplified(
    bytes: &[u8],
    format: Format,
    options: &SimplifyOptions,
) -> (Document, SimplifyReport) {
    let source = open(bytes, format);
    let mut document = open(bytes, format);
    let report = simplify(&mut document, options, &()).unwrap();
    let written = document.to_main_bytes().unwrap();
    if !report.is_changed() {
        assert_eq!(written, bytes);
    }
    let again = open(&written, format);
    for (a, b) in document.meshes().iter().zip(again.meshes()) {
        assert_eq!(a.mesh, b.mesh);
    }
    laws::check(&source, &again, &report);
    (again, report)
}

const FORMATS: [Format; 6] = [
    Format::Obj,
    Format::Ply,
    Format::Off,
    Format::Stl,
    Format::Glb,
    Format::Gltf,
];

#[test]
fn every_format_loses_faces_and_keeps_its_records() {
    let sheet = Sheet::new(24, 16, 5);
    for format in FORMATS {
        let bytes = sheet.bytes(format);
        let (document, report) = simplified(&bytes, format, &ratio(0.5));
        let faces: usize = document
            .meshes()
            .iter()
            .map(|entry| entry.mesh.face_count())
            .sum();
        assert_eq!(faces, report.total.after.faces, "{format}");
        assert_eq!(report.objects.len(), 1, "{format}");
        assert!(faces <= 384 && faces > 376, "{format}: {faces}");
        assert!(
            report.of_file.notes.is_empty(),
            "{format}: {:?}",
            report.of_file.notes
        );
        assert!(report.total.after.vertices < report.total.before.vertices);
        let object = &report.objects[0];
        assert_eq!(object.stop, StopReason::Faces);
        let max = object.distances.unwrap().max;
        assert!(max > 0.0 && max < 0.2 * object.diagonal, "{format}: {max}");
        assert!(document.to_main_bytes().unwrap().len() < bytes.len());
    }
}

#[test]
fn nothing_to_remove_changes_nothing() {
    let sheet = Sheet::new(8, 6, 1);
    for format in FORMATS {
        for options in [
            ratio(1.0),
            SimplifyOptions {
                faces: Some(1000),
                ..SimplifyOptions::default()
            },
        ] {
            let (_, report) = simplified(&sheet.bytes(format), format, &options);
            assert!(!report.is_changed() && report.objects[0].distances.is_none());
            assert_eq!(
                report.of_file.bytes_after,
                Some(report.of_file.bytes_before)
            );
        }
    }
}

#[test]
fn an_error_stops_it_and_a_flat_sheet_has_none() {
    let mut sheet = Sheet::new(16, 16, 2);
    let limit = |error| SimplifyOptions {
        error: Some(error),
        samples: 2000,
        ..SimplifyOptions::default()
    };
    let (_, report) = simplified(
        &sheet.bytes(Format::Ply),
        Format::Ply,
        &limit(ErrorLimit::Diagonal(0.01)),
    );
    let object = &report.objects[0];
    assert_eq!(object.stop, StopReason::Error);
    assert!(f64::from(object.estimated_error) <= 0.01 * object.diagonal);
    assert!(object.faces[1] < object.faces[0]);

    sheet.flatten();
    let (_, report) = simplified(
        &sheet.bytes(Format::Off),
        Format::Off,
        &limit(ErrorLimit::Units(1e-6)),
    );
    assert!(report.objects[0].faces[1] <= 16, "{:?}", report.objects[0]);
    assert!(report.objects[0].distances.unwrap().max < 1e-5);
}

#[test]
fn a_border_that_is_locked_stays() {
    let sheet = Sheet::new(12, 12, 3);
    let options = SimplifyOptions {
        lock_border: true,
        ..ratio(0.0)
    };
    let (document, _) = simplified(&sheet.bytes(Format::Ply), Format::Ply, &options);
    let positions = document.positions(0).unwrap().unwrap();
    let on_border = |p: &&[f32; 3]| p[1] == 0.0 || p[1] == 12.0 || p[0] == 0.0 || p[0] == 12.0;
    assert_eq!(
        positions.iter().filter(on_border).count(),
        sheet.border_records()
    );
}

#[test]
fn removals_do_not_change_the_result() {
    let bytes = Sheet::new(12, 10, 4).bytes(Format::Glb);
    let (plain, _) = simplified(&bytes, Format::Glb, &ratio(0.4));
    let options = SimplifyOptions {
        with_removals: true,
        levels: 9,
        ..ratio(0.4)
    };
    let (with_removals, report) = simplified(&bytes, Format::Glb, &options);
    assert_eq!(
        plain.to_main_bytes().unwrap(),
        with_removals.to_main_bytes().unwrap()
    );
    let removals = report.objects[0].removals.as_ref().unwrap();
    let levels = &report.objects[0].levels;
    assert!(levels.len() > 5 && levels.len() <= 9, "{levels:?}");
    assert_eq!(levels[0].faces, 240);
    assert_eq!(levels[0].error, 0.0);
    assert!(levels.is_sorted_by(|a, b| a.faces > b.faces && a.error <= b.error));
    for level in levels {
        assert!((0.5..=3.0).contains(&level.edited[1]) && level.fresh[1] <= level.edited[1] * 1.05);
    }
    assert!(removals.faces.is_sorted_by(|a, b| a >= b) && removals.error.is_sorted());
    assert!((*removals.faces.last().unwrap() as usize) < report.objects[0].faces[1]);
    let json: serde_json::Value = serde_json::from_str(&report.removals_to_json()).unwrap();
    let columns = &json["objects"][0]["removals"];
    assert_eq!(
        columns["vertex"].as_array().unwrap().len(),
        removals.vertex.len()
    );
    assert_eq!(json["meshes"].as_array().unwrap().len(), 2);
}

#[test]
fn a_polygon_that_does_not_change_stays_one() {
    // Two cubes' worth of quads: a flat strip, and a ridge that stays.
    let mut text = String::new();
    for x in 0..9 {
        let height = if x == 4 { 2 } else { 0 };
        text += &format!("v {x} 0 {height}\nv {x} 1 {height}\n");
    }
    for x in 0..8 {
        let v = 2 * x + 1;
        text += &format!("f {v} {} {} {}\n", v + 2, v + 3, v + 1);
    }
    let options = SimplifyOptions {
        error: Some(ErrorLimit::Units(1e-3)),
        ..ratio(0.0)
    };
    let (document, report) = simplified(text.as_bytes(), Format::Obj, &options);
    let entry = &document.meshes()[0];
    assert!(report.is_changed() && entry.polygons.is_some());
    let quads = (0..entry.record_count()).filter(|&record| {
        let starts = entry.polygons.as_ref().unwrap();
        starts[record + 1] - starts[record] == 2
    });
    assert_eq!(
        quads.count(),
        2,
        "{}",
        String::from_utf8(document.to_main_bytes().unwrap()).unwrap()
    );
}

#[test]
fn what_cannot_be_simplified_is_said() {
    let text = "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0, 1 1 0, 0 1 0, .5 .5 0] }\n\
                coordIndex [0 1 4 -1 1 2 4 -1 2 3 4 -1 3 0 4 -1] } }\n";
    let (_, report) = simplified(text.as_bytes(), Format::Vrml, &ratio(0.5));
    assert!(!report.is_changed());
    assert!(
        report.of_file.notes[0]
            .text
            .contains("not simplified: faces are not left out"),
        "{:?}",
        report.of_file.notes
    );
    let json: serde_json::Value = serde_json::from_str(&report.to_json()).unwrap();
    assert_eq!(json["objects"][0]["stop"], "refused");
}
