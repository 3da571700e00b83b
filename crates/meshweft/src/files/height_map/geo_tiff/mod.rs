//! GeoTIFF: a raster of one band in strips or tiles, with keys that say where it lies.
//!
//! Adobe, *TIFF* 6.0 (1992) and its supplements; OGC 19-008r4, *GeoTIFF* 1.1 (2019); BigTIFF. The structure is
//! read here, and not by the crate `tiff`, whose decoder allocates by what a header says before it can be told a
//! limit. Of several images in a file the first is read: those after it are mostly smaller copies.
//!
//! A sample is the whole of a pixel or a point, by a key of the file. The grid has points, so the first sample of
//! pixels lies half a pixel inwards from the corner that the file says.

use super::super::error::{FileErrorKind, Place, Problem};
use super::super::note::Note;
use super::options::HeightMapOptions;
use super::sampled::{HeightRule, ReadHeights, checked_size};
use directory::TiffDirectory;
use layout::TiffLayout;

mod chunks;
mod directory;
mod layout;
mod place;
mod tag;

pub(super) fn read(bytes: &[u8], options: &HeightMapOptions) -> Result<ReadHeights, Problem> {
    let in_file = |kind: FileErrorKind| kind.at(Place::File);
    let first = TiffDirectory::first(bytes)?;

    // What it says, before anything is allocated.
    let size = [first.need(tag::WIDTH)?, first.need(tag::HEIGHT)?];
    let size = checked_size(size, bytes.len(), options).map_err(in_file)?;
    let layout = TiffLayout::of(&first, size)?;
    let ground = place::of(&first, size)?;
    let no_data = no_data(&first)?;

    let mut rule = HeightRule::new(options, ground.height_unit, no_data.as_slice());
    let mut heights = vec![f32::NAN; size[0] as usize * size[1] as usize];
    chunks::read(&first, &layout, no_data.is_some(), &mut rule, &mut heights)?;
    if ground.is_upwards {
        turn_over(&mut heights, size[0] as usize);
    }

    let mut notes = rule.notes();
    notes.extend(ground.notes);
    notes.extend(metadata_note(&first)?);
    notes.extend(further_images(&first)?);
    Ok(ReadHeights {
        size,
        heights,
        placement: ground.placement,
        notes,
    })
}

/// The value for no height, which GDAL writes as text.
fn no_data(directory: &TiffDirectory<'_>) -> Result<Option<f64>, Problem> {
    let Some(text) = directory.text(tag::GDAL_NO_DATA)? else {
        return Ok(None);
    };
    let number = text.trim_matches(['\0', ' ']).parse();
    number.map(Some).map_err(|_| {
        let text = format!("its value for no data, {text:?}, is no number");
        FileErrorKind::malformed(text).at(Place::File)
    })
}

/// Puts the last row first.
fn turn_over(heights: &mut [f32], columns: usize) {
    let rows = heights.len() / columns;
    let (top, bottom) = heights.split_at_mut(rows / 2 * columns);
    let bottom = bottom.chunks_exact_mut(columns).rev();
    for (above, below) in top.chunks_exact_mut(columns).zip(bottom) {
        above.swap_with_slice(below);
    }
}

/// What is to be said of metadata that changes what samples mean.
fn metadata_note(directory: &TiffDirectory<'_>) -> Result<Option<Note>, Problem> {
    let metadata = directory.text(tag::GDAL_METADATA)?.unwrap_or_default();
    let is_changed = metadata.contains("role=\"scale\"") || metadata.contains("role=\"offset\"");
    Ok(is_changed.then(|| {
        let text = "its metadata have a scale or an offset of heights, which are not applied: give a height scale";
        Note::new(Place::File, text)
    }))
}

/// What is to be said of images after the first that are not smaller copies of it.
fn further_images(first: &TiffDirectory<'_>) -> Result<Option<Note>, Problem> {
    // More than any sound file has, so that a chain without end does.
    const MOST: usize = 1000;
    let (mut masks, mut others) = (0, 0);
    let mut next = first.next_directory()?;
    while let Some(image) = next.take().filter(|_| masks + others < MOST) {
        match image.number(tag::SUBFILE)?.unwrap_or(0) {
            kind if kind & 4 != 0 => masks += 1,
            kind if kind & 1 != 0 => masks += 0,
            _ => others += 1,
        }
        next = image.next_directory()?;
    }
    let text = match (masks, others) {
        (0, 0) => return Ok(None),
        (0, others) => format!("{others} images after the first are not read"),
        _ => "it has a mask beside its samples, which is not read: give the value for no data"
            .to_owned(),
    };
    Ok(Some(Note::new(Place::File, text)))
}
