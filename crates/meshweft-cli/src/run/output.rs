//! Where text and JSON go.

use std::io::{self, Write};

use anyhow::Error;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use meshweft::files::{Document, Note, Place};
use serde_json::{Map, Value, json};

/// The version of what is printed and listed as JSON.
pub(super) const SCHEMA: u32 = 1;

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
    /// Prints the report of a verb, an object with these members, on a line of standard output, if
    /// JSON was asked for.
    pub(crate) fn json(&self, verb: &str, members: &Value) -> io::Result<()> {
        match self.json {
            true => writeln!(io::stdout().lock(), "{}", headed(verb, members)),
            false => Ok(()),
        }
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

/// The members of a report after those that every report begins with.
fn headed(verb: &str, members: &Value) -> Value {
    let mut report = Map::new();
    report.insert("schema".into(), json!(SCHEMA));
    report.insert("command".into(), json!(verb));
    report.extend(members.as_object().cloned().unwrap_or_default());
    Value::Object(report)
}

/// What a file's reader leaves as it is, a line each.
pub(crate) fn note_lines(document: &Document) -> Vec<String> {
    let line = |note: &Note| {
        let place = match place(&note.place) {
            place if place.is_empty() => place,
            place => format!("{place}: "),
        };
        let more = match note.more {
            0 => String::new(),
            more => format!(" (and {more} more like it)"),
        };
        format!("{}: {place}{}{more}", document.path().display(), note.text)
    };
    document.notes().iter().map(line).collect()
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

/// The notes of a document as JSON.
pub(crate) fn notes_json(document: &Document) -> Value {
    let notes = document.notes().iter();
    notes
        .map(|note| json!({"place": place(&note.place), "text": note.text, "more": note.more}))
        .collect()
}

fn place(place: &Place) -> String {
    match place {
        Place::Line(line) => format!("line {line}"),
        Place::Byte(byte) => format!("byte {byte}"),
        Place::Json(pointer) => pointer.clone(),
        _ => String::new(),
    }
}

/// Whether whoever read our output has gone: not an error, and nobody is left to tell.
pub(crate) fn is_broken_pipe(error: &Error) -> bool {
    let io = error.chain().filter_map(|e| e.downcast_ref::<io::Error>());
    io.into_iter()
        .any(|e| e.kind() == io::ErrorKind::BrokenPipe)
}
