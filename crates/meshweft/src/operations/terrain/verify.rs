//! How far what is drawn of a terrain is from its heights, by measuring all of them.

use std::ops::ControlFlow;

use super::error::TerrainError;
use super::heights::TerrainHeights;
use super::measured_heights::{MeasuredHeights, own_samples};
use super::source::{TerrainFacts, TerrainSource};
use super::verify_options::TerrainVerifyOptions;
use super::verify_report::{TerrainVerifyReport, VerifiedSurface};
use crate::lod::quad_tin::{QuadTin, TinSurface};
use crate::lod::{Camera, CameraView};
use crate::operations::walks::{CollectedErrors, MeasuredView};
use crate::progress::Progress;

/// Measures surfaces of a terrain: how far each height is from what is drawn, vertically. In frames of a path it is measured
/// in pixels, where the height is, of all heights in the picture, hidden or not. Of the surface of an error it is measured in metres, of all heights.
///
/// Each face is laid on the grid or on the points, and each height below or above it compared with it, so nothing is taken from the errors of the
/// hierarchy. It is also counted what no face covers, which voids are covered, what two faces cover, which faces are turned over, and where two do
/// not meet: all of that should be 0, and no height farther off than asked for. `heights` are those to compare with, such as the height maps
/// or the points of which a file was made; without them they are the terrain's own, over points those of its vertices that are points.
///
/// # Errors
/// [`TerrainError`]: an option is out of its range, the heights are of another kind than the terrain or on another grid, or a file cannot be
/// read.
///
/// # Complexity
/// Time O(places) for each frame; over points O(n log n) at first, and O(n + faces × log n) for each frame. Space 14 bytes a place, 17 a
/// point.
///
/// ```
/// use meshweft::HeightGrid;
/// use meshweft::operations::{TerrainHeights, TerrainSource, TerrainVerifyOptions, terrain_verify};
///
/// let heights = (0..81).map(|i| [0.0, 2.0, 3.0, 2.5, 1.0, 0.0, 0.0, 0.0, 0.5][i % 9]).collect();
/// let grid = HeightGrid::new([9, 9], [30.0, 30.0], heights)?;
/// let source = TerrainSource::of_heights(TerrainHeights::of_grid("ridge", grid))?;
/// let mut options = TerrainVerifyOptions::default();
/// options.error = Some(1.0);
/// let report = terrain_verify(source, None, &options, &())?;
/// assert!(report.failures().is_empty() && report.worst_metres() <= 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn terrain_verify(
    source: TerrainSource,
    heights: Option<TerrainHeights>,
    options: &TerrainVerifyOptions,
    progress: &dyn Progress,
) -> Result<TerrainVerifyReport, TerrainError> {
    options.check()?;
    let mut source = source.read_fully()?;
    let terrain = TerrainFacts::of(source.tin());
    let mut notes = source.notes.clone();
    let is_own = heights.is_none();
    let (samples, compared) = match heights {
        None => (own_samples(&source)?, Vec::new()),
        Some(heights) => {
            notes.extend(heights.notes);
            (heights.samples, heights.files)
        }
    };
    let full = MeasuredHeights::of(&samples, &source)?;

    // What is looked at: the view of each surface, and how it is measured.
    let at_frame = |frame| move |error| TerrainError::View { frame, error };
    let views: Vec<(usize, CameraView, SurfaceMeasure)> = match options.error {
        Some(length) => {
            let above = if length > 0.0 { length } else { -1.0 };
            let view = CameraView::of_errors_above(above).map_err(at_frame(0))?;
            vec![(0, view, SurfaceMeasure::Metres(length))]
        }
        None => {
            let view = |(number, camera): (usize, Camera)| {
                let view = camera.view(options.tolerance).map_err(at_frame(number))?;
                let measured = MeasuredView::new(&camera, options.tolerance);
                Ok((number, view, SurfaceMeasure::Pixels(measured)))
            };
            let cameras = options.cameras(&terrain).into_iter();
            cameras.map(view).collect::<Result<_, TerrainError>>()?
        }
    };

    // All of them.
    let mut all = CollectedErrors::new(views.len().saturating_mul(full.count()));
    let (mut surfaces, mut is_stopped) = (Vec::new(), false);
    let mut surface = TinSurface::default();
    for (place, (number, view, measure)) in views.iter().enumerate() {
        source.draw(view, None, Some(*number), &mut surface)?;
        let verified = measure.verified(&full, source.tin(), &surface, &mut all);
        surfaces.push(VerifiedSurface {
            number: *number,
            ..verified
        });
        let done = (place + 1) as f64 / views.len() as f64;
        if progress.report(done) == ControlFlow::Break(()) && place + 1 < views.len() {
            is_stopped = true;
            break;
        }
    }
    Ok(TerrainVerifyReport {
        file: source.file,
        compared,
        is_own,
        heights: full.count(),
        options: options.clone(),
        terrain,
        surfaces,
        errors: all.summary(),
        is_stopped,
        notes,
    })
}

/// How the distance of a height counts.
enum SurfaceMeasure {
    /// In parts of this, all heights.
    Metres(f64),
    /// In tolerances, those in the picture.
    Pixels(MeasuredView),
}

/// So many errors are kept before the largest of them are.
const CHUNK: usize = 1 << 20;

impl SurfaceMeasure {
    /// Measures a surface, and adds its errors to those of all.
    fn verified(
        &self,
        full: &MeasuredHeights<'_>,
        tin: &QuadTin,
        surface: &TinSurface,
        all: &mut CollectedErrors,
    ) -> VerifiedSurface {
        let mut own = CollectedErrors::new(full.count());
        let mut errors = Vec::new();
        let mut worst_metres = 0.0_f64;
        let faults = full.look_at(tin, surface.faces(), |point, distance| {
            worst_metres = worst_metres.max(distance);
            let error = match self {
                Self::Metres(length) if *length > 0.0 => distance / length,
                Self::Metres(_) if distance > 0.0 => f64::INFINITY,
                Self::Metres(_) => 0.0,
                Self::Pixels(view) => match view.has_in_picture(point) {
                    true => view.tolerances(point, distance),
                    false => return,
                },
            };
            errors.push(error);
            if errors.len() == CHUNK {
                own.extend(&errors);
                all.extend(&errors);
                errors.clear();
            }
        });
        own.extend(&errors);
        all.extend(&errors);

        let mut vertices: Vec<u32> = surface.faces().iter().flat_map(|it| it.1).collect();
        vertices.sort_unstable();
        vertices.dedup();
        VerifiedSurface {
            number: 0,
            vertices: vertices.len(),
            faces: surface.faces().len(),
            errors: own.summary(),
            worst_metres,
            stated_metres: surface.largest_error().into(),
            uncovered: faults.uncovered,
            covered_voids: faults.covered_voids,
            overlaps: faults.overlaps,
            turned: faults.turned,
            cracks: faults.cracks,
            has_full_area: !faults.has_other_area,
        }
    }
}
