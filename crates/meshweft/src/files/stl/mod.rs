//! STL, binary or ascii: facets move, each with its normal and its attribute bytes.
//!
//! Three choices were made here:
//!
//! - STL stores no vertices, only positions. Corners whose three numbers have the same bits are
//!   one vertex, and vertices are numbered by these bits: a mesh keeps its numbers whatever order
//!   its facets are in. Vertices cannot be moved, as there are none in the file.
//! - A file is binary unless it starts with `solid`; one that does is binary all the same if its
//!   length is what a binary file of that count has, or if there is a zero byte in the count,
//!   which text has not. Many programs begin the header of a binary file with `solid`.
//! - Each `solid` of an ascii file is a *run*: a facet never leaves it. A corner is turned by
//!   exchanging the three positions of its facet.
//!
//! Attributes: the position of each vertex, and of each face its normal as it is stored, whatever
//! that is; of a binary file also the two bytes at the end of a facet, as a number.
//!
//! [`mod@ascii`] and [`binary`] find the [`facets`], [`attributes`] reads their values, and [`select`]
//! writes those that a selection leaves, [`mod@create`] those of a new mesh.

mod ascii;
mod attributes;
mod binary;
mod create;
mod facets;
mod select;

use std::collections::HashMap;

use super::bonds::Bonds;
use super::content::ReadResult;
use super::entry::MeshEntry;
use super::error::{FileErrorKind, Place, Problem};
use super::face_records::{FaceRecords, check_vertex_count};
use super::format::Format;
use super::new_mesh::{self, NewMesh};
use super::note::Note;
use super::options::ReadOptions;
use super::orders::RecordOrders;
use super::record_file::{ReadAgain, RecordFile, RecordRead};
use super::slots::Spans;
use crate::Mesh;
use crate::index::index32;
use crate::limits::Limits;
use ascii::AsciiNotation;
use binary::BinaryNotation;
use facets::Facets;

/// A binary STL file of a new mesh.
pub(super) fn create(meshes: &[NewMesh<'_>]) -> ReadResult {
    let mesh = new_mesh::only(meshes, Format::Stl)?;
    let bytes = create::bytes(mesh).map_err(|kind| kind.at(mesh.place(0)))?;
    read(bytes, &ReadOptions::default())
}

/// Reads an STL file.
///
/// Time O(bytes + vertices log vertices), memory a few times the bytes.
pub(super) fn read(bytes: Vec<u8>, options: &ReadOptions) -> ReadResult {
    match ascii::start(&bytes) {
        Some(at) if !binary::is_sure(&bytes) => {
            let (file, notes) = read_ascii(bytes, at, options)?;
            Ok((Box::new(file), notes))
        }
        _ => {
            let (file, notes) = read_binary(bytes, options)?;
            Ok((Box::new(file), notes))
        }
    }
}

fn read_ascii(
    bytes: Vec<u8>,
    at: usize,
    options: &ReadOptions,
) -> Result<RecordRead<AsciiNotation>, Problem> {
    let facets = ascii::read(&bytes, at, &options.limits)?;
    file(
        bytes,
        facets,
        AsciiNotation,
        options,
        |file, bytes| match ascii::start(&bytes).filter(|_| !binary::is_sure(&bytes)) {
            Some(at) => read_ascii(bytes, at, &file.options),
            None => Err(another_kind()),
        },
    )
}

fn read_binary(
    bytes: Vec<u8>,
    options: &ReadOptions,
) -> Result<RecordRead<BinaryNotation>, Problem> {
    let facets = binary::read(&bytes, &options.limits)?;
    file(
        bytes,
        facets,
        BinaryNotation,
        options,
        |file, bytes| match ascii::start(&bytes).is_some() && !binary::is_sure(&bytes) {
            true => Err(another_kind()),
            false => read_binary(bytes, &file.options),
        },
    )
}

/// The problem of a file that is not what it was any more.
fn another_kind() -> Problem {
    let text = "it could be taken for ascii or for binary: begin it with another word than solid";
    FileErrorKind::malformed(text).at(Place::File)
}

fn file<N>(
    source: Vec<u8>,
    facets: Facets,
    notation: N,
    options: &ReadOptions,
    read_again: ReadAgain<N>,
) -> Result<RecordRead<N>, Problem> {
    let limits = &options.limits;
    let (mut entries, mut notes) = (Vec::new(), Vec::new());
    if facets.corners.is_empty() {
        notes.push(Note::nothing_to_order());
    } else {
        let mesh = welded(&facets.corners, limits).map_err(|kind| kind.at(Place::File))?;
        entries.push(MeshEntry {
            name: facets.name,
            mesh,
            polygons: None,
            runs: facets.runs,
            vertex_group: 0,
            object: 0,
            has_other_faces: false,
            faces_movable: true,
            vertices_movable: false,
            corners_turnable: true,
            level: None,
        });
    }

    let file = RecordFile {
        source,
        vertices: Spans::new(),
        faces: facets.spans,
        companions: Vec::new(),
        lines: Spans::new(),
        notation,
        entries,
        orders: RecordOrders::default(),
        bonds: Bonds::default(),
        options: options.clone(),
        read_again,
        format: Format::Stl,
    };
    Ok((file, notes))
}

/// The mesh in which positions of the same bits are one vertex; vertices are sorted by bits.
fn welded(facets: &[[[u32; 3]; 3]], limits: &Limits) -> Result<Mesh, FileErrorKind> {
    // Only looked up, never iterated: the order of its entries does not matter.
    let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
    let mut unique = Vec::new();
    let mut records = FaceRecords::default();
    records.reserve(facets.len(), size_of_val(facets));
    for facet in facets {
        let face = facet.map(|bits| {
            *numbers.entry(bits).or_insert_with(|| {
                unique.push((bits, index32(unique.len())));
                index32(unique.len() - 1)
            })
        });
        check_vertex_count(unique.len(), limits)?;
        records.push(&face, limits)?;
    }

    // Numbers by bits, so that they do not depend on the order of facets.
    drop(numbers);
    unique.sort_unstable();
    let mut sorted_of = vec![0; unique.len()];
    for (sorted, (_, first)) in (0_u32..).zip(&unique) {
        sorted_of[*first as usize] = sorted;
    }
    for vertex in records.faces.as_flattened_mut() {
        *vertex = sorted_of[*vertex as usize];
    }

    let mesh = Mesh::connectivity_only(unique.len(), records.faces);
    mesh.map_err(|error| FileErrorKind::malformed(error.to_string()))
}
