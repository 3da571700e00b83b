//! Files that are a sequence of records, in text or in bytes: OBJ, OFF, PLY, STL.
//!
//! The source is never changed: orders add up, and the output is spliced when it is asked for.

use std::path::{Path, PathBuf};
use std::{fmt, io};

use super::content::{Content, OutputFile, OutputPlace};
use super::definitions::{Filling, Places};
use super::entry::MeshEntry;
use super::error::Problem;
use super::orders::{RecordOrders, record_in};
use super::placing::Placed;
use super::rewrite::{Change, Notation, Rewrite, StoredMesh};
use super::slots::Spans;
use super::splice::{Layer, splice};
use crate::attribute::{Attribute, AttributeInfo};
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
}

impl<N: Notation> RecordFile<N> {
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

impl<N: Notation> Content for RecordFile<N> {
    fn meshes(&self) -> &[MeshEntry] {
        &self.entries
    }

    fn attributes(&self, _mesh: usize) -> Vec<AttributeInfo> {
        self.notation.attributes()
    }

    fn attribute(&self, mesh: usize, info: &AttributeInfo) -> Result<Attribute, Problem> {
        let stored = StoredMesh {
            source: &self.source,
            vertices: &self.vertices,
            faces: &self.faces,
            entry: &self.entries[mesh],
            orders: &self.orders,
        };
        self.notation.attribute(&stored, info)
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
