//! Numbers in as many bytes as they need, seven bits in each, the lowest first.

/// The most bytes of a number.
pub(crate) const LONGEST: usize = 10;

/// Writes a number.
pub(crate) fn write(bytes: &mut Vec<u8>, mut number: u64) {
    loop {
        let [low, ..] = number.to_le_bytes();
        number >>= 7;
        if number == 0 {
            return bytes.push(low);
        }
        bytes.push(low | 0x80);
    }
}

/// A number with a sign as one without: 0, -1, 1, -2, 2 …
pub(crate) fn zigzag(number: i64) -> u64 {
    ((number << 1) ^ (number >> 63)).cast_unsigned()
}

/// The number with a sign.
pub(crate) fn unzigzag(number: u64) -> i64 {
    (number >> 1).cast_signed() ^ -(number & 1).cast_signed()
}

/// Reads a number from the front; `None` if it is cut or above 64 bits.
pub(crate) fn read(bytes: &mut &[u8]) -> Option<u64> {
    let mut number = 0_u64;
    for shift in (0..64).step_by(7) {
        let byte = *bytes.split_off_first()?;
        let bits = u64::from(byte & 0x7f);
        if shift == 63 && bits > 1 {
            return None;
        }
        number |= bits << shift;
        if byte < 0x80 {
            return Some(number);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_of_either_sign_stay_small() {
        for (number, unsigned) in [(0, 0), (-1, 1), (1, 2), (i64::MIN, u64::MAX)] {
            assert_eq!(zigzag(number), unsigned);
            assert_eq!(unzigzag(unsigned), number);
        }
    }

    #[test]
    fn numbers_come_back_in_as_few_bytes_as_they_need() {
        for (number, length) in [
            (0, 1),
            (127, 1),
            (128, 2),
            (16_383, 2),
            (16_384, 3),
            (u64::from(u32::MAX), 5),
            (u64::MAX, 10),
        ] {
            let mut bytes = Vec::new();
            write(&mut bytes, number);
            assert_eq!(bytes.len(), length);
            for cut in 0..length {
                assert_eq!(read(&mut &bytes[..cut]), None);
            }
            bytes.push(5);
            let mut rest = &bytes[..];
            assert_eq!(read(&mut rest), Some(number));
            assert_eq!(rest, [5]);
        }
        assert_eq!(read(&mut &[0xff; 11][..]), None);
    }
}
