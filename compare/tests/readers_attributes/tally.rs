//! Every file of the test data that opens, and the tally of what was compared.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::io::Read;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::attribute::{Attribute, AttributeInfo, Semantic, Values};
use meshweft::files::{Document, Format};

use crate::made::Made;

/// Folders of the test data that hold no meshes.
const NO_MESHES: [&str; 2] = ["nvidia", "terrain"];

/// Folders of files that must open.
const GOOD_FILES: [&str; 2] = ["gltf", "meshes"];

/// What was compared, and what was not.
pub(super) struct Tally {
    reader: &'static str,
    files: usize,
    attributes: BTreeMap<String, usize>,
    numbers: usize,
    left_out: BTreeMap<String, usize>,
    /// Files that the other reader does not open, and why.
    refused: Vec<String>,
}

/// A file that opens.
pub(super) struct Opened {
    /// Its path within the test data.
    pub(super) name: String,
    pub(super) bytes: Vec<u8>,
    pub(super) document: Document,
}

impl Opened {
    /// One that is made.
    fn made(name: &str, bytes: Vec<u8>) -> Self {
        let path = Path::new(name);
        let format = Format::of_path(path).expect("a known ending");
        let document = Document::from_bytes(bytes.clone(), format, path, Limits::default());
        Self {
            name: name.to_owned(),
            bytes,
            document: document.unwrap_or_else(|error| panic!("{error}")),
        }
    }

    /// The attributes of the only mesh that a file of these formats has.
    pub(super) fn attributes(&self) -> Vec<AttributeInfo> {
        assert_eq!(self.document.meshes().len(), 1, "{}", self.name);
        self.document.attributes(0)
    }

    pub(super) fn read(&self, info: &AttributeInfo) -> Attribute {
        let read = self.document.attribute(0, info);
        read.unwrap_or_else(|error| panic!("{}", error))
    }

    /// Elements of vertices as elements of corners.
    pub(super) fn of_corners(&self, elements: &[u64], components: usize) -> Vec<u64> {
        let corners = self.document.meshes()[0].mesh.faces().as_flattened();
        let element = |&vertex: &u32| &elements[vertex as usize * components..][..components];
        corners.iter().flat_map(element).copied().collect()
    }
}

impl Tally {
    /// Hands over every file with this ending, and those that are made, and says what came of it past
    /// the test harness.
    pub(super) fn of_files(
        reader: &'static str,
        ending: &str,
        made: Vec<Made>,
        compare: impl Fn(&Opened, &mut Self) -> Result<(), String>,
    ) {
        let mut tally = Self {
            reader,
            files: 0,
            attributes: BTreeMap::new(),
            numbers: 0,
            left_out: BTreeMap::new(),
            refused: Vec::new(),
        };

        // What is made must be read, and needs no test data.
        for (name, bytes) in made {
            compare(&Opened::made(name, bytes), &mut tally)
                .unwrap_or_else(|e| panic!("{name}: {e}"));
            tally.files += 1;
        }

        // The test data, if it is there.
        match compare::data_folder() {
            Some(data) => tally.add_data(&data, ending, compare),
            None => tally.leave_out(1, "folder of test data, which is not there: SKIPPED"),
        }

        // What came of it.
        let what = format!("files refused by the other reader {:?}", tally.refused);
        tally.leave_out(tally.refused.len(), &what);
        compare::say(&tally.summary());
    }

    /// Hands over every file of the test data with this ending.
    fn add_data(
        &mut self,
        data: &Path,
        ending: &str,
        compare: impl Fn(&Opened, &mut Self) -> Result<(), String>,
    ) {
        let before = self.files;
        for file in files_below(data, ending) {
            let Some(opened) = self.open(&file, data) else {
                continue;
            };
            if opened.document.meshes().is_empty() {
                self.leave_out(1, "files without faces");
                continue;
            }
            match compare(&opened, self) {
                Ok(()) => self.files += 1,
                Err(error) => {
                    let error = error.lines().next().unwrap_or_default();
                    self.refused.push(format!("{}: {error}", opened.name));
                }
            }
        }
        assert!(self.files > before, "{}: no file was compared", self.reader);
    }

