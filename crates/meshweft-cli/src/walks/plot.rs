//! The plot of a walk: a file beside the report.

use std::path::Path;

use anyhow::{Context, Result};

use super::frames::WalkedFrames;
use crate::run::side_file::{PLOT, PendingFile};
use crate::usage::Usage;

/// Refuses a plot in place of a file that is read, or of one that another program wrote.
pub(crate) fn check<'a>(
    path: &Path,
    inputs: impl IntoIterator<Item = &'a Path>,
    cameras: Option<&Path>,
    force: bool,
) -> Result<(), Usage> {
    PLOT.check_no_mesh(path, inputs)?;
    if let Some(cameras) = cameras {
        PLOT.check_other(path, cameras, "--path")?;
    }
    PLOT.check(path, force)
}

/// Writes the plot.
pub(crate) fn write(path: &Path, frames: &WalkedFrames<'_>) -> Result<()> {
    let written = PendingFile::new(path, frames.svg()).and_then(PendingFile::commit);
    written.with_context(|| path.display().to_string())
}
