//! A walk over a terrain, frame by frame.

use std::ops::ControlFlow;

use super::error::TerrainError;
use super::numbered_surface::NumberedSurface;
use super::source::{TerrainFacts, TerrainSource};
use super::walk_buffers::TerrainBuffers;
use super::walk_options::TerrainWalkOptions;
use super::walk_report::TerrainWalkReport;
use crate::lod::CameraView;
use crate::lod::geometry_cache::{EvictionPolicy, RecordedPath};
use crate::lod::quad_tin::TinLimit;
use crate::operations::walks::{WalkFrame, WalkOptimum};
use crate::progress::Progress;

/// Walks over a terrain, and counts what each frame would send to a graphics card.
///
/// A frame finds the surface that the view needs on one way down from the coarsest one, gives the vertices that came a slot in the vertex
/// buffer, and patches the index buffer: of both is only known what there is. Vertices and faces have numbers from when they are first drawn, so memory is
/// in proportion to what the walk draws, and not to the terrain. Of a `.mwt` file only the blocks are read that a frame needs.
/// [`TerrainWalker`] walks more than once, or for several policies at a time.
///
/// `clock` gives seconds since any time; give `&|| 0.0` where there is no clock, and all times are 0. All else is the same in each
/// run.
///
/// # Errors
/// [`TerrainError`]: an option is out of range, a camera sees nothing, or a part of a file cannot be read.
///
/// # Complexity
/// A frame takes time O(faces); with a limit O(faces · log faces).
///
/// ```no_run
/// use meshweft::operations::{
///     TerrainReadOptions, TerrainSource, TerrainWalkOptions, WalkQuantity, terrain_walk,
/// };
///
/// let source = TerrainSource::open(&["puget.mwt".into()], &TerrainReadOptions::default())?;
/// let start = std::time::Instant::now();
/// let clock = || start.elapsed().as_secs_f64();
/// let report = terrain_walk(source, &TerrainWalkOptions::default(), &clock, &())?;
/// println!("{} inserts", report.summary(WalkQuantity::Inserts).total);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn terrain_walk(
    source: TerrainSource,
    options: &TerrainWalkOptions,
    clock: &dyn Fn() -> f64,
    progress: &dyn Progress,
) -> Result<TerrainWalkReport, TerrainError> {
    let mut walker = TerrainWalker::new(source);
    let mut reports = walker.walk(options, &[options.policy], clock, progress)?;
    Ok(reports.remove(0))
}

/// A terrain to walk over more than once, and with several eviction policies at a time: the surface of a frame is found once, and each policy
/// keeps it in its own buffers.
///
/// ```no_run
/// use meshweft::operations::{
///     EvictionPolicy, TerrainReadOptions, TerrainSource, TerrainWalkOptions, TerrainWalker,
///     WalkQuantity,
/// };
///
/// let source = TerrainSource::open(&["puget.mwt".into()], &TerrainReadOptions::default())?;
/// let mut walker = TerrainWalker::new(source);
/// let options = TerrainWalkOptions::default();
/// for report in walker.walk(&options, &EvictionPolicy::ALL, &|| 0.0, &())? {
///     let inserts = report.summary(WalkQuantity::Inserts).total;
///     println!("{}: {inserts}", report.options.policy);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct TerrainWalker {
    source: TerrainSource,
    /// How many bytes of the file were read before this frame.
    bytes_read: u64,
}

impl TerrainWalker {
    /// Over this terrain.
    #[must_use]
    pub fn new(source: TerrainSource) -> Self {
        Self {
            source,
            bytes_read: 0,
        }
    }

    /// What is walked over.
    #[must_use]
    pub fn terrain(&self) -> TerrainFacts {
        TerrainFacts::of(self.source.tin())
    }

