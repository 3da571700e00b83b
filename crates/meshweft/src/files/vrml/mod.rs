//! VRML97 (VRML 2.0): the faces and vertices of every `IndexedFaceSet` move.
//!
//! Five choices were made here:
//!
//! - A face record is the numbers of a polygon with its -1, wherever lines end. The polygons of
//!   `texCoordIndex`, `colorIndex` and `normalIndex` go along, and what goes by face (indices, or
//!   colors and normals themselves) too.
//! - Vertices are renumbered with all that `coordIndex` numbers: the points, and colors, normals
//!   and texture coordinates that have no indices of their own.
//! - What something else may read by number stays, with a note: lists that a `USE` or a `ROUTE`
//!   names, fields that are one of a `PROTO`, everything if a `Script` is handed nodes.
//! - Faces of a `Shape` whose `Material` has a transparency keep their order: what a `ROUTE` makes
//!   transparent later, and pictures with transparent parts, are not known.
//! - A face set whose `coord` is a `USE` has the vertices that its own faces name. They stay.
//!
//! What can be read of a face set: its positions; its normals, colors and texture coordinates if
//! their node stands in the face set. They go by vertex where they go by the numbers of
//! `coordIndex`, by corner where they have indices of their own, by face where the face set says so.
//! A node that is a `USE` is not looked up but for `coord`, so what it holds is not listed; nor is a
//! list by vertex that has fewer entries than vertices. What a `ROUTE` sends later is not known.

mod attributes;
mod bindings;
mod fields;
mod lexer;
mod lists;
mod nodes;
mod reader;
mod scene;
mod unlisted;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;
use std::{fmt, io};

use super::content::{Content, OutputFile, OutputPlace, ReadResult};
use super::entry::MeshEntry;
use super::error::no_attribute;
use super::error::{FileErrorKind, Place, Problem};
use super::note::Note;
use super::options::ReadOptions;
use super::orders::{RecordOrders, record_in};
use super::placing::Placed;
use super::rewrite::{Change, Rewrite};
use super::slots::Spans;
use super::splice::{Layer, splice};
use super::text::{content_end, is_line_end, line_of};
use super::unlisted::Unlisted;
use crate::attribute::{Attribute, AttributeInfo, Values};
use crate::permutation::{FaceOrder, VertexOrder};
use attributes::{RoleValues, ValueReader};
use bindings::{Binder, Slots, Stop};
use lexer::{Lexer, index};

/// Reads a VRML file.
///
/// Time O(bytes), but for names and vertices of shared coordinates that are sorted; memory a few
/// times the bytes, and less than 2 KiB for each face set.
pub(super) fn read(bytes: Vec<u8>, options: &ReadOptions) -> ReadResult {
    let limits = &options.limits;
    let at = header(&bytes)?;
    let text = &bytes[..content_end(&bytes)];
    let scene = nodes::read(text, at, limits).map_err(|fault| fault.on_its_line(&bytes))?;
    let mut binder = Binder {
        text: &bytes,
        scene: &scene,
        limits,
        reorder_transparent: options.reorder_transparent,
        shared: vec![None; scene.coordinates.len()],
    };

    let (mut entries, mut sets) = (Vec::new(), Vec::new());
    let mut said = Said::default();
    for (at, why) in &scene.refused {
        said.add(*at, Stays::Mesh(why.to_string()));
    }
    for (number, set) in scene.face_sets.iter().enumerate() {
        let at = set.span.start;
        match binder.bind(set, number) {
            Ok(bound) => {
                if let Some(why) = bound.vertices_stay {
                    said.add(at, Stays::Vertices(why));
                }
                let mut entry = bound.entry;
                if !entry.faces_movable {
                    said.add(at, Stays::Order);
                }
                (entry.vertex_group, entry.object) = (entries.len(), entries.len());
                entries.push(entry);
                sets.push(Set {
                    span: set.span.clone(),
                    slots: bound.slots,
                    shared: bound.shared,
                    orders: RecordOrders::default(),
                });
            }
            Err(Stop::Stays(why)) => said.add(at, Stays::Mesh(why)),
            Err(Stop::Fault(fault)) => return Err(fault.on_its_line(&bytes)),
        }
    }

    let shared = binder.shared;
    let unread = said.first_mesh().map(|at| line_of(&bytes, at));
    let mut notes = said.notes(&bytes);
    if entries.is_empty() && notes.is_empty() {
        notes.push(Note::nothing_to_order());
    }
    let file = VrmlFile {
        source: bytes,
        sets,
        shared,
        entries,
        unread,
    };
    Ok((Box::new(file), notes))
}

