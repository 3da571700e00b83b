//! Orders of the faces of a batch, grown from a first face, and what they cost.

use super::batch::{BESIDE_SIZE, Batch, MOST_FACES, MOST_VERTICES, all};
use crate::cache::nvidia::{Setup, WINDOW};

/// What an order of a batch costs: less is better, lost vertices first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Cost {
    /// Corners whose vertex fell out of the window, so that it is transformed again.
    pub(super) lost: u32,
    /// Setup cycles in 64ths, and the misses of the FIFO cache by their weight.
    pub(super) weighed: u32,
}

/// So few candidates are looked at one by one.
const FEW: u32 = 4;
/// A setup cycle in [`Cost::weighed`].
const CYCLE: u32 = 64;

/// Draws the faces of batches one by one and counts; `BESIDE`: misses of the FIFO cache too.
#[derive(Debug, Clone)]
pub(super) struct Grower<const BESIDE: bool> {
    /// How many of the next faces are candidates.
    reach: u32,
    /// What a miss of the FIFO cache weighs.
    beside: u32,
    /// The vertices that the FIFO cache took in last, in a ring.
    pushed: [u32; BESIDE_SIZE as usize],
    /// The place of the oldest of them.
    oldest: usize,
    /// The state at the start of a batch.
    fresh: BatchState,
    state: BatchState,
    /// The faces in the order in which they were drawn.
    order: [u8; MOST_FACES],
    best: [u8; MOST_FACES],
}

/// What drawing a face changes.
#[derive(Debug, Clone)]
struct BatchState {
    setup: Setup,
    /// The faces that have an odd number of corners in the slots, and those that have two or three.
    /// Not kept where few candidates are looked at.
    odd: u32,
    two_or_three: u32,
    /// How many faces are drawn.
    drawn: u8,
    undrawn: u32,
    vertices: [Vertex; MOST_VERTICES],
    /// Pushes into the FIFO cache.
    pushes: u8,
    cost: Cost,
}

#[derive(Debug, Clone, Copy)]
struct Vertex {
    /// The number of its last corner; [`NEVER`] before the first.
    last: u8,
    /// How many undrawn faces it has.
    left: u8,
    /// When it entered the FIFO cache, in pushes; 0: it never did.
    entered: u8,
}

/// As the number of a vertex's last corner: it was not used. From any corner of the batch to this one
/// it is, wrapped, [`UNUSED`] corners or more.
const NEVER: u8 = 160;
const UNUSED: u8 = 96;

/// What a candidate's vertex is worth by how many undrawn faces it has, this one among them.
#[expect(clippy::cast_possible_truncation, reason = "small numbers")]
const OF_LEFT: [i8; 64] = {
    let mut worth = [0; 64];
    worth[1] = 6;
    let mut left = 2;
    while left < 64 {
        worth[left] = 1 - left as i8;
        left += 1;
    }
    worth
};

/// What it is worth by how many corners ago it was used.
#[expect(clippy::cast_possible_truncation, reason = "small numbers")]
const OF_USE: [i8; 256] = {
    let mut worth = [-8; 256];
    let mut corners = 0;
    while corners < UNUSED as usize {
        let faces = corners / 3;
        worth[corners] = if faces < 8 { faces as i8 } else { 8 };
        if faces >= 11 {
            worth[corners] += 40;
        }
        corners += 1;
    }
    worth
};

/// The pushes at the start of a batch: what is in the FIFO cache then entered after push 0.
#[expect(clippy::cast_possible_truncation, reason = "10")]
const FIRST_PUSH: u8 = BESIDE_SIZE as u8 + 1;

impl Default for BatchState {
    fn default() -> Self {
        Self {
            setup: Setup::default(),
            odd: 0,
            two_or_three: 0,
            drawn: 0,
            undrawn: 0,
            vertices: [Vertex {
                last: NEVER,
                left: 0,
                entered: 0,
            }; MOST_VERTICES],
            pushes: FIRST_PUSH,
            cost: Cost {
                lost: 0,
                weighed: 0,
            },
        }
    }
}

