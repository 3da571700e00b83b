//! A walk around a mesh, frame by frame.

use std::ops::ControlFlow;

use super::frame::WalkFrame;
use super::loading::{Loaded, load};
use super::options::{LodError, LodWalkOptions};
use super::report::{LodWalkReport, WalkOptimum, WalkedMesh};
use crate::files::Document;
use crate::index::{BLOCK, index32};
use crate::lod::fast_mesh::{CameraView, Front, VertexHierarchy};
use crate::lod::geometry_cache::{
    FrameMode, GeometryCache, GeometryCacheError, IndexSlots, RecordedPath,
};
use crate::progress::Progress;

/// Walks around the meshes of a document, all as one, and counts what each frame would send to a graphics card.
///
/// A frame changes the front of a vertex hierarchy as the view needs it, gives the vertices that came a slot in the vertex buffer, and
/// patches the index buffer. Positions and faces count, as the file stores them: nodes of a glTF move nothing, and vertices of
/// equal positions are one.
///
/// `clock` gives seconds since any time; give `&|| 0.0` where there is no clock, and all times are 0. All else is the same in each
/// run.
///
/// # Errors
/// [`LodError`]: an option is out of range, there are no faces or no positions, or a camera sees nothing.
///
/// # Complexity
/// That of [`FastMesh::build`](crate::lod::fast_mesh::FastMesh::build), and of [`Front::update`] for each frame.
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
pub fn lod_walk(
    document: &Document,
    options: &LodWalkOptions,
    clock: &dyn Fn() -> f64,
    progress: &dyn Progress,
) -> Result<LodWalkReport, LodError> {
    options.check()?;
    let start = clock();
    let loaded = load(document)?;
    let build_seconds = clock() - start;
    let mut report = LodWalkReport {
        file: document.path().to_owned(),
        options: options.clone(),
        mesh: WalkedMesh {
            vertices: loaded.hierarchy.vertex_count(),
            faces: loaded.face_count,
            roots: 0,
        },
        frames: Vec::new(),
        optimum: None,
        build_seconds,
        is_stopped: false,
        notes: document.notes().to_vec(),
    };

    // All frames.
    let Loaded {
        hierarchy, ball, ..
    } = loaded;
    let mut walker = Walker::new(hierarchy, options)?;
    report.mesh.roots = walker.front.vertex_count();
    let count = options.path.frame_count(options.frames);
    for number in 0..count {
        let camera = options.path.camera(ball, number, count, options.size);
        let view = camera.view(options.tolerance);
        let view = view.map_err(|error| LodError::View {
            frame: number,
            error,
        })?;
        report.frames.push(walker.frame(&view, clock)?);
        let done = (number + 1) as f64 / count as f64;
        if progress.report(done) == ControlFlow::Break(()) && number + 1 < count {
            report.is_stopped = true;
            break;
        }
    }

    report.optimum = walker.path.map(|path| WalkOptimum {
        distinct_vertices: path.distinct_vertices(),
        fewest_inserts: path.fewest_inserts(options.slots),
    });
    Ok(report)
}

/// The front and the buffers of a renderer.
pub(super) struct Walker {
    pub(super) front: Front,
    pub(super) cache: GeometryCache,
    pub(super) indices: IndexSlots,
    /// Only if the optimum is asked for.
    pub(super) path: Option<RecordedPath>,
    hysteresis: f64,
    vertex_size: usize,
    /// What a card would draw of the first frame is all new to it.
    is_first: bool,
    /// The faces that came or have other corners.
    patched: Vec<(u32, [u32; 3])>,
    /// The indices of a pass.
    pass: Vec<[u32; 3]>,
}

