//! Surfaces over points, measured; and that what is wrong with one is found.

use std::io::Cursor;
use std::path::Path;

use super::build::terrain_build;
use super::error::TerrainError;
use super::full_points::FullPoints;
use super::heights::TerrainHeights;
use super::paths::TerrainPath;
use super::source::TerrainSource;
use super::surface_faults::SurfaceFaults;
use super::verify::terrain_verify;
use super::verify_options::TerrainVerifyOptions;
use super::verify_report::TerrainVerifyReport;
use crate::height_grid::HeightGrid;
use crate::limits::Limits;
use crate::lod::CameraView;
use crate::lod::quad_tin::point_sets::{DIFFICULT_SETS, SETS, scattered};
use crate::lod::quad_tin::{PointHierarchy, QuadTin, TinSurface};
use crate::random::SplitMix64;

fn given(points: &[[f32; 3]]) -> TerrainHeights {
    TerrainHeights::of_points("points", points.to_vec())
}

/// As a file.
fn stored(points: &[[f32; 3]]) -> TerrainSource {
    let mut built = terrain_build(given(points), &|| 0.0).unwrap();
    let mut file = Cursor::new(Vec::new());
    built.write(&mut file).unwrap();
    TerrainSource::stored(Path::new("points.mwt"), file, Limits::default()).unwrap()
}

fn of_error(error: f64) -> TerrainVerifyOptions {
    TerrainVerifyOptions {
        error: Some(error),
        ..TerrainVerifyOptions::default()
    }
}

#[test]
fn every_point_of_all_kinds_of_sets_is_within_the_tolerance() {
    let mut random = SplitMix64(41);
    for (name, make) in SETS.into_iter().chain(DIFFICULT_SETS) {
        let points = make(500, &mut random);
        let counts = *PointHierarchy::over(&points).unwrap().counts();
        let vertices = (counts.points - counts.duplicates - counts.left_out) as usize;
        let sound = |report: &TerrainVerifyReport, heights: usize| {
            assert_eq!(report.failures(), Vec::<String>::new(), "{name}");
            assert_eq!((report.heights, report.errors.share()), (heights, 100.0));
        };
        for error in [0.0, 1.0 / 64.0, 0.7, 5.0, 40.0, 1e4] {
            let options = of_error(error);
            let own = terrain_verify(stored(&points), None, &options, &()).unwrap();
            sound(&own, vertices);
            assert!(own.is_own && own.worst_metres() <= error, "{name}");
            assert_eq!(own.errors.seen, vertices);

            // What was left out may be farther off, and is measured too.
            let heights = Some(given(&points));
            let all = terrain_verify(stored(&points), heights, &options, &()).unwrap();
            assert_eq!(all.heights, vertices + counts.left_out as usize);
            assert_eq!((all.errors.seen, all.is_own), (all.heights, false));
            if counts.left_out == 0 {
                sound(&all, vertices);
            }
        }
        for path in [TerrainPath::Circle, TerrainPath::Fly] {
            let options = TerrainVerifyOptions {
                path,
                frames: Some(4),
                tolerance: 2.0,
                ..TerrainVerifyOptions::default()
            };
            let report = terrain_verify(stored(&points), None, &options, &()).unwrap();
            sound(&report, vertices);
            assert_eq!(report.surfaces.len(), 4);
        }
    }
}

/// A terrain over points, a surface of it, and all that may be done to that.
struct DrawnOverPoints {
    points: Vec<[f32; 3]>,
    tin: QuadTin,
    faces: Vec<(u32, [u32; 3])>,
}

impl DrawnOverPoints {
    fn new(error: f64) -> Self {
        let points = scattered(400, &mut SplitMix64(8));
        let tin = QuadTin::from(PointHierarchy::over(&points).unwrap());
        let mut surface = TinSurface::default();
        tin.draw(&CameraView::of_errors_above(error).unwrap(), &mut surface);
        let faces = surface.faces().to_vec();
        Self { points, tin, faces }
    }

    /// What is found, and the largest distance, where a vertex may be somewhere else.
    fn looked_at(
        &self,
        faces: &[(u32, [u32; 3])],
        moved: Option<(u32, [f32; 3])>,
    ) -> (SurfaceFaults, f64) {
        let full = FullPoints::new(&self.points, self.tin.horizontal_range());
        let position = |vertex| match moved {
            Some((other, place)) if other == vertex => place,
            _ => self.tin.position(vertex),
        };
        let mut worst = 0.0_f64;
        let faults = full.look_at(&position, faces, |_, distance| worst = worst.max(distance));
        (faults, worst)
    }

    /// A vertex that is not at the border.
    fn inner_vertex(&self) -> u32 {
        let [xs, zs] = self.tin.horizontal_range();
        let is_inside = |vertex: u32| {
            let [x, _, z] = self.tin.position(vertex);
            !xs.contains(&x) && !zs.contains(&z)
        };
        let mut corners = self.faces.iter().flat_map(|it| it.1);
        corners.find(|&it| is_inside(it)).unwrap()
    }
}

