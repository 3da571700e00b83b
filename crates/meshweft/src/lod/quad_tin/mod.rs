//! Terrain: right triangles that are halved, over a grid of heights or over points at any places.
//!
//! Renato Pajarola, Marc Antonijuan, Roberto Lario: *QuadTIN: Quadtree based Triangulated Irregular Networks*, IEEE Visualization 2002,
//! and the second half of Roberto Lario, Renato Pajarola, Francisco Tirado: *Cached Geometry Manager for View-dependent LOD
//! Rendering*, WSCG 2005.
//!
//! A square is cut into two right triangles, and each triangle again from its right angle to the middle of the side opposite. Two
//! triangles have that side in common, a *diamond*: they are cut together, at one vertex. So a vertex has at most two others above it,
//! those at which its two triangles began. A [`QuadTin`] knows of each vertex an *error*, how far heights below its diamond are from
//! the surface without it, and a *ball* with all of them. Both contain those of the vertices below. So a view that needs a vertex
//! needs those above it, each triangle is decided by itself on one way down, and there are no cracks: no list of what depends on
//! what, nothing from the last frame. The way goes along a Sierpiński curve, so the faces come as one strip.
//!
//! # Where the papers leave room
//! - **Errors.** The largest vertical distance of any height to the triangle that covers it, by going over all of them, not only of the
//!   middle of the side: what is drawn at a tolerance is that near, everywhere. Rounding of positions is counted.
//! - **Sizes and holes.** A grid of any size lies in a square of 2^k + 1; what lies beyond is void, as holes are. A diamond that is
//!   partly void is always cut, so borders are exact, and no face crosses one. Sides of m 2^j + 1 places with a large j are
//!   drawn with few faces; those of 2^k places have single cells along two borders.
//! - **Points.** A [`PointHierarchy`] is over points that are no grid: what is cut where, see `points`.
//! - **Storage.** Of a grid only heights, errors and radii are kept, eight bytes a vertex; which triangles there are follows from
//!   columns and rows. Over points it is 36 bytes, and whether it is a point of the input. A `.mwt` file has them in blocks of a level and a part of the grid (`stored`), and a [`StreamedTin`] reads
//!   those that a surface needs.
//!
//! Read `triangle` and `grid_square` first; then `grid_build`, how errors come about, and `descent`.

mod descent;
mod extent;
mod grid;
mod grid_build;
mod grid_square;
mod hierarchy;
mod limited;
mod plane;
mod point_bounds;
mod point_build;
mod point_diamond;
mod point_distance;
mod point_draw;
#[cfg(test)]
mod point_hostile_tests;
mod point_input;
mod point_lists;
mod point_places;
#[cfg(test)]
pub(crate) mod point_sets;
#[cfg(test)]
mod point_tests;
mod points;
mod rounded;
mod stored;
mod stored_grid;
mod stored_points;
#[cfg(test)]
mod stored_tests;
mod stored_tree;
mod streamed;
mod strip;
#[cfg(test)]
pub(crate) mod tests;
mod tree;
mod triangle;

pub use descent::TinSurface;
pub use hierarchy::{QuadTin, QuadTinError};
pub use limited::TinLimit;
pub use point_input::{PointCounts, PointsError};
pub use points::PointHierarchy;
pub use streamed::StreamedTin;
