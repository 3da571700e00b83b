//! `compare`: are these the same triangles, and which order is better?

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use meshweft::files::{Document, ReadOptions};
use meshweft::operations::{self, CompareReport};

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
    let mut rows = vec![vec![String::new(), "a".into(), "b".into()]];
    for ((model, acmr_a), (_, acmr_b)) in a.counts.acmr().zip(b.counts.acmr()) {
        rows.push(vec![
            format!("misses per face, {model}"),
            format!("{acmr_a:.4}"),
            format!("{acmr_b:.4}"),
        ]);
    }
    format!(
        "a: {}\nb: {}\n{verdict}\n{}\nbetter: {}",
        a.file.display(),
        b.file.display(),
        columns(&rows),
        found.better_name()
    )
}
