//! The heights that surfaces are measured against, of either kind.

use super::error::TerrainError;
use super::full_grid::FullGrid;
use super::full_points::FullPoints;
use super::heights::TerrainSamples;
use super::source::{TerrainFacts, TerrainSource};
use super::surface_faults::SurfaceFaults;
use crate::height_grid::HeightGrid;
use crate::index::index32;
use crate::lod::quad_tin::{QuadTin, QuadTinError};

/// All heights, ready to be looked at.
#[derive(Debug)]
pub(super) enum MeasuredHeights<'a> {
    Grid(FullGrid<'a>),
    Points(FullPoints),
}

impl<'a> MeasuredHeights<'a> {
    /// Heights to measure a terrain with.
    ///
    /// # Errors
    /// They are of the other kind, or on another grid.
    pub(super) fn of(
        samples: &'a TerrainSamples,
        source: &TerrainSource,
    ) -> Result<Self, TerrainError> {
        let terrain = TerrainFacts::of(source.tin());
        let known = terrain.grid_size.zip(terrain.grid_spacing);
        let file = source.file.clone();
        match (samples, known) {
            (TerrainSamples::Points(points), None) => {
                let range = source.tin().horizontal_range();
                Ok(Self::Points(FullPoints::new(points, range)))
            }
            (TerrainSamples::Grid(grid), Some((size, spacing))) => {
                let found = (grid.size(), grid.spacing());
                let is_near =
                    |axis: usize| (spacing[axis] - found.1[axis]).abs() <= 1e-9 * spacing[axis];
                match size == found.0 && is_near(0) && is_near(1) {
                    true => Ok(Self::Grid(FullGrid::new(grid))),
                    false => Err(TerrainError::OtherGrid {
                        file,
                        size,
                        spacing,
                        found,
                    }),
                }
            }
            (_, known) => Err(TerrainError::OtherKind {
                file,
                is_over_grid: known.is_some(),
            }),
        }
    }

    /// How many heights there are.
    pub(super) fn count(&self) -> usize {
        match self {
            Self::Grid(full) => full.grid.heights().len() - full.grid.void_count(),
            Self::Points(full) => full.count(),
        }
    }

    /// Looks at all heights that a surface covers, and gives each to `measured` once, with how far it is from the surface, vertically.
    pub(super) fn look_at(
        &self,
        tin: &QuadTin,
        faces: &[(u32, [u32; 3])],
        mut measured: impl FnMut([f32; 3], f64),
    ) -> SurfaceFaults {
        match self {
            Self::Grid(full) => {
                let columns = full.grid.size()[0] as usize;
                full.look_at(tin, faces, |number, distance| {
                    let place = [number % columns, number / columns];
                    let [column, row] = place.map(index32);
                    measured(full.grid.position(column, row), distance);
                })
            }
            Self::Points(full) => full.look_at(&|vertex| tin.position(vertex), faces, measured),
        }
    }
}

/// The heights of a terrain of which all was read: over points, those of its vertices that are points.
pub(super) fn own_samples(source: &TerrainSource) -> Result<TerrainSamples, TerrainError> {
    let tin = source.tin();
    let vertices = 0..index32(tin.vertex_count());
    let Some((size, spacing)) = tin.grid_size().zip(tin.grid_spacing()) else {
        let own = vertices.filter(|&it| tin.is_input(it));
        let points = own.map(|it| tin.position(it));
        return Ok(TerrainSamples::Points(points.collect()));
    };
    let height = |vertex| tin.height(vertex).unwrap_or(f32::NAN);
    let grid = HeightGrid::new(size, spacing, vertices.map(height).collect());
    grid.map(TerrainSamples::Grid)
        .map_err(|_| TerrainError::Heights {
            file: source.file.clone(),
            error: QuadTinError::Empty,
        })
}