/// Checks the first line; where it ends.
fn header(bytes: &[u8]) -> Result<usize, Problem> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mark = bytes.len() - text.len();
    let known = b"#VRML V2.0";
    if text.starts_with(known) {
        // The header is a comment like any other.
        return Ok(mark);
    }

    let trimmed = text.trim_ascii_start();
    let kind = if text.starts_with(b"#VRML V1") || text.starts_with(b"#Inventor") {
        FileErrorKind::unsupported(
            "VRML 1.0 and Open Inventor are not read. Convert it to VRML 2.0 (VRML97) first",
        )
    } else if text.starts_with(b"#X3D")
        || [&b"<?xml"[..], b"<X3D", b"<!DOCTYPE"]
            .iter()
            .any(|start| trimmed.starts_with(start))
    {
        FileErrorKind::unsupported("X3D is not read. Convert it to VRML 2.0 (VRML97) first")
    } else if known.starts_with(text) {
        FileErrorKind::truncated("the header: a VRML file starts with #VRML V2.0")
    } else {
        FileErrorKind::malformed(
            "a VRML file starts with #VRML V2.0 and this one does not: is it another format?",
        )
    };
    Err(kind.at(Place::Line(1)))
}

/// What stays as it is, and why.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Stays {
    Mesh(String),
    /// That of the faces.
    Order,
    Vertices(String),
}

impl Stays {
    fn note(self, place: Place) -> Note {
        match self {
            Self::Mesh(why) => Note::new(place, format!("the mesh stays as it is: {why}")),
            Self::Order => Note::transparent(place, "its Material has a transparency"),
            Self::Vertices(why) => Note::vertices_stay(place, why),
        }
    }
}

/// What is said of places in the text: each thing once, with its first place and how many there
/// are.
#[derive(Default)]
struct Said(BTreeMap<Stays, (usize, usize)>);

impl Said {
    fn add(&mut self, at: usize, what: Stays) {
        let (first, count) = self.0.entry(what).or_insert((at, 0));
        *first = at.min(*first);
        *count += 1;
    }

    /// Where the first mesh stands that stays as it is.
    fn first_mesh(&self) -> Option<usize> {
        let meshes = self.0.iter();
        let meshes = meshes.filter(|(what, _)| matches!(what, Stays::Mesh(_)));
        meshes.map(|(_, &(at, _))| at).min()
    }

    /// The notes, in the order of the text. Its lines are counted once for all.
    fn notes(self, text: &[u8]) -> Vec<Note> {
        let mut said: Vec<_> = self.0.into_iter().collect();
        said.sort_by_key(|&(_, (at, _))| at);
        let (mut counted, mut line) = (0, 1);
        let notes = said.into_iter().map(|(what, (at, count))| {
            let ends = (counted..at).filter(|&byte| match text[byte] {
                b'\r' => text.get(byte + 1) != Some(&b'\n'),
                byte => is_line_end(byte),
            });
            line += ends.count();
            counted = at;
            Note {
                more: count - 1,
                ..what.note(Place::Line(line))
            }
        });
        notes.collect()
    }
}

/// A face set: its bytes, its records, and the orders they were put in.
struct Set {
    span: Range<usize>,
    slots: Slots,
    /// The number of its points in [`VrmlFile::shared`], if they are shared.
    shared: Option<usize>,
    orders: RecordOrders,
}

struct VrmlFile {
    source: Vec<u8>,
    /// In the order of the file; none holds another.
    sets: Vec<Set>,
    /// Where points stand that face sets share.
    shared: Vec<Option<Spans>>,
    /// One a set.
    entries: Vec<MeshEntry>,
    /// The line of the first face set that is not a mesh.
    unread: Option<usize>,
}

impl VrmlFile {
    fn write(&self, sink: &mut dyn io::Write) -> io::Result<()> {
        let source = self.source.as_slice();
        let mut copied = 0;
        for set in &self.sets {
            if set.orders.records.is_empty() && set.orders.vertices.is_empty() {
                continue;
            }
            sink.write_all(&source[copied..set.span.start])?;
            set.write(source, sink)?;
            copied = set.span.end;
        }
        sink.write_all(&source[copied..])
    }
}

