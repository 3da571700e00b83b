//! The traversal that both sides make: who codes says what comes next, who decodes is told.

use super::known_faces::{KnownFaces, NONE, Path};
use crate::bits::{DecodeError, DecodeErrorKind};
use crate::index::index32;

/// What a vertex sees of the next gap around it: the neighbour from which faces go on, and the one at which
/// they may arrive.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gap {
    pub(super) root: u32,
    /// Where faces go on.
    pub(super) from: u32,
    /// The other end of the gap.
    pub(super) to: u32,
    /// Whether it is walked against the direction of the faces, from its end.
    pub(super) is_backward: bool,
    /// How many faces are known at the root, at `from` and at `to`.
    pub(super) known: [u32; 3],
    /// How many faces the neighbours have that were the root, over six each.
    pub(super) surplus: i32,
}

/// Faces with new vertices, one after the other, and whether the gap is closed then: where it
/// [cannot be](Gap::can_close), whether nothing follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Run {
    pub(super) new: usize,
    pub(super) is_end: bool,
    /// Whether another run follows, and no turn.
    pub(super) goes_on: bool,
}

impl Run {
    /// A new vertex, and another run.
    pub(super) const ONE: Self = Self {
        new: 1,
        is_end: false,
        goes_on: true,
    };
}

/// What comes after a run that does not close the gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FanTurn {
    /// A face with a vertex this number of steps back on the front, from where faces go on.
    Before(u32),
    /// A face with a vertex this number of steps on, from the other end of the gap.
    After(u32),
    /// A face with any other vertex that was met.
    Known,
    /// No face.
    Stop,
    /// Another run.
    GoOn,
}

impl FanTurn {
    pub(super) const ALL: [Self; 14] = [
        Self::Before(1),
        Self::Before(2),
        Self::Before(3),
        Self::Before(4),
        Self::After(1),
        Self::After(2),
        Self::After(3),
        Self::After(4),
        Self::After(5),
        Self::After(6),
        Self::After(7),
        Self::Known,
        Self::Stop,
        Self::GoOn,
    ];

    /// The vertex that it leads to: [`NONE`] if there is none, or it has to be said which.
    #[inline]
    pub(super) fn vertex(self, gap: &Gap, known: &KnownFaces) -> u32 {
        let (mut before, mut vertex, steps) = match (self, gap.is_backward) {
            (Self::Before(steps), false) => (gap.root, gap.from, steps),
            (Self::After(steps), false) => (gap.root, gap.to, steps),
            (Self::After(steps), true) => (gap.root, gap.from, steps),
            _ => return NONE,
        };
        for _ in 0..steps {
            if vertex == NONE {
                break;
            }
            let next = match self {
                Self::Before(_) => known.before_on_front(vertex, before),
                _ => known.after_on_front(vertex, before),
            };
            (before, vertex) = (vertex, next);
        }
        vertex
    }
}

/// Either side.
pub(super) trait Fans {
    /// A vertex begins a part, with the next number.
    fn begin_part(&mut self);
    /// A vertex is the root now.
    fn begin_root(&mut self, root: u32);
    /// The next run.
    fn run(&mut self, gap: &Gap, known: &KnownFaces) -> Run;
    /// What comes then.
    fn turn(&mut self, gap: &Gap, known: &KnownFaces) -> FanTurn;
    /// The vertex of [`FanTurn::Known`].
    fn known(&mut self, gap: &Gap, count: u32) -> u32;
    /// Whether the root has faces that do not follow those that are known.
    fn has_more(&mut self, root: u32) -> bool;
    /// The other vertices of the first of these, 0 and 1: `None` for a new one.
    fn corner(&mut self, root: u32, which: usize, count: u32) -> Option<u32>;
    /// A vertex was met: what is coded with it follows, near three vertices. See [`VertexCoder::code`].
    ///
    /// [`VertexCoder::code`]: super::vertex_coder::VertexCoder::code
    fn vertex(&mut self, vertex: u32, near: [u32; 3]);
    /// A face is complete.
    fn face(&mut self, face: [u32; 3]);
    /// Whether it can go on.
    fn check(&self) -> Result<(), DecodeError>;
    /// An error at this place.
    fn error(&self, kind: DecodeErrorKind) -> DecodeError;
}

/// The state that both sides have.
#[derive(Debug)]
pub(super) struct Traversal<F> {
    pub(super) fans: F,
    pub(super) known: KnownFaces,
    root: u32,
    /// The neighbours of the root that faces of it have named, but for new ones.
    named: Vec<u32>,
    counts: [usize; 2],
    faces_left: usize,
}