    fn open(&mut self, file: &Path, data: &Path) -> Option<Opened> {
        let relative = file.strip_prefix(data).expect("it is below the folder");
        let name = relative.to_string_lossy().into_owned();
        match Document::open(file, Limits::default()) {
            Ok(document) => Some(Opened {
                name,
                bytes: unzipped(file),
                document,
            }),
            Err(error) => {
                let folder = name.split('/').next().unwrap_or_default();
                assert!(!GOOD_FILES.contains(&folder), "{error}");
                self.leave_out(1, &format!("files of {folder}/ refused by meshweft"));
                None
            }
        }
    }

    /// Counts what is not compared.
    pub(super) fn leave_out(&mut self, count: usize, what: &str) {
        if count > 0 {
            *self.left_out.entry(what.to_owned()).or_default() += count;
        }
    }

    /// Compares the values of an attribute, elements of several components, as bits.
    ///
    /// # Panics
    /// If they differ: with the first element that does.
    pub(super) fn compare(
        &mut self,
        (file, info): (&Opened, &AttributeInfo),
        components: usize,
        ours: &[u64],
        theirs: &[u64],
    ) {
        let what = format!("{}, {}", file.name, info.semantic);

        // Not `assert_eq`, which would print millions of numbers.
        let elements = ours.chunks(components).zip(theirs.chunks(components));
        for (at, (ours, theirs)) in elements.enumerate() {
            let reader = self.reader;
            assert!(
                ours == theirs,
                "{what}: element {at} is {ours:x?}, where {reader} has {theirs:x?}"
            );
        }
        assert_eq!(ours.len(), theirs.len(), "{what}: how many numbers");

        let semantic = match &info.semantic {
            Semantic::Other(_) => "other".to_owned(),
            known => known.to_string(),
        };
        let kind = format!("{semantic} of {:?}", info.domain).to_lowercase();
        *self.attributes.entry(kind).or_default() += 1;
        self.numbers += ours.len();
    }

    fn summary(&self) -> String {
        let list = |counts: &BTreeMap<String, usize>| {
            let words: Vec<String> = counts
                .iter()
                .map(|(what, n)| format!("{n} {what}"))
                .collect();
            words.join(", ")
        };
        let mut line = format!(
            "attributes, {}: {} files and meshes, {} attributes ({} numbers) are the same bit by bit: {}",
            self.reader,
            self.files,
            self.attributes.values().sum::<usize>(),
            self.numbers,
            list(&self.attributes),
        );
        match self.left_out.is_empty() {
            true => line.push_str("; left out: nothing"),
            false => {
                write!(line, "; left out: {}", list(&self.left_out)).expect("a string takes all")
            }
        }
        line
    }
}

/// The numbers as bit patterns; whole numbers as those of 64 bits.
pub(super) fn bits(values: &Values) -> Vec<u64> {
    fn whole<T: Copy + Into<i64>>(values: &[T]) -> Vec<u64> {
        let whole = values.iter().map(|&value| value.into().cast_unsigned());
        whole.collect()
    }
    match values {
        Values::I8(values) => whole(values),
        Values::U8(values) => whole(values),
        Values::I16(values) => whole(values),
        Values::U16(values) => whole(values),
        Values::I32(values) => whole(values),
        Values::U32(values) => whole(values),
        Values::F32(values) => bits_of_f32(values),
        Values::F64(values) => values.iter().map(|value| value.to_bits()).collect(),
        other => panic!("values of type {:?}", other.component_type()),
    }
}

pub(super) fn bits_of_f32(values: &[f32]) -> Vec<u64> {
    let bits = values.iter().map(|value| u64::from(value.to_bits()));
    bits.collect()
}

/// The files of the test data with this ending, gzipped or not, sorted.
fn files_below(data: &Path, ending: &str) -> Vec<PathBuf> {
    let mut folders = vec![data.to_owned()];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder of test data") {
            let path = entry.expect("an entry of a folder").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let has_meshes = !NO_MESHES.contains(&name.as_ref());
            let found = name.trim_end_matches(".gz").rsplit('.').next();
            match path.is_dir() {
                true if has_meshes => folders.push(path),
                false if found == Some(ending) => files.push(path),
                _ => {}
            }
        }
    }
    files.sort();
    files
}

fn unzipped(file: &Path) -> Vec<u8> {
    let bytes = std::fs::read(file).expect("the file can be read");
    if file.extension().is_none_or(|ending| ending != "gz") {
        return bytes;
    }
    let mut plain = Vec::new();
    flate2::read::MultiGzDecoder::new(&bytes[..])
        .read_to_end(&mut plain)
        .expect("the file is whole");
    plain
}
