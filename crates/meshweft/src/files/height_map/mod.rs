//! Height maps: grids of heights from images, elevation models and georeferenced rasters.
//!
//! All become a [`HeightGrid`] in metres, with rows from north to south, and the place where it lies. What a
//! file says of its units, its scale and the value that stands for *no height* is followed; what is not
//! supported is refused, with what to do instead. Nothing is written.
//!
//! | format | what is read |
//! |---|---|
//! | PNG | greyscale of 8 or 16 bits; what is transparent is void |
//! | PGM | `P2` and `P5`, 8 or 16 bits |
//! | SRTM | `.hgt`, any square; its name says where it lies |
//! | USGS DEM | text, profiles of any lengths |
//!
//! Degrees become metres by the radii of curvature of the ellipsoid at the middle latitude, so a
//! large grid of degrees is true to scale there and less so at its northern and southern ends.

use std::path::Path;

use super::disk::{holds_gzip, is_gzip, read_as};
use super::document::not_compressed;
use super::error::{FileError, FileErrorKind, Place, Problem};
use super::note::Note;
use super::surroundings::check_size;
use crate::height_grid::HeightGrid;
use crate::limits::Limits;
use kind::HeightMapKind;
use placement::spacing_of;
use sampled::ReadHeights;

mod hgt;
mod kind;
mod pgm;
mod placement;
mod png;
mod sampled;
mod usgs_dem;

pub use placement::MapPlacement;

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
}

/// How a height map is read.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct HeightMapOptions {
    /// How much is accepted; `vertices` limits samples.
    pub limits: Limits,
    /// How far columns and rows are apart, in metres, whatever the file says. Without it, the samples of a file
    /// that does not say it are one metre apart.
    pub spacing: Option<[f64; 2]>,
    /// What heights are multiplied with, after the units of the file have become metres.
    pub height_scale: Option<f64>,
    /// A value of samples, as stored, that stands for no height; beside the one that the file names.
    pub no_data: Option<f64>,
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
        })
    }
}

impl HeightMapOptions {
    /// Refuses numbers that no grid can have.
    fn check(&self) -> Result<(), FileErrorKind> {
        let is_distance = |it: &f64| *it > 0.0 && it.is_finite();
        if let Some(spacing) = self.spacing
            && !spacing.iter().all(is_distance)
        {
            let [x, z] = spacing;
            return Err(FileErrorKind::unsupported(format!(
                "columns {x} and rows {z} metres apart were asked for: give finite distances above 0"
            )));
        }
        match self.height_scale {
            Some(scale) if scale == 0.0 || !scale.is_finite() => Err(FileErrorKind::unsupported(
                format!("heights times {scale} were asked for: give a finite factor that is not 0"),
            )),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
