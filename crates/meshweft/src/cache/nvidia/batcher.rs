//! Primitives into batches.

use super::setup::Setup;
use crate::index::{block_of, index32};

/// Most primitives in a batch.
pub(crate) const BATCH_FACES: u32 = 32;
/// Most vertices in a batch: the threads of a warp.
pub(crate) const LANES: u32 = 32;
/// How many corners after its last use a vertex is still lookup.
pub(crate) const WINDOW: u32 = 42;
/// More than the corners of a batch, so that a free entry is always near.
const ENTRIES: usize = 256;

/// What is known of a vertex that was used in a batch.
#[derive(Debug, Clone, Copy, Default)]
struct Entry {
    vertex: u32,
    /// The batch that it was used in; the entry is free in another one.
    batch: u32,
    /// The number of its last corner in the batch.
    last: u32,
    instance: u32,
    lane: u32,
}

/// What a primitive finds: where each corner's vertex is.
#[derive(Debug, Clone, Copy, Default)]
struct Lookup {
    /// The lane of a corner that hits, or that an earlier corner of the primitive takes.
    lanes: [u32; 3],
    is_miss: [bool; 3],
    /// The entry of a corner that hits.
    entries: [usize; 3],
    misses: u32,
    /// The corner that the last change of block or instance was at, and what it changed to.
    run: u32,
    key: (u32, u32),
}

/// The batch that primitives are added to, and the counts of all batches before it.
#[derive(Debug, Clone)]
pub(crate) struct Batcher {
    /// By a hash of the vertex: costs the same for any number of vertices.
    entries: Box<[Entry; ENTRIES]>,
    /// The number of the batch, from 1.
    batch: u32,
    primitives: u32,
    lanes: u32,
    /// How many corners the batch has.
    corners: u32,
    /// The first corner in this batch after the last change of block or instance.
    run: u32,
    /// Block and instance of the last corner.
    key: (u32, u32),
    setup: Setup,
    pub(super) totals: Totals,
}

/// Counts of all batches that are closed, and of the open one but for its lanes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Totals {
    pub(super) primitives: u64,
    pub(super) invocations: u64,
    pub(super) batches: u64,
    pub(super) distinct_vertices: u64,
    pub(super) setup_cycles: u64,
    /// Batches of 29 lanes and more.
    pub(super) wide_batches: u64,
}

impl Batcher {
    /// Nothing drawn: the first primitive starts a batch.
    pub(crate) fn new() -> Self {
        Self {
            entries: Box::new([Entry::default(); ENTRIES]),
            batch: 1,
            primitives: 0,
            lanes: 0,
            corners: 0,
            run: 0,
            key: (u32::MAX, u32::MAX),
            setup: Setup::default(),
            totals: Totals::default(),
        }
    }

    /// How many primitives the open batch has.
    #[inline]
    pub(crate) fn primitives(&self) -> u32 {
        self.primitives
    }

    /// Invocations so far.
    pub(crate) fn invocations(&self) -> u64 {
        self.totals.invocations
    }

    /// Whether this face goes into the open batch.
    #[inline]
    pub(crate) fn fits(&self, face: [u32; 3]) -> bool {
        self.primitives < BATCH_FACES && self.has_room(self.find(&face, 0).misses)
    }

    /// Which corners miss if this face is drawn next.
    pub(crate) fn missing(&self, corners: [u32; 3]) -> [bool; 3] {
        let lookup = self.find(&corners, 0);
        match self.has_room(lookup.misses) {
            true => lookup.is_miss,
            false => Self::find_in_empty(&corners, 0, self.key).is_miss,
        }
    }

    /// Closes the batch: the next primitive starts one.
    pub(crate) fn close(&mut self) {
        if self.primitives == 0 {
            return;
        }
        self.totals.wide_batches += u64::from(self.lanes > 28);
        self.primitives = 0;
        self.lanes = 0;
        self.corners = 0;
        self.run = 0;
        self.setup = Setup::default();
        self.batch = self.batch.checked_add(1).unwrap_or_else(|| {
            *self.entries = [Entry::default(); ENTRIES];
            1
        });
    }

