//! The flags that verbs share: how files are read, and how a run over many files goes.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;
use meshweft::Limits;
use meshweft::files::ReadOptions;

use super::inputs::Shard;

/// Most threads of a run, so also most jobs: above the cores of most machines, far fewer than a system can start.
pub(super) const MOST_THREADS: usize = 1024;

// No doc comments on groups of flags: clap would take them for the text about a verb.
#[derive(Debug, Args)]
pub(crate) struct Run {
    /// Where to write: a file, or a folder that repeats the folders of the inputs
    #[arg(short, long, value_name = "OUT", conflicts_with = "in_place")]
    pub(crate) output: Option<PathBuf>,
    /// Replace the input once the new file is whole
    #[arg(long)]
    pub(crate) in_place: bool,
    /// Do everything but write
    #[arg(long)]
    pub(crate) dry_run: bool,
    // The flags above are listed before a verb's own, those below after them.
    /// Replace files that are read-only, and one that another program wrote by --write-permutation or --write-levels
    #[arg(long, display_order = 99)]
    pub(crate) force: bool,
    /// Leave images, materials and other files that a mesh file names where they are
    ///
    /// Without this flag they are copied along with -o into another folder, over no other file.
    #[arg(long, display_order = 99)]
    pub(crate) no_copy: bool,
    /// Go on with the next file when one fails
    #[arg(long, display_order = 100)]
    pub(crate) keep_going: bool,
    /// Files to work on at once [default: the cores, shared by --threads]
    #[arg(long, value_name = "N", display_order = 101, value_parser = thread_count)]
    pub(crate) jobs: Option<NonZeroUsize>,
    /// Threads for the meshes of one file, large ones in parts; the output is the same for any
    /// number [default: the cores that the jobs leave]
    #[arg(long, value_name = "N", display_order = 102, value_parser = thread_count)]
    pub(crate) threads: Option<NonZeroUsize>,
    /// List what is done as JSON lines; a run with the same list continues where it was cut off
    ///
    /// A file that the list has as done, and whose output exists, is not done again. Remove the
    /// list to start over.
    #[arg(long, value_name = "FILE", display_order = 103)]
    pub(crate) manifest: Option<PathBuf>,
    /// Do every N-th file only, from the I-th on: 1/4, 2/4, 3/4 and 4/4 together do all
    #[arg(long, value_name = "I/N", display_order = 104)]
    pub(crate) shard: Option<Shard>,
}

impl Run {
    /// Whether a file is written: one that stays in place only if something in it changed.
    pub(crate) fn writes(&self, is_changed: bool) -> bool {
        !self.dry_run && (is_changed || !self.in_place)
    }
}

#[derive(Debug, Args)]
#[command(next_display_order = 115)]
pub(crate) struct Size {
    /// Most bytes of a file, after decompression; K, M or G may follow: a compressed file takes
    /// memory by its unpacked size [default: 8G]
    #[arg(long, value_name = "N", value_parser = byte_count)]
    max_bytes: Option<u64>,
}

impl Size {
    pub(crate) fn limits(&self) -> Limits {
        let mut limits = Limits::default();
        limits.file_bytes = self.max_bytes.unwrap_or(limits.file_bytes);
        limits
    }
}

#[derive(Debug, Args)]
#[command(next_display_order = 110)]
pub(crate) struct Reading {
    /// Refuse files with something that is not known and may depend on the order
    ///
    /// A glTF extension on a primitive, accessor or buffer view, a PLY element, an OBJ statement, an OBJ
    /// comment with numbers. Without this flag, what they may depend on stays where it is, and a note says
    /// so.
    #[arg(long)]
    strict: bool,
    /// An extension, element, statement or comment that does not depend on the order; may be repeated
    #[arg(long, value_name = "NAME")]
    assume_order_safe: Vec<String>,
    /// Let faces of an OBJ cross g and o lines: groups may lose and gain faces
    ///
    /// Materials and smoothing groups are never crossed.
    #[arg(long)]
    across_groups: bool,
    /// Move transparent faces too: drawn one over the other, they may look different then
    ///
    /// Transparent is what has a material with alphaMode BLEND, in any variant of a glTF; one whose .mtl
    /// has d below 1, Tr above 0 or map_d; or one of a VRML file with a transparency.
    #[arg(long)]
    reorder_transparent: bool,
    /// Order triangle strips as faces: they are written as a list of triangles
    #[arg(long)]
    strips_to_lists: bool,
    #[command(flatten)]
    size: Size,
}

impl Reading {
    /// The flags for the library; `keep_buffers` are those that other files read too.
    pub(crate) fn options(&self, keep_buffers: &[PathBuf]) -> ReadOptions {
        let mut options = ReadOptions::default();
        options.limits = self.size.limits();
        options.strict = self.strict;
        options
            .assume_order_safe
            .clone_from(&self.assume_order_safe);
        options.across_groups = self.across_groups;
        options.reorder_transparent = self.reorder_transparent;
        options.strips_to_lists = self.strips_to_lists;
        options.keep_buffers = keep_buffers.to_vec();
        options
    }
}

/// A number of threads or jobs that a system can start.
fn thread_count(text: &str) -> Result<NonZeroUsize, String> {
    let count: NonZeroUsize = text.parse().map_err(|error| format!("{error}"))?;
    match count.get() <= MOST_THREADS {
        true => Ok(count),
        false => Err(format!("at most {MOST_THREADS} are allowed")),
    }
}

/// A number of bytes such as `300` or `2G`.
fn byte_count(text: &str) -> Result<u64, String> {
    let shift = match text.bytes().last().map(|unit| unit.to_ascii_uppercase()) {
        Some(b'K') => 10,
        Some(b'M') => 20,
        Some(b'G') => 30,
        _ => 0,
    };
    let digits = &text[..text.len() - usize::from(shift > 0)];
    let count: u64 = digits
        .parse()
        .map_err(|error| format!("{error}: write 300M or 16G"))?;
    count
        .checked_mul(1 << shift)
        .ok_or_else(|| "no file has that many bytes".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_counted_in_units_too() {
        for (text, count) in [
            ("0", 0),
            ("300", 300),
            ("2k", 2048),
            ("3M", 3 << 20),
            ("1G", 1 << 30),
        ] {
            assert_eq!(byte_count(text), Ok(count), "{text}");
        }
        for text in ["", "G", "-1", "1.5G", "1T", "99999999999G", "1GG"] {
            assert!(byte_count(text).is_err(), "{text}");
        }
    }
}
