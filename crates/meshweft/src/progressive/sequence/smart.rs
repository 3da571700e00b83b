//! The smart update: a new face takes the place of a removed one that it shares vertices with.

use super::places::{FreePlaces, NONE, PlacedFaces, Rule};
use super::simple::FromTheFront;
use super::updated::{Updated, update_methods};
use crate::error::MeshError;
use crate::index::index32;
use crate::permutation::FaceOrder;
use crate::progressive::history::History;
use crate::topology::distinct;

/// Records of more pairs of a removed and an inserted face are updated as [`SimpleUpdate`] does.
///
/// [`SimpleUpdate`]: super::SimpleUpdate
pub const LONGEST: usize = 1 << 22;

/// A rendering sequence kept up by the smart update (Bogomjakov & Gotsman 2002, Fig. 5): a new face
/// takes the place of a removed face that it has two vertices in common with, else one, else any.
///
/// ```
/// use meshweft::FaceOrder;
/// use meshweft::progressive::{HistoryBuilder, NewRecord, SmartUpdate};
/// let faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 3, 5]];
/// let mut builder = HistoryBuilder::new(&faces);
/// builder.push(&NewRecord {
///     removed_vertices: &[4],
///     removed_faces: &[0, 1, 2, 3],
///     inserted_faces: &[[0, 2, 3], [0, 1, 2]],
///     ..NewRecord::default()
/// })?;
/// let history = builder.finish();
/// let mut sequence = SmartUpdate::new(&history, &FaceOrder::identity(5))?;
/// let mut numbers = Vec::new();
/// sequence.coarsen();
/// sequence.emit(&mut numbers);
/// // Face 6 where face 0 was, which has its edge from 0 to 1; face 5 where face 2 was.
/// assert_eq!(numbers, [6, 5, 4]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Complexity
/// A record of n removed and m inserted faces takes O(n · m) the first time, then O(n + m); giving
/// out the sequence takes O(faces of the full mesh). Space 4 bytes a face number and 4 a face of the
/// full mesh.
#[derive(Debug, Clone)]
pub struct SmartUpdate<'a> {
    updated: Updated<'a, PlacedFaces<BySharedVertices>>,
}

impl<'a> SmartUpdate<'a> {
    /// The sequence at full resolution: the faces in this order.
    ///
    /// # Errors
    /// [`MeshError::LengthMismatch`] if the order is not as long as the full mesh has faces.
    pub fn new(history: &'a History, order: &FaceOrder) -> Result<Self, MeshError> {
        let start = || {
            Ok(PlacedFaces::new(
                history,
                order,
                BySharedVertices::default(),
            ))
        };
        let updated = Updated::new(history, order, start)?;
        Ok(Self { updated })
    }
}

update_methods!(SmartUpdate);

/// Fig. 5, with `t` for removed and `T` for inserted faces.
#[derive(Debug, Clone, Default)]
struct BySharedVertices {
    /// Whether the place of each `t` is free.
    is_free: Vec<bool>,
    /// The length of each list `L(T)`: how many free `t` share a vertex with `T`. The lists
    /// themselves are not stored: `t` is in `L(T)` if it is free and shares a vertex.
    lengths: Vec<usize>,
}

impl Rule for BySharedVertices {
    fn give(&mut self, history: &History, free: &FreePlaces, first: u32, given: &mut [u32]) {
        let FreePlaces { faces, places } = free;
        if faces.len().saturating_mul(given.len()) > LONGEST {
            return FromTheFront.give(history, free, first, given);
        }
        let shared = |new: usize, old: usize| {
            let new = history.face(first + index32(new));
            shared_vertices(new, history.face(faces[old]))
        };
        self.is_free.clear();
        self.is_free.resize(faces.len(), true);

        // Assignment due to two common vertices.
        for (new, given) in given.iter_mut().enumerate() {
            let fits = |&old: &usize| self.is_free[old] && shared(new, old) == 2;
            if let Some(old) = (0..faces.len()).find(fits) {
                *given = places[old];
                self.is_free[old] = false;
            }
        }

        // Initialization of adjacency lists.
        self.lengths.clear();
        for (new, given) in given.iter().enumerate() {
            let is_in_list = |&old: &usize| self.is_free[old] && shared(new, old) > 0;
            let length = match *given {
                NONE => (0..faces.len()).filter(is_in_list).count(),
                _ => 0,
            };
            self.lengths.push(length);
        }

        // Assignment due to one common vertex.
        while let Some(new) = shortest(&self.lengths) {
            let is_in_list = |&old: &usize| self.is_free[old] && shared(new, old) > 0;
            let head = (0..faces.len()).find(is_in_list);
            let head = head.expect("the list is not empty");
            given[new] = places[head];
            self.is_free[head] = false;
            self.lengths[new] = 0;
            for (other, length) in self.lengths.iter_mut().enumerate() {
                if *length > 0 && shared(other, head) > 0 {
                    *length -= 1;
                }
            }
        }

        // The remaining faces to whatever places are left.
        let mut left = (0..faces.len()).filter(|&old| self.is_free[old]);
        for given in given.iter_mut().filter(|given| **given == NONE) {
            match left.next() {
                Some(old) => *given = places[old],
                None => break,
            }
        }
    }
}

/// The first of the shortest lists that are not empty.
fn shortest(lengths: &[usize]) -> Option<usize> {
    let lists = lengths
        .iter()
        .enumerate()
        .filter(|(_, length)| **length > 0);
    lists.min_by_key(|(_, length)| **length).map(|(new, _)| new)
}

/// How many distinct vertices two faces have in common.
fn shared_vertices(a: [u32; 3], b: [u32; 3]) -> usize {
    distinct(a).filter(|vertex| b.contains(vertex)).count()
}
