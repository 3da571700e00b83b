//! Stanford PLY, ascii and binary: rows of the `vertex` and `face` elements move.
//!
//! A row moves with everything in it, so properties that are not known stay with their vertex or
//! face. Three things may hang on an order without saying so, and keep what they hang on where
//! it is:
//!
//! - another element may name vertices by number (edges, strips), so the vertices stay;
//! - another element may name faces or stand beside them row by row, so the faces stay, except for
//!   `multi_texture_face`, whose rows are known to go with the faces;
//! - a face property may be about one corner or one edge, so corners are turned only where every
//!   property is known to be about the face as a whole.
//!
//! Every property that is one number can be read, of vertices and of faces. These have a meaning:
//!
//! | properties | attribute |
//! |---|---|
//! | `x y z`, of vertices | position |
//! | `nx ny nz` | normal |
//! | `red green blue`, `r g b`, `diffuse_red` …, each with or without its alpha | color |
//! | `s t`, `u v`, `texture_u texture_v` | texture coordinate |
//! | the list `texcoord` of the faces, two numbers a corner in every face | texture coordinate of corners |
//!
//! A second color or texture coordinate has the next number. Numbers keep their type; where the
//! types of one attribute differ, they become `float` if that holds them all, else `double`. The
//! whole numbers without a sign of a color are fractions of the largest.
//!
//! [`header`] says what is in the file, [`plan`] what may move, [`rows`] reads values and [`body`]
//! whole elements, [`notation`] writes corners, [`attributes`] reads what is stored with them, as
//! the types of [`number`]; [`mod@unlisted`] names the rest. [`select`] writes what a selection leaves. [`strips`] makes faces of strips, [`mod@create`] a file of a new mesh.

mod attributes;
mod body;
mod create;
mod header;
mod notation;
mod number;
mod plan;
mod rows;
mod select;
mod strips;
mod unlisted;

use crate::Mesh;
use crate::files::bonds::Bonds;
use crate::files::content::ReadResult;
use crate::files::entry::MeshEntry;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::face_records::{check_face_count, check_vertex_count};
use crate::files::format::Format;
use crate::files::new_mesh::{self, NewMesh};
use crate::files::note::Note;
use crate::files::options::ReadOptions;
use crate::files::orders::RecordOrders;
use crate::files::record_file::{RecordFile, RecordRead};
use crate::files::slots::Spans;
use crate::files::text::line_of;
use crate::index::index32;
use body::Body;
use header::{Element, Encoding, PlyHeader};
use notation::PlyNotation;
use plan::Plan;
use rows::{Ascii, Binary};

/// A PLY file of a new mesh.
pub(super) fn create(meshes: &[NewMesh<'_>]) -> ReadResult {
    let mesh = new_mesh::only(meshes, Format::Ply)?;
    let bytes = create::bytes(mesh).map_err(|kind| kind.at(mesh.place(0)))?;
    read(bytes, &ReadOptions::default())
}

/// Reads a PLY file.
pub(super) fn read(bytes: Vec<u8>, options: &ReadOptions) -> ReadResult {
    let (file, notes) = read_file(bytes, options)?;
    Ok((Box::new(file), notes))
}

fn read_file(bytes: Vec<u8>, options: &ReadOptions) -> Result<RecordRead<PlyNotation>, Problem> {
    let limits = &options.limits;
    let header = header::read(&bytes)?;
    if options.strips_to_lists
        && let Some((bytes, note)) = strips::to_faces(&bytes, &header, limits)?
    {
        let mut options = options.clone();
        options.strips_to_lists = false;
        let (file, mut notes) = read_file(bytes, &options)?;
        notes.insert(0, note);
        return Ok((file, notes));
    }
    let plan = Plan::new(&header, options)?;
    let at_header = |element: &Element, kind: FileErrorKind| kind.at(Place::Line(element.line));
    if let Some(element) = header.element("vertex") {
        check_vertex_count(element.count, limits).map_err(|kind| at_header(element, kind))?;
    }
    if let Some(element) = header.element("face") {
        check_face_count(element.count, limits).map_err(|kind| at_header(element, kind))?;
    }

    let source = bytes.as_slice();
    let read = match header.encoding {
        Encoding::Ascii => {
            let rows = Ascii::new(source, header.body);
            body::read(rows, &header, &plan, limits)
        }
        Encoding::LittleEndian => {
            let rows = Binary::<false>::new(source, header.body);
            body::read(rows, &header, &plan, limits)
        }
        Encoding::BigEndian => {
            let rows = Binary::<true>::new(source, header.body);
            body::read(rows, &header, &plan, limits)
        }
    };
    let body = read.map_err(|fault| {
        fault.kind.at(match header.encoding {
            Encoding::Ascii => Place::Line(line_of(&bytes, fault.at)),
            _ => Place::Byte(fault.at),
        })
    })?;
    finish(bytes, header, plan, body, options)
}

fn finish(
    bytes: Vec<u8>,
    header: PlyHeader,
    plan: Plan,
    body: Body,
    options: &ReadOptions,
) -> Result<RecordRead<PlyNotation>, Problem> {
    let mut notes: Vec<Note> = header.foreign.iter().cloned().collect();
    let mut entries = Vec::new();
    let record_count = body.records.len();
    if record_count == 0 {
        notes.push(match header.element("tristrips") {
            Some(strips) => Note::new(
                Place::Line(strips.line),
                "triangle strips stay as they are; strips_to_lists makes faces of them",
            ),
            None => Note::nothing_to_order(),
        });
    } else {
        let mesh = Mesh::connectivity_only(body.vertices.len(), body.records.faces);
        let mesh = mesh.map_err(|e| FileErrorKind::malformed(e.to_string()).at(Place::File))?;
        let faces_move = plan.face_obstacle.is_none();
        entries.push(MeshEntry {
            name: "mesh".into(),
            mesh,
            corners_turnable: plan.corners_turnable
                && faces_move
                && body.records.polygons.is_none(),
            level: None,
            polygons: body.records.polygons,
            // Where faces must stay, each is a run of its own.
            runs: match faces_move {
                true => vec![0],
                false => (0..index32(record_count)).collect(),
            },
            vertex_group: 0,
            object: 0,
            has_other_faces: header.element("tristrips").is_some(),
            faces_movable: true,
            vertices_movable: plan.vertex_obstacle.is_none(),
        });
        let obstacles = [&plan.vertex_obstacle, &plan.face_obstacle];
        notes.extend(obstacles.into_iter().flatten().cloned());
    }

    let file = RecordFile {
        source: bytes,
        vertices: body.vertices,
        faces: body.faces,
        lines: Spans::new(),
        notation: PlyNotation::new(header, !body.companions.is_empty(), body.has_texture),
        companions: body.companions,
        entries,
        orders: RecordOrders::default(),
        // What may name them by number, or go by their order, would be wrong.
        bonds: Bonds {
            of_faces: plan.face_obstacle,
            of_vertices: plan.vertex_obstacle,
        },
        options: options.clone(),
        format: Format::Ply,
        read_again: |file, bytes| read_file(bytes, &file.options),
    };
    Ok((file, notes))
}
