//! glTF 2.0, as JSON with buffers beside it or as one binary file: records permuted in the bytes.
//!
//! An order does not write the JSON: what a permutation changes are indices and vertex data, and
//! those are fixed-size records in buffers. So the JSON of a `.glb` stays byte for byte, and in a
//! `.gltf` only the text of a changed `data:` URI (or of a renamed buffer file) is replaced.
//!
//! Records may be moved only if all that reads them moves alike, so everything that reads bytes is
//! listed first ([`byte_users`]). Primitives that share an index accessor share their face order and
//! are one mesh; primitives that share any data share their vertex order and are one group
//! ([`groups`]). What cannot be moved is left as it is, with a note that says why.
//!
//! Read [`container`] → [`buffers`] → [`accessors`] → [`obstacles`] → [`movable`] → [`extensions`] →
//! [`primitives`] → [`byte_users`] → [`groups`] → [`entries`] → [`patch`] → [`output`];
//! [`notes`] says what stays as it is. Values are read on request: [`attributes`] → [`elements`].
//! Strips are made lists before all else, if that is asked for: [`strips`].
//! [`mod@unlisted`] names what is neither in the meshes nor in their attributes.
//! [`levels`] finds which meshes are levels of detail of others.
//! [`companions`] are the files that it names beside these; [`neighbours`] asks who else names a buffer.
//! [`culling`] reads the tables that say which faces need not be drawn, [`new_tables`] adds them, [`tables`] has those
//! of each mesh, [`placed_tables`] their positions too, [`sides`] finds which sides
//! are seen.
//! What is left out goes through [`select`]: [`leaving`] moves up the records that stay, [`byte_map`] says
//! where the rest then stands, [`stated_bounds`] has the smallest and largest values.
//! What is added goes through [`append`]: [`new_meshes`] and [`new_attributes`] make the bytes and
//! values, [`growth`] has the buffer for them, [`scene`] finds where they are drawn,
//! [`new_levels`] adds levels of detail, [`level_nodes`] the nodes that draw these, [`vertex_copies`] vertices where
//! they need their own, [`additions`] puts values into the text.
//! What is wanted first comes first after [`stream_layout`]: [`stream_order`] says when each buffer view is wanted, by what
//! [`primitive_reads`] finds and [`drawn_levels`] draws; [`stream_pieces`] moves them, unless something that is not known
//! names their bytes ([`unknown_names`]). [`level_needs`] says where each level of detail then has its bytes.
//!
//! | word | what it is |
//! |---|---|
//! | `Container` | the file around its JSON: the chunks of a GLB, or text alone |
//! | `Storage` | bytes of the file or of a buffer beside it; several buffers may stand for one |
//! | `StridedRecords` | equal pieces of a storage at equal distances: what a permutation moves |
//! | `Accessor` | an accessor of the file, its bounds checked, as records |
//! | `Elements` | what the elements of an accessor are, to be read as numbers |
//! | `Attributes` | which elements each mesh has, by name |
//! | `IndexList` | records that are vertex numbers: the corners of faces, lines, an outline |
//! | `Draws` | whether a primitive draws faces or something else |
//! | `Sparse` | elements stored by number: their numbers, and their values |
//! | `Obstacles` | why a primitive stays, or only its vertices, while its JSON is read |
//! | `VertexObstacle` | one reason why vertices stay, and the pointer to what gives it |
//! | `Movable` | a primitive that may be changed, as far as itself is concerned |
//! | `Uncommon` | what few movable primitives have: sparse data, outlines, obstacles |
//! | `Staying` | a primitive that stays as it is, and why |
//! | `ByteUsers` | all records of the file, each (`UsedRecords`) with those who read it |
//! | `UsedAs` | what a primitive reads records as: indices, vertices, … |
//! | `Group` | primitives that share data, and so one vertex order |
//! | `Corners` | where the corners of a mesh are stored: in a list, or as vertices in a row |
//! | `Entries` | the meshes that are offered, each with the records of its corners |
//! | `GroupObstacles` | why the vertices of each group stay, while the entries are made |
//! | `Missing` | why a buffer has no bytes |
//! | `Culling` | the culling table of a primitive |
//! | `StatedLevel` | that a mesh of the file, with all its primitives, is a level of detail of another one |
//! | `View` | all that was found in the JSON (no `bufferView`) |
//! | `Growth` | the buffer that new bytes go to |
//! | `Additions` | new values, each with the way to its place |
//! | `Leaving` | storages from which records leave, in the making |
//! | `ByteMap` | the bytes that leave, and where the others then stand |
//! | `DrawnLevels` | at which levels of detail each mesh is drawn |
//! | `PrimitiveReads` | what is read to draw a primitive |
//! | `StreamClass` | when a buffer view is wanted, and for which part (`DrawnPart`) of a picture |
//! | `MovingPiece` | buffer views that share bytes, and so move together |
//! | `LaidOut` | a buffer with its pieces in another order |

