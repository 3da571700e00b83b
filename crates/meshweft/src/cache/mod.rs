//! What a vertex cache does, and how often an order misses it.
//!
//! A GPU keeps the vertices that it transformed last. A vertex that is still kept costs nothing
//! when a face is drawn; a *miss* transforms (and fetches) it again. Four kinds of cache are
//! modelled: first-in first-out (fixed-function hardware), least recently used, *controllable* (the
//! program decides which vertex leaves; Lin & Yu 2006, doi:10.1109/TVCG.2006.59) and today's GPUs,
//! which collect faces in batches: three by meshoptimizer's settings, and [`nvidia`] exactly. Read [`CacheModel`] first, then [`report`].
//!
//! | metric | is |
//! |---|---|
//! | ACMR | misses per face: 3 at worst, about 0.5 at best on a closed mesh |
//! | ATVR | misses per used vertex: 1 at best |
//! | overfetch | bytes fetched over bytes of the used vertices: 1 at best |

mod batch;
mod controllable;
mod drawing;
mod fifo;
mod fifos;
mod lru;
mod metrics;
mod model;
pub mod nvidia;

pub use controllable::{CacheEvent, Schedule, ScheduleError};
pub(crate) use drawing::Drawing;
pub(crate) use fifo::Fifo;
pub use metrics::{CacheReport, acmr, atvr, misses, misses_of, misses_per_face, overfetch, report};
pub(crate) use metrics::{fetched, ratio, used_vertices};
pub use model::{BatchModel, CacheModel, MAX_CACHE_SIZE, MIN_CACHE_SIZE, ParseCacheModelError};
