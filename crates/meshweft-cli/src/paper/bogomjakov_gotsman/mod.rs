//! Figures 3, 4, 6, 7 and 8 and tables 1 and 2 of Bogomjakov and Gotsman 2002, beside ours, and the
//! universality table of Lin and Yu's figure 10 with every order that is available.

mod cache_sizes;
mod coarser;
mod drawing;
mod found;
mod pictures;
mod steps;
mod tables;

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use meshweft::operations::Method;

use super::arguments::OfPaper;
use super::figure::print;
use super::meshes::{LARGE, none_found, open};
use cache_sizes::{fig_4a, fig_4b, fig_8, universality};
use coarser::{fig_6, fig_7, fig_8_coarser};
use found::Found;
use pictures::fig_3;
use tables::{table_1, table_2};

/// Names of the meshes of the universality table: those of Lin and Yu.
const UNIVERSALITY: [&str; 8] = [
    "eight", "cow", "fandisk", "feline", "foot", "skull", "bunny", "horse",
];

#[derive(Debug, Args)]
pub(super) struct BogomjakovGotsman {
    #[command(flatten)]
    of_paper: OfPaper,
    /// Also draw figures 3a, 3b, 4b and 6, as SVG files in this folder
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// Let --pictures replace files that another program wrote
    #[arg(long, requires = "pictures")]
    force: bool,
}

/// Prints the figures for the meshes found in the data folder.
pub(super) fn run(arguments: &BogomjakovGotsman) -> Result<()> {
    let OfPaper {
        data,
        skip_large,
        report,
    } = &arguments.of_paper;
    if let Some(folder) = &arguments.pictures {
        pictures::check(folder, arguments.force)?;
    }

    // The meshes.
    let mut found = Found::open_all(data)?;
    let mut others = Vec::new();
    for name in UNIVERSALITY {
        others.extend(open(data, &[name])?.map(|(_, mesh)| mesh));
    }
    others.retain(|mesh| mesh.face_count() <= LARGE);
    if *skip_large {
        found.retain(|it| it.mesh.face_count() <= LARGE);
    }
    if found.is_empty() || others.is_empty() {
        return Err(none_found(data));
    }

    let written = match &arguments.pictures {
        Some(folder) => pictures::write(folder)?,
        None => Vec::new(),
    };
    print(
        report,
        "doi:10.1111/1467-8659.00573",
        &[
            ("Fig. 3", "figure_3", &|| Ok(fig_3())),
            ("Fig. 4a", "figure_4a", &|| Ok(fig_4a())),
            ("Fig. 4b", "figure_4b", &|| Ok(fig_4b())),
            ("Fig. 6", "figure_6", &fig_6),
            ("Fig. 7", "figure_7", &fig_7),
            ("Fig. 8a, 8c", "figure_8", &|| Ok(fig_8(&found))),
            ("Fig. 8b", "figure_8b", &|| {
                fig_8_coarser(&found, Method::RecursiveCut)
            }),
            ("Fig. 8d", "figure_8d", &|| {
                fig_8_coarser(&found, Method::LinearArrangement)
            }),
            ("Table 1", "table_1", &|| Ok(table_1(&found))),
            ("Table 2", "table_2", &|| Ok(table_2(&found))),
            ("Universality", "universality", &|| {
                Ok(universality(&others))
            }),
        ],
        &written,
    )
}
