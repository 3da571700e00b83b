//! First in, first out: a hit changes nothing, so membership is "among the last K pushes".

/// A FIFO cache over numbered vertices: one time stamp each.
#[derive(Debug, Clone)]
pub(crate) struct Fifo {
    size: u64,
    /// Number of pushes so far, plus `size + 1`, so that stamp 0 is never in the cache.
    clock: u64,
    entered: Vec<u64>,
}

impl Fifo {
    pub(crate) fn new(size: u32, vertex_count: usize) -> Self {
        Self {
            size: u64::from(size),
            clock: u64::from(size) + 1,
            entered: vec![0; vertex_count],
        }
    }

    #[inline]
    pub(crate) fn contains(&self, vertex: u32) -> bool {
        self.age(vertex) <= self.size
    }

    /// Pushes since the last push of `vertex`, itself included; more than the size if it is not in
    /// the cache.
    #[inline]
    pub(crate) fn age(&self, vertex: u32) -> u64 {
        self.clock - self.entered[vertex as usize]
    }

    /// Uses `vertex` and pushes it if it is not in the cache; returns whether it missed.
    #[inline]
    pub(crate) fn miss(&mut self, vertex: u32) -> bool {
        let missed = !self.contains(vertex);
        if missed {
            self.entered[vertex as usize] = self.clock;
            self.clock += 1;
        }
        missed
    }

    /// Forgets all vertices.
    pub(crate) fn clear(&mut self) {
        self.clock += self.size + 1;
    }
}
