//! Are these the same triangles, and which order is better?

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::rc::Rc;

use serde_json::{Value, json};

use super::counts::Counts;
use super::json;
use crate::cache::CacheModel;
use crate::faces::turned;
use crate::files::{Document, FileError, MeshEntry, Note};
use crate::geometry::place_bits;

/// How two documents differ as triangles and in misses under these models.
///
/// Meshes at full resolution are compared with each other, and so is each level of detail with that of the same number. A document
/// that has more levels has the same triangles all the same.
///
/// # Errors
/// [`FileError`] if positions cannot be read.
///
/// # Complexity
/// Time O(faces · log faces), space 36 bytes a face and 12 a vertex of both, and the counts; vertices that
/// meshes share are counted once.
pub fn compare(
    a: &Document,
    b: &Document,
    models: &[CacheModel],
) -> Result<CompareReport, FileError> {
    // Positions tell vertices apart whatever their numbers; without them the numbers must do.
    let positions = [a.all_positions()?, b.all_positions()?];
    let is_by_position = positions.iter().all(Option::is_some);
    let by_position = |side: usize| positions[side].as_deref().filter(|_| is_by_position);
    let both = [by_level(a.meshes()), by_level(b.meshes())];
    let level = |number: usize| {
        let of = |side: usize| {
            let meshes = both[side].get(&number);
            meshes.map(|meshes| triangles(meshes, by_position(side)))
        };
        let of_both = [of(0), of(1)];
        let [in_a, in_b] = of_both
            .each_ref()
            .map(|it| it.as_deref().unwrap_or_default());
        ComparedLevel {
            number,
            faces: of_both.each_ref().map(|it| it.as_ref().map(Vec::len)),
            only_in: differences(in_a, in_b),
        }
    };
    let only_in = level(0).only_in;

    // Each level of detail that one of them has.
    let numbers = both.iter().flat_map(|levels| levels.keys().copied());
    let numbers: BTreeSet<usize> = numbers.filter(|&number| number > 0).collect();
    let levels = numbers.into_iter().map(level).collect();

    let sides = [a, b].map(|document| ComparedFile::new(document, models));
    let better = better(&sides[0].counts, &sides[1].counts);
    Ok(CompareReport {
        sides,
        only_in,
        levels,
        is_by_position,
        better,
    })
}

/// One entry a vertex.
type Positions = Rc<[[f32; 3]]>;

/// What [`compare`] found.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CompareReport {
    /// The two files.
    pub sides: [ComparedFile; 2],
    /// How many triangles at full resolution only one of them has.
    pub only_in: [usize; 2],
    /// The levels of detail that any of them has, from fine to coarse.
    pub levels: Vec<ComparedLevel>,
    /// Whether vertices were told apart by their positions, not by their numbers.
    pub is_by_position: bool,
    /// The side that misses less, under the first model that tells them apart: 0 or 1.
    pub better: Option<usize>,
}

/// A level of detail of two files that are compared: all meshes that are this level of another one.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ComparedLevel {
    /// 1 is the finest below full resolution.
    pub number: usize,
    /// How many faces it has in each; `None` where there is no such level.
    pub faces: [Option<usize>; 2],
    /// How many of its triangles only one of them has.
    pub only_in: [usize; 2],
}

impl ComparedLevel {
    /// Whether both have this level, with the same triangles.
    #[must_use]
    pub fn is_same(&self) -> bool {
        self.only_in == [0, 0] && self.faces[0] == self.faces[1]
    }

    fn json(&self) -> Value {
        json!({
            "level": self.number,
            "faces_a": self.faces[0],
            "faces_b": self.faces[1],
            "same_triangles": self.is_same(),
            "only_in_a": self.only_in[0],
            "only_in_b": self.only_in[1],
        })
    }
}

/// One of two files that are compared.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ComparedFile {
    /// The file.
    pub file: PathBuf,
    /// Its size and that of the buffers beside it that were read.
    pub bytes: u64,
    /// All meshes at full resolution together, without levels of detail.
    pub counts: Counts,
    /// What cannot be re-ordered, and why.
    pub notes: Vec<Note>,
}

impl ComparedFile {
    fn new(document: &Document, models: &[CacheModel]) -> Self {
        let entries = document.meshes();
        let counts = Counts::of_each(entries, models);
        Self {
            file: document.path().to_owned(),
            bytes: document.source_bytes(),
            counts: Counts::total(entries, &counts, models),
            notes: document.notes().to_vec(),
        }
    }

