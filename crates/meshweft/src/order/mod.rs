//! Rendering sequences.
pub mod baselines;
