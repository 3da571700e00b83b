//! A walk that is made once and drawn by every eviction policy.

use std::ops::ControlFlow;

use super::loading::{Loaded, load};
use super::options::{LodError, LodWalkOptions};
use super::report::{LodWalkReport, WalkedMesh};
use crate::files::Document;
use crate::index::index32;
use crate::lod::CameraView;
use crate::lod::fast_mesh::{FrameBudget, Front, FrontChanges};
use crate::lod::geometry_cache::{
    EvictionPolicy, GeometryCache, GeometryCacheError, IndexSlots, RecordedPath,
};
use crate::operations::walks::WalkFrame;
use crate::operations::walks::WalkOptimum;
use crate::progress::Progress;

/// The meshes of a document with all levels of detail, to walk around them more than once.
///
/// ```no_run
/// use std::path::Path;
/// use meshweft::files::{Document, ReadOptions};
/// use meshweft::operations::{EvictionPolicy, LodWalkOptions, WalkQuantity, WalkRecorder};
///
/// let document = Document::open(Path::new("scan.ply"), ReadOptions::default())?;
/// let clock = || 0.0;
/// let recorder = WalkRecorder::new(&document, &clock)?;
/// let walk = recorder.record(&LodWalkOptions::default(), &clock, &())?;
/// for policy in EvictionPolicy::ALL {
///     let report = walk.replay(policy, &clock)?;
///     println!("{policy}: {}", report.summary(WalkQuantity::Inserts).total);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct WalkRecorder {
    loaded: Loaded,
    /// A report without frames.
    report: LodWalkReport,
}

impl WalkRecorder {
    /// Joins the meshes of a document and finds all their levels of detail. `clock` is as for
    /// [`lod_walk`](super::lod_walk).
    ///
    /// # Errors
    /// [`LodError`] if there are no faces or no positions.
    ///
    /// # Complexity
    /// That of [`FastMesh::build`](crate::lod::fast_mesh::FastMesh::build).
    pub fn new(document: &Document, clock: &dyn Fn() -> f64) -> Result<Self, LodError> {
        let start = clock();
        let loaded = load(document, &())?;
        let build_seconds = clock() - start;
        let report = LodWalkReport {
            file: document.path().to_owned(),
            options: LodWalkOptions::default(),
            mesh: WalkedMesh {
                vertices: loaded.hierarchy.vertex_count(),
                faces: loaded.hierarchy.face_count(),
                roots: Front::new(loaded.hierarchy.clone()).vertex_count(),
            },
            file_bytes: None,
            frames: Vec::new(),
            optimum: None,
            build_seconds,
            is_stopped: false,
            notes: document.notes().to_vec(),
        };
        Ok(Self { loaded, report })
    }

    /// What is walked around.
    #[must_use]
    pub fn mesh(&self) -> WalkedMesh {
        self.report.mesh
    }

    /// Walks along a path with a front, and keeps what each frame changes. The policy and the passes of the options do not
    /// count here.
    ///
    /// Where a view needs more vertices than there are slots, the frame has the best mesh that fits, as the paper asks of an
    /// application; [`RecordedWalk::limited_frames`] counts these.
    ///
    /// # Errors
    /// [`LodError`]: an option is out of its range, or a camera sees nothing.
    ///
    /// # Complexity
    /// Time that of [`Front::update`] for each frame; space 4 bytes for each vertex and 20 for each face that a frame changes.
    pub fn record(
        &self,
        options: &LodWalkOptions,
        clock: &dyn Fn() -> f64,
        progress: &dyn Progress,
    ) -> Result<RecordedWalk, LodError> {
        options.check()?;
        let hierarchy = &self.loaded.hierarchy;
        let vertices = hierarchy.vertex_count();
        let errors = (0..index32(vertices)).map(|vertex| hierarchy.error(vertex));
        let mut report = self.report.clone();
        report.options = options.clone();
        let mut walk = RecordedWalk {
            report,
            errors: errors.collect(),
            face_slots: hierarchy.face_slot_count(),
            path: RecordedPath::new(vertices),
            frames: Vec::new(),
            removed_faces: Vec::new(),
            patched_faces: Vec::new(),
            limited_frames: 0,
        };

        // All frames.
        let mut front = Front::new(hierarchy.clone());
        let mut changed = ChangedFront::new(&front);
        let count = options.path.frame_count(options.frames);
        for number in 0..count {
            let view = options.view(self.loaded.ball, number, count)?;
            walk.push_frame(&mut front, &mut changed, &view, clock)?;
            let done = (number + 1) as f64 / count as f64;
            if progress.report(done) == ControlFlow::Break(()) && number + 1 < count {
                walk.report.is_stopped = true;
                break;
            }
        }

        walk.report.optimum = options
            .optimum
            .then(|| WalkOptimum::of(&walk.path, options.slots));
        Ok(walk)
    }
}

