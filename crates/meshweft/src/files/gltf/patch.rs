//! Records moved and vertex numbers rewritten in the bytes of a storage.

use super::records::Records;
use crate::permutation::FaceOrder;

/// Puts record `new_to_old[i]` at the `i`-th place; the bytes between records stay.
pub(super) fn permute(bytes: &mut [u8], records: &Records, new_to_old: &[u32]) {
    let Records {
        start,
        stride,
        size,
        ..
    } = *records;
    let mut old = Vec::with_capacity(records.count * size);
    for i in 0..records.count {
        old.extend_from_slice(&bytes[start + i * stride..][..size]);
    }
    for (new, &from) in new_to_old.iter().enumerate() {
        let from = from as usize * size;
        bytes[start + new * stride..][..size].copy_from_slice(&old[from..from + size]);
    }
}

/// The vertex order that draws the faces of `order` where each face is three vertices in a row.
pub(super) fn triples(order: &FaceOrder) -> Vec<u32> {
    let old_faces = order.new_to_old().iter().enumerate();
    old_faces
        .flat_map(|(new, &old)| {
            let rotation = u32::from(order.rotation(new));
            [0, 1, 2].map(|corner| 3 * old + (corner + rotation) % 3)
        })
        .collect()
}

/// The vertex numbers of a tight list of unsigned integers.
pub(super) fn numbers(bytes: &[u8], records: &Records) -> Vec<u32> {
    let list = &bytes[records.start..records.end()];
    list.chunks_exact(records.size)
        .map(|chunk| {
            let mut word = [0; 4];
            word[..records.size].copy_from_slice(chunk);
            u32::from_le_bytes(word)
        })
        .collect()
}

/// Writes vertex numbers into a tight list of unsigned integers, which is wide enough for them.
pub(super) fn write_numbers(
    bytes: &mut [u8],
    records: &Records,
    numbers: impl IntoIterator<Item = u32>,
) {
    let list = &mut bytes[records.start..records.end()];
    for (chunk, number) in list.chunks_exact_mut(records.size).zip(numbers) {
        debug_assert!(records.size == 4 || number >> (8 * records.size) == 0);
        chunk.copy_from_slice(&number.to_le_bytes()[..records.size]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Permutation;

    #[test]
    fn bytes_between_records_stay() {
        let mut bytes = *b"..aa-bb-cc--";
        let records = Records {
            storage: 0,
            start: 2,
            count: 3,
            stride: 3,
            size: 2,
        };
        permute(&mut bytes, &records, &[2, 0, 1]);
        assert_eq!(&bytes, b"..cc-aa-bb--");
    }

    #[test]
    fn faces_without_indices_move_three_vertices() {
        let order = FaceOrder::new(Permutation::new(vec![1, 0]).unwrap(), vec![2, 0]).unwrap();
        assert_eq!(triples(&order), [5, 3, 4, 0, 1, 2]);
    }

    #[test]
    fn numbers_keep_their_width() {
        for size in [1, 2, 4] {
            let records = Records {
                storage: 0,
                start: 1,
                count: 3,
                stride: size,
                size,
            };
            let mut bytes = vec![0xEE; 3 * size + 2];
            write_numbers(&mut bytes, &records, [7, 0, 254]);
            assert_eq!(numbers(&bytes, &records), [7, 0, 254]);
            assert_eq!((bytes[0], bytes[3 * size + 1]), (0xEE, 0xEE));
        }
    }
}
