//! A table looked at from many sides: what it leaves out, and what is left to do.

use crate::cache::{self, CacheModel};
use crate::culling::{CullingTable, Eye, Ranges};
use crate::faces::Faces;
use crate::geometry::Ball;
use crate::geometry::double::{add, cross, dot, scaled, sub, widened};
use crate::mesh::Mesh;
use crate::parallel;
use crate::random::SplitMix64;

/// The cache whose misses are the vertex work.
pub(super) const CACHE: CacheModel = CacheModel::fifo(16);

/// How far in front of a face, by the sine of the angle, an eye surely sees it.
const SURELY: f64 = 1e-5;

/// Sums over the views of one distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct ViewSums {
    /// How many views.
    pub views: u64,
    /// Faces of all views, drawn or not.
    pub faces: u64,
    /// Those that are drawn.
    pub drawn: u64,
    /// Those that do not face the eye: edge on and without an area too.
    pub back: u64,
    /// Those that face away and are not drawn.
    pub back_rejected: u64,
    /// Those that surely face the eye and are not drawn: none, if the table matches the faces.
    pub wrongly_rejected: u64,
    /// Ranges of faces that are drawn, each by a call.
    pub draws: u64,
    /// Misses of what is drawn in a first-in first-out cache of 16 vertices.
    pub misses: u64,
}

impl ViewSums {
    /// Adds other views.
    pub(super) fn add(&mut self, other: &Self) {
        self.views += other.views;
        self.faces += other.faces;
        self.drawn += other.drawn;
        self.back += other.back;
        self.back_rejected += other.back_rejected;
        self.wrongly_rejected += other.wrongly_rejected;
        self.draws += other.draws;
        self.misses += other.misses;
    }

    /// The share of all faces that is drawn; 0 without faces.
    #[must_use]
    pub fn drawn_share(&self) -> f64 {
        ratio(self.drawn, self.faces)
    }

    /// The share of the faces that face away which is not drawn; 0 without such faces.
    #[must_use]
    pub fn back_rejected_share(&self) -> f64 {
        ratio(self.back_rejected, self.back)
    }

    /// Misses of what is drawn per face of the mesh.
    #[must_use]
    pub fn misses_per_face(&self) -> f64 {
        ratio(self.misses, self.faces)
    }
}

fn ratio(part: u64, of: u64) -> f64 {
    part as f64 / of.max(1) as f64
}

/// What is drawn at each distance, in radii of the ball around the mesh; infinity is an orthographic view.
///
/// # Complexity
/// Time O(distances × eyes × faces); space O(vertices + faces) a thread.
pub(super) fn look_at(
    mesh: &Mesh,
    table: &CullingTable,
    distances: &[f64],
    eyes: usize,
) -> Vec<ViewSums> {
    let Some(ball) = Ball::around(mesh.corner_positions()) else {
        return vec![ViewSums::default(); distances.len()];
    };
    let directions = directions(eyes);
    let views = distances
        .iter()
        .flat_map(|&distance| directions.iter().map(move |&way| (distance, way)));
    let seen = parallel::map(views.collect(), |(distance, way)| {
        let eye = match distance.is_finite() {
            true => {
                let at = add(ball.center, scaled(way, distance * ball.radius));
                Eye::at(at.map(narrowed))
            }
            false => Eye::towards(way.map(narrowed)),
        };
        view(mesh, table, eye)
    });
    let sums = seen.chunks(eyes.max(1)).map(|views| {
        let mut sums = ViewSums::default();
        views.iter().for_each(|view| sums.add(view));
        sums
    });
    let mut sums: Vec<ViewSums> = sums.collect();
    sums.resize(distances.len(), ViewSums::default());
    sums
}

/// One view.
fn view(mesh: &Mesh, table: &CullingTable, eye: Eye) -> ViewSums {
    let mut ranges = Ranges::with_capacity(table.cluster_count());
    let drawn = table.visible_ranges(eye, &mut ranges).as_slice();
    let faces = mesh.faces();
    let list = drawn
        .iter()
        .flat_map(|range| &faces[range.start as usize..range.end as usize]);
    let list: Vec<[u32; 3]> = list.copied().collect();
    let mut sums = ViewSums {
        views: 1,
        faces: faces.len() as u64,
        drawn: list.len() as u64,
        draws: drawn.len() as u64,
        misses: cache::misses(Faces::of_checked(&list, mesh.vertex_count()), CACHE),
        ..ViewSums::default()
    };

    // The faces, those between the ranges too.
    let mut next = drawn.iter().peekable();
    for (number, face) in (0_u32..).zip(faces) {
        while next.next_if(|range| range.end <= number).is_some() {}
        let is_drawn = next.peek().is_some_and(|range| range.start <= number);
        let corners = face.map(|vertex| widened(mesh.positions()[vertex as usize]));
        let sine = sine_above(corners, eye);
        sums.back += u64::from(sine <= 0.0);
        sums.back_rejected += u64::from(sine <= 0.0 && !is_drawn);
        sums.wrongly_rejected += u64::from(sine > SURELY && !is_drawn);
    }
    sums
}

/// How far an eye is above the plane of a face, as the sine of the angle that it is seen under; 0 if that says nothing.
fn sine_above([a, b, c]: [[f64; 3]; 3], eye: Eye) -> f64 {
    let [x, y, z, w] = eye.point.map(f64::from);
    let normal = cross(sub(b, a), sub(c, a));
    let to_eye = sub([x, y, z], scaled(a, w));
    let size = (dot(normal, normal) * dot(to_eye, to_eye)).sqrt();
    let sine = dot(normal, to_eye) / size;
    if sine.is_finite() { sine } else { 0.0 }
}

/// Directions spread at random over the sphere, the same everywhere.
fn directions(count: usize) -> Vec<[f64; 3]> {
    let mut random = SplitMix64(0x5eed);
    let mut directions = Vec::with_capacity(count);
    while directions.len() < count {
        let way = [(); 3].map(|()| random.below(1 << 24) as f64 / f64::from(1 << 23) - 1.0);
        let length = dot(way, way).sqrt();
        if (0.1..1.0).contains(&length) {
            directions.push(scaled(way, 1.0 / length));
        }
    }
    directions
}

#[expect(clippy::cast_possible_truncation, reason = "any eye near it will do")]
fn narrowed(x: f64) -> f32 {
    x as f32
}
