//! Draws as a program issues them, and what the card counts for them.

use super::batcher::{Batcher, Totals};
use crate::cache::metrics::ratio;
use crate::faces::Faces;

/// How a draw makes primitives of its indices, named as in Vulkan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum PrimitiveTopology {
    /// Three indices a triangle.
    #[default]
    TriangleList,
    /// A triangle for each index after the second; every other one turned round.
    TriangleStrip,
    /// A triangle for each index after the second, all with the first one.
    TriangleFan,
    /// Two indices a line.
    LineList,
    /// A line for each index after the first.
    LineStrip,
}

/// One indexed draw.
///
/// ```
/// use meshweft::cache::nvidia::{Draw, PrimitiveTopology};
/// let list = Draw::new(&[0, 1, 2, 2, 1, 3]);
/// let strip = Draw { topology: PrimitiveTopology::TriangleStrip, ..Draw::new(&[0, 1, 2, 3]) };
/// assert_eq!((list.counts().invocations, strip.counts().invocations), (4, 4));
/// // Where consecutive vertices stand in two blocks of 65,536, the card forgets what it had.
/// let across = Draw { vertex_offset: 65_534, ..list };
/// assert_eq!(across.counts().invocations, 5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Draw<'a> {
    /// How primitives are made of the indices.
    pub topology: PrimitiveTopology,
    /// The indices.
    pub indices: &'a [u32],
    /// The index that ends a strip or a fan, where primitive restart is on; in a list the rest of a
    /// primitive before it is dropped.
    pub restart: Option<u32>,
    /// Added to each index.
    pub vertex_offset: i32,
    /// How often all of it is drawn.
    pub instances: u32,
    /// Whether the vertex shader reads the number of the instance. Where it does not, a vertex of the
    /// instance before is found like any other.
    pub reads_instance: bool,
}

impl<'a> Draw<'a> {
    /// A triangle list, drawn once.
    #[must_use]
    pub fn new(indices: &'a [u32]) -> Self {
        Self {
            topology: PrimitiveTopology::TriangleList,
            indices,
            restart: None,
            vertex_offset: 0,
            instances: 1,
            reads_instance: true,
        }
    }

    /// What the card counts. The draw starts with an empty batch, as any usual change of state
    /// between two draws makes it do; its instances run on from each other.
    ///
    /// # Complexity
    /// Time O(indices · instances); constant space.
    #[must_use]
    pub fn counts(&self) -> DrawCounts {
        let mut batcher = Batcher::new();
        for instance in 0..self.instances {
            let instance = if self.reads_instance { instance } else { 0 };
            for part in self.indices.split(|&index| Some(index) == self.restart) {
                self.draw_part(part, instance, &mut batcher);
            }
        }
        DrawCounts::of(batcher)
    }

    /// Draws indices without a restart among them.
    fn draw_part(&self, part: &[u32], instance: u32, batcher: &mut Batcher) {
        let vertex = |index: u32| index.wrapping_add_signed(self.vertex_offset);
        let mut triangle = |corners: [u32; 3]| {
            batcher.draw(&corners.map(vertex), instance);
        };
        match self.topology {
            PrimitiveTopology::TriangleList => {
                let triangles = part.chunks_exact(3);
                triangles.for_each(|corners| triangle([corners[0], corners[1], corners[2]]));
            }
            PrimitiveTopology::TriangleStrip => {
                for (number, corners) in part.windows(3).enumerate() {
                    match number % 2 {
                        0 => triangle([corners[0], corners[1], corners[2]]),
                        _ => triangle([corners[0], corners[2], corners[1]]),
                    }
                }
            }
            PrimitiveTopology::TriangleFan => {
                for pair in part.get(1..).unwrap_or_default().windows(2) {
                    triangle([pair[0], pair[1], part[0]]);
                }
            }
            PrimitiveTopology::LineList => {
                for line in part.chunks_exact(2) {
                    batcher.draw(&[vertex(line[1]), vertex(line[0])], instance);
                }
            }
            PrimitiveTopology::LineStrip => {
                for line in part.windows(2) {
                    batcher.draw(&[vertex(line[1]), vertex(line[0])], instance);
                }
            }
        }
    }
}

/// What the card counts for a draw of these faces.
///
/// # Complexity
/// Time O(faces); constant space.
#[must_use]
pub fn counts<'a>(faces: impl Into<Faces<'a>>) -> DrawCounts {
    let mut batcher = Batcher::new();
    for face in faces.into().as_slice() {
        batcher.draw(face, 0);
    }
    DrawCounts::of(batcher)
}

/// What a card counts for a draw, or for several added up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct DrawCounts {
    /// Primitives drawn.
    pub primitives: u64,
    /// Invocations of the vertex shader.
    pub invocations: u64,
    /// Batches, which run as a warp each. Time of shaders that compute much goes with them.
    pub warps: u64,
    /// Vertices that each batch uses, added up over the batches: what is loaded from memory.
    pub distinct_vertices: u64,
    /// Cycles of primitive setup; of triangles only, 1 a batch for lines.
    pub setup_cycles: u64,
    /// Batches of 29 to 32 vertices. Each takes 38.24 cycles on the vertex side, however cheap the
    /// shader, where no smaller batches among them hide it.
    pub wide_batches: u64,
}

/// Cycles of a full batch of triangles at best: 3 for the first one, 1 for each other, 1 for the batch.
const LEAST_CYCLES: u64 = 35;

impl DrawCounts {
    fn of(mut batcher: Batcher) -> Self {
        batcher.close();
        let Totals {
            primitives,
            invocations,
            batches,
            distinct_vertices,
            setup_cycles,
            wide_batches,
        } = batcher.totals;
        Self {
            primitives,
            invocations,
            warps: batches,
            distinct_vertices,
            setup_cycles,
            wide_batches,
        }
    }

    /// The fewest warps that so many primitives can take.
    #[must_use]
    pub fn least_warps(&self) -> u64 {
        self.primitives.div_ceil(32)
    }

    /// Warps over the fewest; 0 without primitives.
    #[must_use]
    pub fn warps_over_floor(&self) -> f64 {
        over(self.warps, self.least_warps())
    }

    /// The fewest setup cycles that so many triangles can take: 35 a batch of 32, and 3 more than the
    /// triangles in a last one.
    #[must_use]
    pub fn least_setup_cycles(&self) -> u64 {
        let (full, rest) = (self.primitives / 32, self.primitives % 32);
        full * LEAST_CYCLES + if rest == 0 { 0 } else { rest + 3 }
    }

    /// Setup cycles over the fewest; 0 without primitives.
    #[must_use]
    pub fn setup_cycles_over_floor(&self) -> f64 {
        over(self.setup_cycles, self.least_setup_cycles())
    }

    /// Invocations, warps and setup cycles in one figure: a warp counts as 16 invocations, a cycle as
    /// 16/35. On a closed mesh, which has half as many vertices as triangles, each is as much as the
    /// others where it is least.
    #[must_use]
    pub fn cost(&self) -> u64 {
        self.invocations + 16 * self.warps + self.setup_cycles * 16 / LEAST_CYCLES
    }

    /// Adds the counts of another draw.
    pub fn add(&mut self, other: &Self) {
        self.primitives += other.primitives;
        self.invocations += other.invocations;
        self.warps += other.warps;
        self.distinct_vertices += other.distinct_vertices;
        self.setup_cycles += other.setup_cycles;
        self.wide_batches += other.wide_batches;
    }
}

fn over(count: u64, floor: u64) -> f64 {
    ratio(count, usize::try_from(floor).unwrap_or(usize::MAX))
}
