//! Where the raster of a GeoTIFF lies, and what its units are.

use super::super::super::error::{FileErrorKind, Place, Problem};
use super::super::super::note::Note;
use super::super::placement::MapPlacement;
use super::directory::TiffDirectory;
use super::tag;

/// What the keys of a file say.
pub(super) struct TiffGround {
    pub(super) placement: MapPlacement,
    /// Metres of a unit of height.
    pub(super) height_unit: f64,
    /// Whether the first row is the southern one.
    pub(super) is_upwards: bool,
    pub(super) notes: Vec<Note>,
}

/// Keys that are read.
const MODEL: u16 = 1024;
const RASTER: u16 = 1025;
const ANGULAR_UNIT: u16 = 2054;
const PROJECTION: u16 = 3072;
const LINEAR_UNIT: u16 = 3076;
const LINEAR_UNIT_SIZE: u16 = 3077;
const VERTICAL_UNIT: u16 = 4099;

/// What stands in a key for a thing that the file defines itself.
const OWN: u64 = 32_767;

pub(super) fn of(directory: &TiffDirectory<'_>, size: [u32; 2]) -> Result<TiffGround, Problem> {
    let keys = GeoKeys { directory };
    let mut notes = Vec::new();
    let height_unit = match keys.number(VERTICAL_UNIT)? {
        None | Some(OWN) => 1.0,
        Some(code) => metres_of(code).ok_or_else(|| unit_error("heights", code))?,
    };

    // From columns and rows to the ground: origin and step, by either of two tags.
    let Some(PixelLattice { corner, step }) = transformation(directory)? else {
        return Ok(TiffGround {
            placement: MapPlacement::Unknown,
            height_unit,
            is_upwards: false,
            notes,
        });
    };
    let ([x, y], [step_x, step_y]) = (corner, step);
    let is_point = keys.number(RASTER)? == Some(2);
    let shift = if is_point { 0.0 } else { 0.5 };
    let is_upwards = step_y > 0.0;
    let last = f64::from(size[1] - 1);
    let north = y + step_y * (shift + if is_upwards { last } else { 0.0 });
    let (west, step) = (x + step_x * shift, [step_x, step_y.abs()]);
    if !(west.is_finite() && north.is_finite()) {
        let text = "the place of its first sample is not finite";
        return Err(FileErrorKind::malformed(text).at(Place::File));
    }

    let placement = match keys.number(MODEL)? {
        Some(2) => {
            let unit = keys.number(ANGULAR_UNIT)?.unwrap_or(9102);
            // Degrees under three codes.
            if !matches!(unit, 9102 | 9122 | OWN) {
                return Err(unit_error("angles", unit));
            }
            MapPlacement::Degrees { west, north, step }
        }
        Some(3) => {
            let text = "its coordinates are geocentric, and heights are read over a plane or an ellipsoid. Convert it, \
                        for example with gdalwarp";
            return Err(FileErrorKind::unsupported(text).at(Place::File));
        }
        model => {
            if model != Some(1) {
                let text = "it does not say what its coordinates are: metres are assumed";
                notes.push(Note::new(Place::File, text));
            }
            let unit = linear_unit(&keys)?;
            MapPlacement::Projected {
                easting: west * unit,
                northing: north * unit,
                step: step.map(|step| step * unit),
                system: match keys.number(PROJECTION)? {
                    Some(code) if code != OWN => system(code),
                    _ => String::new(),
                },
            }
        }
    };
    Ok(TiffGround {
        placement,
        height_unit,
        is_upwards,
        notes,
    })
}

/// Where pixels lie.
struct PixelLattice {
    /// The outer corner of the first one.
    corner: [f64; 2],
    /// To the next column and row, to the east and to the north.
    step: [f64; 2],
}

