//! Which faces of a vertex are left, and the fewest pushes that they need.

/// Writes the faces of a row that are not drawn, in their order, to the front of `buffer`, which
/// grows if it is shorter than the row; returns how many.
#[inline]
pub(in crate::order) fn gather_live(
    row: impl ExactSizeIterator<Item = u32>,
    drawn: &[bool],
    buffer: &mut Vec<u32>,
) -> usize {
    if buffer.len() < row.len() {
        buffer.resize(row.len(), 0);
    }

    // Each face is written and kept only if live: no branch for the processor to guess.
    let live = &mut buffer[..row.len()];
    let mut count = 0;
    for face in row {
        live[count] = face;
        count += usize::from(!drawn[face as usize]);
    }
    count
}

/// The fewest neighbours of a vertex that must be pushed to finish it, on a surface: `live` faces
/// are left around it, and `missing` of their other corners are not in the cache.
///
/// A neighbour is a corner of one live face, or of two if it is inside the fan: at least
/// `missing / 2` neighbours. A vertex in the cache has a drawn face, so its fan is open: at most
/// `live − 1` neighbours are counted twice, which leaves `missing − (live − 1)`.
#[inline]
pub(in crate::order) fn least_neighbours(missing: u32, live: u32) -> u32 {
    missing.div_ceil(2).max((missing + 1).saturating_sub(live))
}
