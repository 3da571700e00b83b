//! The program as its users call it: a folder, a command, what it prints and leaves behind.

mod basics;
mod compress;
mod content;
mod cull;
mod data;
mod demo;
mod disk;
mod kept;
mod lario;
mod lod;
mod lod_files;
mod many;
mod nothing_lost;
mod papers;
mod simplify;
mod terrain;
mod with_levels;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// A folder of a test's own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let name = format!("meshweft-test-{}-{name}", std::process::id());
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, bytes).unwrap();
        path
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.0.join(name)).unwrap()
    }

    /// Runs the program in the folder.
    fn run(&self, arguments: &[&str]) -> Run {
        let output = Command::new(env!("CARGO_BIN_EXE_meshweft"))
            .args(arguments)
            .current_dir(&self.0)
            .output()
            .unwrap();
        Run(output)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

struct Run(Output);

impl Run {
    fn code(&self) -> i32 {
        self.0.status.code().expect("the program was not killed")
    }

    fn out(&self) -> String {
        String::from_utf8(self.0.stdout.clone()).unwrap()
    }

    fn err(&self) -> String {
        String::from_utf8(self.0.stderr.clone()).unwrap()
    }

    fn json(&self) -> Value {
        assert_eq!(self.code(), 0, "{}", self.err());
        serde_json::from_str(&self.out()).expect("one JSON document")
    }
}

/// The folder of real meshes: `MESHWEFT_DATA`, else beside the checkout.
///
/// `None` is said loudly, and is a failure where `MESHWEFT_REQUIRE_DATA` is set.
fn data_folder(test: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("MESHWEFT_DATA").map_or(beside, PathBuf::from);
    if folder.is_dir() {
        return Some(folder.canonicalize().unwrap());
    }
    let required = std::env::var_os("MESHWEFT_REQUIRE_DATA").is_some();
    assert!(!required, "{test}: no meshes in {}", folder.display());
    eprintln!("SKIPPED {test}: no meshes in {}", folder.display());
    None
}
