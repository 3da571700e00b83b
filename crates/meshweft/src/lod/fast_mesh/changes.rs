//! What a frame changed.

/// The vertices and faces that are not as they were in the frame before, by their numbers; each once.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FrontChanges {
    /// Vertices that are active now.
    pub added_vertices: Vec<u32>,
    /// Vertices that no longer are.
    pub removed_vertices: Vec<u32>,
    /// Faces that are there now.
    pub added_faces: Vec<u32>,
    /// Faces that no longer are.
    pub removed_faces: Vec<u32>,
    /// Faces that stayed and may have other corners.
    pub changed_faces: Vec<u32>,
}

impl FrontChanges {
    pub(super) fn clear(&mut self) {
        let lists = [
            &mut self.added_vertices,
            &mut self.removed_vertices,
            &mut self.added_faces,
            &mut self.removed_faces,
            &mut self.changed_faces,
        ];
        lists.into_iter().for_each(Vec::clear);
    }
}

/// Numbers that were touched, each with whether it was there before.
#[derive(Debug, Clone, Default)]
pub(super) struct Touched {
    list: Vec<(u32, bool)>,
    is_listed: Vec<u64>,
}

impl Touched {
    pub(super) fn new(count: usize) -> Self {
        Self {
            list: Vec::new(),
            is_listed: vec![0; count.div_ceil(64)],
        }
    }

    /// A number is touched; `was_there` counts if it is the first time, which is returned.
    #[inline]
    pub(super) fn touch(&mut self, number: u32, was_there: bool) -> bool {
        let word = &mut self.is_listed[number as usize / 64];
        let bit = 1 << (number % 64);
        let is_first = *word & bit == 0;
        if is_first {
            *word |= bit;
            self.list.push((number, was_there));
        }
        is_first
    }

    /// Empties it; gives each number, and whether it was there.
    pub(super) fn drain(&mut self, mut each: impl FnMut(u32, bool)) {
        for (number, was_there) in self.list.drain(..) {
            self.is_listed[number as usize / 64] &= !(1 << (number % 64));
            each(number, was_there);
        }
    }
}
