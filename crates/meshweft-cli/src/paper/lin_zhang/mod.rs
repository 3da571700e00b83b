//! Tables 1 and 2 and figures 3 and 4 of Lin and Zhang, beside ours.

mod by_mesh;
mod example;
mod printed;

use anyhow::Result;

use super::arguments::OfPaper;
use super::figure::print;
use super::meshes::{LARGE, none_found, open};
use by_mesh::{Found, buffers, parts, table_1};
use example::{fig_4, table_2};
use printed::{OTHERS, TABLE_1};

/// Prints the tables for the meshes found in the data folder.
pub(super) fn run(arguments: &OfPaper) -> Result<()> {
    // The paper's meshes, then others.
    let mut found = Vec::new();
    for printed in &TABLE_1 {
        if let Some((file, mesh)) = open(&arguments.data, printed.files)? {
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
        if let Some((file, mesh)) = open(&arguments.data, &[name])? {
            found.push(Found {
                name: name.to_owned(),
                file,
                mesh,
                printed: None,
            });
        }
    }
    if arguments.skip_large {
        found.retain(|it| it.mesh.face_count() <= LARGE);
    }
    if found.is_empty() {
        return Err(none_found(&arguments.data));
    }

    print(
        &arguments.report,
        "Lin, Zhang: Joint Connectivity Compression and Mesh Rendering",
        &[
            ("Table 1", "table_1", &|| Ok(table_1(&found))),
            ("Parts", "parts", &|| Ok(parts(&found))),
            ("Buffers", "buffers", &|| Ok(buffers(&found))),
            ("Table 2", "table_2", &|| Ok(table_2())),
            ("Fig. 4", "figure_4", &|| Ok(fig_4())),
        ],
        &[],
    )
}
