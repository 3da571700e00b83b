//! How the samples of a TIFF are stored: their type, their compression, strips or tiles.

use super::super::super::error::{FileErrorKind, Place, Problem};
use super::directory::TiffDirectory;
use super::tag;

/// The type of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SampleKind {
    Unsigned,
    Signed,
    Float,
}

/// What the bytes of a strip or tile went through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TiffCompression {
    Plain,
    Deflate,
    Lzw,
    PackBits,
}

/// What was taken off samples before they were compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SamplePredictor {
    Nothing,
    /// The sample to the left.
    Left,
    /// The same of bytes, which are sorted by their place in the sample.
    LeftOfBytes,
}

pub(super) struct TiffLayout {
    pub(super) size: [u32; 2],
    pub(super) kind: SampleKind,
    /// Bytes of a sample.
    pub(super) width: usize,
    pub(super) compression: TiffCompression,
    pub(super) predictor: SamplePredictor,
    /// Columns and rows of a strip or tile.
    pub(super) chunk: [u32; 2],
    /// How many are side by side, and below each other.
    pub(super) chunks: [u32; 2],
    pub(super) offsets_tag: u16,
    pub(super) lengths_tag: u16,
}

impl TiffLayout {
    pub(super) fn of(directory: &TiffDirectory<'_>, size: [u32; 2]) -> Result<Self, Problem> {
        let in_file = |kind: FileErrorKind| kind.at(Place::File);
        check_colours(directory)?;
        let (kind, width) = sample_type(directory)?;
        let compression = compression(directory)?;
        let predictor = match (directory.number(tag::PREDICTOR)?.unwrap_or(1), kind) {
            (1, _) => SamplePredictor::Nothing,
            (2, _) => SamplePredictor::Left,
            (3, SampleKind::Float) => SamplePredictor::LeftOfBytes,
            (code, _) => {
                let text = format!("predictor {code} is not one of samples of this type");
                return Err(in_file(FileErrorKind::malformed(text)));
            }
        };

        // Strips are tiles as wide as the image.
        let is_tiled = directory.count(tag::TILE_OFFSETS) > 0;
        let [columns, rows] = size;
        let claimed = match is_tiled {
            true => [
                directory.need(tag::TILE_WIDTH)?,
                directory.need(tag::TILE_HEIGHT)?,
            ],
            false => {
                let strip = directory.number(tag::ROWS_PER_STRIP)?;
                [
                    u64::from(columns),
                    strip.map_or(rows.into(), |strip| strip.min(rows.into())),
                ]
            }
        };
        let chunk = claimed.map(|it| u32::try_from(it).ok().filter(|it| *it > 0));
        let [Some(chunk_columns), Some(chunk_rows)] = chunk else {
            let [x, y] = claimed;
            let text = format!("strips or tiles of {x} by {y} samples");
            return Err(in_file(FileErrorKind::malformed(text)));
        };
        let chunks = [columns.div_ceil(chunk_columns), rows.div_ceil(chunk_rows)];

        // What tiles hold beyond the image is decoded too.
        let padded = u64::from(chunks[0]) * u64::from(chunk_columns) * u64::from(rows);
        if padded > 4 * u64::from(columns) * u64::from(rows) + (1 << 20) {
            let text = format!(
                "tiles of {chunk_columns} by {chunk_rows} samples for an image of {columns} by {rows}: most of them would \
                 be empty"
            );
            return Err(in_file(FileErrorKind::malformed(text)));
        }

        let (offsets_tag, lengths_tag) = match is_tiled {
            true => (tag::TILE_OFFSETS, tag::TILE_BYTES),
            false => (tag::STRIP_OFFSETS, tag::STRIP_BYTES),
        };
        let expected = u64::from(chunks[0]) * u64::from(chunks[1]);
        let found = directory.count(offsets_tag);
        if found < expected {
            let text = format!("{found} strips or tiles where {expected} make the image");
            return Err(in_file(FileErrorKind::malformed(text)));
        }
        Ok(Self {
            size,
            kind,
            width,
            compression,
            predictor,
            chunk: [chunk_columns, chunk_rows],
            chunks,
            offsets_tag,
            lengths_tag,
        })
    }
}

