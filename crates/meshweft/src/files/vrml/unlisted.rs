//! What a VRML file holds beside the face sets that are meshes, and their listed attributes.

use std::collections::BTreeSet;

use super::lexer::{Lexer, Token};
use super::scene::Role;
use crate::attribute::Semantic;
use crate::files::text::{coordinate, shown};
use crate::files::unlisted::FoundKinds;

/// Every type of node but the ones that meshes are made of, and what a face set says of all its faces.
///
/// Time O(bytes).
pub(super) fn unlisted(text: &[u8], at: usize, listed: &BTreeSet<Semantic>) -> FoundKinds {
    let mut found = FoundKinds::default();
    let mut lexer = Lexer::new(text, at);
    // The last words, the nearest first.
    let mut before: [&[u8]; 2] = [b"", b""];
    // It was read before, so each token is sound.
    while let Ok(Some(token)) = lexer.token() {
        let word = match token {
            Token::Word(span) => &text[span],
            Token::Mark(b'{', _) => {
                node(before[0], listed, &mut found);
                b""
            }
            _ => b"",
        };
        match (before[0], word) {
            // Points that several face sets have are in each of them.
            (b"coord", b"USE") => {}
            (_, b"USE") => found.add("nodes that are used again (USE)"),
            (_, b"ROUTE") => found.add("routes (ROUTE)"),
            (_, b"PROTO" | b"EXTERNPROTO") => found.add("prototypes (PROTO)"),
            (b"ccw", b"FALSE") => found.add("faces that look the other way (ccw FALSE)"),
            (b"solid", b"FALSE") => found.add("faces with two sides (solid FALSE)"),
            (b"convex", b"FALSE") => found.add("faces that are not convex (convex FALSE)"),
            (b"creaseAngle", angle) if coordinate(angle) != Some(0.0) => {
                found.add("smoothing (creaseAngle)");
            }
            _ => {}
        }
        before = [word, before[0]];
    }
    found
}

/// Adds a node of this type.
fn node(kind: &[u8], listed: &BTreeSet<Semantic>, found: &mut FoundKinds) {
    let [_, normal, color, texture] = Role::ALL.map(|role| role.names()[1].as_bytes());
    let is_listed = |semantic| listed.contains(&semantic);
    let is_known = match kind {
        b"Shape" | b"IndexedFaceSet" | b"Coordinate" => true,
        _ if kind == normal => is_listed(Semantic::Normal),
        _ if kind == color => is_listed(Semantic::Color(0)),
        _ if kind == texture => is_listed(Semantic::TexCoord(0)),
        _ => false,
    };
    if !is_known {
        found.add_named(format!("the node {}", shown(kind)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_and_what_holds_for_all_faces_are_found() {
        let found = |text: &str| {
            let list =
                unlisted(text.as_bytes(), 0, &BTreeSet::from([Semantic::Normal])).into_list();
            list.into_iter().map(|it| it.what).collect::<Vec<_>>()
        };
        let plain = "DEF a Shape { geometry IndexedFaceSet { coord DEF p Coordinate { point [0 0 0] } \
            solid TRUE creaseAngle 0.0 normal Normal { vector [] } } } \
            Shape { geometry IndexedFaceSet { coord USE p } }";
        assert_eq!(found(plain), [""; 0]);
        for (text, expected) in [
            (
                "Shape { appearance Appearance { } }",
                "the node \"Appearance\"",
            ),
            ("IndexedFaceSet { color Color { } }", "the node \"Color\""),
            (
                "Shape { geometry USE a }",
                "nodes that are used again (USE)",
            ),
            (
                "IndexedFaceSet { solid FALSE }",
                "faces with two sides (solid FALSE)",
            ),
            (
                "IndexedFaceSet { ccw FALSE }",
                "faces that look the other way (ccw FALSE)",
            ),
            (
                "IndexedFaceSet { creaseAngle .5 }",
                "smoothing (creaseAngle)",
            ),
            ("ROUTE a.b TO c.d", "routes (ROUTE)"),
        ] {
            assert_eq!(found(text), [expected], "{text}");
        }
    }
}
