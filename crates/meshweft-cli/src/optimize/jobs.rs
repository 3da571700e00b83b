//! Which files a run works on, and where each result goes.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Error, Result};
use meshweft::Limits;
use meshweft::files::{Format, external_buffers};

use crate::args::{Optimize, Usage};
use crate::inputs;

/// A file, and where its result goes.
pub(super) struct Job {
    pub(super) input: PathBuf,
    pub(super) target: PathBuf,
}

/// Every file to work on and where it goes.
pub(super) fn jobs(arguments: &Optimize) -> Result<Vec<Job>> {
    let output = arguments.output.as_deref();
    let inputs = inputs::expand(&arguments.inputs, output)?;
    let is_single = inputs.len() == 1 && arguments.inputs[0] == inputs[0].path;
    let is_folder = |out: &Path| out.is_dir() || out.as_os_str().as_encoded_bytes().ends_with(b"/");
    if !is_single {
        // A folder is made, unless the name is taken or looks like that of one mesh.
        let is_file =
            |out: &Path| !is_folder(out) && (out.exists() || Format::of_path(out).is_some());
        if output.is_some_and(is_file) {
            return Err(Usage("several files go into a folder: give -o FOLDER/".into()).into());
        }
        if arguments.write_permutation.is_some() {
            return Err(Usage("--write-permutation takes one file at a time".into()).into());
        }
    }
    let mut jobs = Vec::new();
    let mut input_of: BTreeMap<PathBuf, PathBuf> = BTreeMap::new();
    for input in inputs {
        let target = match output {
            None => input.path.clone(),
            Some(output) if !is_single || is_folder(output) => output.join(&input.relative),
            Some(output) => output.to_owned(),
        };
        let same =
            |a: &Path, b: &Path| Some(fs::canonicalize(a).ok()? == fs::canonicalize(b).ok()?);
        if output.is_some() && same(&target, &input.path) == Some(true) {
            return Err(Error::new(Usage(format!(
                "{} is the input itself: use --in-place to replace it",
                target.display()
            ))));
        }
        if let Some(other) = input_of.insert(target.clone(), input.path.clone()) {
            return Err(Error::new(Usage(format!(
                "{} and {} would both be written to {}: do them one at a time",
                other.display(),
                input.path.display(),
                target.display()
            ))));
        }
        let input = input.path;
        jobs.push(Job { input, target });
    }
    Ok(match arguments.shard {
        Some(shard) => shard.of(jobs),
        None => jobs,
    })
}

/// Buffers that two glTF files of one folder read: moved for one, they would be wrong for the
/// other.
pub(super) fn shared_buffers(jobs: &[Job]) -> Vec<PathBuf> {
    let is_gltf = |path: &Path| matches!(Format::of_path(path), Some(Format::Gltf | Format::Glb));
    let inputs = jobs.iter().filter(|job| is_gltf(&job.input));
    let folders: BTreeSet<&Path> = inputs.filter_map(|job| job.input.parent()).collect();
    let mut shared = Vec::new();
    for folder in folders {
        let here = match folder.as_os_str().is_empty() {
            true => Path::new("."),
            false => folder,
        };
        let entries = fs::read_dir(here).into_iter().flatten().flatten();
        // Paths as the inputs spell them.
        let paths = entries.map(|entry| folder.join(entry.file_name()));
        let mut seen = BTreeSet::new();
        for path in paths.filter(|path| is_gltf(path)) {
            // A file that cannot be read reads no buffer either.
            let buffers = external_buffers(&path, &Limits::default()).unwrap_or_default();
            for buffer in buffers.into_iter().collect::<BTreeSet<_>>() {
                if !seen.insert(buffer.clone()) {
                    shared.push(buffer);
                }
            }
        }
    }
    shared
}
