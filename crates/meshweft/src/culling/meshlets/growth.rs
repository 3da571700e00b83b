//! Meshlets grown vertex by vertex.

use std::f64::consts::PI;

use super::remaining::Remaining;
use super::settings::Meshlets;
use crate::geometry::double::{add, cross, dot, scaled, sub, widened};
use crate::index::index32;
use crate::mesh::Mesh;
use crate::topology::{Adjacency, distinct};

/// How many faces beside finished meshlets are kept as starts of the next ones.
const MOST_STARTS: usize = 256;

/// What counts beside a distance of the radius of a meshlet, which is 1, as a finished vertex is: normals across the
/// others', and a face more. Chosen by the vertices of all meshlets, and by what their cones leave out, of two scans.
const SPREAD: f64 = 8.0;
const GAINED: f64 = 0.5;

/// The faces that are in no meshlet yet, and the meshlet that is made.
pub(super) struct MeshletGrowth<'a> {
    settings: Meshlets,
    mesh: &'a Mesh,
    adjacency: Adjacency,
    remaining: Remaining,
    normals: Vec<[f32; 3]>,
    middles: Vec<[f32; 3]>,
    faces: Vec<OpenFace>,
    vertices: Vec<OpenVertex>,
    /// How far the vertices of a round meshlet are from its middle, at most.
    radius: f64,
    /// The vertices and faces of the meshlet.
    inside: Vec<u32>,
    taken: Vec<u32>,
    /// Faces between its vertices that are not taken yet.
    ready: Vec<u32>,
    /// Vertices with which it would get faces.
    candidates: Vec<u32>,
    /// The sum of its vertices' positions, and of its faces' normals.
    sum: [f64; 3],
    normal: [f64; 3],
    starts: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct OpenFace {
    is_done: bool,
    /// How many of its vertices are not in the meshlet.
    missing: u8,
}

#[derive(Debug, Clone, Copy, Default)]
struct OpenVertex {
    /// How many faces of it are in no meshlet.
    left: u32,
    /// How many faces miss only this vertex.
    covers: u32,
    is_inside: bool,
}

impl<'a> MeshletGrowth<'a> {
    pub(super) fn new(settings: Meshlets, mesh: &'a Mesh) -> Self {
        let adjacency = Adjacency::new(mesh);
        let shapes: Vec<_> = mesh.faces().iter().map(|face| shape(mesh, face)).collect();
        let area: f64 = shapes.iter().map(|shape| shape.area).sum();
        let middles: Vec<[f32; 3]> = shapes.iter().map(|shape| shape.middle).collect();
        let of_meshlet = area / mesh.face_count().max(1) as f64 * f64::from(settings.face_limit);
        let face = |&face: &[u32; 3]| OpenFace {
            is_done: false,
            missing: vertex_count(face),
        };
        let vertex = |vertex| OpenVertex {
            left: adjacency.degree(vertex),
            ..OpenVertex::default()
        };
        Self {
            settings,
            remaining: Remaining::new(&middles),
            normals: shapes.iter().map(|shape| shape.normal).collect(),
            middles,
            faces: mesh.faces().iter().map(face).collect(),
            vertices: (0..index32(mesh.vertex_count())).map(vertex).collect(),
            radius: (of_meshlet / PI).sqrt(),
            inside: Vec::new(),
            taken: Vec::new(),
            ready: Vec::new(),
            candidates: Vec::new(),
            sum: [0.0; 3],
            normal: [0.0; 3],
            starts: Vec::new(),
            mesh,
            adjacency,
        }
    }

    /// The faces of the next meshlet, in the order in which it took them; `None` if none is left.
    pub(super) fn next(&mut self) -> Option<&[u32]> {
        self.close();
        let start = self.start()?;
        self.bring(start);
        while self.taken.len() < self.settings.face_limit as usize {
            let has_room = self.room() > 0;
            match self.best() {
                Some(place) if has_room => {
                    self.enter(self.candidates[place]);
                    self.take_ready();
                }
                None if has_room => {
                    let nearest = self.remaining.nearest(self.middle());
                    let fits =
                        |&face: &u32| usize::from(self.faces[face as usize].missing) <= self.room();
                    let Some(face) = nearest.filter(fits) else {
                        break;
                    };
                    self.bring(face);
                }
                _ => break,
            }
        }
        Some(&self.taken)
    }

