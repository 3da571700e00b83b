//! Which format a height map is of, by its first bytes and then its name.

use std::path::Path;

use super::super::disk::{holds_gzip, read_start_as};
use super::super::error::FileErrorKind;
use super::super::format::ending;
use super::{hgt, usgs_dem};
use crate::limits::Limits;

/// A format of height maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum HeightMapKind {
    Png,
    Pgm,
    Tiff,
    Srtm,
    UsgsDem,
}

/// What names of height maps end with.
const ENDINGS: [(&str, Option<HeightMapKind>); 6] = [
    ("hgt", Some(HeightMapKind::Srtm)),
    ("dem", Some(HeightMapKind::UsgsDem)),
    ("png", None),
    ("pgm", None),
    ("tif", None),
    ("tiff", None),
];

/// First bytes of rasters that are not read, what they are, and what to do.
const RASTERS: [(&[u8], &str, &str); 9] = [
    (
        b"\xff\xd8\xff",
        "a JPEG image",
        "Its heights would be inexact: take a PNG or a GeoTIFF",
    ),
    (b"GIF8", "a GIF image", CONVERT),
    (b"RIFF", "a RIFF file, such as a WebP image", CONVERT),
    (b"\0\0\0\x0cjP  ", "a JPEG 2000 image", CONVERT),
    (b"\x89HDF", "an HDF5 or netCDF file", CONVERT),
    (b"CDF\x01", "a netCDF file", CONVERT),
    (b"CDF\x02", "a netCDF file", CONVERT),
    (b"DSAA", "a Surfer grid", CONVERT),
    (b"DSBB", "a Surfer grid", CONVERT),
];
/// First bytes of archives, which may hold anything.
const ARCHIVES: [(&[u8], &str, &str); 5] = [
    (b"PK\x03\x04", "a ZIP archive", UNPACK),
    (b"\x1f\x8b", "gzip data", UNPACK),
    (b"BZh", "bzip2 data", UNPACK),
    (b"\xfd7zXZ", "xz data", UNPACK),
    (b"\x28\xb5\x2f\xfd", "zstd data", UNPACK),
];
const CONVERT: &str = "Convert it to a GeoTIFF, for example with gdal_translate";
const UNPACK: &str = "Unpack it first";

impl HeightMapKind {
    /// The format of these bytes.
    ///
    /// # Errors
    /// It is something else, which is named where it is known.
    pub(super) fn of(name: &Path, bytes: &[u8]) -> Result<Self, FileErrorKind> {
        let named = of_name(name).flatten();
        // An SRTM tile may start with the bytes of anything: those of a JPEG are heights below the sea.
        if named == Some(Self::Srtm) && hgt::side_of(bytes).is_some() {
            return Ok(Self::Srtm);
        }
        if let Some(found) = of_content(bytes) {
            return found;
        }
        let archive = ARCHIVES.iter().find(|(start, ..)| bytes.starts_with(start));
        match archive {
            Some((_, what, advice)) => Err(refusal(what, advice)),
            None => named.ok_or_else(unknown),
        }
    }
}

fn unknown() -> FileErrorKind {
    FileErrorKind::unsupported(
        "neither the name nor the first bytes are of a height map: PNG, PGM, GeoTIFF, SRTM (.hgt) or USGS DEM (.dem), \
         optionally compressed by gzip",
    )
}

fn refusal(what: &str, advice: &str) -> FileErrorKind {
    FileErrorKind::unsupported(format!(
        "this is {what}, which is not read as heights. {advice}"
    ))
}

/// The format that bytes are surely of, or what is wrong with taking them for one.
fn of_content(bytes: &[u8]) -> Option<Result<HeightMapKind, FileErrorKind>> {
    let refused = |what: &str, advice: &str| Some(Err(refusal(what, advice)));
    let is_blank_at = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_whitespace);
    match bytes {
        [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => {
            return Some(Ok(HeightMapKind::Tiff));
        }
        [0x89, b'P', b'N', b'G', ..] => return Some(Ok(HeightMapKind::Png)),
        [b'P', b'2' | b'5', b'#', ..] => return Some(Ok(HeightMapKind::Pgm)),
        [b'P', b'2' | b'5', ..] if is_blank_at(2) => return Some(Ok(HeightMapKind::Pgm)),
        [b'P', b'1' | b'4', ..] if is_blank_at(2) => {
            return refused("a bitmap of black and white", "Take a PGM of 8 or 16 bits");
        }
        [b'P', b'3' | b'6' | b'7', ..] if is_blank_at(2) => {
            return refused(
                "a colour image",
                "Save it as greyscale, as a PGM of 8 or 16 bits",
            );
        }
        [b'P', b'f' | b'F', ..] if is_blank_at(2) => return refused("a PFM image", CONVERT),
        _ => {}
    }
    if is_ascii_grid(bytes) {
        return refused("an Arc/Info ASCII grid", CONVERT);
    }
    if let Some((_, what, advice)) = RASTERS.iter().find(|(start, ..)| bytes.starts_with(start)) {
        return refused(what, advice);
    }
    usgs_dem::is_dem(bytes).then_some(Ok(HeightMapKind::UsgsDem))
}

/// Whether its first word is that of an ASCII grid.
fn is_ascii_grid(bytes: &[u8]) -> bool {
    let text = bytes.trim_ascii_start();
    let word = text.get(..5).unwrap_or(&[]);
    word.eq_ignore_ascii_case(b"ncols") || word.eq_ignore_ascii_case(b"nrows")
}

/// Whether a name is one of a height map, and of which format, where it takes no more than the name.
fn of_name(name: &Path) -> Option<Option<HeightMapKind>> {
    let ending = ending(name)?;
    let found = ENDINGS.iter().find(|(known, _)| *known == ending);
    found.map(|(_, kind)| *kind)
}

pub(super) fn is_height_map(path: &Path) -> bool {
    if of_name(path).is_some() {
        return true;
    }
    let start = holds_gzip(path).ok().and_then(|is_gzip| {
        let start = read_start_as(path, is_gzip, &Limits::default(), |_| usgs_dem::HEADER);
        start.ok()
    });
    start.and_then(|start| of_content(&start)).is_some()
}
