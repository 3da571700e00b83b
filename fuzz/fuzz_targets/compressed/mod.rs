//! A document that was read is compressed as it is, or refused for a reason.

use meshweft::connectivity::FirstVertex;
use meshweft::files::Document;
use meshweft::operations::{self, CompressError, CompressOptions, Tier};

/// Compresses a small document, with everything in it and without what can be left out.
///
/// # Panics
/// If what was compressed decodes to something else.
pub(crate) fn check(document: &Document) {
    let entries = document.meshes().iter();
    let size = entries.map(|entry| entry.mesh.face_count() + entry.mesh.vertex_count());
    if size.sum::<usize>() > 1 << 10 {
        return;
    }
    for leaves_out in [false, true] {
        let mut options = CompressOptions::default();
        options.tier = Tier::Fast;
        options.first_vertex = FirstVertex::Given(0);
        options.drop_attributes = leaves_out;
        options.triangles = true;
        let compressed = operations::compress(document, &options);
        let is_lost = matches!(compressed, Err(CompressError::NotVerified { .. }));
        assert!(!is_lost, "it decodes to something else");
    }
}
