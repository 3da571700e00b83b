//! Figures 3 and 6 to 12 of Lin and Yu 2006, beside ours.

mod by_mesh;
mod coarser;
mod found;
mod means;
mod printed;

use anyhow::Result;

use super::arguments::OfPaper;
use super::figure::print;
use super::meshes::{LARGE, none_found};
use by_mesh::{fig_3, fig_6, fig_9};
use coarser::{fig_11, fig_12};
use found::Found;
use means::{fig_7, fig_8, fig_10};
use printed::FIG_3;

/// Prints the figures for the meshes found in the data folder.
pub(super) fn run(arguments: &OfPaper) -> Result<()> {
    let mut found = Vec::new();
    for printed in &FIG_3 {
        if let Some(mesh) = Found::open(printed, &arguments.data)? {
            found.push(mesh);
        }
    }
    if arguments.skip_large {
        found.retain(|mesh| mesh.mesh.face_count() <= LARGE);
    }
    if found.is_empty() {
        return Err(none_found(&arguments.data));
    }

    print(
        &arguments.report,
        "doi:10.1109/TVCG.2006.59",
        &[
            ("Fig. 3", "figure_3", &|| Ok(fig_3(&found))),
            ("Fig. 6", "figure_6", &|| Ok(fig_6(&found))),
            ("Fig. 7", "figure_7", &|| Ok(fig_7(&found))),
            ("Fig. 8", "figure_8", &|| Ok(fig_8(&found))),
            ("Fig. 9", "figure_9", &|| Ok(fig_9(&found))),
            ("Fig. 10", "figure_10", &|| Ok(fig_10(&found))),
            ("Fig. 11", "figure_11", &|| fig_11(&found)),
            ("Fig. 12", "figure_12", &|| fig_12(&found)),
        ],
        &[],
    )
}
