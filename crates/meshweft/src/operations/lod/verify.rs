//! How far what is drawn is from the mesh at full detail, by measuring it.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::detail_front::LoadedFront;
use super::options::LodError;
use super::report::WalkedMesh;
use super::source::LodSource;
use super::verify_options::LodVerifyOptions;
use super::verify_report::{LodVerifyReport, VerifiedFrame};
use crate::geometry::double::{cross, dot, scaled, sub, widened};
use crate::geometry::{Ball, Surface, vertex_normals};
use crate::index::index32;
use crate::lod::Camera;
use crate::lod::fast_mesh::Front;
use crate::operations::walks::CollectedErrors;
use crate::operations::walks::MeasuredView;
use crate::parallel;
use crate::progress::{PartOfWork, Progress};

/// Measures some frames of a path: how far the mesh at full detail is from what is drawn, in pixels.
///
/// Every vertex counts that is in the picture and whose normal faces the eye, hidden by another part of the mesh or not. Its distance to the
/// nearest point of all drawn faces is projected where the vertex is. Nothing is estimated, and nothing is taken from the errors of
/// the hierarchy, so this tells how good these are. Of a `.mwl` file everything is read.
///
/// # Errors
/// As [`lod_walk`](super::lod_walk).
///
/// # Complexity
/// Time O(vertices · log faces) for each frame; space O(vertices).
///
/// ```no_run
/// use std::path::Path;
/// use meshweft::files::ReadOptions;
/// use meshweft::operations::{LodSource, LodVerifyOptions, lod_verify};
///
/// let source = LodSource::open(Path::new("scan.mwl"), &ReadOptions::default())?;
/// let report = lod_verify(source, &LodVerifyOptions::default(), &())?;
/// println!("{} % of the vertices are at most 1.5 pixels off", report.errors.share());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn lod_verify<'a>(
    source: impl Into<LodSource<'a>>,
    options: &LodVerifyOptions,
    progress: &dyn Progress,
) -> Result<LodVerifyReport, LodError> {
    options.check()?;
    let LoadedFront {
        file,
        mut detail,
        ball,
        notes,
        done,
        mut is_stopped,
    } = LoadedFront::new(source.into(), progress)?;
    let roots = detail.front().vertex_count();
    detail.refine_fully()?;
    let full = DetailedMesh::new(detail.front(), ball);
    let cameras = options.cameras(ball);

    // All frames.
    let mut all = CollectedErrors::new(cameras.len().saturating_mul(full.points.len()));
    let mut frames = Vec::new();
    let progress = PartOfWork::new(progress, done, 1.0);
    let measured = if is_stopped { 0 } else { cameras.len() };
    for (place, &(number, camera)) in cameras.iter().enumerate().take(measured) {
        let view = camera.view(options.tolerance);
        let view = view.map_err(|error| LodError::View {
            frame: number,
            error,
        })?;
        // Nothing of full detail stays, as a walk begins with the coarsest mesh.
        let hysteresis = if place == 0 { 1.0 } else { options.hysteresis };
        detail.update(&view, hysteresis, number)?;
        let share = |part: f64| progress.report((place as f64 + part) / cameras.len() as f64);
        let Some((frame, errors)) =
            full.measure(detail.front(), &camera, options.tolerance, &share)
        else {
            is_stopped = true;
            break;
        };
        all.extend(&errors);
        frames.push(VerifiedFrame { number, ..frame });
        if share(1.0) == ControlFlow::Break(()) && place + 1 < cameras.len() {
            is_stopped = true;
            break;
        }
    }

    let hierarchy = detail.front().hierarchy();
    Ok(LodVerifyReport {
        file,
        options: options.clone(),
        mesh: WalkedMesh {
            vertices: hierarchy.vertex_count(),
            faces: hierarchy.face_count(),
            roots,
        },
        file_bytes: detail.bytes().map(|[length, _]| length),
        frames,
        errors: all.summary(),
        is_stopped,
        notes,
    })
}

/// The mesh at full detail; vertices at one place count once.
pub(super) struct DetailedMesh {
    pub(super) points: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
}

