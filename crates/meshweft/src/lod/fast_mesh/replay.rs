//! The removals of a mesh, played on half-edges, with what has to be known of each.

use super::deviation::NearestFaces;
use super::hierarchy::HierarchyNode;
use super::links::Edge;
use crate::geometry::double::{add, cross, dot, rounded_up, scaled, sub, widened};
use crate::index::index32;
use crate::lod::cone::PackedCone;
use crate::progressive::{Collapse, ProgressiveMesh};
use crate::topology::half_edges::{HalfEdges, NONE, next, previous};

/// A collapse, in the numbers of the input.
#[derive(Debug, Clone, Copy)]
pub(super) struct Made {
    pub(super) point: u32,
    pub(super) edge: Edge,
    pub(super) flags: u32,
}

/// The mesh while points leave, in the numbers of the input, but for faces: those with two corners at one point are left out.
#[derive(Debug)]
pub(super) struct Replay<'a> {
    pub(super) positions: &'a [[f32; 3]],
    /// The first vertex at the place of each.
    pub(super) point_of: Vec<u32>,
    pub(super) edges: HalfEdges,
    pub(super) nodes: Vec<HierarchyNode>,
    pub(super) made: Vec<Made>,
    pub(super) flat_faces: Vec<u32>,
    pub(super) cut_points: usize,
    /// The number here of each face of the input.
    face_of: Vec<u32>,
    deviation: NearestFaces,
    /// Around the normals of the input's faces at each point.
    cones: Vec<PackedCone>,
    /// The faces around the point that leaves; those that stay, with their corners; and normals of both.
    faces: Vec<u32>,
    staying: Vec<(u32, [[f64; 3]; 3])>,
    normals: Vec<[f64; 3]>,
}

impl<'a> Replay<'a> {
    pub(super) fn new(
        positions: &'a [[f32; 3]],
        removals: &ProgressiveMesh,
        point_of: Vec<u32>,
    ) -> Self {
        let mut faces = Vec::with_capacity(removals.faces().len());
        let mut face_of = vec![NONE; removals.faces().len()];
        let mut flat_faces = Vec::new();
        for (number, &face) in (0..).zip(removals.faces()) {
            let [a, b, c] = face.map(|vertex| point_of[vertex as usize]);
            if a == b || b == c || c == a {
                flat_faces.push(number);
            } else {
                face_of[number as usize] = index32(faces.len());
                faces.push(face);
            }
        }

        // Twins are found between points; then corners get their vertices.
        let point = |vertex: u32| point_of[vertex as usize];
        let points: Vec<[u32; 3]> = faces.iter().map(|&face| face.map(point)).collect();
        let mut edges = HalfEdges::new(&points, positions.len());
        let cut_points = cut_points(&edges, positions.len());
        for (half_edge, &vertex) in (0..).zip(faces.as_flattened()) {
            edges.set_start(half_edge, vertex);
        }
        let place = |vertex: u32| widened(positions[vertex as usize]);
        let placed = points.iter().map(|&face| (face, face.map(place)));
        let cones = PackedCone::around_points(positions.len(), placed);
        Self {
            positions,
            cones,
            nodes: vec![HierarchyNode::ROOT; positions.len()],
            made: Vec::with_capacity(removals.last_level()),
            deviation: NearestFaces::new(faces.len(), positions.len()),
            point_of,
            edges,
            flat_faces,
            cut_points,
            face_of,
            faces: Vec::new(),
            staying: Vec::new(),
            normals: Vec::new(),
        }
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        widened(self.positions[vertex as usize])
    }

    fn corners(&self, face: u32) -> [[f64; 3]; 3] {
        self.edges.face(face).map(|vertex| self.position(vertex))
    }

    /// The edge along which a point leaves; `None` if no point does.
    fn edge(&self, removal: Collapse<'_>) -> Option<(u32, u32, Edge)> {
        let pair = removal.pairs().next()?;
        let [point, to] = [pair.from, pair.to].map(|vertex| self.point_of[vertex as usize]);
        let mut edge = Edge {
            forth: NONE,
            back: NONE,
        };
        for &face in removal.leaving_faces() {
            let first = 3 * self.face_of[face as usize];
            let at = |half_edge: u32| self.point_of[self.edges.start(half_edge) as usize];
            let here = (first..first + 3).find(|&half_edge| at(half_edge) == point)?;
            if at(next(here)) == to {
                edge.forth = here;
            } else {
                edge.back = previous(here);
            }
        }
        Some((point, to, edge))
    }

    /// A point leaves, with all that has to be known of it.
    pub(super) fn collapse(&mut self, removal: Collapse<'_>) {
        let Some((point, to, edge)) = self.edge(removal) else {
            return;
        };
        let flags = edge.flags(&self.edges);
        debug_assert!(flags.is_some(), "vertices can be told from those around");

        // What there is around the point before.
        let leaving = self.gather(edge);
        self.normals.clear();
        let middle = self.position(to);
        let (mut square, mut axis) = (0.0_f64, [0.0; 3]);
        for place in 0..self.faces.len() {
            let corners = self.corners(self.faces[place]);
            for corner in corners {
                let way = sub(corner, middle);
                square = square.max(dot(way, way));
            }
            axis = add(axis, self.put_normal(corners));
        }

        let deviation = self.leave(point, edge, leaving);

        // What there is after.
        for place in leaving..self.faces.len() {
            self.put_normal(self.corners(self.faces[place]));
        }
        self.make_node(point, to, [deviation, square.sqrt()], axis);
        self.made.push(Made {
            point,
            edge,
            flags: flags.unwrap_or_default(),
        });
    }