/// Where pixels lie, if the file says it.
fn transformation(directory: &TiffDirectory<'_>) -> Result<Option<PixelLattice>, Problem> {
    let refused = |text: &str| Err(FileErrorKind::unsupported(text).at(Place::File));
    let scale = directory.reals::<2>(tag::PIXEL_SCALE)?;
    let tie_point = directory.reals::<6>(tag::TIE_POINTS)?;
    let matrix = directory.reals::<16>(tag::TRANSFORMATION)?;
    let (corner, step) = match (scale, tie_point, matrix) {
        (Some([x, y]), Some([column, row, _, east, north, _]), _) => {
            ([east - column * x, north + row * y], [x, -y])
        }
        (_, _, Some(matrix)) => {
            if matrix[1] != 0.0 || matrix[4] != 0.0 {
                return refused(
                    "its raster is turned against the axes of its coordinates, which is not read. Turn it straight, for \
                     example with gdalwarp",
                );
            }
            ([matrix[3], matrix[7]], [matrix[0], matrix[5]])
        }
        (None, Some(_), None) if directory.count(tag::TIE_POINTS) > 6 => {
            return refused(
                "it is tied to the ground by points alone, which is not read. Warp it, for example with gdalwarp",
            );
        }
        _ => return Ok(None),
    };
    if !step[0].is_finite() || !step[1].is_finite() || step[0] <= 0.0 || step[1] == 0.0 {
        return refused(
            "its columns do not run from west to east, or have no distance. Warp it, for example with gdalwarp",
        );
    }
    Ok(Some(PixelLattice { corner, step }))
}

/// Metres of a unit on the ground.
fn linear_unit(keys: &GeoKeys<'_>) -> Result<f64, Problem> {
    match keys.number(LINEAR_UNIT)? {
        None => Ok(1.0),
        Some(OWN) => {
            let size = keys.real(LINEAR_UNIT_SIZE)?.unwrap_or(1.0);
            match size > 0.0 && size.is_finite() {
                true => Ok(size),
                false => Err(unit_error("distances", OWN)),
            }
        }
        Some(code) => metres_of(code).ok_or_else(|| unit_error("distances", code)),
    }
}

/// Metres of a unit, by the code of the EPSG.
fn metres_of(code: u64) -> Option<f64> {
    match code {
        9001 => Some(1.0),
        9002 => Some(0.3048),
        9003 => Some(1200.0 / 3937.0),
        9036 => Some(1000.0),
        _ => None,
    }
}

fn unit_error(of: &str, code: u64) -> Problem {
    let text = format!(
        "its unit of {of} has the code {code}, which is not read. Convert it to metres or degrees, for example with \
         gdalwarp"
    );
    FileErrorKind::unsupported(text).at(Place::File)
}

/// What a code of the EPSG is called; zones of UTM are named as other formats name them.
fn system(code: u64) -> String {
    match code {
        // Of WGS 84, NAD83, NAD27 and ETRS89.
        32_601..=32_660 | 26_901..=26_923 | 26_701..=26_722 | 25_828..=25_838 => {
            format!("UTM zone {}", code % 100)
        }
        32_701..=32_760 => format!("UTM zone {} south", code % 100),
        _ => format!("EPSG:{code}"),
    }
}

/// The keys of a file: rows of four numbers after a first one.
struct GeoKeys<'a> {
    directory: &'a TiffDirectory<'a>,
}

impl GeoKeys<'_> {
    /// Where the value of a key is (0: it is the last number itself, else a tag), and that number.
    fn entry(&self, key: u16) -> Result<Option<(u64, u64)>, Problem> {
        let number = |index: u64| self.directory.nth(tag::GEO_KEYS, index);
        let count = number(3)?
            .unwrap_or(0)
            .min(self.directory.count(tag::GEO_KEYS) / 4);
        for row in 1..=count {
            if number(4 * row)? == Some(u64::from(key)) {
                let place = number(4 * row + 1)?;
                return Ok(place.zip(number(4 * row + 3)?));
            }
        }
        Ok(None)
    }

    fn number(&self, key: u16) -> Result<Option<u64>, Problem> {
        let entry = self.entry(key)?;
        Ok(entry
            .filter(|(place, _)| *place == 0)
            .map(|(_, value)| value))
    }

    fn real(&self, key: u16) -> Result<Option<f64>, Problem> {
        match self.entry(key)? {
            Some((place, index)) if place == u64::from(tag::GEO_NUMBERS) => {
                self.directory.real(tag::GEO_NUMBERS, index)
            }
            _ => Ok(None),
        }
    }
}
