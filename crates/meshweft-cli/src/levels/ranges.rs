//! `levels --ranges`: which bytes of a file each level needs.

use std::path::PathBuf;

use anyhow::Result;
use meshweft::files::Document;
use meshweft::operations::{
    FileRange, LevelRanges, LevelRangesOptions, LevelRangesReport, level_ranges,
};

use crate::columns::columns;
use crate::run::arguments::Reading;
use crate::run::inputs;
use crate::run::output::{Report, note_lines};

/// Prints the ranges of each file.
pub(super) fn run(files: &[PathBuf], reading: &Reading, output: &Report) -> Result<()> {
    for input in inputs::expand(files, None)? {
        let document = Document::open(&input.path, reading.options(&[]))?;
        let report = level_ranges(&document, &LevelRangesOptions::default())?;
        output.json_line(&report.to_json())?;
        output.text(&text(&report))?;
        output.notes(&note_lines(&report.file, &report.notes))?;
    }
    Ok(())
}

/// A line for the file, a table of its levels with the ranges of each below it.
fn text(report: &LevelRangesReport) -> String {
    let mut rows = vec![vec![
        "level".to_owned(),
        "faces".to_owned(),
        "vertices".to_owned(),
        "bytes".to_owned(),
        "of the geometry".to_owned(),
        "ranges".to_owned(),
    ]];
    rows.extend(report.levels.iter().map(row));
    let mut text = format!(
        "{}: {} bytes, header and JSON 0 to {}, geometry {} bytes\n{}",
        report.file.display(),
        report.bytes,
        report.head_bytes,
        report.geometry_bytes,
        columns(&rows)
    );
    for level in &report.levels {
        let ranges: Vec<String> = level.ranges.iter().map(range).collect();
        text += &format!("\nlevel {}: {}", level.level, ranges.join(", "));
    }
    text
}

/// What is counted of a level; the share is that of all bytes up to it.
fn row(level: &LevelRanges) -> Vec<String> {
    vec![
        level.level.to_string(),
        level.faces.to_string(),
        level.vertices.to_string(),
        level.bytes.to_string(),
        format!("{:.1} %", 100.0 * level.share),
        level.ranges.len().to_string(),
    ]
}

/// The first byte and that after the last, with the name of the file if it is not the main one.
fn range(range: &FileRange) -> String {
    let bytes = format!("{} to {}", range.start, range.start + range.length);
    match &range.file {
        None => bytes,
        Some(file) => format!("{bytes} of {}", file.display()),
    }
}
