//! The header of a DEM: units, distances, and how many profiles there are.

use super::super::super::error::FileErrorKind;
use super::super::placement::MapPlacement;
use super::fields::{decimal, field_error, whole};

/// Metres of a foot, and of one by the survey.
const FOOT: f64 = 0.3048;
const SURVEY_FOOT: f64 = 1200.0 / 3937.0;

/// What the header says.
pub(super) struct DemHeader {
    /// Planimetric system: 0 degrees, 1 UTM, 2 state plane, others by their codes.
    system: i64,
    zone: i64,
    /// What a unit on the ground is: metres or degrees.
    ground_unit: f64,
    /// Metres of a unit of elevation.
    pub(super) elevation_unit: f64,
    /// Between columns, and between elevations of a profile, in units on the ground.
    pub(super) step: [f64; 2],
    /// Units of elevation of the last digit.
    pub(super) resolution: f64,
    /// How many profiles there are.
    pub(super) profiles: usize,
}

impl DemHeader {
    pub(super) fn read(block: &[u8]) -> Result<Self, FileErrorKind> {
        let number = |from: usize, what: &str| {
            whole(block, from, 6).ok_or_else(|| field_error(block, from, 6, what))
        };
        let real = |from: usize, width: usize, what: &str| {
            let found = decimal(block, from, width).filter(|number| number.is_finite());
            found.ok_or_else(|| field_error(block, from, width, what))
        };

        // Systems and units.
        let system = number(156, "the code of the reference system")?;
        let zone = number(162, "the zone")?;
        let ground_unit = match (number(528, "the unit on the ground")?, system) {
            (1, 0) | (2, 0) | (3, 1..) => {
                let text = "its reference system and its unit on the ground do not fit together";
                return Err(FileErrorKind::malformed(text));
            }
            (1, _) => SURVEY_FOOT,
            (2, _) => 1.0,
            (3, _) => 1.0 / 3600.0,
            (0, _) => {
                let text = "it is in radians, which are not read. Convert it to a GeoTIFF, for example with \
                            gdal_translate";
                return Err(FileErrorKind::unsupported(text));
            }
            (code, _) => return Err(no_unit("on the ground", code)),
        };
        let elevation_unit = match number(534, "the unit of elevation")? {
            1 => FOOT,
            2 => 1.0,
            code => return Err(no_unit("of elevation", code)),
        };

        // Profiles.
        let angle = decimal(block, 786, 24).unwrap_or(0.0);
        if angle != 0.0 {
            let text = "its profiles are turned against the axes of its coordinates, which is not read. Convert it to \
                        a GeoTIFF, for example with gdalwarp";
            return Err(FileErrorKind::unsupported(text));
        }
        let step = [
            real(816, 12, "the distance of profiles")?,
            real(828, 12, "the distance of elevations")?,
        ];
        let resolution = real(840, 12, "the resolution of elevations")?;
        if !step.iter().all(|step| *step > 0.0) || resolution <= 0.0 {
            let text = "its distances or its resolution are not above 0";
            return Err(FileErrorKind::malformed(text));
        }
        let profiles = number(858, "the number of profiles")?;
        let profiles = usize::try_from(profiles).ok().filter(|count| *count > 0);
        let profiles = profiles.ok_or_else(|| FileErrorKind::malformed("it has no profiles"))?;
        Ok(Self {
            system,
            zone,
            ground_unit,
            elevation_unit,
            step,
            resolution,
            profiles,
        })
    }

    /// Where the grid lies whose first sample is here, in units on the ground.
    pub(super) fn placement(&self, first: [f64; 2]) -> MapPlacement {
        let [x, y] = first.map(|it| it * self.ground_unit);
        let step = self.step.map(|it| it * self.ground_unit);
        match self.system {
            0 => MapPlacement::Degrees {
                west: x,
                north: y,
                step,
            },
            system => MapPlacement::Projected {
                easting: x,
                northing: y,
                step,
                system: match system {
                    1 => format!("UTM zone {}", self.zone),
                    2 => format!("state plane zone {}", self.zone),
                    _ => format!("USGS system {system}, zone {}", self.zone),
                },
            },
        }
    }
}

fn no_unit(of: &str, code: i64) -> FileErrorKind {
    FileErrorKind::malformed(format!(
        "the unit {of} has the code {code}, which is not known"
    ))
}
