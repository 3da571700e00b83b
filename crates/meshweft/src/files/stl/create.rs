//! A binary STL file of a new mesh.

use super::binary::{FACET, HEADER};
use super::facets::normal_of;
use crate::files::error::FileErrorKind;
use crate::files::format::Format;
use crate::files::new_mesh::{NewMesh, in_one_line};
use crate::files::plain_mesh::PlainMesh;
use crate::index::index32;

/// The bytes of a file with this mesh: each face with the positions of its corners, and the normal that they
/// give.
///
/// # Errors
/// There is more to the mesh than positions and faces.
pub(super) fn bytes(mesh: &NewMesh<'_>) -> Result<Vec<u8>, FileErrorKind> {
    let PlainMesh {
        positions, faces, ..
    } = PlainMesh::new(mesh, Format::Stl)?;
    let mut bytes = Vec::with_capacity(HEADER + faces.len() * FACET);
    bytes.extend(header(mesh.name));
    bytes.extend(index32(faces.len()).to_le_bytes());
    for face in faces {
        let corners = face.map(|vertex| positions[vertex as usize]);
        let numbers = normal_of(corners)
            .into_iter()
            .chain(corners.into_iter().flatten());
        bytes.extend(numbers.flat_map(f32::to_le_bytes));
        bytes.extend([0; 2]);
    }
    Ok(bytes)
}

/// The 80 bytes at the start. They must not begin with `solid`, as ascii files do, nor have the `COLOR=` of
/// some programs in them.
fn header(name: &str) -> [u8; HEADER - 4] {
    let name = in_one_line(name).replace('=', "_");
    let mut text = format!("made by meshweft {}", env!("CARGO_PKG_VERSION"));
    if !name.is_empty() {
        text += &format!(": {name}");
    }
    // As many whole characters as there is room for.
    let mut ends = (0..=text.len().min(HEADER - 4)).rev();
    let end = ends.find(|&end| text.is_char_boundary(end)).unwrap_or(0);
    let mut header = [0; HEADER - 4];
    header[..end].copy_from_slice(&text.as_bytes()[..end]);
    header
}
