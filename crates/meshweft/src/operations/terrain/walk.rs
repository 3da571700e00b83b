//! A walk over a terrain, frame by frame.

use std::ops::ControlFlow;

use super::error::TerrainError;
use super::numbers::DistinctNumbers;
use super::source::{TerrainFacts, TerrainSource};
use super::walk_options::TerrainWalkOptions;
use super::walk_report::TerrainWalkReport;
use crate::lod::CameraView;
use crate::lod::geometry_cache::{FrameMode, GeometryCache, IndexSlots, RecordedPath};
use crate::lod::quad_tin::{TinLimit, TinSurface};
use crate::operations::walks::{WalkFrame, WalkOptimum, draw_passes};
use crate::progress::Progress;

/// Walks over a terrain, and counts what each frame would send to a graphics card.
///
/// A frame finds the surface that the view needs on one way down from the coarsest one, gives the vertices that came a slot in the vertex
/// buffer, and patches the index buffer: of both is only known what there is. Vertices and faces have numbers from when they are first drawn, so memory is
/// in proportion to what the walk draws, and not to the terrain. Of a `.mwt` file only the blocks are read that a frame needs.
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
    options.check()?;
    let terrain = TerrainFacts::of(source.tin());
    let mut report = TerrainWalkReport {
        file: source.file.clone(),
        options: options.clone(),
        terrain,
        file_bytes: source.bytes().map(|[length, _]| length),
        frames: Vec::new(),
        optimum: None,
        distinct: [0; 2],
        is_stopped: false,
        notes: source.notes.clone(),
    };

    // All frames.
    let mut walker = TerrainWalker::new(source, options)?;
    let count = options.path.frame_count(options.frames);
    for number in 0..count {
        let view = options.view(&terrain, number, count)?;
        report.frames.push(walker.frame(&view, number, clock)?);
        let done = (number + 1) as f64 / count as f64;
        if progress.report(done) == ControlFlow::Break(()) && number + 1 < count {
            report.is_stopped = true;
            break;
        }
    }

    report.distinct = [walker.vertices.len(), walker.faces.len()];
    report.optimum = walker
        .path
        .map(|path| WalkOptimum::of(&path, options.slots));
    Ok(report)
}

/// The terrain and the buffers of a renderer.
pub(super) struct TerrainWalker {
    source: TerrainSource,
    pub(super) surface: TinSurface,
    limit: Option<TinLimit>,
    pub(super) vertices: DistinctNumbers,
    pub(super) faces: DistinctNumbers,
    /// Of each face its vertices, all by the numbers of this walk.
    corners: Vec<[u32; 3]>,
    pub(super) cache: GeometryCache,
    pub(super) indices: IndexSlots,
    /// Only if the optimum is asked for.
    path: Option<RecordedPath>,
    vertex_size: usize,
    /// How many bytes of the file were read before this frame.
    bytes_read: u64,
    /// The errors of the vertices that came in a frame.
    errors: Vec<f32>,
    /// The corners of all faces of a frame, and these faces.
    active: Vec<u32>,
    living: Vec<(u32, [u32; 3])>,
}

impl TerrainWalker {
    pub(super) fn new(
        source: TerrainSource,
        options: &TerrainWalkOptions,
    ) -> Result<Self, TerrainError> {
        let cache = GeometryCache::new(options.slots, Vec::new(), options.policy)?;
        Ok(Self {
            source,
            surface: TinSurface::default(),
            limit: options.limit.map(TinLimit::Vertices),
            vertices: DistinctNumbers::default(),
            faces: DistinctNumbers::default(),
            corners: Vec::new(),
            cache: match options.passes {
                true => cache.with_passes(),
                false => cache,
            },
            indices: IndexSlots::new(0),
            path: options.optimum.then(|| RecordedPath::new(0)),
            vertex_size: options.vertex_size,
            bytes_read: 0,
            errors: Vec::new(),
            active: Vec::new(),
            living: Vec::new(),
        })
    }

    /// Draws a view.
    pub(super) fn frame(
        &mut self,
        view: &CameraView,
        number: usize,
        clock: &dyn Fn() -> f64,
    ) -> Result<WalkFrame, TerrainError> {
        // What the view needs, by the numbers of this walk.
        let start = clock();
        let surface = &mut self.surface;
        self.source.draw(view, self.limit, Some(number), surface)?;
        let new_faces = self.number_all();
        let updated = clock();

        // Slots for vertices.
        let new_vertices = self.errors.len();
        self.cache.grow(&self.errors)?;
        let upload = self.cache.set_active(&self.active)?;
        let (mode, statistics) = (upload.mode(), upload.statistics());
        let cached = clock();
        if let Some(path) = &mut self.path {
            path.grow(new_vertices);
            path.push_active(&self.active)?;
        }

        // Indices of faces.
        let recorded = clock();
        self.indices.grow(new_faces);
        let patch = self.indices.set_living(&self.cache, &self.living);
        let patch = patch.expect("all corners are active").statistics();
        let indexed = clock();

        let read = self.source.bytes().map_or(0, |[_, read]| read);
        let mut frame = WalkFrame {
            vertices: statistics.active,
            faces: self.living.len(),
            added: statistics.added,
            removed: statistics.removed,
            read_bytes: read - self.bytes_read,
            update_milliseconds: 1e3 * (updated - start),
            cache_milliseconds: 1e3 * (cached - updated),
            index_milliseconds: 1e3 * (indexed - recorded),
            ..WalkFrame::default()
        }
        .with_sent(mode, statistics, patch, self.vertex_size);
        self.bytes_read = read;
        if mode == FrameMode::Passes {
            draw_passes(
                &mut self.cache,
                self.indices.corners(),
                self.vertex_size,
                &mut frame,
            )?;
            frame.cache_milliseconds += 1e3 * (clock() - indexed);
        }
        Ok(frame)
    }

    /// Numbers the faces and vertices of the surface: how many faces are new.
    fn number_all(&mut self) -> usize {
        let before = self.faces.len();
        self.errors.clear();
        self.active.clear();
        self.living.clear();
        let tin = self.source.tin();
        for &(id, corners) in self.surface.faces() {
            let (face, is_new) = self.faces.number(id);
            if is_new {
                let corners = corners.map(|vertex| {
                    let (number, is_new) = self.vertices.number(vertex);
                    if is_new {
                        // What is always drawn is as coarse as can be.
                        self.errors.push(tin.error(vertex).min(f32::MAX));
                    }
                    number
                });
                self.corners.push(corners);
            }
            let corners = self.corners[face as usize];
            self.living.push((face, corners));
            self.active.extend(corners);
        }
        self.faces.len() - before
    }
}
