//! A hierarchy over a grid or over points.

use std::fmt;
use std::io::{self, Write};

use super::descent::TinSurface;
use super::extent::TinExtent;
use super::grid::GridTin;
use super::limited::TinLimit;
use super::points::{CORNERS, PointHierarchy};
use super::stored_grid::MOST_PLACES;
use super::tree::TinTree;
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
    pub(super) tree: TinTree,
    pub(super) extent: TinExtent,
}

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
        if grid.heights().len() > MOST_PLACES {
            return Err(QuadTinError::TooLarge);
        }
        let extent = TinExtent::of(grid).ok_or(QuadTinError::Empty)?;
        Ok(Self {
            tree: TinTree::Grid(GridTin::over(grid)),
            extent,
        })
    }

    /// How many vertices there are at full detail, with void ones.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.tree.vertex_count()
    }

    /// Where a vertex is: x east, y up, z south. y is 0 where it is void or was not read.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub fn position(&self, vertex: u32) -> [f32; 3] {
        match &self.tree {
            TinTree::Grid(grid) => grid.position(grid.place(vertex)),
            TinTree::Points(points) => points.position(vertex),
        }
    }

    /// The height of a vertex; `None` where it is void or was not read.
    #[must_use]
    pub fn height(&self, vertex: u32) -> Option<f32> {
        let height = match &self.tree {
            TinTree::Grid(grid) => grid.node(grid.place(vertex)).ok()?.height,
            TinTree::Points(points) => points.position(vertex)[1],
        };
        (!height.is_nan()).then_some(height)
    }

    /// The error that keeps a vertex in the surface, if it is above it; infinite where it is always drawn.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub fn error(&self, vertex: u32) -> f32 {
        match &self.tree {
            TinTree::Grid(grid) => grid.error(grid.place(vertex)),
            TinTree::Points(points) => points.error(vertex),
        }
    }

    /// Whether a vertex is a height of the input. Over points, a few are not, and no error says how far those are from a surface.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub fn is_input(&self, vertex: u32) -> bool {
        match &self.tree {
            TinTree::Grid(_) => self.height(vertex).is_some(),
            TinTree::Points(points) => !points.is_steiner[vertex as usize],
        }
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

    /// Columns and rows; `None` if it is not over a grid.
    #[must_use]
    pub fn grid_size(&self) -> Option<[u32; 2]> {
        match &self.tree {
            TinTree::Grid(grid) => Some(grid.blocks.square.size),
            TinTree::Points(_) => None,
        }
    }

    /// How far columns and rows are apart, in metres; `None` if it is not over a grid.
    #[must_use]
    pub fn grid_spacing(&self) -> Option<[f64; 2]> {
        match &self.tree {
            TinTree::Grid(grid) => Some(grid.spacing),
            TinTree::Points(_) => None,
        }
    }

    /// The smallest and the largest x, and those of z.
    #[must_use]
    pub fn horizontal_range(&self) -> [[f32; 2]; 2] {
        let [[west, _, north], [east, _, south]] = match &self.tree {
            TinTree::Grid(grid) => {
                let last = grid.blocks.square.size.map(|it| it - 1);
                [[0, 0], last].map(|place| grid.position(place))
            }
            // The first and the last of the corners.
            TinTree::Points(points) => [0, CORNERS - 1].map(|it| points.position(it)),
        };
        [[west, east], [north, south]]
    }

    /// Writes it as a `.mwt` file, with a name.
    ///
    /// # Errors
    /// What the sink says.
    pub fn write(&self, name: &str, sink: &mut dyn Write) -> io::Result<()> {
        self.tree.write(self.extent, name, sink)
    }

    /// The coarsest surface that a view does not need finer. It has no cracks, whatever the view.
    ///
    /// # Complexity
    /// Time and space O(faces).
    pub fn draw(&self, view: &CameraView, surface: &mut TinSurface) {
        self.tree.draw(view, surface);
    }

    /// The surface of limited size that a view needs most: what it sees worst is cut first.
    ///
    /// The faces along borders and holes are always there, even if they are more.
    ///
    /// # Complexity
    /// Time O(n log n), space O(n) for n faces.
    pub fn draw_within(&self, limit: TinLimit, view: &CameraView, surface: &mut TinSurface) {
        self.tree.draw_within(limit, view, surface);
    }
}

impl From<PointHierarchy> for QuadTin {
    fn from(points: PointHierarchy) -> Self {
        Self {
            extent: points.extent(),
            tree: TinTree::Points(points),
        }
    }
}

impl NodeBound {
    /// What a view is asked about.
    pub(super) fn detail(&self) -> DetailBound {
        DetailBound::of_ball(self.position, self.radius, self.error)
    }
}