impl BatchState {
    /// Counts the corners in the slots for the faces at the vertices that came or went; before, the slots
    /// kept `before`. One bit a face, all faces at once.
    #[inline]
    fn note_kept(&mut self, batch: &Batch, before: u32) {
        let now = self.setup.kept();
        for vertex in bits(now & !before) {
            let faces = batch.faces_at(vertex);
            self.two_or_three ^= faces & self.odd;
            self.odd ^= faces;
        }
        for vertex in bits(before & !now) {
            let faces = batch.faces_at(vertex);
            self.odd ^= faces;
            self.two_or_three ^= faces & self.odd;
        }
    }

    /// Whether a vertex is not in the FIFO cache.
    #[inline]
    fn is_outside(&self, vertex: &Vertex) -> bool {
        u32::from(self.pushes - vertex.entered) > BESIDE_SIZE
    }
}

impl<const BESIDE: bool> Grower<BESIDE> {
    pub(super) fn new(reach: u32, beside: u32) -> Self {
        Self {
            reach,
            beside,
            pushed: [u32::MAX; BESIDE_SIZE as usize],
            oldest: 0,
            fresh: BatchState::default(),
            state: BatchState::default(),
            order: [0; MOST_FACES],
            best: [0; MOST_FACES],
        }
    }

    /// Draws a face in the FIFO cache for good.
    #[inline]
    pub(super) fn passed(&mut self, face: [u32; 3]) {
        if !BESIDE {
            return;
        }
        for vertex in face {
            if !self.pushed.contains(&vertex) {
                self.pushed[self.oldest] = vertex;
                self.oldest = (self.oldest + 1) % self.pushed.len();
            }
        }
    }

    /// Comes to a batch; returns what it costs as it stands.
    pub(super) fn replay(&mut self, batch: &Batch) -> Cost {
        self.enter(batch);
        self.state.clone_from(&self.fresh);
        for face in 0..batch.len() {
            self.draw(batch, face);
        }
        self.best = self.order;
        self.state.cost
    }

    /// Sets the state before the first face of a batch.
    fn enter(&mut self, batch: &Batch) {
        self.fresh = BatchState {
            undrawn: all(batch.len()),
            ..BatchState::default()
        };
        for (number, state) in self.fresh.vertices.iter_mut().enumerate() {
            state.left = ones(batch.faces_at(number));
        }
        if BESIDE {
            let (newer, older) = self.pushed.split_at(self.oldest);
            for (entered, &vertex) in (1..).zip(older.iter().chain(newer)) {
                if let Some(number) = batch.number_of(vertex) {
                    self.fresh.vertices[number].entered = entered;
                }
            }
        }
    }

    /// The best order found: as the batch stands, which costs `before`, or grown from one of the first
    /// `starts` faces with the fewest neighbours, of those that may start; and its cost.
    pub(super) fn best(
        &mut self,
        batch: &Batch,
        before: Cost,
        starts: u32,
        may_start: impl Fn(usize) -> bool,
    ) -> ([u8; MOST_FACES], Cost) {
        // One cycle a face, and two more for the first.
        let floor = Cost {
            lost: 0,
            weighed: CYCLE * (batch.face_count() + 2),
        };
        let mut least = before;
        let mut firsts = lowest(batch.firsts(), self.reach);
        for _ in 0..starts {
            if firsts == 0 || (!BESIDE && least <= floor) {
                break;
            }

            // The next face to start with.
            let left = |vertex: usize| u32::from(self.fresh.vertices[vertex].left);
            let neighbours = |face: &usize| -> u32 { batch.corners(*face).map(left).iter().sum() };
            let start = bits(firsts).min_by_key(neighbours).unwrap_or(0);
            firsts &= !(1 << start);
            if !may_start(start) {
                continue;
            }

            // Grow.
            let cost = self.grow(batch, start, least);
            if cost < least {
                least = cost;
                self.best = self.order;
            }
        }
        (self.best, least)
    }

    /// What an order costs that starts with `start`; it is given up where it cannot cost less than
    /// `least` any more.
    fn grow(&mut self, batch: &Batch, start: usize, least: Cost) -> Cost {
        self.state.clone_from(&self.fresh);
        for face in 0..batch.fixed() {
            self.draw(batch, face);
        }
        let mut next = start;
        loop {
            for face in batch.together(next) {
                self.draw(batch, face);
            }
            let state = &self.state;
            let at_least = Cost {
                weighed: state.cost.weighed + CYCLE * (batch.face_count() - u32::from(state.drawn)),
                ..state.cost
            };
            if state.undrawn == 0 || at_least >= least {
                return at_least;
            }
            next = self.next(batch, batch.firsts());
        }
    }

