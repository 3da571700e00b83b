//! `paper`: a paper's tables beside ours.

pub(crate) mod bogomjakov_gotsman;
mod figures;
pub(crate) mod lin_yu;

use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};
use meshweft::files::Document;
use meshweft::{Limits, Mesh};
use serde_json::{Value, json};

use crate::args::Report;
use crate::inspect::columns;

/// One figure as text and as JSON.
struct Figure {
    title: String,
    rows: Vec<Vec<String>>,
    json: Value,
}

/// A figure's name, its key in JSON, and what makes it.
type MakeFigure<'a> = (&'a str, &'a str, &'a dyn Fn() -> Figure);

/// Makes one figure after the other and prints it; all of them as JSON in the end.
fn print(report: &Report, doi: &str, figures: &[MakeFigure<'_>]) -> Result<()> {
    let progress = ProgressBar::new(figures.len() as u64).with_style(ProgressStyle::with_template(
        "[{elapsed}] {msg} {wide_bar} {pos}/{len}",
    )?);
    progress.enable_steady_tick(Duration::from_millis(500));
    let mut json = serde_json::Map::new();
    json.insert("schema".into(), json!(1));
    json.insert("paper".into(), json!(format!("doi:{doi}")));
    for &(name, key, make) in figures {
        progress.set_message(name.to_owned());
        let figure = make();
        progress.suspend(|| {
            let rows = columns(&figure.rows);
            report.text(&format!("{name}. {}\n{rows}\n", figure.title))
        })?;
        json.insert(key.into(), figure.json);
        progress.inc(1);
    }
    progress.finish_and_clear();
    Ok(report.json(&Value::Object(json))?)
}

/// The largest mesh of the first file with one of these names, there or in a folder `meshes`.
fn open(folder: &Path, names: &[&str]) -> Result<Option<(PathBuf, Mesh)>> {
    let folders = [folder.to_owned(), folder.join("meshes")];
    let names = names.iter().flat_map(|name| {
        let endings = ["off", "ply", "obj", "glb", "gltf"].into_iter();
        endings.flat_map(move |e| [format!("{name}.{e}"), format!("{name}.{e}.gz")])
    });
    let mut paths = names.flat_map(|name| folders.each_ref().map(|f| f.join(&name)));
    let Some(file) = paths.find(|path| path.is_file()) else {
        return Ok(None);
    };
    let document = Document::open(&file, Limits::default())?;
    let largest = document.meshes().iter().max_by_key(|e| e.mesh.face_count());
    Ok(largest.map(|entry| (file, entry.mesh.clone())))
}

fn cells(name: impl Into<String>, numbers: impl IntoIterator<Item = f64>) -> Vec<String> {
    let numbers = numbers.into_iter().map(|x| format!("{x:.3}"));
    [name.into()].into_iter().chain(numbers).collect()
}

fn head(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

fn mean(numbers: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for x in numbers {
        sum += x;
        count += 1;
    }
    crate::count::ratio(sum, count)
}
