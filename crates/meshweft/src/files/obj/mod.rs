//! Wavefront OBJ: `f` lines move within their run, `v` lines as a whole.
//!
//! Two choices were made here:
//!
//! - A vertex is what the *position* number of a corner names (the first of `1/2/3`). So a file has
//!   as many vertices as `v` lines, whatever seams its textures have; texture and normal numbers
//!   stay attached to their corner. A program that makes one GPU vertex of each `1/2/3` sees a few
//!   more misses at seams, in the same order.
//! - A *run* is a stretch of `f` lines with nothing between but blank lines and comments. Any other
//!   statement (`g`, `o`, `usemtl`, `s`, `v`, `l`, …) ends it, because what it says holds for the
//!   faces after it. A face never leaves its run, so a number that counts back (`-1`) means the
//!   same wherever the face goes; it is written as a plain number only if its vertex is renumbered.
//!   If the caller wishes, `g` and `o` do not end a run.
//!
//! Vertices move only if every `v` line comes before the first `f`, `l` or `p`, and nothing in the
//! file may name vertices in a way that is not known here.
//!
//! What can be read of it:
//!
//! - The position of a vertex, and its color if every `v` line has one behind the position
//!   (`v x y z r g b` or `v x y z r g b a`; a mix has three components).
//! - The texture coordinates and normals of corners (`f 1/2/3`), if every face names them for every
//!   corner. Texture coordinates have three components where all that are named have, else two; a
//!   second one that a `vt` line leaves out is 0.
//!
//! [`reader`] finds the statements and [`statement`] cuts them, [`notation`] writes corners,
//! [`attributes`] reads values.

mod attributes;
mod notation;
mod reader;
mod statement;

use crate::Mesh;
use crate::files::content::ReadResult;
use crate::files::entry::MeshEntry;
use crate::files::error::{FileErrorKind, Place};
use crate::files::note::Note;
use crate::files::options::ReadOptions;
use crate::files::orders::RecordOrders;
use crate::files::record_file::RecordFile;
use crate::files::text::line_of;
use notation::ObjNotation;
use reader::ObjReader;

/// Reads an OBJ file.
pub(super) fn read(bytes: Vec<u8>, options: &ReadOptions) -> ReadResult {
    let mut reader = ObjReader::new(&bytes, options);
    reader
        .statements()
        .map_err(|fault| fault.on_its_line(&bytes))?;
    reader
        .check_range()
        .map_err(|fault| fault.on_its_line(&bytes))?;
    let attributes = reader.attributes();
    let ObjReader {
        vertices,
        faces,
        records,
        runs,
        lines,
        name,
        obstacle,
        ..
    } = reader;

    let mut notes = Vec::new();
    let mut entries = Vec::new();
    if records.len() == 0 {
        notes.push(Note::nothing_to_order());
    } else {
        let vertices_movable = obstacle.is_none();
        if let Some((at, why)) = obstacle {
            let place = Place::Line(line_of(&bytes, at));
            notes.push(Note::vertices_stay(place, why));
        }
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
            polygons: records.polygons,
            runs,
            vertex_group: 0,
            faces_movable: true,
            vertices_movable,
        });
    }

    let notation = ObjNotation {
        vertex_count: vertices.len(),
        attributes,
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
    };
    Ok((Box::new(file), notes))
}
