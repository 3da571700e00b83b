//! OBJ faces, lines and points on their way to the output.

use super::attributes::ObjAttributes;
use crate::attribute::{Attribute, AttributeInfo};
use crate::files::error::Problem;
use crate::files::rewrite::{Notation, Rewrite, StoredMesh};
use crate::files::text::{Tokens, leading_number};

/// How corners stand in `f`, `l` and `p` lines.
pub(super) struct ObjNotation {
    /// How many vertices the file has.
    pub(super) vertex_count: usize,
    pub(super) attributes: ObjAttributes,
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

    fn write_line(&self, line: &[u8], rewrite: Rewrite<'_>) {
        self.write_face(line, rewrite);
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
}
