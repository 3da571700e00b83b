//! The main job: a document's faces and vertices in a better order.

use std::collections::BTreeMap;
use std::fmt;

use super::counts::{Counts, USUAL_CACHES};
use super::file_report::FileReport;
use super::improve::{Improvement, improve};
use super::options::{Options, OptionsError};
use crate::cache::CacheModel;
use crate::files::{Document, FileError, MeshLevel};
use crate::order::Target;
use crate::permutation::{FaceOrder, VertexOrder};
use crate::progress::Progress;

/// Puts the faces of a document in an order that misses less, and its vertices in the order of their
/// first use, those of a group of more than 65,536 in blocks
/// ([`vertex_blocks`](crate::order::vertex_blocks())), those that levels of detail share in bands, so that what each level uses is a
/// prefix ([`vertex_bands`](crate::order::vertex_bands())).
///
/// A mesh or run whose order would not get better stays as it is: the misses of the target's caches are
/// added up, and a gain of less than .5 % counts as none. Vertices stay where no faces moved and
/// they would not be fetched better by as much; a group in blocks, or of so many vertices in bands, is judged as a whole. So a document that was optimised is not changed again,
/// except after a run with a budget, a time limit, the faithful mode or [`Options::allow_worse`]: what
/// is found for a mesh of up to 131,072 faces is ordered once more, and taken if that finds nothing;
/// in larger ones a second run gains less than what counts. The document is changed in memory:
/// [`Document::write`] writes it.
///
/// The result is the same on any number of threads, those of the current pool with feature
/// `parallel`.
///
/// # Errors
/// [`OptimizeError::Options`] for options that cannot be combined; nothing is changed then.
/// [`OptimizeError::File`] if the document refuses an order, which it does not for those made here.
///
/// # Complexity
/// The cost of the order, twice where it is checked, once or a few times more for levels that share more than 65,536 vertices, and one
/// count a cache before and after; 60 to 100 bytes a face on top of the document.
///
/// ```no_run
/// use std::path::Path;
/// use meshweft::files::{Document, ReadOptions};
/// use meshweft::operations::{Options, optimize};
///
/// let mut document = Document::open(Path::new("scene.glb"), ReadOptions::default())?;
/// let report = optimize(&mut document, &Options::default(), &())?;
/// if report.is_changed() {
///     document.write(Path::new("ordered.glb"))?;
/// }
/// println!("{}", report.to_json());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn optimize(
    document: &mut Document,
    options: &Options,
    progress: &dyn Progress,
) -> Result<OptimizeReport, OptimizeError> {
    options.check()?;
    if options.greedy.is_some() && progress.time_spent().is_some() {
        return Err(OptionsError::GreedyIsOnePass.into());
    }
    let models = counted_models(options.target);
    let before = Counts::of_each(document.meshes(), &models);
    let improvement = improve(document.meshes(), options, &models, &before, progress);
    improvement.apply(document)?;
    let improvement = improvement.settle(document, options, &models, progress)?;
    Ok(OptimizeReport::new(
        document,
        options,
        &models,
        before,
        improvement,
    ))
}

/// The caches that are ordered for, and the usual ones.
fn counted_models(target: Target) -> Vec<CacheModel> {
    let mut models = target.models().to_vec();
    models.extend(
        USUAL_CACHES
            .iter()
            .filter(|&model| !target.models().contains(model)),
    );
    models
}

/// Why a document was not optimised.
#[derive(Debug)]
#[non_exhaustive]
pub enum OptimizeError {
    /// The options cannot be combined.
    Options(OptionsError),
    /// The document does not take an order.
    File(FileError),
}

impl From<OptionsError> for OptimizeError {
    fn from(error: OptionsError) -> Self {
        Self::Options(error)
    }
}

impl From<FileError> for OptimizeError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

impl fmt::Display for OptimizeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Options(error) => error.fmt(f),
            Self::File(error) => error.fmt(f),
        }
    }
}

// No `source`: the text above already says it.
impl std::error::Error for OptimizeError {}

