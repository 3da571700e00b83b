//! Heights from files.

use std::fs;
use std::path::{Path, PathBuf};

use super::error::TerrainError;
use crate::files::height_map::{HeightMap, HeightMapOptions};
use crate::files::{Document, FileErrorKind, Note, Place, ReadOptions};
use crate::height_grid::HeightGrid;
use crate::index::index32;
use crate::lod::quad_tin::{PointCounts, PointHierarchy, QuadTin};
use crate::operations::plain_meshes::plain_meshes;
use crate::operations::walks::is_stored;

/// How height maps become heights.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct TerrainReadOptions {
    /// How each map is read.
    pub maps: HeightMapOptions,
    /// Fill voids from their surroundings; they are holes otherwise.
    pub fill_voids: bool,
    /// Of points and meshes, z is up and y north. Otherwise y is up and z south, as in what is written.
    pub is_z_up: bool,
}

/// Heights above a grid, or above any places.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum TerrainSamples {
    /// Of height maps.
    Grid(HeightGrid),
    /// Points, x east, y up, z south.
    Points(Vec<[f32; 3]>),
}

/// Heights of one file, or of several that lie beside each other, and what was found in them.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct TerrainHeights {
    /// All of them.
    pub samples: TerrainSamples,
    /// What the terrain is called.
    pub name: String,
    /// The files.
    pub files: Vec<PathBuf>,
    /// Their sizes.
    pub bytes: u64,
    /// Places without a height, before any was filled.
    pub voids: usize,
    /// How many of them were filled.
    pub filled: usize,
    /// Places at which two files have different heights; that of the first one is taken.
    pub disagreeing: usize,
    /// How far these are apart at most, in metres.
    pub largest_disagreement: f32,
    /// What the readers say, each with its file.
    pub notes: Vec<(PathBuf, Note)>,
}

impl TerrainHeights {
    /// Reads height maps, and joins them if there are several; or files of points or meshes, of which all vertices count.
    ///
    /// # Errors
    /// [`TerrainError`]: a file is of no known format or cannot be read, or the files do not fit together.
    ///
    /// # Complexity
    /// Time O(bytes + places). Space: the heights of the files and those of the whole, 4 bytes a place, 12 a point.
    pub fn open(paths: &[PathBuf], options: &TerrainReadOptions) -> Result<Self, TerrainError> {
        if let Some(path) = paths
            .iter()
            .find(|it| is_stored(it, "mwt", QuadTin::begins_bytes))
        {
            let file = path.clone();
            return Err(TerrainError::Built { file });
        }
        let is_map = |path: &PathBuf| !path.exists() || HeightMap::is_height_map(path);
        match paths.iter().position(|it| !is_map(it)) {
            None => Self::open_maps(paths, options),
            Some(_) if !paths.iter().any(is_map) => Self::open_points(paths, options),
            Some(other) => {
                let file = paths[other].clone();
                Err(TerrainError::Mixed { file })
            }
        }
    }

    fn open_maps(paths: &[PathBuf], options: &TerrainReadOptions) -> Result<Self, TerrainError> {
        let (mut maps, mut notes, mut bytes) = (Vec::new(), Vec::new(), 0);
        for path in paths {
            let mut map = HeightMap::open(path, &options.maps)?;
            notes.extend(map.notes.drain(..).map(|note| (path.clone(), note)));
            bytes += size_of(path);
            maps.push(map);
        }

        // As one.
        let first = paths.first().map_or(Path::new(""), |it| it.as_path());
        let joined = HeightMap::join(maps).map_err(|error| {
            let kind = FileErrorKind::unsupported(error.to_string());
            kind.at(Place::File).in_file(first, None)
        })?;
        let joined_notes = joined.map.notes.iter();
        notes.extend(joined_notes.map(|note| (first.to_owned(), note.clone())));
        let mut grid = joined.map.grid;
        let voids = grid.void_count();
        let filled = match options.fill_voids {
            true => grid.fill_voids(),
            false => 0,
        };
        Ok(Self {
            voids,
            filled,
            files: paths.to_vec(),
            bytes,
            disagreeing: joined.disagreeing,
            largest_disagreement: joined.largest_difference,
            notes,
            ..Self::new(&name_of(first), TerrainSamples::Grid(grid))
        })
    }

