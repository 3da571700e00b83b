//! A height map, from the bytes of any format.

use std::path::Path;

use super::super::disk::{holds_gzip, is_gzip, read_as};
use super::super::document::not_compressed;
use super::super::error::{FileError, FileErrorKind, Place, Problem};
use super::super::note::Note;
use super::super::surroundings::check_size;
use super::kind::{self, HeightMapKind};
use super::options::HeightMapOptions;
use super::placement::{MapPlacement, spacing_of};
use super::sampled::ReadHeights;
use super::{geo_tiff, hgt, pgm, png, usgs_dem};
use crate::height_grid::HeightGrid;

/// A grid of heights, and where it lies.
///
/// ```
/// use meshweft::files::height_map::{HeightMap, HeightMapOptions};
///
/// let image = b"P2\n# two rows\n3 2\n255\n10 20 30 40 0 60\n";
/// let mut options = HeightMapOptions::default();
/// options.spacing = Some([30.0, 30.0]);
/// options.no_data = Some(0.0);
/// let map = HeightMap::from_bytes("hill.pgm".as_ref(), image, &options)?;
/// assert_eq!(map.grid.size(), [3, 2]);
/// assert_eq!((map.grid.height(2, 1), map.grid.height(1, 1)), (Some(60.0), None));
/// # Ok::<(), meshweft::files::FileError>(())
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct HeightMap {
    /// The heights, in metres.
    pub grid: HeightGrid,
    /// Where the grid lies, where the file says it.
    pub placement: MapPlacement,
    /// What a reader of the file should know: what was assumed, rounded or left out.
    pub notes: Vec<Note>,
    /// The spacing that the caller gave.
    pub(super) given_spacing: Option<[f64; 2]>,
}

impl HeightMap {
    /// Whether a file is one that is read here, or a raster that is refused here with what it is; any other
    /// may be a mesh. Told by its first bytes, then by its name; compressed by gzip or not.
    ///
    /// What cannot be opened is told by its name.
    #[must_use]
    pub fn is_height_map(path: &Path) -> bool {
        kind::is_height_map(path)
    }

    /// Reads a height map; gzip data is decompressed first, whatever the name is.
    ///
    /// # Errors
    /// [`FileError`]: the file cannot be read, is of no known format or not sound, uses what is not supported,
    /// or is over a limit.
    ///
    /// # Complexity
    /// Time O(bytes + samples), also where few bytes stand for many samples. Space: the file and 4 bytes a
    /// sample, not above 64 MiB and 20 times the (decompressed) file.
    pub fn open(path: &Path, options: &HeightMapOptions) -> Result<Self, FileError> {
        let in_file = |kind: FileErrorKind| kind.at(Place::File).in_file(path, None);
        let no_access = |error| in_file(FileErrorKind::Io(error));
        let holds_gzip = holds_gzip(path).map_err(no_access)?;
        if is_gzip(path) && !holds_gzip {
            return Err(in_file(not_compressed()));
        }
        let stored = read_as(path, holds_gzip, &options.limits).map_err(in_file)?;
        Self::from_bytes(path, &stored.bytes, options)
    }

    /// Reads a height map that is in memory already. The bytes are not compressed by gzip; the name is for
    /// errors, and of an SRTM tile it says where the tile lies.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn from_bytes(
        name: &Path,
        bytes: &[u8],
        options: &HeightMapOptions,
    ) -> Result<Self, FileError> {
        let read = Self::read(name, bytes, options);
        read.map_err(|problem| problem.in_file(name, None))
    }

    fn read(name: &Path, bytes: &[u8], options: &HeightMapOptions) -> Result<Self, Problem> {
        let in_file = |kind: FileErrorKind| kind.at(Place::File);
        options.check().map_err(in_file)?;
        check_size(bytes, &options.limits).map_err(in_file)?;

        let kind = HeightMapKind::of(name, bytes).map_err(in_file)?;
        let ReadHeights {
            size,
            heights,
            placement,
            mut notes,
        } = match kind {
            HeightMapKind::Png => png::read(bytes, options),
            HeightMapKind::Pgm => pgm::read(bytes, options),
            HeightMapKind::Tiff => geo_tiff::read(bytes, options),
            HeightMapKind::Srtm => hgt::read(name, bytes, options),
            HeightMapKind::UsgsDem => usgs_dem::read(bytes, options),
        }?;

        let spacing = spacing_of(&placement, size, options.spacing, &mut notes);
        let spacing = spacing.map_err(in_file)?;
        let grid = HeightGrid::new(size, spacing, heights);
        let grid = grid.map_err(|error| in_file(FileErrorKind::malformed(error.to_string())))?;
        Ok(Self {
            grid,
            placement,
            notes,
            given_spacing: options.spacing,
        })
    }
}
