//! Object File Format (Geomview), ascii: vertex lines and face lines move.
//!
//! The format is free: line ends are blanks, but for the colour of a face, which ends with its line. So
//! a file is read by the first of these ways that reads all of it:
//!
//! 1. Each vertex has a line of its own, as nearly every writer has it. Each face starts on a line of its
//!    own, goes on over as many as it needs, and ends with the line of its last corner. The numbers after
//!    those that are needed (colours of faces, or what a program adds to a vertex) go along.
//! 2. A vertex is as many numbers as the keyword says (with `C`, a colour of four), wherever lines end;
//!    faces as before.
//! 3. The same, and a face is its number of corners and the corners; nothing follows the last one.
//!
//! A comment within a record goes along with it, others stay. The keyword may be missing or stand right
//! before the first count; the number of edges may be missing or wrong, as in many files that are around.
//! Moved records must be read as they were: where the numbers of lines do not exclude an earlier way,
//! everything stays where it is, with a note.
//!
//! Attributes, where the format leaves room:
//!
//! - Positions and normals have three components: the first three numbers (of `4OFF` too, whose
//!   fourth is one to divide by), and zeros where there are fewer.
//! - Colours are the numbers that `COFF` puts last, and those after the corners of faces, if all
//!   lines have three or all have four. If every one is a whole number from 0 to 255 they are bytes
//!   that stand for fractions, else numbers as they are written. A single number is an entry in a
//!   table that is not in the file, and is not listed.
//! - Texture coordinates come after the colours, so they are listed if the colours are, or there
//!   are none.

mod columns;
mod create;
mod header;
mod lines;
mod notation;
mod records;
mod select;
mod unlisted;

use super::bonds::Bonds;
use super::content::ReadResult;
use super::entry::MeshEntry;
use super::error::{FileErrorKind, Place, Problem};
use super::format::Format;
use super::new_mesh::{self, NewMesh};
use super::note::Note;
use super::options::ReadOptions;
use super::orders::RecordOrders;
use super::record_file::{RecordFile, RecordRead};
use super::slots::Spans;
use super::text::content_end;
use crate::Mesh;
use crate::index::index32;
use lines::Lines;
use notation::OffNotation;
use records::{FaceLines, OffRecords};

/// An OFF file of a new mesh.
pub(super) fn create(meshes: &[NewMesh<'_>]) -> ReadResult {
    let mesh = new_mesh::only(meshes, Format::Off)?;
    let bytes = create::bytes(mesh).map_err(|kind| kind.at(mesh.place(0)))?;
    read(bytes, &ReadOptions::default())
}

/// Reads an OFF file.
pub(super) fn read(bytes: Vec<u8>, options: &ReadOptions) -> ReadResult {
    let (file, notes) = read_file(bytes, options)?;
    Ok((Box::new(file), notes))
}

fn read_file(bytes: Vec<u8>, options: &ReadOptions) -> Result<RecordRead<OffNotation>, Problem> {
    let limits = &options.limits;
    let mark = b"\xef\xbb\xbf";
    let text = &bytes[..content_end(&bytes)];
    let mut lines = Lines {
        text,
        at: if bytes.starts_with(mark) {
            mark.len()
        } else {
            0
        },
    };
    let header = header::header(&mut lines, limits)?;
    let OffRecords {
        vertices,
        vertex_colours,
        faces:
            FaceLines {
                spans: faces,
                records,
                colours,
            },
        stays,
    } = records::read(text, &header, limits)?;

    let (mut entries, mut notes) = (Vec::new(), Vec::new());
    if records.len() == 0 {
        notes.push(Note::nothing_to_order());
    } else {
        let mesh = Mesh::connectivity_only(vertices.len(), records.faces);
        let mesh = mesh.map_err(|e| FileErrorKind::malformed(e.to_string()).at(Place::File))?;
        entries.push(MeshEntry {
            name: "mesh".into(),
            mesh,
            // Where faces must stay, each is a run of its own.
            runs: match stays {
                true => (0..index32(faces.len())).collect(),
                false => vec![0],
            },
            vertex_group: 0,
            object: 0,
            has_other_faces: false,
            faces_movable: !stays,
            vertices_movable: !stays,
            corners_turnable: !stays && records.polygons.is_none(),
            level: None,
            polygons: records.polygons,
        });
        if stays {
            let text = "the faces and vertices stay where they are: some share a line and others \
                        go over several, so moved ones might be read as others. Write one on each line";
            notes.push(Note::new(Place::File, text));
        }
    }

    let file = RecordFile {
        source: bytes,
        vertices,
        faces,
        companions: Vec::new(),
        lines: Spans::new(),
        notation: OffNotation {
            columns: columns::columns(&header, &vertex_colours, &colours),
            counts: header.counts,
        },
        entries,
        orders: RecordOrders::default(),
        bonds: Bonds::default(),
        options: options.clone(),
        format: Format::Off,
        read_again: |file, bytes| read_file(bytes, &file.options),
    };
    Ok((file, notes))
}
