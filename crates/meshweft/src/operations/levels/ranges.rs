//! Which byte ranges of a file a client needs for each level of detail.
//!
//! A client reads the header and the JSON first. Then, coarsest level first, it needs what a level adds to those before:
//! index lists, and of each vertex view the part up to the last vertex that the level uses. Ranges that stand close
//! together are one, as a request costs more than a few bytes that are not needed.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use serde_json::{Map, Value, json};

use crate::files::{Document, FileBytes, FileError, LevelBytes, Note};
use crate::operations::json;

/// How the ranges of [`level_ranges`] are made.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LevelRangesOptions {
    /// Ranges that touch, or have fewer bytes than this between them, may be one. By default 4096.
    pub gap: u64,
    /// How many bytes may be fetched so, for each that is needed at a level: the nearest ranges are joined first. By default a
    /// twentieth.
    pub most_waste: f64,
}

impl Default for LevelRangesOptions {
    fn default() -> Self {
        Self {
            gap: 4096,
            most_waste: 0.05,
        }
    }
}

/// The byte ranges of a glTF or GLB, as it is now, that a client needs for each level of detail.
///
/// Levels are those that nodes state by `MSFT_lod`; a file without has level 0 only. At a level every mesh is drawn, one that
/// has no such level at its next finer one. Which vertices a level uses is found in its index lists. Animations are no part of any level.
///
/// ```
/// use meshweft::files::{Document, Format, NewMesh};
/// use meshweft::operations::{LevelRangesOptions, level_ranges};
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let triangle = NewMesh::plain("triangle", &corners, &[[0, 1, 2]]);
/// let document = Document::create(Format::Glb, "triangle.glb".as_ref(), &[triangle])?;
/// let report = level_ranges(&document, &LevelRangesOptions::default())?;
/// assert_eq!((report.levels.len(), report.levels[0].faces), (1, 1));
/// assert_eq!(report.levels[0].ranges.len(), 1);
/// assert!(report.levels[0].ranges[0].start >= report.head_bytes);
/// # Ok::<(), meshweft::files::FileError>(())
/// ```
///
/// # Errors
/// [`FileErrorKind::Unsupported`](crate::files::FileErrorKind::Unsupported) if the document is of another format, or was
/// compressed as a whole: then there are no ranges to ask for.
///
/// # Complexity
/// Time O(n log n) in the JSON, O(faces); space O(JSON).
pub fn level_ranges(
    document: &Document,
    options: &LevelRangesOptions,
) -> Result<LevelRangesReport, FileError> {
    let found = document.level_bytes()?;
    let all = found.levels.iter().flat_map(|level| &level.geometry);
    let mut geometry = Fetched::default();
    all.for_each(|&bytes| geometry.add(bytes));
    let geometry_bytes = geometry.length();

    // What each level adds.
    let (mut fetched, mut total) = (Fetched::default(), 0);
    let mut levels = Vec::with_capacity(found.levels.len());
    for (level, needs) in (0..found.levels.len()).rev().zip(&found.levels) {
        let mut missing = Fetched::default();
        for &bytes in needs.geometry.iter().chain(&needs.matrices) {
            fetched.missing_of(bytes, |bytes| missing.add(bytes));
        }
        let joined = missing.joined(options);
        joined.iter().for_each(|&bytes| fetched.add(bytes));
        let bytes = joined.iter().map(|it| it.end - it.start).sum();
        total += bytes;
        levels.push(LevelRanges {
            level,
            faces: needs.faces,
            vertices: needs.vertices,
            bytes,
            waste: bytes - missing.length(),
            share: total as f64 / geometry_bytes.max(1) as f64,
            ranges: found.ranges(&joined),
        });
    }

    let mut images = Fetched::default();
    found.images.iter().for_each(|&bytes| images.add(bytes));
    Ok(LevelRangesReport {
        file: document.path().to_owned(),
        bytes: document.source_bytes(),
        options: *options,
        head_bytes: found.head,
        geometry_bytes,
        levels,
        image_bytes: images.length(),
        images: found.ranges(&images.joined(options)),
        companions: document.companions(),
        notes: document.notes().to_vec(),
    })
}

/// What [`level_ranges`] found.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LevelRangesReport {
    /// The file.
    pub file: PathBuf,
    /// Its size and that of the buffers beside it that were read.
    pub bytes: u64,
    /// How the ranges were made.
    pub options: LevelRangesOptions,
    /// Header and JSON: the bytes of the file that are read before all others, from 0 on.
    pub head_bytes: u64,
    /// How many bytes index lists, attributes and morph targets have at all levels together, outside the JSON.
    pub geometry_bytes: u64,
    /// Each level, coarsest first.
    pub levels: Vec<LevelRanges>,
    /// How many bytes the images in the buffers have.
    pub image_bytes: u64,
    /// Where they are.
    pub images: Vec<FileRange>,
    /// What else the file names beside it, such as images.
    pub companions: Vec<PathBuf>,
    /// What the reader of the file leaves as it is.
    pub notes: Vec<Note>,
}

/// What a client fetches for a level of detail that has all coarser ones.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LevelRanges {
    /// The level; 0 is full resolution.
    pub level: usize,
    /// How many faces it draws, each mesh counted once.
    pub faces: u64,
    /// How many vertices it needs: of each mesh those up to the last that is used, shared ones once.
    pub vertices: u64,
    /// How many bytes it fetches.
    pub bytes: u64,
    /// How many of them it does not need, or were fetched before: what stands between ranges that became one.
    pub waste: u64,
    /// What was fetched up to and with this level, the header and JSON apart, by [`geometry_bytes`](LevelRangesReport::geometry_bytes).
    /// It may be more than 1: waste counts, and so do matrices of joints.
    pub share: f64,
    /// Where these bytes are, file by file, rising.
    pub ranges: Vec<FileRange>,
}

