//! `compare`: are these the same triangles, and which order is better?

use std::cmp::Ordering;
use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use meshweft::files::{Document, MeshEntry};
use meshweft::{CacheModel, Limits};
use serde_json::{Value, json};

use crate::caches::Caches;
use crate::columns::columns;
use crate::count::Counts;
use crate::run::output::{self, Report};

#[derive(Debug, Args)]
pub(crate) struct Compare {
    /// The first file
    a: PathBuf,
    /// The second file; another format is fine
    b: PathBuf,
    #[command(flatten)]
    caches: Caches,
    #[command(flatten)]
    report: Report,
}

/// Prints how two files differ as triangles and in misses.
pub(crate) fn run(arguments: &Compare) -> Result<()> {
    let models = arguments.caches.models();
    let open = |path: &Path| Document::open(path, Limits::default());
    let (a, b) = (open(&arguments.a)?, open(&arguments.b)?);
    let counts = [&a, &b].map(|document| {
        let entries = document.meshes();
        let each = entries.iter().map(|e| Counts::of(&e.mesh, &models));
        Counts::total(entries, &each.collect::<Vec<_>>(), &models)
    });

    // Positions tell vertices apart whatever their numbers; without them the numbers must do.
    let entries = || a.meshes().iter().chain(b.meshes());
    let by_position = entries().all(|e| e.mesh.positions().len() == e.mesh.vertex_count());
    let [only_a, only_b] = differences(
        &triangles(a.meshes(), by_position),
        &triangles(b.meshes(), by_position),
    );
    let same = only_a == 0 && only_b == 0;
    let better = better(&counts, &models);

    let side = |document: &Document, counts: &Counts| {
        let mut object = counts.json();
        let file = document.path().display().to_string();
        object.shift_insert(0, "file".into(), json!(file));
        Value::Object(object)
    };
    let members = json!({
        "a": side(&a, &counts[0]),
        "b": side(&b, &counts[1]),
        "same_triangles": same,
        "compared_by": if by_position { "position" } else { "vertex number" },
        "only_in_a": only_a,
        "only_in_b": only_b,
        "better": better,
    });

    let verdict = match same {
        true => "the same triangles".to_owned(),
        false => format!("different triangles: {only_a} only in a, {only_b} only in b"),
    };
    let mut rows = vec![vec![String::new(), "a".into(), "b".into()]];
    for ((model, acmr_a), (_, acmr_b)) in counts[0].acmr().zip(counts[1].acmr()) {
        rows.push(vec![
            format!("misses per face, {model}"),
            format!("{acmr_a:.4}"),
            format!("{acmr_b:.4}"),
        ]);
    }
    let text = format!(
        "a: {}\nb: {}\n{verdict}\n{}\nbetter: {better}",
        a.path().display(),
        b.path().display(),
        columns(&rows)
    );

    let report = &arguments.report;
    report.json("compare", &members)?;
    report.text(&text)?;
    Ok(report.notes(&[&a, &b].map(output::note_lines).concat())?)
}

/// Which side misses less: under the first model that tells them apart.
fn better(counts: &[Counts; 2], models: &[CacheModel]) -> &'static str {
    for i in 0..models.len() {
        // Misses per face: the numbers of faces may differ.
        let [a, b] = [&counts[0], &counts[1]];
        let left = u128::from(a.misses[i].1) * b.faces.max(1) as u128;
        let right = u128::from(b.misses[i].1) * a.faces.max(1) as u128;
        match left.cmp(&right) {
            Ordering::Less => return "a",
            Ordering::Greater => return "b",
            Ordering::Equal => {}
        }
    }
    "equal"
}

/// All triangles, sorted; a triangle starts at its least corner, the orientation kept.
fn triangles(entries: &[MeshEntry], by_position: bool) -> Vec<[[u32; 3]; 3]> {
    let mut triangles = Vec::new();
    for entry in entries {
        let identity = |vertex: u32| match by_position {
            true => entry.mesh.positions()[vertex as usize].map(f32::to_bits),
            false => [vertex, 0, 0],
        };
        for face in entry.mesh.faces() {
            let [a, b, c] = face.map(identity);
            let turned = [[a, b, c], [b, c, a], [c, a, b]];
            triangles.push(turned.into_iter().min().unwrap_or(turned[0]));
        }
    }
    triangles.sort_unstable();
    triangles
}

/// How many entries each of two sorted lists has that the other lacks.
fn differences<T: Ord>(a: &[T], b: &[T]) -> [usize; 2] {
    let (mut i, mut j, mut common) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        match a[i].cmp(&b[j]) {
            Ordering::Less => i += 1,
            Ordering::Greater => j += 1,
            Ordering::Equal => {
                (i, j) = (i + 1, j + 1);
                common += 1;
            }
        }
    }
    [a.len() - common, b.len() - common]
}
