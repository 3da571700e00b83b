//! What is known of the faces around each vertex.

use crate::index::index32;

/// Stands for no vertex and no place.
pub(super) const NONE: u32 = u32::MAX;

/// More paths of one vertex are forgotten: the faces that would go on from there begin fans of their own.
const MOST_PATHS: usize = 64;

/// Known faces that follow each other around a vertex, as the path of neighbours that they make.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Path {
    /// The neighbour before the first face.
    pub(super) start: u32,
    /// The neighbour after the last face.
    pub(super) end: u32,
    /// The neighbour between the first face and the next one: the third vertex of the first face.
    pub(super) inner: u32,
    /// How many faces; 0 for no path.
    pub(super) faces: u32,
    /// The place of the vertex's next path among the others.
    next: u32,
}

impl Path {
    const NO: Self = Self {
        start: NONE,
        end: NONE,
        inner: NONE,
        faces: 0,
        next: NONE,
    };

    fn of_a_face(start: u32, end: u32) -> Self {
        Self {
            start,
            end,
            inner: end,
            faces: 1,
            next: NONE,
        }
    }
}

/// What is known around a vertex.
#[derive(Debug, Clone, Copy)]
struct VertexPaths {
    /// Its first path.
    path: Path,
    /// How many faces its neighbours have that were the root, over six each.
    surplus: i32,
}

/// The open paths of all vertices that were met and were not the root yet, and of the root. A path that closes is
/// complete, and forgotten.
///
/// A vertex has more than one where two parts of the front touch. The first is kept in place, as nearly all
/// vertices have no other.
#[derive(Debug)]
pub(super) struct KnownFaces {
    /// A ring: a power of two of places, each vertex at its number without the high bits.
    around: Vec<VertexPaths>,
    /// The first vertex that is kept.
    root: u32,
    vertex_count: u32,
    others: Vec<Path>,
    /// The first place that is free among the others; the next one is in `next`.
    free: u32,
}

impl KnownFaces {
    pub(super) fn new() -> Self {
        const NOTHING: VertexPaths = VertexPaths {
            path: Path::NO,
            surplus: 0,
        };
        Self {
            around: vec![NOTHING; 16],
            root: 0,
            vertex_count: 0,
            others: Vec::new(),
            free: NONE,
        }
    }

    /// The place of a vertex that is kept.
    #[inline]
    fn place(&self, vertex: u32) -> usize {
        debug_assert!(self.is_kept(vertex), "vertex {vertex}");
        vertex as usize & (self.around.len() - 1)
    }

    /// Whether a vertex was met and was not the root before.
    #[inline]
    pub(super) fn is_kept(&self, vertex: u32) -> bool {
        (self.root..self.vertex_count).contains(&vertex)
    }

    #[inline]
    fn path(&self, vertex: u32) -> &Path {
        &self.around[self.place(vertex)].path
    }

    #[inline]
    fn path_mut(&mut self, vertex: u32) -> &mut Path {
        let place = self.place(vertex);
        &mut self.around[place].path
    }

    /// A vertex without faces.
    #[inline]
    pub(super) fn add_vertex(&mut self) {
        self.add_vertex_with(Path::NO);
    }

    #[inline]
    fn add_vertex_with(&mut self, path: Path) {
        if (self.vertex_count - self.root) as usize == self.around.len() {
            self.grow();
        }
        let vertex = self.vertex_count;
        self.vertex_count += 1;
        let place = self.place(vertex);
        self.around[place] = VertexPaths { path, surplus: 0 };
    }

    #[cold]
    fn grow(&mut self) {
        let mut wider = self.around.clone();
        wider.extend_from_slice(&self.around);
        for vertex in self.root..self.vertex_count {
            wider[vertex as usize & (2 * self.around.len() - 1)] = self.around[self.place(vertex)];
        }
        self.around = wider;
    }

    /// The root is complete; the next vertex is the root.
    #[inline]
    pub(super) fn next_root(&mut self) {
        self.root += 1;
    }