impl Set {
    fn write(&self, source: &[u8], sink: &mut dyn io::Write) -> io::Result<()> {
        let orders = &self.orders;
        let old_to_new = orders.old_to_new();
        let old_to_new = old_to_new.as_slice();
        let mut layers = Vec::new();

        for (list, spans) in self.slots.polygons.iter().enumerate() {
            let mut corners = Vec::new();
            layers.push(Layer::new(spans, move |slots, out| {
                for slot in slots {
                    let change = Change {
                        rotation: orders.rotation(slot),
                        old_to_new: if list == 0 { old_to_new } else { &[] },
                    };
                    let record = &source[spans.span(record_in(&orders.records, slot))];
                    match change.is_nothing() {
                        true => out.extend_from_slice(record),
                        false => write_polygon(
                            record,
                            Rewrite {
                                change,
                                corners: &mut corners,
                                out,
                            },
                        ),
                    }
                }
            }));
        }

        for spans in &self.slots.companions {
            layers.push(Layer::moved(spans, source, &orders.records));
        }
        if !orders.vertices.is_empty() {
            for spans in &self.slots.vertices {
                layers.push(Layer::moved(spans, source, &orders.vertices));
            }
        }
        splice(source, self.span.clone(), layers, sink)
    }
}

/// Appends a polygon with its corners turned and renumbered; what is between them is copied.
fn write_polygon(record: &[u8], rewrite: Rewrite<'_>) {
    let corners = &mut *rewrite.corners;
    corners.clear();
    let mut lexer = Lexer::new(record, 0);
    corners.extend(std::iter::from_fn(|| lexer.word()));
    let is_closed = corners
        .last()
        .is_some_and(|last| index(&record[last.clone()]) == Some(-1));
    corners.truncate(corners.len() - usize::from(is_closed));

    let vertex_of = |corner: &[u8]| {
        let vertex = usize::try_from(index(corner)?).ok()?;
        Some((vertex, corner.len()))
    };
    rewrite.write_corners(record, 0, vertex_of);
}

impl fmt::Debug for VrmlFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("VrmlFile")
            .field("bytes", &self.source.len())
            .field("face_sets", &self.sets.len())
            .finish()
    }
}

impl Content for VrmlFile {
    fn meshes(&self) -> &[MeshEntry] {
        &self.entries
    }

    fn attributes(&self, mesh: usize) -> Vec<AttributeInfo> {
        let values = self.sets[mesh].slots.values.iter();
        values.map(RoleValues::info).collect()
    }

    fn attribute(&self, mesh: usize, info: &AttributeInfo) -> Result<Attribute, Problem> {
        let set = &self.sets[mesh];
        let mut values = set.slots.values.iter();
        let values = values.find(|values| values.info() == *info);
        let values = values.ok_or_else(|| no_attribute(info))?;
        let reader = ValueReader {
            text: &self.source,
            polygons: &set.slots.polygons,
            companions: &set.slots.companions,
            shared: set.shared.and_then(|shared| self.shared[shared].as_ref()),
            entry: &self.entries[mesh],
            orders: &set.orders,
        };
        let read = reader.read(values);
        let read = read.map_err(|fault| fault.on_its_line(&self.source))?;
        Ok(Attribute::new(info.clone(), Values::F32(read)))
    }

    fn unlisted(&self) -> Vec<Unlisted> {
        let meshes = 0..self.sets.len();
        let listed: Vec<_> = meshes.flat_map(|mesh| self.attributes(mesh)).collect();
        let listed = listed.into_iter().map(|info| info.semantic);
        let text = &self.source[..content_end(&self.source)];
        let start = header(&self.source).unwrap_or(0);
        let mut found = unlisted::unlisted(text, start, &listed.collect::<BTreeSet<_>>());
        if let Some(line) = self.unread {
            found.add_faces(format!("the face set on line {line}"));
        }
        found.into_list()
    }

    fn order(&mut self, mesh: usize, faces: Option<&FaceOrder>, vertices: Option<&VertexOrder>) {
        let (entry, orders) = (&mut self.entries[mesh], &mut self.sets[mesh].orders);
        if let Some(faces) = faces {
            orders.add_faces(faces);
            entry.apply_faces(faces);
        }
        if let Some(vertices) = vertices {
            orders.add_vertices(vertices);
            entry.apply_vertices(vertices);
        }
    }

    fn files(&self, path: &Path, _: &[Placed]) -> Result<Vec<OutputFile<'_>>, Problem> {
        Ok(vec![OutputFile {
            path: path.to_owned(),
            place: OutputPlace::Replaced,
            write: Box::new(|sink| self.write(sink)),
        }])
    }
}
