//! Height maps: grids of heights from images, elevation models and georeferenced rasters.
//!
//! All become a [`HeightGrid`](crate::HeightGrid) in metres, with rows from north to south, and the place where it lies. What a
//! file says of its units, its scale and the value that stands for *no height* is followed; what is not
//! supported is refused, with what to do instead. Nothing is written.
//!
//! | format | what is read |
//! |---|---|
//! | PNG | greyscale of 8 or 16 bits; what is transparent is void |
//! | PGM | `P2` and `P5`, 8 or 16 bits |
//! | GeoTIFF | one band of integers or floats, strips or tiles; plain, deflate, LZW, PackBits |
//! | SRTM | `.hgt`, any square; its name says where it lies |
//! | USGS DEM | text, profiles of any lengths |
//!
//! Degrees become metres by the radii of curvature of the ellipsoid at the middle latitude, so a
//! large grid of degrees is true to scale there and less so at its northern and southern ends.

mod geo_tiff;
mod hgt;
mod join;
mod kind;
mod map;
mod options;
mod pgm;
mod placement;
mod png;
mod sampled;
#[cfg(test)]
mod tests;
mod usgs_dem;

pub use join::{JoinError, JoinedMap};
pub use map::HeightMap;
pub use options::HeightMapOptions;
pub use placement::MapPlacement;
