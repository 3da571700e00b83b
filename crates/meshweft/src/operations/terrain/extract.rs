//! One surface of those that a terrain has.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::error::TerrainError;
use super::source::{TerrainFacts, TerrainSource};
use crate::index::index32;
use crate::lod::quad_tin::{TinLimit, TinSurface};
use crate::lod::{Camera, CameraView};
use crate::mesh::Mesh;
use crate::operations::json;
use crate::operations::walks::WalkOptionError;

/// Which surface of a terrain is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum TerrainDetail {
    /// That which no height is farther from than this, vertically, in metres. With 0 it has all of them.
    Error(f64),
    /// The best one of at most this many faces: the largest errors are cut first.
    Faces(usize),
    /// What a camera needs, if an error of this many pixels may be seen: coarse outside of the picture.
    Camera {
        /// The camera.
        camera: Camera,
        /// How many pixels the surface may be off.
        tolerance: f64,
    },
}

/// How a surface is taken from a terrain.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct TerrainExtractOptions {
    /// Which surface.
    pub detail: TerrainDetail,
}

impl TerrainExtractOptions {
    /// A surface of this detail.
    #[must_use]
    pub fn new(detail: TerrainDetail) -> Self {
        Self { detail }
    }

    /// Whether every number is in its range.
    ///
    /// # Errors
    /// The first one that is not.
    pub fn check(&self) -> Result<(), WalkOptionError> {
        let error = |option, found: String, allowed: &str| {
            Err(WalkOptionError {
                option,
                found,
                allowed: allowed.to_owned(),
            })
        };
        match self.detail {
            TerrainDetail::Error(length) if !(length >= 0.0 && length.is_finite()) => {
                let allowed = "a number of metres, 0 for all heights";
                error("error", length.to_string(), allowed)
            }
            TerrainDetail::Faces(0) => error("faces", "0".to_owned(), "a number of faces above 0"),
            TerrainDetail::Camera { tolerance, .. }
                if !(tolerance > 0.0 && tolerance.is_finite()) =>
            {
                let allowed = "a number of pixels above 0";
                error("tolerance", tolerance.to_string(), allowed)
            }
            _ => Ok(()),
        }
    }
}

/// A surface of a terrain.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ExtractedTerrain {
    /// What the terrain is called; may be empty.
    pub name: String,
    /// Positions and faces: each face has a side in common with the one before, but at holes; vertices by their first use.
    pub mesh: Mesh,
    /// What was taken.
    pub report: TerrainExtractReport,
}

/// What [`terrain_extract`] took. The caller may add where it went and the time it took.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct TerrainExtractReport {
    /// The file that was read.
    pub file: PathBuf,
    /// The file that was written: set by the caller.
    pub output: Option<PathBuf>,
    /// Size of a `.mwt` file, and how much of it was read; `None` if the hierarchy was made here.
    pub bytes: Option<[u64; 2]>,
    /// Size of what was written: set by the caller.
    pub bytes_written: Option<u64>,
    /// How long it took: set by the caller, who has a clock.
    pub seconds: Option<f64>,
    /// What there is at full detail.
    pub terrain: TerrainFacts,
    /// Vertices of the surface.
    pub vertices: usize,
    /// Faces of the surface.
    pub faces: usize,
    /// How far any height is from the surface at most, vertically, in metres.
    pub error: f32,
    /// Vertices of a triangle strip of all faces, in their order.
    pub strip: usize,
    /// What the readers say, each with its file.
    pub notes: Vec<(PathBuf, crate::files::Note)>,
}

