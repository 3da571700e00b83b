//! View-mask clusters: faces that are seen from the same eyes.
//!
//! Normals alone put faces from all over the mesh side by side, and each of their vertices is transformed for each of them. So
//! clusters are made of neighbours here, by what drawing them is expected to cost: the share of eyes that see something of a
//! cluster, times the vertices that drawing it takes.
//!
//! 1. `eyes`: some hundred eyes are sampled. `masks`: a bit for each that is in front of a face.
//! 2. `merge`: each face is a cluster; the two neighbours that save most become one, as long as that saves anything. A
//!    cluster has the bits of all its faces. `parts` does that side by side.
//!    `moves` then puts single faces into a neighbouring cluster where they cost less.
//! 3. For an NVIDIA card, `moves` makes more clusters multiples of 32 faces, and `batches` makes all of them whole batches.
//! 4. `tour`: clusters that are seen from nearly the same eyes come after each other, so that draws are few.
//! 5. The faces of each cluster are put in an order for the cache, and [`CullingTable`] bounds from where it is seen.

mod batches;
mod eyes;
mod face_cluster;
mod masks;
mod merge;
mod moves;
mod parts;
mod seen;
#[cfg(test)]
mod tests;
mod tour;

use super::eye::Eye;
use super::facing::Facing;
use super::inner_order;
use super::table::CullingTable;
use crate::cache::CacheModel;
use crate::geometry::Ball;
use crate::geometry::double::{scaled, widened};
use crate::index::index32;
use crate::mesh::Mesh;
use crate::order::{Optimizer, Target};
use crate::permutation::FaceOrder;
pub use eyes::SampledEyes;
use face_cluster::in_tour;
use merge::Price;
use seen::Seen;

/// Clusters of neighbouring faces that are seen from the same eyes, for few vertices and few draws.
///
/// The costs are in vertices: what an eye is expected to cost is the sum, over the clusters that it sees something of, of their
/// vertices, plus [`face_cost`](Self::face_cost) for each face, plus [`draw_cost`](Self::draw_cost).
///
/// ```
/// use meshweft::Mesh;
/// use meshweft::culling::{Eye, Ranges, ViewClusters};
/// // A box: two faces a side.
/// let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2].map(|x| x as f32);
/// let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
/// let faces: Vec<_> = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
/// let mesh = Mesh::new((0..8).map(corner).collect::<Vec<_>>(), faces)?;
///
/// let clusters = ViewClusters { draw_cost: 0.0, ..ViewClusters::default() };
/// let clustered = clusters.order(&mesh);
/// let mut ranges = Ranges::default();
/// clustered.table().visible_ranges(Eye::at([0.5, 0.5, 9.0]), &mut ranges);
/// assert_eq!(ranges.face_count(), 2); // One side faces the eye.
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ViewClusters {
    /// The eyes that drawing is expected from.
    pub eyes: SampledEyes,
    /// *α*: what a face costs that is drawn, in vertices. A cache that is too small for a cluster transforms some vertices
    /// again.
    pub face_cost: f32,
    /// *λ*: what another cluster costs, in vertices. With more, clusters are larger and fewer.
    pub draw_cost: f32,
    /// What puts the faces of each cluster in order. For [`CacheModel::Nvidia`] clusters are whole batches of the card: most have a
    /// multiple of 32 faces, and where vertices stand in blocks of 65,536, as [`vertex_blocks`](crate::order::vertex_blocks())
    /// numbers them, no batch has faces of two blocks.
    pub optimizer: Optimizer,
    /// How far each position may be from where it is drawn, in the units of positions: half a step of the lattice where they
    /// are rounded afterwards, times √3.
    pub position_error: f32,
}

impl Default for ViewClusters {
    fn default() -> Self {
        Self {
            eyes: SampledEyes::default(),
            face_cost: 0.8,
            draw_cost: 2.0,
            optimizer: Optimizer::for_cache(CacheModel::fifo(16)),
            position_error: 0.0,
        }
    }
}

/// Faces in clusters, and what finds those that may be seen.
#[derive(Debug, Clone, PartialEq)]
pub struct ClusteredFaces {
    order: FaceOrder,
    table: CullingTable,
}

impl ClusteredFaces {
    /// The order of the faces.
    #[must_use]
    pub fn order(&self) -> &FaceOrder {
        &self.order
    }

    /// Which of the faces, in their new order, an eye may see.
    #[must_use]
    pub fn table(&self) -> &CullingTable {
        &self.table
    }
}

/// More would not change anything.
const MOST_COST: f32 = 1e6;

/// How much of what a vertex costs goes to the faces, for a card. With more, clusters are smaller and draws more.
const FOR_CARD: f32 = 0.6;

/// The direction from the middle of a ball towards an eye.
fn direction(eye: Eye, ball: Ball) -> [f64; 3] {
    let [x, y, z, _] = eye.around(ball.center).unwrap_or([0.0; 4]);
    let length = (x * x + y * y + z * z).sqrt();
    scaled([x, y, z], if length > 0.0 { 1.0 / length } else { 0.0 })
}

