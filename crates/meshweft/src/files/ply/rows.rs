//! Reading the rows of a PLY file, ascii or binary, value by value.

use super::header::{Element, Property, PropertyKind};
use super::number::PlyNumber;
use crate::attribute::ComponentType;
use crate::files::error::{Fault, FileErrorKind};
use crate::files::text::is_coordinate;
use crate::files::text::{Tokens, is_blank, is_line_end, shown, whole_number};

/// The row that is being read, for errors.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    pub(super) element: &'a Element,
    pub(super) number: usize,
}

impl Row<'_> {
    #[cold]
    pub(super) fn malformed(&self, at: usize, text: impl std::fmt::Display) -> Fault {
        let text = format!("{} {}: {text}", self.element.name, self.number);
        Fault::malformed(at, text)
    }

    #[cold]
    fn truncated(&self, at: usize) -> Fault {
        let Element { name, count, .. } = self.element;
        let kind = FileErrorKind::truncated(format!("{name} {} of {count}", self.number));
        Fault { at, kind }
    }
}

/// A stream of values.
pub(super) trait PlyRows {
    /// Where the next value is looked for.
    fn at(&self) -> usize;
    /// Moves to the first byte of the next row, which is returned.
    fn start_row(&mut self) -> usize;
    /// The end of the row's last value, after looking whether the row ends there.
    fn end_row(&mut self, row: &Row<'_>) -> Result<usize, Fault>;
    /// Reads past `count` values.
    fn skip(&mut self, count: usize, scalar: ComponentType, row: &Row<'_>) -> Result<(), Fault>;
    /// Reads past a coordinate, after looking whether it is one.
    fn coordinate(&mut self, scalar: ComponentType, row: &Row<'_>) -> Result<(), Fault> {
        self.skip(1, scalar, row)
    }
    /// A number, as another type that holds all numbers of its type.
    fn number<T: PlyNumber>(&mut self, scalar: ComponentType, row: &Row<'_>) -> Result<T, Fault>;
    /// A whole number; the type is not a float.
    fn whole(&mut self, scalar: ComponentType, row: &Row<'_>) -> Result<i64, Fault>;
    /// The number of entries of a list, which stands before them.
    fn list_length(&mut self, scalar: ComponentType, row: &Row<'_>) -> Result<usize, Fault> {
        let at = self.at();
        let length = self.whole(scalar, row)?;
        let fits = usize::try_from(length);
        fits.map_err(|_| row.malformed(at, format!("a list of {length} entries")))
    }
    /// How many bytes are left.
    fn left(&self) -> usize;
    /// How many rows of the element can be there, by the bytes that are left.
    fn at_most(&self, element: &Element) -> usize;

    /// Reads past all rows of the element, if they have one length and are all there; where they
    /// start, and that length. A faster way, that leaves whatever is unusual to the other.
    fn pass_even(&mut self, _element: &Element) -> Option<(usize, usize)> {
        None
    }

    /// Reads rows, at most `count`, as long as they are triangles of the layout and all there, and
    /// adds their corners to `faces`; how many, and how long each is. A faster way, that leaves
    /// whatever is unusual to the other.
    fn triangles(
        &mut self,
        _layout: &TriangleLayout,
        _count: usize,
        _faces: &mut Vec<[u32; 3]>,
    ) -> (usize, usize) {
        (0, 0)
    }
}

/// Rows with numbers around one list of corners, of four bytes each, its length in one byte.
pub(super) struct TriangleLayout {
    /// Bytes before the list.
    before: usize,
    /// Bytes after it.
    after: usize,
    /// Whether a corner may be negative.
    is_signed: bool,
}

impl TriangleLayout {
    /// The layout of an element's rows, if they have it.
    pub(super) fn of(element: &Element, list: usize) -> Option<Self> {
        let size = |property: &Property| match property.kind {
            PropertyKind::Scalar(scalar) => Some(scalar.size()),
            PropertyKind::List { .. } => None,
        };
        let (before, rest) = element.properties.split_at_checked(list)?;
        let (list, after) = rest.split_first()?;
        let is_signed = match list.kind {
            PropertyKind::List {
                count: ComponentType::U8 | ComponentType::I8,
                item: ComponentType::I32,
            } => true,
            PropertyKind::List {
                count: ComponentType::U8 | ComponentType::I8,
                item: ComponentType::U32,
            } => false,
            _ => return None,
        };
        Some(Self {
            before: before.iter().map(size).sum::<Option<usize>>()?,
            after: after.iter().map(size).sum::<Option<usize>>()?,
            is_signed,
        })
    }
}

/// PlyRows as lines of text.
pub(super) struct Ascii<'a> {
    source: &'a [u8],
    tokens: Tokens<'a>,
}

impl<'a> Ascii<'a> {
    pub(super) fn new(source: &'a [u8], at: usize) -> Self {
        Self {
            source,
            tokens: Tokens::plain(source, at),
        }
    }

    #[inline]
    fn token(&mut self, row: &Row<'_>) -> Result<&'a [u8], Fault> {
        match self.tokens.next() {
            Some(token) => Ok(&self.source[token]),
            None => Err(row.truncated(self.source.len())),
        }
    }
}

impl PlyRows for Ascii<'_> {
    fn at(&self) -> usize {
        self.tokens.at()
    }

    #[inline]
    fn start_row(&mut self) -> usize {
        let source = self.source;
        let gap = source[self.tokens.at()..].iter();
        let gap = gap.take_while(|&&byte| is_blank(byte) || is_line_end(byte));
        let start = self.tokens.at() + gap.count();
        self.tokens = Tokens::plain(source, start);
        start
    }

    #[inline]
    fn end_row(&mut self, row: &Row<'_>) -> Result<usize, Fault> {
        let end = self.tokens.at();
        // A line with more values than declared would shift all rows after it.
        let rest = self.source[end..].iter();
        match rest.copied().find(|&byte| !is_blank(byte)) {
            Some(byte) if !is_line_end(byte) => {
                Err(row.malformed(end, "more values on its line than the header declares"))
            }
            _ => Ok(end),
        }
    }

    #[inline]
    fn skip(&mut self, count: usize, _scalar: ComponentType, row: &Row<'_>) -> Result<(), Fault> {
        for _ in 0..count {
            self.token(row)?;
        }
        Ok(())
    }

    #[inline]
    fn coordinate(&mut self, _scalar: ComponentType, row: &Row<'_>) -> Result<(), Fault> {
        let token = self.token(row)?;
        if is_coordinate(token) {
            return Ok(());
        }
        let text = format!("{} is not a coordinate: write a number", shown(token));
        Err(row.malformed(self.tokens.at(), text))
    }

    #[inline]
    fn number<T: PlyNumber>(&mut self, _scalar: ComponentType, row: &Row<'_>) -> Result<T, Fault> {
        let token = self.token(row)?;
        T::of_token(token).ok_or_else(|| {
            let text = format!(
                "{} is not {}: write a number of its type",
                shown(token),
                T::KIND
            );
            row.malformed(self.tokens.at(), text)
        })
    }

    #[inline]
    fn whole(&mut self, _scalar: ComponentType, row: &Row<'_>) -> Result<i64, Fault> {
        let token = self.token(row)?;
        whole_number(token).ok_or_else(|| {
            let text = format!("{} is not a whole number", shown(token));
            row.malformed(self.tokens.at(), text)
        })
    }

    fn left(&self) -> usize {
        self.source.len() - self.at()
    }

    fn at_most(&self, element: &Element) -> usize {
        // Each value takes a digit and what separates it from the next.
        let smallest = element.properties.len() * 2;
        element
            .count
            .min((self.source.len() - self.at()) / smallest.max(1) + 1)
    }
}

/// PlyRows as bytes.
pub(super) struct Binary<'a, const BIG: bool> {
    source: &'a [u8],
    at: usize,
}

impl<'a, const BIG: bool> Binary<'a, BIG> {
    pub(super) fn new(source: &'a [u8], at: usize) -> Self {
        Self { source, at }
    }

    #[inline]
    fn take<const SIZE: usize>(&mut self, row: &Row<'_>) -> Result<[u8; SIZE], Fault> {
        let Some(bytes) = self.source[self.at..].first_chunk::<SIZE>() else {
            return Err(row.truncated(self.source.len()));
        };
        self.at += SIZE;
        Ok(*bytes)
    }
}

/// Reads a number of a type, in the byte order of the file.
macro_rules! number {
    ($rows:expr, $row:expr, $number:ty) => {{
        let bytes = $rows.take($row)?;
        match BIG {
            true => <$number>::from_be_bytes(bytes),
            false => <$number>::from_le_bytes(bytes),
        }
    }};
}

impl<const BIG: bool> PlyRows for Binary<'_, BIG> {
    #[inline]
    fn at(&self) -> usize {
        self.at
    }

    #[inline]
    fn start_row(&mut self) -> usize {
        self.at
    }

    #[inline]
    fn end_row(&mut self, _row: &Row<'_>) -> Result<usize, Fault> {
        Ok(self.at)
    }

    #[inline]
    fn skip(&mut self, count: usize, scalar: ComponentType, row: &Row<'_>) -> Result<(), Fault> {
        let left = self.source.len() - self.at;
        match count.checked_mul(scalar.size()) {
            Some(size) if size <= left => {
                self.at += size;
                Ok(())
            }
            _ => Err(row.truncated(self.source.len())),
        }
    }

    #[inline]
    fn number<T: PlyNumber>(&mut self, scalar: ComponentType, row: &Row<'_>) -> Result<T, Fault> {
        Ok(match scalar {
            ComponentType::F32 => T::of_f32(number!(self, row, f32)),
            ComponentType::F64 => T::of_f64(number!(self, row, f64)),
            whole => T::of_whole(self.whole(whole, row)?),
        })
    }

    #[inline]
    fn whole(&mut self, scalar: ComponentType, row: &Row<'_>) -> Result<i64, Fault> {
        Ok(match scalar {
            ComponentType::I8 => number!(self, row, i8).into(),
            ComponentType::U8 => number!(self, row, u8).into(),
            ComponentType::I16 => number!(self, row, i16).into(),
            ComponentType::U16 => number!(self, row, u16).into(),
            ComponentType::I32 => number!(self, row, i32).into(),
            ComponentType::U32 => number!(self, row, u32).into(),
            // The header reader refuses floats where whole numbers are needed.
            ComponentType::F32 | ComponentType::F64 => {
                return Err(row.malformed(self.at, "a float as a count"));
            }
        })
    }

    fn left(&self) -> usize {
        self.source.len() - self.at
    }

    fn at_most(&self, element: &Element) -> usize {
        let left = self.source.len() - self.at;
        element.count.min(left / element.smallest_row().max(1) + 1)
    }

    fn pass_even(&mut self, element: &Element) -> Option<(usize, usize)> {
        let size = |property: &Property| match property.kind {
            PropertyKind::Scalar(scalar) => Some(scalar.size()),
            PropertyKind::List { .. } => None,
        };
        let length: usize = element.properties.iter().map(size).sum::<Option<_>>()?;
        let start = self.at;
        let end = element.count.checked_mul(length)?.checked_add(start)?;
        if end > self.source.len() {
            return None;
        }
        self.at = end;
        Some((start, length))
    }

    fn triangles(
        &mut self,
        layout: &TriangleLayout,
        count: usize,
        faces: &mut Vec<[u32; 3]>,
    ) -> (usize, usize) {
        let length = layout.before + 13 + layout.after;
        let before = faces.len();
        // A negative corner is told apart by its first bit.
        let largest = if layout.is_signed {
            u32::MAX >> 1
        } else {
            u32::MAX
        };

        for row in self.source[self.at..].chunks_exact(length).take(count) {
            let Some([3, corners @ ..]) = row[layout.before..].first_chunk::<13>() else {
                break;
            };
            let [a, b, c] = [0, 4, 8].map(|i| {
                let bytes = [corners[i], corners[i + 1], corners[i + 2], corners[i + 3]];
                match BIG {
                    true => u32::from_be_bytes(bytes),
                    false => u32::from_le_bytes(bytes),
                }
            });
            if a.max(b).max(c) > largest {
                break;
            }
            faces.push([a, b, c]);
        }

        let read = faces.len() - before;
        self.at += read * length;
        (read, length)
    }
}
