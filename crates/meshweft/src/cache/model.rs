//! The cache models, as values and as text.

use std::fmt;
use std::str::FromStr;

use super::nvidia;

/// The smallest cache in which a face can be drawn.
pub const MIN_CACHE_SIZE: u32 = 3;
/// The largest cache that [`CacheModel`] reads from text.
pub const MAX_CACHE_SIZE: u32 = 65_536;

/// A FIFO cache that is emptied whenever a batch is full.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BatchModel {
    cache_size: u32,
    batch_vertices: u32,
    batch_faces: u32,
}

impl BatchModel {
    /// 32 entries, 32 vertices, 32 faces: what meshoptimizer's analyzer takes for NVIDIA. Cards do
    /// something else ([`CacheModel::Nvidia`]): 1 to 20 % more invocations.
    pub const MESHOPT_NVIDIA: Self = Self::new(32, 32, 32);
    /// 14 entries, 64 vertices, 128 faces.
    pub const AMD: Self = Self::new(14, 64, 128);
    /// 128 entries, no batches.
    pub const INTEL: Self = Self::new(128, 0, 0);

    /// A FIFO cache of `cache_size` vertices that is emptied before a face that would bring the
    /// batch to more than `batch_vertices` misses or `batch_faces` faces; 0 for no limit.
    ///
    /// # Panics
    /// If the cache size, or a limit of vertices other than 0, is below 3: no face fits.
    #[must_use]
    pub const fn new(cache_size: u32, batch_vertices: u32, batch_faces: u32) -> Self {
        assert!(cache_size >= MIN_CACHE_SIZE, "a face needs three entries");
        assert!(
            batch_vertices == 0 || batch_vertices >= MIN_CACHE_SIZE,
            "a face needs three vertices in its batch"
        );
        Self {
            cache_size,
            batch_vertices,
            batch_faces,
        }
    }

    /// Entries of the FIFO cache inside a batch.
    #[must_use]
    pub const fn cache_size(&self) -> u32 {
        self.cache_size
    }

    /// Most vertices transformed in a batch; 0 for no limit.
    #[must_use]
    pub const fn batch_vertices(&self) -> u32 {
        self.batch_vertices
    }

    /// Most faces in a batch; 0 for no limit.
    #[must_use]
    pub const fn batch_faces(&self) -> u32 {
        self.batch_faces
    }
}

/// A vertex cache; sizes are in vertices.
///
/// Written and read as `fifo:16`, `lru:32`, `controllable:12`, `nvidia`, `amd`, `intel`,
/// `meshopt-nvidia`, and other batches as `batch:20/0/9`: cache size, most vertices and most faces in a
/// batch.
///
/// Make one by a constructor, which refuses a cache in which no face can be drawn. Match with `..`.
///
/// ```
/// use meshweft::CacheModel;
/// assert_eq!("fifo:16".parse(), Ok(CacheModel::fifo(16)));
/// assert_eq!(CacheModel::fifo(16).to_string(), "fifo:16");
/// assert!(matches!(CacheModel::fifo(16), CacheModel::Fifo { size: 16, .. }));
/// ```
///
/// ```compile_fail
/// let no_face_fits = meshweft::CacheModel::Controllable { size: 2 };
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum CacheModel {
    /// The vertex that entered first leaves first; a hit changes nothing.
    #[non_exhaustive]
    Fifo {
        /// Cache size in vertices, at least [`MIN_CACHE_SIZE`].
        size: u32,
    },
    /// The least recently used vertex leaves first.
    #[non_exhaustive]
    Lru {
        /// Cache size in vertices, at least [`MIN_CACHE_SIZE`].
        size: u32,
    },
    /// The program decides which vertex leaves. A face order alone is counted with its best
    /// schedule (Belady: the vertex needed last leaves, never one of the face being drawn).
    #[non_exhaustive]
    Controllable {
        /// Cache size in vertices, at least [`MIN_CACHE_SIZE`].
        size: u32,
    },
    /// A GPU that collects faces in batches and starts each with an empty cache.
    Batch(BatchModel),
    /// An NVIDIA card as it was probed: see [`nvidia`]. Misses are invocations of
    /// the vertex shader.
    Nvidia,
}

impl CacheModel {
    /// NVIDIA's batches as meshoptimizer's analyzer sets them: 32 entries, 32 vertices, 32 faces.
    pub const MESHOPT_NVIDIA: Self = Self::Batch(BatchModel::MESHOPT_NVIDIA);
    /// AMD's batches in the same analyzer: 14 entries, 64 vertices, 128 faces.
    pub const AMD: Self = Self::Batch(BatchModel::AMD);
    /// Intel's cache in the same analyzer: 128 entries, no batches.
    pub const INTEL: Self = Self::Batch(BatchModel::INTEL);

    /// A first-in first-out cache.
    ///
    /// # Panics
    /// If `size` is below 3: no face fits.
    #[must_use]
    pub const fn fifo(size: u32) -> Self {
        assert!(size >= MIN_CACHE_SIZE, "a face needs three entries");
        Self::Fifo { size }
    }

    /// A least-recently-used cache.
    ///
    /// # Panics
    /// If `size` is below 3: no face fits.
    #[must_use]
    pub const fn lru(size: u32) -> Self {
        assert!(size >= MIN_CACHE_SIZE, "a face needs three entries");
        Self::Lru { size }
    }