impl ViewClusters {
    /// The faces of a mesh in clusters.
    ///
    /// Two clusters come last. The first has the faces whose side rounding leaves unknown; it is always drawn. The second has the
    /// faces with two equal corners, which have no front. A mesh too large or too small for a table is one cluster.
    ///
    /// # Panics
    /// If the mesh has no positions, or more than [`SampledEyes::MOST`] eyes are asked for.
    ///
    /// # Complexity
    /// Time about O(faces · (eyes + log faces)), and what the optimizer takes; space 300 bytes a face.
    #[must_use]
    pub fn order(&self, mesh: &Mesh) -> ClusteredFaces {
        assert!(
            mesh.faces().is_empty() || !mesh.positions().is_empty(),
            "no positions"
        );
        let Some(ball) = Ball::around(mesh.corner_positions()).filter(CullingTable::holds) else {
            let end = index32(mesh.face_count());
            let starts = if end == 0 { vec![0] } else { vec![0, end] };
            return ClusteredFaces {
                order: FaceOrder::identity(mesh.face_count()),
                table: CullingTable::new(mesh, &starts),
            };
        };
        let eyes = self.eyes.eyes(ball);
        match eyes.len() {
            0..=64 => self.order_for::<1>(mesh, ball, &eyes),
            65..=128 => self.order_for::<2>(mesh, ball, &eyes),
            129..=256 => self.order_for::<4>(mesh, ball, &eyes),
            _ => self.order_for::<8>(mesh, ball, &eyes),
        }
    }

    fn order_for<const WORDS: usize>(
        &self,
        mesh: &Mesh,
        ball: Ball,
        eyes: &[Eye],
    ) -> ClusteredFaces {
        // Faces that are seen from one side, and the others.
        let mut faces = Vec::with_capacity(mesh.face_count());
        let mut planes = Vec::with_capacity(mesh.face_count());
        let mut others = [Vec::new(), Vec::new()];
        for (number, face) in (0..).zip(mesh.faces()) {
            let corners = face.map(|vertex| widened(mesh.positions()[vertex as usize]));
            match Facing::of(corners, ball.center) {
                Facing::Plane(plane) => {
                    faces.push(number);
                    planes.push(plane);
                }
                Facing::Unknown => others[0].push(number),
                Facing::Never => others[1].push(number),
            }
        }

        // Clusters, in the order of a tour.
        let masks = masks::of_planes::<WORDS>(&planes, ball.center, eyes);
        let directions: Vec<[f64; 3]> = eyes.iter().map(|eye| direction(*eye, ball)).collect();
        let seen = Seen {
            mesh,
            faces: &faces,
            masks: &masks,
            directions: &directions,
        };
        let (price, card) = (self.price(), self.price_for_card());
        let mut clusters = parts::clusters(&seen, price, card);
        if let Some(price) = card {
            clusters = batches::clusters(&seen, clusters, price, |runs| {
                let ordered = inner_order::each(mesh, runs, &self.optimizer).into_iter();
                let in_order = |(faces, order): (Vec<u32>, FaceOrder)| {
                    let places = order.new_to_old().iter();
                    places.map(|&place| faces[place as usize]).collect()
                };
                ordered.map(in_order).collect()
            });
        }
        let clusters = in_tour(clusters, &directions, card.unwrap_or(price));

        // The faces of each in order.
        let members = clusters.into_iter().map(|cluster| cluster.faces);
        let mut ordered: Vec<(Vec<u32>, FaceOrder)> = match card {
            Some(_) => members
                .map(|faces| {
                    let order = FaceOrder::identity(faces.len());
                    (faces, order)
                })
                .collect(),
            None => inner_order::each(mesh, members.collect(), &self.optimizer),
        };
        ordered.extend(inner_order::each(mesh, others.into(), &self.optimizer));
        ordered.retain(|(faces, _)| !faces.is_empty());
        let mut starts = vec![0];
        for (faces, _) in &ordered {
            starts.push(starts[starts.len() - 1] + index32(faces.len()));
        }
        let order = inner_order::joined(ordered);
        let ordered = mesh.with_face_order(&order);
        let error = f64::from(self.position_error.max(0.0));
        let table = CullingTable::within(&ordered, &starts, error, eyes);
        ClusteredFaces { order, table }
    }

    /// What a cluster costs.
    fn price(&self) -> Price {
        // NaN costs nothing too.
        let cost = |cost: f32| if cost > 0.0 { cost.min(MOST_COST) } else { 0.0 };
        Price {
            vertex: 1.0,
            face: cost(self.face_cost),
            draw: cost(self.draw_cost),
        }
    }

    /// What batches of an NVIDIA card cost, if faces are ordered for one: a batch is as dear with few vertices, so faces weigh more.
    fn price_for_card(&self) -> Option<Price> {
        let is_for_card = self.optimizer.target == Target::Cache(CacheModel::Nvidia);
        let Price { vertex, face, draw } = self.price();
        is_for_card.then_some(Price {
            vertex: vertex * (1.0 - FOR_CARD),
            face: face + FOR_CARD,
            draw,
        })
    }
}
