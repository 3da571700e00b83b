//! Figures as text and as JSON.

use std::time::Duration;

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::{Map, Value, json};

use crate::columns::columns;
use crate::run::output::Report;

/// One figure as text and as JSON.
pub(super) struct Figure {
    pub(super) title: String,
    pub(super) rows: Vec<Vec<String>>,
    pub(super) json: Value,
}

/// A figure's name, its key in JSON, and what makes it.
pub(super) type MakeFigure<'a> = (&'a str, &'a str, &'a dyn Fn() -> Result<Figure>);

/// Makes one figure after the other and prints it; in the end all of them as JSON, and the files that were
/// written.
pub(super) fn print(
    report: &Report,
    paper: &str,
    figures: &[MakeFigure<'_>],
    files: &[String],
) -> Result<()> {
    let style = ProgressStyle::with_template("[{elapsed}] {msg} {wide_bar} {pos}/{len}")?;
    let progress = ProgressBar::new(figures.len() as u64).with_style(style);
    progress.enable_steady_tick(Duration::from_millis(500));

    let mut json = Map::new();
    json.insert("paper".into(), json!(paper));
    for &(name, key, make) in figures {
        progress.set_message(name.to_owned());
        let figure = make()?;
        progress.suspend(|| {
            let rows = columns(&figure.rows);
            report.text(&format!("{name}. {}\n{rows}\n", figure.title))
        })?;
        json.insert(key.into(), figure.json);
        progress.inc(1);
    }

    progress.finish_and_clear();
    if !files.is_empty() {
        report.text(&format!("written: {}", files.join(", ")))?;
    }
    json.insert("files".into(), json!(files));
    Ok(report.json("paper", &Value::Object(json))?)
}

/// A row of a figure: a name, and numbers with three digits.
pub(super) fn cells(
    name: impl Into<String>,
    numbers: impl IntoIterator<Item = f64>,
) -> Vec<String> {
    let numbers = numbers.into_iter().map(|x| format!("{x:.3}"));
    [name.into()].into_iter().chain(numbers).collect()
}

/// The names of the columns.
pub(super) fn head(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

/// The mean, 0 of nothing.
pub(super) fn mean(numbers: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for x in numbers {
        sum += x;
        count += 1.0;
    }
    sum / count.max(1.0)
}
