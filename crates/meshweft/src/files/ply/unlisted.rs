//! What a PLY file holds beside the vertices, faces and numbers that are listed.

use std::collections::BTreeSet;

use super::header::{self, Element, PlyHeader, PropertyKind};
use crate::files::unlisted::FoundKinds;

/// Other elements, and lists of something other than corners; `has_texture`: whether the texture coordinates of faces are
/// listed.
///
/// Time O(header).
pub(super) fn unlisted(source: &[u8], has_texture: bool) -> FoundKinds {
    let mut found = FoundKinds::default();
    // It was read before.
    if let Ok(header) = header::read(source) {
        look(&header, has_texture, &mut found);
    }
    found
}

fn look(header: &PlyHeader, has_texture: bool, found: &mut FoundKinds) {
    for element in &header.elements {
        let is_first = |name| std::ptr::eq(element, header.element(name).unwrap_or(element));
        match element.name.as_str() {
            // Without rows there is nothing.
            _ if element.count == 0 => {}
            "vertex" if is_first("vertex") => properties(element, "vertices", [None; 2], found),
            "face" if is_first("face") => {
                let texture = element.texture_list().filter(|_| has_texture);
                let known = [element.corner_list(), texture];
                properties(element, "faces", known, found);
            }
            name => found.add_named(format!("the element {name:?}")),
        }
    }
}

/// Adds the properties of an element that are not listed, but for the `known` ones.
fn properties(element: &Element, of: &str, known: [Option<usize>; 2], found: &mut FoundKinds) {
    let mut names = BTreeSet::new();
    for (number, property) in element.properties.iter().enumerate() {
        let name = &property.name;
        let is_new = names.insert(name);
        match property.kind {
            _ if known.contains(&Some(number)) => {}
            PropertyKind::List { .. } => {
                found.add_named(format!("the list {name:?} of the {of}"));
            }
            PropertyKind::Scalar(_) if !is_new => {
                found.add_named(format!("a second {name:?} of the {of}"));
            }
            PropertyKind::Scalar(_) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_and_lists_are_found() {
        let header = "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\n\
            property float x\nproperty list uchar int near\nelement face 1\n\
            property list uchar int vertex_indices\nproperty list uchar float texcoord\n\
            property uchar red\nproperty uchar red\nelement edge 2\nproperty int vertex1\n\
            element camera 0\nproperty float view\nend_header\n";
        let found = |has_texture| {
            let list = unlisted(header.as_bytes(), has_texture).into_list();
            list.into_iter().map(|it| it.what).collect::<Vec<_>>()
        };
        let expected = [
            "the list \"near\" of the vertices",
            "the list \"texcoord\" of the faces",
            "a second \"red\" of the faces",
            "the element \"edge\"",
        ];
        assert_eq!(found(false), expected);
        assert_eq!(found(true), [expected[0], expected[2], expected[3]]);
    }
}