impl<F: Fans> Traversal<F> {
    pub(super) fn new(fans: F, face_count: usize, vertex_count: usize) -> Self {
        Self {
            fans,
            known: KnownFaces::new(),
            root: 0,
            named: Vec::new(),
            counts: [face_count, vertex_count],
            faces_left: face_count,
        }
    }

    /// So many of the faces are not in fans.
    pub(super) fn leave_out(&mut self, faces: usize) -> Result<(), DecodeError> {
        let left = self.faces_left.checked_sub(faces);
        self.faces_left = left.ok_or_else(|| self.too_many(true))?;
        Ok(())
    }

    /// The next vertex whose faces are drawn.
    pub(super) fn root(&self) -> u32 {
        self.root
    }

    pub(super) fn is_complete(&self) -> bool {
        self.faces_left == 0
    }

    pub(super) fn faces_left(&self) -> usize {
        self.faces_left
    }

    /// Goes through the faces of root after root, until there were enough, or none is left.
    pub(super) fn go(&mut self, enough: usize) -> Result<(), DecodeError> {
        let end = self.faces_left.saturating_sub(enough);
        while self.faces_left > end {
            let root = self.root;
            let begins = root == self.known.vertex_count();
            if begins {
                let vertex = self.new_vertex()?;
                self.fans.begin_part();
                self.fans.vertex(vertex, [vertex.saturating_sub(1); 3]);
            }
            self.fans.begin_root(root);
            self.go_around(root, begins)?;
            self.fans.check()?;
            self.known.next_root();
            self.root += 1;
        }
        Ok(())
    }

    fn new_vertex(&mut self) -> Result<u32, DecodeError> {
        let vertex = self.known.vertex_count();
        if vertex as usize >= self.counts[1] {
            return Err(self.too_many(false));
        }
        self.known.add_vertex();
        Ok(vertex)
    }

    fn new_face(&mut self, face: [u32; 3]) -> Result<(), DecodeError> {
        if self.faces_left == 0 {
            return Err(self.too_many(true));
        }
        self.faces_left -= 1;
        self.known.add_face(face);
        self.fans.face(face);
        Ok(())
    }

    #[cold]
    fn too_many(&self, faces: bool) -> DecodeError {
        let (what, said) = match faces {
            true => ("faces", self.counts[0]),
            false => ("vertices", self.counts[1]),
        };
        self.fans.error(DecodeErrorKind::TooMany { what, said })
    }

    /// All faces of a root that are not known yet.
    #[inline]
    fn go_around(&mut self, root: u32, begins: bool) -> Result<(), DecodeError> {
        self.named.clear();
        let first_new = self.known.vertex_count();
        let known = self.known.faces(root);
        let left = self.faces_left;
        if begins {
            self.begin_fan(root)?;
        }
        loop {
            while let Some(path) = self.known.first(root) {
                self.extend(root, path)?;
                if self.faces_left == 0 {
                    return Ok(());
                }
            }
            if !self.fans.has_more(root) {
                break;
            }
            self.begin_fan(root)?;
        }

        // How many faces it has is worth knowing at its neighbours.
        let faces = known as usize + (left - self.faces_left);
        let over = index32(faces.min(12)).cast_signed() - 6;
        let new = first_new..self.known.vertex_count();
        for neighbour in self.named.drain(..).chain(new) {
            self.known.add_surplus(neighbour, over);
        }
        Ok(())
    }

    #[cold]
    fn begin_fan(&mut self, root: u32) -> Result<(), DecodeError> {
        let [from, to] = [self.corner(root, 0)?, self.corner(root, 1)?];
        match from == to {
            true => Err(self.no_such(to)),
            false => self.new_face([root, from, to]),
        }
    }

    /// A corner of a face that follows no other.
    fn corner(&mut self, root: u32, which: usize) -> Result<u32, DecodeError> {
        let count = self.known.vertex_count();
        match self.fans.corner(root, which, count) {
            None => {
                let vertex = self.new_vertex()?;
                self.fans.vertex(vertex, [root; 3]);
                Ok(vertex)
            }
            Some(vertex) if vertex > root && vertex < count => Ok(vertex),
            Some(vertex) => Err(self.no_such(vertex)),
        }
    }

