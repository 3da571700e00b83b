//! The types of numbers that a PLY file stores.

use crate::attribute::Values;
use crate::files::decoded::note_floats;
use crate::files::text::{float, whole_number};

/// A type that values are read as. It holds every number of the type that the file declares.
pub(super) trait PlyNumber: Copy + Default {
    /// What it is, for errors.
    const KIND: &'static str;
    /// The number that a word of text is.
    fn of_token(token: &[u8]) -> Option<Self>;
    /// A whole number that fits.
    fn of_whole(number: i64) -> Self;
    /// A float, if this is a float.
    fn of_f32(number: f32) -> Self;
    /// A float, if this is a float.
    fn of_f64(number: f64) -> Self;
    /// Many of them.
    fn values(numbers: Vec<Self>) -> Values;
}

macro_rules! whole {
    ($number:ty, $values:ident, $kind:literal) => {
        impl PlyNumber for $number {
            const KIND: &'static str = $kind;
            fn of_token(token: &[u8]) -> Option<Self> {
                Self::try_from(whole_number(token)?).ok()
            }
            fn of_whole(number: i64) -> Self {
                // A number of the file's type is read as that type.
                Self::try_from(number).unwrap_or_default()
            }
            fn of_f32(_number: f32) -> Self {
                // Floats are read as floats.
                Self::default()
            }
            fn of_f64(_number: f64) -> Self {
                Self::default()
            }
            fn values(numbers: Vec<Self>) -> Values {
                Values::$values(numbers)
            }
        }
    };
}

whole!(i8, I8, "a whole number from -128 to 127");
whole!(u8, U8, "a whole number from 0 to 255");
whole!(i16, I16, "a whole number from -32768 to 32767");
whole!(u16, U16, "a whole number from 0 to 65535");
whole!(i32, I32, "a whole number of 32 bits");
whole!(u32, U32, "a whole number of 32 bits without a sign");

impl PlyNumber for f32 {
    const KIND: &'static str = "a number";
    fn of_token(token: &[u8]) -> Option<Self> {
        float(token)
    }
    #[expect(clippy::cast_precision_loss, reason = "at most 16 bits, see `Column`")]
    fn of_whole(number: i64) -> Self {
        number as f32
    }
    fn of_f32(number: f32) -> Self {
        note_floats(1);
        number
    }
    #[expect(clippy::cast_possible_truncation, reason = "doubles are read as such")]
    fn of_f64(number: f64) -> Self {
        note_floats(1);
        number as f32
    }
    fn values(numbers: Vec<Self>) -> Values {
        Values::F32(numbers)
    }
}

impl PlyNumber for f64 {
    const KIND: &'static str = "a number";
    fn of_token(token: &[u8]) -> Option<Self> {
        float(token)
    }
    #[expect(clippy::cast_precision_loss, reason = "at most 32 bits")]
    fn of_whole(number: i64) -> Self {
        number as f64
    }
    fn of_f32(number: f32) -> Self {
        note_floats(1);
        number.into()
    }
    fn of_f64(number: f64) -> Self {
        note_floats(1);
        number
    }
    fn values(numbers: Vec<Self>) -> Values {
        Values::F64(numbers)
    }
}