    /// Gathers the faces around the point of an edge, those that leave first; returns how many these are.
    fn gather(&mut self, edge: Edge) -> usize {
        self.faces.clear();
        self.faces.extend(edge.faces());
        let leaving = self.faces.len();
        self.faces.extend(edge.fan(&self.edges).map(|it| it / 3));
        leaving
    }

    /// A point leaves, around which faces were gathered; returns how far the surface is from the points that left there.
    fn leave(&mut self, point: u32, edge: Edge, leaving: usize) -> f64 {
        self.deviation.take(point, &self.faces);
        edge.collapse(&mut self.edges, |_| {});

        // Where no face of the fan stays, those beyond the one that left.
        self.staying.clear();
        for &face in &self.faces[leaving..] {
            self.staying.push((face, self.corners(face)));
        }
        if self.staying.is_empty() {
            for face in edge.faces_around(&self.edges) {
                self.staying.push((face, self.corners(face)));
            }
        }
        let positions = self.positions;
        let position = |point: u32| widened(positions[point as usize]);
        self.deviation.give(&self.staying, position)
    }

    /// The points return, all of them.
    pub(super) fn split_all(&mut self) {
        for made in self.made.iter().rev() {
            made.edge.split(made.flags, &mut self.edges, |_| {});
        }
        self.deviation = NearestFaces::new(self.edges.len() / 3, self.positions.len());
    }

    /// A point leaves once more, by the number of its collapse; returns its error.
    pub(super) fn collapse_again(&mut self, number: u32) -> f32 {
        let Made { point, edge, .. } = self.made[number as usize];
        let leaving = self.gather(edge);
        rounded_up(self.leave(point, edge, leaving))
    }

    /// The ball and the cone of the point that left last contain the points whose distances are its error, and the normals there:
    /// these may be seen where the faces that were there are not.
    pub(super) fn contain_measured(&mut self, number: u32) {
        let point = self.made[number as usize].point;
        let node = self.nodes[point as usize];
        let middle = self.position(node.parent);
        let measured = self.deviation.given();
        let mut square = 0.0_f64;
        for &point in measured {
            let way = sub(self.position(point), middle);
            square = square.max(dot(way, way));
        }
        let cones = measured.iter().map(|&point| self.cones[point as usize]);
        let cone = node.cone.with(cones);
        let node = &mut self.nodes[point as usize];
        node.radius = node.radius.max(with_room(square.sqrt()));
        node.cone = cone;
    }

    /// Every node contains those below, in the order of the build, where these come first.
    pub(super) fn contain_below(&mut self) {
        for made in &self.made {
            let mut node = self.nodes[made.point as usize];
            let way = sub(self.position(made.point), self.position(node.parent));
            let step = dot(way, way).sqrt();
            for (below, step) in [(node.first_child, step), (node.next_sibling, 0.0)] {
                if below != NONE {
                    let below = self.nodes[below as usize];
                    let reach = f64::from(below.radius) + step;
                    if reach > f64::from(node.radius) {
                        node.radius = with_room(reach);
                    }
                    node.error = node.error.max(below.error);
                    node.cone = node.cone.with(std::iter::once(below.cone));
                }
            }
            self.nodes[made.point as usize] = node;
        }
    }

    /// Remembers the normal of a face with an area; returns it, as long as the area is large.
    fn put_normal(&mut self, [a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
        let normal = cross(sub(b, a), sub(c, a));
        let length = dot(normal, normal).sqrt();
        if length > 0.0 {
            self.normals.push(scaled(normal, 1.0 / length));
        }
        normal
    }

    /// The node of a collapse contains those below: of what went into the point, and of what went into its parent before.
    fn make_node(
        &mut self,
        point: u32,
        parent: u32,
        [deviation, radius]: [f64; 2],
        axis: [f64; 3],
    ) {
        let way = sub(self.position(point), self.position(parent));
        let step = dot(way, way).sqrt();
        let first_child = self.nodes[point as usize].first_child;
        let next_sibling = self.nodes[parent as usize].first_child;
        let node = |place: u32| self.nodes.get(place as usize).copied();
        let below = [(node(first_child), step), (node(next_sibling), 0.0)];
        let below = below
            .into_iter()
            .filter_map(|(node, way)| Some((node?, way)));

        let (mut error, mut reach) = (rounded_up(deviation), radius);
        for (node, way) in below.clone() {
            error = error.max(node.error);
            reach = reach.max(f64::from(node.radius) + way);
        }
        let cones = below.map(|(node, _)| node.cone);
        let node = HierarchyNode {
            error,
            radius: with_room(reach),
            cone: PackedCone::around(axis, self.normals.iter().copied(), cones),
            parent,
            first_child,
            next_sibling,
        };
        self.nodes[point as usize] = node;
        self.nodes[parent as usize].first_child = point;
    }
}

/// A radius, larger by more than what rounding may do to a test.
fn with_room(radius: f64) -> f32 {
    rounded_up(radius * (1.0 + 1e-6))
}

/// How many points have faces that are not one fan.
fn cut_points(edges: &HalfEdges, point_count: usize) -> usize {
    let mut fans = vec![0_u8; point_count];
    let mut is_seen = vec![false; edges.len()];
    for start in 0..index32(edges.len()) {
        if is_seen[start as usize] {
            continue;
        }
        let fan = &mut fans[edges.start(start) as usize];
        *fan = fan.saturating_add(1);

        // One way round, then the other where there is a border.
        let mut at = start;
        while at != NONE && !is_seen[at as usize] {
            is_seen[at as usize] = true;
            at = edges.twin(previous(at));
        }
        let mut twin = if at == NONE { edges.twin(start) } else { NONE };
        while twin != NONE {
            is_seen[next(twin) as usize] = true;
            twin = edges.twin(next(twin));
        }
    }
    fans.iter().filter(|&&fans| fans > 1).count()
}
