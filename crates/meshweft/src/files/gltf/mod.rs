//! glTF 2.0, as JSON with buffers beside it or as one binary file: records permuted in the bytes.
//!
//! The JSON is read and never written: what a permutation changes are indices and vertex data, and
//! those are fixed-size records in buffers. So the JSON of a `.glb` stays byte for byte, and in a
//! `.gltf` only the text of a changed `data:` URI (or of a renamed buffer file) is replaced.
//!
//! Records may be moved only if all who read them agree, so everything that reads bytes is listed
//! first ([`byte_users`]). Primitives that share an index accessor share their face order and are one
//! mesh; primitives that share any data share their vertex order and are one group ([`groups`]).
//! What cannot be moved is left as it is, with a note that says why.
//!
//! Read [`container`] → [`buffers`] → [`accessors`] → [`obstacles`] → [`movable`] → [`extensions`] →
//! [`primitives`] → [`byte_users`] → [`groups`] → [`entries`] → [`patch`] → [`output`].
//!
//! | word | what it is |
//! |---|---|
//! | `Storage` | bytes of the file or of a buffer beside it; several buffers may stand for one |
//! | `StridedRecords` | equal pieces of a storage at equal distances: what a permutation moves |
//! | `Obstacles` | why a primitive stays, or only its vertices, while its JSON is read |
//! | `VertexObstacle` | one reason why vertices stay, and where it stands |
//! | `Movable` | a primitive that may move, as far as itself is concerned |
//! | `Uncommon` | what few movable primitives have: sparse data, outlines, obstacles |
//! | `Staying` | a primitive that stays as it is, and why |
//! | `ByteUsers` | all records of the file, each (`UsedRecords`) with those who read it |
//! | `Group` | primitives that share data, and so one vertex order |
//! | `Entries` | the meshes that are offered, each with the records of its corners |
//! | `Missing` | why a buffer has no bytes |

mod accessors;
mod base64;
mod buffers;
mod byte_users;
mod container;
mod entries;
mod extensions;
mod groups;
mod json;
mod movable;
mod object;
mod obstacles;
mod output;
mod patch;
mod primitives;
mod sparse;
mod strided_records;

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::content::{Content, OutputFile, ReadResult};
use super::disk::{read_limited, read_start};
use super::entry::MeshEntry;
use super::error::{FileError, FileErrorKind, Place, Problem};
use super::format::Format;
use super::note::Note;
use super::options::ReadOptions;
use crate::limits::Limits;
use crate::permutation::{FaceOrder, VertexOrder};
use accessors::Accessors;
use buffers::Buffers;
use byte_users::ByteUsers;
use container::Container;
use entries::{Corners, Entries};
use json::{Json, JsonFault, Value};
use movable::PrimitiveNumber;
use object::Object;
use output::Output;
use primitives::Primitives;

/// A glTF file whose records can be moved.
struct GltfFile {
    source: PathBuf,
    container: Container,
    buffers: Buffers,
    uri_spans: BTreeMap<usize, Range<usize>>,
    entries: Entries,
}

