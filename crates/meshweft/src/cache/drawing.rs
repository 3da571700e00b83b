//! A vertex cache of any kind that the program does not control, face by face.

use super::batch::Batches;
use super::fifo::Fifo;
use super::lru::Lru;
use super::model::CacheModel;

/// The state of a cache while faces are drawn.
#[derive(Debug, Clone)]
pub(crate) enum Drawing {
    Fifo(Fifo),
    Lru(Lru),
    Batches(Batches),
}

impl Drawing {
    /// An empty cache; `None` if the program controls it.
    pub(crate) fn new(model: CacheModel, vertex_count: usize) -> Option<Self> {
        match model {
            CacheModel::Fifo { size } => Some(Self::Fifo(Fifo::new(size, vertex_count))),
            CacheModel::Lru { size } => Some(Self::Lru(Lru::new(size, vertex_count))),
            CacheModel::Batch(batch) => Some(Self::Batches(Batches::new(batch, vertex_count))),
            CacheModel::Controllable { .. } => None,
        }
    }

    /// Which corners of a face are not there as it starts.
    pub(crate) fn missing(&self, face: [u32; 3]) -> [bool; 3] {
        match self {
            Self::Fifo(cache) => face.map(|v| !cache.contains(v)),
            Self::Lru(cache) => face.map(|v| !cache.contains(v)),
            Self::Batches(cache) => cache.missing(face),
        }
    }

    /// Draws a face; how many of its corners missed.
    pub(crate) fn draw(&mut self, face: [u32; 3]) -> u8 {
        match self {
            Self::Fifo(cache) => face.map(|v| u8::from(cache.miss(v))).iter().sum(),
            Self::Lru(cache) => face.map(|v| u8::from(cache.miss(v))).iter().sum(),
            Self::Batches(cache) => cache.draw(face),
        }
    }
}
