//! Tables 1 and 2 and figures 3 and 4 of Lin and Zhang, beside ours.

mod by_mesh;
mod example;
mod picture;
mod printed;
mod windows;

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;

use super::arguments::OfPaper;
use super::figure::print;
use super::meshes::{LARGE, none_found, open};
use by_mesh::{Found, buffers, parts, table_1};
use example::{fig_4, table_2};
use printed::{OTHERS, TABLE_1};
use windows::windows;

#[derive(Debug, Args)]
pub(super) struct LinZhang {
    #[command(flatten)]
    of_paper: OfPaper,
    /// Also draw figure 3, as an SVG file in this folder
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// Let --pictures replace a file that another program wrote
    #[arg(long, requires = "pictures")]
    force: bool,
}

/// Prints the tables for the meshes found in the data folder.
pub(super) fn run(arguments: &LinZhang) -> Result<()> {
    let OfPaper {
        data,
        skip_large,
        report,
    } = &arguments.of_paper;
    if let Some(folder) = &arguments.pictures {
        picture::check(folder, arguments.force)?;
    }

    // The paper's meshes, then others.
    let mut found = Vec::new();
    for printed in &TABLE_1 {
        if let Some((file, mesh)) = open(data, printed.files)? {
            let is_the_papers = printed.size == [mesh.vertex_count(), mesh.face_count()];
            let star = if is_the_papers { "" } else { "*" };
            found.push(Found {
                name: format!("{}{star}", printed.mesh),
                file,
                mesh,
                printed: Some(printed),
            });
        }
    }
    for name in OTHERS {
        if let Some((file, mesh)) = open(data, &[name])? {
            found.push(Found {
                name: name.to_owned(),
                file,
                mesh,
                printed: None,
            });
        }
    }
    if *skip_large {
        found.retain(|it| it.mesh.face_count() <= LARGE);
    }
    if found.is_empty() {
        return Err(none_found(data));
    }

    let pictures = arguments.pictures.iter();
    let written = pictures.map(|folder| picture::write(folder, &found));
    let written = written.collect::<Result<Vec<_>>>()?;
    print(
        report,
        "Lin, Zhang: Joint Connectivity Compression and Mesh Rendering",
        &[
            ("Table 1", "table_1", &|| Ok(table_1(&found))),
            ("Parts", "parts", &|| Ok(parts(&found))),
            ("Buffers", "buffers", &|| Ok(buffers(&found))),
            ("Windows", "windows", &|| Ok(windows(&found))),
            ("Table 2", "table_2", &|| Ok(table_2())),
            ("Fig. 4", "figure_4", &|| Ok(fig_4())),
        ],
        &written,
    )
}