/// Reads a `.gltf` or `.glb`, and the buffers beside it.
///
/// # Complexity
/// Time O(n log n) and space O(n) in the bytes of the file and its buffers.
pub(super) fn read(
    bytes: Vec<u8>,
    format: Format,
    path: &Path,
    options: &ReadOptions,
) -> ReadResult {
    let limits = &options.limits;
    let is_glb = format == Format::Glb;
    let mut container = match is_glb {
        true => Container::of_chunks(bytes)?,
        false => Container::of_text(bytes),
    };
    let binary = container.binary.take();
    let json = read_json(&container, limits)?;
    let root = Object::new(json.root(), String::new())?;
    check_version(&root)?;
    let buffers = Buffers::load(&root, binary, path, is_glb, options)?;
    let uris = root.array("buffers")?.into_iter().enumerate();
    let span = |(number, buffer): (usize, Value<'_>)| Some((number, buffer.get("uri")?.span()));
    let uri_spans = uris.filter_map(span).collect();
    let accessors = Accessors::new(&root, &buffers, &options.assume_order_safe)?;
    let mut primitives = Primitives::read(&root, &accessors, options)?;
    let mut byte_users = ByteUsers::new(&root, &accessors, &primitives);
    groups::keep_entangled(&mut primitives, &mut byte_users);
    let entries = Entries::new(&primitives, &byte_users, &buffers)?;
    let notes = notes(&root, &primitives, &entries, &buffers);
    let scene = GltfFile {
        source: path.to_owned(),
        container,
        buffers,
        uri_spans,
        entries,
    };
    Ok((Box::new(scene), notes))
}

fn read_json<'a>(container: &'a Container, limits: &Limits) -> Result<Json<'a>, Problem> {
    let text = &container.head[container.json.clone()];
    Json::read(text, limits).map_err(|fault| {
        // A .gltf has no header: the parser's own line and column are already in the message.
        let place = match container.json.start {
            0..=3 => Place::File,
            start => Place::Byte(start),
        };
        let kind = match fault {
            JsonFault::Kind(kind) => kind,
            JsonFault::Syntax(error) => {
                FileErrorKind::malformed(format!("the JSON cannot be read: {error}"))
            }
        };
        kind.at(place)
    })
}

/// The files that the buffers of a glTF or GLB name, as paths beside it.
///
/// Two files of one folder may name the same: see
/// [`ReadOptions::keep_buffers`](super::ReadOptions::keep_buffers).
///
/// # Errors
/// [`FileError`]: the file cannot be read, is not a glTF, or its JSON is not sound.
pub fn external_buffers(path: &Path, limits: &Limits) -> Result<Vec<PathBuf>, FileError> {
    let format = Format::of_path(path);
    let read = || {
        let bytes = match format {
            // The binary chunk of a GLB may be large, and is of no use here.
            Some(Format::Glb) => read_start(path, limits, Container::json_end),
            _ => read_limited(path, limits).map(|stored| stored.bytes),
        };
        let bytes = bytes.map_err(|kind| kind.at(Place::File))?;
        let container = match format {
            Some(Format::Glb) => Container::of_start(bytes)?,
            _ => Container::of_text(bytes),
        };
        let json = read_json(&container, limits)?;
        buffers::external_paths(&Object::new(json.root(), String::new())?, path)
    };
    read().map_err(|problem: Problem| problem.in_file(path, format))
}

fn check_version(root: &Object) -> Result<(), Problem> {
    let Some(asset) = root.object("asset")? else {
        return Ok(());
    };
    match asset.text("version")? {
        Some(version) if !version.starts_with("2.") => {
            let feature = format!("glTF version {version}: only version 2 is read, re-export it");
            let place = Place::Json(asset.pointer_to("version"));
            Err(FileErrorKind::unsupported(feature).at(place))
        }
        _ => Ok(()),
    }
}

/// Why something stays as it is.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Reason<'a> {
    OfPrimitive(&'a str),
    OfVertices(&'a str),
}

impl Reason<'_> {
    fn note(self, place: Place) -> Note {
        match self {
            Self::OfPrimitive(why) => Note::new(place, format!("left as it is: {why}")),
            Self::OfVertices(why) => Note::vertices_stay(place, why),
        }
    }
}

/// The first primitive that a reason holds for, and how many there are.
struct First<'a> {
    number: PrimitiveNumber,
    /// What in the primitive it is, if not all of it.
    pointer: Option<&'a str>,
    count: usize,
}

