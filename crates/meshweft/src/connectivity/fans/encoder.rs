//! Writes faces as fans.

use super::at_root::{AtRoot, Rank, RootFace};
use super::fan_model::FanModel;
use super::known_faces::{KnownFaces, NONE};
use super::traversal::{FanTurn, Fans, Gap, Run};
use super::vertex_coder::{VertexCoder, beyond, outlook};
use crate::bits::{DecodeError, DecodeErrorKind, RansEncoder};
use crate::faces::{Faces, turned};
use crate::index::index32;
use crate::topology::Adjacency;

/// The faces and what is left of them.
pub(super) struct FanEncoder<'a, V: VertexCoder> {
    faces: &'a [[u32; 3]],
    adjacency: Adjacency,
    is_drawn: Vec<bool>,
    /// The number of each vertex; [`NONE`] for those that were not met.
    new: Vec<u32>,
    /// The vertices that were met.
    pub(super) old: Vec<u32>,
    /// A vertex to begin a part with, if it was not met.
    seed: u32,
    /// Vertices below were met.
    next_seed: u32,
    at_root: AtRoot,
    /// The face at the root that a turn leads to.
    chosen: Option<u32>,
    /// The face that begins a fan, while its corners are asked for.
    begun: Option<u32>,
    /// The roots that have faces which follow no others, as often as a fan begins there.
    pub(super) more: Vec<u32>,
    /// The faces in the order in which they are drawn, and their turns.
    pub(super) drawn: Vec<u32>,
    pub(super) rotations: Vec<u8>,
    model: V::Model,
    at_vertices: V,
    pub(super) port: RansEncoder,
}

impl<'a, V: VertexCoder> FanEncoder<'a, V> {
    /// Faces without repeated corners; the first part begins with a vertex if it has faces.
    pub(super) fn new(faces: Faces<'a>, first_vertex: u32, at_vertices: V) -> Self {
        Self {
            faces: faces.as_slice(),
            adjacency: Adjacency::new(faces),
            is_drawn: vec![false; faces.len()],
            new: vec![NONE; faces.vertex_count()],
            old: Vec::with_capacity(faces.vertex_count()),
            seed: first_vertex,
            next_seed: 0,
            at_root: AtRoot::default(),
            chosen: None,
            begun: None,
            more: Vec::new(),
            drawn: Vec::with_capacity(faces.len()),
            rotations: Vec::with_capacity(faces.len()),
            model: V::Model::new(),
            at_vertices,
            port: RansEncoder::new(1 + V::LANES),
        }
    }

    fn meet(&mut self, vertex: u32) {
        let before = rank(&self.new, vertex);
        self.new[vertex as usize] = index32(self.old.len());
        self.old.push(vertex);
        let (new, after) = (&self.new, rank(&self.new, vertex));
        self.at_root.meet(vertex, before, after, |it| rank(new, it));
    }

    pub(super) fn is_new(&self, vertex: u32) -> bool {
        self.new[vertex as usize] == NONE
    }

    /// Codes what belongs to a vertex that has a number.
    #[inline]
    pub(super) fn code_vertex(&mut self, vertex: u32, near: [u32; 3]) {
        let source = self.old[vertex as usize];
        self.at_vertices.code(&mut self.port, source, near);
    }

    pub(super) fn settle(&mut self) {
        self.at_vertices.settle(&mut self.port);
    }

    /// The vertex to which a face leads.
    fn led_to(&self, gap: &Gap, place: u32) -> u32 {
        let RootFace { from, to, .. } = self.at_root.face(place);
        match gap.is_backward {
            false => to,
            true => from,
        }
    }

    fn draw(&mut self, place: u32) {
        let RootFace { from, face, .. } = self.at_root.face(place);
        let new = &self.new;
        self.at_root.take(place, |it| rank(new, it));
        self.is_drawn[face as usize] = true;
        self.drawn.push(face);
        // The root comes first, `from` second.
        let corners = self.faces[face as usize];
        let rotation = (0..3).find(|&rotation| turned(corners, rotation)[1] == from);
        self.rotations.push(rotation.unwrap_or(0));
    }
}

/// The rank of a vertex, by the numbers of those that were met.
fn rank(new: &[u32], vertex: u32) -> Rank {
    match new[vertex as usize] {
        NONE => Rank::from(vertex),
        number => 1 << 32 | Rank::from(number),
    }
}

