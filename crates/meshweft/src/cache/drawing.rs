//! Drawing faces with any kind of vertex cache that the program does not control.

use super::batch::Batches;
use super::fifo::Fifo;
use super::lru::Lru;
use super::model::CacheModel;
use super::nvidia::Batcher;

/// The state of a cache while faces are drawn.
#[derive(Debug, Clone)]
pub(crate) enum Drawing {
    Fifo(Fifo),
    Lru(Lru),
    Batches(Batches),
    Nvidia(Batcher),
}

impl Drawing {
    /// An empty cache; `None` if the program controls it.
    pub(crate) fn new(model: CacheModel, vertex_count: usize) -> Option<Self> {
        match model {
            CacheModel::Fifo { size } => Some(Self::Fifo(Fifo::new(size, vertex_count))),
            CacheModel::Lru { size } => Some(Self::Lru(Lru::new(size, vertex_count))),
            CacheModel::Batch(batch) => Some(Self::Batches(Batches::new(batch, vertex_count))),
            CacheModel::Nvidia => Some(Self::Nvidia(Batcher::new())),
            CacheModel::Controllable { .. } => None,
        }
    }

    /// Which corners of a face are not in the cache before it is drawn.
    pub(crate) fn missing(&self, face: [u32; 3]) -> [bool; 3] {
        match self {
            Self::Fifo(cache) => face.map(|v| !cache.contains(v)),
            Self::Lru(cache) => face.map(|v| !cache.contains(v)),
            Self::Batches(cache) => cache.missing(face),
            Self::Nvidia(batcher) => batcher.missing(face),
        }
    }

    /// Draws faces one after the other; calls `visit` with the number of each and how many of its
    /// corners missed.
    pub(crate) fn draw_all(&mut self, faces: &[[u32; 3]], mut visit: impl FnMut(usize, u8)) {
        // A loop of its own for each kind, so the kind is matched once, not per face.
        let numbered = faces.iter().enumerate();
        match self {
            Self::Fifo(cache) => {
                numbered.for_each(|(number, face)| visit(number, misses(face, |v| cache.miss(v))))
            }
            Self::Lru(cache) => {
                numbered.for_each(|(number, face)| visit(number, misses(face, |v| cache.miss(v))))
            }
            Self::Batches(cache) => {
                numbered.for_each(|(number, &face)| visit(number, cache.draw(face)));
            }
            Self::Nvidia(batcher) => {
                numbered.for_each(|(number, face)| visit(number, batcher.draw(face, 0)));
            }
        }
    }

    /// Draws a face; returns how many of its corners missed.
    pub(crate) fn draw(&mut self, face: [u32; 3]) -> u8 {
        match self {
            Self::Fifo(cache) => misses(&face, |v| cache.miss(v)),
            Self::Lru(cache) => misses(&face, |v| cache.miss(v)),
            Self::Batches(cache) => cache.draw(face),
            Self::Nvidia(batcher) => batcher.draw(&face, 0),
        }
    }
}

/// How many corners miss, when used one after the other.
#[inline]
fn misses(face: &[u32; 3], mut miss: impl FnMut(u32) -> bool) -> u8 {
    face.map(|v| u8::from(miss(v))).iter().sum()
}
