//! What an OBJ file holds beside the name of its object, positions, faces and listed attributes.

use super::attributes::ObjAttributes;
use super::comments::Comments;
use super::statement::{Piece, Statements, attribute_numbers};
use crate::files::options::ReadOptions;
use crate::files::text::{Tokens, leading_number, shown};
use crate::files::unlisted::FoundKinds;

/// A walk through a file that was read.
struct ObjKinds<'a> {
    source: &'a [u8],
    attributes: &'a ObjAttributes,
    found: FoundKinds,
    vertex_count: usize,
    face_count: usize,
    /// The name that is kept.
    object: Option<&'a [u8]>,
}

/// Time O(bytes).
pub(super) fn unlisted(source: &[u8], attributes: &ObjAttributes) -> FoundKinds {
    let mut walk = ObjKinds {
        source,
        attributes,
        found: FoundKinds::default(),
        vertex_count: 0,
        face_count: 0,
        object: None,
    };

    // Statements, and comments for what they hold together.
    let mut comments = Comments::new(source);
    let mut pieces = Statements::new(source);
    while let Some(piece) = pieces.next_piece() {
        match piece {
            Piece::Statement(span) => {
                let mut tokens = Tokens::of_statement(&source[..span.end], span.start);
                if let Some(keyword) = tokens.next() {
                    walk.statement(&source[keyword], tokens);
                }
            }
            // Too many to be kept: they were read before.
            Piece::Comment(span) => {
                let _ = comments.comment(span);
            }
        }
    }
    walk.comments(&comments);
    walk.found
}

impl<'a> ObjKinds<'a> {
    fn statement(&mut self, keyword: &[u8], mut tokens: Tokens<'a>) {
        let source = self.source;
        let rest = |mut tokens: Tokens<'a>| {
            let first = tokens.next()?;
            let end = tokens.last().map_or(first.end, |last| last.end);
            Some(&source[first.start..end])
        };
        match keyword {
            b"v" => {
                self.vertex_count += 1;
                if self.attributes.colors.is_none() && tokens.nth(3).is_some() {
                    self.found.add("more than three numbers of a vertex (v)");
                }
            }
            b"f" => self.face(tokens),
            b"vt" if self.attributes.texture.is_none() => {
                self.found.add("texture coordinates (vt)");
            }
            b"vn" if !self.attributes.has_normals => self.found.add("normals (vn)"),
            b"vt" | b"vn" => {}
            b"o" => {
                let Some(name) = rest(tokens) else { return };
                let is_only = *self.object.get_or_insert(name) == name;
                if !is_only || self.face_count > 0 {
                    self.found.add("several objects (o)");
                }
            }
            // What holds for all faces if nothing is said.
            b"g" if matches!(rest(tokens.clone()), None | Some(b"default")) => {}
            b"s" if matches!(rest(tokens.clone()), None | Some(b"off" | b"0")) => {}
            b"g" => self.found.add("groups (g)"),
            b"s" => self.found.add("smoothing groups (s)"),
            b"usemtl" => self.found.add("materials (usemtl)"),
            // A library says nothing of faces before one asks for a material.
            b"mtllib" => {}
            b"l" => self.found.add("lines (l)"),
            b"p" => self.found.add("points (p)"),
            other => self
                .found
                .add_named(format!("the statement {}", shown(other))),
        }
    }

    /// Some corners may name what others do not.
    fn face(&mut self, corners: Tokens<'_>) {
        self.face_count += 1;
        let has_texture = self.attributes.texture.is_some();
        if has_texture && self.attributes.has_normals {
            return;
        }
        for corner in corners {
            let corner = &self.source[corner];
            let length = leading_number(corner).map_or(0, |(_, length)| length);
            let [texture, normal] = attribute_numbers(&corner[length..]).unwrap_or_default();
            if texture.is_some() && !has_texture {
                self.found.add("texture coordinates (vt)");
            }
            if normal.is_some() && !self.attributes.has_normals {
                self.found.add("normals (vn)");
            }
        }
    }

    /// Comments with data for each vertex or face. Of one or two of these, any comment could be.
    fn comments(&mut self, comments: &Comments<'_>) {
        let is_wrong = || comments.vertex_obstacle(self.vertex_count).is_some();
        if comments.colors.len() > 0 || is_wrong() {
            self.found.add("colors in comments (#MRGB)");
        }
        for count in [self.vertex_count, self.face_count] {
            let data = comments.unknown(count, &ReadOptions::default());
            if let Some((_, word)) = data.filter(|_| count > 2) {
                let what = format!("as many numbers in comments {word:?} as vertices or faces");
                self.found.add_named(what);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is found in a file with no attributes for all vertices or corners.
    fn found(text: &str) -> Vec<String> {
        let attributes = ObjAttributes {
            colors: None,
            texture: None,
            has_normals: false,
        };
        let list = unlisted(text.as_bytes(), &attributes).into_list();
        list.into_iter().map(|it| it.what).collect()
    }

    #[test]
    fn whatever_is_said_of_some_faces_is_found() {
        let nothing =
            "# by hand\nmtllib a.mtl\no a\no a\ng\ng default\ns off\ns 0\ns\nv 0 0 0\nf 1 1 1\n";
        assert_eq!(found(nothing), [""; 0]);
        for (text, expected) in [
            ("f 1 1 1\no late\n", "several objects (o)"),
            ("o a\no b\n", "several objects (o)"),
            ("g wheel\n", "groups (g)"),
            ("s 1\n", "smoothing groups (s)"),
            ("usemtl red\n", "materials (usemtl)"),
            ("l 1 1\n", "lines (l)"),
            ("p 1\n", "points (p)"),
            ("vt 0 0\n", "texture coordinates (vt)"),
            ("f 1 1/1 1\n", "texture coordinates (vt)"),
            ("vn 0 0 1\n", "normals (vn)"),
            ("f 1//1 1 1\n", "normals (vn)"),
            ("v 0 0 0 1\n", "more than three numbers of a vertex (v)"),
            ("vp 1\n", "the statement \"vp\""),
            ("#MRGB ff00ff00\n", "colors in comments (#MRGB)"),
        ] {
            assert_eq!(found(&format!("v 0 0 0\n{text}")), [expected], "{text}");
        }
        let bones = "v 0 0 0\nv 0 0 1\nv 0 1 0\n#bone 1\n#bone 1\n#bone 2\n";
        let text = "as many numbers in comments \"bone\" as vertices or faces";
        assert_eq!(found(bones), [text]);
    }
}
