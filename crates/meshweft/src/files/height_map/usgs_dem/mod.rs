//! USGS DEM: elevation models as text, in profiles from south to north.
//!
//! U.S. Geological Survey, *Standards for Digital Elevation Models*, part 2 (1997). A file is a header and a
//! profile for each column, in blocks of 1,024 characters with fields at fixed columns. A model of a map sheet is
//! cut by meridians and parallels, and lies aslant in its projected metres: so profiles begin at
//! different latitudes and have different lengths, and what they leave free of the grid is void.

use super::super::error::{FileErrorKind, Place, Problem};
use super::options::HeightMapOptions;
use super::sampled::{HeightRule, ReadHeights, checked_size};
use blocks::DemBlocks;
use fields::whole;
use header::DemHeader;
use profiles::DemProfile;

mod blocks;
mod fields;
mod header;
mod profiles;

/// As many bytes tell whether a file is a DEM.
pub(super) const HEADER: u64 = 1024;

/// What stands for no elevation, by the standard and by what writers use.
const VOIDS: [f64; 2] = [-32_767.0, -32_768.0];

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
