//! The caches that an order is made for, and how much time it is worth.

use std::fmt;
use std::str::FromStr;

#[cfg(doc)]
use crate::cache::nvidia::DrawCounts;
use crate::cache::{self, CacheModel, ParseCacheModelError, nvidia};
use crate::faces::Faces;

/// The caches that an order is made for.
///
/// Written and read as `universal` or as a [`CacheModel`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Target {
    /// Every cache size and every GPU at once: for files whose device is unknown.
    #[default]
    Universal,
    /// One cache.
    Cache(CacheModel),
}

impl Target {
    /// The caches that [`Universal`](Self::Universal) is judged by: FIFO caches of 10 to 64
    /// vertices and the batches of three GPUs.
    pub const UNIVERSAL: [CacheModel; 9] = [
        CacheModel::fifo(10),
        CacheModel::fifo(12),
        CacheModel::fifo(16),
        CacheModel::fifo(24),
        CacheModel::fifo(32),
        CacheModel::fifo(64),
        CacheModel::Nvidia,
        CacheModel::AMD,
        CacheModel::INTEL,
    ];

    /// The caches that it stands for.
    #[must_use]
    pub fn models(&self) -> &[CacheModel] {
        match self {
            Self::Universal => &Self::UNIVERSAL,
            Self::Cache(model) => std::slice::from_ref(model),
        }
    }

    /// What this face order costs: the misses, added up over [`models`](Self::models); for
    /// [`CacheModel::Nvidia`] also the warps and the setup cycles, weighed so that a closed mesh has as much
    /// of each as of invocations where all are least ([`DrawCounts::cost`]).
    ///
    /// # Complexity
    /// As [`cache::misses_of`].
    #[must_use]
    pub fn cost<'a>(&self, faces: impl Into<Faces<'a>>) -> u64 {
        let faces = faces.into();
        let (card, others): (Vec<_>, Vec<_>) = self
            .models()
            .iter()
            .partition(|&&model| model == CacheModel::Nvidia);
        let of_card = match card.is_empty() {
            true => 0,
            false => nvidia::counts(faces).cost(),
        };
        of_card + cache::misses_of(faces, &others).iter().sum::<u64>()
    }

    /// The misses of this face order, added up over [`models`](Self::models).
    ///
    /// # Complexity
    /// As [`cache::misses_of`].
    #[must_use]
    pub fn misses<'a>(&self, faces: impl Into<Faces<'a>>) -> u64 {
        cache::misses_of(faces, self.models()).iter().sum()
    }
}

impl From<CacheModel> for Target {
    fn from(model: CacheModel) -> Self {
        Self::Cache(model)
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Universal => f.write_str("universal"),
            Self::Cache(model) => model.fmt(f),
        }
    }
}

impl FromStr for Target {
    type Err = ParseTargetError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "universal" => Ok(Self::Universal),
            _ => text.parse().map(Self::Cache).map_err(ParseTargetError),
        }
    }
}

/// Why a text is not the name of a [`Target`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParseTargetError(ParseCacheModelError);

impl fmt::Display for ParseTargetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, or universal", self.0)
    }
}

impl std::error::Error for ParseTargetError {}

/// How much time an order is worth.
///
/// Written as `fast`, `best`, `max`. Times over that of [`Fast`](Self::Fast), on three meshes of 13 to
/// 97 thousand faces and one thread (the ratios of what `cd compare && cargo run --release --bin search`
/// prints):
///
/// | target | `Best` | `Max` |
/// |---|--:|--:|
/// | universal | 3 | 14 to 16 |
/// | NVIDIA | 7 to 8 | 180 to 240 |
/// | FIFO, LRU | 21 to 23 | 310 to 380 |
/// | controllable | 13 to 15 | 200 to 240 |
/// | other GPUs | 11 to 23 | 155 to 390 |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
#[non_exhaustive]
pub enum Effort {
    /// One greedy pass; for the universal target and NVIDIA the best of three continuations, which takes
    /// about six times as long.
    #[default]
    Fast,
    /// A search.
    Best,
    /// A long search.
    Max,
}

impl fmt::Display for Effort {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Fast => "fast",
            Self::Best => "best",
            Self::Max => "max",
        })
    }
}
