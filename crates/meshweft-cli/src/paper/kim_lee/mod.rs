//! Tables 1 to 4 and figures 9, 10 and 13 of Kim and Lee, beside ours; figures 5, 6, 11, 12 and 14 as pictures.

mod found;
mod pictures;
mod printed;
mod shares;
mod sweeps;
mod times;
mod vertex_work;

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;

use super::arguments::OfPaper;
use super::figure::print;
use super::meshes::{LARGE, none_found};
use found::Found;
use shares::{fig_10, table_2};
use sweeps::{fig_13, table_3};
use times::table_1;
use vertex_work::table_4;

#[derive(Debug, Args)]
pub(super) struct KimLee {
    #[command(flatten)]
    of_paper: OfPaper,
    /// Also draw figures 5, 6, 11, 12 and 14, as PNG files in this folder
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// Let --pictures replace files that another program wrote
    #[arg(long, requires = "pictures")]
    force: bool,
}

/// Prints the tables for the meshes found in the data folder.
pub(super) fn run(arguments: &KimLee) -> Result<()> {
    let OfPaper {
        data,
        skip_large,
        report,
    } = &arguments.of_paper;
    if let Some(folder) = &arguments.pictures {
        pictures::check(folder, arguments.force)?;
    }
    let mut found = Found::open_all(data)?;
    if *skip_large {
        found.retain(|it| it.mesh.face_count() <= LARGE);
    }
    if found.is_empty() {
        return Err(none_found(data));
    }

    let written = match &arguments.pictures {
        Some(folder) => pictures::write(folder, &found)?,
        None => Vec::new(),
    };
    print(
        report,
        "doi:10.3390/sym14030466",
        &[
            ("Table 1", "table_1", &|| Ok(table_1(&found))),
            ("Table 2", "table_2", &|| Ok(table_2(&found))),
            ("Fig. 10", "figure_10", &|| Ok(fig_10(&found))),
            ("Table 3", "table_3", &|| Ok(table_3(*skip_large))),
            ("Fig. 13", "figure_13", &|| Ok(fig_13(&found))),
            ("Table 4", "table_4", &|| Ok(table_4(&found))),
        ],
        &written,
    )
}
