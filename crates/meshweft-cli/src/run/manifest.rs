//! The list of what a run has done, from which a later run continues where it was cut off.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use anyhow::{Context, Result};
use meshweft::operations::SCHEMA;
use serde_json::{Value, json};

use super::side_file::is_list;
use crate::usage::Usage;

/// A file of JSON lines, one for each finished input.
pub(super) struct Manifest {
    path: PathBuf,
    /// `None` if nothing is to be written.
    file: Option<Mutex<File>>,
    /// Input and output of what was done before.
    done: BTreeSet<(String, String)>,
}

impl Manifest {
    /// Reads what is in the manifest, and opens it, or a new one, unless nothing is to be written.
    pub(super) fn open(path: &Path, is_dry_run: bool) -> Result<Self> {
        let context = || path.display().to_string();
        // What is not a file, such as /dev/stdout, holds no list, and may be a pipe that nobody writes.
        let is_file = fs::metadata(path).map_or(true, |data| data.is_file());
        let read = match is_file {
            true => fs::read(path),
            false => Ok(Vec::new()),
        };
        let text = match read {
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(error).with_context(context),
        };

        if !is_list(text.as_bytes()) {
            let text =
                "not every line of this file is one that --manifest writes: choose another name";
            return Err(Usage(format!("--manifest {}: {text}", path.display())).into());
        }

        // What is done. Lines that are not whole, or say something else, are passed over.
        let mut done = BTreeSet::new();
        let lines = text
            .split_inclusive('\n')
            .filter(|line| line.ends_with('\n'));
        for line in lines {
            let Ok(line) = serde_json::from_str::<Value>(line) else {
                continue;
            };
            let member = |name: &str| line[name].as_str().map(str::to_owned);
            if line["status"] == "done"
                && let Some(pair) = member("file").zip(member("output"))
            {
                done.insert(pair);
            }
        }

        let path = path.to_owned();
        if is_dry_run {
            let file = None;
            return Ok(Self { path, file, done });
        }
        let file = OpenOptions::new().append(true).create(true).open(&path);
        let mut file = file.with_context(context)?;
        // A run that was killed may have left half a line: the next one must not be added to it.
        if !text.is_empty() && !text.ends_with('\n') {
            file.write_all(b"\n").with_context(context)?;
        }
        let file = Some(Mutex::new(file));
        Ok(Self { path, file, done })
    }

    /// Whether an earlier run wrote `output` from `input`, and it is still there.
    pub(super) fn has(&self, input: &Path, output: &Path) -> bool {
        // In the list, names that are not UTF-8 may be equal where they are not.
        if input.to_str().is_none() || output.to_str().is_none() {
            return false;
        }
        let pair = (input.display().to_string(), output.display().to_string());
        self.done.contains(&pair) && output.exists()
    }