    /// How many vertices there are.
    #[inline]
    pub(super) fn vertex_count(&self) -> u32 {
        self.vertex_count
    }

    /// The first path of a vertex, if it has one.
    #[inline]
    pub(super) fn first(&self, vertex: u32) -> Option<Path> {
        let path = *self.path(vertex);
        (path.faces > 0).then_some(path)
    }

    /// How many faces the first path of a vertex has; 0 for one that was the root.
    #[inline]
    pub(super) fn faces(&self, vertex: u32) -> u32 {
        match self.is_kept(vertex) {
            true => self.path(vertex).faces,
            false => 0,
        }
    }

    /// How many faces its neighbours have that were the root, over six each.
    #[inline]
    pub(super) fn surplus(&self, vertex: u32) -> i32 {
        self.around[self.place(vertex)].surplus
    }

    /// A neighbour that was the root has some faces over six.
    #[inline]
    pub(super) fn add_surplus(&mut self, vertex: u32, over: i32) {
        if self.is_kept(vertex) {
            let place = self.place(vertex);
            let surplus = &mut self.around[place].surplus;
            *surplus = surplus.wrapping_add(over);
        }
    }

    /// Faces between the root and new vertices, the first one after `from`, which is the end of a path of the root;
    /// with `closes`, also a last face to that vertex.
    #[inline]
    pub(super) fn add_fan(&mut self, root: u32, from: u32, new: u32, closes: Option<u32>) {
        let mut before = from;
        let last = self.vertex_count + new;
        if self.vertex_count < last {
            self.join(from, self.vertex_count, root);
        }
        while self.vertex_count < last {
            let vertex = self.vertex_count;
            self.join(root, before, vertex);
            let is_last = vertex + 1 == last;
            self.add_vertex_with(match (is_last, closes) {
                (true, None) => Path::of_a_face(root, before),
                (_, to) => Path {
                    start: to.filter(|_| is_last).unwrap_or(vertex + 1),
                    end: before,
                    inner: root,
                    faces: 2,
                    next: NONE,
                },
            });
            before = vertex;
        }
        if let Some(to) = closes {
            self.join(root, before, to);
            self.join(to, root, before);
            if new == 0 {
                self.join(from, to, root);
            }
        }
    }

    /// The third vertex of the known face with an edge from a vertex to another: [`NONE`] if that is not known.
    #[inline]
    pub(super) fn third(&self, vertex: u32, start: u32) -> u32 {
        let path = self.path(vertex);
        match path.start == start {
            true => path.inner,
            false => self.starting(vertex, start).map_or(NONE, |path| path.inner),
        }
    }