    fn open_points(paths: &[PathBuf], options: &TerrainReadOptions) -> Result<Self, TerrainError> {
        let (mut points, mut notes, mut bytes) = (Vec::new(), Vec::new(), 0);
        for path in paths {
            let read = ReadOptions {
                limits: options.maps.limits,
                ..ReadOptions::default()
            };
            let document = Document::open(path, read).map_err(|error| match error.kind {
                FileErrorKind::UnknownFormat => TerrainError::NoTerrain { file: path.clone() },
                _ => error.into(),
            })?;
            bytes += size_of(path);
            let loose = document.loose_positions()?;
            if !loose.is_empty() {
                points.extend(loose);
                continue;
            }
            if document.meshes().is_empty() {
                let file = path.clone();
                return Err(TerrainError::NoPoints { file });
            }
            let own_notes = document.notes().iter();
            notes.extend(own_notes.map(|note| (path.clone(), note.clone())));
            for plain in plain_meshes(&document)? {
                points.extend_from_slice(plain.mesh.positions());
            }
        }
        if options.is_z_up {
            for point in &mut points {
                let [x, y, z] = *point;
                *point = [x, z, -y];
            }
        }
        let first = paths.first().map_or(Path::new(""), |it| it.as_path());
        if let Some(text) = lost_digits(&points) {
            notes.push((first.to_owned(), Note::new(Place::File, text)));
        }
        Ok(Self {
            files: paths.to_vec(),
            bytes,
            notes,
            ..Self::new(&name_of(first), TerrainSamples::Points(points))
        })
    }

    /// Heights that are from no file.
    #[must_use]
    pub fn of_grid(name: &str, grid: HeightGrid) -> Self {
        Self {
            voids: grid.void_count(),
            ..Self::new(name, TerrainSamples::Grid(grid))
        }
    }

    /// Points that are from no file: x east, y up, z south.
    #[must_use]
    pub fn of_points(name: &str, points: Vec<[f32; 3]>) -> Self {
        Self::new(name, TerrainSamples::Points(points))
    }

    fn new(name: &str, samples: TerrainSamples) -> Self {
        Self {
            samples,
            name: name.to_owned(),
            files: Vec::new(),
            bytes: 0,
            voids: 0,
            filled: 0,
            disagreeing: 0,
            largest_disagreement: 0.0,
            notes: Vec::new(),
        }
    }

    /// The grid, if it is one.
    #[must_use]
    pub fn grid(&self) -> Option<&HeightGrid> {
        match &self.samples {
            TerrainSamples::Grid(grid) => Some(grid),
            TerrainSamples::Points(_) => None,
        }
    }

    /// The hierarchy of these heights, compared with them; and what became of points.
    pub(super) fn tin(&self) -> Result<(QuadTin, Option<PointCounts>), TerrainError> {
        let file = || self.file();
        match &self.samples {
            TerrainSamples::Grid(grid) => {
                let tin = QuadTin::over_grid(grid);
                let tin = tin.map_err(|error| TerrainError::Heights {
                    file: file(),
                    error,
                })?;
                let is_same = |(vertex, height): (u32, &f32)| {
                    let own = tin.height(vertex).map(f32::to_bits);
                    own == (!height.is_nan()).then_some(height.to_bits())
                };
                match (0..).zip(grid.heights()).all(is_same) {
                    true => Ok((tin, None)),
                    false => Err(TerrainError::NotVerified { file: file() }),
                }
            }
            TerrainSamples::Points(points) => {
                let hierarchy = PointHierarchy::over(points);
                let hierarchy = hierarchy.map_err(|error| TerrainError::Points {
                    file: file(),
                    error,
                })?;
                let is_same = |vertex: u32| {
                    let source = hierarchy.source(vertex).map(|it| points[it as usize]);
                    let own = hierarchy.position(vertex).map(f32::to_bits);
                    source.is_none_or(|it| it.map(f32::to_bits) == own)
                };
                if !(0..index32(hierarchy.vertex_count())).all(is_same) {
                    return Err(TerrainError::NotVerified { file: file() });
                }
                let counts = *hierarchy.counts();
                Ok((hierarchy.into(), Some(counts)))
            }
        }
    }

