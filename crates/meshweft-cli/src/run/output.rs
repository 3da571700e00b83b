//! Where text and JSON go.

use std::io::{self, Write};
use std::path::Path;

use anyhow::Error;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use meshweft::files::{Note, Place};
use meshweft::operations::SCHEMA;
use serde_json::{Map, Value, json};

// No doc comment: clap would take it for the text about a verb.
#[derive(Debug, Args)]
#[command(next_display_order = 120)]
pub(crate) struct Report {
    /// Print the report as JSON on standard output, all text on standard error
    #[arg(long)]
    json: bool,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

impl Report {
    /// Prints a report of the library, one line of JSON, on standard output, if JSON was asked for.
    pub(crate) fn json_line(&self, line: &str) -> io::Result<()> {
        match self.json {
            true => writeln!(io::stdout().lock(), "{line}"),
            false => Ok(()),
        }
    }

    /// Prints a report of the program's own, an object with these members.
    pub(crate) fn json(&self, verb: &str, members: &Value) -> io::Result<()> {
        self.json_line(&headed(verb, members))
    }

    /// Whether people may be shown how far the work is.
    pub(crate) fn shows_progress(&self) -> bool {
        !self.quiet
    }

    /// Prints text for people: on standard output, or on standard error if JSON goes there.
    pub(crate) fn text(&self, text: &str) -> io::Result<()> {
        match (self.quiet, self.json) {
            (true, _) => Ok(()),
            (false, true) => writeln!(io::stderr().lock(), "{text}"),
            (false, false) => writeln!(io::stdout().lock(), "{text}"),
        }
    }

    /// Says on standard error what a file's reader leaves as it is.
    pub(crate) fn notes(&self, lines: &[String]) -> io::Result<()> {
        if self.quiet {
            return Ok(());
        }
        let mut stderr = io::stderr().lock();
        lines
            .iter()
            .try_for_each(|line| writeln!(stderr, "note: {line}"))
    }
}

/// A report as one line of JSON: what every report begins with, then these members.
pub(super) fn headed(verb: &str, members: &Value) -> String {
    let mut report = Map::new();
    report.insert("schema".into(), json!(SCHEMA));
    report.insert("command".into(), json!(verb));
    report.insert("version".into(), json!(env!("CARGO_PKG_VERSION")));
    report.extend(members.as_object().cloned().unwrap_or_default());
    Value::Object(report).to_string()
}

/// What a file's reader leaves as it is, a line each.
pub(crate) fn note_lines(file: &Path, notes: &[Note]) -> Vec<String> {
    let line = |note: &Note| {
        let place = match note.place {
            Place::File => String::new(),
            _ => format!("{}: ", note.place),
        };
        let more = match note.more {
            0 => String::new(),
            more => format!(" (and {more} more like it)"),
        };
        format!("{}: {place}{}{more}", file.display(), note.text)
    };
    notes.iter().map(line).collect()
}

/// A bar for work on several files, on standard error if that is a terminal.
pub(crate) fn progress(files: usize, report: &Report) -> ProgressBar {
    let bar = match files > 1 && !report.quiet {
        true => ProgressBar::new(files as u64),
        false => ProgressBar::hidden(),
    };
    let template = "{bar:40} {pos}/{len} files, {eta} left";
    bar.with_style(
        ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()),
    )
}

/// Whether the reader of the program's output has gone: not an error, and nobody is left to tell.
pub(crate) fn is_broken_pipe(error: &Error) -> bool {
    let io = error.chain().filter_map(|e| e.downcast_ref::<io::Error>());
    io.into_iter()
        .any(|e| e.kind() == io::ErrorKind::BrokenPipe)
}
