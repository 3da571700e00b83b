//! Figures 7 and 8, and 10 and 11, over the frames, as SVG files.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use meshweft::operations::{WalkFrame, WalkQuantity};

use super::walked::{NAMES, PathWalk, Walked, build_milliseconds, bytes};
use crate::plot::{self, Axis, Curve};
use crate::run::side_file::{PICTURE, PICTURE_NAME};

/// Points of a curve at most.
const POINTS: usize = 250;

/// The two figures of a renderer.
pub(super) type Figures = [&'static str; 2];

/// Refuses a folder in which one of the files is there and no such picture.
pub(super) fn check(
    folder: &Path,
    figures: Figures,
    stems: &[String],
    letters: &[&str],
    force: bool,
) -> Result<()> {
    for (number, stem) in stems.iter().enumerate() {
        for letter in letters {
            for figure in figures {
                PICTURE.check(&file(folder, figure, number, stem, letter), force)?;
            }
        }
    }
    Ok(())
}

/// Writes the pictures of the walks with a tolerance into a folder; their paths.
pub(super) fn write(
    folder: &Path,
    figures: Figures,
    walked: &[&Walked],
    tolerance: Option<f64>,
) -> Result<Vec<String>> {
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let mut written = Vec::new();
    for (number, it) in walked.iter().enumerate() {
        let is_drawn = |walk: &&PathWalk| tolerance.is_none_or(|it| walk.tolerance == it);
        for walk in it.walks.iter().filter(is_drawn) {
            let [times, inserts] = figures;
            for (figure, svg) in [(times, of_times(it, walk)), (inserts, of_inserts(it, walk))] {
                let path = file(folder, figure, number, &it.stem, walk.letter);
                let svg = described(&svg, &format!("Fig. {figure}"));
                fs::write(&path, svg).with_context(|| path.display().to_string())?;
                written.push(path.display().to_string());
            }
        }
    }
    Ok(written)
}

/// Where a picture goes; two of one name have their own.
fn file(folder: &Path, figure: &str, number: usize, stem: &str, letter: &str) -> PathBuf {
    let plain = stem
        .chars()
        .filter(|it| it.is_ascii_alphanumeric() || *it == '_');
    let plain: String = plain.collect();
    let letter = letter.to_lowercase();
    folder.join(format!(
        "figure-{figure}{letter}-{}-{plain}.svg",
        number + 1
    ))
}

/// Times above, bytes below.
fn of_times(it: &Walked, walk: &PathWalk) -> String {
    let update = |frame: &WalkFrame| WalkQuantity::UpdateMilliseconds.of(frame);
    let mut times = curves(walk, build_milliseconds);
    times.push(curve("level of detail", &walk.frames[0], update));
    let frames = walk.frames[0].len();
    let upper = picture(
        &title(it, walk, "slots and indices"),
        "milliseconds",
        &times,
        frames,
    );
    let lower = picture(
        "Bytes of vertices and indices",
        "bytes a frame",
        &curves(walk, bytes),
        frames,
    );
    plot::stacked(&upper, &lower)
}

/// Vertices inserted.
fn of_inserts(it: &Walked, walk: &PathWalk) -> String {
    let curves = curves(walk, |frame| frame.inserts as f64);
    let title = title(it, walk, "vertices inserted");
    picture(&title, "vertices a frame", &curves, walk.frames[0].len())
}

fn title(it: &Walked, walk: &PathWalk, what: &str) -> String {
    format!(
        "{}, path {}, {} px: {what}",
        it.name, walk.letter, walk.tolerance
    )
}

/// One of each policy.
fn curves(walk: &PathWalk, of: impl Fn(&WalkFrame) -> f64) -> Vec<Curve> {
    let policies = NAMES.into_iter().zip(&walk.frames);
    policies
        .map(|(name, frames)| curve(name, frames, &of))
        .collect()
}

/// All frames but the first, means where there are many.
fn curve(name: &str, frames: &[WalkFrame], of: impl Fn(&WalkFrame) -> f64) -> Curve {
    let later = frames.get(1..).unwrap_or_default();
    let together = later.len().div_ceil(POINTS).max(1);
    let point = |(number, frames): (usize, &[WalkFrame])| {
        let sum: f64 = frames.iter().map(&of).sum();
        [(1 + number * together) as f64, sum / frames.len() as f64]
    };
    let points = later.chunks(together).enumerate().map(point);
    let mut curve = Curve::new(name.to_owned(), points.collect());
    // Not on a scale of decades.
    curve.leave_out_zeros();
    curve
}

fn picture(title: &str, unit: &'static str, curves: &[Curve], frames: usize) -> String {
    let axes = [
        Axis::of_numbers("frame", frames),
        Axis::of_decades(unit, curves, 1),
    ];
    plot::svg(title, &axes, curves)
}

/// With the words by which it is known again.
fn described(svg: &str, figure: &str) -> String {
    svg.replacen(
        '\n',
        &format!("\n<desc>{PICTURE_NAME}: {figure}</desc>\n"),
        1,
    )
}
