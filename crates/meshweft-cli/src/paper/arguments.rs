//! The flags of every paper.

use std::path::PathBuf;

use clap::Args;

use crate::run::output::Report;

#[derive(Debug, Args)]
pub(super) struct OfPaper {
    /// A folder with the meshes (fandisk.off, bunny.ply, …, optionally followed by .gz), or one that
    /// contains a folder `meshes`
    #[arg(long, value_name = "DIR")]
    pub(super) data: PathBuf,
    /// Leave out meshes of more than 200 thousand faces
    #[arg(long)]
    pub(super) skip_large: bool,
    #[command(flatten)]
    pub(super) report: Report,
}
