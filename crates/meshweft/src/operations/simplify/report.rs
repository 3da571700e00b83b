//! What was simplified.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use super::levels::LevelFigures;
use super::options::{SimplifyOptions, SimplifyOptionsError};
use super::reduced::Reduced;
use super::removals::Removals;
use crate::files::{Document, FileError, Note};
use crate::geometry::Distances;
use crate::operations::counts::Counts;
use crate::operations::file_report::FileReport;
use crate::operations::optimize::{CountChange, OptimizeReport};
use crate::progressive::StopReason;

/// Why a document was not simplified.
#[derive(Debug)]
#[non_exhaustive]
pub enum SimplifyError {
    /// The options make no sense.
    Options(SimplifyOptionsError),
    /// The document does not take an order.
    File(FileError),
    /// A mesh has levels of detail, which would no longer be levels of what it becomes.
    HasLevels {
        /// The file.
        file: PathBuf,
        /// The mesh.
        mesh: String,
    },
}

impl fmt::Display for SimplifyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Options(error) => error.fmt(f),
            Self::File(error) => error.fmt(f),
            Self::HasLevels { file, mesh } => write!(
                f,
                "{}: {mesh} has levels of detail already: simplify the file that they were made from",
                file.display()
            ),
        }
    }
}

// No `source`: the text above already says it.
impl std::error::Error for SimplifyError {}

/// What [`simplify`](super::simplify) did. The caller may add where it went, its size there and the time it
/// took.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SimplifyReport {
    /// The file, and where it went.
    pub of_file: FileReport,
    /// What was asked for.
    pub options: SimplifyOptions,
    /// Each mesh.
    pub meshes: Vec<SimplifiedMesh>,
    /// What was simplified together: each object with faces.
    pub objects: Vec<SimplifiedObject>,
    /// All meshes together.
    pub total: CountChange,
    /// Whether the caller stopped it before it was done.
    pub is_stopped: bool,
}

/// What was done to a mesh.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SimplifiedMesh {
    /// What the file calls it.
    pub name: String,
    /// What was counted before and after.
    pub change: CountChange,
    /// For each vertex of the source the one that stands for it, by its number in the source: itself if it
    /// is still there, nothing if it left with a whole part.
    pub fine_to_coarse: Vec<Option<u32>>,
    /// The vertex of the source that each vertex is; `None` in files that store corners, as STL does.
    pub vertices: Option<Vec<u32>>,
}

/// What was done to meshes that were simplified together.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SimplifiedObject {
    /// Their numbers.
    pub meshes: Vec<usize>,
    /// How many faces they had together, and have.
    pub faces: [usize; 2],
    /// How many they were to have at most; 0 where only an error was the limit.
    pub goal: usize,
    /// Why no more faces left.
    pub stop: StopReason,
    /// Why it stayed as it is, if it cannot be simplified.
    pub refused: Option<String>,
    /// The error of the last removal, as an estimate in units of the positions.
    pub estimated_error: f32,
    /// How far the result is from the source, as measured from both, in units of the positions; `None` if
    /// nothing was removed, or nothing measured.
    pub distances: Option<Distances>,
    /// The diagonal of its bounding box.
    pub diagonal: f64,
    /// In which order vertices leave, if that was asked for.
    pub removals: Option<Removals>,
    /// Figures of some levels, fine to coarse, if these were asked for.
    pub levels: Vec<LevelFigures>,
}

impl SimplifiedObject {
    /// Whether it has fewer faces.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.faces[0] != self.faces[1]
    }

    /// A length as a share of the diagonal; 0 if that is.
    #[must_use]
    pub fn of_diagonal(&self, length: f64) -> f64 {
        match self.diagonal > 0.0 {
            true => length / self.diagonal,
            false => 0.0,
        }
    }
}

/// What a report is made of.
pub(super) struct ReportParts<'a> {
    pub(super) document: &'a Document,
    pub(super) options: &'a SimplifyOptions,
    pub(super) objects: Vec<Vec<usize>>,
    pub(super) goals: Vec<usize>,
    pub(super) outcomes: Vec<Result<Reduced, String>>,
    /// The vertices that stay of each group of which some leave.
    pub(super) kept: BTreeMap<usize, Vec<u32>>,
    pub(super) before: Vec<Counts>,
    pub(super) total_before: Counts,
    pub(super) ordered: Option<OptimizeReport>,
    pub(super) is_stopped: bool,
    pub(super) notes: Vec<Note>,
}

