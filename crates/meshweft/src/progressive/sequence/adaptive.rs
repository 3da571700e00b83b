//! The adaptive update: a new face is drawn where the first of its vertices turned black.

use super::updated::{Sequence, Updated, update_methods};
use crate::error::MeshError;
use crate::index::{MAX_VERTICES, index32};
use crate::permutation::FaceOrder;
use crate::progressive::history::History;
use crate::topology::distinct;

/// A vertex that no face of the full mesh uses turns black nowhere.
const NEVER: u32 = u32::MAX;

/// A rendering sequence kept up by the adaptive update (Lin & Yu 2006): a new face is drawn where the
/// first of its vertices turned black in the full sequence, behind the last of that vertex's faces.
///
/// ```
/// use meshweft::FaceOrder;
/// use meshweft::progressive::{AdaptiveUpdate, HistoryBuilder, NewRecord};
/// let faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 3, 5]];
/// let mut builder = HistoryBuilder::new(&faces);
/// builder.push(&NewRecord {
///     removed_vertices: &[4],
///     removed_faces: &[0, 1, 2, 3],
///     inserted_faces: &[[0, 2, 3], [0, 1, 2]],
///     ..NewRecord::default()
/// })?;
/// let history = builder.finish();
/// let mut sequence = AdaptiveUpdate::new(&history, &FaceOrder::identity(5))?;
/// let mut numbers = Vec::new();
/// sequence.coarsen();
/// sequence.emit(&mut numbers);
/// // Vertex 1 turns black with face 1, vertex 2 with face 2, vertices 0 and 3 with face 4.
/// assert_eq!(numbers, [6, 5, 4]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Complexity
/// O(removed vertices, removed faces and inserted faces) a record, both ways; giving out the sequence
/// takes O(vertices and faces of the level). Space 8 bytes a face number and 12 a vertex.
#[derive(Debug, Clone)]
pub struct AdaptiveUpdate<'a> {
    updated: Updated<'a, LinkedFaces>,
}

impl<'a> AdaptiveUpdate<'a> {
    /// The sequence at full resolution: the faces in this order.
    ///
    /// # Errors
    /// [`MeshError::LengthMismatch`] if the order is not as long as the full mesh has faces,
    /// [`MeshError::TooLarge`] if there are more face numbers and vertices than 32 bits count.
    pub fn new(history: &'a History, order: &FaceOrder) -> Result<Self, MeshError> {
        let updated = Updated::new(history, order, || LinkedFaces::new(history, order))?;
        Ok(Self { updated })
    }
}

update_methods!(AdaptiveUpdate);

/// The sequence as a ring of nodes: the faces that are drawn, behind the last face of each vertex in
/// the full sequence a mark for the vertex, and the end.
///
/// A node that leaves keeps its links. As records are undone in reverse, its neighbours are then
/// those that it had, and it links itself in again.
#[derive(Debug, Clone)]
struct LinkedFaces {
    /// By node: face numbers, then vertices, then the end.
    next: Vec<u32>,
    previous: Vec<u32>,
    /// When each vertex turns black, in the order of the marks, or [`NEVER`].
    black: Vec<u32>,
}

impl LinkedFaces {
    fn new(history: &History, order: &FaceOrder) -> Result<Self, MeshError> {
        let (numbers, vertices) = (history.number_count(), history.vertex_count());
        let (count, limit) = (numbers.saturating_add(vertices), MAX_VERTICES - 1);
        if count > limit {
            let what = "faces of all levels and vertices";
            return Err(MeshError::TooLarge { what, count, limit });
        }
        let mut linked = Self {
            next: vec![0; count + 1],
            previous: vec![0; count + 1],
            black: vec![NEVER; vertices],
        };
        let end = linked.end();
        linked.next[end as usize] = end;
        linked.previous[end as usize] = end;

        // How many faces of each vertex are still to come; at none, it turns black.
        let faces = history.full_faces().as_slice();
        let mut rest = vec![0_u32; vertices];
        for vertex in faces.iter().flat_map(|&face| distinct(face)) {
            rest[vertex as usize] += 1;
        }
        let mut marks = 0..;
        for &number in order.new_to_old() {
            linked.link_before(end, number);
            for vertex in distinct(faces[number as usize]) {
                rest[vertex as usize] -= 1;
                if rest[vertex as usize] == 0 {
                    linked.black[vertex as usize] = marks.next().expect("marks are counted");
                    linked.link_before(end, linked.mark(vertex));
                }
            }
        }
        Ok(linked)
    }

    /// The node behind the last.
    fn end(&self) -> u32 {
        index32(self.next.len() - 1)
    }

    /// The node of a vertex.
    fn mark(&self, vertex: u32) -> u32 {
        self.end() - index32(self.black.len()) + vertex
    }

    /// The node that a new face goes before.
    fn node_after(&self, face: [u32; 3]) -> u32 {
        let first = face.into_iter().min_by_key(|&v| self.black[v as usize]);
        let first = first.expect("a face has three corners");
        match self.black[first as usize] {
            NEVER => self.end(),
            _ => self.mark(first),
        }
    }

    /// The node of a vertex that has one.
    fn mark_of(&self, vertex: u32) -> Option<u32> {
        (self.black[vertex as usize] != NEVER).then(|| self.mark(vertex))
    }

    fn link_before(&mut self, after: u32, node: u32) {
        let before = self.previous[after as usize];
        self.previous[node as usize] = before;
        self.next[node as usize] = after;
        self.relink(node);
    }

    fn unlink(&mut self, node: u32) {
        let (before, after) = self.neighbours(node);
        self.next[before as usize] = after;
        self.previous[after as usize] = before;
    }

    /// Links a node in between the neighbours that it had.
    fn relink(&mut self, node: u32) {
        let (before, after) = self.neighbours(node);
        self.next[before as usize] = node;
        self.previous[after as usize] = node;
    }

    fn neighbours(&self, node: u32) -> (u32, u32) {
        (self.previous[node as usize], self.next[node as usize])
    }
}

impl Sequence for LinkedFaces {
    fn play(&mut self, history: &History, record: usize) {
        let update = history.record(record);
        for &face in update.removed_faces {
            self.unlink(face);
        }
        for &vertex in update.removed_vertices {
            if let Some(mark) = self.mark_of(vertex) {
                self.unlink(mark);
            }
        }
        for face in update.inserted_faces {
            let after = self.node_after(history.face(face));
            self.link_before(after, face);
        }
    }

    fn undo(&mut self, history: &History, record: usize) {
        let update = history.record(record);
        for face in update.inserted_faces.rev() {
            self.unlink(face);
        }
        for &vertex in update.removed_vertices.iter().rev() {
            if let Some(mark) = self.mark_of(vertex) {
                self.relink(mark);
            }
        }
        for &face in update.removed_faces.iter().rev() {
            self.relink(face);
        }
    }

    fn visit(&self, mut visit: impl FnMut(u32)) {
        let end = self.end();
        let numbers = end - index32(self.black.len());
        let mut node = self.next[end as usize];
        while node != end {
            if node < numbers {
                visit(node);
            }
            node = self.next[node as usize];
        }
    }
}
