//! Files that are a sequence of records, in text or in bytes: OBJ, OFF, PLY, STL.
//!
//! The source is never changed by orders: they add up, and the output is spliced when it is asked for.
//! What a selection leaves is a new source, which is read again.

use std::path::{Path, PathBuf};
use std::{fmt, io};

use super::bonds::Bonds;
use super::content::{Content, OutputFile, OutputPlace};
use super::definitions::{Filling, Places};
use super::edit::check_order;
use super::entry::MeshEntry;
use super::error::{FileErrorKind, Place, Problem};
use super::format::Format;
use super::note::Note;
use super::options::ReadOptions;
use super::orders::{RecordOrders, record_in};
use super::placing::Placed;
use super::rewrite::{Change, Rewrite, StoredMesh};
use super::select::{PlannedRecord, SelectPlan};
use super::selected::{self, SelectNotation, SelectSource, SelectedFile};
use super::signature;
use super::slots::Spans;
use super::splice::{Layer, splice};
use super::unlisted::Unlisted;
use crate::attribute::{Attribute, AttributeInfo};
use crate::index::index32;
use crate::mesh::Mesh;
use crate::permutation::{FaceOrder, VertexOrder};

/// A file of records, and the orders its records were put in.
pub(super) struct RecordFile<N> {
    pub(super) source: Vec<u8>,
    pub(super) vertices: Spans,
    pub(super) faces: Spans,
    /// Rows that hang on the faces one by one and go where they go.
    pub(super) companions: Vec<Spans>,
    /// Lines that name vertices and stay where they are.
    pub(super) lines: Spans,
    pub(super) notation: N,
    /// One mesh, or none if the file has no faces.
    pub(super) entries: Vec<MeshEntry>,
    pub(super) orders: RecordOrders,
    /// What may be about records that are left out.
    pub(super) bonds: Bonds,
    /// How it was read, and how other bytes in its stead are.
    pub(super) options: ReadOptions,
    pub(super) read_again: ReadAgain<N>,
    pub(super) format: Format,
}

/// Reads other bytes as a file was read.
pub(super) type ReadAgain<N> = fn(&RecordFile<N>, Vec<u8>) -> Result<RecordRead<N>, Problem>;

/// A file that was read, and what there is to say about it.
pub(super) type RecordRead<N> = (RecordFile<N>, Vec<Note>);

impl<N: SelectNotation> RecordFile<N> {
    fn write(&self, sink: &mut dyn io::Write) -> io::Result<()> {
        let RecordOrders {
            records, vertices, ..
        } = &self.orders;
        let source = self.source.as_slice();
        let old_to_new = self.orders.old_to_new();
        let old_to_new = old_to_new.as_slice();
        let places = self.places();
        let mut layers = Vec::new();

        if !records.is_empty() || !vertices.is_empty() {
            layers.push(self.face_layer(places.as_ref(), old_to_new));
            let companions = self.companions.iter();
            layers.extend(companions.map(|spans| Layer::moved(spans, source, records)));
        }

        if !vertices.is_empty() {
            let top = places.as_ref().map(|places| &places.top_vertices);
            let slots = top.unwrap_or(&self.vertices);
            layers.push(Layer::new(slots, move |slots, out| {
                for slot in slots {
                    out.extend_from_slice(&source[self.vertices.span(record_in(vertices, slot))]);
                }
            }));
            let rows = self.notation.vertex_rows();
            layers.extend(rows.map(|rows| Layer::moved(rows, source, vertices)));
            let mut corners = Vec::new();
            layers.push(Layer::new(&self.lines, move |slots, out| {
                for slot in slots {
                    let change = Change {
                        rotation: 0,
                        old_to_new,
                    };
                    let rewrite = Rewrite {
                        change,
                        corners: &mut corners,
                        out,
                    };
                    self.notation
                        .write_line(&source[self.lines.span(slot)], rewrite);
                }
            }));
        }
        splice(source, 0..source.len(), layers, sink)
    }

