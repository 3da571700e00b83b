//! A hierarchy over a grid or over points.

use std::fmt;
use std::io::{self, Write};

use super::descent::{Descent, TinSurface};
use super::extent::TinExtent;
use super::grid::GridTin;
use super::grid_square;
use super::limited::{TinLimit, draw_within};
use super::triangle::NodeBound;
use crate::height_grid::HeightGrid;
use crate::lod::view::{CameraView, DetailBound};

/// All levels of detail of a terrain: what to draw of it is found on one way down, for any view.
///
/// Each vertex knows how far any input point below it may be from the surface without it, vertically: exactly so, and never more.
///
/// ```
/// use meshweft::HeightGrid;
/// use meshweft::lod::CameraView;
/// use meshweft::lod::quad_tin::{QuadTin, TinSurface};
/// let heights = (0..5 * 4).map(|i| [0.0, 1.0, 3.0, 1.0][i / 5]).collect::<Vec<f32>>();
/// let terrain = QuadTin::over_grid(&HeightGrid::new([5, 4], [10.0, 10.0], heights)?)?;
///
/// let mut surface = TinSurface::default();
/// terrain.draw(&CameraView::of_errors_above(-1.0)?, &mut surface);
/// assert_eq!(surface.faces().len(), 2 * 4 * 3);
/// terrain.draw(&CameraView::of_errors_above(1.5)?, &mut surface);
/// assert!(surface.faces().len() < 24 && surface.largest_error() <= 1.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct QuadTin {
    pub(super) grid: GridTin,
    pub(super) extent: TinExtent,
}

/// Most vertices: four faces begin at each, and have numbers.
pub(super) const MOST_VERTICES: usize = 1 << 30;

/// Why there is no hierarchy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum QuadTinError {
    /// A grid has more than 2^30 places.
    TooLarge,
    /// No place, or no triangle between neighbouring places, has heights.
    Empty,
}

impl fmt::Display for QuadTinError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooLarge => "the grid has more than 2^30 places: cut it into parts",
            Self::Empty => "the grid has no three neighbouring heights: all of it is void",
        })
    }
}

impl std::error::Error for QuadTinError {}

impl QuadTin {
    /// The hierarchy over a grid. What is void is a hole: no face has a void corner, or has a void inside.
    ///
    /// # Errors
    /// [`QuadTinError`] if the grid has more than 2^30 places, or no three neighbouring heights.
    ///
    /// # Complexity
    /// Time O(n log n) for n places; memory 8 bytes a place.
    pub fn over_grid(grid: &HeightGrid) -> Result<Self, QuadTinError> {
        if grid.heights().len() > MOST_VERTICES {
            return Err(QuadTinError::TooLarge);
        }
        let extent = TinExtent::of(grid).ok_or(QuadTinError::Empty)?;
        Ok(Self {
            grid: GridTin::over(grid),
            extent,
        })
    }

    /// How many vertices there are at full detail.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        let [columns, rows] = self.grid.blocks.square.size;
        columns as usize * rows as usize
    }

    /// Where a vertex is: x east, y up, z south. y is 0 where it is void or was not read.
    #[must_use]
    pub fn position(&self, vertex: u32) -> [f32; 3] {
        self.grid.position(self.place(vertex))
    }

    /// The error that keeps a vertex in the surface, if it is above it; infinite where it is always drawn.
    #[must_use]
    pub fn error(&self, vertex: u32) -> f32 {
        self.grid.error(self.place(vertex))
    }

    /// How many faces there are at full detail.
    #[must_use]
    pub fn face_count(&self) -> u64 {
        self.extent.faces
    }

    /// The lowest and the highest height.
    #[must_use]
    pub fn height_range(&self) -> [f32; 2] {
        self.extent.heights
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.grid.blocks.square.size
    }

    /// How far columns and rows are apart, in metres.
    #[must_use]
    pub fn spacing(&self) -> [f64; 2] {
        self.grid.spacing
    }

    /// Writes it as a `.mwt` file, with a name.
    ///
    /// # Errors
    /// What the sink says.
    pub fn write(&self, name: &str, sink: &mut dyn Write) -> io::Result<()> {
        self.grid.write(self.extent, name, sink)
    }

    fn place(&self, vertex: u32) -> [u32; 2] {
        grid_square::place(self.grid.blocks.square.vertex_of(vertex))
    }

    /// The coarsest surface that a view does not need finer. It has no cracks, whatever the view.
    ///
    /// # Complexity
    /// Time and space O(faces).
    pub fn draw(&self, view: &CameraView, surface: &mut TinSurface) {
        let needs = |_, bound: &NodeBound| view.needs(&bound.detail());
        Descent {
            tree: &self.grid,
            needs,
            surface,
        }
        .run();
    }

    /// The surface of limited size that a view needs most: what it sees worst is cut first.
    ///
    /// The faces along borders and holes are always there, even if they are more.
    ///
    /// # Complexity
    /// Time O(n log n), space O(n) for n faces.
    pub fn draw_within(&self, limit: TinLimit, view: &CameraView, surface: &mut TinSurface) {
        draw_within(&self.grid, view, limit, surface);
    }
}

impl NodeBound {
    /// What a view is asked about.
    pub(super) fn detail(&self) -> DetailBound {
        DetailBound::of_ball(self.position, self.radius, self.error)
    }
}
