//! OFF faces on their way to the output, and what lines hold.

use super::columns::OffColumn;
use super::header::CountSpans;
use super::lines::FreeTokens;
use super::unlisted::unlisted;
use crate::attribute::{Attribute, AttributeInfo};
use crate::files::error::{Problem, no_attribute};
use crate::files::rewrite::{Notation, Rewrite, StoredMesh, vertex_from_zero};
use crate::files::text::whole_number;
use crate::files::unlisted::FoundKinds;

/// How corners stand in face lines: after their number. And what else lines hold.
pub(super) struct OffNotation {
    pub(super) columns: Vec<OffColumn>,
    pub(super) counts: CountSpans,
}

impl Notation for OffNotation {
    fn write_face(&self, record: &[u8], rewrite: Rewrite<'_>) {
        let mut tokens = FreeTokens::new(record, 0);
        let corner_count = tokens.next().and_then(|token| whole_number(&record[token]));
        let corner_count = corner_count.and_then(|n| usize::try_from(n).ok());
        rewrite.corners.clear();
        rewrite
            .corners
            .extend(tokens.take(corner_count.unwrap_or(0)));
        rewrite.write_corners(record, 0, vertex_from_zero);
    }

    fn attributes(&self) -> Vec<AttributeInfo> {
        let infos = self.columns.iter().map(|column| column.info.clone());
        infos.collect()
    }

    fn attribute(
        &self,
        stored: &StoredMesh<'_>,
        info: &AttributeInfo,
    ) -> Result<Attribute, Problem> {
        let mut columns = self.columns.iter();
        let column = columns.find(|column| column.info == *info);
        let column = column.ok_or_else(|| no_attribute(info))?;
        column.read(stored)
    }

    fn unlisted(&self, stored: &StoredMesh<'_>) -> FoundKinds {
        unlisted(
            stored.source,
            [stored.vertices, stored.faces],
            &self.columns,
        )
    }
}
