//! Heights from files.

use std::fs;
use std::path::{Path, PathBuf};

use super::error::TerrainError;
use crate::files::height_map::{HeightMap, HeightMapOptions};
use crate::files::{FileErrorKind, Note, Place};
use crate::height_grid::HeightGrid;
use crate::lod::quad_tin::QuadTin;
use crate::operations::walks::is_stored;

/// How height maps become heights.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct TerrainReadOptions {
    /// How each map is read.
    pub maps: HeightMapOptions,
    /// Fill voids from their surroundings; they are holes otherwise.
    pub fill_voids: bool,
}

/// Heights of one file, or of several that lie beside each other, and what was found in them.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct TerrainHeights {
    /// All of them.
    pub grid: HeightGrid,
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
    /// Reads height maps, and joins them if there are several.
    ///
    /// # Errors
    /// [`TerrainError`]: a file is no height map or cannot be read, or the files do not fit together.
    ///
    /// # Complexity
    /// Time O(bytes + places). Space: the heights of the files and those of the whole, 4 bytes a place.
    pub fn open(paths: &[PathBuf], options: &TerrainReadOptions) -> Result<Self, TerrainError> {
        let (mut maps, mut notes, mut bytes) = (Vec::new(), Vec::new(), 0);
        for path in paths {
            if is_stored(path, "mwt", QuadTin::begins_bytes) {
                let file = path.clone();
                return Err(TerrainError::Built { file });
            }
            // Here is the place for files of points.
            if path.exists() && !HeightMap::is_height_map(path) {
                let file = path.clone();
                return Err(TerrainError::NoTerrain { file });
            }
            let mut map = HeightMap::open(path, &options.maps)?;
            notes.extend(map.notes.drain(..).map(|note| (path.clone(), note)));
            bytes += fs::metadata(path).map_or(0, |it| it.len());
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
        let mut heights = Self::of_grid(&name_of(first), joined.map.grid);
        heights.filled = match options.fill_voids {
            true => heights.grid.fill_voids(),
            false => 0,
        };
        Ok(Self {
            files: paths.to_vec(),
            bytes,
            disagreeing: joined.disagreeing,
            largest_disagreement: joined.largest_difference,
            notes,
            ..heights
        })
    }

    /// Heights that are from no file.
    #[must_use]
    pub fn of_grid(name: &str, grid: HeightGrid) -> Self {
        Self {
            voids: grid.void_count(),
            grid,
            name: name.to_owned(),
            files: Vec::new(),
            bytes: 0,
            filled: 0,
            disagreeing: 0,
            largest_disagreement: 0.0,
            notes: Vec::new(),
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

/// The name of a file, without its endings.
fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    stem.to_owned()
}
