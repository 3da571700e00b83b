//! Tables 1 to 3 and figures 7 and 8 of Lario, Pajarola and Tirado, beside ours. The terrain of tables 4 and 5 is not here.

mod figures;
mod pictures;
mod policy_order;
mod printed;
mod tables;
mod walked;

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use meshweft::operations::LodWalkOptions;

use super::figure::print;
use super::meshes::none_like;
use crate::run::output::Report;
use crate::usage::Usage;
use figures::{fig_7, fig_8};
use tables::{table_1, table_2, table_3};
use walked::Named;

#[derive(Debug, Args)]
pub(super) struct Lario {
    /// Meshes to walk around instead of the paper's: files of any format that is read
    #[arg(value_name = "MESH", required_unless_present = "data")]
    meshes: Vec<PathBuf>,
    /// A folder with the paper's meshes (hand.off, dragon.ply, happy.ply, optionally followed by .gz), or one that
    /// contains a folder `meshes`
    #[arg(long, value_name = "DIR", conflicts_with = "meshes")]
    data: Option<PathBuf>,
    /// Leave out meshes of more than 200 thousand faces
    #[arg(long)]
    skip_large: bool,
    /// How many frames each path has
    #[arg(long, value_name = "N", default_value_t = 1000)]
    frames: usize,
    /// A second tolerance beside the paper's 1.5 pixels: the default gives a mesh of 870 thousand faces the paper's load
    #[arg(long, value_name = "PIXELS", default_value_t = 0.12)]
    tolerance: f64,
    /// Also draw figures 7 and 8 over the frames of the second tolerance, as SVG files in this folder
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// Let --pictures replace files that another program wrote
    #[arg(long, requires = "pictures")]
    force: bool,
    #[command(flatten)]
    report: Report,
}

/// Prints the tables for the meshes that are named, or found in the data folder.
pub(super) fn run(arguments: &Lario) -> Result<()> {
    let mut options = LodWalkOptions::default();
    options.frames = Some(arguments.frames);
    options.tolerance = arguments.tolerance;
    options
        .check()
        .map_err(|error| Usage(format!("--{error}")))?;

    // The meshes.
    let mut meshes = match &arguments.data {
        Some(folder) => Named::in_folder(folder)?,
        None => {
            let named = arguments.meshes.iter().map(|file| Named::file(file));
            named.collect::<Result<Vec<_>>>()?
        }
    };
    if arguments.skip_large {
        meshes.retain(|it| !it.is_large());
    }
    if meshes.is_empty() {
        return Err(match &arguments.data {
            Some(folder) => none_like(folder, "dragon.ply, hand.off or happy.ply"),
            None => Usage("every mesh is left out by --skip-large".to_owned()).into(),
        });
    }
    if let Some(folder) = &arguments.pictures {
        pictures::check(folder, &meshes, arguments.force)?;
    }

    let shows_progress = arguments.report.shows_progress();
    let walked = walked::walk(
        &meshes,
        arguments.frames,
        arguments.tolerance,
        shows_progress,
    )?;
    let written = match &arguments.pictures {
        Some(folder) => pictures::write(folder, &walked, arguments.tolerance)?,
        None => Vec::new(),
    };
    print(
        &arguments.report,
        "ISBN 80-903100-7-9",
        &[
            ("Table 1", "table_1", &|| Ok(table_1(&walked))),
            ("Table 2", "table_2", &|| Ok(table_2(&walked))),
            ("Table 3", "table_3", &|| Ok(table_3(&walked))),
            ("Fig. 7", "figure_7", &|| Ok(fig_7(&walked))),
            ("Fig. 8", "figure_8", &|| Ok(fig_8(&walked))),
        ],
        &written,
    )
}