impl TerrainExtractReport {
    /// Vertices of the strip for each face.
    #[must_use]
    pub fn strip_per_face(&self) -> f64 {
        self.strip as f64 / self.faces.max(1) as f64
    }

    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut report = json::file_head(
            "terrain extract",
            [Some(&self.file), self.output.as_deref()],
            (
                self.bytes.map_or(0, |[length, _]| length),
                self.bytes_written,
            ),
            0,
            self.seconds,
        );
        let members = [
            ("bytes_read", json!(self.bytes.map(|[_, read]| read))),
            ("terrain", self.terrain.json()),
            ("vertices", json!(self.vertices)),
            ("faces", json!(self.faces)),
            ("error", json!(self.error)),
            ("strip_per_face", json!(self.strip_per_face())),
            ("notes", super::build::notes(&self.notes)),
        ];
        report.extend(members.map(|(name, value)| (name.to_owned(), value)));
        Value::Object(report).to_string()
    }
}

/// Takes one surface from a terrain. Of a `.mwt` file only the blocks are read that it needs.
///
/// # Errors
/// [`TerrainError`]: an option is out of its range, the file cannot be read or is damaged, or the coarsest surface has more faces than
/// are asked for.
///
/// # Complexity
/// Time O(n) for n faces; with a number of faces O(n log n).
///
/// ```
/// use meshweft::HeightGrid;
/// use meshweft::operations::{
///     TerrainDetail, TerrainExtractOptions, TerrainHeights, TerrainSource, terrain_extract,
/// };
///
/// let heights = (0..81).map(|i| [0.0, 2.0, 3.0, 2.5, 1.0, 0.0, 0.0, 0.0, 0.5][i % 9]).collect();
/// let grid = HeightGrid::new([9, 9], [30.0, 30.0], heights)?;
/// let source = TerrainSource::of_heights(TerrainHeights::of_grid("ridge", grid))?;
/// let extracted = terrain_extract(source, &TerrainExtractOptions::new(TerrainDetail::Error(1.0)))?;
/// assert!(extracted.report.error <= 1.0 && extracted.mesh.face_count() < 128);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn terrain_extract(
    mut source: TerrainSource,
    options: &TerrainExtractOptions,
) -> Result<ExtractedTerrain, TerrainError> {
    options.check()?;
    let view =
        |view: Result<CameraView, _>| view.map_err(|error| TerrainError::View { frame: 0, error });
    let (view, limit) = match options.detail {
        TerrainDetail::Error(0.0) => (view(CameraView::of_errors_above(-1.0))?, None),
        TerrainDetail::Error(length) => (view(CameraView::of_errors_above(length))?, None),
        TerrainDetail::Faces(most) => (
            view(CameraView::of_errors_above(-1.0))?,
            Some(TinLimit::Faces(most)),
        ),
        TerrainDetail::Camera { camera, tolerance } => (view(camera.view(tolerance))?, None),
    };
    let mut surface = TinSurface::default();
    source.draw(&view, limit, None, &mut surface)?;
    if let TerrainDetail::Faces(asked) = options.detail
        && surface.faces().len() > asked
    {
        let (file, least) = (source.file.clone(), surface.faces().len());
        return Err(TerrainError::TooFewFaces { file, asked, least });
    }

    // Vertices by their first use.
    let tin = source.tin();
    let mut numbers = std::collections::HashMap::new();
    let mut positions = Vec::new();
    let mut number = |vertex: u32| {
        *numbers.entry(vertex).or_insert_with(|| {
            positions.push(tin.position(vertex));
            index32(positions.len() - 1)
        })
    };
    let faces = surface.faces().iter();
    let faces: Vec<[u32; 3]> = faces.map(|&(_, face)| face.map(&mut number)).collect();
    let report = TerrainExtractReport {
        file: source.file.clone(),
        output: None,
        bytes: source.bytes(),
        bytes_written: None,
        seconds: None,
        terrain: TerrainFacts::of(tin),
        vertices: positions.len(),
        faces: faces.len(),
        error: surface.largest_error(),
        strip: surface.strip().len(),
        notes: source.notes.clone(),
    };
    let mesh = Mesh::new(positions, faces).expect("all vertices were counted, and are finite");
    Ok(ExtractedTerrain {
        name: source.name,
        mesh,
        report,
    })
}
