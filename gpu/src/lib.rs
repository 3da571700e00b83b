//! Draws meshes on a graphics card through Vulkan, without a window, and compares what it counts and
//! how long it takes with what the models of meshweft say.
//!
//! [`vulkan`] is all that talks to the card, and all that is unsafe. [`renderer`] counts, logs and times
//! one draw, [`frames`] whole pictures. [`predict`], [`mod@bench`], [`cull`], [`probe`] and [`paper`] are the jobs of the program `meshweft-gpu`.

#![deny(unsafe_code)]

pub mod batch_rule;
pub mod bench;
mod clock;
pub mod cull;
pub mod draw;
pub mod error;
pub mod frames;
pub mod lavapipe;
pub mod meshes;
pub mod model;
pub mod orders;
pub mod paper;
pub mod predict;
pub mod probe;
mod random;
pub mod renderer;
pub mod setup;
#[expect(unsafe_code, reason = "calls of Vulkan; each says why it is sound")]
pub mod vulkan;
pub mod workload;
