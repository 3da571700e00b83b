//! Files that a run writes beside the meshes: lists, orders, plots, pictures. None of them replaces anything else.

use std::fs;
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use super::interrupt;
use crate::usage::Usage;

/// A kind of such files: the flag that names one, and how one is known again.
pub(crate) struct SideFile {
    pub(crate) flag: &'static str,
    /// What else can be given with the flag where a file is in the way.
    pub(crate) other: &'static str,
    /// Whether a file that starts with these bytes is of this kind.
    pub(crate) is_own: fn(&[u8]) -> bool,
}

/// What `--write-permutation` writes.
pub(crate) const PERMUTATION: SideFile = SideFile {
    flag: "--write-permutation",
    other: "another name",
    is_own: |start| {
        let text = String::from_utf8_lossy(start);
        text.starts_with("{\"schema\":") && text.contains("out[i] = in[new_to_old[i]]")
    },
};

/// What `--write-levels` writes.
pub(crate) const LEVELS: SideFile = SideFile {
    flag: "--write-levels",
    other: "another name",
    is_own: |start| {
        let text = String::from_utf8_lossy(start);
        text.starts_with("{\"schema\":") && text.contains("fine_to_coarse[v] stands for v")
    },
};

/// What `--plot` writes.
pub(crate) const PLOT: SideFile = SideFile {
    flag: "--plot",
    other: "another name",
    is_own: |start| {
        let text = String::from_utf8_lossy(start);
        text.starts_with("<svg")
            && (text.contains("Misses per face") || text.contains(">Frames of a walk<"))
    },
};

/// What the description of a paper's picture begins with.
pub(crate) const PICTURE_NAME: &str = "meshweft paper";

/// What `--pictures` writes.
pub(crate) const PICTURE: SideFile = SideFile {
    flag: "--pictures",
    other: "another folder",
    is_own: |start| {
        let text = String::from_utf8_lossy(start);
        text.starts_with("<svg") && text.contains(&format!("<desc>{PICTURE_NAME}"))
            || start.starts_with(b"\x89PNG\r\n")
                && text.contains(&format!("Description\0{PICTURE_NAME}"))
    },
};

/// What `compress` writes.
pub(crate) const ARCHIVE: SideFile = SideFile {
    flag: "--output",
    other: "another name",
    is_own: |start| start.starts_with(b"MWZ\x1a"),
};

/// What `lod build` writes.
pub(crate) const HIERARCHY: SideFile = SideFile {
    flag: "--output",
    other: "another name",
    is_own: |start| start.starts_with(b"MWLD"),
};

/// What `terrain build` writes.
pub(crate) const TERRAIN: SideFile = SideFile {
    flag: "--output",
    other: "another name",
    is_own: |start| start.starts_with(b"MWTN"),
};

/// What `--manifest` appends to.
pub(crate) const MANIFEST: SideFile = SideFile {
    flag: "--manifest",
    other: "another name",
    is_own: |start| {
        // All of it is looked at later: see `is_list`.
        let line = start
            .split(|&byte| byte == b'\n')
            .next()
            .unwrap_or_default();
        is_line_of_list(line, line.len() == start.len())
    },
};

/// Whether every line of a text is one that a run with `--manifest` writes. One that was killed may have
/// left a part of a line; the next one goes on below it.
pub(super) fn is_list(text: &[u8]) -> bool {
    let mut lines = text.split(|&byte| byte == b'\n');
    lines.all(|line| is_line_of_list(line, true))
}

/// Whether this is a line of such a list, or with `may_be_cut` the beginning of one.
fn is_line_of_list(line: &[u8], may_be_cut: bool) -> bool {
    const HEAD: &[u8] = b"{\"schema\":";
    let has_output = line.windows(9).any(|word| word == b"\"output\":");
    let is_cut = may_be_cut && (!line.ends_with(b"}") || line.len() < HEAD.len());
    line.starts_with(HEAD) && (is_cut || has_output) || is_cut && HEAD.starts_with(line)
}

impl SideFile {
    /// Whether `path` may be written: it is free, or of this kind, or `force` says so.
    pub(crate) fn check(&self, path: &Path, force: bool) -> Result<(), Usage> {
        let flag = self.flag;
        let refused = |text: String| Err(Usage(format!("{flag} {}: {text}", path.display())));
        // Anything else, such as /dev/stdout, holds nothing that could be lost.
        let is_file = fs::metadata(path).is_ok_and(|data| data.is_file());
        if !is_file || force {
            return Ok(());
        }

        let mut start = Vec::new();
        let read = fs::File::open(path).and_then(|file| file.take(1 << 16).read_to_end(&mut start));
        match read {
            Err(error) => refused(error.to_string()),
            Ok(_) if start.is_empty() || (self.is_own)(&start) => Ok(()),
            Ok(_) => refused(format!(
                "this file is not one that {flag} writes: choose {}, or give --force to replace it",
                self.other
            )),
        }
    }

