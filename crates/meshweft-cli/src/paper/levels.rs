//! Levels of a mesh that gets coarser, and the misses of sequences that follow.

use meshweft::operations::{Method, SequenceUpdate};
use meshweft::progressive::History;
use meshweft::{CacheModel, FaceOrder, MeshError, cache};

/// Misses per face of a FIFO cache at each level, of the sequence kept up by an update.
pub(super) fn updated(
    update: SequenceUpdate,
    history: &History,
    order: &FaceOrder,
    levels: &[usize],
    size: u32,
) -> Result<Vec<f64>, MeshError> {
    let mut acmr = Vec::new();
    update.at_levels(history, order, levels.iter().copied(), |faces| {
        acmr.push(cache::acmr(faces, CacheModel::fifo(size)));
    })?;
    Ok(acmr)
}

/// Misses per face of a FIFO cache at each level, ordered for it alone.
pub(super) fn ordered_again(
    method: Method,
    history: &History,
    levels: &[usize],
    size: u32,
) -> Result<Vec<f64>, MeshError> {
    let full = FaceOrder::identity(history.full_faces().len());
    let mut acmr = Vec::new();
    let levels = levels.iter().copied();
    SequenceUpdate::Simple.at_levels(history, &full, levels, |faces| {
        let faces = method.order(faces).apply(faces);
        acmr.push(cache::acmr(&faces, CacheModel::fifo(size)));
    })?;
    Ok(acmr)
}
