//! What a simplification is asked for.

use std::fmt;

use crate::operations::options::{Options, OptionsError};
use crate::progressive::AttributeWeights;

/// How far `simplify` goes, what it keeps, and how the result is ordered.
///
/// At least one of [`ratio`](Self::ratio), [`faces`](Self::faces) and [`error`](Self::error) must be given;
/// of several, it stops at whichever comes first.
#[derive(Debug, Clone, PartialEq)]
pub struct SimplifyOptions {
    /// The share of its faces that each object keeps, from 0 to 1.
    pub ratio: Option<f64>,
    /// How many faces stay in the whole file. Each object keeps a share in proportion to its own.
    pub faces: Option<usize>,
    /// The largest error that a removal may have.
    pub error: Option<ErrorLimit>,
    /// Whether the vertices at open edges stay.
    pub lock_border: bool,
    /// Whether a part that cannot be simplified any more may leave as a whole, and a small hole close, if its extent is
    /// within the error. The last part never leaves.
    pub drop_parts: bool,
    /// What differences in attributes count.
    pub weights: AttributeWeights,
    /// From how many points of either surface the error of the result is measured, of all objects together;
    /// 0 measures nothing.
    pub samples: usize,
    /// Whether the report has the order in which vertices leave, down to the coarsest mesh. The result is the
    /// same, but takes as long as that mesh.
    pub with_removals: bool,
    /// Of how many levels, from the full mesh to the coarsest, the report has the figures; 0 for none. As
    /// [`with_removals`](Self::with_removals), this takes as long as the coarsest mesh.
    pub levels: usize,
    /// How the result is ordered. The effort is also that of the removals.
    pub ordering: Options,
}

impl Default for SimplifyOptions {
    /// Without a limit, which has to be given.
    fn default() -> Self {
        Self {
            ratio: None,
            faces: None,
            error: None,
            lock_border: false,
            drop_parts: false,
            weights: AttributeWeights::default(),
            samples: 50_000,
            with_removals: false,
            levels: 0,
            ordering: Options::default(),
        }
    }
}

/// The largest error that is allowed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ErrorLimit {
    /// In units of the positions.
    Units(f64),
    /// As a share of the diagonal of the bounding box of each object: 0.01 is 1 %.
    Diagonal(f64),
}

impl ErrorLimit {
    /// The limit for an object whose bounding box has this diagonal, in units of the positions.
    #[expect(clippy::cast_possible_truncation, reason = "an estimate is compared")]
    pub(in crate::operations) fn of_diagonal(self, diagonal: f64) -> f32 {
        match self {
            Self::Units(units) => units as f32,
            Self::Diagonal(share) => (share * diagonal) as f32,
        }
    }

    pub(in crate::operations) fn number(self) -> f64 {
        match self {
            Self::Units(number) | Self::Diagonal(number) => number,
        }
    }
}

/// Written as the program reads it: `0.01`, or `1%` of the diagonal.
impl fmt::Display for ErrorLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Units(units) => write!(f, "{units}"),
            Self::Diagonal(share) => write!(f, "{}%", share * 100.0),
        }
    }
}

impl SimplifyOptions {
    /// Whether these make sense; `simplify` checks it first.
    ///
    /// # Errors
    /// [`SimplifyOptionsError`] if they do not.
    pub fn check(&self) -> Result<(), SimplifyOptionsError> {
        self.ordering
            .check()
            .map_err(SimplifyOptionsError::Ordering)?;
        if self.ratio.is_none() && self.faces.is_none() && self.error.is_none() {
            return Err(SimplifyOptionsError::NoLimit);
        }
        let error = self.error.map(ErrorLimit::number);
        let weights = [
            self.weights.normal,
            self.weights.tex_coord,
            self.weights.color,
        ];
        let least = |number: f64| number >= 0.0 && number.is_finite();
        if self
            .ratio
            .is_some_and(|ratio| !(0.0..=1.0).contains(&ratio))
        {
            return Err(SimplifyOptionsError::OutOfRange("the ratio", "0 to 1"));
        }
        if error.is_some_and(|error| !least(error)) {
            return Err(SimplifyOptionsError::OutOfRange("the error", "0 and more"));
        }
        match weights.into_iter().all(|weight| least(weight.into())) {
            true => Ok(()),
            false => Err(SimplifyOptionsError::OutOfRange("weights", "0 and more")),
        }
    }

    /// How many of its faces an object keeps, of a file with `total`, whose objects before this one have
    /// `before`.
    pub(super) fn faces_of(&self, own: usize, before: usize, total: usize) -> usize {
        let up_to = |most: usize, faces: usize| {
            let share = most as u128 * faces as u128 / total.max(1) as u128;
            usize::try_from(share).unwrap_or(usize::MAX)
        };
        let share = self
            .faces
            .map(|most| up_to(most, before + own) - up_to(most, before));
        #[expect(
            clippy::cast_possible_truncation,
            reason = "at most the number of faces"
        )]
        #[expect(clippy::cast_sign_loss, reason = "a ratio is not negative")]
        let of_ratio = self.ratio.map(|ratio| (ratio * own as f64) as usize);
        let limits = [share, of_ratio].into_iter().flatten();
        match (limits.min(), self.error) {
            (Some(least), _) => least.clamp(1, own.max(1)),
            // Only the error is a limit.
            (None, _) => 0,
        }
    }
}

/// Options of a simplification that make no sense.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SimplifyOptionsError {
    /// Nothing says how far to go.
    NoLimit,
    /// What is out of its range, and the range.
    OutOfRange(&'static str, &'static str),
    /// The order of the result cannot be made.
    Ordering(OptionsError),
}

impl fmt::Display for SimplifyOptionsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoLimit => f.write_str("how far? Give a ratio, a number of faces, or an error"),
            Self::OutOfRange(what, range) => write!(f, "{what} out of range: {range} is allowed"),
            Self::Ordering(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for SimplifyOptionsError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_the_faces_add_up_and_none_is_left_without() {
        let options = SimplifyOptions {
            faces: Some(10),
            ..SimplifyOptions::default()
        };
        assert_eq!(options.check(), Ok(()));
        let shares =
            [(50, 0), (30, 50), (20, 80)].map(|(own, before)| options.faces_of(own, before, 100));
        assert_eq!(shares, [5, 3, 2]);
        assert_eq!(options.faces_of(1, 3, 1000), 1);
        let ratio = SimplifyOptions {
            ratio: Some(0.5),
            ..options
        };
        assert_eq!(
            [ratio.faces_of(4, 0, 1000), ratio.faces_of(1000, 0, 1000)],
            [1, 10]
        );
        let error = SimplifyOptions {
            error: Some(ErrorLimit::Diagonal(0.01)),
            ..SimplifyOptions::default()
        };
        assert_eq!((error.check(), error.faces_of(9, 0, 9)), (Ok(()), 0));
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        let refused = |options: SimplifyOptions| options.check().unwrap_err().to_string();
        let none = SimplifyOptions::default();
        assert!(refused(none.clone()).starts_with("how far?"));
        for ratio in [-0.1, 1.1, f64::NAN] {
            let ratio = Some(ratio);
            assert!(
                refused(SimplifyOptions {
                    ratio,
                    ..none.clone()
                })
                .contains("0 to 1")
            );
        }
        let error = Some(ErrorLimit::Units(-1.0));
        assert!(
            refused(SimplifyOptions {
                error,
                ..none.clone()
            })
            .contains("the error")
        );
        let mut negative = SimplifyOptions {
            ratio: Some(0.5),
            ..none
        };
        negative.weights.normal = -1.0;
        assert!(refused(negative).contains("weights"));
    }
}
