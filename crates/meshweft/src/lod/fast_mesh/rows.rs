//! Rows of bytes: what is stored with vertices besides their places.

use std::collections::BTreeSet;

use crate::attribute::{AttributeInfo, Domain, Semantic};

/// The attributes of vertices, a row of bytes each; nothing where there are none.
#[derive(Debug, Clone, Default)]
pub(super) struct VertexRows {
    /// What stands in a row, one after the other.
    pub(super) layouts: Vec<AttributeInfo>,
    /// How long a row is.
    size: usize,
    bytes: Vec<u8>,
}

impl VertexRows {
    /// Rows of zeros.
    pub(super) fn zeros(layouts: Vec<AttributeInfo>, vertices: usize) -> Self {
        let size = layouts.iter().map(size_of).sum();
        Self {
            layouts,
            size,
            bytes: vec![0; vertices * size],
        }
    }

    pub(super) fn row(&self, vertex: u32) -> &[u8] {
        &self.bytes[vertex as usize * self.size..][..self.size]
    }

    pub(super) fn row_mut(&mut self, vertex: u32) -> &mut [u8] {
        &mut self.bytes[vertex as usize * self.size..][..self.size]
    }
}

/// How many bytes an element takes.
pub(super) fn size_of(info: &AttributeInfo) -> usize {
    info.components * info.component_type.size()
}

/// Whether rows have an attribute: all of vertices, but where they are.
pub(super) fn is_of_rows(info: &AttributeInfo) -> bool {
    let is_place = info.semantic == Semantic::Position && info.morph_target.is_none();
    info.domain == Domain::Vertex && !is_place && (1..=MOST_COMPONENTS).contains(&info.components)
}

/// Components of an attribute of rows.
const MOST_COMPONENTS: usize = 65_535;

/// Whether no two attributes mean the same.
pub(super) fn are_different(layouts: &[AttributeInfo]) -> bool {
    let meanings = layouts
        .iter()
        .map(|info| (&info.semantic, info.morph_target));
    meanings.collect::<BTreeSet<_>>().len() == layouts.len()
}
