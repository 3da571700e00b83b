//! How points that were not read yet come into a hierarchy.

use std::convert::Infallible;

use super::hierarchy::VertexHierarchy;

/// Where missing blocks come from.
pub(super) trait BlockLoader {
    /// Why a block could not be read.
    type Error;

    /// Puts a block into the hierarchy, which is not missing there any more.
    fn load(&mut self, block: usize, hierarchy: &mut VertexHierarchy) -> Result<(), Self::Error>;
}

/// Nothing is missing.
#[derive(Debug, Clone, Copy)]
pub(super) struct Complete;

impl BlockLoader for Complete {
    type Error = Infallible;

    fn load(&mut self, _: usize, _: &mut VertexHierarchy) -> Result<(), Infallible> {
        Ok(())
    }
}
