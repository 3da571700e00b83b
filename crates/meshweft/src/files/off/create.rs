//! An OFF file of a new mesh.

use crate::files::error::FileErrorKind;
use crate::files::format::Format;
use crate::files::new_mesh::NewMesh;
use crate::files::plain_mesh::PlainMesh;
use crate::files::text::{push_float, push_number};

/// The bytes of a file with this mesh: a line for each vertex and each face, and nothing else, so that the
/// simplest readers take it.
///
/// # Errors
/// There is more to the mesh than positions and faces, or a position is not finite.
pub(super) fn bytes(mesh: &NewMesh<'_>) -> Result<Vec<u8>, FileErrorKind> {
    let mesh = PlainMesh::new(mesh, Format::Off)?;
    mesh.check_finite(Format::Off)?;

    // The header. Edges are counted by few programs, and 0 stands for that.
    let mut text = b"OFF\n".to_vec();
    push_number(&mut text, mesh.positions.len() as u64);
    text.push(b' ');
    push_number(&mut text, mesh.polygons.len() as u64);
    text.extend(b" 0\n");

    // The records.
    for position in mesh.positions {
        for (axis, &number) in position.iter().enumerate() {
            text.extend(if axis == 0 { &b""[..] } else { b" " });
            push_float(&mut text, number);
        }
        text.push(b'\n');
    }
    for polygon in 0..mesh.polygons.len() {
        push_number(&mut text, mesh.polygons.count(polygon) as u64);
        for vertex in mesh.polygons.of(polygon) {
            text.push(b' ');
            push_number(&mut text, vertex.into());
        }
        text.push(b'\n');
    }
    Ok(text)
}
