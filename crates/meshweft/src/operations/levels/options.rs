//! What levels are asked for.

use std::fmt;
use std::path::PathBuf;

use crate::files::FileError;
use crate::operations::converted::ConversionError;
use crate::operations::options::{OptionsError, check_target};
use crate::operations::simplify::ErrorLimit;
use crate::order::Optimizer;
use crate::progressive::AttributeWeights;

/// How many levels a document gets, how coarse they are, and how each is ordered.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LevelsOptions {
    /// How coarse each level is, fine to coarse.
    pub goals: LevelGoals,
    /// Whether the vertices at open edges stay.
    pub lock_border: bool,
    /// Whether a part may leave as a whole, and a hole close, where its extent is below the error of the level. The last
    /// part of an object never leaves.
    pub drop_parts: bool,
    /// Whether levels go on where only vertices without a partner on the other side of a seam are left: their texture
    /// coordinates and normals then change.
    pub cross_seams: bool,
    /// Whether the vertices stay where they are. Those of a coarse level are then not the first ones, and a reader needs all for
    /// the first picture. In groups of more than 65,536 vertices, which some cards transform in blocks of that many, the full mesh
    /// takes up to three times as many invocations with its vertices in bands.
    pub keep_vertex_order: bool,
    /// What differences in attributes count.
    pub weights: AttributeWeights,
    /// From how many points of either surface the error of each level is measured, of all objects together; 0 takes the
    /// estimate instead.
    pub samples: usize,
    /// How each level is ordered. The effort is also that of the removals.
    pub optimizer: Optimizer,
    /// For formats other than glTF: leaves out what a GLB of names, positions and faces does not have.
    pub drop_attributes: bool,
}

impl Default for LevelsOptions {
    /// Half of the faces, a quarter, a tenth.
    fn default() -> Self {
        Self {
            goals: LevelGoals::Ratios(vec![0.5, 0.25, 0.1]),
            lock_border: false,
            drop_parts: true,
            cross_seams: false,
            keep_vertex_order: false,
            weights: AttributeWeights::default(),
            samples: 100_000,
            optimizer: Optimizer::default(),
            drop_attributes: false,
        }
    }
}

/// How coarse levels are, fine to coarse. All objects of a file have one error budget: at each level none is farther off
/// than needed for the whole.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum LevelGoals {
    /// Shares of the faces of the file, falling, below 1.
    Ratios(Vec<f64>),
    /// Numbers of faces of the file, falling.
    Faces(Vec<usize>),
    /// The largest errors of removals, rising, as they are drawn: lengths are those of the scene, and a share is of the
    /// diagonal of the largest object.
    Errors(Vec<ErrorLimit>),
}

impl LevelGoals {
    /// How many levels are asked for.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Ratios(ratios) => ratios.len(),
            Self::Faces(faces) => faces.len(),
            Self::Errors(errors) => errors.len(),
        }
    }

    /// Whether none is.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn check(&self) -> Result<(), LevelsOptionsError> {
        let is_sorted = match self {
            Self::Ratios(ratios) => {
                let is_share = |&ratio: &f64| ratio > 0.0 && ratio < 1.0;
                ratios.iter().all(is_share) && ratios.is_sorted_by(|a, b| a > b)
            }
            Self::Faces(faces) => {
                faces.iter().all(|&count| count > 0) && faces.is_sorted_by(|a, b| a > b)
            }
            Self::Errors(errors) => {
                let numbers: Vec<f64> = errors.iter().map(|error| error.number()).collect();
                let kinds = errors.iter().map(std::mem::discriminant);
                let is_length = |number: &f64| *number >= 0.0 && number.is_finite();
                let is_one_kind = kinds.clone().all(|kind| Some(kind) == kinds.clone().next());
                is_one_kind && numbers.iter().all(is_length) && numbers.is_sorted_by(|a, b| a < b)
            }
        };
        match (self.len(), is_sorted) {
            (0, _) => Err(LevelsOptionsError::NoLevels),
            (count, _) if count > LevelsOptions::MOST_LEVELS => {
                Err(LevelsOptionsError::TooManyLevels { count })
            }
            (_, false) => Err(LevelsOptionsError::NotCoarser),
            (_, true) => Ok(()),
        }
    }
}

impl LevelsOptions {
    /// Most levels below the full mesh that a file gets.
    pub const MOST_LEVELS: usize = 16;

