//! Where test data is.

use std::path::{Path, PathBuf};

/// The folder of test data, or `None` with a loud word: `MESHWEFT_DATA`, else beside the checkout.
pub(crate) fn folder() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("MESHWEFT_DATA").map_or(beside, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    let required = std::env::var_os("MESHWEFT_REQUIRE_DATA").is_some();
    assert!(!required, "no test data in {}", folder.display());
    eprintln!("SKIPPED: no test data in {}", folder.display());
    None
}