    /// Whether `path` is not the file that another flag names.
    pub(crate) fn check_other(&self, path: &Path, other: &Path, flag: &str) -> Result<(), Usage> {
        match is_same(path, other) {
            true => Err(Usage(format!(
                "{} {}: this is the file of {flag}: choose another name",
                self.flag,
                path.display()
            ))),
            false => Ok(()),
        }
    }

    /// Whether `path` is none of these meshes of a run; no flag allows that.
    pub(crate) fn check_no_mesh<'a>(
        &self,
        path: &Path,
        meshes: impl IntoIterator<Item = &'a Path>,
    ) -> Result<(), Usage> {
        match meshes.into_iter().any(|name| is_same(name, path)) {
            true => Err(Usage(format!(
                "{} {}: this is a mesh of the run: choose another name",
                self.flag,
                path.display()
            ))),
            false => Ok(()),
        }
    }
}

/// A file that is written and read again.
pub(crate) trait Reread: Read + Write + Seek {}

impl<F: Read + Write + Seek> Reread for F {}

/// A side file that is on the disk, but gets its name only when the mesh it goes with has: neither is lost
/// without the other.
pub(crate) struct PendingFile {
    path: PathBuf,
    /// `None` where there is no file to rename, such as for /dev/stdout.
    temporary: Option<PathBuf>,
    bytes: Vec<u8>,
    /// Locked as long as it is needed: another run would take it for abandoned.
    file: Option<fs::File>,
}

impl PendingFile {
    /// Writes text or other bytes beside their place.
    pub(crate) fn new(path: &Path, bytes: impl Into<Vec<u8>>) -> io::Result<Self> {
        let bytes = bytes.into();
        let mut pending = Self::named(path)?;
        match &mut pending.file {
            Some(file) => {
                file.write_all(&bytes)?;
                file.sync_all()?;
            }
            None => pending.bytes = bytes,
        }
        Ok(pending)
    }

    /// Has a file written beside its place, and read again.
    pub(crate) fn filled(
        path: &Path,
        fill: impl FnOnce(&mut dyn Reread) -> Result<()>,
    ) -> Result<Self> {
        let told = || path.display().to_string();
        let mut pending = Self::named(path).with_context(told)?;
        match &mut pending.file {
            Some(file) => {
                fill(file)?;
                file.sync_all().with_context(told)?;
            }
            None => {
                let mut bytes = io::Cursor::new(Vec::new());
                fill(&mut bytes)?;
                pending.bytes = bytes.into_inner();
            }
        }
        Ok(pending)
    }

    /// An empty file beside its place.
    fn named(path: &Path) -> io::Result<Self> {
        let mut pending = Self {
            path: path.to_owned(),
            temporary: None,
            bytes: Vec::new(),
            file: None,
        };
        if fs::metadata(path).is_ok_and(|data| !data.is_file()) {
            return Ok(pending);
        }
        // A link is followed.
        if let Ok(real) = fs::canonicalize(path) {
            pending.path = real;
        }
        let mut name = std::ffi::OsString::from(".");
        name.push(format!("order.{}.meshweft-tmp", std::process::id()));
        let temporary = pending.path.with_file_name(name);
        let open = || {
            let mut options = fs::OpenOptions::new();
            options.read(true).write(true).create_new(true);
            options.open(&temporary)
        };
        let file = match open() {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                // Of a run that was killed.
                fs::remove_file(&temporary)?;
                open()?
            }
            file => file?,
        };
        // Not every file system has locks.
        let _ = file.lock();
        pending.temporary = Some(temporary);
        pending.file = Some(file);
        Ok(pending)
    }

    /// Gives it its name.
    pub(crate) fn commit(mut self) -> io::Result<()> {
        let _no_interrupt = interrupt::hold_off();
        match self.temporary.take() {
            Some(temporary) => fs::rename(temporary, &self.path),
            None => fs::write(&self.path, &self.bytes),
        }
    }
}

impl Drop for PendingFile {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            let _ = fs::remove_file(temporary);
        }
    }
}

/// Whether two names are one file, or will be.
fn is_same(a: &Path, b: &Path) -> bool {
    let whole = |path: &Path| {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        match (fs::canonicalize(&path), path.parent(), path.file_name()) {
            (Ok(path), _, _) => path,
            (Err(_), Some(folder), Some(name)) => {
                let folder = fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
                folder.join(name)
            }
            _ => path,
        }
    };
    a == b || whole(a) == whole(b)
}
