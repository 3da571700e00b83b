//! An OBJ file of new meshes.

use std::borrow::Cow;

use crate::files::error::Problem;
use crate::files::format::Format;
use crate::files::new_mesh::{NewMesh, in_one_line};
use crate::files::plain_mesh::PlainMesh;
use crate::files::text::{push_float, push_number};

/// The bytes of a file with these meshes, each an object: its `o` line, its vertices, its faces. Vertices are
/// numbered on over all of them.
///
/// # Errors
/// There is more to a mesh than positions and faces, or a position is not finite.
pub(super) fn bytes(meshes: &[NewMesh<'_>]) -> Result<Vec<u8>, Problem> {
    let version = env!("CARGO_PKG_VERSION");
    let mut text = format!("# made by meshweft {version}\n").into_bytes();
    let mut first = 1_u64;
    for (number, mesh) in meshes.iter().enumerate() {
        let in_mesh = |kind| Problem {
            place: mesh.place(number),
            kind,
        };
        let plain = PlainMesh::new(mesh, Format::Obj).map_err(in_mesh)?;
        plain.check_finite(Format::Obj).map_err(in_mesh)?;

        // What it is called. Several meshes need a line between them.
        let mut name = Cow::from(object_name(mesh.name));
        if name.is_empty() && meshes.len() > 1 {
            name = format!("mesh_{number}").into();
        }
        if !name.is_empty() {
            text.extend(format!("o {name}\n").into_bytes());
        }

        // The records.
        for position in plain.positions {
            text.push(b'v');
            for &number in position {
                text.push(b' ');
                push_float(&mut text, number);
            }
            text.push(b'\n');
        }
        for polygon in 0..plain.polygons.len() {
            text.push(b'f');
            for vertex in plain.polygons.of(polygon) {
                text.push(b' ');
                push_number(&mut text, first + u64::from(vertex));
            }
            text.push(b'\n');
        }
        first += plain.positions.len() as u64;
    }
    Ok(text)
}

/// A name as an `o` line holds it: `_` for what ends a line, begins a comment, or joins a line with the next
/// one, and no blanks around it.
fn object_name(name: &str) -> String {
    let mut name = in_one_line(name).replace('#', "_").trim().to_owned();
    if name.ends_with('\\') {
        name.pop();
        name.push('_');
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_stays_on_its_line() {
        for (name, expected) in [
            ("left arm", "left arm"),
            (" a\n\tb\r\n ", "a__b__"),
            ("#1", "_1"),
            ("c:\\meshes\\", "c:\\meshes_"),
            ("a\u{85}b\u{2028}c\0", "a_b_c_"),
            ("Schräge ", "Schräge"),
            ("  ", ""),
        ] {
            assert_eq!(object_name(name), expected);
        }
    }
}
