//! A history made record by record, each checked against those before it.

use super::error::{HistoryError, HistoryErrorKind};
use super::record::NewRecord;
use super::{History, UNKNOWN};
use crate::faces::Faces;
use crate::index::{MAX_VERTICES, index32};
use crate::topology::distinct;
use crate::topology::rows::Rows;

/// The record that a face or vertex left with: it has not.
const PRESENT: u32 = u32::MAX;

const REMOVED: &str = "removed vertex";
const CORNER: &str = "an inserted face: vertex";
const MERGED: &str = "a removed vertex is merged into vertex";

/// Makes a [`History`], record by record.
///
/// Takes 4 bytes a face number and 8 a vertex beside the history.
#[derive(Debug, Clone)]
pub struct HistoryBuilder {
    history: History,
    /// The record that each face left with.
    face_left: Vec<u32>,
    /// The record that each vertex left with.
    vertex_left: Vec<u32>,
    /// How many present faces use each vertex.
    uses: Vec<u32>,
}

/// How much of a record was done before a check failed.
#[derive(Debug, Default)]
struct Done {
    removed_faces: usize,
    removed_vertices: usize,
    inserted_faces: usize,
}

impl HistoryBuilder {
    /// The history of these faces without any record.
    ///
    /// # Complexity
    /// Time and space O(vertices + faces).
    #[must_use]
    pub fn new<'a>(faces: impl Into<Faces<'a>>) -> Self {
        let faces = faces.into();
        let mut builder = Self {
            history: History {
                vertex_count: faces.vertex_count(),
                full_face_count: faces.len(),
                faces: faces.as_slice().to_vec(),
                removed_vertices: Rows::with_capacity(0, 0),
                merges_into: Vec::new(),
                removed_faces: Rows::with_capacity(0, 0),
                inserted_starts: vec![index32(faces.len())],
                errors: Vec::new(),
            },
            face_left: vec![PRESENT; faces.len()],
            vertex_left: vec![PRESENT; faces.vertex_count()],
            uses: vec![0; faces.vertex_count()],
        };
        for &face in faces.as_slice() {
            builder.count(face);
        }
        builder
    }

    /// Adds the record that leads to the next coarser level.
    ///
    /// # Errors
    /// A [`HistoryError`] for the first thing in it that cannot be; nothing is added then.
    ///
    /// # Complexity
    /// Time O(vertices and faces of the record), amortised.
    pub fn push(&mut self, record: &NewRecord<'_>) -> Result<(), HistoryError> {
        let mut done = Done::default();
        match self.play(record, &mut done) {
            Ok(()) => {
                self.keep(record);
                Ok(())
            }
            Err(kind) => {
                self.take_back(record, &done);
                let record = self.history.len();
                Err(HistoryError { record, kind })
            }
        }
    }

    /// The history of all records that were added.
    #[must_use]
    pub fn finish(self) -> History {
        self.history
    }

    /// The history so far.
    #[must_use]
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Whether the face with this number has not left; also of numbers that there are not.
    #[must_use]
    pub fn has_face(&self, number: u32) -> bool {
        self.face_left.get(number as usize) == Some(&PRESENT)
    }

    /// Takes the record's faces and vertices out and counts its new faces in, checking each.
    fn play(&mut self, record: &NewRecord<'_>, done: &mut Done) -> Result<(), HistoryErrorKind> {
        self.check_counts(record)?;
        let number = index32(self.history.len());

        // Faces that leave.
        for &face in record.removed_faces {
            let count = self.face_left.len();
            let left = self.face_left.get_mut(face as usize);
            let left = left.ok_or(HistoryErrorKind::NoSuchFace { face, count })?;
            if *left != PRESENT {
                let left_with = *left;
                return Err(HistoryErrorKind::FaceIsGone { face, left_with });
            }
            *left = number;
            self.discount(self.history.face(face));
            done.removed_faces += 1;
        }

        // Vertices that leave.
        for &vertex in record.removed_vertices {
            self.check_vertex(REMOVED, vertex)?;
            self.vertex_left[vertex as usize] = number;
            done.removed_vertices += 1;
        }

        // Faces that come, and what they leave unused.
        for &face in record.inserted_faces {
            face.iter()
                .try_for_each(|&v| self.check_vertex(CORNER, v))?;
            self.count(face);
            done.inserted_faces += 1;
        }
        for &vertex in record.removed_vertices {
            if self.uses[vertex as usize] > 0 {
                let face = self.user_of(vertex);
                return Err(HistoryErrorKind::VertexInUse { vertex, face });
            }
        }

        // What the vertices are merged into.
        let (vertices, merged) = (record.removed_vertices.len(), record.merges_into.len());
        if merged > 0 && merged != vertices {
            return Err(HistoryErrorKind::PartialMerge { vertices, merged });
        }
        let mut into = record.merges_into.iter();
        into.try_for_each(|&vertex| self.check_vertex(MERGED, vertex))
    }

    fn check_counts(&self, record: &NewRecord<'_>) -> Result<(), HistoryErrorKind> {
        let error = record.error;
        if !(error >= 0.0 && error.is_finite()) {
            return Err(HistoryErrorKind::InvalidError { error });
        }
        let counts = [
            ("records", self.history.len(), 1),
            (
                "face numbers",
                self.history.faces.len(),
                record.inserted_faces.len(),
            ),
        ];
        for (what, before, more) in counts {
            let (count, limit) = (before + more, MAX_VERTICES);
            if count > limit {
                return Err(HistoryErrorKind::TooLarge { what, count, limit });
            }
        }
        Ok(())
    }

    fn check_vertex(&self, what: &'static str, vertex: u32) -> Result<(), HistoryErrorKind> {
        match self.vertex_left.get(vertex as usize) {
            Some(&PRESENT) => Ok(()),
            Some(&left_with) => Err(HistoryErrorKind::VertexIsGone {
                what,
                vertex,
                left_with,
            }),
            None => Err(HistoryErrorKind::NoSuchVertex {
                what,
                vertex,
                vertex_count: self.vertex_left.len(),
            }),
        }
    }

    /// The first face that uses a vertex. Inserted faces cannot use one that leaves.
    fn user_of(&self, vertex: u32) -> u32 {
        let present = |&face: &u32| self.face_left[face as usize] == PRESENT;
        let mut faces = (0..index32(self.face_left.len())).filter(present);
        let user = faces.find(|&face| self.history.face(face).contains(&vertex));
        user.expect("a face was counted at the vertex")
    }

    /// Stores a record that was played.
    fn keep(&mut self, record: &NewRecord<'_>) {
        let history = &mut self.history;

        // Histories that never say what a vertex is merged into store nothing for it.
        let entries = history.removed_vertices.entries().len();
        if !record.merges_into.is_empty() {
            history.merges_into.resize(entries, UNKNOWN);
            history.merges_into.extend(record.merges_into);
        } else if !history.merges_into.is_empty() {
            let entries = entries + record.removed_vertices.len();
            history.merges_into.resize(entries, UNKNOWN);
        }

        let removed_vertices = record.removed_vertices.iter().copied();
        history.removed_vertices.extend(removed_vertices);
        history.removed_vertices.end_row();
        let removed_faces = record.removed_faces.iter().copied();
        history.removed_faces.extend(removed_faces);
        history.removed_faces.end_row();
        history.faces.extend(record.inserted_faces);
        history.inserted_starts.push(index32(history.faces.len()));
        history.errors.push(record.error);
        self.face_left.resize(history.faces.len(), PRESENT);
    }

    /// Undoes what was done of a record.
    fn take_back(&mut self, record: &NewRecord<'_>, done: &Done) {
        for &face in &record.inserted_faces[..done.inserted_faces] {
            self.discount(face);
        }
        for &vertex in &record.removed_vertices[..done.removed_vertices] {
            self.vertex_left[vertex as usize] = PRESENT;
        }
        for &face in &record.removed_faces[..done.removed_faces] {
            self.face_left[face as usize] = PRESENT;
            self.count(self.history.face(face));
        }
    }

    fn count(&mut self, face: [u32; 3]) {
        for vertex in distinct(face) {
            self.uses[vertex as usize] += 1;
        }
    }

    fn discount(&mut self, face: [u32; 3]) {
        for vertex in distinct(face) {
            self.uses[vertex as usize] -= 1;
        }
    }
}
