//! The profiles of a DEM, and the grid that they make.

use std::borrow::Cow;

use super::super::super::error::{FileErrorKind, Place, Problem};
use super::blocks::DemBlocks;
use super::fields::{decimal, field_error, whole};
use super::header::DemHeader;

/// A column of elevations from south to north.
pub(super) struct DemProfile {
    /// Where its first elevation is, in units on the ground.
    start: [f64; 2],
    /// What its elevations are above, in their units.
    pub(super) datum: f64,
    /// As stored: units of the resolution.
    pub(super) elevations: Vec<i32>,
}

/// Elevations in the first block of a profile, and in each further one.
const IN_FIRST: usize = 146;
const IN_FURTHER: usize = 170;
const WIDTH: usize = 6;

/// All profiles that the header promises.
pub(super) fn read(
    blocks: &mut DemBlocks<'_>,
    header: &DemHeader,
) -> Result<Vec<DemProfile>, Problem> {
    let mut profiles = Vec::new();
    for number in 1..=header.profiles {
        let what = || format!("profile {number} of {}", header.profiles);
        let (at, block) = next(blocks, what)?;
        let profile = read_profile(blocks, (at, block), what)?;
        profiles.push(profile);
    }
    Ok(profiles)
}

fn next<'a>(
    blocks: &mut DemBlocks<'a>,
    what: impl Fn() -> String,
) -> Result<(usize, Cow<'a, [u8]>), Problem> {
    let end = Place::Byte(blocks.bytes.len());
    blocks
        .next()
        .ok_or_else(|| FileErrorKind::truncated(what()).at(end))
}

fn read_profile(
    blocks: &mut DemBlocks<'_>,
    (at, block): (usize, Cow<'_, [u8]>),
    what: impl Fn() -> String,
) -> Result<DemProfile, Problem> {
    let number = |from: usize| {
        let found = whole(&block, from, WIDTH).and_then(|number| usize::try_from(number).ok());
        found.ok_or_else(|| field_error(&block, from, WIDTH, &what()).at(Place::Byte(at + from)))
    };
    let real = |from: usize| {
        let found = decimal(&block, from, 24).filter(|number| number.is_finite());
        found.ok_or_else(|| field_error(&block, from, 24, &what()).at(Place::Byte(at + from)))
    };

    // Its own header.
    let (rows, columns) = (number(12)?, number(18)?);
    if columns != 1 {
        let text = format!(
            "{} has {columns} columns: it is one in each profile",
            what()
        );
        return Err(FileErrorKind::malformed(text).at(Place::Byte(at + 18)));
    }
    let start = [real(24)?, real(48)?];
    let datum = real(72)?;

    // Elevations, block by block; they are asked for only as blocks are there.
    let mut elevations = Vec::new();
    let (mut block, mut at) = (block, at);
    let mut fields = (144, IN_FIRST);
    while elevations.len() < rows {
        if fields.1 == 0 {
            (at, block) = next(blocks, &what)?;
            fields = (0, IN_FURTHER);
        }
        for _ in 0..fields.1.min(rows - elevations.len()) {
            let (from, left) = fields;
            let elevation = whole(&block, from, WIDTH).and_then(|it| i32::try_from(it).ok());
            let Some(elevation) = elevation else {
                // A last block that is cut is filled with blanks.
                let is_cut = at + from + WIDTH > blocks.bytes.len();
                let kind = match is_cut {
                    true => FileErrorKind::truncated(what()),
                    false => field_error(&block, from, WIDTH, &what()),
                };
                return Err(kind.at(Place::Byte((at + from).min(blocks.bytes.len()))));
            };
            elevations.push(elevation);
            fields = (from + WIDTH, left - 1);
        }
    }
    Ok(DemProfile {
        start,
        datum,
        elevations,
    })
}

/// The grid that holds all profiles.
pub(super) struct DemArea {
    /// Of its south-western sample, in units on the ground.
    pub(super) start: [f64; 2],
    pub(super) size: [u64; 2],
}

/// The smallest grid that holds all elevations of the profiles.
pub(super) fn area(profiles: &[DemProfile], step: [f64; 2]) -> Result<DemArea, FileErrorKind> {
    // Where profiles may begin off the lattice, by this part of a step.
    const TOLERANCE: f64 = 0.05;
    let filled = profiles
        .iter()
        .filter(|profile| !profile.elevations.is_empty());
    let mut start = [f64::INFINITY; 2];
    for profile in filled.clone() {
        start = [0, 1].map(|axis| start[axis].min(profile.start[axis]));
    }
    let mut size = [0_u64; 2];
    for profile in filled {
        let steps = [0, 1].map(|axis| (profile.start[axis] - start[axis]) / step[axis]);
        let is_off = |steps: &f64| (steps - steps.round()).abs() > TOLERANCE;
        if steps.iter().any(is_off) {
            let [x, y] = profile.start;
            return Err(FileErrorKind::malformed(format!(
                "the profile at {x}, {y} is not whole steps of {} by {} away from the others",
                step[0], step[1]
            )));
        }
        let end = steps.map(steps_of);
        size[0] = size[0].max(end[0].saturating_add(1));
        size[1] = size[1].max(end[1].saturating_add(profile.elevations.len() as u64));
    }
    Ok(DemArea { start, size })
}

impl DemArea {
    /// Column of a profile, and the row of its first elevation from the south; both are in the area.
    pub(super) fn place_of(&self, profile: &DemProfile, step: [f64; 2]) -> [u32; 2] {
        [0, 1].map(|axis| {
            let steps = (profile.start[axis] - self.start[axis]) / step[axis];
            u32::try_from(steps_of(steps)).expect("the size was checked")
        })
    }
}

/// The nearest whole number, from 0 on.
#[expect(
    clippy::cast_possible_truncation,
    reason = "too large a number becomes the largest, and is refused as a size"
)]
fn steps_of(steps: f64) -> u64 {
    steps.round() as u64
}