impl Walker {
    pub(super) fn new(
        hierarchy: VertexHierarchy,
        options: &LodWalkOptions,
    ) -> Result<Self, GeometryCacheError> {
        let vertices = hierarchy.vertex_count();
        let errors = (0..index32(vertices)).map(|vertex| hierarchy.error(vertex));
        let cache = GeometryCache::new(options.slots, errors.collect(), options.policy)?;
        Ok(Self {
            cache: match options.passes {
                true => cache.with_passes(),
                false => cache,
            },
            indices: IndexSlots::new(hierarchy.face_slot_count()),
            path: options.optimum.then(|| RecordedPath::new(vertices)),
            hysteresis: options.hysteresis,
            vertex_size: options.vertex_size,
            is_first: true,
            patched: Vec::new(),
            pass: Vec::new(),
            front: Front::new(hierarchy),
        })
    }

    /// Draws a view.
    pub(super) fn frame(
        &mut self,
        view: &CameraView,
        clock: &dyn Fn() -> f64,
    ) -> Result<WalkFrame, GeometryCacheError> {
        // What the view needs.
        let start = clock();
        self.front.update(view, self.hysteresis);
        let updated = clock();

        // Slots for vertices.
        let changes = self.front.changes();
        let all: Vec<u32>;
        let [added, removed] = match self.is_first {
            false => [&changes.added_vertices[..], &changes.removed_vertices[..]],
            true => {
                all = self.front.vertices().collect();
                [&all[..], &[]]
            }
        };
        let upload = self.cache.change(added, removed)?;
        let (mode, statistics) = (upload.mode(), upload.statistics());
        let cached = clock();
        if let Some(path) = &mut self.path {
            path.push_change(added, removed)?;
        }

        // Indices of faces.
        let recorded = clock();
        self.patched.clear();
        match self.is_first {
            true => self.patched.extend(self.front.faces()),
            false => {
                let faces = changes.added_faces.iter().chain(&changes.changed_faces);
                let corners = |&face: &u32| Some((face, self.front.face(face)?));
                self.patched.extend(faces.filter_map(corners));
            }
        }
        let patch = self
            .indices
            .update(&self.cache, &changes.removed_faces, &self.patched)
            .expect("corners of faces of the front are active vertices");
        let patch = patch.statistics();
        let indexed = clock();

        let mut frame = WalkFrame {
            vertices: self.front.vertex_count(),
            faces: self.front.face_count(),
            added: changes.added_vertices.len(),
            removed: changes.removed_vertices.len(),
            inserts: statistics.inserts,
            vertex_ranges: statistics.ranges,
            vertex_bytes: statistics.bytes(self.vertex_size),
            patched_faces: patch.patched,
            index_ranges: patch.ranges,
            index_bytes: patch.bytes as u64,
            passes: 1,
            is_streamed: mode == FrameMode::Streamed,
            update_milliseconds: 1e3 * (updated - start),
            cache_milliseconds: 1e3 * (cached - updated),
            index_milliseconds: 1e3 * (indexed - recorded),
        };
        self.is_first = false;
        if mode == FrameMode::Passes {
            self.draw_passes(&mut frame)?;
            frame.cache_milliseconds += 1e3 * (clock() - indexed);
        }
        Ok(frame)
    }

    /// Draws the faces of a frame that does not fit into the slots, and adds what that sends.
    fn draw_passes(&mut self, frame: &mut WalkFrame) -> Result<(), GeometryCacheError> {
        let index_size = if self.cache.slots() <= BLOCK { 2 } else { 4 };
        let mut passes = self.cache.passes(self.indices.corners())?;
        frame.passes = 0;
        while let Some(pass) = passes.next_pass() {
            self.pass.clear();
            self.pass.extend(pass.indices());
            let statistics = pass.upload().statistics();
            frame.passes += 1;
            frame.inserts += statistics.inserts;
            frame.vertex_ranges += statistics.ranges;
            frame.vertex_bytes += statistics.bytes(self.vertex_size);
            frame.patched_faces += self.pass.len();
            frame.index_ranges += 1;
            frame.index_bytes += 3 * (self.pass.len() * index_size) as u64;
        }
        Ok(())
    }
}
