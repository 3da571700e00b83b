//! Half-edge collapses and vertex splits, which undo them.

use crate::progressive::told_from_point;
use crate::topology::half_edges::{HalfEdges, NONE, next, previous};

/// The two half-edges of an edge that collapses, either may be [`NONE`]: at a border there is one.
///
/// With *a* the vertex that leaves, *b* the one that takes its corners, and *x*, *y* opposite: the faces are (a, b, x) and (b, a, y).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Edge {
    /// From *a* to *b*.
    pub(super) forth: u32,
    /// From *b* to *a*.
    pub(super) back: u32,
}

/// A face that leaves, by its half-edges.
#[derive(Debug, Clone, Copy)]
struct LeavingFace {
    /// That which starts at *a*.
    at_a: u32,
    at_b: u32,
    at_tip: u32,
    /// That between the tip and *b*.
    beyond_b: u32,
    /// That between the tip and *a*.
    beyond_a: u32,
}

/// Where the vertices of a returning face are read: bits of the flags of an edge.
const B_FROM_A: [u32; 2] = [1, 4];
const TIP_FROM_A: [u32; 2] = [2, 8];

impl Edge {
    /// The faces that leave, that of `forth` first.
    fn leaving(self) -> [Option<LeavingFace>; 2] {
        let Self { forth, back } = self;
        let first = (forth != NONE).then(|| LeavingFace {
            at_a: forth,
            at_b: next(forth),
            at_tip: previous(forth),
            beyond_b: next(forth),
            beyond_a: previous(forth),
        });
        let second = (back != NONE).then(|| LeavingFace {
            at_a: next(back),
            at_b: back,
            at_tip: previous(back),
            beyond_b: previous(back),
            beyond_a: next(back),
        });
        [first, second]
    }

    /// The faces that leave.
    pub(super) fn faces(self) -> impl Iterator<Item = u32> {
        [self.forth, self.back]
            .into_iter()
            .filter(|&half_edge| half_edge != NONE)
            .map(|half_edge| half_edge / 3)
    }

    /// Of each face that leaves what has to be stored: the half-edge at *a*, and the two sides beyond which others are. All else is
    /// read from those when the face returns.
    pub(super) fn stored(self) -> impl Iterator<Item = (u32, [u32; 2])> {
        let faces = self.leaving().into_iter().flatten();
        faces.map(|face| (face.at_a, [face.beyond_b, face.beyond_a]))
    }

    /// The faces around those that leave, or that left: what must be there before they return.
    pub(super) fn faces_around(self, edges: &HalfEdges) -> impl Iterator<Item = u32> {
        let faces = self.leaving().into_iter().flatten();
        faces
            .flat_map(|face| [face.beyond_b, face.beyond_a])
            .map(|half_edge| edges.twin(half_edge))
            .filter(|&twin| twin != NONE)
            .map(|twin| twin / 3)
    }

    /// The half-edges that start at *a* one after the other, but for those of the faces that leave: the first one, or [`NONE`].
    /// The faces may have left already.
    fn first_of_fan(self, edges: &HalfEdges) -> u32 {
        match self.leaving() {
            [Some(first), _] => edges.twin(first.beyond_a),
            [None, Some(second)] => next_unless_none(edges.twin(second.beyond_a)),
            [None, None] => NONE,
        }
    }

    /// The one after: round to the second face, or to the border.
    fn next_of_fan(self, edges: &HalfEdges, at: u32) -> u32 {
        match self.leaving() {
            [Some(_), second] => {
                let found = edges.twin(previous(at));
                let is_last = second.is_some_and(|it| it.at_a == found);
                if is_last { NONE } else { found }
            }
            [None, _] => next_unless_none(edges.twin(at)),
        }
    }

    /// The half-edges that start at *a*, but for those of the faces that leave.
    pub(super) fn fan(self, edges: &HalfEdges) -> impl Iterator<Item = u32> {
        let at = |half_edge: u32| (half_edge != NONE).then_some(half_edge);
        std::iter::successors(at(self.first_of_fan(edges)), move |&it| {
            at(self.next_of_fan(edges, it))
        })
    }