    fn all(&self, vertex: u32) -> impl Iterator<Item = Path> + '_ {
        let others = |path: &Path| self.others.get(path.next as usize).copied();
        std::iter::successors(self.first(vertex), others)
    }

    /// The path of a vertex with this end.
    #[inline]
    pub(super) fn ending(&self, vertex: u32, end: u32) -> Option<Path> {
        self.all(vertex).find(|path| path.end == end)
    }

    /// The path of a vertex with this start.
    #[inline]
    pub(super) fn starting(&self, vertex: u32, start: u32) -> Option<Path> {
        self.all(vertex).find(|path| path.start == start)
    }

    /// The vertex before `vertex` on the front, where `after` follows it there: [`NONE`] if that is not
    /// known.
    #[inline]
    pub(super) fn before_on_front(&self, vertex: u32, after: u32) -> u32 {
        if !self.is_kept(vertex) {
            return NONE;
        }
        let path = *self.path(vertex);
        if path.next == NONE {
            return path.end;
        }
        let other = self.all(vertex).find(|path| path.start != after);
        other.map_or(NONE, |path| path.end)
    }

    /// The vertex after `vertex` on the front, where `before` precedes it there.
    #[inline]
    pub(super) fn after_on_front(&self, vertex: u32, before: u32) -> u32 {
        if !self.is_kept(vertex) {
            return NONE;
        }
        let path = *self.path(vertex);
        if path.next == NONE {
            return path.start;
        }
        let other = self.all(vertex).find(|path| path.end != before);
        other.map_or(NONE, |path| path.start)
    }

    /// A face is known.
    #[inline]
    pub(super) fn add_face(&mut self, [a, b, c]: [u32; 3]) {
        self.join(a, b, c);
        self.join(b, c, a);
        self.join(c, a, b);
    }

    /// A face leads from one neighbour of a vertex to another.
    #[inline]
    fn join(&mut self, vertex: u32, from: u32, to: u32) {
        let path = self.path_mut(vertex);
        if path.next != NONE {
            return self.join_one_of_several(vertex, from, to);
        }
        match (path.end == from, path.start == to) {
            (true, true) => *path = Path::NO,
            (true, false) => {
                path.end = to;
                path.faces += 1;
            }
            (false, true) => {
                path.start = from;
                path.inner = to;
                path.faces += 1;
            }
            (false, false) if path.faces == 0 => *path = Path::of_a_face(from, to),
            (false, false) => self.append(vertex, Path::of_a_face(from, to)),
        }
    }

    #[cold]
    fn join_one_of_several(&mut self, vertex: u32, from: u32, to: u32) {
        let (mut before, mut after) = (None, None);
        let mut place = NONE;
        loop {
            let path = *self.at(vertex, place);
            if before.is_none() && path.end == from {
                before = Some(place);
            }
            if after.is_none() && path.start == to {
                after = Some(place);
            }
            place = path.next;
            if place == NONE {
                break;
            }
        }

        match (before, after) {
            (Some(before), Some(after)) if before == after => self.remove(vertex, before),
            (Some(before), Some(after)) => {
                let Path { end, faces, .. } = *self.at(vertex, after);
                let path = self.at(vertex, before);
                path.end = end;
                path.faces += faces + 1;
                self.remove(vertex, after);
            }
            (Some(before), None) => {
                let path = self.at(vertex, before);
                path.end = to;
                path.faces += 1;
            }
            (None, Some(after)) => {
                let path = self.at(vertex, after);
                path.start = from;
                path.inner = to;
                path.faces += 1;
            }
            (None, None) => self.append(vertex, Path::of_a_face(from, to)),
        }
    }

    /// A path by its place among the others; [`NONE`] is the first.
    fn at(&mut self, vertex: u32, place: u32) -> &mut Path {
        match place {
            NONE => self.path_mut(vertex),
            place => &mut self.others[place as usize],
        }
    }

    #[cold]
    fn append(&mut self, vertex: u32, path: Path) {
        let mut last = NONE;
        for _ in 1..MOST_PATHS {
            let next = self.at(vertex, last).next;
            if next == NONE {
                let place = self.place_of(path);
                self.at(vertex, last).next = place;
                return;
            }
            last = next;
        }
    }

    /// Where a path is kept now.
    fn place_of(&mut self, path: Path) -> u32 {
        let place = self.free;
        if place == NONE {
            self.others.push(path);
            return index32(self.others.len() - 1);
        }
        self.free = self.others[place as usize].next;
        self.others[place as usize] = path;
        place
    }

    fn remove(&mut self, vertex: u32, place: u32) {
        let mut gone = place;
        if place == NONE {
            // The second one moves to the first place.
            gone = self.path(vertex).next;
            if gone == NONE {
                *self.path_mut(vertex) = Path::NO;
                return;
            }
            *self.path_mut(vertex) = self.others[gone as usize];
        } else {
            let mut before = NONE;
            while self.at(vertex, before).next != gone {
                before = self.at(vertex, before).next;
            }
            self.at(vertex, before).next = self.others[gone as usize].next;
        }
        self.others[gone as usize].next = self.free;
        self.free = gone;
    }

    /// Forgets the path of a vertex with this end.
    pub(super) fn forget(&mut self, vertex: u32, end: u32) {
        let mut place = NONE;
        loop {
            let path = *self.at(vertex, place);
            if path.end == end {
                return self.remove(vertex, place);
            }
            place = path.next;
            if place == NONE {
                return;
            }
        }
    }
}
