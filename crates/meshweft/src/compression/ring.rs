//! Values of the last vertices.

/// What belongs to the vertices that are near the front, by number.
#[derive(Debug)]
pub(super) struct Ring<T> {
    /// A power of two of places, each vertex at its number without the high bits.
    values: Vec<T>,
    count: u32,
    /// The most vertices that were ahead of a root.
    ahead: u32,
}

impl<T: Copy + Default> Ring<T> {
    pub(super) fn new() -> Self {
        Self {
            values: vec![T::default(); 16],
            count: 0,
            ahead: 0,
        }
    }

    /// The value of a vertex that is in a face with the root, or with one after it.
    #[inline]
    pub(super) fn get(&self, vertex: u32) -> T {
        self.values[vertex as usize & (self.values.len() - 1)]
    }

    /// The value of the next vertex, while some vertex is the root.
    ///
    /// A vertex is met when a neighbour is the root, and all faces that it has come then or later. So whatever is in a
    /// face with the root is at most `ahead` before the root, and `2 ahead` before the last vertex.
    #[inline]
    pub(super) fn push(&mut self, root: u32, value: T) {
        self.ahead = self.ahead.max(self.count - root.min(self.count));
        if 2 * self.ahead as usize + 1 >= self.values.len() {
            self.grow();
        }
        let mask = self.values.len() - 1;
        self.values[self.count as usize & mask] = value;
        self.count += 1;
    }

    #[cold]
    fn grow(&mut self) {
        // Of either half, only the places that their numbers belong to are read.
        self.values.extend_from_within(..);
    }
}
