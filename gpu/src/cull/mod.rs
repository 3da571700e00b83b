//! What cullers leave of meshes, drawn: the same pictures as of whole meshes, vertices as the card's model says, and
//! what a frame costs.
//!
//! Sungjin Kim, Chang Ha Lee: *Mesh Clustering and Reordering Based on Normal Locality for Efficient Rendering*,
//! Symmetry 14 (3), 466, 2022, <https://doi.org/10.3390/sym14030466>.
//!
//! `cullers` has what is compared, `pictures` draws every view whole and culled and counts, `times` has the settings of
//! the paper's Tables 3 and 4. `lattice` says exactly what a front face is, `camera` is from where meshes are seen.

mod camera;
mod cullers;
mod lattice;
mod pictures;
mod times;

use cullers::stripes;
use meshweft::Mesh;
use serde_json::{Value, json};

pub use cullers::{Culler, Visible, cullers};
pub use pictures::{Tally, pictures};

use crate::error::GpuError;
use crate::frames::Frames;
use crate::meshes::NamedMesh;
use crate::renderer::Renderer;
use crate::vulkan::Card;

/// What is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CullOptions {
    /// Views of each mesh.
    pub views: u32,
    /// Width and height of pictures in pixels.
    pub side: u32,
    /// Whether frames are timed.
    pub times: bool,
}

/// Draws every mesh whole and culled from many eyes, and says whether all pictures are the same and all counts those of
/// the model; then times frames.
///
/// # Errors
/// If the card cannot draw ranges by one call, has no timestamps, or fails.
pub fn run(
    renderer: &Renderer<'_>,
    meshes: &[NamedMesh],
    options: CullOptions,
) -> Result<(bool, Value), GpuError> {
    let frames = Frames::new(renderer, options.side)?;
    // More stripes leave out more, and are more draws.
    let with_stripes = |mesh: &Mesh, card: &Card| {
        let mut all = cullers(mesh, card);
        all.push(stripes(mesh, Some(64)));
        all
    };
    let (tally, pictures) = pictures(&frames, meshes, options.views, &with_stripes)?;
    let times = match options.times {
        true => times::run(&frames, meshes)?,
        false => Value::Null,
    };
    Ok((
        tally.is_right(renderer.gpu().card()),
        json!({"pictures": pictures, "times": times}),
    ))
}
