//! With which vertex the traversal begins.

use super::fans::FanCode;
use super::minimum_time::MinimumTimeRendering;
use super::sweep::Sweep;
use super::trimmed_lists::TrimmedLists;
use crate::error::MeshError;
use crate::faces::Faces;
use crate::geometry::dot;
use crate::mesh::Mesh;
use crate::random::SplitMix64;

/// Meshes with fewer vertices have random candidates too.
const SMALL: usize = 10_000;
/// How many.
const RANDOM: usize = 48;

/// How the first vertex is chosen: it makes a factor of two in the buffer size, and a few percent of the bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum FirstVertex {
    /// The one that needs the smallest buffer, of [`candidates`](Self::candidates).
    #[default]
    MinBuffer,
    /// The one with the fewest bytes by [`FanCode`], of the same.
    MinBits,
    /// This one.
    Given(u32),
}

impl FirstVertex {
    /// The vertex. Without faces it is 0.
    ///
    /// # Errors
    /// [`MeshError::LengthMismatch`] if a given vertex is not there.
    ///
    /// # Complexity
    /// Up to 27 traversals, 75 below 10,000 vertices; with [`MinBits`](Self::MinBits) each of them is coded,
    /// which takes several times as long.
    pub fn choose(self, mesh: &Mesh) -> Result<u32, MeshError> {
        let faces = Faces::from(mesh);
        let buffer = |&vertex: &u32| (buffer_size(faces, vertex), vertex);
        let bytes = |&vertex: &u32| (FanCode::new(faces, vertex).bytes().len(), vertex);
        let candidates = Self::candidates(mesh);
        match self {
            Self::MinBuffer => Ok(candidates.into_iter().min_by_key(buffer).unwrap_or(0)),
            Self::MinBits => Ok(candidates.into_iter().min_by_key(bytes).unwrap_or(0)),
            Self::Given(vertex) if (vertex as usize) < mesh.vertex_count() => Ok(vertex),
            Self::Given(vertex) => Err(MeshError::LengthMismatch {
                what: "vertices, to begin with the one that is given",
                expected: vertex as usize + 1,
                found: mesh.vertex_count(),
            }),
        }
    }

    /// Vertices with faces that are likely to need a small buffer: the farthest in each of 26 directions
    /// (along axes, edges and diagonals of a cube), and one at an end of the graph. Below 10,000 vertices also
    /// 48 random ones, the same on every platform.
    ///
    /// # Complexity
    /// Time O(vertices + faces).
    #[must_use]
    pub fn candidates(mesh: &Mesh) -> Vec<u32> {
        let Some(first) = mesh.faces().first() else {
            return Vec::new();
        };
        let mut found = Vec::new();

        // Extremes of the shape.
        if mesh.positions().len() == mesh.vertex_count() {
            let mut is_used = vec![false; mesh.vertex_count()];
            for &vertex in mesh.faces().as_flattened() {
                is_used[vertex as usize] = true;
            }
            found.extend(directions().filter_map(|direction| farthest(mesh, &is_used, direction)));
        }

        // An end of the graph.
        found.push(Sweep::new(mesh.into()).end(first[0]));

        // Random ones.
        if mesh.vertex_count() < SMALL {
            let mut random = SplitMix64(1);
            let corners = mesh.faces().as_flattened();
            found.extend((0..RANDOM).map(|_| corners[random.below(corners.len())]));
        }

        found.sort_unstable();
        found.dedup();
        found
    }
}

/// To the middles of the faces, edges and corners of a cube.
fn directions() -> impl Iterator<Item = [f32; 3]> {
    let signs = [-1.0, 0.0, 1.0];
    let all = signs.into_iter().flat_map(move |x| {
        let pairs = signs
            .into_iter()
            .flat_map(move |y| signs.into_iter().map(move |z| (y, z)));
        pairs.map(move |(y, z)| [x, y, z])
    });
    all.filter(|direction| *direction != [0.0; 3])
}

/// The vertex with faces that is farthest in a direction; the first of several.
fn farthest(mesh: &Mesh, is_used: &[bool], direction: [f32; 3]) -> Option<u32> {
    let along = |p: &[f32; 3]| dot(*p, direction);
    let places = (0..).zip(mesh.positions()).zip(is_used);
    let places = places.filter(|&(_, &is_used)| is_used);
    let places = places.map(|((vertex, position), _)| (along(position), vertex));
    let better = |a: (f32, u32), b: (f32, u32)| if b.0 > a.0 { b } else { a };
    places.reduce(better).map(|(_, vertex)| vertex)
}

/// The required buffer size of the traversal from a vertex.
fn buffer_size(faces: Faces<'_>, first_vertex: u32) -> usize {
    let lists = TrimmedLists::new(faces, first_vertex);
    let renumbered = lists.vertices().renumber(faces.as_slice());
    MinimumTimeRendering::new(Faces::of_checked(&renumbered, faces.vertex_count())).buffer_size()
}