#[test]
fn a_damaged_surface_is_found() {
    for error in [-1.0, 3.0, 30.0] {
        let surface = DrawnOverPoints::new(error);
        let faces = &surface.faces;
        let (faults, worst) = surface.looked_at(faces, None);
        assert!(faults.is_sound() && worst <= error.max(0.0), "{faults:?}");
        let step = 1 + faces.len() / 25;
        for damaged in (0..faces.len()).step_by(step) {
            // Lost: at a corner of the rectangle one side is left that has no face beside it.
            let mut lost = faces.clone();
            lost.remove(damaged);
            let (faults, _) = surface.looked_at(&lost, None);
            assert!(faults.cracks > 0 && faults.has_other_area, "{faults:?}");

            // There twice.
            let mut twice = faces.clone();
            twice.push(faces[damaged]);
            let (faults, _) = surface.looked_at(&twice, None);
            assert!(faults.cracks >= 3 && faults.has_other_area, "{faults:?}");

            // Turned over.
            let mut turned = faces.clone();
            turned[damaged].1.swap(1, 2);
            let (faults, _) = surface.looked_at(&turned, None);
            assert!(faults.turned == 1 && faults.cracks > 0, "{faults:?}");
        }

        // Moved up or down; beside, into faces of others; and a bit to the side, which only full detail has no room for.
        let vertex = surface.inner_vertex();
        let [x, y, z] = surface.tin.position(vertex);
        let (faults, worst) = surface.looked_at(faces, Some((vertex, [x, y + 100.0, z])));
        assert!(faults.is_sound() && worst > 50.0, "{worst}");
        let (faults, _) = surface.looked_at(faces, Some((vertex, [x + 4000.0, y, z])));
        assert!(faults.turned > 0 && !faults.is_sound(), "{faults:?}");

        // A vertex of the border, away from it.
        let corner = surface.tin.position(0);
        let inward = [corner[0] + 0.5, corner[1], corner[2]];
        let (faults, _) = surface.looked_at(faces, Some((0, inward)));
        assert!(faults.cracks > 0 && faults.has_other_area, "{faults:?}");
    }

    // Two coarse faces upon fine ones: no crack, and no side twice where no vertex of the fine ones is at a common place.
    let surface = DrawnOverPoints::new(-1.0);
    let coarse = DrawnOverPoints::new(1e6);
    let both = [&surface.faces[..], &coarse.faces].concat();
    let (faults, _) = surface.looked_at(&both, None);
    assert!(faults.overlaps > 300 && faults.has_other_area, "{faults:?}");
}

#[test]
fn distances_are_those_of_naive_loops() {
    for error in [-1.0, 1.0, 10.0, 200.0] {
        let surface = DrawnOverPoints::new(error);
        let full = FullPoints::new(&surface.points, surface.tin.horizontal_range());
        let mut found = Vec::new();
        let position = |vertex| surface.tin.position(vertex);
        full.look_at(&position, &surface.faces, |point, distance| {
            found.push((point, distance));
        });
        assert_eq!(found.len(), surface.points.len());
        for (point, distance) in found {
            assert!(surface.points.contains(&point));
            let [x, y, z] = point.map(f64::from);
            let distances = surface.faces.iter().filter_map(|&(_, face)| {
                let [a, b, c] = face.map(|it| position(it).map(f64::from));
                let [u, v, p] = [
                    [b[0] - a[0], b[2] - a[2]],
                    [c[0] - a[0], c[2] - a[2]],
                    [x - a[0], z - a[2]],
                ];
                let whole = u[1] * v[0] - u[0] * v[1];
                let [second, third] = [
                    (p[1] * v[0] - p[0] * v[1]) / whole,
                    (u[1] * p[0] - u[0] * p[1]) / whole,
                ];
                let is_in = second.min(third).min(1.0 - second - third) > -1e-9;
                is_in.then(|| (a[1] + second * (b[1] - a[1]) + third * (c[1] - a[1]) - y).abs())
            });
            let naive = distances.fold(f64::INFINITY, f64::min);
            assert!((naive - distance).abs() < 1e-6, "{naive} {distance}");
        }
    }
}

#[test]
fn other_points_are_farther_off_or_refused() {
    let points = scattered(700, &mut SplitMix64(9));
    let verify = |points: Vec<[f32; 3]>, heights: Vec<[f32; 3]>| {
        terrain_verify(stored(&points), Some(given(&heights)), &of_error(2.0), &()).unwrap()
    };
    let mut higher = points.clone();
    higher[300][1] += 50.0;
    let report = verify(points.clone(), higher);
    assert_eq!(report.errors.seen - report.errors.within, 1);
    assert!(report.worst_metres() >= 48.0);
    assert_eq!(report.failures().len(), 2, "{:?}", report.failures());

    // Outside of the rectangle; at a place that there is already; not a number.
    let mut more = points.clone();
    more.extend([
        [0.0, 1.0, 0.0],
        [points[5][0], 9.0, points[5][2]],
        [f32::NAN; 3],
    ]);
    let report = verify(points.clone(), more);
    assert_eq!((report.heights, report.surfaces[0].uncovered), (701, 1));
    assert_eq!(report.failures(), ["places that no face covers: 1"]);

    let flat = HeightGrid::new([2, 2], [1.0; 2], vec![0.0; 4]).unwrap();
    let grid = TerrainHeights::of_grid("flat", flat.clone());
    let over_grid = TerrainSource::of_heights(TerrainHeights::of_grid("flat", flat)).unwrap();
    for (source, heights) in [(stored(&points), grid), (over_grid, given(&points))] {
        let error = terrain_verify(source, Some(heights), &of_error(1.0), &()).unwrap_err();
        assert!(matches!(error, TerrainError::OtherKind { .. }), "{error}");
    }
}