    /// What errors name.
    pub(super) fn file(&self) -> PathBuf {
        match self.files.first() {
            Some(file) => file.clone(),
            None => PathBuf::from(&self.name),
        }
    }
}

/// The size of a file that could be read.
fn size_of(path: &Path) -> u64 {
    fs::metadata(path).map_or(0, |it| it.len())
}

/// The name of a file, without its endings.
fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    stem.to_owned()
}

/// Coordinates that are farther from 0 than this times the range of all are said to have lost digits: no more than 17 bits tell the
/// points of that range apart.
const FAR: f64 = 64.0;

/// What is said of points that are far from 0 for the area that they are in: how far two `f32` are apart there.
fn lost_digits(points: &[[f32; 3]]) -> Option<String> {
    let finite = || points.iter().filter(|it| it.iter().all(|x| x.is_finite()));
    let far = [0, 2].into_iter().filter_map(|axis: usize| {
        let along = finite().map(|it| it[axis]);
        let [low, high] = along.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], it| {
            [low.min(it), high.max(it)]
        });
        let largest = low.abs().max(high.abs());
        let range = f64::from(high) - f64::from(low);
        (largest.is_finite() && f64::from(largest) > FAR * range).then_some(largest)
    });
    let largest = far.reduce(f32::max)?;

    // Those at the place of another one, -0 and 0 being one.
    let place = |&[x, _, z]: &[f32; 3]| [x, z].map(|it| (it + 0.0).to_bits());
    let mut places: Vec<[u32; 2]> = finite().map(place).collect();
    let count = places.len();
    places.sort_unstable();
    places.dedup();
    let together = count - places.len();
    let step = largest - largest.next_down();
    Some(format!(
        "coordinates of up to {largest} are read as 32-bit numbers, which are {step} apart there, and that is the grid that the points \
         are on; points at the place of another one: {together}. Move the points towards 0, by subtracting a round origin, and \
         export them again to keep their digits"
    ))
}

#[cfg(test)]
mod tests {
    use super::lost_digits;

    #[test]
    fn what_points_far_from_0_lose_is_said() {
        // A kilometre in steps of 10 cm, in UTM.
        let line = |origin: [f64; 2]| {
            let point = |i: u32| {
                let along = 0.1 * f64::from(i);
                #[expect(clippy::cast_possible_truncation, reason = "as a reader does it")]
                let place = [origin[0] + along, origin[1] + along].map(|it| it as f32);
                [place[0], 7.0, place[1]]
            };
            (0..10_000).map(point).collect::<Vec<_>>()
        };
        let said = lost_digits(&line([500_000.0, 5_200_000.0])).unwrap();
        assert!(said.contains("of up to 5201000 "), "{said}");
        assert!(said.contains("which are 0.5 apart there"), "{said}");
        // To the east they are 1/32 apart, so none is at the place of another one; along one northing four of five are.
        assert!(said.contains("at the place of another one: 0."), "{said}");
        let mut same = line([500_000.0, 5_200_000.0]);
        same.iter_mut().for_each(|it| it[0] = 500_000.0);
        let said = lost_digits(&same).unwrap();
        assert!(said.contains("another one: 7999."), "{said}");

        assert_eq!(lost_digits(&line([0.0, 0.0])), None);
        assert_eq!(lost_digits(&line([60_000.0, -500.0])), None);
        assert_eq!(lost_digits(&[]), None);
    }
}