/// What each frame of a walk changes, for any eviction policy: made by [`WalkRecorder::record`].
#[derive(Debug)]
pub struct RecordedWalk {
    /// A report without frames.
    report: LodWalkReport,
    /// Of each vertex.
    errors: Vec<f32>,
    face_slots: usize,
    path: RecordedPath,
    frames: Vec<RecordedFrame>,
    /// Of all frames, one after the other.
    removed_faces: Vec<u32>,
    /// The faces that came or have other corners, of all frames.
    patched_faces: Vec<(u32, [u32; 3])>,
    limited_frames: usize,
}

/// A frame without what a policy decides.
#[derive(Debug)]
struct RecordedFrame {
    frame: WalkFrame,
    /// Where its faces end in the two lists.
    ends: [usize; 2],
}

impl RecordedWalk {
    /// What is known of the vertices of all frames.
    #[must_use]
    pub fn path(&self) -> &RecordedPath {
        &self.path
    }

    /// How many frames have fewer vertices than their views need, as there are no more slots.
    #[must_use]
    pub fn limited_frames(&self) -> usize {
        self.limited_frames
    }

    /// Draws all frames with an eviction policy. The times of the front are those of the recording.
    ///
    /// # Errors
    /// [`LodError::Cache`] if the number of slots is out of its range, which was checked for the recording.
    ///
    /// # Complexity
    /// Time O(changed vertices and faces), with [`EvictionPolicy::Nothing`] O(active vertices and faces) for each frame.
    pub fn replay(
        &self,
        policy: EvictionPolicy,
        clock: &dyn Fn() -> f64,
    ) -> Result<LodWalkReport, LodError> {
        let mut report = self.report.clone();
        report.options.policy = policy;
        report.options.passes = false;
        self.draw(policy, clock, &mut |_, _, frame| report.frames.push(frame))?;
        Ok(report)
    }

    /// Draws all frames, and gives each with the buffers as they are after it.
    pub(super) fn draw(
        &self,
        policy: EvictionPolicy,
        clock: &dyn Fn() -> f64,
        each: &mut dyn FnMut(&GeometryCache, &IndexSlots, WalkFrame),
    ) -> Result<(), GeometryCacheError> {
        let options = &self.report.options;
        let mut cache = GeometryCache::new(options.slots, self.errors.clone(), policy)?;
        let mut indices = IndexSlots::new(self.face_slots);
        let mut starts = [0; 2];
        for (recorded, (added, removed)) in self.frames.iter().zip(self.path.frames()) {
            // Slots for vertices.
            let start = clock();
            let upload = cache.change(added, removed)?;
            let (mode, statistics) = (upload.mode(), upload.statistics());
            let cached = clock();

            // Indices of faces.
            let removed = &self.removed_faces[starts[0]..recorded.ends[0]];
            let patched = &self.patched_faces[starts[1]..recorded.ends[1]];
            let patch = indices
                .update(&cache, removed, patched)
                .expect("corners of faces of the front are active vertices");
            let patch = patch.statistics();
            let indexed = clock();
            starts = recorded.ends;

            let frame = WalkFrame {
                cache_milliseconds: 1e3 * (cached - start),
                index_milliseconds: 1e3 * (indexed - cached),
                ..recorded.frame
            }
            .with_sent(mode, statistics, patch, options.vertex_size);
            each(&cache, &indices, frame);
        }
        Ok(())
    }