    fn json(&self) -> Value {
        let mut object = self.counts.json();
        let file = self.file.display().to_string();
        object.shift_insert(0, "file".into(), json!(file));
        object.shift_insert(1, "bytes".into(), json!(self.bytes));
        Value::Object(object)
    }
}

impl CompareReport {
    /// Whether both have the same triangles at full resolution.
    #[must_use]
    pub fn is_same(&self) -> bool {
        self.only_in == [0, 0]
    }

    /// Whether both have the same levels of detail, with the same triangles.
    #[must_use]
    pub fn has_same_levels(&self) -> bool {
        self.levels.iter().all(ComparedLevel::is_same)
    }

    /// The better side as `a`, `b` or `equal`.
    #[must_use]
    pub fn better_name(&self) -> &'static str {
        match self.better {
            Some(0) => "a",
            Some(_) => "b",
            None => "equal",
        }
    }

    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let compared_by = match self.is_by_position {
            true => "position",
            false => "vertex number",
        };
        let [only_in_a, only_in_b] = self.only_in;
        let mut report = json::head("compare");
        report.insert("a".into(), self.sides[0].json());
        report.insert("b".into(), self.sides[1].json());
        report.insert("same_triangles".into(), json!(self.is_same()));
        report.insert("compared_by".into(), json!(compared_by));
        report.insert("only_in_a".into(), json!(only_in_a));
        report.insert("only_in_b".into(), json!(only_in_b));
        report.insert("same_levels".into(), json!(self.has_same_levels()));
        let levels = self.levels.iter().map(ComparedLevel::json);
        report.insert("levels".into(), levels.collect());
        report.insert("better".into(), json!(self.better_name()));
        Value::Object(report).to_string()
    }
}

/// Which side misses less a face, under the first model that tells them apart.
fn better(a: &Counts, b: &Counts) -> Option<usize> {
    for ((_, misses_a), (_, misses_b)) in a.misses.iter().zip(&b.misses) {
        // The numbers of faces may differ: cross-multiplied, so that nothing is rounded.
        let left = u128::from(*misses_a) * b.faces.max(1) as u128;
        let right = u128::from(*misses_b) * a.faces.max(1) as u128;
        match left.cmp(&right) {
            Ordering::Less => return Some(0),
            Ordering::Greater => return Some(1),
            Ordering::Equal => {}
        }
    }
    None
}

/// The meshes of each level of detail with their numbers; level 0 is full resolution.
fn by_level(entries: &[MeshEntry]) -> BTreeMap<usize, Vec<(usize, &MeshEntry)>> {
    let mut levels: BTreeMap<usize, Vec<(usize, &MeshEntry)>> = BTreeMap::new();
    for (mesh, entry) in entries.iter().enumerate() {
        let number = entry.level.map_or(0, |level| level.number);
        levels.entry(number).or_default().push((mesh, entry));
    }
    levels
}

/// All triangles, sorted; a triangle starts at its least corner, the orientation kept.
fn triangles(
    meshes: &[(usize, &MeshEntry)],
    positions: Option<&[Positions]>,
) -> Vec<[[u32; 3]; 3]> {
    let mut triangles = Vec::new();
    for &(mesh, entry) in meshes {
        let identity = |vertex: u32| match positions {
            Some(positions) => place_bits(positions[mesh][vertex as usize]),
            None => [vertex, 0, 0],
        };
        for face in entry.mesh.faces() {
            let corners = face.map(identity);
            let turns = [0, 1, 2].map(|rotation| turned(corners, rotation));
            triangles.push(turns.into_iter().min().unwrap_or(corners));
        }
    }
    triangles.sort_unstable();
    triangles
}

/// How many entries each of two sorted lists has that the other has not.
fn differences<T: Ord>(a: &[T], b: &[T]) -> [usize; 2] {
    let (mut i, mut j, mut common) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        match a[i].cmp(&b[j]) {
            Ordering::Less => i += 1,
            Ordering::Greater => j += 1,
            Ordering::Equal => {
                (i, j) = (i + 1, j + 1);
                common += 1;
            }
        }
    }
    [a.len() - common, b.len() - common]
}