    /// The face to draw next, of those that begin a polygon.
    #[inline]
    fn next(&self, batch: &Batch, firsts: u32) -> usize {
        let open = lowest(self.state.undrawn & firsts, self.reach);
        let candidates = match self.reach {
            ..=FEW => open,
            _ => self.with_most_kept(open),
        };

        // The best of them, ties to the first; of a few, how many corners are kept comes before all.
        let mut best = (i32::MIN, 0);
        for face in bits(candidates) {
            let mut value = self.value(batch, face);
            if self.reach <= FEW {
                let kept = self.state.setup.kept();
                let missing = batch.lanes(face).map(|lane| !(kept >> lane) & 1);
                let misses: u32 = missing.iter().sum();
                value -= 1000 * misses.max(1).cast_signed();
            }
            if value > best.0 {
                best = (value, face);
            }
        }
        best.1
    }

    /// Those of the faces that have most corners in the slots, where two are as good as three: the
    /// third costs no cycle.
    #[inline]
    fn with_most_kept(&self, open: u32) -> u32 {
        match (open & self.state.two_or_three, open & self.state.odd) {
            (0, 0) => open,
            (0, one) => one,
            (most, _) => most,
        }
    }

    /// How good it is to draw a face next: vertices that are finished or were used, and above all those
    /// that soon fall out of the window. Of the candidates each has as many corners in the slots.
    #[inline]
    fn value(&self, batch: &Batch, face: usize) -> i32 {
        let state = &self.state;
        let now = 3 * state.drawn;
        let mut value = 0;
        for number in batch.corners(face) {
            let vertex = &state.vertices[number];
            let since = now.wrapping_sub(vertex.last);
            value += i32::from(OF_LEFT[usize::from(vertex.left) % OF_LEFT.len()]);
            value += i32::from(OF_USE[usize::from(since)]);
            if BESIDE && state.is_outside(vertex) {
                value -= self.beside.cast_signed() * 25 / 64;
            }
        }
        value
    }

    /// Draws a face.
    #[inline]
    fn draw(&mut self, batch: &Batch, face: usize) {
        let state = &mut self.state;
        let corners = batch.corners(face);
        let kept_before = state.setup.kept();
        state.cost.weighed += CYCLE * state.setup.add(batch.lanes(face));
        if self.reach > FEW {
            state.note_kept(batch, kept_before);
        }

        for (number, now) in corners.into_iter().zip(3 * state.drawn..) {
            let vertex = state.vertices[number];
            let since = now.wrapping_sub(vertex.last);
            let is_lost = u32::from(since) > WINDOW && since < UNUSED;
            state.cost.lost += u32::from(is_lost);

            let enters = BESIDE && state.is_outside(&vertex);
            if enters {
                state.cost.weighed += self.beside;
            }
            state.vertices[number] = Vertex {
                last: now,
                left: vertex.left - 1,
                entered: if enters { state.pushes } else { vertex.entered },
            };
            state.pushes += u8::from(enters);
        }

        #[expect(clippy::cast_possible_truncation, reason = "below 32")]
        {
            self.order[usize::from(state.drawn)] = face as u8;
        }
        state.undrawn &= !(1 << face);
        state.drawn += 1;
    }
}

/// How many numbers a set has.
#[expect(clippy::cast_possible_truncation, reason = "at most 32")]
fn ones(set: u32) -> u8 {
    set.count_ones() as u8
}

/// The lowest `count` numbers of a set.
#[inline]
fn lowest(set: u32, count: u32) -> u32 {
    if count >= u32::BITS {
        return set;
    }
    let rest = (0..count).fold(set, |rest, _| rest & rest.wrapping_sub(1));
    set & !rest
}

/// The numbers in a set, ascending.
#[inline]
fn bits(mut set: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lowest = set.trailing_zeros();
        (set != 0).then(|| {
            set &= set - 1;
            lowest as usize
        })
    })
}