    /// The same walk with each of these policies, in place of that of the options: reports in this order, each as [`terrain_walk`] gives it. The
    /// times to find the surface are the same in all. Of a `.mwt` file is read what no walk before needed.
    ///
    /// # Errors
    /// As [`terrain_walk`].
    ///
    /// # Complexity
    /// A frame takes the time of a frame of [`terrain_walk`], of which O(faces) counts for each policy.
    pub fn walk(
        &mut self,
        options: &TerrainWalkOptions,
        policies: &[EvictionPolicy],
        clock: &dyn Fn() -> f64,
        progress: &dyn Progress,
    ) -> Result<Vec<TerrainWalkReport>, TerrainError> {
        let of_policy = |&policy: &EvictionPolicy| TerrainWalkOptions {
            policy,
            ..options.clone()
        };
        let all: Vec<TerrainWalkOptions> = policies.iter().map(of_policy).collect();
        all.iter().try_for_each(TerrainWalkOptions::check)?;
        let terrain = self.terrain();
        let mut walk = TerrainWalk::new(&all)?;

        // All frames.
        let (mut frames, mut is_stopped) = (Vec::new(), false);
        let count = options.path.frame_count(options.frames);
        for number in 0..count {
            let view = options.view(&terrain, number, count)?;
            frames.push(self.frame(&mut walk, &view, number, clock)?);
            let done = (number + 1) as f64 / count as f64;
            if progress.report(done) == ControlFlow::Break(()) && number + 1 < count {
                is_stopped = true;
                break;
            }
        }

        // A report of each policy.
        let optimum = walk.path.map(|path| WalkOptimum::of(&path, options.slots));
        let report = |(place, options): (usize, TerrainWalkOptions)| TerrainWalkReport {
            file: self.source.file.clone(),
            options,
            terrain,
            file_bytes: self.source.bytes().map(|[length, _]| length),
            frames: frames.iter().map(|frame| frame[place]).collect(),
            optimum,
            distinct: [walk.surface.vertices.len(), walk.surface.faces.len()],
            is_stopped,
            notes: self.source.notes.clone(),
        };
        Ok(all.into_iter().enumerate().map(report).collect())
    }

    /// Draws a view with every policy of a walk.
    pub(super) fn frame(
        &mut self,
        walk: &mut TerrainWalk,
        view: &CameraView,
        number: usize,
        clock: &dyn Fn() -> f64,
    ) -> Result<Vec<WalkFrame>, TerrainError> {
        // What the view needs, by the numbers of this walk.
        let start = clock();
        walk.surface
            .draw(&mut self.source, view, walk.limit, number)?;
        let update_milliseconds = 1e3 * (clock() - start);
        let read = self.source.bytes().map_or(0, |[_, read]| read);
        let read_bytes = read - std::mem::replace(&mut self.bytes_read, read);
        if let Some(path) = &mut walk.path {
            path.grow(walk.surface.new_errors.len());
            path.push_active(&walk.surface.active)?;
        }

        // What each policy sends of it.
        let mut frames = Vec::new();
        for buffers in &mut walk.buffers {
            frames.push(WalkFrame {
                read_bytes,
                update_milliseconds,
                ..buffers.frame(&walk.surface, clock)?
            });
        }
        Ok(frames)
    }
}

/// What a walk has drawn so far.
pub(super) struct TerrainWalk {
    pub(super) surface: NumberedSurface,
    limit: Option<TinLimit>,
    /// Of each policy.
    pub(super) buffers: Vec<TerrainBuffers>,
    /// Only if the optimum is asked for.
    path: Option<RecordedPath>,
}

impl TerrainWalk {
    /// With buffers for each of these options, which differ in the policy only.
    pub(super) fn new(all: &[TerrainWalkOptions]) -> Result<Self, TerrainError> {
        let buffers = all.iter().map(TerrainBuffers::new);
        let limit = all.first().and_then(|options| options.limit);
        Ok(Self {
            surface: NumberedSurface::default(),
            limit: limit.map(TinLimit::Vertices),
            buffers: buffers.collect::<Result<_, _>>()?,
            path: (all.iter().any(|options| options.optimum)).then(|| RecordedPath::new(0)),
        })
    }
}
