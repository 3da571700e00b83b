//! Where a grid lies, and what a degree is in metres.

use super::super::error::{FileErrorKind, Place};
use super::super::note::Note;

/// Where the samples of a height map lie.
///
/// The sample of column c and row r is c steps east and r steps south of the first one.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum MapPlacement {
    /// The file does not say it.
    Unknown,
    /// Longitudes and latitudes.
    #[non_exhaustive]
    Degrees {
        /// Longitude of the first column.
        west: f64,
        /// Latitude of the first row.
        north: f64,
        /// Degrees from column to column and from row to row.
        step: [f64; 2],
    },
    /// A map projection, in metres.
    #[non_exhaustive]
    Projected {
        /// Of the first column.
        easting: f64,
        /// Of the first row.
        northing: f64,
        /// Metres from column to column and from row to row.
        step: [f64; 2],
        /// What the file says of the projection, such as `UTM zone 10`; empty if nothing.
        system: String,
    },
}

/// How far columns and rows are apart in metres, by the caller's word or else the file's.
pub(super) fn spacing_of(
    placement: &MapPlacement,
    size: [u32; 2],
    asked: Option<[f64; 2]>,
    notes: &mut Vec<Note>,
) -> Result<[f64; 2], FileErrorKind> {
    let own = match placement {
        MapPlacement::Unknown => None,
        MapPlacement::Degrees { north, step, .. } => {
            let middle = north - 0.5 * step[1] * f64::from(size[1] - 1);
            let south = north - step[1] * f64::from(size[1] - 1);
            // Whole pixels may reach over a pole by half a step.
            if !(-90.0..=90.0).contains(&middle) || *north > 91.0 || south < -91.0 {
                return Err(FileErrorKind::malformed(format!(
                    "its latitudes reach from {south} to {north}: they end at 90 degrees"
                )));
            }
            let east = step[0] * f64::from(size[0] - 1);
            if east > 361.0 {
                return Err(FileErrorKind::malformed(format!(
                    "its longitudes reach over {east} degrees: all are 360"
                )));
            }
            let metres = metres_per_degree(middle);
            Some([step[0] * metres[0], step[1] * metres[1]])
        }
        MapPlacement::Projected { step, .. } => Some(*step),
    };
    match (own, asked) {
        (Some(own), None) => Ok(own),
        (Some([x, z]), Some(asked)) => {
            let text = format!(
                "its samples are {x:.3} by {z:.3} metres apart by what the file says; the spacing that was given is \
                 taken"
            );
            notes.push(Note::new(Place::File, text));
            Ok(asked)
        }
        (None, Some(asked)) => Ok(asked),
        (None, None) => {
            let text =
                "it does not say how far samples are apart: one metre is assumed, give a spacing";
            notes.push(Note::new(Place::File, text));
            Ok([1.0, 1.0])
        }
    }
}

/// Metres a degree of longitude and one of latitude take at a latitude in degrees, on the ellipsoid of WGS 84.
pub(super) fn metres_per_degree(latitude: f64) -> [f64; 2] {
    const MAJOR: f64 = 6_378_137.0;
    const FLATTENING: f64 = 1.0 / 298.257_223_563;
    let eccentricity = FLATTENING * (2.0 - FLATTENING);
    let degree = std::f64::consts::PI / 180.0;

    let sine = sine(latitude.abs() * degree);
    let cosine = self::sine((90.0 - latitude.abs()) * degree);
    let w = (1.0 - eccentricity * sine * sine).sqrt();
    let prime_vertical = MAJOR / w;
    let meridian = MAJOR * (1.0 - eccentricity) / (w * w * w);
    [prime_vertical * cosine * degree, meridian * degree]
}

/// The sine of an angle from 0 to a right one. Only with operations that give the same bits on all platforms.
fn sine(angle: f64) -> f64 {
    let square = angle * angle;
    // Innermost last: x (1 - x²/(2·3) (1 - x²/(4·5) (…))); the first term left out is below 1e-22.
    let series = (1..=13).rev().fold(1.0, |inner, i| {
        let i = 2.0 * f64::from(i);
        1.0 - square / (i * (i + 1.0)) * inner
    });
    angle * series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_degree_is_as_long_as_tables_say() {
        // NGA's figures of WGS 84, to the centimetre.
        for (latitude, longitude_metres, latitude_metres) in [
            (0.0, 111_319.49, 110_574.28),
            (45.0, 78_846.81, 111_131.78),
            (-60.0, 55_799.98, 111_412.27),
            (90.0, 0.0, 111_693.86),
        ] {
            let [x, z] = metres_per_degree(latitude);
            assert!((x - longitude_metres).abs() < 0.3, "{latitude}: {x}");
            assert!((z - latitude_metres).abs() < 0.3, "{latitude}: {z}");
        }
    }

    #[test]
    fn a_sine_is_one() {
        for tenth in 0..=900 {
            let angle = f64::from(tenth) * std::f64::consts::PI / 1800.0;
            assert!((sine(angle) - angle.sin()).abs() < 4e-16, "{tenth}");
        }
    }
}
