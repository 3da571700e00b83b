//! The order of minimum-time rendering, made good for small caches on the way.

use crate::faces::Faces;
use crate::index::{MAX_FACES, index32};
use crate::permutation::{FaceOrder, Permutation};

/// How many faces are ordered together.
///
/// More faces miss less in a cache that has room for what is then drawn, and take a larger buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum WindowSize {
    /// This many faces for each vertex that the first-in first-out buffer holds at the time, of which 16
    /// are taken at least. A ring around what is drawn has about two faces a vertex, so this is twice the
    /// number of rings that are drawn across.
    OfBuffer(u32),
    /// This many faces, at least one: to compare, or where the required buffer size is known before.
    Faces(u32),
}

impl Default for WindowSize {
    /// Three rings: [`OfBuffer(6)`](Self::OfBuffer).
    fn default() -> Self {
        Self::OfBuffer(6)
    }
}

/// Vertices in the buffer that a window is made for at least.
const LEAST_HELD: u32 = 16;
/// A window ends where its roots are this many times as many as its faces, and as many more.
const SPARSE: usize = 8;

impl WindowSize {
    /// The faces of a window while the buffer holds this many vertices.
    #[inline]
    fn limit(self, held: u32) -> usize {
        let faces = match self {
            Self::OfBuffer(scale) => scale.saturating_mul(held.max(LEAST_HELD)),
            Self::Faces(count) => count,
        };
        (faces.max(1) as usize).min(MAX_FACES)
    }
}

/// Faces in the order of their least vertices, given out window by window in an order that is good for small
/// caches too.
///
/// In the order of their least vertices the faces go around what was drawn, ring after ring. A ring is longer
/// than a small cache, so each vertex is missed twice: in the ring that brings it in, and in the next. So a
/// window of some rings is drawn *across*: a root draws its faces, and each vertex for which no other root of
/// the window is left but the one before it draws its own at once, before the next root has its turn. One end
/// of each column is missed twice then, and the sweep still goes around once: the buffer, whose slots are
/// freed after the last face of a vertex, stays about as large as it was
/// ([`released_buffer_size`](super::released_buffer_size)).
///
/// It takes no bits, knows no cache size, and calculates in integers. Corners are not turned.
///
/// ```
/// use meshweft::connectivity::{WindowOrder, WindowSize};
/// use meshweft::{CacheModel, cache};
/// // A strip of 40 rows of 30 squares, row by row.
/// let square = |i: u32| [[i, i + 1, i + 31], [i + 1, i + 32, i + 31]];
/// let faces: Vec<_> = (0..40 * 31).filter(|i| i % 31 < 30).flat_map(square).collect();
/// let mut windows = WindowOrder::new(WindowSize::default());
/// let mut drawn = Vec::new();
/// for face in &faces {
///     drawn.extend(windows.push(*face).into_iter().flat_map(|window| window.faces));
/// }
/// drawn.extend(windows.finish().into_iter().flat_map(|window| window.faces));
/// let acmr = [&faces, &drawn].map(|faces| cache::acmr(faces, CacheModel::fifo(16)));
/// assert!(acmr[0] > 1.0 && acmr[1] < 0.72, "{acmr:?}");
/// ```
#[derive(Debug, Clone, Default)]
pub struct WindowOrder {
    size: WindowSize,
    window: Roots,
    /// All vertices below this one were sent.
    sent: u32,
    across: Across,
    drawn: Vec<[u32; 3]>,
}

/// Faces that are given out together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window<'a> {
    /// In the order in which they are drawn.
    pub faces: &'a [[u32; 3]],
    /// For each of them, how many of the same window came in before it.
    pub order: &'a [u32],
    /// No later window uses a vertex below this one: the slot of such a vertex is free after its last face here.
    pub finished: u32,
}

impl WindowOrder {
    /// Nothing so far.
    #[must_use]
    pub fn new(size: WindowSize) -> Self {
        Self {
            size,
            ..Self::default()
        }
    }

