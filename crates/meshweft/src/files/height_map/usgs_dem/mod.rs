//! USGS DEM: elevation models as text, in profiles from south to north.
//!
//! U.S. Geological Survey, *Standards for Digital Elevation Models*, part 2 (1997). A file is a header and a
//! profile for each column, in blocks of 1,024 characters with fields at fixed columns. A model of a map sheet is
//! cut by meridians and parallels, and lies aslant in its projected metres: so profiles begin at
//! different latitudes and have different lengths, and what they leave free of the grid is void.

use std::borrow::Cow;

use super::super::error::{FileErrorKind, Place, Problem};
use super::super::text::{is_line_end, line_end};
use super::HeightMapOptions;
use super::placement::MapPlacement;
use super::sampled::{HeightRule, ReadHeights, checked_size};
use fields::{decimal, text_of, whole};
use profiles::DemProfile;

mod fields;
mod profiles;

/// Characters of a block.
const BLOCK: usize = 1024;
/// As many bytes tell whether a file is a DEM.
pub(super) const HEADER: u64 = BLOCK as u64;

/// What stands for no elevation, by the standard and by what writers use.
const VOIDS: [f64; 2] = [-32_767.0, -32_768.0];

/// Metres of a foot, and of one by the survey.
const FOOT: f64 = 0.3048;
const SURVEY_FOOT: f64 = 1200.0 / 3937.0;

/// Whether this is the start of a DEM: numbers where its header has them.
pub(super) fn is_dem(bytes: &[u8]) -> bool {
    let Some(start) = bytes.get(..864) else {
        return false;
    };
    let is = |from: usize, allowed: std::ops::RangeInclusive<i64>| {
        whole(start, from, 6).is_some_and(|number| allowed.contains(&number))
    };
    let is_text = start
        .iter()
        .all(|byte| byte.is_ascii_graphic() || *byte == b' ');
    is_text
        && is(144, 1..=4)
        && is(150, 1..=2)
        && is(528, 0..=3)
        && is(534, 1..=2)
        && is(540, 4..=4)
}

pub(super) fn read(bytes: &[u8], options: &HeightMapOptions) -> Result<ReadHeights, Problem> {
    let mut blocks = DemBlocks::of(bytes);
    let Some((at, block)) = blocks.next() else {
        return Err(FileErrorKind::truncated("the header").at(Place::File));
    };
    let header = DemHeader::read(&block).map_err(|kind| kind.at(Place::Byte(at)))?;

    // Profiles as they come; where they lie says how large the grid is.
    let profiles = profiles::read(&mut blocks, &header)?;
    let area = profiles::area(&profiles, header.step).map_err(|kind| kind.at(Place::File))?;
    let size = checked_size(area.size, bytes.len(), options);
    let size = size.map_err(|kind| kind.at(Place::File))?;

    let mut rule = HeightRule::new(options, header.elevation_unit, &[]);
    let mut heights = vec![f32::NAN; size[0] as usize * size[1] as usize];
    for profile in profiles.iter().filter(|it| !it.elevations.is_empty()) {
        let [column, row] = area.place_of(profile, header.step);
        put(
            profile,
            [column, row],
            &mut rule,
            &header,
            size,
            &mut heights,
        );
    }

    let first = [
        area.start[0],
        area.start[1] + header.step[1] * f64::from(size[1] - 1),
    ];
    Ok(ReadHeights {
        size,
        heights,
        placement: header.placement(first),
        notes: rule.notes(),
    })
}

/// Puts a profile into the grid; its first elevation comes at this place, counted from the south.
fn put(
    profile: &DemProfile,
    [column, from_south]: [u32; 2],
    rule: &mut HeightRule,
    header: &DemHeader,
    [columns, rows]: [u32; 2],
    heights: &mut [f32],
) {
    for (up, &elevation) in (from_south as usize..).zip(&profile.elevations) {
        let row = rows as usize - 1 - up;
        let stored = f64::from(elevation);
        let height = match VOIDS.contains(&stored) || rule.is_no_data(stored) {
            true => f32::NAN,
            false => rule.metres(stored * header.resolution + profile.datum),
        };
        heights[row * columns as usize + column as usize] = height;
    }
}

/// What the header says.
pub(super) struct DemHeader {
    /// Planimetric system: 0 degrees, 1 UTM, 2 state plane, others by their codes.
    system: i64,
    zone: i64,
    /// What a unit on the ground is: metres or degrees.
    ground_unit: f64,
    /// Metres of a unit of elevation.
    elevation_unit: f64,
    /// Between columns, and between elevations of a profile, in units on the ground.
    step: [f64; 2],
    /// Units of elevation of the last digit.
    resolution: f64,
    /// How many profiles there are.
    profiles: usize,
}

impl DemHeader {
    fn read(block: &[u8]) -> Result<Self, FileErrorKind> {
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
    fn placement(&self, first: [f64; 2]) -> MapPlacement {
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

fn field_error(block: &[u8], from: usize, width: usize, what: &str) -> FileErrorKind {
    let found = super::super::text::shown(text_of(block, from, width));
    FileErrorKind::malformed(format!("{found} where a number was expected: {what}"))
}

/// The blocks of a file, filled up with blanks: 1,024 characters each, or a line each where there are lines.
pub(super) struct DemBlocks<'a> {
    bytes: &'a [u8],
    at: usize,
    has_lines: bool,
}

impl<'a> DemBlocks<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        let start = &bytes[..bytes.len().min(BLOCK + 2)];
        Self {
            bytes,
            at: 0,
            has_lines: start.iter().any(|byte| is_line_end(*byte)),
        }
    }
}

impl<'a> Iterator for DemBlocks<'a> {
    type Item = (usize, Cow<'a, [u8]>);

    fn next(&mut self) -> Option<Self::Item> {
        let start = self.at;
        if start >= self.bytes.len() {
            return None;
        }
        let end = match self.has_lines {
            true => line_end(self.bytes, start),
            false => (start + BLOCK).min(self.bytes.len()),
        };
        self.at = end;
        if self.has_lines {
            let rest = &self.bytes[end..];
            self.at += if rest.starts_with(b"\r\n") { 2 } else { 1 };
        }
        let block = &self.bytes[start..end];
        Some((
            start,
            match block.len() < BLOCK {
                true => {
                    let mut filled = block.to_vec();
                    filled.resize(BLOCK, b' ');
                    Cow::Owned(filled)
                }
                false => Cow::Borrowed(block),
            },
        ))
    }
}