/// Bytes of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct FileRange {
    /// The file, as a path from the folder of the main one; `None` is the main one itself.
    pub file: Option<PathBuf>,
    /// The first byte.
    pub start: u64,
    /// How many there are.
    pub length: u64,
}

impl FileRange {
    fn json(&self) -> Value {
        json!({
            "file": json::name(self.file.as_deref()),
            "start": self.start,
            "length": self.length,
        })
    }
}

impl LevelRanges {
    fn json(&self) -> Value {
        json!({
            "level": self.level,
            "faces": self.faces,
            "vertices": self.vertices,
            "bytes": self.bytes,
            "waste": self.waste,
            "share": self.share,
            "ranges": self.ranges.iter().map(FileRange::json).collect::<Value>(),
        })
    }
}

impl LevelRangesReport {
    /// The report as one line of JSON. The `file` of a range is `null` where it is of the main file.
    #[must_use]
    pub fn to_json(&self) -> String {
        let ranges = self.images.iter().map(FileRange::json);
        let companions = self.companions.iter().map(|it| it.display().to_string());
        let members = [
            ("file", json!(self.file.display().to_string())),
            ("bytes", json!(self.bytes)),
            ("gap", json!(self.options.gap)),
            ("most_waste", json!(self.options.most_waste)),
            ("head_bytes", json!(self.head_bytes)),
            ("geometry_bytes", json!(self.geometry_bytes)),
            ("levels", Value::Null),
            (
                "images",
                json!({"bytes": self.image_bytes, "ranges": ranges.collect::<Value>()}),
            ),
            ("companions", companions.collect::<Value>()),
            ("notes", json::notes(&self.notes)),
        ];
        let mut report: Map<String, Value> = json::head("levels ranges");
        report.extend(members.map(|(name, value)| (name.to_owned(), value)));
        let levels = self.levels.iter().map(LevelRanges::json);
        json::with_list(&report, "levels", levels)
    }
}

impl LevelBytes {
    /// The same bytes by the names of their files.
    fn ranges(&self, bytes: &[FileBytes]) -> Vec<FileRange> {
        let range = |bytes: &FileBytes| FileRange {
            file: bytes
                .file
                .checked_sub(1)
                .map(|beside| self.beside[beside].clone()),
            start: bytes.start,
            length: bytes.end - bytes.start,
        };
        bytes.iter().map(range).collect()
    }
}

/// A set of bytes of files, as ranges that do not touch.
#[derive(Debug, Default)]
struct Fetched {
    /// The end of each range by its file and start.
    ends: BTreeMap<(usize, u64), u64>,
}

impl Fetched {
    /// Adds bytes. Time O(log n) in the ranges, beside that of taking out those that it joins.
    fn add(
        &mut self,
        FileBytes {
            file,
            mut start,
            mut end,
        }: FileBytes,
    ) {
        while let Some((&(_, other), &other_end)) = self.last_up_to(file, end) {
            if other_end < start {
                break;
            }
            start = start.min(other);
            end = end.max(other_end);
            self.ends.remove(&(file, other));
        }
        self.ends.insert((file, start), end);
    }

    /// The last range of a file that starts at a byte or before.
    fn last_up_to(&self, file: usize, byte: u64) -> Option<(&(usize, u64), &u64)> {
        self.ends.range((file, 0)..=(file, byte)).next_back()
    }

    /// Passes to `visit` what of these bytes is not in the set.
    fn missing_of(&self, bytes: FileBytes, mut visit: impl FnMut(FileBytes)) {
        let FileBytes { file, start, end } = bytes;
        let before = self.last_up_to(file, start);
        let mut at = before.map_or(start, |(_, &before)| before.max(start));
        for (&(_, other), &other_end) in self.ends.range((file, start)..(file, end)) {
            if at < other {
                visit(FileBytes {
                    file,
                    start: at,
                    end: other,
                });
            }
            at = at.max(other_end);
        }
        if at < end {
            visit(FileBytes {
                file,
                start: at,
                end,
            });
        }
    }

    /// How many bytes there are.
    fn length(&self) -> u64 {
        self.ends
            .iter()
            .map(|(&(_, start), &end)| end - start)
            .sum()
    }

    /// The ranges, those that are near each other as one.
    fn joined(&self, options: &LevelRangesOptions) -> Vec<FileBytes> {
        // Between two ranges of one file, nearest first, as long as there is not too much between them in all.
        let pairs = self.ends.iter().zip(self.ends.keys().skip(1));
        let gaps = pairs.filter(|((before, _), next)| before.0 == next.0);
        let gaps = gaps.map(|((_, &end), &next)| (next.1 - end, next));
        let mut gaps: Vec<(u64, (usize, u64))> = gaps.filter(|it| it.0 < options.gap).collect();
        gaps.sort_unstable();
        let most = options.most_waste * self.length() as f64;
        let mut waste = 0;
        let filled = gaps.into_iter().take_while(|&(gap, _)| {
            waste += gap;
            waste as f64 <= most
        });
        let filled: BTreeSet<(usize, u64)> = filled.map(|(_, next)| next).collect();

        let mut joined: Vec<FileBytes> = Vec::new();
        for (&(file, start), &end) in &self.ends {
            match joined.last_mut() {
                Some(last) if filled.contains(&(file, start)) => last.end = end,
                _ => joined.push(FileBytes { file, start, end }),
            }
        }
        joined
    }
}

#[cfg(test)]
#[path = "ranges_tests.rs"]
mod tests;
