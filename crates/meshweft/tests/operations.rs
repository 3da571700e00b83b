//! The jobs on documents: what they change, what they report, how they are bounded.
#![cfg(feature = "files")]

use std::fmt::{self, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

use meshweft::files::{Document, Format, ReadOptions};
use meshweft::operations::{
    self, Greedy, IndexOptions, OptimizeError, Options, OptionsError, USUAL_CACHES,
};
use meshweft::order::{Effort, Mode};
use meshweft::{Budget, CacheModel, Permutation, Progress};

/// Two grids of squares in two objects of an OBJ, faces shuffled.
fn obj() -> String {
    let side = 24;
    let mut text = String::new();
    for object in 0..2 {
        for i in 0..(side + 1) * (side + 1) {
            writeln!(text, "v {} {} {object}", i % (side + 1), i / (side + 1)).unwrap();
        }
    }
    let first = |object: u32| 1 + object * (side + 1) * (side + 1);
    for object in 0..2 {
        writeln!(text, "o object{object}").unwrap();
        let square = |i: u32| {
            let corner = first(object) + i / side * (side + 1) + i % side;
            let above = corner + side + 1;
            [[corner, corner + 1, above], [corner + 1, above + 1, above]]
        };
        let faces: Vec<[u32; 3]> = (0..side * side).flat_map(square).collect();
        for [a, b, c] in Permutation::random(faces.len(), 3).apply(&faces) {
            writeln!(text, "f {a} {b} {c}").unwrap();
        }
    }
    text
}

fn document(text: &str) -> Document {
    let bytes = text.as_bytes().to_vec();
    let name = Path::new("grids.obj");
    Document::from_bytes(bytes, Format::Obj, name, ReadOptions::default()).unwrap()
}

fn bytes(document: &Document) -> Vec<u8> {
    document.to_main_bytes().unwrap()
}

/// The document after these options, and its report.
fn optimized(text: &str, options: &Options) -> (Document, operations::OptimizeReport) {
    let mut document = document(text);
    let report = operations::optimize(&mut document, options, &()).unwrap();
    (document, report)
}

#[test]
fn a_document_gets_better_keeps_its_triangles_and_settles() {
    let text = obj();
    for effort in [Effort::Fast, Effort::Best] {
        for target in ["universal", "fifo:12", "nvidia", "controllable:9"] {
            let options = Options {
                target: target.parse().unwrap(),
                effort,
                ..Options::default()
            };
            let (after, report) = optimized(&text, &options);
            assert!(report.is_changed() && !report.is_stopped);
            assert_eq!(report.scheduled().is_some(), target == "controllable:9");
            let models = options.target.models();
            let sum = |counts: &operations::Counts| -> u64 {
                let of_target = counts.misses.iter().filter(|(m, _)| models.contains(m));
                of_target.map(|(_, misses)| misses).sum()
            };
            assert!(sum(&report.total.after) < sum(&report.total.before));

            // What is promised is what the file has.
            let inspected = operations::inspect(&after, models);
            assert_eq!(sum(&inspected.total), sum(&report.total.after));
            let compared = operations::compare(&document(&text), &after, models).unwrap();
            assert!(compared.is_same() && compared.better == Some(1));
            assert_eq!(compared.better_name(), "b");

            // Run on its own output it changes nothing.
            let again = String::from_utf8(bytes(&after)).unwrap();
            let (same, report) = optimized(&again, &options);
            assert!(!report.is_changed(), "{target}, {effort:?}");
            assert_eq!(bytes(&same), again.as_bytes());
            assert_eq!(
                report.of_file.bytes_after,
                Some(report.of_file.bytes_before)
            );
        }
    }
}

#[test]
fn raw_indices_and_documents_are_ordered_alike() {
    // One run over all its faces: what is left of the document is its connectivity.
    let text = obj().replace("o object1\n", "");
    let before = document(&text);
    let mesh = &before.meshes()[0].mesh;
    let (after, _) = optimized(&text, &Options::default());

    let mut indices = mesh.faces().as_flattened().to_vec();
    let options = IndexOptions {
        renumber_vertices: true,
        ..IndexOptions::default()
    };
    operations::optimize_indices(&mut indices, mesh.vertex_count(), &options).unwrap();
    assert_eq!(after.meshes()[0].mesh.faces().as_flattened(), indices);
}

#[test]
fn a_budget_of_steps_gives_the_same_bytes_always_and_less_than_all() {
    let text = obj();
    let with = |budget| {
        let options = Options {
            // The universal order is at least the floor, whatever the budget.
            target: CacheModel::fifo(16).into(),
            effort: Effort::Max,
            budget,
            ..Options::default()
        };
        let (document, report) = optimized(&text, &options);
        let misses = options.target.misses(&document.meshes()[0].mesh);
        (bytes(&document), misses, report.is_stopped)
    };
    let few = with(Budget::Steps(20));
    assert_eq!(few, with(Budget::Steps(20)));
    assert!(!few.2);
    let all = with(Budget::Unlimited);
    assert!(all.1 < few.1 && few.1 < with(Budget::Steps(0)).1);
}

/// A caller who stops after some reports.
struct Patient {
    left: AtomicU32,
}

impl Progress for Patient {
    fn report(&self, fraction: f64) -> ControlFlow<()> {
        assert!((0.0..=1.0).contains(&fraction), "{fraction}");
        let left = self.left.load(Ordering::Relaxed);
        self.left.store(left.saturating_sub(1), Ordering::Relaxed);
        match left {
            0 => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }
}

#[test]
fn a_caller_may_stop_at_any_time_and_loses_nothing() {
    let text = obj();
    let options = Options {
        effort: Effort::Best,
        ..Options::default()
    };
    let mut stopped = 0;
    for reports in 0..8 {
        let mut after = document(&text);
        let caller = Patient {
            left: AtomicU32::new(reports),
        };
        let report = operations::optimize(&mut after, &options, &caller).unwrap();
        stopped += u32::from(report.is_stopped);
        let models = options.target.models();
        let compared = operations::compare(&document(&text), &after, models).unwrap();
        assert!(compared.is_same() && compared.better != Some(0));
        let json: serde_json::Value = serde_json::from_str(&report.to_json()).unwrap();
        assert_eq!(json["stopped"], report.is_stopped);
    }
    assert!(stopped > 2, "{stopped} of 8 were stopped");
}

#[test]
fn options_that_do_not_go_together_change_nothing() {
    let text = obj();
    let mut after = document(&text);
    let options = Options {
        greedy: Some(Greedy::of_mode(Mode::Faithful)),
        ..Options::default()
    };
    let error = operations::optimize(&mut after, &options, &()).unwrap_err();
    assert!(matches!(
        error,
        OptimizeError::Options(OptionsError::NotGreedy { .. })
    ));
    assert_eq!(bytes(&after), text.as_bytes());
}

#[test]
fn worse_is_taken_only_if_allowed() {
    let text = obj();
    let best = Options {
        target: CacheModel::fifo(9).into(),
        effort: Effort::Best,
        ..Options::default()
    };
    let (good, _) = optimized(&text, &best);
    let good = String::from_utf8(bytes(&good)).unwrap();
    let fast = Options {
        effort: Effort::Fast,
        ..best.clone()
    };
    let (kept, report) = optimized(&good, &fast);
    assert_eq!(bytes(&kept), good.as_bytes());
    assert_eq!(
        report.meshes[0].reason,
        Some("the order found does not miss less")
    );
    let allowed = Options {
        allow_worse: true,
        ..fast
    };
    let (worse, report) = optimized(&good, &allowed);
    assert!(report.is_changed() && bytes(&worse) != good.as_bytes());
}

#[test]
fn reports_have_one_schema() {
    let text = obj();
    let (after, mut report) = optimized(&text, &Options::default());
    report.of_file.seconds = Some(1.5);
    report.of_file.set_output(Path::new("out.obj"), 77);
    let reports = [
        ("optimize", report.to_json()),
        (
            "inspect",
            operations::inspect(&after, &USUAL_CACHES).to_json(),
        ),
        (
            "compare",
            operations::compare(&after, &after, &USUAL_CACHES)
                .unwrap()
                .to_json(),
        ),
    ];
    for (command, text) in &reports {
        assert!(!text.contains('\n'));
        let json: serde_json::Value = serde_json::from_str(text).unwrap();
        assert_eq!(json["schema"], operations::SCHEMA);
        assert_eq!(json["command"], *command);
        assert_eq!(json["version"], env!("CARGO_PKG_VERSION"));
    }
    let json: serde_json::Value = serde_json::from_str(&reports[0].1).unwrap();
    assert_eq!(json["bytes"]["before"], text.len());
    assert_eq!(json["bytes"]["after"], 77);
    assert_eq!(
        (&json["seconds"], &json["output"]),
        (&1.5.into(), &"out.obj".into())
    );

    let total: serde_json::Value = serde_json::from_str(&report.total_to_json()).unwrap();
    assert_eq!(total, json["total"]);
    let moved: serde_json::Value = serde_json::from_str(&report.permutations_to_json()).unwrap();
    assert_eq!(
        moved["meshes"].as_array().map(Vec::len),
        Some(report.meshes.len())
    );
    let records = moved["meshes"][0]["face_new_to_old"].as_array().unwrap();
    assert_eq!(records.len(), report.meshes[0].faces.len());
}

#[test]
fn what_is_public_can_be_shared_and_shown() {
    fn is<T: Send + Sync + fmt::Debug>() {}
    is::<Document>();
    is::<Options>();
    is::<operations::OptimizeReport>();
    is::<operations::InspectReport>();
    is::<operations::CompareReport>();
    is::<operations::Orders>();
    is::<OptimizeError>();
    is::<operations::Method>();
    is::<meshweft::Faces<'_>>();
    is::<Budget>();
}