    /// What has to be known to read the vertices of the faces when they return, of an edge that is there; `None` if they could not be
    /// read, as no face around has the same vertex.
    ///
    /// The vertices at a point differ at a seam. The vertex of *b* and that of the tip are read from the face beyond the edge
    /// between them, or else from that beyond the edge between the tip and *a*, which has a corner at *b* by then.
    pub(super) fn flags(self, edges: &HalfEdges) -> Option<u32> {
        let mut flags = 0;
        for (place, face) in self.leaving().into_iter().enumerate() {
            let Some(face) = face else { continue };
            let corners = [face.at_a, face.at_b, face.at_tip].map(|corner| edges.start(corner));
            let beyond = [face.beyond_b(edges), face.beyond_a(edges)];
            let [b_from_a, tip_from_a] = told_from_point(corners, beyond[0], beyond[1])?;
            if b_from_a {
                flags |= B_FROM_A[place];
            }
            if tip_from_a {
                flags |= TIP_FROM_A[place];
            }
        }
        Some(flags)
    }

    /// The faces leave, and the corners at *a* go to *b*; says each half-edge that starts elsewhere now.
    ///
    /// What leaves keeps its links and its vertices, so that [`split`](Self::split) finds the way back.
    pub(super) fn collapse(self, edges: &mut HalfEdges, mut moved: impl FnMut(u32)) {
        let faces = self.leaving();
        let pairs = faces.map(|face| face.map(|it| [edges.start(it.at_a), edges.start(it.at_b)]));
        self.relabel(edges, pairs, &mut moved);
        for face in faces.into_iter().flatten() {
            let twins = [face.beyond_b, face.beyond_a].map(|it| edges.twin(it));
            edges.join(twins[0], twins[1]);
        }
    }

    /// The faces return, and the corners at *b* between them go to *a*; says each half-edge that starts elsewhere now.
    pub(super) fn split(self, flags: u32, edges: &mut HalfEdges, mut moved: impl FnMut(u32)) {
        let faces = self.leaving();

        // The vertices of the returning faces may have changed since they left.
        for (place, face) in faces.into_iter().enumerate() {
            let Some(face) = face else { continue };
            let beyond = [face.beyond_b(edges), face.beyond_a(edges)];
            let from_a = [B_FROM_A, TIP_FROM_A].map(|bits| flags & bits[place] != 0);
            for (at, corner) in [face.at_b, face.at_tip].into_iter().enumerate() {
                if let Some(vertices) = beyond[usize::from(from_a[at])] {
                    edges.set_start(corner, vertices[at]);
                }
            }
        }

        for face in faces.into_iter().flatten() {
            for side in [face.beyond_b, face.beyond_a] {
                edges.join(side, edges.twin(side));
            }
        }
        let pairs = faces.map(|face| face.map(|it| [edges.start(it.at_b), edges.start(it.at_a)]));
        self.relabel(edges, pairs, &mut moved);
    }

    /// The fan of *a* gets other vertices: each pair has the one before and the one after, as the corners of a face that leaves
    /// have them.
    fn relabel(
        self,
        edges: &mut HalfEdges,
        pairs: [Option<[u32; 2]>; 2],
        moved: &mut impl FnMut(u32),
    ) {
        let Some(first) = pairs[0].or(pairs[1]) else {
            return;
        };
        let second = pairs[1].unwrap_or(first);
        // Someone may have made the links up: they may come back to where they were, which has a vertex after then.
        let after = [first[1], second[1]];
        if after.contains(&first[0]) || after.contains(&second[0]) {
            return;
        }
        let mut at = self.first_of_fan(edges);
        while at != NONE {
            let vertex = match edges.start(at) {
                before if before == first[0] => first[1],
                before if before == second[0] => second[1],
                _ => break,
            };
            edges.set_start(at, vertex);
            moved(at);
            at = self.next_of_fan(edges, at);
        }
    }
}

fn next_unless_none(half_edge: u32) -> u32 {
    match half_edge {
        NONE => NONE,
        _ => next(half_edge),
    }
}

impl LeavingFace {
    /// The vertices of *b* and of the tip in the face beyond the edge between them.
    fn beyond_b(self, edges: &HalfEdges) -> Option<[u32; 2]> {
        self.beyond(edges, self.beyond_b, self.at_b)
    }

    /// The vertices of *a* and of the tip in the face beyond the edge between them.
    fn beyond_a(self, edges: &HalfEdges) -> Option<[u32; 2]> {
        self.beyond(edges, self.beyond_a, self.at_a)
    }

    /// The vertices across an edge: that across from where `corner` is, and that across from the tip.
    fn beyond(self, edges: &HalfEdges, side: u32, corner: u32) -> Option<[u32; 2]> {
        let twin = edges.twin(side);
        if twin == NONE {
            return None;
        }
        // The twin starts where the side ends.
        let across = [edges.start(next(twin)), edges.start(twin)];
        Some(match side == corner {
            true => across,
            false => [across[1], across[0]],
        })
    }
}
