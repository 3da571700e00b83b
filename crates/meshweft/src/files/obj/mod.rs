//! Wavefront OBJ: `f` lines move within their run, `v` lines as a whole.
//!
//! Two choices were made here:
//!
//! - A vertex is what the *position* number of a corner names (the first of `1/2/3`). So a file has
//!   as many vertices as `v` lines, whatever seams its textures have; texture and normal numbers
//!   stay attached to their corner. A program that makes one GPU vertex of each `1/2/3` sees a few
//!   more misses at seams, in the same order.
//! - A *run* is a stretch of `f` lines of one state: what the statements above them say that hold for
//!   faces (`g`, `o`, `usemtl`, `s`, …), compared by value. A face never leaves its run. Statements
//!   that say nothing new of faces end no run: comments, `mtllib`, a repeated `usemtl`, the `v`, `vt`
//!   and `vn` lines between the faces. Unknown ones do. If the caller wishes, `g` and `o` do not.
//! - Many readers look up at once what a face names, so no face goes above it: where the faces of a
//!   run move, the `v`, `vt` and `vn` lines between them go above the first, in their order, and so
//!   keep their numbers. There, a number that counts back (`-1`) becomes a plain one. Everywhere else
//!   it means the same in all of the run, and is written as a plain number only if its vertex is
//!   renumbered. What an `l` or `p` counts back, and a `v` line below an `o` or `g`, stays below
//!   it: there the run ends.
//!
//! Vertices move only if every `v` line comes before the first `f`, `l` or `p`, or goes above it as
//! said, and nothing in the file may name vertices in a way that is not known here.
//!
//! Comments may hold data in the order of the vertices. `#MRGB` (ZBrush: mask, red, green, blue, two
//! digits each) is known, and the colors go where the vertices go. Of other comments, those of a word
//! and numbers are counted by the word: where there is a line or a number for each vertex, or face, these
//! stay.
//!
//! Transparent faces (material with `d` below 1, `Tr` above 0 or `map_d`) are drawn one over the other:
//! each is a run of its own. The libraries of materials are looked for beside the file; where one is
//! missing, all is taken as opaque, with a note. They and the textures they name come along when the file
//! is written elsewhere.
//!
//! What can be read of it:
//!
//! - The position of a vertex, and its color if every `v` line has one behind the position
//!   (`v x y z r g b` or `v x y z r g b a`; a mix has three components).
//! - The texture coordinates and normals of corners (`f 1/2/3`), if every face names them for every
//!   corner. Texture coordinates have three components where all that are named have, else two; a
//!   second one that a `vt` line leaves out is 0.
//!
//! [`reader`] finds the statements and [`statement`] cuts them, [`runs`] and [`state`] tell which faces
//! may change places, [`comments`] keeps data in comments,
//! [`mod@materials`] and [`paths`] read the other files that it names, [`notation`] writes corners, [`select`] what a
//! selection leaves, [`mod@create`] new meshes, [`attributes`] reads values, [`mod@unlisted`] names the rest.

mod attributes;
mod comments;
mod corners;
mod create;
mod kinds;
mod materials;
mod notation;
mod obstacles;
mod paths;
mod reader;
mod runs;
mod select;
mod state;
mod statement;
mod unlisted;

use crate::Mesh;
use crate::files::bonds::Bonds;
use crate::files::content::ReadResult;
use crate::files::entry::MeshEntry;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::format::Format;
use crate::files::new_mesh::NewMesh;
use crate::files::note::Note;
use crate::files::options::ReadOptions;
use crate::files::orders::RecordOrders;
use crate::files::record_file::{RecordFile, RecordRead};
use crate::files::surroundings::Surroundings;
use crate::files::text::{content_end, line_of, shown};
use materials::KnownMaterials;
use notation::ObjNotation;
use reader::ObjReader;