    /// Makes the front what a view needs, or the best that fits, and keeps what that changed.
    fn push_frame(
        &mut self,
        front: &mut Front,
        changed: &mut ChangedFront,
        view: &CameraView,
        clock: &dyn Fn() -> f64,
    ) -> Result<(), GeometryCacheError> {
        let options = &self.report.options;
        let start = clock();
        front.update(view, options.hysteresis);
        let mut seconds = clock() - start;
        changed.follow(front.changes());
        if front.vertex_count() > options.slots {
            let budget = FrameBudget {
                vertices: options.slots,
                ..FrameBudget::default()
            };
            let start = clock();
            front.update_within(view, options.hysteresis, budget);
            seconds += clock() - start;
            changed.follow(front.changes());
            self.limited_frames += 1;
        }

        // Vertices: in the first frame all that are active; in the order of their numbers, as in a walk.
        let [mut added, mut removed] = changed.vertices();
        let is_first = self.frames.is_empty();
        if is_first {
            added = front.vertices().collect();
        }
        added.sort_unstable();
        removed.sort_unstable_by(|a, b| b.cmp(a));
        self.path.push_change(&added, &removed)?;
        let roots = if is_first { self.report.mesh.roots } else { 0 };

        // Faces, likewise.
        let starts = [self.removed_faces.len(), self.patched_faces.len()];
        match is_first {
            true => self.patched_faces.extend(front.faces()),
            false => {
                let there = |face: &u32| Some((*face, front.face(*face)?));
                self.patched_faces
                    .extend(changed.faces.iter().filter_map(there));
                let gone = changed.faces.iter().copied();
                self.removed_faces
                    .extend(gone.filter(|&face| front.face(face).is_none()));
            }
        }
        changed.faces.clear();
        self.removed_faces[starts[0]..].sort_unstable();
        self.patched_faces[starts[1]..].sort_unstable();

        self.frames.push(RecordedFrame {
            frame: WalkFrame {
                vertices: front.vertex_count(),
                faces: front.face_count(),
                added: added.len() - roots,
                removed: removed.len(),
                update_milliseconds: 1e3 * seconds,
                ..WalkFrame::default()
            },
            ends: [self.removed_faces.len(), self.patched_faces.len()],
        });
        Ok(())
    }
}

/// What a front changed in several steps, as one.
#[derive(Debug)]
struct ChangedFront {
    was_active: Vec<bool>,
    is_active: Vec<bool>,
    /// Vertices that any step named.
    vertices: Vec<u32>,
    /// Faces that any step named.
    faces: Vec<u32>,
}

impl ChangedFront {
    /// Everything in a front is new.
    fn new(front: &Front) -> Self {
        let count = front.hierarchy().vertex_count();
        let mut is_active = vec![false; count];
        let vertices: Vec<u32> = front.vertices().collect();
        for &vertex in &vertices {
            is_active[vertex as usize] = true;
        }
        Self {
            was_active: vec![false; count],
            is_active,
            vertices,
            faces: Vec::new(),
        }
    }

    /// One more step.
    fn follow(&mut self, changes: &FrontChanges) {
        let vertices = [
            (&changes.added_vertices, true),
            (&changes.removed_vertices, false),
        ];
        for (list, is_active) in vertices {
            for &vertex in list {
                self.is_active[vertex as usize] = is_active;
            }
            self.vertices.extend(list);
        }
        self.faces.extend(&changes.added_faces);
        self.faces.extend(&changes.removed_faces);
        self.faces.extend(&changes.changed_faces);
    }

    /// The vertices that came and those that left, each once; and begins again.
    fn vertices(&mut self) -> [Vec<u32>; 2] {
        let mut came_and_left = [Vec::new(), Vec::new()];
        for vertex in self.vertices.drain(..) {
            let is_active = self.is_active[vertex as usize];
            let was_active = std::mem::replace(&mut self.was_active[vertex as usize], is_active);
            if was_active != is_active {
                came_and_left[usize::from(was_active)].push(vertex);
            }
        }
        came_and_left
    }
}