    /// How many more vertices there may be.
    fn room(&self) -> usize {
        self.settings.vertex_limit as usize - self.inside.len()
    }

    fn middle(&self) -> [f64; 3] {
        scaled(self.sum, 1.0 / self.inside.len().max(1) as f64)
    }

    /// Takes a face, with all of its vertices.
    fn bring(&mut self, face: u32) {
        for vertex in distinct(self.mesh.faces()[face as usize]) {
            if !self.vertices[vertex as usize].is_inside {
                self.enter(vertex);
            }
        }
        // This face before others between the same vertices.
        if let Some(place) = self.ready.iter().position(|&ready| ready == face) {
            self.ready.swap_remove(place);
            self.ready.push(face);
        }
        self.take_ready();
    }

    /// A vertex comes into the meshlet.
    fn enter(&mut self, vertex: u32) {
        let state = &mut self.vertices[vertex as usize];
        state.is_inside = true;
        if std::mem::take(&mut state.covers) > 0 {
            self.candidates.retain(|&candidate| candidate != vertex);
        }
        self.inside.push(vertex);
        self.sum = add(self.sum, widened(position(self.mesh, vertex)));
        for &face in self.adjacency.faces_of(vertex) {
            let state = &mut self.faces[face as usize];
            if state.is_done {
                continue;
            }
            state.missing -= 1;
            match state.missing {
                0 => self.ready.push(face),
                1 => {
                    let missing = |&vertex: &u32| !self.vertices[vertex as usize].is_inside;
                    let corners = self.mesh.faces()[face as usize];
                    if let Some(missing) = corners.into_iter().find(missing) {
                        let covers = &mut self.vertices[missing as usize].covers;
                        if *covers == 0 {
                            self.candidates.push(missing);
                        }
                        *covers += 1;
                    }
                }
                _ => {}
            }
        }
    }

    /// Takes the faces between vertices of the meshlet, as many as it may.
    fn take_ready(&mut self) {
        while self.taken.len() < self.settings.face_limit as usize {
            let Some(face) = self.ready.pop() else {
                return;
            };
            self.faces[face as usize].is_done = true;
            self.remaining.take(face);
            self.taken.push(face);
            self.normal = add(self.normal, widened(self.normals[face as usize]));
            for vertex in distinct(self.mesh.faces()[face as usize]) {
                self.vertices[vertex as usize].left -= 1;
            }
        }
    }