mod accessors;
mod additions;
mod append;
mod attributes;
mod base64;
mod buffers;
mod byte_map;
mod byte_users;
mod companions;
mod container;
mod culling;
mod drawn_levels;
mod drawn_scales;
mod elements;
mod entries;
mod extensions;
mod groups;
mod growth;
mod json;
mod leaving;
mod level_needs;
mod level_nodes;
mod levels;
#[cfg(test)]
mod levels_tests;
mod movable;
mod neighbours;
mod new_attributes;
mod new_levels;
mod new_meshes;
mod new_tables;
mod notes;
mod object;
mod objects;
mod obstacles;
mod output;
mod patch;
mod placed_tables;
mod primitive_reads;
mod primitives;
mod scene;
mod select;
mod sides;
mod sparse;
mod stated_bounds;
mod stream_layout;
mod stream_order;
mod stream_pieces;
mod strided_records;
mod strips;
mod tables;
mod unknown_names;
mod unlisted;
mod uri;
mod vertex_copies;

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::{fmt, fs, io};

use super::content::{Content, OutputFile, ReadResult};
use super::disk::read_start;
use super::edit::NewValue;
use super::entry::MeshEntry;
use super::error::{FileError, FileErrorKind, Place, Problem};
use super::format::Format;
use super::level_bytes::LevelBytes;
use super::new_levels::{NewLevels, VerticesOfLevels};
use super::new_mesh::NewMesh;
use super::note::Note;
use super::options::ReadOptions;
use super::placing::{Beside, Placed};
use super::select::SelectPlan;
use super::stored_culling::{PlacedTable, SeenSides, StoredCulling};
use super::surroundings::Surroundings;
use super::unlisted::Unlisted;
use crate::attribute::{Attribute, AttributeInfo};
use crate::limits::Limits;
use crate::permutation::{FaceOrder, VertexOrder};
use accessors::Accessors;
use attributes::Attributes;
use buffers::Buffers;
use byte_users::ByteUsers;
use companions::Companions;
use container::Container;
use entries::{Corners, Entries};
use json::{Json, JsonFault, Value};
pub use neighbours::shared_buffers;
pub(super) use neighbours::{Known, buffer_names, named_by_others, names_of_buffers};
use object::Object;
use output::Output;
use primitives::Primitives;

/// A glTF file whose records can be moved.
struct GltfFile {
    container: Container,
    buffers: Buffers,
    view: View,
    options: ReadOptions,
}

/// All that was found in the JSON; nothing to do with a `bufferView`.
struct View {
    /// Where in the JSON the URI of each buffer stands, of those that have one.
    uri_spans: BTreeMap<usize, Range<usize>>,
    /// The files that it names beside its buffers, as paths from its folder.
    companions: Vec<PathBuf>,
    entries: Entries,
    attributes: Attributes,
    /// Those of each primitive that has a culling table.
    table_attributes: Attributes,
    /// What is wrong with culling tables that cannot be used.
    damaged_table: Option<Note>,
    /// The name of the first primitive with faces that are in no mesh.
    unread_faces: Option<String>,
}

