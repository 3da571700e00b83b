//! The code of the paper: bits of four types, and left faces.

use std::collections::BTreeMap;

use super::minimum_time::MinimumTimeRendering;
use super::trimmed_lists::TrimmedLists;
use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::{FaceOrder, Permutation, VertexOrder};

/// What the paper writes of a mesh. Kept as its reference: it takes two to three times the bits of what is
/// usual today.
///
/// Any faces can be coded: those that are no face of a list, among them faces of the other direction,
/// repeated ones and those that name a vertex twice, are left faces. Faces come back with their direction, and
/// turned so that the least vertex is first.
///
/// Where the paper leaves room:
/// - The first root has a type III bit too, and so has each vertex that begins a part: it may have no
///   neighbour. Neither has a type IV bit, as there is no PREV.
/// - Once all vertices were met, no root has bits of the types III and IV; left faces are counted for each.
/// - PREV is the last vertex that was met.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TrimmedListCode {
    vertex_count: usize,
    /// Type I, of each vertex of a list: whether it is the last one.
    is_last: Vec<bool>,
    /// Type II, of each vertex of a list but the last: whether it makes a face with the next one.
    with_next: Vec<bool>,
    /// Type II, of the last vertex of each list: whether it makes a face with the next root.
    with_root: Vec<bool>,
    /// Type III, of each root: whether its list is empty.
    is_empty: Vec<bool>,
    /// Type IV, of each root: whether it makes a face with PREV and NEXT.
    with_previous: Vec<bool>,
    /// How many left faces each root has.
    left_counts: Vec<u32>,
    /// Of each left face the two differences to the root.
    left: Vec<[u32; 2]>,
}

/// How a face is known from the code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Membership {
    /// By a type II bit: F₁ in the paper.
    List,
    /// By a type IV bit: F₂.
    Previous,
    /// As a left face: F_L.
    Left,
}

/// The bits of each part of a code, if each symbol takes what it takes at best with frequencies of its own
/// part (entropy of order 0).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CodeBits {
    /// Type I.
    pub type_1: f64,
    /// Type II, both kinds.
    pub type_2: f64,
    /// Type III.
    pub type_3: f64,
    /// Type IV.
    pub type_4: f64,
    /// The numbers of left faces.
    pub left_counts: f64,
    /// The differences of left faces.
    pub left: f64,
}

impl CodeBits {
    /// All parts together.
    #[must_use]
    pub fn total(&self) -> f64 {
        let types = self.type_1 + self.type_2 + self.type_3 + self.type_4;
        types + self.left_counts + self.left
    }
}