    /// The faces in their new order, with the definitions that go above them.
    fn face_layer<'a>(
        &'a self,
        places: Option<&'a Places<'_>>,
        old_to_new: &'a [u32],
    ) -> Layer<'a> {
        let source = self.source.as_slice();
        let mut corners = Vec::new();
        let mut write_face = move |slot, record: &[u8], out: &mut Vec<u8>| {
            let change = Change {
                rotation: self.orders.rotation(slot),
                old_to_new,
            };
            if change.is_nothing() {
                out.extend_from_slice(record);
                return;
            }
            let rewrite = Rewrite {
                change,
                corners: &mut corners,
                out,
            };
            self.notation.write_face(record, rewrite);
        };
        let span_of = |slot| self.faces.span(record_in(&self.orders.records, slot));

        let Some(places) = places else {
            return Layer::new(&self.faces, move |slots, out| {
                slots.for_each(|slot| write_face(slot, &source[span_of(slot)], out));
            });
        };

        let mut fillings = places.fillings();
        let mut settled = Vec::new();
        Layer::new(&places.slots, move |slots, out| {
            for filling in fillings.by_ref().take(slots.len()) {
                match filling {
                    Filling::Line(span) => out.extend_from_slice(&source[span]),
                    Filling::Vertex(slot) => {
                        let record = record_in(&self.orders.vertices, slot);
                        out.extend_from_slice(&source[self.vertices.span(record)]);
                    }
                    Filling::Face { slot, run: None } => {
                        write_face(slot, &source[span_of(slot)], out);
                    }
                    Filling::Face {
                        slot,
                        run: Some(run),
                    } => {
                        let span = span_of(slot);
                        let above = places.above(run, span.start);
                        settled.clear();
                        self.notation
                            .write_settled(&source[span], above, &mut settled);
                        write_face(slot, &settled, out);
                    }
                }
            }
        })
    }

    /// Where faces and definitions go, if faces of a run with definitions move.
    fn places(&self) -> Option<Places<'_>> {
        let runs = &self.entries.first()?.runs;
        let definitions = self.notation.definitions()?;
        definitions.places(&self.faces, &self.vertices, runs, &self.orders)
    }

    /// Other bytes, as a reader of a file of this format takes them.
    fn again(&self, bytes: Vec<u8>) -> Result<RecordRead<N>, Problem> {
        signature::check(self.format, &bytes).map_err(|kind| kind.at(Place::File))?;
        (self.read_again)(self, bytes)
    }

    /// The file with all records where its orders put them.
    fn settled(&self) -> Result<Self, Problem> {
        let mut bytes = Vec::with_capacity(self.source.len());
        let written = self.write(&mut bytes);
        written.map_err(|error| FileErrorKind::Io(error).at(Place::File))?;
        let (file, _) = self.again(bytes).map_err(not_again)?;
        match file.entries.iter().zip(&self.entries).next() {
            Some((new, old)) if new.mesh.faces() == old.mesh.faces() => Ok(file),
            _ => Err(otherwise()),
        }
    }

    /// The file, whose records are where its source has them, without what is left out.
    fn without(&self, plan: &SelectPlan) -> Result<RecordRead<N>, Problem> {
        let vertices = plan.group(0).filter(|group| !group.are_all());
        let old_to_new = match vertices {
            Some(vertices) if self.vertices.len() > 0 => vertices.old_to_new.as_slice(),
            _ => &[],
        };
        let source = self.select_source(old_to_new);
        let mut writer = self.notation.select_writer(&source);
        let rows = self.notation.vertex_rows();
        let SelectedFile {
            bytes,
            vertices,
            faces,
        } = selected::write(&source, plan, rows, &mut *writer)?;

        // A reader has to find what was written, where it was written.
        let (file, notes) = self.again(bytes).map_err(not_again)?;
        let is_found = file.vertices.is_same(&vertices) && file.faces.is_same(&faces);
        let expected = self.faces_of(plan, &source);
        match &file.entries[..] {
            [entry] if is_found && entry.mesh.faces() == expected => {}
            _ => return Err(otherwise()),
        }
        Ok((file, notes))
    }

    /// The records of a mesh, with the orders that they were put in.
    fn stored<'a>(&'a self, entry: &'a MeshEntry) -> StoredMesh<'a> {
        StoredMesh {
            source: &self.source,
            vertices: &self.vertices,
            faces: &self.faces,
            entry,
            orders: &self.orders,
        }
    }

    /// The records where they stand, with these new numbers of the vertices.
    fn select_source<'a>(&'a self, old_to_new: &'a [u32]) -> SelectSource<'a> {
        SelectSource {
            stored: self.stored(&self.entries[0]),
            companions: &self.companions,
            lines: &self.lines,
            old_to_new,
        }
    }

    /// The faces that are left.
    fn faces_of(&self, plan: &SelectPlan, source: &SelectSource<'_>) -> Vec<[u32; 3]> {
        let entry = &self.entries[0];
        let mut faces: Vec<[u32; 3]> = match plan.mesh(0) {
            Some(mesh) => mesh.faces(entry).collect(),
            None => entry.mesh.faces().to_vec(),
        };
        if self.vertices.len() > 0 {
            for vertex in faces.as_flattened_mut() {
                *vertex = source.new_number(*vertex);
            }
            return faces;
        }

        // Vertices that are made of corners are those that faces use, in their old order.
        let mut numbers = vec![None; entry.mesh.vertex_count()];
        for &vertex in faces.as_flattened() {
            numbers[vertex as usize] = Some(0);
        }
        for (new, number) in numbers.iter_mut().flatten().enumerate() {
            *number = index32(new);
        }
        for vertex in faces.as_flattened_mut() {
            *vertex = numbers[*vertex as usize].unwrap_or_default();
        }
        faces
    }
}

