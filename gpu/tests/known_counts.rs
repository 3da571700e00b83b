//! The rule against what cards of NVIDIA counted: the data folder's `nvidia/`, found as everywhere by
//! `MESHWEFT_DATA`, else beside the repository.

use std::io::{Read, Write};
use std::path::PathBuf;

use flate2::read::GzDecoder;
use gpu::batch_rule::BatchRule;
use gpu::draw::Draw;
use gpu::setup;
use serde_json::Value;

/// The lines of a file, each a draw; none where there is no data, unless that is a failure.
fn lines(name: &str) -> Vec<Value> {
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = std::env::var_os("MESHWEFT_DATA").map_or_else(beside, PathBuf::from);
    let file = folder.join("nvidia").join(name);
    let Ok(bytes) = std::fs::read(&file) else {
        let is_needed = std::env::var_os("MESHWEFT_REQUIRE_DATA").is_some();
        assert!(!is_needed, "no test data in {}", file.display());
        let _ = writeln!(std::io::stderr(), "{name}: SKIPPED, no test data");
        return Vec::new();
    };
    let mut text = String::new();
    GzDecoder::new(&bytes[..])
        .read_to_string(&mut text)
        .expect("gzipped text");
    text.lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect()
}

fn indices(line: &Value) -> Vec<u32> {
    let indices = line["indices"].as_array().expect("indices");
    indices
        .iter()
        .map(|index| index.as_u64().unwrap().try_into().unwrap())
        .collect()
}

#[test]
fn batches_are_those_of_the_card() {
    for line in lines("list-draws.jsonl.gz") {
        let indices = indices(&line);
        let draw = Draw {
            vertex_offset: line["vertex_offset"].as_i64().unwrap().try_into().unwrap(),
            reads_instance: true,
            instances: line["instances"].as_u64().unwrap().try_into().unwrap(),
            ..Draw::list(&indices)
        };
        let counted = [&line["invocations"], &line["warps"]].map(|count| count.as_u64().unwrap());
        let (invocations, batches) = BatchRule::NVIDIA.counts(&draw);
        assert_eq!([invocations, batches], counted, "{}", line["name"]);
    }
}

#[test]
fn setup_takes_the_cycles_of_the_card() {
    for line in lines("setup-cycles.jsonl.gz") {
        let indices = indices(&line);
        let batches = BatchRule::NVIDIA.batches(&Draw::list(&indices));
        let cycles: u64 = batches
            .iter()
            .map(|batch| setup::cycles(&batch.faces))
            .sum();
        // Timed, not counted.
        let timed = line["cycles"].as_f64().unwrap();
        assert!(
            (timed - cycles as f64).abs() < 0.1,
            "{}: {timed} cycles, model {cycles}",
            line["name"]
        );
    }
}
