//! Which files a run works on, and where each result goes.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Result;
use meshweft::files::{Format, Outputs, shared_buffers};

use super::arguments::Run;
use super::inputs;
use crate::usage::Usage;

/// The work of a run.
pub(crate) struct Jobs {
    pub(crate) list: Vec<Job>,
    /// Whether the command line names one file, rather than a folder, a pattern or several.
    pub(crate) is_one_file: bool,
    /// Buffers that a file of the list reads and another file reads too, where files are replaced.
    pub(crate) shared_buffers: Vec<PathBuf>,
    pub(crate) outputs: Outputs,
}

/// A file, and where its result goes.
pub(crate) struct Job {
    pub(crate) input: PathBuf,
    pub(crate) target: PathBuf,
}

impl Jobs {
    /// Every file that `names` stand for, or the run's share of them, and where it goes.
    ///
    /// # Errors
    /// No place to write, several files to one place, an input that would be replaced unasked, and
    /// what [`inputs::expand`] refuses.
    pub(crate) fn new(names: &[PathBuf], run: &Run) -> Result<Self> {
        Self::called(names, run, |target| target)
    }

    /// The same with other names of what is written.
    fn called(names: &[PathBuf], run: &Run, name: impl Fn(PathBuf) -> PathBuf) -> Result<Self> {
        let output = run.output.as_deref();
        if output.is_none() && !run.in_place && !run.dry_run {
            let text = "where to? Give -o OUT, --in-place, or --dry-run";
            return Err(Usage(text.into()).into());
        }

        // An output folder of an earlier run is not an input, even within a folder that is one.
        let mut inputs = inputs::expand(names, output)?;
        if output.is_none() {
            // Of two names of one file, the first.
            let mut seen = BTreeSet::new();
            inputs.retain(|input| whole(&input.path).is_none_or(|path| seen.insert(path)));
        }
        let is_one_file = inputs.len() == 1 && names[0] == inputs[0].path;
        if !is_one_file && output.is_some_and(is_file) {
            return Err(Usage("several files go into a folder: give -o FOLDER/".into()).into());
        }

        // Where each goes; no two to the same place.
        let mut list = Vec::new();
        let mut input_of: BTreeMap<PathBuf, PathBuf> = BTreeMap::new();
        for input in inputs {
            let target = match output {
                None => input.path.clone(),
                Some(output) if !is_one_file || is_folder(output) => output.join(&input.relative),
                Some(output) => output.to_owned(),
            };
            let job = Job {
                input: input.path,
                target: name(target),
            };

            if output.is_some() {
                job.check_that_input_stays()?;
            }
            let place = whole(&job.target).unwrap_or_else(|| job.target.clone());
            if let Some(other) = input_of.insert(place, job.input.clone()) {
                return Err(job.collision_with(&other).into());
            }
            list.push(job);
        }

        // No job writes over what another one reads.
        if output.is_some() {
            let inputs: BTreeSet<PathBuf> =
                list.iter().filter_map(|job| whole(&job.input)).collect();
            let taken = |job: &&Job| whole(&job.target).is_some_and(|to| inputs.contains(&to));
            if let Some(job) = list.iter().find(taken) {
                return Err(Usage(format!(
                    "{} would be written over by {}, and is an input too: choose another output",
                    job.target.display(),
                    job.input.display()
                ))
                .into());
            }
        }

        // The share is taken last: all shares of a run are checked as a whole.
        let outputs = list
            .iter()
            .map(|job| (job.input.as_path(), job.target.as_path()));
        let outputs = Outputs::of(outputs);
        if let Some(shard) = run.shard {
            list = shard.of(list);
        }
        // With an output of its own, a file has buffers of its own.
        let shared = list.iter().map(|job| job.input.as_path());
        Ok(Self {
            shared_buffers: match output {
                Some(_) => Vec::new(),
                None => shared_buffers(shared),
            },
            outputs,
            list,
            is_one_file,
        })
    }
}

/// What the name of a level ends with, before its number.
const LEVEL: &str = "_LOD";

