//! An archive as meshes, in an order to be drawn.

use crate::bits::DecodeError;
use crate::compression::{DecodedMesh, MeshArchive, SourceOrder};
use crate::connectivity::{WindowOrder, WindowSize};
use crate::faces::Faces;
use crate::limits::Limits;
use crate::mesh::Mesh;
use crate::order::{InBatches, by_first_use};

/// How an archive is decompressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct DecompressOptions {
    /// The most that is decoded; `file_bytes` is for all meshes together, as they are in memory.
    pub limits: Limits,
    /// The order of faces and vertices.
    pub order: DecodedOrder,
    /// Give polygons as the triangles that they are drawn as, in an order that is as good as without polygons.
    pub triangles: bool,
}

/// A mesh of an archive.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct DecompressedMesh {
    /// Its name.
    pub name: String,
    /// Its positions and faces.
    pub mesh: Mesh,
    /// Where the faces of each polygon start in [`mesh`](Self::mesh), and where the last ones end, or `None` where each
    /// is one triangle. The faces of a polygon are a fan around its first corner.
    pub polygons: Option<Vec<u32>>,
}

/// In which order faces and vertices are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum DecodedOrder {
    /// As in the source, if that [is stored](crate::compression::KeepOrder); what is not, as by [`Window`](Self::Window).
    #[default]
    Source,
    /// Good to draw for small caches and for batches of a card: the stored order, drawn
    /// [in windows](crate::connectivity::WindowOrder) and [in batches](crate::order::InBatches); vertices in the order of
    /// their first use.
    Window,
    /// As they are stored. Compressed again from vertex 0, they give the same bytes.
    Stored,
}

/// The meshes of an archive with their names and polygons.
///
/// # Errors
/// The bytes are not an archive, are damaged or above the limits.
///
/// # Complexity
/// Time and space O(vertices + faces).
pub fn decompress(
    bytes: &[u8],
    options: &DecompressOptions,
) -> Result<Vec<DecompressedMesh>, DecodeError> {
    let archive = MeshArchive::from_bytes(bytes)?;
    let limits = options.limits;
    let mut left = limits.file_bytes;
    let each = (0..archive.len()).map(|number| {
        // A position takes 12 bytes, and so does a face.
        let most = usize::try_from(left / 12).unwrap_or(usize::MAX);
        let limits = Limits {
            vertices: limits.vertices.min(most),
            faces: limits.faces.min(most),
            ..limits
        };
        let mut stored = archive.decode_stored(number, limits)?;
        let count = stored.mesh.vertex_count() as u64 + stored.mesh.face_count() as u64;
        left = left.saturating_sub(12 * count);

        if options.triangles {
            stored.polygons = None;
        }
        if options.order != DecodedOrder::Source {
            stored.order = SourceOrder::default();
        }
        let (mesh, polygons) = match options.order {
            DecodedOrder::Source | DecodedOrder::Window => in_order(&stored),
            DecodedOrder::Stored => stored.restore(),
        };
        Ok(DecompressedMesh {
            name: archive.name(number).to_owned(),
            mesh,
            polygons,
        })
    });
    each.collect()
}

/// A mesh, whose faces come in the order of their least vertices, in its order as far as that is known; else in an order
/// to be drawn; and its polygons.
fn in_order(stored: &DecodedMesh) -> (Mesh, Option<Vec<u32>>) {
    let DecodedMesh {
        mesh,
        polygons,
        order,
    } = stored;
    let windows = || {
        let windows = WindowOrder::of_faces(mesh, WindowSize::default());
        InBatches::BESIDE_OTHERS.follow(mesh, &windows)
    };
    let mut faces = order.faces().cloned().unwrap_or_else(windows);
    let polygons = polygons.as_ref().map(|polygons| {
        let polygons = polygons.follow(&faces);
        faces = polygons.faces().clone();
        polygons.starts().to_vec()
    });
    let drawn = mesh.with_face_order(&faces);
    // Not in blocks as in a file that is optimized: those that a sweep meets together have near numbers already.
    let first_use = || by_first_use(Faces::from(&drawn));
    let vertices = order.vertices().cloned().unwrap_or_else(first_use);
    (drawn.with_vertex_order(&vertices), polygons)
}