impl TrimmedListCode {
    /// The code of a mesh whose traversal begins with a vertex, and the orders in which vertices and faces
    /// come back.
    ///
    /// # Panics
    /// If there are vertices, and `first_vertex` is not one of them.
    ///
    /// # Complexity
    /// Time O(vertices + faces log valence); space O(vertices + faces).
    ///
    /// ```
    /// use meshweft::connectivity::TrimmedListCode;
    /// // A fan of six faces around vertex 0.
    /// let faces: Vec<[u32; 3]> = (0..6).map(|i| [0, i + 1, (i + 1) % 6 + 1]).collect();
    /// let (code, vertices, order) = TrimmedListCode::new(&faces, 0);
    /// assert_eq!(code.decode(), vertices.renumber(&order.apply(&faces)));
    /// assert_eq!(code.left_count(), 0);
    /// ```
    #[must_use]
    pub fn new<'a>(
        faces: impl Into<Faces<'a>>,
        first_vertex: u32,
    ) -> (Self, VertexOrder, FaceOrder) {
        let faces = faces.into();
        let lists = TrimmedLists::new(faces, first_vertex);
        let renumbered = lists.vertices().renumber(faces.as_slice());
        let rendering =
            MinimumTimeRendering::new(Faces::of_checked(&renumbered, faces.vertex_count()));
        let by_root = rendering.order().apply(&renumbered);

        let mut code = Self::of_nothing(faces.vertex_count());
        let mut coded = Vec::with_capacity(faces.len());
        let mut of_root = OfRoot::default();
        let mut met = 0;
        for (root, step) in (0..).zip(rendering.steps()) {
            of_root.begin(root, &by_root, step.faces.start, step.faces.end);
            let length = lists.lengths()[root as usize];
            code.code_root(root, length, &mut met, |face| of_root.take(face));
            let left = of_root.take_rest();
            code.left_counts.push(index32(left.len()));
            code.left
                .extend(left.iter().map(|[a, b]| [a - root, b - root]));
            coded.append(&mut of_root.taken);
        }

        let order = rendering.order();
        let order = order.then(&Permutation::from_algorithm(coded).into());
        (code, lists.vertices().clone(), order)
    }

    fn of_nothing(vertex_count: usize) -> Self {
        Self {
            vertex_count,
            is_last: Vec::new(),
            with_next: Vec::new(),
            with_root: Vec::new(),
            is_empty: Vec::new(),
            with_previous: Vec::new(),
            left_counts: Vec::with_capacity(vertex_count),
            left: Vec::new(),
        }
    }

    /// The bits of a root; `take` says whether there is such a face, and takes it.
    fn code_root(
        &mut self,
        root: u32,
        length: u32,
        met: &mut u32,
        mut take: impl FnMut([u32; 3]) -> bool,
    ) {
        let begins = *met == root;
        *met += u32::from(begins);
        if *met as usize == self.vertex_count {
            return;
        }
        self.is_empty.push(length == 0);
        if !begins {
            let next = if length > 0 { *met } else { root + 1 };
            self.with_previous.push(take([root, *met - 1, next]));
        }
        let end = *met + length;
        for vertex in *met..end {
            let is_last = vertex + 1 == end;
            self.is_last.push(is_last);
            match is_last {
                true => self.with_root.push(take([root, vertex, root + 1])),
                false => self.with_next.push(take([root, vertex, vertex + 1])),
            }
        }
        *met = end;
    }

    /// The faces, in the order in which they are coded.
    ///
    /// # Complexity
    /// Time O(vertices + faces).
    #[must_use]
    pub fn decode(&self) -> Vec<[u32; 3]> {
        self.with_memberships().map(|(face, _)| face).collect()
    }

    /// The faces, in the order in which they are coded, and how each is known.
    pub fn with_memberships(&self) -> impl Iterator<Item = ([u32; 3], Membership)> {
        let mut bits = Bits::new(self);
        (0..index32(self.vertex_count)).flat_map(move |root| bits.faces_of(root))
    }

    /// How many left faces there are.
    #[must_use]
    pub fn left_count(&self) -> usize {
        self.left.len()
    }

    /// The shares of bits that say that there is a face: of type II within a list, of type II at its end, of
    /// type IV.
    #[must_use]
    pub fn hit_rates(&self) -> [f64; 3] {
        [&self.with_next, &self.with_root, &self.with_previous].map(|bits| {
            let hits = bits.iter().filter(|&&bit| bit).count();
            hits as f64 / bits.len().max(1) as f64
        })
    }

    /// How many bits it takes.
    #[must_use]
    pub fn bits(&self) -> CodeBits {
        let differences = |of: usize| entropy(self.left.iter().map(move |pair| pair[of]));
        CodeBits {
            type_1: entropy(&self.is_last),
            type_2: entropy(&self.with_next) + entropy(&self.with_root),
            type_3: entropy(&self.is_empty),
            type_4: entropy(&self.with_previous),
            left_counts: entropy(&self.left_counts),
            left: differences(0) + differences(1),
        }
    }
}

/// The faces whose least vertex is the root, to be taken one by one.
#[derive(Default)]
struct OfRoot {
    root: u32,
    /// The corners that follow the root, and the place of the face: rising.
    pairs: Vec<([u32; 2], u32)>,
    is_taken: Vec<bool>,
    /// The places of those that were taken.
    taken: Vec<u32>,
}

impl OfRoot {
    fn begin(&mut self, root: u32, faces: &[[u32; 3]], start: u32, end: u32) {
        self.root = root;
        self.pairs.clear();
        let pair = |place: u32| {
            let [_, a, b] = faces[place as usize];
            ([a, b], place)
        };
        self.pairs.extend((start..end).map(pair));
        self.pairs.sort_unstable();
        self.is_taken.clear();
        self.is_taken.resize(self.pairs.len(), false);
    }

