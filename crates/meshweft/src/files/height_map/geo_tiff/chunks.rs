//! Strips and tiles: their bytes become heights row by row, so that no more than a row is held beside them.

use std::io::{self, ErrorKind, Read};

use flate2::read::ZlibDecoder;
use weezl::{BitOrder, LzwStatus};

use super::super::super::error::{FileErrorKind, Place, Problem};
use super::super::sampled::HeightRule;
use super::directory::TiffDirectory;
use super::layout::{SampleKind, SamplePredictor, TiffCompression, TiffLayout};

/// Reads all samples. A strip or tile that the file leaves out is void if there is a value for no height,
/// and 0 otherwise.
pub(super) fn read(
    directory: &TiffDirectory<'_>,
    layout: &TiffLayout,
    has_no_data: bool,
    rule: &mut HeightRule,
    heights: &mut [f32],
) -> Result<(), Problem> {
    let [columns, rows] = layout.size;
    let [chunk_columns, chunk_rows] = layout.chunk;
    let mut row_bytes = vec![0; chunk_columns as usize * layout.width];
    let mut sorted = Vec::new();
    for number in 0..layout.chunks[0] * layout.chunks[1] {
        // Where it lies in the image, and in the file.
        let column = number % layout.chunks[0] * chunk_columns;
        let row = number / layout.chunks[0] * chunk_rows;
        let inside = [
            chunk_columns.min(columns - column),
            chunk_rows.min(rows - row),
        ];
        let what = || format!("strip or tile {number}");
        let at = directory
            .nth(layout.offsets_tag, number.into())?
            .unwrap_or(0);
        let length = directory.nth(layout.lengths_tag, number.into())?;
        let stored = match (length, layout.compression) {
            (Some(0), _) if at == 0 => None,
            (Some(length), _) => Some(directory.slice(at, length, &what())?),
            // Old writers leave the lengths out.
            (None, TiffCompression::Plain) => Some(directory.rest(at)),
            (None, _) => {
                let text = format!("{} has no length", what());
                return Err(FileErrorKind::malformed(text).at(Place::File));
            }
        };
        let mut source = stored.map(|stored| unpacked(layout.compression, stored));

        for row in row..row + inside[1] {
            let start = row as usize * columns as usize + column as usize;
            let heights = &mut heights[start..start + inside[0] as usize];
            let Some(source) = &mut source else {
                heights.fill(if has_no_data {
                    f32::NAN
                } else {
                    rule.height(0.0)
                });
                continue;
            };
            let found = source.read_exact(&mut row_bytes);
            found.map_err(|error| data_error(&error, &what(), at))?;
            to_native(&mut row_bytes, &mut sorted, layout, directory.is_little());
            put(&row_bytes, layout, rule, heights);
        }
    }
    Ok(())
}

fn data_error(error: &io::Error, what: &str, at: u64) -> Problem {
    let kind = match error.kind() {
        ErrorKind::UnexpectedEof => FileErrorKind::truncated(what),
        _ => FileErrorKind::malformed(format!(
            "the compressed data of {what} is damaged ({error})"
        )),
    };
    kind.at(usize::try_from(at).map_or(Place::File, Place::Byte))
}

/// What the bytes of a strip or tile decompress to.
fn unpacked<'a>(compression: TiffCompression, stored: &'a [u8]) -> Box<dyn Read + 'a> {
    match compression {
        TiffCompression::Plain => Box::new(stored),
        TiffCompression::Deflate => Box::new(ZlibDecoder::new(stored)),
        TiffCompression::Lzw => Box::new(LzwSource {
            stored,
            decoder: weezl::decode::Decoder::with_tiff_size_switch(BitOrder::Msb, 8),
        }),
        TiffCompression::PackBits => Box::new(PackBitsSource {
            stored,
            run: PackBitsRun::Copied(0),
        }),
    }
}

struct LzwSource<'a> {
    stored: &'a [u8],
    decoder: weezl::decode::Decoder,
}

