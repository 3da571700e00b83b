//! What the library reads of a file, for programs that compare it with what other readers read.
//!
//!   cargo run --release --bin attributes FILE [VALUES]
//!
//! Prints one JSON object a line: one for each mesh, one for each of its attributes, then one for
//! each note. The file VALUES gets all numbers, little-endian: in the order of the lines, and as many
//! bytes as the line says, the faces of a mesh (three `u32` each) and the values of an attribute.
//!
//! Exits with 1 if the file is refused.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::process::ExitCode;

use meshweft::Limits;
use meshweft::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Values};
use meshweft::files::{Document, FileError, MeshEntry};
use serde_json::{Value, json};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (file, values) = match arguments.as_slice() {
        [file] => (file, None),
        [file, values] => (file, Some(values)),
        _ => {
            eprintln!("usage: attributes FILE [VALUES]");
            return ExitCode::from(2);
        }
    };
    let document = match Document::open(Path::new(file), Limits::default()) {
        Ok(document) => document,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };

    let values: std::io::Result<Box<dyn Write>> = match values {
        Some(path) => File::create(path).map(|file| Box::new(BufWriter::new(file)) as _),
        None => Ok(Box::new(std::io::sink())),
    };
    let printed = values.and_then(|values| print(&document, values));
    compare::exit_code(printed.map_err(|error| error.to_string()))
}

/// Prints all lines, and writes all numbers.
fn print(document: &Document, mut values: impl Write) -> std::io::Result<()> {
    let mut out = BufWriter::new(std::io::stdout().lock());
    for (mesh, entry) in document.meshes().iter().enumerate() {
        let bytes = little_endian(entry.mesh.faces().as_flattened(), |v| v.to_le_bytes());
        writeln!(out, "{}", mesh_line(mesh, entry, bytes.len()))?;
        values.write_all(&bytes)?;

        for info in document.attributes(mesh) {
            let read = document.attribute(mesh, &info);
            let bytes = read.as_ref().map(bytes_of).unwrap_or_default();
            writeln!(out, "{}", attribute_line(mesh, &info, &read, bytes.len()))?;
            values.write_all(&bytes)?;
        }
    }
    for note in document.notes() {
        let place = note.place.to_string();
        let line = json!({ "note": note.text, "place": place, "more": note.more });
        writeln!(out, "{line}")?;
    }
    values.flush()?;
    out.flush()
}

fn mesh_line(mesh: usize, entry: &MeshEntry, bytes: usize) -> Value {
    json!({
        "mesh": mesh,
        "name": entry.name,
        "vertices": entry.mesh.vertex_count(),
        "faces": entry.mesh.face_count(),
        "bytes": bytes,
    })
}

fn attribute_line(
    mesh: usize,
    info: &AttributeInfo,
    read: &Result<Attribute, FileError>,
    bytes: usize,
) -> Value {
    let domain = match info.domain {
        Domain::Vertex => "vertex",
        Domain::Corner => "corner",
        Domain::Face => "face",
        _ => "unknown",
    };
    let kind = match info.component_type {
        ComponentType::I8 => "i1",
        ComponentType::U8 => "u1",
        ComponentType::I16 => "i2",
        ComponentType::U16 => "u2",
        ComponentType::I32 => "i4",
        ComponentType::U32 => "u4",
        ComponentType::F32 => "f4",
        ComponentType::F64 => "f8",
        _ => "unknown",
    };
    json!({
        "mesh": mesh,
        "attribute": info.semantic.to_string(),
        "target": info.morph_target,
        "domain": domain,
        "components": info.components,
        "type": kind,
        "normalized": info.is_normalized,
        "count": read.as_ref().map_or(0, Attribute::len),
        "error": read.as_ref().err().map(ToString::to_string),
        "bytes": bytes,
    })
}

fn bytes_of(attribute: &Attribute) -> Vec<u8> {
    match &attribute.values {
        Values::I8(values) => little_endian(values, |v| v.to_le_bytes()),
        Values::U8(values) => values.clone(),
        Values::I16(values) => little_endian(values, |v| v.to_le_bytes()),
        Values::U16(values) => little_endian(values, |v| v.to_le_bytes()),
        Values::I32(values) => little_endian(values, |v| v.to_le_bytes()),
        Values::U32(values) => little_endian(values, |v| v.to_le_bytes()),
        Values::F32(values) => little_endian(values, |v| v.to_le_bytes()),
        Values::F64(values) => little_endian(values, |v| v.to_le_bytes()),
        other => unreachable!("values of type {:?}", other.component_type()),
    }
}

fn little_endian<T: Copy, const WIDTH: usize>(
    values: &[T],
    bytes: impl Fn(T) -> [u8; WIDTH],
) -> Vec<u8> {
    values.iter().flat_map(|&value| bytes(value)).collect()
}