/// What is left as it is, in the order of the file.
fn notes(
    root: &Object,
    primitives: &Primitives,
    entries: &Entries,
    buffers: &Buffers,
) -> Vec<Note> {
    // One note for each reason, at the first place: a reason may hold for very many.
    let mut firsts: BTreeMap<Reason<'_>, First<'_>> = BTreeMap::new();
    let staying = primitives.staying.iter();
    let staying = staying.map(|staying| (Reason::OfPrimitive(&staying.why), staying.number, None));
    let obstacles = entries.vertex_obstacles.iter();
    let obstacles = obstacles.map(|(number, obstacle)| {
        let reason = Reason::OfVertices(&obstacle.why);
        (reason, *number, Some(obstacle.pointer.as_str()))
    });
    for (reason, number, pointer) in staying.chain(obstacles) {
        let first = firsts.entry(reason).or_insert(First {
            number,
            pointer,
            count: 0,
        });
        if number < first.number {
            (first.number, first.pointer) = (number, pointer);
        }
        first.count += 1;
    }

    let mut firsts: Vec<_> = firsts.into_iter().collect();
    firsts.sort_by_key(|(_, first)| first.number);
    let notes = firsts.into_iter().map(|(reason, first)| {
        let pointer = first.pointer.map(str::to_owned);
        let pointer = pointer.unwrap_or_else(|| first.number.pointer());
        Note {
            more: first.count - 1,
            ..reason.note(Place::Json(pointer))
        }
    });
    let mut notes: Vec<Note> = notes.collect();

    let note = |pointer: &str, text: String| Note::new(Place::Json(pointer.to_owned()), text);
    for (buffer, why) in buffers.unreadable() {
        notes.push(note(
            &format!("/buffers/{buffer}/uri"),
            format!("not read: {why}"),
        ));
    }
    let is_external = |image: Value<'_>| {
        let uri = image.get("uri").and_then(Value::text);
        uri.is_some_and(|uri| !uri.starts_with("data:"))
    };
    let images = root.value("images").map(Value::elements);
    if images.is_some_and(|mut images| images.any(is_external)) {
        let text = "images are files of their own: copy them to the folder of the output";
        notes.push(note("/images", text.to_owned()));
    }
    notes
}

impl fmt::Debug for GltfFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GltfFile")
            .field("source", &self.source)
            .field("bytes", &self.buffers.byte_count())
            .field("meshes", &self.entries.meshes.len())
            .finish_non_exhaustive()
    }
}

impl Content for GltfFile {
    fn meshes(&self) -> &[MeshEntry] {
        &self.entries.meshes
    }

    fn apply(&mut self, mesh: usize, faces: &FaceOrder, vertices: Option<&VertexOrder>) {
        let group = self.entries.meshes[mesh].vertex_group;
        let mut rewritten = Vec::new();
        if !faces.is_identity() {
            match &self.entries.corners[mesh] {
                Corners::Indices(_) => {
                    self.entries.meshes[mesh].apply_faces(faces);
                    rewritten.push(mesh);
                }
                Corners::Triples(vertices) => {
                    let new_to_old = patch::triples(faces);
                    for records in vertices {
                        let bytes = self.buffers.bytes_to_change(records.storage);
                        patch::permute(bytes, records, &new_to_old);
                    }
                    self.entries.move_triples(mesh, new_to_old);
                }
            }
        }
        if let Some(order) = vertices.filter(|order| !order.is_identity()) {
            let group = &self.entries.groups[group];
            for records in &group.vertices {
                let bytes = self.buffers.bytes_to_change(records.storage);
                patch::permute(bytes, records, order.new_to_old());
            }
            let old_to_new = order.permutation().old_to_new();
            for records in &group.outlines {
                let bytes = self.buffers.bytes_to_change(records.storage);
                let numbers = patch::numbers(bytes, records);
                let renumbered = numbers.iter().map(|&old| old_to_new[old as usize]);
                patch::write_numbers(bytes, records, renumbered);
            }
            sparse::renumber(&mut self.buffers, &group.sparse, &old_to_new);
            for &member in &group.meshes {
                self.entries.meshes[member].apply_vertices(order);
            }
            rewritten.clone_from(&group.meshes);
        }
        for mesh in rewritten {
            if let Corners::Indices(records) = &self.entries.corners[mesh] {
                let bytes = self.buffers.bytes_to_change(records.storage);
                let faces = self.entries.meshes[mesh].mesh.faces();
                patch::write_numbers(bytes, records, faces.as_flattened().iter().copied());
            }
        }
    }

    fn files(&self, path: &Path) -> Result<Vec<OutputFile<'_>>, Problem> {
        let output = Output {
            source: &self.source,
            container: &self.container,
            buffers: &self.buffers,
            uri_spans: &self.uri_spans,
        };
        output.files(path)
    }

    fn size_beside(&self) -> u64 {
        self.buffers.read_size
    }
}