impl Read for LzwSource<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            let result = self.decoder.decode_bytes(self.stored, buffer);
            self.stored = &self.stored[result.consumed_in..];
            match result.status {
                _ if result.consumed_out > 0 => return Ok(result.consumed_out),
                Ok(LzwStatus::Ok) if result.consumed_in > 0 => {}
                Ok(_) => return Ok(0),
                Err(error) => return Err(io::Error::new(ErrorKind::InvalidData, error)),
            }
        }
    }
}

/// Runs of PackBits: a count, then as many bytes, or one byte that is repeated.
struct PackBitsSource<'a> {
    stored: &'a [u8],
    run: PackBitsRun,
}

/// What is left of a run.
enum PackBitsRun {
    Copied(usize),
    Repeated(u8, usize),
}

impl Read for PackBitsSource<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        // The next run.
        while matches!(
            self.run,
            PackBitsRun::Copied(0) | PackBitsRun::Repeated(_, 0)
        ) {
            let Some((&count, rest)) = self.stored.split_first() else {
                return Ok(0);
            };
            self.stored = rest;
            match count {
                0..=127 => self.run = PackBitsRun::Copied(usize::from(count) + 1),
                128 => {}
                129.. => {
                    let Some((&byte, rest)) = self.stored.split_first() else {
                        return Ok(0);
                    };
                    self.stored = rest;
                    self.run = PackBitsRun::Repeated(byte, 257 - usize::from(count));
                }
            }
        }

        // As much of it as there is room for.
        match &mut self.run {
            PackBitsRun::Copied(left) => {
                let count = (*left).min(buffer.len()).min(self.stored.len());
                let (bytes, rest) = self.stored.split_at(count);
                buffer[..count].copy_from_slice(bytes);
                self.stored = rest;
                *left -= count;
                Ok(count)
            }
            PackBitsRun::Repeated(byte, left) => {
                let count = (*left).min(buffer.len());
                buffer[..count].fill(*byte);
                *left -= count;
                Ok(count)
            }
        }
    }
}

/// Undoes the predictor of a row; its samples are little-endian then.
fn to_native(row: &mut [u8], sorted: &mut Vec<u8>, layout: &TiffLayout, is_little: bool) {
    let width = layout.width;
    if layout.predictor == SamplePredictor::LeftOfBytes {
        // Sorted by place, the highest byte of all samples first, whatever the order of bytes is.
        for at in 1..row.len() {
            row[at] = row[at].wrapping_add(row[at - 1]);
        }
        sorted.clear();
        sorted.extend_from_slice(row);
        let columns = row.len() / width;
        for (column, sample) in row.chunks_exact_mut(width).enumerate() {
            for (place, byte) in sample.iter_mut().enumerate() {
                *byte = sorted[(width - 1 - place) * columns + column];
            }
        }
        return;
    }

    if !is_little {
        row.chunks_exact_mut(width).for_each(<[u8]>::reverse);
    }
    if layout.predictor == SamplePredictor::Left {
        let mut left = 0_u64;
        for sample in row.chunks_exact_mut(width) {
            left = left.wrapping_add(little_endian(sample));
            sample.copy_from_slice(&left.to_le_bytes()[..width]);
        }
    }
}

fn little_endian(sample: &[u8]) -> u64 {
    let mut bytes = [0; 8];
    bytes[..sample.len()].copy_from_slice(sample);
    u64::from_le_bytes(bytes)
}

/// Puts the samples of a row, as many as there are heights for.
fn put(row: &[u8], layout: &TiffLayout, rule: &mut HeightRule, heights: &mut [f32]) {
    // Samples have at most 8 bytes, integers at most 4.
    for (height, sample) in heights.iter_mut().zip(row.chunks_exact(layout.width)) {
        let sample = match (layout.kind, sample) {
            (SampleKind::Float, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]).into(),
            (SampleKind::Float, _) => f64::from_bits(little_endian(sample)),
            (SampleKind::Unsigned, _) => little_endian(sample) as f64,
            (SampleKind::Signed, &[a]) => f64::from(a.cast_signed()),
            (SampleKind::Signed, &[a, b]) => i16::from_le_bytes([a, b]).into(),
            (SampleKind::Signed, &[a, b, c, d]) => i32::from_le_bytes([a, b, c, d]).into(),
            (SampleKind::Signed, _) => f64::NAN,
        };
        *height = rule.height(sample);
    }
}