    /// Adds the line of an input, unless nothing is to be written: the sums of its report, as JSON, or why it failed.
    pub(super) fn add(
        &self,
        input: &Path,
        output: &Path,
        result: Result<&str, String>,
    ) -> Result<()> {
        let Some(file) = &self.file else {
            return Ok(());
        };
        let mut line = json!({
            "schema": SCHEMA,
            "file": input.display().to_string(),
            "output": output.display().to_string(),
        });
        match result {
            Ok(total) => {
                line["status"] = "done".into();
                line["total"] = serde_json::from_str(total)?;
            }
            Err(error) => {
                line["status"] = "failed".into();
                line["error"] = error.into();
            }
        }

        // In one write: no other thread's line comes in between.
        let line = format!("{line}\n");
        let mut file = file.lock().unwrap_or_else(|lock| lock.into_inner());
        file.write_all(line.as_bytes())
            .with_context(|| self.path.display().to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names that JSON has to write otherwise.
    const NAMES: [&str; 5] = ["a.obj", "b \"c\".obj", "d\\e.obj", "f\ng.obj", "ü €.obj"];
    const CASES: usize = 100_000;

    /// A list of its own, removed at the end.
    struct List(PathBuf);

    impl List {
        fn new(name: &str) -> Self {
            let name = format!("meshweft-list-{}-{name}.jsonl", std::process::id());
            Self(std::env::temp_dir().join(name))
        }

        /// Writes the list as runs do, the third input failed; its bytes.
        fn filled(&self) -> Vec<u8> {
            let manifest = Manifest::open(&self.0, false).unwrap();
            for (i, name) in NAMES.iter().enumerate() {
                let result = match i {
                    2 => Err("line 3: \"x\" is not a number".to_owned()),
                    _ => Ok(r#"{"faces":12,"misses":{"before":{"fifo:12":30}}}"#),
                };
                let pair = (Path::new(name), output(name));
                manifest.add(pair.0, &pair.1, result).unwrap();
            }
            fs::read(&self.0).unwrap()
        }

        /// What a run finds done in these bytes, unless it refuses them.
        fn read(&self, bytes: &[u8]) -> Result<BTreeSet<(String, String)>> {
            // A new file each time: one that is cut to nothing is synced when it is closed.
            let _ = fs::remove_file(&self.0);
            fs::write(&self.0, bytes)?;
            Ok(Manifest::open(&self.0, true)?.done)
        }
    }

    impl Drop for List {
        fn drop(&mut self) {
            let _ = fs::remove_file(&self.0);
        }
    }

    fn output(name: &str) -> PathBuf {
        Path::new("out").join(name)
    }

    fn pair(name: &str) -> (String, String) {
        (name.to_owned(), output(name).display().to_string())
    }

    /// The names whose whole lines are in the bytes: what must be found done.
    fn whole<'a>(bytes: &[u8], lines: &[&[u8]]) -> Vec<&'a str> {
        let found: Vec<&[u8]> = bytes.split_inclusive(|&byte| byte == b'\n').collect();
        let names = NAMES.iter().enumerate().filter(|&(i, _)| i != 2);
        let whole = names.filter(|&(i, _)| found.contains(&lines[i]));
        whole.map(|(_, &name)| name).collect()
    }

    /// SplitMix64.
    fn below(state: &mut u64, limit: usize) -> usize {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        usize::try_from((z ^ (z >> 31)) % limit.max(1) as u64).unwrap()
    }

    /// The list with one to three things changed.
    fn changed(list: &[u8], state: &mut u64) -> Vec<u8> {
        let mut bytes = list.to_vec();
        for _ in 0..=below(state, 3) {
            let (a, b) = (below(state, bytes.len() + 1), below(state, bytes.len() + 1));
            let (a, b) = (a.min(b), a.max(b));
            match below(state, 6) {
                0 => bytes.truncate(b),
                1 => drop(bytes.drain(a..b)),
                2 => bytes.insert(a, u8::try_from(below(state, 256)).unwrap()),
                3 if a < bytes.len() => bytes[a] ^= 1 << below(state, 8),
                4 => bytes.insert(a, b"{}[]\",:\\\n\0"[below(state, 10)]),
                _ => {
                    let part = bytes[a..b].to_vec();
                    bytes.extend(part);
                }
            }
        }
        bytes
    }

    #[test]
    fn a_list_that_was_cut_off_anywhere_is_read_up_to_its_last_whole_line() {
        let list = List::new("cut");
        let bytes = list.filled();
        let lines: Vec<&[u8]> = bytes.split_inclusive(|&byte| byte == b'\n').collect();
        for end in 0..=bytes.len() {
            let done = list.read(&bytes[..end]).unwrap();
            let expected = whole(&bytes[..end], &lines);
            assert_eq!(
                done,
                expected.into_iter().map(pair).collect(),
                "{end} bytes"
            );
        }
    }

    #[test]
    fn any_list_is_read_or_refused_and_what_it_holds_stays() {
        let list = List::new("any");
        let original = list.filled();
        let lines: Vec<&[u8]> = original.split_inclusive(|&byte| byte == b'\n').collect();
        let mut state = 7;
        let mut accepted = 0;
        for case in 0..CASES {
            let bytes = changed(&original, &mut state);
            let done = list.read(&bytes);
            assert_eq!(fs::read(&list.0).unwrap(), bytes, "reading writes nothing");
            if let Ok(done) = &done {
                for name in whole(&bytes, &lines) {
                    assert!(done.contains(&pair(name)), "{name:?} of case {case}");
                }
            }

            // A further line comes after what is there, and is found again.
            if case % 10 == 0 {
                let opened = Manifest::open(&list.0, false);
                assert_eq!(opened.is_ok(), done.is_ok(), "case {case}");
                let Ok(manifest) = opened else {
                    continue;
                };
                manifest
                    .add(Path::new("new.obj"), &output("new.obj"), Ok("{}"))
                    .unwrap();
                let now = fs::read(&list.0).unwrap();
                assert!(now.starts_with(&bytes), "case {case}");
                let done = Manifest::open(&list.0, true).unwrap().done;
                assert!(done.contains(&pair("new.obj")), "case {case}");
                accepted += 1;
            }
        }
        assert!(
            accepted > CASES / 200,
            "only {accepted} of {} lists are read",
            CASES / 10
        );
    }

    #[cfg(unix)]
    #[test]
    fn a_device_holds_no_list_and_is_not_read() {
        // Reading it would never end.
        let manifest = Manifest::open(Path::new("/dev/zero"), false).unwrap();
        assert!(manifest.done.is_empty());
        manifest
            .add(Path::new("a.obj"), &output("a.obj"), Ok("{}"))
            .unwrap();
    }
}
