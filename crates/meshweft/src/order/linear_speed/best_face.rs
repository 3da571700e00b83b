//! Which face is drawn next.

/// The face with the greatest score, of those that were offered the first.
#[derive(Clone, Copy, Default)]
pub(super) struct BestFace {
    /// 0 where none was offered.
    pub(super) score: f32,
    pub(super) face: u32,
}

impl BestFace {
    #[inline]
    pub(super) fn offer(&mut self, score: f32, face: u32) {
        if score > self.score {
            *self = Self { score, face };
        }
    }
}