pub(super) fn report(parts: ReportParts<'_>) -> SimplifyReport {
    let document = parts.document;
    let (entries, before) = (document.meshes(), &parts.before);

    // The meshes, none simplified yet.
    let meshes = entries.iter().zip(before).enumerate();
    let meshes = meshes.map(|(mesh, (entry, before))| {
        let ordered = parts.ordered.as_ref();
        let after = ordered.map_or(before, |it| &it.meshes[mesh].change.after);
        SimplifiedMesh {
            name: entry.name.clone(),
            change: CountChange {
                before: before.clone(),
                after: after.clone(),
            },
            fine_to_coarse: numbers(before.vertices).map(Some).collect(),
            vertices: vertices(&parts, mesh),
        }
    });
    let mut meshes: Vec<SimplifiedMesh> = meshes.collect();
    let is_changed = parts.ordered.is_some();
    let total_after = parts.ordered.as_ref().map(|it| it.total.after.clone());

    // The objects.
    let mut objects = Vec::with_capacity(parts.objects.len());
    let outcomes = parts.objects.into_iter().zip(parts.goals);
    for ((members, goal), outcome) in outcomes.zip(parts.outcomes) {
        let faces = members.iter().map(|&mesh| parts.before[mesh].faces).sum();
        let mut object = SimplifiedObject {
            meshes: members,
            faces: [faces; 2],
            goal,
            stop: StopReason::NothingLeft,
            refused: None,
            estimated_error: 0.0,
            distances: None,
            diagonal: 0.0,
            removals: None,
            levels: Vec::new(),
        };
        match outcome {
            Err(why) => object.refused = Some(why),
            Ok(reduced) => {
                object.faces = [reduced.faces_before, reduced.faces_after];
                object.stop = reduced.stop;
                object.estimated_error = reduced.estimated_error;
                object.distances = reduced.distances;
                object.diagonal = reduced.diagonal;
                object.removals = reduced.removals;
                object.levels = reduced.levels;
                for mesh in reduced.meshes {
                    meshes[mesh.mesh].fine_to_coarse = mesh.fine_to_coarse;
                }
            }
        }
        objects.push(object);
    }

    let mut of_file = FileReport::of(document);
    of_file.bytes_after = (!is_changed).then_some(of_file.bytes_before);
    of_file.notes.extend(parts.notes);
    SimplifyReport {
        of_file,
        options: parts.options.clone(),
        meshes,
        objects,
        total: CountChange {
            after: total_after.unwrap_or_else(|| parts.total_before.clone()),
            before: parts.total_before,
        },
        is_stopped: parts.is_stopped,
    }
}

/// The vertex of the source that each vertex of a mesh is, if vertices are what the file stores.
fn vertices(parts: &ReportParts<'_>, mesh: usize) -> Option<Vec<u32>> {
    let entry = &parts.document.meshes()[mesh];
    let count = parts.before[mesh].vertices;
    let kept = parts.kept.get(&entry.vertex_group);
    let kept = kept.map_or_else(|| numbers(count).collect(), Vec::clone);
    let ordered = parts.ordered.as_ref();
    // Without indices every corner has a vertex of its own.
    let triples = (0_u32..).zip(entry.mesh.faces().as_flattened());
    if !entry.vertices_movable && triples.fold(true, |all, (at, &vertex)| all && at == vertex) {
        return None;
    }
    match ordered.and_then(|ordered| ordered.vertex_order(mesh)) {
        Some(order) if order.len() == kept.len() => Some(order.permutation().apply(&kept)),
        Some(_) => None,
        None => (entry.mesh.vertex_count() == kept.len()).then_some(kept),
    }
}

fn numbers(count: usize) -> std::ops::Range<u32> {
    0..crate::index::index32(count)
}

impl SimplifyReport {
    /// Whether any face left.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.objects.iter().any(SimplifiedObject::is_changed)
    }
}