/// Refuses what is not one band from black to white, the first row on top.
fn check_colours(directory: &TiffDirectory<'_>) -> Result<(), Problem> {
    let bands = directory.number(tag::BANDS)?.unwrap_or(1);
    let colours = directory.number(tag::PHOTOMETRIC)?.unwrap_or(1);
    let orientation = directory.number(tag::ORIENTATION)?.unwrap_or(1);
    let fill_order = directory.number(tag::FILL_ORDER)?.unwrap_or(1);
    let (what, advice) = if colours == 2 || colours == 5 || colours == 6 {
        (
            "a colour image".to_owned(),
            "Take the raster of heights itself",
        )
    } else if colours == 3 {
        (
            "an image with a palette".to_owned(),
            "Take the raster of heights itself",
        )
    } else if bands != 1 {
        (
            format!("a raster of {bands} bands"),
            "Keep the one with heights: gdal_translate -b 1",
        )
    } else if colours != 1 {
        let what =
            format!("an image of photometric interpretation {colours}, not from black to white");
        (what, "Save it as greyscale from black to white")
    } else if orientation != 1 {
        let what = format!("an image of orientation {orientation}");
        (what, "Save it with the first row on top: orientation 1")
    } else if fill_order != 1 {
        (
            "an image with turned bits (fill order 2)".to_owned(),
            "Save it with fill order 1",
        )
    } else {
        return Ok(());
    };
    let text = format!("this is {what}, which is not read as heights. {advice}");
    Err(FileErrorKind::unsupported(text).at(Place::File))
}

/// The type of samples and how many bytes they have.
fn sample_type(directory: &TiffDirectory<'_>) -> Result<(SampleKind, usize), Problem> {
    let bits = directory.number(tag::BITS)?.unwrap_or(1);
    let format = directory.number(tag::SAMPLE_FORMAT)?.unwrap_or(1);
    let kind = match format {
        1 | 4 => Some((SampleKind::Unsigned, "unsigned integers")),
        2 => Some((SampleKind::Signed, "integers")),
        3 => Some((SampleKind::Float, "floats")),
        _ => None,
    };
    let width = match (kind, bits) {
        (Some((SampleKind::Unsigned | SampleKind::Signed, _)), 8 | 16 | 32) => bits / 8,
        (Some((SampleKind::Float, _)), 32 | 64) => bits / 8,
        _ => 0,
    };
    match kind {
        Some((kind, _)) if width > 0 => Ok((kind, usize::try_from(width).expect("at most 8"))),
        _ => {
            let what = kind.map_or("numbers of an unknown or complex type", |(_, what)| what);
            let text = format!(
                "samples are {what} of {bits} bits: integers of 8, 16 and 32 bits are read, and floats of 32 and 64. \
                 Convert it, for example with gdal_translate -ot Float32"
            );
            Err(FileErrorKind::unsupported(text).at(Place::File))
        }
    }
}

fn compression(directory: &TiffDirectory<'_>) -> Result<TiffCompression, Problem> {
    let code = directory.number(tag::COMPRESSION)?.unwrap_or(1);
    let name = match code {
        1 => return Ok(TiffCompression::Plain),
        5 => return Ok(TiffCompression::Lzw),
        8 | 32_946 => return Ok(TiffCompression::Deflate),
        32_773 => return Ok(TiffCompression::PackBits),
        2..=4 => "a fax compression",
        6 | 7 => "JPEG",
        34_712 => "JPEG 2000",
        34_887 => "LERC",
        34_925 => "LZMA",
        50_000 => "ZSTD",
        50_001 => "WebP",
        50_002 => "JPEG XL",
        _ => "an unknown compression",
    };
    let text = format!(
        "samples are compressed by {name} ({code}), which is not read. Convert it, for example with gdal_translate -co \
         COMPRESS=DEFLATE"
    );
    Err(FileErrorKind::unsupported(text).at(Place::File))
}
