//! The fields of files of blocks, one after the other.

use std::ops::Range;

use crate::bits::{DecodeError, DecodeErrorKind, crc32, varint};
use crate::topology::half_edges::NONE;

/// The difference of a number from another, plus one; 0 for [`NONE`].
pub(super) fn put_difference(bytes: &mut Vec<u8>, from: u32, number: u32) {
    let difference = match number {
        NONE => 0,
        _ => 1 + varint::zigzag(i64::from(number) - i64::from(from)),
    };
    varint::write(bytes, difference);
}

pub(super) fn put_f32s<const N: usize>(bytes: &mut Vec<u8>, numbers: [f32; N]) {
    for number in numbers {
        bytes.extend(number.to_le_bytes());
    }
}

/// Whether bytes have a checksum. A fuzzer does not find the right ones: there, any will do.
pub(super) fn is_sealed(bytes: &[u8], checksum: u32) -> bool {
    cfg!(fuzzing) || crc32(bytes) == checksum
}

/// Bytes that are read from the front; `at` is where they were in the file.
pub(super) struct FieldReader<'a> {
    rest: &'a [u8],
    end: usize,
}

impl<'a> FieldReader<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self {
            rest: bytes,
            end: at + bytes.len(),
        }
    }

    pub(super) fn error(&self, kind: DecodeErrorKind) -> DecodeError {
        DecodeError {
            byte: self.end - self.rest.len(),
            kind,
        }
    }

    pub(super) fn damaged(&self) -> DecodeError {
        self.error(DecodeErrorKind::Damaged)
    }

    pub(super) fn number(&mut self) -> Result<u64, DecodeError> {
        varint::read(&mut self.rest).ok_or_else(|| self.error(DecodeErrorKind::EndsEarly))
    }

    /// A number below a limit.
    pub(super) fn below(&mut self, limit: u32) -> Result<u32, DecodeError> {
        let number = u32::try_from(self.number()?).ok();
        number
            .filter(|&it| it < limit)
            .ok_or_else(|| self.damaged())
    }

    /// A number in a range by its difference from another, or [`NONE`].
    pub(super) fn difference(&mut self, from: u32, range: Range<u32>) -> Result<u32, DecodeError> {
        let Some(difference) = self.number()?.checked_sub(1) else {
            return Ok(NONE);
        };
        let number = i64::from(from).checked_add(varint::unzigzag(difference));
        let number = number.and_then(|it| u32::try_from(it).ok());
        let number = number.filter(|it| range.contains(it));
        number.ok_or_else(|| self.damaged())
    }

    pub(super) fn bytes<const N: usize>(&mut self) -> Result<[u8; N], DecodeError> {
        let bytes = self.rest.split_off(..N).and_then(|it| it.try_into().ok());
        bytes.ok_or_else(|| self.error(DecodeErrorKind::EndsEarly))
    }

    pub(super) fn slice(&mut self, length: usize) -> Result<&'a [u8], DecodeError> {
        let bytes = self.rest.split_off(..length);
        bytes.ok_or_else(|| self.error(DecodeErrorKind::EndsEarly))
    }

    pub(super) fn f32s<const N: usize>(&mut self) -> Result<[f32; N], DecodeError> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = f32::from_le_bytes(self.bytes()?);
        }
        Ok(numbers)
    }

    pub(super) fn f64(&mut self) -> Result<f64, DecodeError> {
        Ok(f64::from_le_bytes(self.bytes()?))
    }

    /// A number that is not below 0; it may be infinite.
    pub(super) fn length(&mut self) -> Result<f32, DecodeError> {
        let [length] = self.f32s()?;
        match length >= 0.0 {
            true => Ok(length),
            false => Err(self.damaged()),
        }
    }

    /// How many bytes are left.
    #[cfg(test)]
    pub(super) fn left(&self) -> usize {
        self.rest.len()
    }

    pub(super) fn finish(self) -> Result<(), DecodeError> {
        match self.rest.is_empty() {
            true => Ok(()),
            false => Err(self.damaged()),
        }
    }
}
