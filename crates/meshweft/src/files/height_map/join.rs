//! Several height maps as one.

use super::map::HeightMap;
use super::placement::{MapPlacement, metres_per_degree};
use crate::height_grid::HeightGrid;
use crate::index::index32;

/// Several height maps as one grid, and how far they agree where they lie over each other.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct JoinedMap {
    /// The whole; places that no map covers are void.
    pub map: HeightMap,
    /// How many samples have heights in more than one map, counted once for each map after the first.
    pub shared: usize,
    /// In how many of them the heights differ.
    pub disagreeing: usize,
    /// By how much at most, in metres.
    pub largest_difference: f32,
}

/// Why maps are not one grid: which of them, in the order given, and why.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum JoinError {
    /// There is no map.
    Nothing,
    /// A map does not say where it lies.
    #[non_exhaustive]
    Nowhere {
        /// The map.
        map: usize,
    },
    /// A map is in other coordinates than the first one.
    #[non_exhaustive]
    Coordinates {
        /// The map.
        map: usize,
        /// Those of the first one, and its own.
        systems: [String; 2],
    },
    /// The samples of a map are otherwise apart than those of the first one.
    #[non_exhaustive]
    Step {
        /// The map.
        map: usize,
        /// Of the first one, and its own, in the units of the coordinates.
        steps: [[f64; 2]; 2],
    },
    /// A map is not whole samples away from the first one.
    #[non_exhaustive]
    Offset {
        /// The map.
        map: usize,
        /// How many samples it is away, to the east and to the south.
        samples: [f64; 2],
    },
    /// The whole would have too many columns or rows, or be mostly void.
    #[non_exhaustive]
    Size {
        /// Columns and rows.
        size: [u64; 2],
        /// Samples of all maps.
        samples: usize,
    },
}

impl std::fmt::Display for JoinError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Nothing => f.write_str("there is no height map to join: give one"),
            Self::Nowhere { map } => write!(
                f,
                "height map {map} does not say where it lies, so it cannot be joined with others: take it alone, or a \
                 GeoTIFF of it"
            ),
            Self::Coordinates {
                map,
                systems: [first, own],
            } => write!(
                f,
                "height map {map} is in {own}, the first one in {first}: warp them to the same coordinates, for example \
                 with gdalwarp"
            ),
            Self::Step {
                map,
                steps: [[x, y], [own_x, own_y]],
            } => write!(
                f,
                "samples of height map {map} are {own_x} by {own_y} apart, those of the first one {x} by {y}: resample them, \
                 for example with gdalwarp -tr"
            ),
            Self::Offset {
                map,
                samples: [x, y],
            } => write!(
                f,
                "height map {map} is {x:.3} by {y:.3} samples away from the first one, which are not whole: resample it, for \
                 example with gdalwarp -tap"
            ),
            Self::Size {
                size: [columns, rows],
                samples,
            } => write!(
                f,
                "{samples} samples would be spread over {columns} columns and {rows} rows: a grid has at most {} of each, and \
                 at least one sample in {SPARSE}. Join fewer maps, or nearer ones",
                HeightGrid::MOST
            ),
        }
    }
}

impl std::error::Error for JoinError {}

/// How many places a joined grid may have a sample of its maps.
const SPARSE: u64 = 20;
/// Places that it may have anyway.
const FREE_PLACES: u64 = 1 << 24;
/// How far from a whole sample a map may lie at any of its own, in samples.
const TOLERANCE: f64 = 0.05;

/// Where samples lie: origin and step, growing to the east and to the north, and in which coordinates.
struct TileLattice {
    west: f64,
    north: f64,
    step: [f64; 2],
    system: String,
}

impl TileLattice {
    fn of(placement: &MapPlacement) -> Option<Self> {
        let (west, north, step, system) = match placement {
            MapPlacement::Unknown => return None,
            MapPlacement::Degrees { west, north, step } => {
                (*west, *north, *step, "degrees".to_owned())
            }
            MapPlacement::Projected {
                easting,
                northing,
                step,
                system,
            } => {
                let system = match system.is_empty() {
                    true => "metres".to_owned(),
                    false => system.clone(),
                };
                (*easting, *northing, *step, system)
            }
        };
        Some(Self {
            west,
            north,
            step,
            system,
        })
    }
}

