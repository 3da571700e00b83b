//! What a corner that moves to another vertex takes along: which corner of the file has it.
//!
//! A format may store things with the corners of faces, as texture coordinates. What stands at the
//! corners of one vertex differs where a seam passes through it, and a corner that comes to the vertex
//! has to take that of its side. So corners of one vertex with the same things are one *side* of it.

use std::collections::{BTreeSet, HashMap};

use super::entry::MeshEntry;
use super::error::Problem;
use super::select::{PlannedTriangle, RecordCorner, face_problem};
use crate::index::index32;

/// All corners of a file that stores something with them.
pub(super) struct CornerSources {
    /// Where the corners of each record start, and the end of the last.
    starts: Vec<u32>,
    /// The side of each corner.
    sides: Vec<u32>,
    /// The vertex of each side.
    vertices: Vec<u32>,
    /// The first corner of each side.
    firsts: Vec<RecordCorner>,
    /// The connected part of the surface, cut at its seams, that each side is in.
    parts: Vec<u32>,
    /// All sides, those of one vertex together, and where those of each vertex start.
    by_vertex: Vec<u32>,
    vertex_starts: Vec<u32>,
    /// All corners by side, and where those of each side start.
    corners_by_side: Vec<u32>,
    side_starts: Vec<u32>,
    /// The record of each corner.
    record_of: Vec<u32>,
}

impl CornerSources {
    /// `stored` gives what is stored with each corner of a record, as bytes that are the same where the
    /// same is stored.
    ///
    /// # Complexity
    /// Time and space O(corners), plus the bytes of each side.
    pub(super) fn new(entry: &MeshEntry, mut stored: impl FnMut(usize) -> Vec<Vec<u8>>) -> Self {
        let mut all = Self {
            starts: vec![0],
            sides: Vec::new(),
            vertices: Vec::new(),
            firsts: Vec::new(),
            parts: Vec::new(),
            by_vertex: Vec::new(),
            vertex_starts: Vec::new(),
            corners_by_side: Vec::new(),
            side_starts: Vec::new(),
            record_of: Vec::new(),
        };

        // The sides, by what the corners hold. They are numbered as they come.
        let mut numbers: HashMap<(u32, Vec<u8>), u32> = HashMap::new();
        for record in 0..entry.record_count() {
            let vertices = entry.corners_of(record);
            for (place, (vertex, held)) in vertices.zip(stored(record)).enumerate() {
                let next = index32(all.vertices.len());
                let side = *numbers.entry((vertex, held)).or_insert(next);
                if side == next {
                    all.vertices.push(vertex);
                    all.firsts.push(RecordCorner { record, place });
                }
                all.sides.push(side);
                all.record_of.push(index32(record));
            }
            all.starts.push(index32(all.sides.len()));
        }

        all.parts = all.parts();
        let vertex_count = entry.mesh.vertex_count();
        (all.by_vertex, all.vertex_starts) = grouped(&all.vertices, vertex_count);
        (all.corners_by_side, all.side_starts) = grouped(&all.sides, all.vertices.len());
        all
    }

    /// For each side the smallest side that records connect it with.
    fn parts(&self) -> Vec<u32> {
        let mut parents: Vec<u32> = (0..index32(self.vertices.len())).collect();
        for record in 0..self.starts.len() - 1 {
            let sides = self.of_record(record);
            for pair in sides.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|side| root_of(&mut parents, side));
                parents[a.max(b) as usize] = a.min(b);
            }
        }
        (0..index32(parents.len()))
            .map(|side| root_of(&mut parents, side))
            .collect()
    }

    /// The sides of a record's corners.
    fn of_record(&self, record: usize) -> &[u32] {
        let [start, end] = [0, 1].map(|i| self.starts[record + i] as usize);
        &self.sides[start..end]
    }

    /// The sides of a vertex.
    fn of_vertex(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        let [start, end] = [0, 1].map(|i| self.vertex_starts[vertex + i] as usize);
        &self.by_vertex[start..end]
    }

    /// The corner that has what a corner of a triangle is to hold.
    ///
    /// # Errors
    /// The vertex has several sides, and none is surely the one.
    pub(super) fn source(
        &self,
        triangle: &PlannedTriangle,
        corner: usize,
    ) -> Result<RecordCorner, Problem> {
        let vertex = triangle.corners[corner];
        let sides = self.of_vertex(vertex);
        let side = match sides {
            [side] => Some(*side),
            _ => self.side_beside(triangle, sides),
        };
        match side {
            Some(side) => Ok(self.firsts[side as usize]),
            None => Err(face_problem(
                triangle.record,
                &format!(
                    "corner {corner} moves to vertex {vertex}, where corners store {} different things \
                     (texture coordinates, normals), and which of them belongs here cannot be told: leave \
                     out the faces of that vertex, or none",
                    sides.len()
                ),
            )),
        }
    }

    /// The only one of these sides that a record has together with a side of the triangle as it was; else
    /// the only one in the same part of the surface.
    fn side_beside(&self, triangle: &PlannedTriangle, sides: &[u32]) -> Option<u32> {
        let of_record = self.of_record(triangle.record as usize);
        let old = triangle.places().map(|place| of_record[place]);

        let mut beside = BTreeSet::new();
        for side in old {
            let [start, end] = [0, 1].map(|i| self.side_starts[side as usize + i] as usize);
            for &corner in &self.corners_by_side[start..end] {
                let record = self.record_of[corner as usize] as usize;
                let found = self.of_record(record).iter();
                beside.extend(found.filter(|side| sides.contains(side)));
            }
        }
        if let [side] = beside.iter().copied().collect::<Vec<u32>>()[..] {
            return Some(side);
        }

        let part = self.parts[old[0] as usize];
        let mut in_part = sides
            .iter()
            .filter(|&&side| self.parts[side as usize] == part);
        let first = in_part.next()?;
        in_part.next().is_none().then_some(*first)
    }
}