    /// Draws a primitive of 2 or 3 corners; returns how many missed.
    #[inline]
    pub(crate) fn draw<const CORNERS: usize>(
        &mut self,
        corners: &[u32; CORNERS],
        instance: u32,
    ) -> u8 {
        // Into this batch or the next.
        let mut lookup = self.find(corners, instance);
        if !self.has_room(lookup.misses) {
            let key = self.key;
            self.close();
            lookup = Self::find_in_empty(corners, instance, key);
        }
        if self.primitives == 0 {
            self.totals.batches += 1;
            self.totals.setup_cycles += 1;
        }

        // Lanes for the misses, in corner order; a vertex twice in the primitive is one.
        let mut lanes = [0; CORNERS];
        let mut misses = 0;
        for (i, &vertex) in corners.iter().enumerate() {
            lanes[i] = match (lookup.is_miss[i], lookup.lanes[i]) {
                (true, _) => {
                    misses += 1;
                    self.lanes + misses - 1
                }
                (false, earlier @ SAME_PRIMITIVE..) => lanes[(earlier - SAME_PRIMITIVE) as usize],
                (false, lane) => lane,
            };

            // Note the use.
            if lookup.is_miss[i] {
                self.enter(vertex, instance, lanes[i], self.corners + index32(i));
            } else {
                let at = match lookup.lanes[i] {
                    SAME_PRIMITIVE.. => self.entry(vertex),
                    _ => lookup.entries[i],
                };
                self.entries[at].last = self.corners + index32(i);
            }
        }
        self.lanes += misses;
        self.corners += index32(CORNERS);
        self.run = lookup.run;
        self.key = lookup.key;
        self.primitives += 1;

        // Count.
        self.totals.primitives += 1;
        self.totals.invocations += u64::from(misses);
        if let [a, b, c] = lanes[..] {
            self.totals.setup_cycles += u64::from(self.setup.add([a, b, c]));
        }
        #[expect(clippy::cast_possible_truncation, reason = "at most three")]
        {
            misses as u8
        }
    }

    fn has_room(&self, misses: u32) -> bool {
        self.primitives < BATCH_FACES && self.lanes + misses <= LANES
    }

    /// What these corners find in the open batch.
    #[inline]
    fn find<const CORNERS: usize>(&self, corners: &[u32; CORNERS], instance: u32) -> Lookup {
        let mut lookup = Lookup {
            run: self.run,
            key: self.key,
            ..Lookup::default()
        };
        for (i, &vertex) in corners.iter().enumerate() {
            let now = self.corners + index32(i);
            lookup.come_to(now, vertex, instance);

            // An earlier corner of the primitive, or the batch's last use.
            if let Some(lane) = lookup.same_primitive(corners, i, self.corners) {
                lookup.lanes[i] = lane;
                continue;
            }
            let at = self.entry(vertex);
            let entry = &self.entries[at];
            let is_hit =
                entry.batch == self.batch && entry.last >= lookup.run && now - entry.last <= WINDOW;
            lookup.entries[i] = at;
            lookup.lanes[i] = entry.lane;
            lookup.is_miss[i] = !is_hit;
            lookup.misses += u32::from(!is_hit);
        }
        lookup
    }

    /// What these corners find in an empty batch, after a corner of `key`.
    fn find_in_empty(corners: &[u32], instance: u32, key: (u32, u32)) -> Lookup {
        let mut lookup = Lookup {
            key,
            ..Lookup::default()
        };
        for (i, &vertex) in corners.iter().enumerate() {
            lookup.come_to(index32(i), vertex, instance);
            match lookup.same_primitive(corners, i, 0) {
                Some(lane) => lookup.lanes[i] = lane,
                None => {
                    lookup.is_miss[i] = true;
                    lookup.misses += 1;
                }
            }
        }
        lookup
    }

    /// The entry of a vertex in this batch, or a free one.
    #[inline]
    fn entry(&self, vertex: u32) -> usize {
        // Fibonacci hashing: the top 8 bits.
        let mut at = (vertex.wrapping_mul(0x9e37_79b9) >> 24) as usize;
        loop {
            let entry = &self.entries[at];
            if entry.batch != self.batch || entry.vertex == vertex {
                return at;
            }
            at = (at + 1) % ENTRIES;
        }
    }

    /// Notes that a vertex takes a lane.
    #[inline]
    fn enter(&mut self, vertex: u32, instance: u32, lane: u32, now: u32) {
        let at = self.entry(vertex);
        let entry = &mut self.entries[at];
        let is_known = entry.batch == self.batch && entry.instance == instance;
        self.totals.distinct_vertices += u64::from(!is_known);
        *entry = Entry {
            vertex,
            batch: self.batch,
            last: now,
            instance,
            lane,
        };
    }
}

/// In [`Lookup::lanes`]: the lane of an earlier corner of the same primitive, plus its number.
const SAME_PRIMITIVE: u32 = 1 << 16;

impl Lookup {
    /// Comes to a corner: a run starts where block or instance change.
    #[inline]
    fn come_to(&mut self, now: u32, vertex: u32, instance: u32) {
        let key = (block_of(vertex), instance);
        if key != self.key {
            self.run = now;
            self.key = key;
        }
    }

    /// [`SAME_PRIMITIVE`] plus the number of the last earlier corner that is the same vertex, if that
    /// is in the run; the first corner of the primitive is number `start` in the batch.
    #[inline]
    fn same_primitive(&self, corners: &[u32], corner: usize, start: u32) -> Option<u32> {
        let earlier = corners[..corner]
            .iter()
            .rposition(|&v| v == corners[corner])?;
        let is_in_run = start + index32(earlier) >= self.run;
        is_in_run.then_some(SAME_PRIMITIVE + index32(earlier))
    }
}
