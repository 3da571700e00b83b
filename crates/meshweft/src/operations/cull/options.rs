//! What is asked for, and why a document gets no tables.

use std::fmt;
use std::path::PathBuf;

use crate::culling::{SampledEyes, ViewClusters};
use crate::files::FileError;
use crate::operations::converted::ConversionError;
use crate::operations::options::{OptionsError, check_target};

/// How a document gets culling tables.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct CullOptions {
    /// How clusters are made.
    pub clusters: ViewClusters,
    /// Stripes by the normals of faces instead, this many ([`NormalStripes`](crate::culling::NormalStripes)): each range of a stripe
    /// is a cluster. Their faces are ordered by the optimizer of [`clusters`](Self::clusters).
    pub stripes: Option<u32>,
    /// For formats other than glTF: keep only names of meshes, positions and faces.
    pub drop_attributes: bool,
}

impl CullOptions {
    /// More stripes would have more ranges than most meshes have faces.
    pub const MOST_STRIPES: u32 = 4096;

    /// Whether clusters can be made like this; `cull_build` checks it first.
    ///
    /// # Errors
    /// [`CullOptionsError`] if they cannot.
    pub fn check(&self) -> Result<(), CullOptionsError> {
        let target = self.clusters.optimizer.target;
        check_target(target).map_err(CullOptionsError::Ordering)?;
        if let Some(count) = self
            .stripes
            .filter(|count| !(1..=Self::MOST_STRIPES).contains(count))
        {
            return Err(CullOptionsError::Stripes { count });
        }
        match self.clusters.eyes.count() {
            0 => Err(CullOptionsError::NoEyes),
            count if count > SampledEyes::MOST => Err(CullOptionsError::TooManyEyes { count }),
            _ => Ok(()),
        }
    }
}

/// Why clusters cannot be made like this.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum CullOptionsError {
    /// Faces are not ordered for that.
    Ordering(OptionsError),
    /// Not 1 to [`CullOptions::MOST_STRIPES`] stripes.
    Stripes {
        /// How many were asked for.
        count: u32,
    },
    /// No eye is asked for.
    NoEyes,
    /// More than [`SampledEyes::MOST`] are.
    TooManyEyes {
        /// How many, with those that are added.
        count: usize,
    },
}

impl fmt::Display for CullOptionsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ordering(error) => error.fmt(f),
            Self::Stripes { count } => {
                write!(
                    f,
                    "{count} stripes: give 1 to {}",
                    CullOptions::MOST_STRIPES
                )
            }
            Self::NoEyes => f.write_str("clusters are made for some eyes: give one at least"),
            Self::TooManyEyes { count } => write!(
                f,
                "{count} eyes, with those that are added: {} at most are sampled",
                SampledEyes::MOST
            ),
        }
    }
}

impl std::error::Error for CullOptionsError {}

/// From where a document is looked at.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CullStatsOptions {
    /// How many directions at each distance.
    pub eyes: usize,
    /// Distances from the center of each mesh, in radii of the ball around it; infinity is an orthographic view.
    pub distances: Vec<f64>,
}

impl Default for CullStatsOptions {
    /// 40 directions at 1.5, 2, 4 and 10 radii, and orthographic.
    fn default() -> Self {
        Self {
            eyes: 40,
            distances: vec![1.5, 2.0, 4.0, 10.0, f64::INFINITY],
        }
    }
}

/// Why a document gets no culling tables.
#[derive(Debug)]
#[non_exhaustive]
pub enum CullError {
    /// A mesh has one already.
    HasTable {
        /// The file.
        file: PathBuf,
        /// The mesh.
        mesh: String,
    },
    /// No GLB can be made of the document.
    Conversion(ConversionError),
    /// Clusters cannot be made like that.
    Options(CullOptionsError),
    /// The document cannot be read or changed.
    File(FileError),
}

impl fmt::Display for CullError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::HasTable { file, mesh } => write!(
                f,
                "{}: {mesh} has a culling table already (MESHWEFT_culling): start from the file that it was made of",
                file.display()
            ),
            Self::Conversion(error) => error.fmt(f),
            Self::Options(error) => error.fmt(f),
            Self::File(error) => error.fmt(f),
        }
    }
}

// No `source`: the text above already says it.
impl std::error::Error for CullError {}

impl From<FileError> for CullError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

impl From<ConversionError> for CullError {
    fn from(error: ConversionError) -> Self {
        Self::Conversion(error)
    }
}