/// The places of `keys` by their key, and where those of each key start, and the end of the last.
fn grouped(keys: &[u32], count: usize) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0; count + 1];
    for &key in keys {
        starts[key as usize + 1] += 1;
    }
    for key in 0..count {
        starts[key + 1] += starts[key];
    }
    let mut next = starts.clone();
    let mut places = vec![0; keys.len()];
    for (place, &key) in (0..).zip(keys) {
        places[next[key as usize] as usize] = place;
        next[key as usize] += 1;
    }
    (places, starts)
}

/// The root of a side's set; paths are halved on the way.
fn root_of(parents: &mut [u32], mut side: u32) -> u32 {
    while parents[side as usize] != side {
        let parent = parents[parents[side as usize] as usize];
        parents[side as usize] = parent;
        side = parent;
    }
    side
}

/// The place among `corners`, the vertices of a record, of what corner `corner` of a triangle of it is to
/// hold: that of the corner itself if its vertex is the same, else one with that vertex.
pub(super) fn place_in_record(
    corners: &[u32],
    triangle: &PlannedTriangle,
    corner: usize,
) -> Option<usize> {
    let vertex = triangle.corners[corner];
    let own = triangle.places()[corner];
    match corners[own] == vertex {
        true => Some(own),
        false => corners.iter().position(|&other| other == vertex),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;

    /// Two strips of quads side by side, 3 by 3 vertices, whose middle column (1, 4, 7) is a seam.
    fn sheets() -> (MeshEntry, CornerSources) {
        let quad = |a: u32| [[a, a + 1, a + 4], [a, a + 4, a + 3]];
        let faces: Vec<[u32; 3]> = [0, 1, 3, 4].into_iter().flat_map(quad).collect();
        let entry = MeshEntry {
            name: "sheets".into(),
            mesh: Mesh::connectivity_only(9, faces).unwrap(),
            polygons: None,
            runs: vec![0],
            vertex_group: 0,
            object: 0,
            has_other_faces: false,
            faces_movable: true,
            vertices_movable: true,
            corners_turnable: true,
            level: None,
        };
        // Left of the seam a corner holds 0, right of it 1.
        let sources = CornerSources::new(&entry, |record| {
            vec![(record / 2 % 2).to_le_bytes().to_vec(); 3]
        });
        (entry, sources)
    }

    #[test]
    fn a_corner_takes_what_its_side_of_the_seam_has() {
        let (entry, sources) = sheets();
        let source = |record: u32, corners: [u32; 3], corner: usize| {
            let triangle = PlannedTriangle {
                record,
                fan: 0,
                corners,
                sources: None,
            };
            sources.source(&triangle, corner).unwrap()
        };
        for record in 0..8 {
            let corners = entry.mesh.faces()[record as usize];
            for corner in 0..3 {
                for seam in [1, 4, 7] {
                    let mut corners = corners;
                    corners[corner] = seam;
                    let found = source(record, corners, corner);
                    assert_eq!(found.record / 2 % 2, record as usize / 2 % 2);
                    let vertices: Vec<u32> = entry.corners_of(found.record).collect();
                    assert_eq!(vertices[found.place], seam);
                }
            }
        }
        // A vertex with one side has no other.
        assert_eq!(source(0, [0, 1, 8], 2).record, 6);
    }

    #[test]
    fn what_cannot_be_told_is_refused() {
        let (entry, _) = sheets();
        let sources = CornerSources::new(&entry, |record| vec![record.to_le_bytes().to_vec(); 3]);
        let triangle = PlannedTriangle {
            record: 0,
            fan: 0,
            corners: [0, 1, 7],
            sources: None,
        };
        let problem = sources.source(&triangle, 2).unwrap_err();
        let text = problem.kind.to_string();
        assert!(
            text.contains("vertex 7, where corners store 3 different"),
            "{text}"
        );
    }
}
