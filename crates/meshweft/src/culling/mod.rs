//! What of a mesh can face the eye, found before anything is drawn.
//!
//! Sungjin Kim, Chang Ha Lee: *Mesh Clustering and Reordering Based on Normal Locality for Efficient Rendering*,
//! Symmetry 14 (3), 466, 2022, <https://doi.org/10.3390/sym14030466>.
//!
//! A face is seen only from the side its corners turn left on. Faces whose normals are alike are seen from the same
//! eyes: put in an order by normal, those that may be seen are few ranges of the faces, each drawn by a call. What faces
//! away in them is left to the card. [`NormalStripes`] is the paper's order.
//!
//! **Front.** With `n = (b − a) × (c − a)`, a face is a *front face* for an [`Eye`] `(p, w)` if `n · p > w n · a`. That is decided in the
//! space of the mesh: take the eye there by the inverse of its transform, and never the normals. It then holds under any affine
//! transform; one that mirrors reverses the winding on the screen, and a renderer that follows glTF then reverses which winding is the front, so the same faces are drawn.
//!
//! **No front face is ever left out.** Every bound here errs on the side of drawing: ranges include what rounding may have put
//! in the next one, and a face whose normal rounding may have turned is always drawn.
//!
//! Left out are faces, not pixels: what is drawn looks the same. So do not cull what is seen from both sides, nor what is
//! moved by joints or morph targets.

mod clusters;
#[cfg(test)]
mod exact;
mod eye;
mod facing;
mod inner_order;
mod meshlets;
#[cfg(test)]
mod paper_circle_tests;
mod planes;
mod ranges;
mod stripes;
mod table;
mod table_error;
#[cfg(test)]
mod tests;

pub use clusters::{ClusteredFaces, SampledEyes, ViewClusters};
pub use eye::{Eye, EyeBox};
pub use meshlets::{MeshletMesh, Meshlets, NormalCone, order_meshlet};
pub use ranges::Ranges;
pub use stripes::{NormalStripes, StripedFaces};
pub use table::CullingTable;
pub use table_error::CullingTableError;
