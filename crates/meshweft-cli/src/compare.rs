//! `compare`: are these the same triangles, and which order is better?

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use meshweft::files::{Document, ReadOptions};
use meshweft::operations::{self, CompareReport, ComparedLevel};

use crate::caches::Caches;
use crate::columns::columns;
use crate::run::arguments::Size;
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
    size: Size,
    #[command(flatten)]
    report: Report,
}

/// Prints how two files differ as triangles and in misses.
pub(crate) fn run(arguments: &Compare) -> Result<()> {
    // What is drawn counts, whether as a strip or as a list.
    let mut options = ReadOptions::from(arguments.size.limits());
    options.strips_to_lists = true;
    let open = |path: &Path| Document::open(path, &options);
    let (a, b) = (open(&arguments.a)?, open(&arguments.b)?);
    let found = operations::compare(&a, &b, &arguments.caches.models())?;

    let report = &arguments.report;
    report.json_line(&found.to_json())?;
    report.text(&text(&found))?;
    let notes = found.sides.iter();
    let notes = notes.flat_map(|side| output::note_lines(&side.file, &side.notes));
    Ok(report.notes(&notes.collect::<Vec<_>>())?)
}

fn text(found: &CompareReport) -> String {
    let [a, b] = &found.sides;
    let verdict = match found.is_same() {
        true => "the same triangles".to_owned(),
        false => {
            let [only_a, only_b] = found.only_in;
            format!("different triangles: {only_a} only in a, {only_b} only in b")
        }
    };
    let levels = match found.levels.is_empty() {
        true => String::new(),
        false => format!("\n{}", level_lines(&found.levels).join("\n")),
    };
    let mut rows = vec![vec![String::new(), "a".into(), "b".into()]];
    for ((model, acmr_a), (_, acmr_b)) in a.counts.acmr().zip(b.counts.acmr()) {
        rows.push(vec![
            format!("misses per face, {model}"),
            format!("{acmr_a:.4}"),
            format!("{acmr_b:.4}"),
        ]);
    }
    format!(
        "a: {}\nb: {}\n{verdict}{levels}\n{}\nbetter: {}",
        a.file.display(),
        b.file.display(),
        columns(&rows),
        found.better_name()
    )
}

/// How many levels of detail each file has, and how those that both have differ.
fn level_lines(levels: &[ComparedLevel]) -> Vec<String> {
    let count = |side: usize| levels.iter().filter(|it| it.faces[side].is_some()).count();
    let first = match [count(0), count(1)] {
        [a, b] if a == b => format!("levels of detail: {a} in both"),
        [a, b] => format!("levels of detail: {a} in a, {b} in b"),
    };
    let of_level = levels.iter().map(|level| {
        let number = level.number;
        match level.faces {
            [Some(faces), Some(_)] if level.is_same() => {
                format!("  level {number}: the same triangles, faces: {faces}")
            }
            [Some(_), Some(_)] => {
                let [only_a, only_b] = level.only_in;
                format!(
                    "  level {number}: different triangles, {only_a} only in a, {only_b} only in b"
                )
            }
            [a, b] => {
                let (faces, side) = (a.or(b).unwrap_or(0), if a.is_some() { "a" } else { "b" });
                format!("  level {number}: only in {side}, faces: {faces}")
            }
        }
    });
    std::iter::once(first).chain(of_level).collect()
}
