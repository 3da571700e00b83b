//! Samples of a file on their way to heights in metres.

use super::super::error::{FileErrorKind, Place, Problem};
use super::super::note::Note;
use super::options::HeightMapOptions;
use super::placement::MapPlacement;
use crate::height_grid::HeightGrid;
use crate::index::index32;

/// What a format's reader found.
pub(super) struct ReadHeights {
    pub(super) size: [u32; 2],
    /// Row by row from the north, in metres; NaN is void.
    pub(super) heights: Vec<f32>,
    pub(super) placement: MapPlacement,
    pub(super) notes: Vec<Note>,
}

/// What is always accepted of heights, in bytes: room for 3,601 by 3,601 samples of one height, which
/// compress to almost nothing.
const FREE_BYTES: u64 = 52 << 20;
/// What is accepted beyond that, in bytes of heights a byte of the file.
const BYTES_PER_BYTE: u64 = 16;

/// Columns and rows, if a grid may have that many and a file of this length may stand for them.
///
/// A header may claim any size, so this comes before anything is allocated.
pub(super) fn checked_size(
    size: [u64; 2],
    file_bytes: usize,
    options: &HeightMapOptions,
) -> Result<[u32; 2], FileErrorKind> {
    let [columns, rows] = size;
    let most = u64::from(HeightGrid::MOST);
    if !size.iter().all(|it| (2..=most).contains(it)) {
        return Err(FileErrorKind::unsupported(format!(
            "{columns} columns and {rows} rows: a grid of heights has 2 to {most} of each. Crop it, or cut it into \
             tiles"
        )));
    }

    let (samples, limit) = (columns * rows, options.limits.vertices as u64);
    if samples > limit {
        return Err(FileErrorKind::OverLimit {
            what: "samples",
            found: samples,
            limit,
        });
    }
    if samples * 4 > FREE_BYTES + BYTES_PER_BYTE * file_bytes as u64 {
        return Err(FileErrorKind::unsupported(format!(
            "{columns} by {rows} samples from {file_bytes} bytes: more than is unpacked from so small a file. If it is \
             sound, save it without compression, or cut it into tiles"
        )));
    }
    Ok(size.map(|it| index32(usize::try_from(it).expect("at most 32,769"))))
}

/// How samples become heights.
pub(super) struct HeightRule {
    /// Stored values that stand for no height.
    no_data: Vec<f64>,
    /// Metres per unit of a sample.
    scale: f64,
    /// How many samples single precision does not hold.
    rounded: usize,
    largest: f32,
}

impl HeightRule {
    /// For samples of which one unit is `unit` metres, and `no_data` stands for no height.
    pub(super) fn new(options: &HeightMapOptions, unit: f64, no_data: &[f64]) -> Self {
        let no_data = no_data.iter().copied().chain(options.no_data);
        Self {
            no_data: no_data.collect(),
            scale: unit * options.height_scale.unwrap_or(1.0),
            rounded: 0,
            largest: 0.0,
        }
    }

    /// The height of a sample, NaN for none.
    #[inline]
    pub(super) fn height(&mut self, sample: f64) -> f32 {
        if self.is_no_data(sample) {
            return f32::NAN;
        }
        self.rounded += usize::from(f64::from(single(sample)) != sample && sample.is_finite());
        self.metres(sample)
    }

    /// Whether a stored value stands for no height.
    #[inline]
    pub(super) fn is_no_data(&self, stored: f64) -> bool {
        self.no_data.iter().any(|&value| {
            // The value for single precision is often written with fewer digits than it has.
            let is_single = f64::from(single(stored)) == stored;
            value == stored || is_single && single(value) == single(stored)
        })
    }

    /// The height that this many units are, NaN if there is none.
    #[inline]
    pub(super) fn metres(&mut self, units: f64) -> f32 {
        let height = single(units * self.scale);
        if !height.is_finite() {
            return f32::NAN;
        }
        self.largest = self.largest.max(height.abs());
        height
    }

    /// What is to be said of all samples.
    pub(super) fn notes(&self) -> Vec<Note> {
        // No height on Earth, in whatever unit.
        const HIGHEST: f32 = 100_000.0;
        let mut notes = Vec::new();
        if self.rounded > 0 {
            let text = format!(
                "{} samples have more digits than single precision holds, and are rounded",
                self.rounded
            );
            notes.push(Note::new(Place::File, text));
        }
        if self.largest > HIGHEST {
            let text = format!(
                "there are heights of up to {} metres: if that is a value for no height, name it as no data",
                self.largest
            );
            notes.push(Note::new(Place::File, text));
        }
        notes
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounded to the nearest")]
fn single(number: f64) -> f32 {
    number as f32
}

/// The error for bytes that end inside a row, counted from the top of the file.
pub(super) fn ends_in_row(row: u32, rows: u32, at: usize) -> Problem {
    FileErrorKind::truncated(format!("row {row} of {rows}")).at(Place::Byte(at))
}