    /// The place of the best candidate.
    fn best(&self) -> Option<usize> {
        let middle = self.middle();
        let length = dot(self.normal, self.normal).sqrt();
        let axis = match length > 0.0 {
            true => scaled(self.normal, 1.0 / length),
            false => [0.0; 3],
        };
        let mut best = None;
        for (place, &vertex) in self.candidates.iter().enumerate() {
            let cost = self.cost(vertex, middle, axis);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, place));
            }
        }
        best.map(|(_, place)| place)
    }

    /// What it costs to take a vertex next: its distance and how far the normals of the faces that come with it are from the
    /// others, less what is gained.
    fn cost(&self, vertex: u32, middle: [f64; 3], axis: [f64; 3]) -> f64 {
        let state = self.vertices[vertex as usize];
        let room = self.settings.face_limit - index32(self.taken.len());
        let gained = state.covers.min(room);
        let way = sub(widened(position(self.mesh, vertex)), middle);
        let distance = dot(way, way).sqrt() / self.radius.max(f64::MIN_POSITIVE);

        // A vertex that is finished is in no other meshlet.
        let mut spread: f64 = 0.0;
        let mut finished = u32::from(state.left == gained);
        for &face in self.adjacency.faces_of(vertex) {
            let state = self.faces[face as usize];
            if state.is_done || state.missing != 1 {
                continue;
            }
            let normal = widened(self.normals[face as usize]);
            spread = spread.max(1.0 - dot(normal, axis));
            let corners = self.mesh.faces()[face as usize];
            let left = corners.map(|corner| self.vertices[corner as usize].left);
            let others = corners
                .iter()
                .zip(left)
                .filter(|&(&corner, _)| corner != vertex);
            finished += others.map(|(_, left)| u32::from(left == 1)).sum::<u32>();
        }
        let weight = f64::from(self.settings.cone_weight);
        (1.0 - weight) * distance + SPREAD * weight * spread
            - GAINED * f64::from(gained)
            - f64::from(finished)
    }

    /// The face to start the next meshlet with: beside the finished ones, where few are left.
    fn start(&mut self) -> Option<u32> {
        let faces = &self.faces;
        self.starts.retain(|&face| !faces[face as usize].is_done);

        // The fewest faces left, then the nearest.
        let middle = self.middle();
        let mut best: Option<(u32, f64, u32)> = None;
        for &face in &self.starts {
            let way = sub(widened(self.middles[face as usize]), middle);
            let found = (self.left_at(face), dot(way, way), face);
            if best.is_none_or(|best| found < best) {
                best = Some(found);
            }
        }

        // A meshlet without a vertex.
        self.inside.clear();
        self.taken.clear();
        self.sum = [0.0; 3];
        self.normal = [0.0; 3];
        match best {
            Some((_, _, face)) => Some(face),
            None => self.remaining.nearest(middle),
        }
    }

    /// How many faces are left at the vertices of a face.
    fn left_at(&self, face: u32) -> u32 {
        let corners = self.mesh.faces()[face as usize];
        corners
            .map(|vertex| self.vertices[vertex as usize].left)
            .iter()
            .sum()
    }

    /// Ends a meshlet: what its vertices were to other faces is forgotten, and these faces are starts.
    fn close(&mut self) {
        for place in 0..self.inside.len() {
            let vertex = self.inside[place];
            self.vertices[vertex as usize].is_inside = false;
            let mut start: Option<(u32, u32)> = None;
            for &face in self.adjacency.faces_of(vertex) {
                let state = &mut self.faces[face as usize];
                if !state.is_done {
                    state.missing = vertex_count(self.mesh.faces()[face as usize]);
                    let found = (self.left_at(face), face);
                    start = Some(start.map_or(found, |start| start.min(found)));
                }
            }
            self.starts.extend(start.map(|(_, face)| face));
        }
        for &vertex in &self.candidates {
            self.vertices[vertex as usize].covers = 0;
        }
        self.candidates.clear();
        self.ready.clear();

        // The last ones are the nearest.
        let surplus = self.starts.len().saturating_sub(MOST_STARTS);
        self.starts.drain(..surplus);
    }
}

/// How many vertices a face has.
fn vertex_count(face: [u32; 3]) -> u8 {
    distinct(face).map(|_| 1).sum()
}

/// What counts of a face.
struct FaceShape {
    middle: [f32; 3],
    /// Of length 1, or 0 where that is not known.
    normal: [f32; 3],
    area: f64,
}

fn shape(mesh: &Mesh, face: &[u32; 3]) -> FaceShape {
    let [a, b, c] = face.map(|vertex| widened(position(mesh, vertex)));
    let normal = cross(sub(b, a), sub(c, a));
    let length = dot(normal, normal).sqrt();
    let factor = if length > 0.0 { 1.0 / length } else { 0.0 };
    #[expect(clippy::cast_possible_truncation, reason = "only compared")]
    let narrowed = |point: [f64; 3]| point.map(|x| x as f32);
    FaceShape {
        middle: narrowed(scaled(add(add(a, b), c), 1.0 / 3.0)),
        normal: narrowed(scaled(normal, factor)),
        area: length / 2.0,
    }
}

/// Where a vertex is; coordinates that are no number are 0.
fn position(mesh: &Mesh, vertex: u32) -> [f32; 3] {
    mesh.positions()[vertex as usize].map(|x| if x.is_finite() { x } else { 0.0 })
}
