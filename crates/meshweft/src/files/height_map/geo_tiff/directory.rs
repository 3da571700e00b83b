//! Tags of a TIFF and their values, read where they stand: nothing is allocated by what a count says.

use super::super::super::error::{FileErrorKind, Place, Problem};
use super::tag::ALL;

/// The bytes of a TIFF, in its order of bytes.
#[derive(Clone, Copy)]
struct TiffBytes<'a> {
    bytes: &'a [u8],
    is_little: bool,
    /// Offsets of 64 bits.
    is_big: bool,
}

impl<'a> TiffBytes<'a> {
    fn slice(self, at: u64, length: u64, what: &str) -> Result<&'a [u8], Problem> {
        let range = at.checked_add(length).and_then(|end| {
            let (at, end) = (usize::try_from(at).ok()?, usize::try_from(end).ok()?);
            self.bytes.get(at..end)
        });
        range.ok_or_else(|| FileErrorKind::truncated(what).at(Place::Byte(self.bytes.len())))
    }

    /// The whole number that these bytes are.
    fn whole(self, bytes: &[u8]) -> u64 {
        let join = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        match self.is_little {
            true => bytes.iter().rev().fold(0, join),
            false => bytes.iter().fold(0, join),
        }
    }

    fn whole_at(self, at: u64, length: u64, what: &str) -> Result<u64, Problem> {
        self.slice(at, length, what).map(|bytes| self.whole(bytes))
    }
}

/// One entry of a directory.
#[derive(Clone, Copy)]
struct TiffField {
    tag: u16,
    kind: u16,
    count: u64,
    /// Where its first value stands.
    at: u64,
}

impl TiffField {
    /// Bytes of a value.
    fn width(self) -> Option<u64> {
        match self.kind {
            1 | 2 | 6 | 7 => Some(1),
            3 | 8 => Some(2),
            4 | 9 | 11 | 13 => Some(4),
            5 | 10 | 12 | 16 | 17 | 18 => Some(8),
            _ => None,
        }
    }
}

/// A directory: the tags of one image.
pub(super) struct TiffDirectory<'a> {
    file: TiffBytes<'a>,
    at: u64,
    fields: Vec<TiffField>,
    next: u64,
}

impl<'a> TiffDirectory<'a> {
    /// The directory of the first image.
    pub(super) fn first(bytes: &'a [u8]) -> Result<Self, Problem> {
        let is_little = bytes.starts_with(b"II");
        let mut file = TiffBytes {
            bytes,
            is_little,
            is_big: false,
        };
        file.is_big = file.whole_at(2, 2, "the header")? == 43;
        if file.is_big && file.whole_at(4, 4, "the header")? != if is_little { 8 } else { 8 << 16 }
        {
            let text = "a BigTIFF whose offsets are not of 8 bytes";
            return Err(FileErrorKind::malformed(text).at(Place::Byte(4)));
        }
        let first = match file.is_big {
            true => file.whole_at(8, 8, "the header")?,
            false => file.whole_at(4, 4, "the header")?,
        };
        Self::read(file, first)
    }

    /// The directory after this one, if there is one further on in the file.
    pub(super) fn next_directory(&self) -> Result<Option<Self>, Problem> {
        // One before it may lead back.
        match self.next > self.at {
            true => Self::read(self.file, self.next).map(Some),
            false => Ok(None),
        }
    }

    fn read(file: TiffBytes<'a>, at: u64) -> Result<Self, Problem> {
        let what = "a list of tags";
        let [count_bytes, entry, offset] = if file.is_big { [8, 20, 8] } else { [2, 12, 4] };
        let count = file.whole_at(at, count_bytes, what)?;
        let start = at + count_bytes;
        let length = count.checked_mul(entry);
        let length = length.ok_or_else(|| FileErrorKind::truncated(what).at(Place::File))?;
        let entries = file.slice(start, length, what)?;
        // A list without the offset of a next one is met in files.
        let next = file.whole_at(start + length, offset, what).unwrap_or(0);

        let width = usize::try_from(entry).expect("12 or 20");
        let mut fields = Vec::new();
        for (number, entry) in (0_u64..).zip(entries.chunks_exact(width)) {
            let tag = u16::try_from(file.whole(&entry[..2])).expect("two bytes");
            // Only those that are read are kept, each once.
            let is_known = ALL.contains(&tag);
            if !is_known || fields.iter().any(|field: &TiffField| field.tag == tag) {
                continue;
            }
            let value = width - usize::try_from(offset).expect("4 or 8");
            let mut field = TiffField {
                tag,
                kind: u16::try_from(file.whole(&entry[2..4])).expect("two bytes"),
                count: file.whole(&entry[4..value]),
                at: start + number * entry.len() as u64 + value as u64,
            };
            let size = field
                .width()
                .and_then(|width| width.checked_mul(field.count));
            if size.is_none_or(|size| size > offset) {
                field.at = file.whole(&entry[value..]);
            }
            fields.push(field);
        }
        Ok(Self {
            file,
            at,
            fields,
            next,
        })
    }