    /// A cache whose evictions the program decides.
    ///
    /// # Panics
    /// If `size` is below 3: no face fits.
    #[must_use]
    pub const fn controllable(size: u32) -> Self {
        assert!(size >= MIN_CACHE_SIZE, "a face needs three entries");
        Self::Controllable { size }
    }

    /// Whether it is the model of a GPU, which collects faces in batches; misses are then given per vertex.
    #[must_use]
    pub const fn is_gpu(&self) -> bool {
        matches!(self, Self::Batch(_) | Self::Nvidia)
    }

    /// How many vertices it holds.
    #[must_use]
    pub const fn size(&self) -> u32 {
        match self {
            Self::Fifo { size } | Self::Lru { size } | Self::Controllable { size } => *size,
            Self::Batch(batch) => batch.cache_size(),
            Self::Nvidia => nvidia::LANES,
        }
    }
}

impl fmt::Display for CacheModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Fifo { size } => write!(f, "fifo:{size}"),
            Self::Lru { size } => write!(f, "lru:{size}"),
            Self::Controllable { size } => write!(f, "controllable:{size}"),
            Self::Nvidia => f.write_str("nvidia"),
            Self::MESHOPT_NVIDIA => f.write_str("meshopt-nvidia"),
            Self::AMD => f.write_str("amd"),
            Self::INTEL => f.write_str("intel"),
            Self::Batch(batch) => write!(
                f,
                "batch:{}/{}/{}",
                batch.cache_size(),
                batch.batch_vertices(),
                batch.batch_faces()
            ),
        }
    }
}

/// Why a text is not the name of a cache model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParseCacheModelError {
    text: String,
}

impl fmt::Display for ParseCacheModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:?} is not a cache model: use fifo:K, lru:K or controllable:K with K from \
             {MIN_CACHE_SIZE} to {MAX_CACHE_SIZE}, batch:K/VERTICES/FACES (0 for no limit), or \
             nvidia, amd, intel, meshopt-nvidia",
            self.text
        )
    }
}

impl std::error::Error for ParseCacheModelError {}

impl FromStr for CacheModel {
    type Err = ParseCacheModelError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let error = || ParseCacheModelError {
            text: text.to_owned(),
        };
        match text {
            "nvidia" => return Ok(Self::Nvidia),
            "meshopt-nvidia" => return Ok(Self::MESHOPT_NVIDIA),
            "amd" => return Ok(Self::AMD),
            "intel" => return Ok(Self::INTEL),
            _ => {}
        }
        let (kind, numbers) = text.split_once(':').ok_or_else(error)?;
        if kind == "batch" {
            return batch(numbers).map(Self::Batch).ok_or_else(error);
        }
        let size = number(numbers, MIN_CACHE_SIZE).ok_or_else(error)?;
        match kind {
            "fifo" => Ok(Self::Fifo { size }),
            "lru" => Ok(Self::Lru { size }),
            "controllable" => Ok(Self::Controllable { size }),
            _ => Err(error()),
        }
    }
}

/// A number of digits only, from `least` to [`MAX_CACHE_SIZE`].
fn number(text: &str, least: u32) -> Option<u32> {
    let digits_only = text.bytes().all(|b| b.is_ascii_digit());
    let number = text.parse().ok().filter(|_| digits_only)?;
    (least..=MAX_CACHE_SIZE).contains(&number).then_some(number)
}

/// A limit of a batch, at least `least`, or 0 for none.
fn limit(text: &str, least: u32) -> Option<u32> {
    number(text, 0).filter(|&limit| limit == 0 || limit >= least)
}

/// `K/VERTICES/FACES`.
fn batch(numbers: &str) -> Option<BatchModel> {
    let (size, limits) = numbers.split_once('/')?;
    let (vertices, faces) = limits.split_once('/')?;
    let size = number(size, MIN_CACHE_SIZE)?;
    let (vertices, faces) = (limit(vertices, MIN_CACHE_SIZE)?, limit(faces, 1)?);
    Some(BatchModel::new(size, vertices, faces))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for name in [
            "fifo:3",
            "lru:32",
            "controllable:12",
            "nvidia",
            "amd",
            "intel",
            "meshopt-nvidia",
            "batch:20/0/9",
            "batch:3/3/0",
            "batch:65536/65536/65536",
        ] {
            assert_eq!(name.parse::<CacheModel>().unwrap().to_string(), name);
        }
        assert_eq!("batch:32/32/32".parse(), Ok(CacheModel::MESHOPT_NVIDIA));
    }

    #[test]
    fn other_texts_are_refused_with_the_remedy() {
        for name in [
            "fifo",
            "fifo:2",
            "fifo:",
            "fifo:+16",
            "fifo:99999",
            "gpu",
            "lru:1.5",
            "batch",
            "batch:20/9",
            "batch:2/0/9",
            "batch:20/2/9",
            "batch:20/0/9/1",
            "batch:20//9",
            "batch:20/0/70000",
            "",
        ] {
            let error = name.parse::<CacheModel>().unwrap_err().to_string();
            assert!(error.contains("use fifo:K"), "{error}");
        }
    }
}