/// The problem of a file of which a reader would not find what is left.
fn otherwise() -> Problem {
    let text = "what is left could be read in another way than it was: write each vertex and each face on a \
                line of its own";
    FileErrorKind::unsupported(text).at(Place::File)
}

/// The problem of a file that cannot be read any more.
fn not_again(problem: Problem) -> Problem {
    let text = format!("what is left cannot be read: {}", problem.kind);
    FileErrorKind::unsupported(text).at(Place::File)
}

impl<N> fmt::Debug for RecordFile<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RecordFile")
            .field("bytes", &self.source.len())
            .field("vertices", &self.vertices.len())
            .field("faces", &self.faces.len())
            .finish_non_exhaustive()
    }
}

impl<N: SelectNotation> Content for RecordFile<N> {
    fn meshes(&self) -> &[MeshEntry] {
        &self.entries
    }

    fn attributes(&self, _mesh: usize) -> Vec<AttributeInfo> {
        self.notation.attributes()
    }

    fn attribute(&self, mesh: usize, info: &AttributeInfo) -> Result<Attribute, Problem> {
        let stored = self.stored(&self.entries[mesh]);
        self.notation.attribute(&stored, info)
    }

    fn loose_positions(&self) -> Result<Option<Attribute>, Problem> {
        let mut infos = self.notation.attributes().into_iter();
        let info = infos.find(AttributeInfo::is_vertex_position);
        let Some(info) = info.filter(|_| self.entries.is_empty()) else {
            return Ok(None);
        };

        // As those of a mesh.
        let mesh = Mesh::connectivity_only(self.vertices.len(), Vec::new());
        let entry = MeshEntry {
            name: String::new(),
            mesh: mesh.map_err(|e| FileErrorKind::Order(e).at(Place::File))?,
            polygons: None,
            runs: Vec::new(),
            vertex_group: 0,
            object: 0,
            has_other_faces: false,
            faces_movable: false,
            vertices_movable: false,
            corners_turnable: false,
            level: None,
        };
        let stored = self.stored(&entry);
        self.notation.attribute(&stored, &info).map(Some)
    }

    fn unlisted(&self) -> Vec<Unlisted> {
        let Some(entry) = self.entries.first() else {
            return Vec::new();
        };
        let stored = self.stored(entry);
        self.notation.unlisted(&stored).into_list()
    }

    fn corner_kinds(&self, _mesh: usize) -> Result<Vec<u32>, Problem> {
        if !self.orders.is_empty() {
            return self.settled()?.corner_kinds(0);
        }
        let source = self.select_source(&[]);
        Ok(self.notation.corner_kinds(&source, &self.options))
    }

    fn order(&mut self, mesh: usize, faces: Option<&FaceOrder>, vertices: Option<&VertexOrder>) {
        let (entry, orders) = (&mut self.entries[mesh], &mut self.orders);
        if let Some(faces) = faces {
            orders.add_faces(faces);
            entry.apply_faces(faces);
        }
        if let Some(vertices) = vertices {
            orders.add_vertices(vertices);
            entry.apply_vertices(vertices);
        }
    }

    fn select(&mut self, plan: SelectPlan) -> Result<Vec<Note>, Problem> {
        // Nothing may be about what leaves.
        let stays =
            |(record, planned): (usize, &PlannedRecord)| planned.record() == index32(record);
        let faces_leave = plan.mesh(0).is_some_and(|mesh| {
            let is_each = mesh.records.len() == self.faces.len();
            !(is_each && mesh.records.iter().enumerate().all(stays))
        });
        let vertices = plan.group(0);
        let vertices_leave = vertices.is_some_and(|vertices| !vertices.are_all());
        self.bonds.check(faces_leave, vertices_leave)?;

        // What stays, first as it stands and then in its order.
        let (mut file, notes) = match self.orders.is_empty() {
            true => self.without(&plan)?,
            false => self.settled()?.without(&plan)?,
        };
        let faces = plan.mesh(0).map(|mesh| &mesh.order);
        let faces = faces.filter(|order| !order.is_identity());
        let vertices = vertices.map(|vertices| &vertices.order);
        let vertices = vertices.filter(|order| !order.is_identity() && file.vertices.len() > 0);
        let checked = check_order(&file.entries[0], faces, vertices);
        checked.map_err(|kind| kind.at(Place::File))?;
        file.order(0, faces, vertices);
        *self = file;
        Ok(notes)
    }

    fn companions(&self) -> Vec<PathBuf> {
        self.notation.companions()
    }

    fn files(&self, path: &Path, _: &[Placed]) -> Result<Vec<OutputFile<'_>>, Problem> {
        Ok(vec![OutputFile {
            path: path.to_owned(),
            place: OutputPlace::Replaced,
            write: Box::new(|sink| self.write(sink)),
        }])
    }
}