impl Jobs {
    /// As [`new`](Self::new), but each job writes `count` files, one for each level; that of level 1 is the target.
    ///
    /// # Errors
    /// Also that one of them is an input, or the target of two jobs.
    pub(crate) fn in_levels(names: &[PathBuf], run: &Run, count: usize) -> Result<Self> {
        let mut jobs = Self::called(names, run, |target| level_name(&target, 1))?;
        let inputs = jobs.list.iter().filter_map(|job| whole(&job.input));
        let inputs: BTreeSet<PathBuf> = inputs.collect();
        let mut seen = BTreeSet::new();
        for job in &jobs.list {
            for number in 1..=count {
                let target = job.at_level(number).target;
                if whole(&target).is_some_and(|target| inputs.contains(&target)) {
                    let (target, input) = (target.display(), job.input.display());
                    let text = format!(
                        "{target} would be written over by level {number} of {input}, and is an input too: choose \
                         another output"
                    );
                    return Err(Usage(text).into());
                }
                if !seen.insert(target.clone()) {
                    let text = format!("two levels would be written to {}", target.display());
                    return Err(Usage(text).into());
                }
            }
        }
        let levels = jobs.list.iter().flat_map(|job| {
            let targets = (1..=count).map(|number| job.at_level(number).target);
            targets.map(|target| (job.input.clone(), target))
        });
        let levels: Vec<(PathBuf, PathBuf)> = levels.collect();
        let pairs = levels.iter();
        jobs.outputs = Outputs::of(pairs.map(|(input, target)| (&**input, &**target)));
        Ok(jobs)
    }
}

/// A name with the number of a level before its ending.
fn level_name(path: &Path, number: usize) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    // The ending may be two, as .ply.gz.
    let without_gz = name.strip_suffix(".gz").unwrap_or(&name);
    let end = without_gz.rfind('.').filter(|&dot| dot > 0);
    let (stem, ending) = name.split_at(end.unwrap_or(without_gz.len()));
    path.with_file_name(format!("{stem}{LEVEL}{number}{ending}"))
}

impl Job {
    /// The job whose target is another level than this one's, which is the first.
    pub(crate) fn at_level(&self, number: usize) -> Self {
        let name = self.target.file_name().unwrap_or_default();
        let name = name.to_string_lossy();
        let first = format!("{LEVEL}1");
        let target = match name.rfind(&first) {
            Some(place) => {
                let (stem, ending) = (&name[..place], &name[place + first.len()..]);
                let name = format!("{stem}{LEVEL}{number}{ending}");
                self.target.with_file_name(name)
            }
            None => level_name(&self.target, number),
        };
        let input = self.input.clone();
        Self { input, target }
    }

    /// Refuses to write the GLB that is made of a file of another format under another ending.
    pub(crate) fn check_that_glb_fits(&self, format: Format, run: &Run) -> Result<(), Usage> {
        let becomes_glb = !matches!(format, Format::Gltf | Format::Glb);
        if !becomes_glb || run.dry_run || Format::of_path(&self.target) == Some(Format::Glb) {
            return Ok(());
        }
        Err(Usage(format!(
            "{}: a .glb is made of it: give the output that ending, not {}",
            self.input.display(),
            self.target.display()
        )))
    }

    /// Refuses a target that is the input: that takes `--in-place`.
    fn check_that_input_stays(&self) -> Result<(), Usage> {
        // Most targets do not exist yet, and then are not an input either.
        match whole(&self.target) {
            target @ Some(_) if target == whole(&self.input) => Err(Usage(format!(
                "{} is the input itself: use --in-place to replace it",
                self.target.display()
            ))),
            _ => Ok(()),
        }
    }

    /// The error of two inputs with one target.
    fn collision_with(&self, other: &Path) -> Usage {
        Usage(format!(
            "{} and {} would both be written to {}: do them one at a time",
            other.display(),
            self.input.display(),
            self.target.display()
        ))
    }
}

/// The one name of a file that is there.
fn whole(path: &Path) -> Option<PathBuf> {
    fs::canonicalize(path).ok()
}

/// The inputs and outputs of jobs.
pub(crate) fn names_of(jobs: &[Job]) -> impl Iterator<Item = &Path> {
    jobs.iter()
        .flat_map(|job| [job.input.as_path(), &job.target])
}

/// Whether an output is a folder, or is to become one.
fn is_folder(out: &Path) -> bool {
    out.is_dir() || out.as_os_str().as_encoded_bytes().ends_with(b"/")
}

/// Whether an output must be a file: its name is taken by one or looks like that of a mesh. Any
/// other name becomes a folder where several files need one.
fn is_file(out: &Path) -> bool {
    !is_folder(out) && (out.exists() || Format::of_path(out).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_numbered_before_the_ending() {
        for (name, expected) in [
            ("out/scan.ply", "out/scan_LOD3.ply"),
            ("scan.v2.ply.gz", "scan.v2_LOD3.ply.gz"),
            ("scan", "scan_LOD3"),
            ("a_LOD1.glb", "a_LOD1_LOD3.glb"),
            (".glb", ".glb_LOD3"),
        ] {
            let first = Job {
                input: PathBuf::new(),
                target: level_name(Path::new(name), 1),
            };
            assert_eq!(first.at_level(3).target, Path::new(expected));
        }
    }
}
