//! OBJ faces, lines and points on their way to the output.

use std::path::PathBuf;

use super::attributes::ObjAttributes;
use super::materials::KnownMaterials;
use super::unlisted::unlisted;
use crate::attribute::{Attribute, AttributeInfo};
use crate::files::definitions::Definitions;
use crate::files::error::Problem;
use crate::files::rewrite::{Notation, Rewrite, StoredMesh};
use crate::files::slots::Spans;
use crate::files::text::{Tokens, leading_number, push_number};
use crate::files::unlisted::FoundKinds;

/// How corners stand in `f`, `l` and `p` lines.
pub(super) struct ObjNotation {
    /// How many vertices the file has.
    pub(super) vertex_count: usize,
    pub(super) attributes: ObjAttributes,
    /// `v`, `vt` and `vn` lines, as kinds 0, 1 and 2.
    pub(super) definitions: Definitions,
    /// The colors in comments, if any one for each vertex.
    pub(super) colors: Spans,
    /// What the libraries of materials say, and where they are.
    pub(super) materials: KnownMaterials,
}

impl Notation for ObjNotation {
    fn write_face(&self, record: &[u8], rewrite: Rewrite<'_>) {
        rewrite.corners.clear();
        rewrite
            .corners
            .extend(Tokens::of_statement(record, 0).skip(1));
        // Vertices are only renumbered where all of them stand above the first face, so counting
        // back starts at the last one everywhere.
        let vertex_of = |corner: &[u8]| {
            let (number, length) = leading_number(corner)?;
            let number = isize::try_from(number).ok()?;
            let vertex = match number > 0 {
                true => usize::try_from(number - 1).ok()?,
                false => self.vertex_count.checked_add_signed(number)?,
            };
            Some((vertex, length))
        };
        rewrite.write_corners(record, 1, vertex_of);
    }

    fn definitions(&self) -> Option<&Definitions> {
        Some(&self.definitions)
    }

    fn vertex_rows(&self) -> Option<&Spans> {
        (self.colors.len() > 0).then_some(&self.colors)
    }

    /// Numbers that count back become plain ones.
    fn write_settled(&self, record: &[u8], above: [usize; 3], out: &mut Vec<u8>) {
        if !record.contains(&b'-') {
            out.extend_from_slice(record);
            return;
        }
        let mut copied = 0;
        for corner in Tokens::of_statement(record, 0).skip(1) {
            let mut at = corner.start;
            for above in above {
                if let Some((number, length)) = leading_number(&record[at..corner.end]) {
                    let back = usize::try_from(number.unsigned_abs()).ok();
                    let line = back.and_then(|back| above.checked_sub(back));
                    if let (..0, Some(line)) = (number, line) {
                        out.extend_from_slice(&record[copied..at]);
                        push_number(out, line as u64 + 1);
                        copied = at + length;
                    }
                    at += length;
                }
                // Past the `/`.
                at = corner.end.min(at + 1);
            }
        }
        out.extend_from_slice(&record[copied..]);
    }

    fn write_line(&self, line: &[u8], rewrite: Rewrite<'_>) {
        self.write_face(line, rewrite);
    }

    fn companions(&self) -> Vec<PathBuf> {
        self.materials.files.clone()
    }

    fn attributes(&self) -> Vec<AttributeInfo> {
        self.attributes.infos()
    }

    fn attribute(
        &self,
        stored: &StoredMesh<'_>,
        info: &AttributeInfo,
    ) -> Result<Attribute, Problem> {
        self.attributes.read(stored, info)
    }

    fn unlisted(&self, stored: &StoredMesh<'_>) -> FoundKinds {
        unlisted(stored.source, &self.attributes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_count_back_are_settled() {
        let notation = ObjNotation {
            vertex_count: 9,
            attributes: ObjAttributes {
                colors: None,
                texture: None,
                has_normals: false,
            },
            definitions: Definitions::new(),
            colors: Spans::new(),
            materials: KnownMaterials::default(),
        };
        let settled = |record: &str| {
            let mut out = Vec::new();
            notation.write_settled(record.as_bytes(), [7, 5, 3], &mut out);
            String::from_utf8(out).unwrap()
        };
        assert_eq!(
            settled("f -1/-5/-3  2/-1\\\n -7//-1 # -1"),
            "f 7/1/1  2/5\\\n 1//3 # -1"
        );
        assert_eq!(settled("f 1/2/3 +4 -2/"), "f 1/2/3 +4 6/");
    }
}