/// What [`optimize`] did. The caller may add where it went, its size there and the time it took.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct OptimizeReport {
    /// The file, and where it went.
    pub of_file: FileReport,
    /// What was asked for.
    pub options: Options,
    /// Each mesh.
    pub meshes: Vec<OptimizedMesh>,
    /// All meshes at full resolution together, without levels of detail.
    pub total: CountChange,
    /// Whether the caller stopped it before it was settled.
    pub is_stopped: bool,
    /// The vertex orders of the groups that were moved.
    vertex_orders: BTreeMap<usize, VertexOrder>,
}

/// What was counted before and after.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct CountChange {
    /// Before.
    pub before: Counts,
    /// After.
    pub after: Counts,
}

/// What was done to a mesh.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct OptimizedMesh {
    /// What the file calls it.
    pub name: String,
    /// Of which mesh it is a level of detail, if it is one.
    pub level: Option<MeshLevel>,
    /// What was counted before and after.
    pub change: CountChange,
    /// The order that its face records were put in.
    pub faces: FaceOrder,
    /// Why the faces were not reordered, although they can be.
    pub reason: Option<&'static str>,
    /// Pushes of the schedule for a controllable cache.
    pub scheduled: Option<u64>,
    pub(super) vertex_group: usize,
}

impl OptimizedMesh {
    /// Whether faces were moved or turned.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        !self.faces.is_identity()
    }
}

impl OptimizeReport {
    fn new(
        document: &Document,
        options: &Options,
        models: &[CacheModel],
        before: Vec<Counts>,
        improvement: Improvement,
    ) -> Self {
        let entries = document.meshes();
        let after = improvement.after;
        let total = CountChange {
            before: Counts::total(entries, &before, models),
            after: Counts::total(entries, &after, models),
        };

        let changes = before.into_iter().zip(after);
        let changes = changes.map(|(before, after)| CountChange { before, after });
        let meshes = entries.iter().zip(improvement.faces).zip(changes);
        let meshes = meshes.map(|((entry, faces), change)| OptimizedMesh {
            name: entry.name.clone(),
            level: entry.level,
            change,
            faces: faces.order,
            reason: faces.reason,
            scheduled: faces.scheduled,
            vertex_group: entry.vertex_group,
        });

        let vertex_orders = improvement.vertices.into_iter();
        let mut report = Self {
            of_file: FileReport::of(document),
            options: options.clone(),
            meshes: meshes.collect(),
            total,
            is_stopped: improvement.is_stopped,
            vertex_orders: vertex_orders
                .map(|(group, change)| (group, change.order))
                .collect(),
        };
        if !report.is_changed() {
            report.of_file.bytes_after = Some(report.of_file.bytes_before);
        }
        report
    }

    /// Whether any face or vertex was moved, or any corner turned.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        let faces = self.meshes.iter().any(OptimizedMesh::is_changed);
        faces || !self.vertex_orders.is_empty()
    }

    /// The order that the vertices of mesh `mesh` were put in, together with those of its group;
    /// `None` if they stay.
    ///
    /// # Panics
    /// If there is no such mesh.
    #[must_use]
    pub fn vertex_order(&self, mesh: usize) -> Option<&VertexOrder> {
        self.vertex_orders.get(&self.meshes[mesh].vertex_group)
    }

    /// Pushes of the schedules of all meshes at full resolution, if each has one.
    #[must_use]
    pub fn scheduled(&self) -> Option<u64> {
        let full = self.meshes.iter().filter(|mesh| mesh.level.is_none());
        let total: Option<u64> = full.map(|mesh| mesh.scheduled).sum();
        total.filter(|_| !self.meshes.is_empty())
    }

    /// The target's caches in which all meshes together miss more than before, although they miss less
    /// in all of its caches taken together.
    pub fn worse_in(&self) -> impl Iterator<Item = CacheModel> {
        let models = self.options.target.models();
        let pairs = self
            .total
            .before
            .misses
            .iter()
            .zip(&self.total.after.misses);
        let worse = pairs.filter(|((_, before), (_, after))| after > before);
        worse
            .map(|((model, _), _)| *model)
            .filter(|model| models.contains(model))
    }
}