    pub(super) fn is_little(&self) -> bool {
        self.file.is_little
    }

    /// These bytes of the file.
    pub(super) fn slice(&self, at: u64, length: u64, what: &str) -> Result<&'a [u8], Problem> {
        self.file.slice(at, length, what)
    }

    /// The bytes from here to the end of the file.
    pub(super) fn rest(&self, at: u64) -> &'a [u8] {
        let at = usize::try_from(at).unwrap_or(usize::MAX);
        self.file.bytes.get(at..).unwrap_or(&[])
    }

    fn field(&self, tag: u16) -> Option<TiffField> {
        self.fields.iter().copied().find(|field| field.tag == tag)
    }

    /// How many values a tag has.
    pub(super) fn count(&self, tag: u16) -> u64 {
        self.field(tag).map_or(0, |field| field.count)
    }

    /// The bytes of one value of a tag, and its kind.
    fn value(&self, tag: u16, index: u64) -> Result<Option<(u16, &'a [u8])>, Problem> {
        let Some(field) = self.field(tag).filter(|field| index < field.count) else {
            return Ok(None);
        };
        let Some(width) = field.width() else {
            return Err(wrong_kind(tag, field.kind));
        };
        let at = field.at.saturating_add(index.saturating_mul(width));
        let bytes = self
            .file
            .slice(at, width, &format!("the values of tag {tag}"))?;
        Ok(Some((field.kind, bytes)))
    }

    /// A value of a tag that is a whole number.
    pub(super) fn nth(&self, tag: u16, index: u64) -> Result<Option<u64>, Problem> {
        match self.value(tag, index)? {
            None => Ok(None),
            Some((1 | 3 | 4 | 13 | 16 | 18, bytes)) => Ok(Some(self.file.whole(bytes))),
            Some((kind, _)) => Err(wrong_kind(tag, kind)),
        }
    }

    /// The first value of a tag, a whole number.
    pub(super) fn number(&self, tag: u16) -> Result<Option<u64>, Problem> {
        self.nth(tag, 0)
    }

    /// As [`number`](Self::number), of a tag that must be there.
    pub(super) fn need(&self, tag: u16) -> Result<u64, Problem> {
        self.number(tag)?.ok_or_else(|| {
            let text = format!("tag {tag} is missing, which every image has");
            FileErrorKind::malformed(text).at(Place::File)
        })
    }

    /// The value of a tag with a fraction, of 64 bits.
    pub(super) fn real(&self, tag: u16, index: u64) -> Result<Option<f64>, Problem> {
        match self.value(tag, index)? {
            None => Ok(None),
            Some((12, bytes)) => Ok(Some(f64::from_bits(self.file.whole(bytes)))),
            Some((kind, _)) => Err(wrong_kind(tag, kind)),
        }
    }

    /// Several such values from the first on, if all are there.
    pub(super) fn reals<const N: usize>(&self, tag: u16) -> Result<Option<[f64; N]>, Problem> {
        let mut found = [0.0; N];
        for (index, found) in (0..).zip(&mut found) {
            match self.real(tag, index)? {
                Some(value) => *found = value,
                None => return Ok(None),
            }
        }
        Ok(Some(found))
    }

    /// The text of a tag.
    pub(super) fn text(&self, tag: u16) -> Result<Option<String>, Problem> {
        let Some(field) = self.field(tag) else {
            return Ok(None);
        };
        let bytes = self
            .file
            .slice(field.at, field.count, &format!("the text of tag {tag}"))?;
        Ok(Some(String::from_utf8_lossy(bytes).into_owned()))
    }
}

fn wrong_kind(tag: u16, kind: u16) -> Problem {
    let text = format!("the values of tag {tag} are of type {kind}, which is not one of its own");
    FileErrorKind::malformed(text).at(Place::File)
}