/// Reads a `.gltf` or `.glb` of this name, and the buffers beside it.
///
/// # Complexity
/// Time O(n log n) and space O(n) in the bytes of the file and its buffers.
pub(super) fn read(
    bytes: Vec<u8>,
    format: Format,
    name: &Path,
    surroundings: Surroundings<'_>,
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

    let mut buffers = Buffers::load(&root, binary, surroundings, limits)?;
    buffers.fix(name, is_glb, &options.keep_buffers, surroundings);
    let mut options = options.clone();
    let mut first_note = None;
    if std::mem::take(&mut options.strips_to_lists)
        && let Some((changed, note)) = strips::to_lists(&root, &container, &mut buffers, &options)?
    {
        container = changed;
        first_note = Some(note);
    }
    let json = read_json(&container, limits)?;
    let root = Object::new(json.root(), String::new())?;
    let (view, notes) = look(&root, &buffers, &options)?;
    let file = GltfFile {
        container,
        buffers,
        view,
        options,
    };
    Ok((
        Box::new(file),
        first_note.into_iter().chain(notes).collect(),
    ))
}

/// Finds the meshes of a file, which of them can be moved, and what they store.
fn look(
    root: &Object,
    buffers: &Buffers,
    options: &ReadOptions,
) -> Result<(View, Vec<Note>), Problem> {
    let uris = root.array("buffers")?.into_iter().enumerate();
    let span = |(number, buffer): (usize, Value<'_>)| Some((number, buffer.get("uri")?.span()));
    let uri_spans = uris.filter_map(span).collect();

    // Primitives that share data with what stays must stay too; the rest are the meshes.
    let accessors = Accessors::new(root, buffers, &options.assume_order_safe)?;
    let mut primitives = Primitives::read(root, &accessors, options)?;
    let mut byte_users = ByteUsers::new(root, &accessors, &primitives);
    groups::keep_entangled(&mut primitives, &mut byte_users);
    let mut entries = Entries::new(&primitives, &byte_users, buffers)?;
    levels::add(root, &mut entries);
    let attributes = Attributes::new(root, &accessors, &entries.first_primitives);
    let table_attributes = Attributes::new(root, &accessors, &entries.tables.primitives());

    let companions = Companions::of(root);
    let notes = notes::notes(&primitives, &entries, buffers, &companions);
    let view = View {
        uri_spans,
        companions: companions.files.into_iter().collect(),
        entries,
        attributes,
        table_attributes,
        damaged_table: tables::damaged(&primitives),
        unread_faces: primitives.unread_faces(),
    };
    Ok((view, notes))
}

/// A `.gltf` or `.glb` of new meshes.
pub(super) fn create(format: Format, name: &Path, meshes: &[NewMesh<'_>]) -> ReadResult {
    let generator = concat!("meshweft ", env!("CARGO_PKG_VERSION"));
    let json = serde_json::json!({ "asset": { "version": "2.0", "generator": generator } });
    let empty = match format {
        Format::Glb => Container::new_glb(&json.to_string()),
        _ => json.to_string().into_bytes(),
    };
    let options = ReadOptions::default();
    let (mut content, _) = read(empty, format, name, Surroundings::Nothing, &options)?;
    let notes = content.append(meshes, &[])?;
    Ok((content, notes))
}

/// The JSON of a file, parsed.
fn read_json<'a>(container: &'a Container, limits: &Limits) -> Result<Json<'a>, Problem> {
    let text = container::without_zeros(&container.head[container.json.clone()]);
    Json::read(text, limits).map_err(|fault| {
        // In a .gltf, the line and column in the parser's message say where it is.
        let place = match container.is_glb() {
            true => Place::Byte(container.json.start),
            false => Place::File,
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
/// Two files may name the same buffer: see [`shared_buffers`].
///
/// # Errors
/// [`FileError`]: the file cannot be read, is not a glTF, or its JSON is not sound.
pub fn external_buffers(path: &Path, limits: &Limits) -> Result<Vec<PathBuf>, FileError> {
    let format = Format::of_path(path);
    let read = || {
        // A pipe would be waited for.
        if fs::metadata(path).is_ok_and(|data| !data.is_file()) {
            let error = io::Error::other("it is not a file");
            return Err(FileErrorKind::Io(error).at(Place::File));
        }
        // The binary chunk of a GLB may be large, and is of no use here.
        let is_glb = |start: &[u8]| start.starts_with(b"glTF") || format == Some(Format::Glb);
        let end = |start: &[u8]| match is_glb(start) {
            true => Container::json_end(start),
            false => u64::MAX,
        };
        let bytes = read_start(path, limits, end);
        let bytes = bytes.map_err(|kind| kind.at(Place::File))?;
        let container = match is_glb(&bytes) {
            true => Container::of_start(bytes)?,
            false => Container::of_text(bytes),
        };
        let json = read_json(&container, limits)?;
        buffers::external_paths(&Object::new(json.root(), String::new())?, path)
    };
    read().map_err(|problem: Problem| problem.in_file(path, format))
}

/// Refuses a file that says it is not of glTF 2.
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

impl GltfFile {
    fn json(&self) -> &[u8] {
        &self.container.head[self.container.json.clone()]
    }

    fn output(&self) -> Output<'_> {
        Output {
            container: &self.container,
            buffers: &self.buffers,
            uri_spans: &self.view.uri_spans,
        }
    }

    /// Moves the faces of a mesh, but does not write its indices.
    fn move_faces(&mut self, mesh: usize, faces: &FaceOrder) {
        match &self.view.entries.corners[mesh] {
            Corners::Indices(_) => self.view.entries.meshes[mesh].apply_faces(faces),
            // The mesh stays as it is: vertices 0, 1, 2, and so on.
            Corners::Triples(vertices) => {
                let new_to_old = patch::triples(faces);
                for records in vertices {
                    let bytes = self.buffers.bytes_to_change(records.storage);
                    patch::permute(bytes, records, &new_to_old);
                }
            }
        }
    }

    /// Moves the vertices of a group and renumbers them, but does not write the indices of faces.
    fn move_vertices(&mut self, group: usize, order: &VertexOrder) {
        // Vertex data.
        let group = &self.view.entries.groups[group];
        for records in &group.vertices {
            let bytes = self.buffers.bytes_to_change(records.storage);
            patch::permute(bytes, records, order.new_to_old());
        }

        // All that names vertices.
        let old_to_new = order.permutation().old_to_new();
        for records in &group.other_lists {
            let bytes = self.buffers.bytes_to_change(records.storage);
            let numbers = patch::numbers(bytes, records);
            let renumbered = numbers.iter().map(|&old| old_to_new[old as usize]);
            patch::write_numbers(bytes, records, renumbered);
        }
        sparse::renumber(&mut self.buffers, &group.sparse, &old_to_new);
        for &member in &group.meshes {
            self.view.entries.meshes[member].renumber_vertices(&old_to_new);
        }
    }
}

impl fmt::Debug for GltfFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GltfFile")
            .field("bytes", &self.buffers.byte_count())
            .field("meshes", &self.view.entries.meshes.len())
            .finish_non_exhaustive()
    }
}

impl Content for GltfFile {
    fn meshes(&self) -> &[MeshEntry] {
        &self.view.entries.meshes
    }

    fn attributes(&self, mesh: usize) -> Vec<AttributeInfo> {
        self.view.attributes.of_mesh(mesh, self.json())
    }

    fn attribute(&self, mesh: usize, info: &AttributeInfo) -> Result<Attribute, Problem> {
        let vertex_count = self.view.entries.meshes[mesh].mesh.vertex_count();
        self.view
            .attributes
            .read(mesh, info, self.json(), vertex_count, &self.buffers)
    }

    fn store(&self, mesh: usize, info: &AttributeInfo) -> Option<usize> {
        self.view.attributes.store(mesh, info, self.json())
    }

    fn unlisted(&self) -> Vec<Unlisted> {
        self.found_unlisted().into_list()
    }

    fn order(&mut self, mesh: usize, faces: Option<&FaceOrder>, vertices: Option<&VertexOrder>) {
        let mut rewritten = Vec::new();
        if let Some(faces) = faces.filter(|order| !order.is_identity()) {
            self.move_faces(mesh, faces);
            rewritten.push(mesh);
        }
        if let Some(order) = vertices.filter(|order| !order.is_identity()) {
            let group = self.view.entries.meshes[mesh].vertex_group;
            self.move_vertices(group, order);
            rewritten.clone_from(&self.view.entries.groups[group].meshes);
        }

        // Indices are written once for both orders.
        for mesh in rewritten {
            if let Corners::Indices(records) = &self.view.entries.corners[mesh] {
                let bytes = self.buffers.bytes_to_change(records.storage);
                let faces = self.view.entries.meshes[mesh].mesh.faces();
                patch::write_numbers(bytes, records, faces.as_flattened().iter().copied());
            }
        }
    }

    fn select(&mut self, plan: SelectPlan) -> Result<Vec<Note>, Problem> {
        GltfFile::select(self, plan)
    }

    fn append(
        &mut self,
        meshes: &[NewMesh<'_>],
        values: &[NewValue<'_>],
    ) -> Result<Vec<Note>, Problem> {
        GltfFile::append(self, meshes, values)
    }

    fn culling(&self, mesh: usize) -> Option<StoredCulling> {
        let table = self.view.entries.tables.of(mesh)?;
        Some(table.stored(&self.buffers))
    }

    fn each_table(&self, visit: &mut dyn FnMut(PlacedTable<'_>)) -> Result<(), Problem> {
        GltfFile::each_table(self, visit)
    }

    fn damaged_table(&self) -> Option<&Note> {
        self.view.damaged_table.as_ref()
    }

    fn seen_sides(&self) -> Vec<Result<SeenSides, &'static str>> {
        self.found_sides()
    }

    fn cull(&mut self, tables: &[(usize, &StoredCulling)]) -> Result<Vec<Note>, Problem> {
        GltfFile::cull(self, tables)
    }

    fn drawn_scales(&self) -> Vec<f64> {
        self.found_scales()
    }

    fn draws_alike(&self) -> Vec<bool> {
        self.found_alike()
    }

    fn vertices_of_levels(&self) -> Vec<VerticesOfLevels> {
        self.found_vertices_of_levels()
    }

    fn add_levels(&mut self, meshes: &[NewLevels]) -> Result<Vec<Note>, Problem> {
        GltfFile::add_levels(self, meshes)
    }

    fn level_bytes(&self) -> Result<LevelBytes, Problem> {
        GltfFile::level_bytes(self)
    }

    fn stream_layout(&mut self) -> Result<Option<Vec<Note>>, Problem> {
        GltfFile::stream_layout(self)
    }

    fn beside(&self) -> Vec<Beside<'_>> {
        self.output().beside()
    }

    fn companions(&self) -> Vec<PathBuf> {
        self.view.companions.clone()
    }

    fn unread(&self) -> Vec<PathBuf> {
        self.buffers.unread.clone()
    }

    fn unchanged_text(&self) -> Option<&[u8]> {
        self.output().unchanged_text()
    }

    fn files(&self, path: &Path, placed: &[Placed]) -> Result<Vec<OutputFile<'_>>, Problem> {
        self.output().files(path, placed)
    }

    fn size_beside(&self) -> u64 {
        self.buffers.read_size
    }
}
