//! `levels --ranges`: which bytes of a file each level needs.

use anyhow::Result;
use meshweft::files::Document;
use meshweft::operations::{
    FileRange, LevelRanges, LevelRangesOptions, LevelRangesReport, level_ranges,
};

use super::Levels;
use crate::columns::columns;
use crate::run::inputs;
use crate::run::output;

/// Prints the ranges of each file.
pub(super) fn run(arguments: &Levels) -> Result<()> {
    for input in inputs::expand(&arguments.inputs, None)? {
        let document = Document::open(&input.path, arguments.reading.options(&[]))?;
        let report = level_ranges(&document, &LevelRangesOptions::default())?;
        arguments.report.json_line(&report.to_json())?;
        arguments.report.text(&text(&report))?;
        let notes = output::note_lines(&report.file, &report.notes);
        arguments.report.notes(&notes)?;
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
