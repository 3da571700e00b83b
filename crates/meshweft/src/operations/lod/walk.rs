//! A walk around a mesh, frame by frame.

use std::ops::ControlFlow;

use super::detail_front::{DetailFront, LoadedFront};
use super::options::{LodError, LodWalkOptions};
use super::report::{LodWalkReport, WalkedMesh};
use super::source::LodSource;
use crate::index::index32;
use crate::lod::CameraView;
use crate::lod::geometry_cache::{
    FrameMode, GeometryCache, GeometryCacheError, IndexSlots, RecordedPath,
};
use crate::operations::walks::{WalkFrame, WalkOptimum, draw_passes};
use crate::progress::{PartOfWork, Progress};

/// Walks around the meshes of a document, all as one, or around a `.mwl` file, and counts what each frame would send to a graphics
/// card.
///
/// A frame changes the front of a vertex hierarchy as the view needs it, gives the vertices that came a slot in the vertex buffer, and
/// patches the index buffer. Positions and faces count, as the file stores them: nodes of a glTF move nothing, and vertices of
/// equal positions are one. Of a `.mwl` file only the blocks are read that a frame needs; all else is as in a walk around the mesh
/// of which it was made.
///
/// `clock` gives seconds since any time; give `&|| 0.0` where there is no clock, and all times are 0. All else is the same in each
/// run.
///
/// # Errors
/// [`LodError`]: an option is out of range, there are no faces or no positions, a camera sees nothing, or a part of a file cannot be
/// read.
///
/// # Complexity
/// That of [`FastMesh::build`](crate::lod::fast_mesh::FastMesh::build), and of [`Front::update`](crate::lod::fast_mesh::Front::update) for each frame.
///
/// ```no_run
/// use std::path::Path;
/// use meshweft::files::{Document, ReadOptions};
/// use meshweft::operations::{LodWalkOptions, WalkQuantity, lod_walk};
///
/// let document = Document::open(Path::new("scan.ply"), ReadOptions::default())?;
/// let start = std::time::Instant::now();
/// let clock = || start.elapsed().as_secs_f64();
/// let report = lod_walk(&document, &LodWalkOptions::default(), &clock, &())?;
/// println!("{} inserts", report.summary(WalkQuantity::Inserts).total);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn lod_walk<'a>(
    source: impl Into<LodSource<'a>>,
    options: &LodWalkOptions,
    clock: &dyn Fn() -> f64,
    progress: &dyn Progress,
) -> Result<LodWalkReport, LodError> {
    options.check()?;
    let start = clock();
    let LoadedFront {
        file,
        detail,
        ball,
        notes,
        done,
        is_stopped,
    } = LoadedFront::new(source.into(), progress)?;
    let build_seconds = clock() - start;
    let coarsest = detail.front();
    let mut report = LodWalkReport {
        file,
        options: options.clone(),
        mesh: WalkedMesh {
            vertices: coarsest.hierarchy().vertex_count(),
            faces: coarsest.hierarchy().face_count(),
            roots: coarsest.vertex_count(),
        },
        file_bytes: detail.bytes().map(|[length, _]| length),
        frames: Vec::new(),
        optimum: None,
        build_seconds,
        is_stopped,
        notes,
    };

    // All frames.
    let mut walker = Walker::new(detail, options)?;
    let progress = PartOfWork::new(progress, done, 1.0);
    let count = options.path.frame_count(options.frames);
    let walked = if is_stopped { 0 } else { count };
    for number in 0..walked {
        let view = options.view(ball, number, count)?;
        report.frames.push(walker.frame(&view, number, clock)?);
        let done = (number + 1) as f64 / count as f64;
        if progress.report(done) == ControlFlow::Break(()) && number + 1 < count {
            report.is_stopped = true;
            break;
        }
    }

    report.optimum = walker
        .path
        .map(|path| WalkOptimum::of(&path, options.slots));
    Ok(report)
}

