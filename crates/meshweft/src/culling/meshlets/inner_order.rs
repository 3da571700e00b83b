//! The faces of a meshlet in an order that primitive setup likes, then its vertices by first use.

use crate::cache::nvidia::{LaneSet, Setup, meshlet_setup_cycles};
use crate::error::MeshError;
use crate::index::index32;
use crate::permutation::Permutation;

/// How many faces are tried as the first one.
const STARTS: usize = 4;
/// Local numbers of vertices are 8 bits.
const MOST_VERTICES: usize = 256;

/// Puts the faces of anybody's meshlet in an order in which primitive setup takes fewer cycles
/// ([`meshlet_setup_cycles`]), never more, and numbers its vertices by first use; returns the order of the faces. `vertices`
/// are the numbers in the mesh, `faces` name them by their place. Corners are not turned; vertices without a face come last.
///
/// For whoever builds meshlets with another library: the step changes nothing but the order inside each of them.
///
/// ```
/// use meshweft::cache::nvidia::meshlet_setup_cycles;
/// use meshweft::culling::order_meshlet;
/// // Every other face of a strip, then the rest.
/// let strip = |i: u8| [i, i + 1, i + 2];
/// let mut faces: Vec<[u8; 3]> = (0..30).step_by(2).chain((1..30).step_by(2)).map(strip).collect();
/// let mut vertices: Vec<u32> = (100..132).collect();
/// let before = meshlet_setup_cycles(&faces);
/// order_meshlet(&mut vertices, &mut faces)?;
/// assert_eq!((before, meshlet_setup_cycles(&faces)), (63, 33));
/// # Ok::<(), meshweft::MeshError>(())
/// ```
///
/// # Errors
/// [`MeshError::IndexOutOfRange`] if a face names a vertex that there is not; nothing is changed then.
///
/// # Complexity
/// Time O(faces · faces at a vertex) for a connected meshlet, at worst O(faces²).
pub fn order_meshlet(
    vertices: &mut [u32],
    faces: &mut [[u8; 3]],
) -> Result<Permutation, MeshError> {
    for (number, face) in faces.iter().enumerate() {
        for (corner, &vertex) in face.iter().enumerate() {
            if usize::from(vertex) >= vertices.len() {
                return Err(MeshError::IndexOutOfRange {
                    face: number,
                    corner,
                    index: vertex.into(),
                    vertex_count: vertices.len(),
                });
            }
        }
    }
    let mut order = InnerOrder::default();
    order.improve(vertices, faces);
    Ok(Permutation::from_algorithm(order.best))
}

/// Orders meshlets one after the other, in the same memory.
#[derive(Debug, Default)]
pub(super) struct InnerOrder {
    /// The faces at each vertex: where they begin, and all of them.
    starts: Vec<u32>,
    faces_at: Vec<u32>,
    state: DrawState,
    /// The faces in the best order so far.
    best: Vec<u32>,
    firsts: Vec<u32>,
}

/// What drawing a face changes.
#[derive(Debug, Default)]
struct DrawState {
    setup: Setup<[u64; 4]>,
    cycles: u64,
    order: Vec<u32>,
    is_drawn: Vec<bool>,
    vertices: Vec<LocalVertex>,
}

#[derive(Debug, Clone, Copy, Default)]
struct LocalVertex {
    /// How many of its faces are not drawn.
    left: u32,
    /// How many faces were drawn when it was used last; 0 if it never was.
    used: u32,
}

impl InnerOrder {
    /// As [`order_meshlet`], of numbers that are in range; returns the order of the faces.
    pub(super) fn improve(&mut self, vertices: &mut [u32], faces: &mut [[u8; 3]]) -> &[u32] {
        self.order(faces);

        // Faces in their places.
        let before = faces.to_vec();
        for (place, &face) in faces.iter_mut().zip(&self.best) {
            *place = before[face as usize];
        }

        // Vertices by first use, then those that are not used.
        let count = vertices.len().min(MOST_VERTICES);
        let mut numbers = [u16::MAX; MOST_VERTICES];
        let mut next = 0;
        let used = faces
            .as_flattened()
            .iter()
            .map(|&vertex| usize::from(vertex));
        for vertex in used.chain(0..count) {
            if numbers[vertex] == u16::MAX {
                numbers[vertex] = next;
                next += 1;
            }
        }
        let before = vertices[..count].to_vec();
        for (vertex, number) in before.iter().zip(numbers) {
            vertices[usize::from(number)] = *vertex;
        }
        for vertex in faces.as_flattened_mut() {
            #[expect(clippy::cast_possible_truncation, reason = "below 256")]
            {
                *vertex = numbers[usize::from(*vertex)] as u8;
            }
        }
        &self.best
    }