impl<V: VertexCoder> Fans for FanEncoder<'_, V> {
    fn begin_part(&mut self) {
        let cannot =
            |it: &Self, vertex: u32| !it.is_new(vertex) || it.adjacency.degree(vertex) == 0;
        while cannot(self, self.seed) {
            self.seed = self.next_seed;
            self.next_seed += 1;
        }
        self.meet(self.seed);
    }

    fn begin_root(&mut self, root: u32) {
        let root = self.old[root as usize];
        let (faces, new) = (self.faces, &self.new);
        let of_root = self.adjacency.faces_of(root).iter().copied();
        let left = of_root.filter(|&face| !self.is_drawn[face as usize]);
        let at_root = left.map(|face| {
            let [a, b, c] = faces[face as usize];
            let (from, to) = match () {
                () if a == root => (b, c),
                () if b == root => (c, a),
                () => (a, b),
            };
            RootFace { from, to, face }
        });
        self.at_root.set(at_root, |it| rank(new, it));
    }

    fn run(&mut self, gap: &Gap, known: &KnownFaces) -> Run {
        let outlook = outlook(&self.at_vertices, gap, known);
        let mut neighbour = self.old[gap.from as usize];
        let end = self.old[gap.to as usize];
        let mut run = Run {
            new: 0,
            is_end: false,
            goes_on: false,
        };
        self.chosen = None;
        while let Some(place) = self.at_root.first_at(neighbour, gap.is_backward) {
            let vertex = self.led_to(gap, place);
            if self.is_new(vertex) && run.new < V::Model::MOST_NEW {
                self.meet(vertex);
                self.draw(place);
                run.new += 1;
                neighbour = vertex;
                if V::Model::MOST_NEW == 1 {
                    return self.model.run(&mut self.port, gap, outlook, Run::ONE);
                }
            } else if vertex == end && vertex != neighbour && gap.can_close() {
                self.draw(place);
                run.is_end = true;
                break;
            } else {
                self.chosen = Some(place);
                break;
            }
        }
        run.is_end |= !gap.can_close() && self.chosen.is_none();
        self.model.run(&mut self.port, gap, outlook, run)
    }

    fn turn(&mut self, gap: &Gap, known: &KnownFaces) -> FanTurn {
        let vertex = self
            .chosen
            .map(|place| self.new[self.led_to(gap, place) as usize]);
        let is_it = |turn: &FanTurn| match (turn, vertex) {
            (FanTurn::Stop, None) | (FanTurn::GoOn, Some(NONE)) => true,
            (FanTurn::Stop, _) | (FanTurn::GoOn, _) | (_, None | Some(NONE)) => false,
            (FanTurn::Known, _) => true,
            (turn, Some(vertex)) => turn.vertex(gap, known) == vertex,
        };
        let found = FanTurn::ALL.iter().position(is_it);
        let found = found.expect("any vertex that was met is known");
        let beyond = beyond(&self.at_vertices, gap, known);
        let turn = self.model.turn(&mut self.port, gap, beyond, found);
        if !matches!(turn, FanTurn::Known | FanTurn::Stop | FanTurn::GoOn)
            && let Some(place) = self.chosen
        {
            self.draw(place);
        }
        turn
    }

    fn known(&mut self, gap: &Gap, count: u32) -> u32 {
        let place = self.chosen.expect("a face was chosen");
        let vertex = self.new[self.led_to(gap, place) as usize];
        self.draw(place);
        self.model.known(&mut self.port, gap.root, count, vertex)
    }

    fn has_more(&mut self, root: u32) -> bool {
        let new = &self.new;
        let has_more = self.at_root.first(|it| rank(new, it)).is_some();
        if has_more {
            self.more.push(root);
        }
        has_more
    }

    fn corner(&mut self, root: u32, which: usize, count: u32) -> Option<u32> {
        if which == 0 {
            let new = &self.new;
            self.begun = self.at_root.first(|it| rank(new, it));
        }
        let place = self.begun.expect("a face is left");
        let RootFace { from, to, .. } = self.at_root.face(place);
        let vertex = [from, to][which];
        let number = Some(self.new[vertex as usize]).filter(|&number| number != NONE);
        if number.is_none() {
            self.meet(vertex);
        }
        if which == 1 {
            self.draw(place);
        }
        self.model.corner(&mut self.port, root, count, number)
    }

    fn vertex(&mut self, vertex: u32, near: [u32; 3]) {
        self.code_vertex(vertex, near);
    }

    fn face(&mut self, _: [u32; 3]) {}

    fn check(&self) -> Result<(), DecodeError> {
        Ok(())
    }

    fn error(&self, kind: DecodeErrorKind) -> DecodeError {
        DecodeError { byte: 0, kind }
    }
}