/// So many vertices are measured between two looks at the progress.
const CHUNK: usize = 4096;

impl DetailedMesh {
    /// That of a front which is refined fully.
    pub(super) fn new(front: &Front, ball: Ball) -> Self {
        let hierarchy = front.hierarchy();
        let [count, _] = hierarchy.point_counts();
        let points: Vec<[f32; 3]> = (0..index32(count))
            .map(|it| hierarchy.position(it))
            .collect();

        // Areas of very small and very large meshes are out of range: a power of two changes no direction.
        let farthest = ball
            .center
            .iter()
            .fold(ball.radius, |far, x| far.max(ball.radius + x.abs()));
        let factor = match farthest > 0.0 && farthest.is_finite() {
            true => (-farthest.log2().round()).exp2(),
            false => 1.0,
        };
        #[expect(clippy::cast_possible_truncation, reason = "about 1 at most")]
        let near = points
            .iter()
            .map(|&it| scaled(widened(it), factor).map(|x| x as f32));
        let normals = vertex_normals(&near.collect::<Vec<_>>(), &drawn_faces(front));
        Self { points, normals }
    }

    /// What a frame is like, and the error of each vertex that is seen, in tolerances; `None` if it was stopped.
    pub(super) fn measure(
        &self,
        front: &Front,
        camera: &Camera,
        tolerance: f64,
        progress: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
    ) -> Option<(VerifiedFrame, Vec<f64>)> {
        let view = MeasuredView::new(camera, tolerance);
        let faces = drawn_faces(front);
        let surface = Surface::new(&self.points, &faces);
        let is_seen = |&point: &u32| {
            let point = point as usize;
            view.sees(self.points[point], self.normals[point])
        };
        let seen: Vec<u32> = (0..index32(self.points.len())).filter(is_seen).collect();

        // The distance of each.
        let error = |&point: &u32| {
            let point = self.points[point as usize];
            let nearest = surface.nearest(widened(point));
            let distance = nearest.map_or(f64::INFINITY, |it| it.distance);
            view.tolerances(point, distance)
        };
        let (is_stopped, done) = (AtomicBool::new(false), AtomicUsize::new(0));
        let chunks: Vec<&[u32]> = seen.chunks(CHUNK).collect();
        let count = chunks.len();
        let errors = parallel::map(chunks, |chunk| {
            let part = done.load(Ordering::Relaxed) as f64 / count as f64;
            if progress(part) == ControlFlow::Break(()) {
                is_stopped.store(true, Ordering::Relaxed);
            }
            if is_stopped.load(Ordering::Relaxed) {
                return Vec::new();
            }
            done.fetch_add(1, Ordering::Relaxed);
            chunk.iter().map(error).collect()
        });
        if done.into_inner() < count {
            return None;
        }

        let errors: Vec<f64> = errors.concat();
        let mut collected = CollectedErrors::new(errors.len());
        collected.extend(&errors);
        let frame = VerifiedFrame {
            number: 0,
            vertices: front.vertex_count(),
            faces: faces.len(),
            turned_faces: faces.iter().filter(|face| self.is_turned(face)).count(),
            errors: collected.summary(),
        };
        Some((frame, errors))
    }

    /// Whether a face looks against the mean of its vertices' normals.
    fn is_turned(&self, face: &[u32; 3]) -> bool {
        let [a, b, c] = face.map(|point| widened(self.points[point as usize]));
        let area = cross(sub(b, a), sub(c, a));
        let parts = face.map(|point| dot(area, widened(self.normals[point as usize])));
        parts.iter().sum::<f64>() < 0.0
    }
}

/// The faces of a front by their points, in the order of their numbers.
fn drawn_faces(front: &Front) -> Vec<[u32; 3]> {
    let hierarchy = front.hierarchy();
    let mut faces: Vec<(u32, [u32; 3])> = front.faces().collect();
    faces.sort_unstable();
    let points = |(_, face): (u32, [u32; 3])| face.map(|vertex| hierarchy.point_of(vertex));
    faces.into_iter().map(points).collect()
}