    /// Faces on both sides of a path of the root, until it is closed or nothing follows.
    #[inline]
    fn extend(&mut self, root: u32, mut path: Path) -> Result<(), DecodeError> {
        self.named.extend([path.end, path.start]);
        for is_backward in [false, true] {
            loop {
                // A neighbour that was the root has all its faces: none goes on from there.
                let (from, to) = match is_backward {
                    false => (path.end, path.start),
                    true => (path.start, path.end),
                };
                if from < root {
                    break;
                }
                let mut gap = self.gap(root, from, to, path.faces, is_backward);
                let run = self.fans.run(&gap, &self.known);
                let closes = run.is_end && gap.can_close();
                self.add_run(&mut gap, run.new, closes)?;
                if closes || self.faces_left == 0 {
                    return Ok(());
                }
                let stops = run.is_end || !run.goes_on && !self.take_turn(&mut gap, run)?;

                // The path as it is now: longer, joined with another, or closed.
                let found = match is_backward {
                    false => self.known.starting(root, to),
                    true => self.known.ending(root, to),
                };
                match found {
                    Some(found) if self.faces_left > 0 => path = found,
                    _ => return Ok(()),
                }
                if stops {
                    break;
                }
            }
        }
        self.known.forget(root, path.end);
        Ok(())
    }

    /// Faces with new vertices, and the one that closes the gap.
    #[inline]
    fn add_run(&mut self, gap: &mut Gap, new: usize, closes: bool) -> Result<(), DecodeError> {
        // A gap between two different ends is closed, or the last face was the first.
        if closes && new == 0 && gap.from == gap.to {
            return Err(self.no_such(gap.to));
        }
        let faces = new + usize::from(closes);
        let first = self.known.vertex_count();
        if faces > self.faces_left || first as usize + new > self.counts[1] {
            return Err(self.too_many(faces > self.faces_left));
        }
        self.faces_left -= faces;

        // The vertex across the edge from which faces go on.
        let mut across = match new {
            0 => NONE,
            _ => gap.across(&self.known),
        };
        if !gap.is_backward {
            let to = closes.then_some(gap.to);
            self.known.add_fan(gap.root, gap.from, index32(new), to);
        }
        for vertex in first..first + index32(new) {
            let face = gap.face(vertex);
            if gap.is_backward {
                self.known.add_vertex();
                self.known.add_face(face);
            }
            // Without one, the vertex is taken to be near the neighbour.
            let across_or = if across == NONE { gap.root } else { across };
            self.fans.vertex(vertex, [gap.root, gap.from, across_or]);
            self.fans.face(face);
            across = gap.from;
            gap.from = vertex;
        }
        if closes {
            self.fans.face(gap.face(gap.to));
        }
        Ok(())
    }

    /// What comes after a run; returns whether anything follows.
    #[inline]
    fn take_turn(&mut self, gap: &mut Gap, run: Run) -> Result<bool, DecodeError> {
        // A new vertex has one face, whatever the one before had.
        gap.known[1] *= u32::from(run.new == 0);
        let count = self.known.vertex_count();
        let turn = self.fans.turn(gap, &self.known);
        let vertex = match turn {
            FanTurn::GoOn => return Ok(true),
            FanTurn::Stop => return Ok(false),
            FanTurn::Known => self.fans.known(gap, count),
            turn => turn.vertex(gap, &self.known),
        };
        if vertex <= gap.root || vertex >= count || vertex == gap.from {
            return Err(self.no_such(vertex));
        }
        self.named.push(vertex);
        self.new_face(gap.face(vertex))?;
        Ok(true)
    }

    fn gap(&self, root: u32, from: u32, to: u32, faces: u32, is_backward: bool) -> Gap {
        Gap {
            root,
            from,
            to,
            is_backward,
            known: [faces, self.known.faces(from), self.known.faces(to)],
            surplus: self.known.surplus(root),
        }
    }

    #[cold]
    fn no_such(&self, vertex: u32) -> DecodeError {
        self.fans.error(DecodeErrorKind::NoSuchVertex { vertex })
    }
}

impl Gap {
    /// The third vertex of the known face at the edge from which faces go on, or [`NONE`].
    #[inline]
    pub(super) fn across(&self, known: &KnownFaces) -> u32 {
        match self.is_backward {
            false => known.third(self.from, self.root),
            true => known.third(self.root, self.from),
        }
    }

    /// Whether a face may lead to the other end: to a vertex that was the root, none does any more.
    #[inline]
    pub(super) fn can_close(&self) -> bool {
        !self.is_backward && self.to >= self.root
    }

    /// The next face, with a vertex.
    #[inline]
    pub(super) fn face(&self, vertex: u32) -> [u32; 3] {
        match self.is_backward {
            false => [self.root, self.from, vertex],
            true => [self.root, vertex, self.from],
        }
    }
}