/// An OBJ file of new meshes.
pub(super) fn create(meshes: &[NewMesh<'_>]) -> ReadResult {
    let bytes = create::bytes(meshes)?;
    read(bytes, Surroundings::Nothing, &ReadOptions::default())
}

/// Reads an OBJ file.
pub(super) fn read(
    bytes: Vec<u8>,
    surroundings: Surroundings<'_>,
    options: &ReadOptions,
) -> ReadResult {
    let (file, notes) = read_file(bytes, Libraries::Read(surroundings), options)?;
    Ok((Box::new(file), notes))
}

/// Where it is told which materials are transparent.
#[derive(Clone, Copy)]
enum Libraries<'a> {
    /// In files that are to be read.
    Read(Surroundings<'a>),
    /// In files that have been read.
    Known(&'a ObjNotation),
}

fn read_file(
    bytes: Vec<u8>,
    libraries: Libraries<'_>,
    options: &ReadOptions,
) -> Result<RecordRead<ObjNotation>, Problem> {
    let mut reader = ObjReader::new(&bytes[..content_end(&bytes)], options);
    reader
        .statements()
        .map_err(|fault| fault.on_its_line(&bytes))?;
    let mut notes = Vec::new();
    let materials = materials(&mut reader, libraries, options, &mut notes);
    reader.check().map_err(|fault| fault.on_its_line(&bytes))?;
    let attributes = reader.attributes();
    let ObjReader {
        vertices,
        faces,
        records,
        runs,
        lines,
        name,
        obstacle,
        face_obstacle,
        bond,
        comments,
        ..
    } = reader;
    let place = |at: usize| Place::Line(line_of(&bytes, at));
    let bond = bond.map(|(at, why)| Note::vertices_stay(place(at), why));
    let face_obstacle = face_obstacle.map(|(at, comments)| {
        let why = format!("the comments {comments:?} may go by their order");
        Note::faces_stay(place(at), why)
    });

    let mut entries = Vec::new();
    if records.len() == 0 {
        notes.push(Note::nothing_to_order());
    } else {
        let vertices_movable = obstacle.is_none();
        if let Some((at, why)) = obstacle {
            notes.push(Note::vertices_stay(place(at), why));
        }
        let faces_movable = face_obstacle.is_none();
        notes.extend(face_obstacle.clone());
        let name = name.map_or_else(
            || "mesh".to_owned(),
            |span| String::from_utf8_lossy(&bytes[span]).into_owned(),
        );
        let mesh = Mesh::connectivity_only(vertices.len(), records.faces);
        let mesh = mesh.map_err(|e| FileErrorKind::malformed(e.to_string()).at(Place::File))?;
        entries.push(MeshEntry {
            name,
            mesh,
            corners_turnable: records.polygons.is_none(),
            level: None,
            polygons: records.polygons,
            runs: runs.starts,
            vertex_group: 0,
            object: 0,
            has_other_faces: false,
            faces_movable,
            vertices_movable,
        });
    }

    let notation = ObjNotation {
        vertex_count: vertices.len(),
        attributes,
        definitions: runs.definitions,
        colors: comments.colors,
        materials,
    };
    let file = RecordFile {
        source: bytes,
        vertices,
        faces,
        companions: Vec::new(),
        lines,
        notation,
        entries,
        orders: RecordOrders::default(),
        bonds: Bonds {
            of_faces: face_obstacle,
            of_vertices: bond,
        },
        options: options.clone(),
        format: Format::Obj,
        read_again: |file, bytes| read_file(bytes, Libraries::Known(&file.notation), &file.options),
    };
    Ok((file, notes))
}

/// Reads the libraries of materials, and keeps transparent faces where they are.
fn materials(
    reader: &mut ObjReader<'_>,
    libraries: Libraries<'_>,
    options: &ReadOptions,
    notes: &mut Vec<Note>,
) -> KnownMaterials {
    let ObjReader { runs, faces, .. } = reader;
    let named = &runs.state.libraries;
    let has_materials = runs.materials().next().is_some();
    let materials = match libraries {
        Libraries::Read(surroundings) => {
            let used = runs.materials();
            KnownMaterials::read(named, used, surroundings, &options.limits)
        }
        Libraries::Known(notation) => notation.materials.clone(),
    };

    if !options.reorder_transparent {
        if let Some((text, path, why)) = materials.unread.as_ref().filter(|_| has_materials) {
            let at = named.get(text.as_slice()).copied().unwrap_or(0);
            let place = Place::Line(line_of(reader.source, at));
            let path = path.display();
            let text = format!(
                "whether materials are transparent cannot be told, so their faces move: {path}: {why}"
            );
            notes.push(Note::new(place, text));
        }
        let kept = runs.keep(faces.len(), |name| materials.is_transparent(name));
        if let Some((count, face, name)) = kept {
            let place = Place::Line(line_of(reader.source, faces.start(face)));
            let why = format!("their material {} is transparent", shown(name));
            let mut note = Note::transparent(place, &why);
            note.more = count - 1;
            notes.push(note);
        }
    }
    materials
}