/// The front and the buffers of a renderer.
pub(super) struct Walker {
    pub(super) detail: DetailFront,
    pub(super) cache: GeometryCache,
    pub(super) indices: IndexSlots,
    /// Only if the optimum is asked for.
    pub(super) path: Option<RecordedPath>,
    hysteresis: f64,
    vertex_size: usize,
    /// How many bytes of the file were read before this frame.
    bytes_read: u64,
    /// What a card would draw of the first frame is all new to it.
    is_first: bool,
    /// The faces that came or have other corners.
    patched: Vec<(u32, [u32; 3])>,
}

impl Walker {
    pub(super) fn new(
        detail: DetailFront,
        options: &LodWalkOptions,
    ) -> Result<Self, GeometryCacheError> {
        let hierarchy = detail.front().hierarchy();
        let vertices = hierarchy.vertex_count();
        let errors = match detail.knows_errors() {
            true => (0..index32(vertices))
                .map(|it| hierarchy.error(it))
                .collect(),
            false => vec![0.0; vertices],
        };
        let cache = GeometryCache::new(options.slots, errors, options.policy)?;
        Ok(Self {
            cache: match options.passes {
                true => cache.with_passes(),
                false => cache,
            },
            indices: IndexSlots::new(hierarchy.face_slot_count()),
            path: options.optimum.then(|| RecordedPath::new(vertices)),
            hysteresis: options.hysteresis,
            vertex_size: options.vertex_size,
            bytes_read: 0,
            is_first: true,
            patched: Vec::new(),
            detail,
        })
    }

    /// Draws a view.
    pub(super) fn frame(
        &mut self,
        view: &CameraView,
        number: usize,
        clock: &dyn Fn() -> f64,
    ) -> Result<WalkFrame, LodError> {
        // What the view needs.
        let start = clock();
        self.detail.update(view, self.hysteresis, number)?;
        let front = self.detail.front();
        let updated = clock();

        // In the order of their numbers, which does not depend on what had been read when. Fine ones leave first.
        let changes = front.changes();
        let [mut added, mut removed] = match self.is_first {
            false => [&changes.added_vertices, &changes.removed_vertices].map(Vec::clone),
            true => [front.vertices().collect(), Vec::new()],
        };
        added.sort_unstable();
        removed.sort_unstable_by(|a, b| b.cmp(a));
        self.patched.clear();
        match self.is_first {
            true => self.patched.extend(front.faces()),
            false => {
                let faces = changes.added_faces.iter().chain(&changes.changed_faces);
                let corners = |&face: &u32| Some((face, front.face(face)?));
                self.patched.extend(faces.filter_map(corners));
            }
        }
        self.patched.sort_unstable();
        let mut removed_faces = changes.removed_faces.clone();
        removed_faces.sort_unstable();

        // Slots for vertices.
        let sorted = clock();
        if !self.detail.knows_errors() {
            for &vertex in &added {
                self.cache
                    .set_error(vertex, front.hierarchy().error(vertex))?;
            }
        }
        let upload = self.cache.change(&added, &removed)?;
        let (mode, statistics) = (upload.mode(), upload.statistics());
        let cached = clock();
        if let Some(path) = &mut self.path {
            path.push_change(&added, &removed)?;
        }

        // Indices of faces.
        let recorded = clock();
        let patch = self
            .indices
            .update(&self.cache, &removed_faces, &self.patched)
            .map_err(|error| self.detail.damaged(number, error))?;
        let patch = patch.statistics();
        let indexed = clock();

        let read = self.detail.bytes().map_or(0, |[_, read]| read);
        let mut frame = WalkFrame {
            vertices: front.vertex_count(),
            faces: front.face_count(),
            added: changes.added_vertices.len(),
            removed: changes.removed_vertices.len(),
            read_bytes: read - self.bytes_read,
            update_milliseconds: 1e3 * (updated - start),
            cache_milliseconds: 1e3 * (cached - sorted),
            index_milliseconds: 1e3 * (indexed - recorded),
            ..WalkFrame::default()
        }
        .with_sent(mode, statistics, patch, self.vertex_size);
        self.is_first = false;
        self.bytes_read = read;
        if mode == FrameMode::Passes {
            draw_passes(
                &mut self.cache,
                self.indices.corners(),
                self.vertex_size,
                clock,
                &mut frame,
            )?;
        }
        Ok(frame)
    }
}