impl HeightMap {
    /// One grid of all these maps, the first of them first: where two have a height, that of the earlier one is taken;
    /// where one has a void, that of the other.
    ///
    /// Maps lie whole samples apart, in the same coordinates, and their samples are equally spaced. One map is taken as it
    /// is.
    ///
    /// # Errors
    /// [`JoinError`] names the map that does not fit, counted from 1.
    ///
    /// # Complexity
    /// Time O(samples of the whole). Space: the whole beside the maps, each of which is given back when it is in.
    pub fn join(mut maps: Vec<Self>) -> Result<JoinedMap, JoinError> {
        if maps.len() <= 1 {
            let map = maps.pop().ok_or(JoinError::Nothing)?;
            return Ok(JoinedMap::of(map));
        }
        let offsets = offsets(&maps)?;

        // The whole, from its north-western place on.
        let least = [0, 1].map(|axis| offsets.iter().map(|it| it[axis]).min().unwrap_or(0));
        let ends = maps.iter().zip(&offsets).map(|(map, offset)| {
            [0, 1].map(|axis| offset[axis] - least[axis] + i64::from(map.grid.size()[axis]))
        });
        let size = ends.fold([0, 0], |size: [i64; 2], end| {
            [0, 1].map(|axis| size[axis].max(end[axis]))
        });
        let size = size.map(i64::unsigned_abs);
        let samples = maps.iter().map(|map| map.grid.heights().len()).sum();
        let is_large = size.iter().any(|it| *it > u64::from(HeightGrid::MOST));
        if is_large || size[0] * size[1] > FREE_PLACES + SPARSE * samples as u64 {
            return Err(JoinError::Size { size, samples });
        }
        let [columns, rows] = size.map(|it| usize::try_from(it).expect("at most 32,769"));

        // Its place, by that of the first map.
        let first = &maps[0];
        let placement = moved(&first.placement, least.map(|it| it as f64));
        let spacing = spacing(first, &placement, size[1]);
        let mut joined = JoinedMap::of(Self {
            grid: first.grid.clone(),
            placement,
            notes: Vec::new(),
            given_spacing: first.given_spacing,
        });

        let mut heights = vec![f32::NAN; columns * rows];
        for (map, offset) in maps.into_iter().zip(&offsets) {
            let [column, row] = [0, 1].map(|axis| (offset[axis] - least[axis]).unsigned_abs());
            let start = usize::try_from(row * size[0] + column).expect("inside the whole");
            joined.put(&map.grid, &mut heights[start..], columns);
            joined.map.notes.extend(map.notes);
        }
        let size = [columns, rows].map(index32);
        joined.map.grid = HeightGrid::new(size, spacing, heights).expect("its parts are grids");
        Ok(joined)
    }
}

impl JoinedMap {
    fn of(map: HeightMap) -> Self {
        Self {
            map,
            shared: 0,
            disagreeing: 0,
            largest_difference: 0.0,
        }
    }

    /// Puts a grid at the start of these heights, whose rows are this far apart.
    fn put(&mut self, grid: &HeightGrid, heights: &mut [f32], columns: usize) {
        let width = grid.size()[0] as usize;
        let rows = grid.heights().chunks_exact(width);
        for (row, places) in rows.zip(heights.chunks_mut(columns)) {
            for (place, &height) in places.iter_mut().zip(row) {
                if place.is_nan() {
                    *place = height;
                } else if !height.is_nan() {
                    let difference = (*place - height).abs();
                    self.shared += 1;
                    self.disagreeing += usize::from(difference > 0.0);
                    self.largest_difference = self.largest_difference.max(difference);
                }
            }
        }
    }
}

/// How many samples each map is east and south of the first one.
fn offsets(maps: &[HeightMap]) -> Result<Vec<[i64; 2]>, JoinError> {
    let lattices = maps
        .iter()
        .enumerate()
        .map(|(map, it)| TileLattice::of(&it.placement).ok_or(JoinError::Nowhere { map: map + 1 }));
    let lattices: Vec<TileLattice> = lattices.collect::<Result<_, _>>()?;
    let first = &lattices[0];
    let offsets = lattices
        .iter()
        .zip(maps)
        .enumerate()
        .map(|(number, (own, map))| {
            let number = number + 1;
            if own.system != first.system {
                let systems = [first.system.clone(), own.system.clone()];
                return Err(JoinError::Coordinates {
                    map: number,
                    systems,
                });
            }
            let size = map.grid.size();
            let is_other = |axis: usize| {
                let drift = (own.step[axis] / first.step[axis] - 1.0).abs();
                drift * f64::from(size[axis]) > TOLERANCE
            };
            let has_other_spacing = map.given_spacing != maps[0].given_spacing;
            if is_other(0) || is_other(1) || has_other_spacing {
                let steps = [first.step, own.step];
                return Err(JoinError::Step { map: number, steps });
            }

            // East of the antimeridian, longitudes begin again.
            let mut east = own.west - first.west;
            if own.system == "degrees" {
                east -= 360.0 * (east / 360.0).round();
            }
            let samples = [
                east / first.step[0],
                (first.north - own.north) / first.step[1],
            ];
            let is_off = |it: &f64| (it - it.round()).abs() > TOLERANCE;
            match samples.iter().any(is_off) {
                true => Err(JoinError::Offset {
                    map: number,
                    samples,
                }),
                false => Ok(samples.map(whole)),
            }
        });
    offsets.collect()
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "too far becomes far enough to be refused"
)]
fn whole(samples: f64) -> i64 {
    samples.round().clamp(-1e12, 1e12) as i64
}

/// The placement of a place this many samples to the east and to the south.
fn moved(placement: &MapPlacement, [east, south]: [f64; 2]) -> MapPlacement {
    let mut moved = placement.clone();
    match &mut moved {
        MapPlacement::Unknown => {}
        MapPlacement::Degrees { west, north, step } => {
            *west += east * step[0];
            *north -= south * step[1];
        }
        MapPlacement::Projected {
            easting,
            northing,
            step,
            ..
        } => {
            *easting += east * step[0];
            *northing -= south * step[1];
        }
    }
    moved
}

/// The spacing of the whole: degrees are as long as at its own middle.
fn spacing(first: &HeightMap, placement: &MapPlacement, rows: u64) -> [f64; 2] {
    match placement {
        MapPlacement::Degrees { north, step, .. } if first.given_spacing.is_none() => {
            let middle = north - 0.5 * step[1] * (rows - 1) as f64;
            let metres = metres_per_degree(middle.clamp(-89.9, 89.9));
            [step[0] * metres[0], step[1] * metres[1]]
        }
        _ => first.grid.spacing(),
    }
}
