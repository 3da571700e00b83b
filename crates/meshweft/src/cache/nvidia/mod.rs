//! What an NVIDIA card does with an index list: an exact model of its vertex batches and its
//! primitive setup.
//!
//! Found by probing an H200 and an H100 (driver 580.159, Vulkan): shaders wrote which vertex ran in
//! which lane of which warp. The model gives the invocations and warps that the cards counted for every
//! triangle list tried, of up to 1.7 million vertices, and their setup cycles within .05 % (below 65,536
//! vertices). Other cards, drivers and shader stages were not probed. Strips, fans, lines and restart
//! follow the same rules on the cards' probes, but no stored counts check them here.
//!
//! # Batches
//!
//! The corners of the primitives are numbered in the order in which they are drawn. A batch takes
//! primitives until it has 32, or until the next one would bring it to more than 32 vertices. A corner
//! *misses* if its vertex was not used in this batch, or last more than 42 corners ago, or if the high 16
//! bits of the vertex number or the instance changed between two consecutive corners since (the instance
//! only where the shader reads it). Each miss
//! is one invocation of the vertex shader and takes a *lane*; a batch is a *warp*. Numbers are those
//! after the base vertex was added, so a draw whose numbers all lie in one aligned block of 65,536
//! never loses vertices by the third rule.
//!
//! # What a draw costs
//!
//! The largest of four decides: [`warps`](DrawCounts::warps) where the vertex shader computes much,
//! [`distinct_vertices`](DrawCounts::distinct_vertices) where it loads much,
//! [`setup_cycles`](DrawCounts::setup_cycles) where triangles are small or culled, and pixels.
//! Fewer invocations in as many warps save nothing by themselves.

mod batcher;
mod draw;
mod invocations;
mod setup;

pub(crate) use batcher::{BATCH_FACES, Batcher, LANES, WINDOW};
pub use draw::{Draw, DrawCounts, PrimitiveTopology, counts};
pub(crate) use invocations::invocations;
pub use setup::meshlet_setup_cycles;
pub(crate) use setup::{LaneSet, Setup};