    /// Whether these make sense; `levels` checks it first.
    ///
    /// # Errors
    /// [`LevelsOptionsError`] if they do not.
    pub fn check(&self) -> Result<(), LevelsOptionsError> {
        let target = check_target(self.optimizer.target);
        target.map_err(LevelsOptionsError::Ordering)?;
        self.goals.check()?;
        let weights = [
            self.weights.normal,
            self.weights.tex_coord,
            self.weights.color,
        ];
        let is_sound = |weight: f32| weight >= 0.0 && weight.is_finite();
        match weights.into_iter().all(is_sound) {
            true => Ok(()),
            false => Err(LevelsOptionsError::Weights),
        }
    }
}

/// Options that make no sense.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LevelsOptionsError {
    /// No level is asked for.
    NoLevels,
    /// More than [`LevelsOptions::MOST_LEVELS`] are.
    TooManyLevels {
        /// How many.
        count: usize,
    },
    /// A level is not coarser than the one before it, or out of range.
    NotCoarser,
    /// A weight is negative or not a number.
    Weights,
    /// The order of the levels cannot be made.
    Ordering(OptionsError),
}

impl fmt::Display for LevelsOptionsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoLevels => f.write_str("which levels? Give ratios, numbers of faces, or errors"),
            Self::TooManyLevels { count } => {
                write!(f, "{count} levels: {} at most", LevelsOptions::MOST_LEVELS)
            }
            Self::NotCoarser => f.write_str(
                "each level must be coarser than the one before it: ratios fall and are between 0 and 1, numbers of \
                 faces fall, errors rise and are of one kind",
            ),
            Self::Weights => f.write_str("weights out of range: 0 and more is allowed"),
            Self::Ordering(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for LevelsOptionsError {}

/// Why a document gets no levels.
#[derive(Debug)]
#[non_exhaustive]
pub enum LevelsError {
    /// A mesh has some already.
    HasLevels {
        /// The file.
        file: PathBuf,
        /// The mesh.
        mesh: String,
    },
    /// No mesh can be made coarser.
    NothingLeaves {
        /// The file.
        file: PathBuf,
        /// Why, for the largest object.
        why: String,
    },
    /// The levels make no sense.
    Options(LevelsOptionsError),
    /// No GLB can be made of the document.
    Conversion(ConversionError),
    /// The document cannot be read or changed.
    File(FileError),
}

impl fmt::Display for LevelsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::HasLevels { file, mesh } => write!(
                f,
                "{}: {mesh} has levels of detail already (MSFT_lod): start from the file that they were made from",
                file.display()
            ),
            Self::NothingLeaves { file, why } => {
                write!(f, "{}: no mesh gets coarser: {why}", file.display())
            }
            Self::Options(error) => error.fmt(f),
            Self::Conversion(error) => error.fmt(f),
            Self::File(error) => error.fmt(f),
        }
    }
}

// No `source`: the text above already says it.
impl std::error::Error for LevelsError {}

impl From<FileError> for LevelsError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

impl From<ConversionError> for LevelsError {
    fn from(error: ConversionError) -> Self {
        Self::Conversion(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(goals: LevelGoals) -> Option<LevelsOptionsError> {
        let options = LevelsOptions {
            goals,
            ..LevelsOptions::default()
        };
        options.check().err()
    }

    #[test]
    fn each_level_must_be_coarser() {
        use LevelGoals::{Errors, Faces, Ratios};
        assert_eq!(LevelsOptions::default().check(), Ok(()));
        for sound in [
            Ratios(vec![0.9, 0.1]),
            Faces(vec![1000, 10]),
            Errors(vec![ErrorLimit::Units(0.0), ErrorLimit::Units(0.5)]),
            Errors(vec![ErrorLimit::Diagonal(0.01)]),
        ] {
            assert_eq!(refusal(sound), None);
        }
        for bad in [
            Ratios(vec![0.5, 0.5]),
            Ratios(vec![1.0]),
            Ratios(vec![0.0]),
            Ratios(vec![f64::NAN]),
            Faces(vec![10, 20]),
            Faces(vec![10, 0]),
            Errors(vec![ErrorLimit::Units(0.5), ErrorLimit::Units(0.1)]),
            Errors(vec![ErrorLimit::Units(0.5), ErrorLimit::Diagonal(0.9)]),
            Errors(vec![ErrorLimit::Units(f64::INFINITY)]),
        ] {
            assert_eq!(refusal(bad), Some(LevelsOptionsError::NotCoarser));
        }
        assert_eq!(
            refusal(Ratios(Vec::new())),
            Some(LevelsOptionsError::NoLevels)
        );
        let many = Faces((1..=17).rev().collect());
        assert_eq!(
            refusal(many),
            Some(LevelsOptionsError::TooManyLevels { count: 17 })
        );
    }
}