    /// The order of all faces of a list.
    ///
    /// # Complexity
    /// Time and space O(faces).
    #[must_use]
    pub fn of_faces<'a>(faces: impl Into<Faces<'a>>, size: WindowSize) -> FaceOrder {
        let faces = faces.into();
        let mut windows = Self::new(size);
        let mut new_to_old = Vec::with_capacity(faces.len());
        let mut add = |window: Option<Window<'_>>| {
            let before = index32(new_to_old.len());
            let order = window.iter().flat_map(|window| window.order);
            new_to_old.extend(order.map(|place| before + place));
        };
        for face in faces.as_slice() {
            add(windows.push(*face));
        }
        add(windows.finish());
        Permutation::from_algorithm(new_to_old).into()
    }

    /// Takes the next face; gives out the window that ends before it, if one does.
    ///
    /// Faces come as [`FanCode::decode`](super::FanCode::decode) has them: in the order of their least
    /// vertices, vertices numbered as they are sent. One that comes late is drawn with the last root; its
    /// vertices are then sent once more.
    ///
    /// # Complexity
    /// Time O(1) a face, all in all. Space O(faces of a window), which is that of the required buffer, and
    /// reused from window to window.
    #[inline]
    pub fn push(&mut self, face: [u32; 3]) -> Option<Window<'_>> {
        let [a, b, c] = face;
        let root = a.min(b).min(c).max(self.window.last());
        let held = self.sent.saturating_sub(root);
        let is_full = self.window.is_full(root, self.size.limit(held));
        if is_full {
            self.draw();
        }
        self.window.add(root, face);
        self.sent = self.sent.max(a.max(b).max(c).saturating_add(1));
        is_full.then(|| self.out(root))
    }

    /// Gives out the faces that are left, if there are any. The next face begins another list.
    ///
    /// # Complexity
    /// As [`push`](Self::push).
    pub fn finish(&mut self) -> Option<Window<'_>> {
        let is_left = !self.window.faces.is_empty();
        self.draw();
        let finished = std::mem::take(&mut self.sent);
        self.window.first = 0;
        is_left.then(|| self.out(finished))
    }

    /// Draws the window, and begins the next.
    fn draw(&mut self) {
        self.across.draw(&self.window);
        let faces = &self.window.faces;
        self.drawn.clear();
        let drawn = self.across.order.iter().map(|&at| faces[at as usize]);
        self.drawn.extend(drawn);
        self.window.clear();
    }

    fn out(&self, finished: u32) -> Window<'_> {
        Window {
            faces: &self.drawn,
            order: &self.across.order,
            finished,
        }
    }
}

/// Faces by their roots, which are numbered from the first one.
#[derive(Debug, Clone, Default)]
struct Roots {
    first: u32,
    faces: Vec<[u32; 3]>,
    /// Where the faces of each root begin.
    starts: Vec<u32>,
}

impl Roots {
    /// The last root so far.
    #[inline]
    fn last(&self) -> u32 {
        self.first + index32(self.starts.len()).saturating_sub(1)
    }

    /// Whether there are faces, and a face of this root belongs to another window.
    #[inline]
    fn is_full(&self, root: u32, limit: usize) -> bool {
        let count = self.faces.len();
        let is_sparse = (root - self.first) as usize > SPARSE * (count + SPARSE);
        count > 0 && (count >= limit || is_sparse)
    }

    #[inline]
    fn add(&mut self, root: u32, face: [u32; 3]) {
        let start = index32(self.faces.len());
        if self.starts.is_empty() {
            self.first = root;
        }
        let roots = (root - self.first) as usize + 1;
        while self.starts.len() < roots {
            self.starts.push(start);
        }
        self.faces.push(face);
    }

    /// The root of the next window is not below the last one.
    fn clear(&mut self) {
        self.first = self.last();
        self.faces.clear();
        self.starts.clear();
    }

    /// The faces of a root.
    fn of(&self, root: usize) -> std::ops::Range<usize> {
        let end = self.starts.get(root + 1);
        let end = end.map_or(self.faces.len(), |end| *end as usize);
        self.starts[root] as usize..end
    }
}

/// How the faces of a window are drawn.
#[derive(Debug, Clone, Default)]
struct Across {
    order: Vec<u32>,
    /// For each root, how many of its corners at faces of others are not drawn yet; [`DRAWN`] once it is.
    waits: Vec<u32>,
    /// Roots whose turn it is, the next one last.
    ready: Vec<u32>,
}

/// Stands for a root whose faces are drawn, or will be before any other root comes in.
const DRAWN: u32 = u32::MAX;

impl Across {
    fn draw(&mut self, window: &Roots) {
        let count = window.starts.len();
        // The root that a corner will be, if it has to wait for this one. It need not if it is the next one:
        // otherwise all would wait for each other, ring after ring.
        let waiting = |root: usize, corner: u32| {
            let at = corner.wrapping_sub(window.first) as usize;
            (at > root + 1 && at < count).then_some(at)
        };

        self.waits.clear();
        self.waits.resize(count, 0);
        for root in 0..count {
            for corner in window.faces[window.of(root)].as_flattened() {
                if let Some(at) = waiting(root, *corner) {
                    self.waits[at] += 1;
                }
            }
        }

        self.order.clear();
        for root in 0..count {
            if self.waits[root] == DRAWN {
                continue;
            }
            self.waits[root] = DRAWN;
            self.ready.push(index32(root));
            while let Some(root) = self.ready.pop() {
                let (root, others) = (root as usize, self.ready.len());
                for at in window.of(root) {
                    self.order.push(index32(at));
                    for &corner in &window.faces[at] {
                        if let Some(at) = waiting(root, corner) {
                            self.waits[at] -= 1;
                            if self.waits[at] == 0 {
                                self.waits[at] = DRAWN;
                                self.ready.push(index32(at));
                            }
                        }
                    }
                }
                // The first that became ready goes first.
                self.ready[others..].reverse();
            }
        }
    }
}
