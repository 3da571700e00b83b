//! Greyscale PNG images of 8 or 16 bits.
//!
//! Nothing in the file says how large a sample is or how far samples are apart: the caller does. The grey
//! that the file says is transparent is void, as writers of rasters use it so.

use std::io::{Cursor, ErrorKind};

use ::png::{BitDepth, ColorType, Decoder, DecodingError, Limits as PngLimits, Transformations};

use super::super::error::{FileErrorKind, Place, Problem};
use super::super::note::Note;
use super::options::HeightMapOptions;
use super::placement::MapPlacement;
use super::sampled::{HeightRule, ReadHeights, checked_size};

pub(super) fn read(bytes: &[u8], options: &HeightMapOptions) -> Result<ReadHeights, Problem> {
    let in_file = |kind: FileErrorKind| kind.at(Place::File);

    // The header, before anything is allocated by what it says.
    let limits = PngLimits { bytes: 4 << 20 };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::IDENTITY);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let header = decoder
        .read_header_info()
        .map_err(|error| in_file(png_error(&error)))?;
    let size = [header.width, header.height].map(u64::from);
    check_colours(header.color_type, header.bit_depth).map_err(in_file)?;
    let size = checked_size(size, bytes.len(), options).map_err(in_file)?;

    let mut reader = decoder
        .read_info()
        .map_err(|error| in_file(png_error(&error)))?;
    let width = if reader.info().bit_depth == BitDepth::Sixteen {
        2
    } else {
        1
    };
    let transparent = reader.info().trns.as_deref();
    // Of two bytes whatever the depth is.
    let no_data = transparent.and_then(|grey| Some(u16::from_be_bytes(*grey.first_chunk()?)));
    let no_data: Vec<f64> = no_data.map(f64::from).into_iter().collect();
    let mut rule = HeightRule::new(options, 1.0, &no_data);

    // Row by row; the rows of an interlaced image come in seven passes.
    let [columns, rows] = size.map(|it| it as usize);
    let mut heights = vec![f32::NAN; columns * rows];
    let mut pass_rows = match reader.info().interlaced {
        true => interlaced_rows([columns, rows]),
        false => (0..rows).map(|row| (row * columns, 1)).collect(),
    }
    .into_iter();
    loop {
        let decoded = reader
            .next_row()
            .map_err(|error| in_file(png_error(&error)))?;
        let (Some(row), Some((start, step))) = (decoded, pass_rows.next()) else {
            break;
        };
        let end = (start / columns + 1) * columns;
        let places = heights[start..end].iter_mut().step_by(step);
        for (place, sample) in places.zip(row.data().chunks_exact(width)) {
            let value = sample
                .iter()
                .fold(0, |value, &byte| value << 8 | u32::from(byte));
            *place = rule.height(f64::from(value));
        }
    }
    reader
        .finish()
        .map_err(|error| in_file(png_error(&error)))?;

    let mut notes = rule.notes();
    if let Some(grey) = no_data.first() {
        let text = format!("samples of {grey} are transparent, and are read as void");
        notes.push(Note::new(Place::File, text));
    }
    Ok(ReadHeights {
        size,
        heights,
        placement: MapPlacement::Unknown,
        notes,
    })
}

/// Where each row that an interlaced image stores begins, and the step between its samples.
fn interlaced_rows([columns, rows]: [usize; 2]) -> Vec<(usize, usize)> {
    // First column and its step, first row and its step, of each pass.
    const PASSES: [[usize; 4]; 7] = [
        [0, 8, 0, 8],
        [4, 8, 0, 8],
        [0, 4, 4, 8],
        [2, 4, 0, 4],
        [0, 2, 2, 4],
        [1, 2, 0, 2],
        [0, 1, 1, 2],
    ];
    let passes = PASSES.into_iter().filter(|&[column, ..]| column < columns);
    passes
        .flat_map(|[column, step, row, row_step]| {
            let starts = (row..rows).step_by(row_step);
            starts.map(move |row| (row * columns + column, step))
        })
        .collect()
}

/// Refuses what is not one grey of whole bytes.
fn check_colours(colours: ColorType, depth: BitDepth) -> Result<(), FileErrorKind> {
    let what = match (colours, depth) {
        (ColorType::Grayscale, BitDepth::Eight | BitDepth::Sixteen) => return Ok(()),
        (ColorType::Grayscale, _) => "a greyscale image of fewer than 8 bits",
        (ColorType::GrayscaleAlpha, _) => "a greyscale image with an alpha channel",
        (ColorType::Indexed, _) => "an image with a palette",
        (ColorType::Rgb | ColorType::Rgba, _) => "a colour image",
    };
    Err(FileErrorKind::unsupported(format!(
        "this is {what}, and heights are read from greyscale of 8 or 16 bits. Save it as that, without alpha"
    )))
}

fn png_error(error: &DecodingError) -> FileErrorKind {
    match error {
        DecodingError::IoError(io) if io.kind() == ErrorKind::UnexpectedEof => {
            FileErrorKind::truncated("the image")
        }
        DecodingError::LimitsExceeded => FileErrorKind::unsupported(
            "a block of the PNG that is not its samples is larger than is read. Save it without metadata",
        ),
        DecodingError::IoError(_) | DecodingError::Format(_) | DecodingError::Parameter(_) => {
            FileErrorKind::malformed(format!("not a sound PNG: {error}"))
        }
    }
}