    /// Finds the best order.
    fn order(&mut self, faces: &[[u8; 3]]) {
        self.best.clear();
        self.best.extend(0..index32(faces.len()));
        if faces.len() < 2 {
            return;
        }
        self.find_faces_at(faces);

        // Faces with few neighbours first, grown until nothing better is possible.
        let mut firsts = std::mem::take(&mut self.firsts);
        firsts.clear();
        firsts.extend(0..index32(faces.len()));
        firsts.sort_by_key(|&face| -> u32 {
            let counts = faces[face as usize].map(|vertex| self.count_at(vertex));
            counts.iter().sum()
        });
        let mut least = meshlet_setup_cycles(faces);
        let floor = faces.len() as u64 + 3;
        for &first in firsts.iter().take(STARTS) {
            if least <= floor {
                break;
            }
            if let Some(cycles) = self.grow(faces, first, least) {
                least = cycles;
                std::mem::swap(&mut self.best, &mut self.state.order);
            }
        }
        self.firsts = firsts;
    }

    fn find_faces_at(&mut self, faces: &[[u8; 3]]) {
        self.starts.clear();
        self.starts.resize(MOST_VERTICES + 1, 0);
        let corners = faces.as_flattened();
        for &vertex in corners {
            self.starts[usize::from(vertex)] += 1;
        }
        let mut end = 0;
        for start in &mut self.starts {
            end += *start;
            *start = end;
        }
        self.faces_at.clear();
        self.faces_at.resize(corners.len(), 0);
        for (face, corners) in (0..index32(faces.len())).zip(faces).rev() {
            for &vertex in corners {
                let start = &mut self.starts[usize::from(vertex)];
                *start -= 1;
                self.faces_at[*start as usize] = face;
            }
        }
    }

    /// The faces at a vertex; twice where a face names it twice.
    #[inline]
    fn at(&self, vertex: u8) -> &[u32] {
        let [start, end] = [0, 1].map(|next| self.starts[usize::from(vertex) + next] as usize);
        &self.faces_at[start..end]
    }

    fn count_at(&self, vertex: u8) -> u32 {
        index32(self.at(vertex).len())
    }

    /// An order that starts with a face, in `state.order`, and its cycles; `None` if they are not below `least`.
    fn grow(&mut self, faces: &[[u8; 3]], first: u32, least: u64) -> Option<u64> {
        // Nothing drawn.
        let mut state = std::mem::take(&mut self.state);
        state.setup = Setup::default();
        state.cycles = 1;
        state.order.clear();
        state.is_drawn.clear();
        state.is_drawn.resize(faces.len(), false);
        state.vertices.clear();
        let counts = self.starts.windows(2).map(|pair| pair[1] - pair[0]);
        state
            .vertices
            .extend(counts.map(|left| LocalVertex { left, used: 0 }));

        // Face by face.
        let mut next = Some(first);
        while let Some(face) = next {
            state.draw(face, faces[face as usize]);
            let rest = (faces.len() - state.order.len()) as u64;
            if state.cycles + rest >= least {
                break;
            }
            next = self.next(faces, &state);
        }
        let is_better = state.order.len() == faces.len() && state.cycles < least;
        let cycles = state.cycles;
        self.state = state;
        is_better.then_some(cycles)
    }

    /// The face to draw next: the best at a vertex in a slot, or of all if none is there.
    fn next(&self, faces: &[[u8; 3]], state: &DrawState) -> Option<u32> {
        let better = |best: Option<(i32, u32)>, face: u32| {
            if state.is_drawn[face as usize] {
                return best;
            }
            let value = state.value(faces[face as usize]);
            match best {
                Some((most, _)) if most >= value => best,
                _ => Some((value, face)),
            }
        };
        let mut best = None;
        for lane in state.setup.kept_in_turn() {
            #[expect(clippy::cast_possible_truncation, reason = "below 256")]
            let faces_at = self.at(lane as u8);
            best = faces_at.iter().copied().fold(best, better);
        }
        if best.is_none() {
            best = (0..index32(faces.len())).fold(best, better);
        }
        best.map(|(_, face)| face)
    }
}

impl DrawState {
    fn draw(&mut self, face: u32, corners: [u8; 3]) {
        self.cycles += u64::from(self.setup.add(corners.map(u32::from)));
        self.is_drawn[face as usize] = true;
        self.order.push(face);
        for vertex in corners {
            let vertex = &mut self.vertices[usize::from(vertex)];
            vertex.left -= 1;
            vertex.used = index32(self.order.len());
        }
    }

    /// How good it is to draw a face next: what costs a cycle more comes last; then vertices that are finished, or wait
    /// for long.
    #[inline]
    fn value(&self, corners: [u8; 3]) -> i32 {
        let kept = self.setup.kept();
        let mut value = 0;
        let mut misses = 0;
        for vertex in corners {
            misses += i32::from(!kept.has(vertex.into()));
            let vertex = self.vertices[usize::from(vertex)];
            let age = index32(self.order.len()) - vertex.used;
            value += if vertex.used == 0 {
                -8
            } else {
                age.min(8).cast_signed()
            };
            value += if vertex.left == 1 { 6 } else { 0 };
            value -= vertex.left.min(1000).cast_signed();
        }
        value - 100 * (misses - 1).max(0)
    }
}
