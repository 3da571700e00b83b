//! SRTM tiles, `.hgt`: big-endian 16-bit samples of a square degree, nothing else.
//!
//! The length says how many samples there are, the name where the south-western corner is: `N47W123.hgt`.
//! Rows run from north to south, and the outer ones lie on whole degrees, so that neighbours share them.
//! -32,768 is void.

use std::path::Path;

use super::super::error::{FileErrorKind, Place, Problem};
use super::options::HeightMapOptions;
use super::placement::MapPlacement;
use super::sampled::{HeightRule, ReadHeights, checked_size};

const VOID: f64 = -32_768.0;

pub(super) fn read(
    name: &Path,
    bytes: &[u8],
    options: &HeightMapOptions,
) -> Result<ReadHeights, Problem> {
    let in_file = |kind: FileErrorKind| kind.at(Place::File);
    let Some(side) = side_of(bytes) else {
        let text = format!(
            "{} bytes are no square of 16-bit samples: an SRTM tile of three arc seconds has 2884802, one of one \
             second 25934402. Fetch it again, it may be incomplete",
            bytes.len()
        );
        return Err(in_file(FileErrorKind::unsupported(text)));
    };
    let size = checked_size([side as u64; 2], bytes.len(), options).map_err(in_file)?;

    let placement = match south_west(name) {
        Some([south, west]) => MapPlacement::Degrees {
            west,
            north: south + 1.0,
            step: [1.0 / f64::from(size[0] - 1); 2],
        },
        None if options.spacing.is_some() => MapPlacement::Unknown,
        None => {
            let text = "its name does not say where it lies: call it as N47W123.hgt, by its south-western corner, or \
                        give a spacing";
            return Err(in_file(FileErrorKind::unsupported(text)));
        }
    };

    let mut rule = HeightRule::new(options, 1.0, &[VOID]);
    let samples = bytes.as_chunks::<2>().0.iter();
    let heights = samples.map(|&sample| rule.height(f64::from(i16::from_be_bytes(sample))));
    Ok(ReadHeights {
        size,
        heights: heights.collect(),
        placement,
        notes: rule.notes(),
    })
}

/// How many columns and rows these bytes are, if they are a square.
pub(super) fn side_of(bytes: &[u8]) -> Option<usize> {
    let side = (bytes.len() / 2).isqrt();
    (side * side * 2 == bytes.len()).then_some(side)
}

/// Latitude and longitude of the south-western corner that a name says.
fn south_west(name: &Path) -> Option<[f64; 2]> {
    let name = name.file_name()?.to_str()?.to_ascii_uppercase();
    let whole = |range: std::ops::Range<usize>| {
        let digits = name.get(range)?;
        let is_number = digits.bytes().all(|byte| byte.is_ascii_digit());
        is_number
            .then(|| digits.parse::<i16>().ok())?
            .map(f64::from)
    };
    let sign = |at: usize, plus: &str, minus: &str| match name.get(at..=at)? {
        letter if letter == plus => Some(1.0),
        letter if letter == minus => Some(-1.0),
        _ => None,
    };
    let south = sign(0, "N", "S")? * whole(1..3)?;
    let west = sign(3, "E", "W")? * whole(4..7)?;
    let ends = name
        .as_bytes()
        .get(7)
        .is_none_or(|byte| !byte.is_ascii_digit());
    let is_on_earth = (-90.0..90.0).contains(&south) && (-180.0..=180.0).contains(&west);
    (ends && is_on_earth).then_some([south, west])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_says_the_south_western_corner() {
        for (name, expected) in [
            ("N47W123.hgt", Some([47.0, -123.0])),
            ("a/s01e009.SRTMGL1.hgt.gz", Some([-1.0, 9.0])),
            ("N00E000", Some([0.0, 0.0])),
            ("N47W1234.hgt", None),
            ("N90E000.hgt", None),
            ("N4+W123.hgt", None),
            ("tile.hgt", None),
            ("", None),
        ] {
            assert_eq!(south_west(Path::new(name)), expected, "{name}");
        }
    }
}
