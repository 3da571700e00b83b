//! Indices of 16 or 32 bits.

/// Indices of slots, three a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SlotIndices<'a> {
    /// Of 16 bits.
    Narrow(&'a [u16]),
    /// Of 32 bits.
    Wide(&'a [u32]),
}

impl SlotIndices<'_> {
    /// How many indices there are.
    #[must_use]
    pub fn len(self) -> usize {
        match self {
            Self::Narrow(indices) => indices.len(),
            Self::Wide(indices) => indices.len(),
        }
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// How many bytes an index has.
    #[must_use]
    pub fn index_size(self) -> usize {
        match self {
            Self::Narrow(_) => 2,
            Self::Wide(_) => 4,
        }
    }

    /// The three indices of a face.
    ///
    /// # Panics
    /// If the buffer has no such place.
    #[must_use]
    pub fn face(self, place: usize) -> [u32; 3] {
        [0, 1, 2].map(|corner| match self {
            Self::Narrow(indices) => u32::from(indices[3 * place + corner]),
            Self::Wide(indices) => indices[3 * place + corner],
        })
    }
}

/// Faces as indices of the size that they need.
#[derive(Debug, Clone)]
pub(super) enum IndexArray {
    Narrow(Vec<u16>),
    Wide(Vec<u32>),
}

impl IndexArray {
    pub(super) fn as_slice(&self) -> SlotIndices<'_> {
        match self {
            Self::Narrow(indices) => SlotIndices::Narrow(indices),
            Self::Wide(indices) => SlotIndices::Wide(indices),
        }
    }

    /// No face; keeps the memory unless the size of indices is another.
    pub(super) fn restart(&mut self, is_narrow: bool) {
        match self {
            Self::Narrow(indices) if is_narrow => indices.clear(),
            Self::Wide(indices) if !is_narrow => indices.clear(),
            Self::Narrow(_) => *self = Self::Wide(Vec::new()),
            Self::Wide(_) => *self = Self::Narrow(Vec::new()),
        }
    }

    /// Makes the number of faces this one; those that come are degenerate.
    #[inline]
    pub(super) fn resize(&mut self, faces: usize) {
        match self {
            Self::Narrow(indices) => indices.resize(3 * faces, 0),
            Self::Wide(indices) => indices.resize(3 * faces, 0),
        }
    }

    /// Writes a face. An index that has no room is 0.
    #[inline]
    pub(super) fn write(&mut self, place: u32, slots: [u32; 3]) {
        let start = 3 * place as usize;
        match self {
            Self::Narrow(indices) => {
                let narrow = |slot| u16::try_from(slot).unwrap_or(0);
                indices[start..start + 3].copy_from_slice(&slots.map(narrow));
            }
            Self::Wide(indices) => indices[start..start + 3].copy_from_slice(&slots),
        }
    }
}
