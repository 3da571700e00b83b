//! Heights as a terrain in a file.

use std::io::{Read, Seek, SeekFrom, Write};
use std::path::PathBuf;

use serde_json::{Value, json};

use super::error::TerrainError;
use super::heights::TerrainHeights;
use super::source::TerrainFacts;
use crate::files::{FileErrorKind, Note, Place};
use crate::lod::quad_tin::{PointCounts, QuadTin};
use crate::operations::json;

/// What [`terrain_build`] did. The caller may add where it went and how long it took to read.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct TerrainBuildReport {
    /// The files that were read.
    pub files: Vec<PathBuf>,
    /// The file that was written: set by the caller.
    pub output: Option<PathBuf>,
    /// Size of the files that were read.
    pub bytes_before: u64,
    /// Size of what was written; `None` before that.
    pub bytes_after: Option<u64>,
    /// How long it took to read the heights: set by the caller.
    pub read_seconds: Option<f64>,
    /// How long it took to make the hierarchy.
    pub build_seconds: f64,
    /// How long everything took: set by the caller.
    pub seconds: Option<f64>,
    /// What there is at full detail.
    pub terrain: TerrainFacts,
    /// Places without a height, before any was filled.
    pub voids: usize,
    /// How many of them were filled.
    pub filled: usize,
    /// Places at which two files, or two points, have different heights.
    pub disagreeing: usize,
    /// How far these are apart at most, in metres.
    pub largest_disagreement: f64,
    /// What became of points; `None` of height maps.
    pub points: Option<PointCounts>,
    /// What the readers say, each with its file.
    pub notes: Vec<(PathBuf, Note)>,
}

impl TerrainBuildReport {
    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut report = json::file_head(
            "terrain build",
            [
                self.files.first().map(PathBuf::as_path),
                self.output.as_deref(),
            ],
            (self.bytes_before, self.bytes_after),
            0,
            self.seconds,
        );
        let files = self.files.iter().map(|it| it.display().to_string());
        let members = [
            ("files", files.collect()),
            ("read_seconds", json!(self.read_seconds)),
            ("build_seconds", json!(self.build_seconds)),
            ("terrain", self.terrain.json()),
            ("voids", json!(self.voids)),
            ("filled", json!(self.filled)),
            ("disagreeing", json!(self.disagreeing)),
            ("largest_disagreement", json!(self.largest_disagreement)),
            ("points", json!(self.points.as_ref().map(point_counts))),
            ("notes", notes(&self.notes)),
        ];
        report.extend(members.map(|(name, value)| (name.to_owned(), value)));
        Value::Object(report).to_string()
    }
}

fn point_counts(counts: &PointCounts) -> Value {
    json!({
        "points": counts.points,
        "not_finite": counts.not_finite,
        "duplicates": counts.duplicates,
        "left_out": counts.left_out,
        "largest_left_out": counts.largest_left_out,
        "steiner": counts.steiner,
        "depth": counts.depth,
    })
}

/// Notes as JSON, each with its file.
pub(super) fn notes(notes: &[(PathBuf, Note)]) -> Value {
    let note = |(file, note): &(PathBuf, Note)| {
        json!({
            "file": file.display().to_string(),
            "place": note.place.to_string(),
            "text": note.text,
            "more": note.more,
        })
    };
    notes.iter().map(note).collect()
}

/// A terrain that is not written yet.
#[derive(Debug)]
pub struct BuiltTerrain {
    /// All its levels of detail.
    pub tin: QuadTin,
    /// What is known of it.
    pub report: TerrainBuildReport,
    name: String,
    file: PathBuf,
}

/// Makes a terrain of heights, with every level of detail. [`BuiltTerrain::write`] makes a `.mwt` file of it.
///
/// `clock` gives seconds since any time; give `&|| 0.0` where there is no clock.
///
/// # Errors
/// [`TerrainError`] if there are no heights, too many, or points on a line.
///
/// # Complexity
/// That of [`QuadTin::over_grid`], or of [`PointHierarchy::over`](crate::lod::quad_tin::PointHierarchy::over).
///
/// ```
/// use std::io::Cursor;
/// use meshweft::HeightGrid;
/// use meshweft::operations::{TerrainHeights, terrain_build};
///
/// let grid = HeightGrid::new([3, 3], [30.0, 30.0], vec![0.0, 1.0, 0.0, 1.0, 5.0, 1.0, 0.0, 1.0, 0.0])?;
/// let mut built = terrain_build(TerrainHeights::of_grid("hill", grid), &|| 0.0)?;
/// let mut file = Cursor::new(Vec::new());
/// built.write(&mut file)?;
/// assert_eq!(built.report.terrain.faces, 8);
/// assert!(file.into_inner().starts_with(b"MWTN"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn terrain_build(
    heights: TerrainHeights,
    clock: &dyn Fn() -> f64,
) -> Result<BuiltTerrain, TerrainError> {
    let start = clock();
    let file = heights.file();
    let (tin, points) = heights.tin()?;
    let build_seconds = clock() - start;

    let (disagreeing, largest_disagreement) = match &points {
        None => (heights.disagreeing, heights.largest_disagreement.into()),
        Some(counts) => (counts.disagreeing as usize, counts.largest_disagreement),
    };
    let report = TerrainBuildReport {
        files: heights.files,
        output: None,
        bytes_before: heights.bytes,
        bytes_after: None,
        read_seconds: None,
        build_seconds,
        seconds: None,
        terrain: TerrainFacts::of(&tin),
        voids: heights.voids,
        filled: heights.filled,
        disagreeing,
        largest_disagreement,
        points,
        notes: heights.notes,
    };
    Ok(BuiltTerrain {
        tin,
        report,
        name: heights.name,
        file,
    })
}

impl BuiltTerrain {
    /// Writes a `.mwt` file, reads it back and compares: every height, bit for bit, and all that the hierarchy knows of it. Both are
    /// done block by block, so no second copy is in memory.
    ///
    /// # Errors
    /// [`TerrainError`] if it cannot be written or read back, or is not the same.
    pub fn write(
        &mut self,
        file: &mut (impl Read + Write + Seek + ?Sized),
    ) -> Result<(), TerrainError> {
        let not_written = |error| {
            let kind = FileErrorKind::Io(error).at(Place::File);
            TerrainError::File(kind.in_file(&self.file, None))
        };
        let mut sink = &mut *file;
        let written = self.tin.write(&self.name, &mut sink);
        written.map_err(not_written)?;
        let length = file.seek(SeekFrom::End(0)).map_err(not_written)?;

        let is_same = self.tin.is_stored_in(&mut *file);
        let is_same = is_same.map_err(|error| TerrainError::Stored {
            file: self.file.clone(),
            frame: None,
            error,
        })?;
        if !is_same {
            let file = self.file.clone();
            return Err(TerrainError::NotVerified { file });
        }
        self.report.bytes_after = Some(length);
        Ok(())
    }
}