    /// Whether the face is there and was not taken before.
    fn take(&mut self, [root, a, b]: [u32; 3]) -> bool {
        debug_assert_eq!(root, self.root, "a face of the root");
        let at = self.pairs.partition_point(|&(pair, _)| pair < [a, b]);
        // A list asks for each pair once, so of repeated faces the first is as good as any.
        let is_there = self.pairs.get(at).is_some_and(|&(pair, _)| pair == [a, b]);
        let is_free = is_there && !std::mem::replace(&mut self.is_taken[at], true);
        if is_free {
            self.taken.push(self.pairs[at].1);
        }
        is_free
    }

    /// Takes all others; returns the corners that follow the root.
    fn take_rest(&mut self) -> Vec<[u32; 2]> {
        let all = self.pairs.iter().zip(&self.is_taken);
        let rest = all.filter(|&(_, &is_taken)| !is_taken);
        let (pairs, places): (Vec<_>, Vec<_>) = rest.map(|(&pair, _)| pair).unzip();
        self.taken.extend(places);
        pairs
    }
}

/// A code that is read root by root.
struct Bits<'a> {
    vertex_count: u32,
    met: u32,
    is_last: std::slice::Iter<'a, bool>,
    with_next: std::slice::Iter<'a, bool>,
    with_root: std::slice::Iter<'a, bool>,
    is_empty: std::slice::Iter<'a, bool>,
    with_previous: std::slice::Iter<'a, bool>,
    left_counts: std::slice::Iter<'a, u32>,
    left: std::slice::Iter<'a, [u32; 2]>,
}

impl<'a> Bits<'a> {
    fn new(code: &'a TrimmedListCode) -> Self {
        Self {
            vertex_count: index32(code.vertex_count),
            met: 0,
            is_last: code.is_last.iter(),
            with_next: code.with_next.iter(),
            with_root: code.with_root.iter(),
            is_empty: code.is_empty.iter(),
            with_previous: code.with_previous.iter(),
            left_counts: code.left_counts.iter(),
            left: code.left.iter(),
        }
    }

    fn faces_of(&mut self, root: u32) -> Vec<([u32; 3], Membership)> {
        let mut faces = Vec::new();
        let next_bit = |bits: &mut std::slice::Iter<'_, bool>| bits.next().copied() == Some(true);
        let begins = self.met == root;
        self.met += u32::from(begins);

        // Faces that the lists tell.
        if self.met < self.vertex_count {
            let is_empty = next_bit(&mut self.is_empty);
            let next = if is_empty { root + 1 } else { self.met };
            if !begins && next_bit(&mut self.with_previous) {
                faces.push(([root, self.met - 1, next], Membership::Previous));
            }
            let mut is_last = is_empty;
            while !is_last && self.met < self.vertex_count {
                let vertex = self.met;
                self.met += 1;
                is_last = next_bit(&mut self.is_last);
                let (bits, with) = match is_last {
                    true => (&mut self.with_root, root + 1),
                    false => (&mut self.with_next, vertex + 1),
                };
                if next_bit(bits) {
                    faces.push(([root, vertex, with], Membership::List));
                }
            }
        }

        // Left faces.
        let count = self.left_counts.next().copied().unwrap_or(0);
        let left = self.left.by_ref().take(count as usize);
        let left = left.map(|[a, b]| ([root, root + a, root + b], Membership::Left));
        faces.extend(left);
        faces
    }
}

/// Bits of symbols at the entropy of order 0, frequencies not counted.
fn entropy<T: Ord>(symbols: impl IntoIterator<Item = T>) -> f64 {
    let mut counts = BTreeMap::new();
    let mut all = 0.0;
    for symbol in symbols {
        *counts.entry(symbol).or_insert(0.0) += 1.0;
        all += 1.0;
    }
    let bits = |count: &f64| count * (all / count).log2();
    counts.values().map(bits).sum()
}
