//! What an OFF file holds beside positions, faces and the numbers that are listed.

use super::columns::OffColumn;
use super::lines::FreeTokens;
use crate::attribute::Domain;
use crate::files::slots::Spans;
use crate::files::text::whole_number;
use crate::files::unlisted::FoundKinds;

/// Numbers of vertices and faces that no column has.
///
/// Time O(bytes).
pub(super) fn unlisted(
    source: &[u8],
    [vertices, faces]: [&Spans; 2],
    columns: &[OffColumn],
) -> FoundKinds {
    let known = |domain| {
        let columns = columns.iter().filter(|column| column.info.domain == domain);
        columns.map(|column| column.stored).sum::<usize>()
    };
    let tokens = |spans: &Spans, record| {
        let span = spans.span(record);
        FreeTokens::new(&source[..span.end], span.start)
    };
    let mut found = FoundKinds::default();

    let of_vertices = known(Domain::Vertex);
    let mut records = 0..vertices.len();
    if records.any(|record| tokens(vertices, record).nth(of_vertices).is_some()) {
        found.add("more numbers of vertices than their format has");
    }

    let of_faces = known(Domain::Face);
    let mut records = 0..faces.len();
    let has_more = |record| {
        let mut tokens = tokens(faces, record);
        let corners = tokens.next().and_then(|token| whole_number(&source[token]));
        let corners = corners.and_then(|count| usize::try_from(count).ok());
        tokens
            .nth(corners.unwrap_or(0).saturating_add(of_faces))
            .is_some()
    };
    if records.any(has_more) {
        found.add("colors of some faces");
    }
    found
}
