//! Records moved and vertex numbers rewritten in the bytes of a storage.

use super::strided_records::StridedRecords;
use crate::permutation::FaceOrder;

/// Puts record `new_to_old[i]` at the `i`-th place; the bytes between records stay.
pub(super) fn permute(bytes: &mut [u8], records: &StridedRecords, new_to_old: &[u32]) {
    debug_assert_eq!(new_to_old.len(), records.count);
    let StridedRecords {
        start,
        stride,
        size,
        ..
    } = *records;

    // The usual sizes: copying a length that the compiler knows takes a few instructions.
    match size {
        4 => permute_sized::<4>(bytes, records, new_to_old),
        8 => permute_sized::<8>(bytes, records, new_to_old),
        12 => permute_sized::<12>(bytes, records, new_to_old),
        16 => permute_sized::<16>(bytes, records, new_to_old),
        20 => permute_sized::<20>(bytes, records, new_to_old),
        24 => permute_sized::<24>(bytes, records, new_to_old),
        32 => permute_sized::<32>(bytes, records, new_to_old),
        48 => permute_sized::<48>(bytes, records, new_to_old),
        _ => {
            let mut moved = Vec::with_capacity(records.count * size);
            for &old in new_to_old {
                moved.extend_from_slice(&bytes[start + old as usize * stride..][..size]);
            }
            for (new, record) in moved.chunks_exact(size.max(1)).enumerate() {
                bytes[start + new * stride..][..size].copy_from_slice(record);
            }
        }
    }
}

/// [`permute`] for records of `SIZE` bytes.
fn permute_sized<const SIZE: usize>(
    bytes: &mut [u8],
    records: &StridedRecords,
    new_to_old: &[u32],
) {
    debug_assert_eq!(records.size, SIZE);
    let StridedRecords { start, stride, .. } = *records;
    let record = |bytes: &[u8], i: usize| -> [u8; SIZE] {
        let record = bytes[start + i * stride..].first_chunk::<SIZE>();
        *record.expect("records are within their storage")
    };
    let moved = new_to_old.iter().map(|&old| record(bytes, old as usize));
    let moved: Vec<[u8; SIZE]> = moved.collect();

    // Without gaps all go back at once.
    if stride == SIZE {
        return bytes[start..records.end()].copy_from_slice(moved.as_flattened());
    }
    for (new, record) in moved.iter().enumerate() {
        bytes[start + new * stride..][..SIZE].copy_from_slice(record);
    }
}

/// Joins records that are adjacent in one interleaved layout, to move them together;
/// `all` is sorted.
pub(super) fn join(all: &mut Vec<StridedRecords>) {
    let mut joined: Vec<StridedRecords> = Vec::with_capacity(all.len());
    for &records in all.iter() {
        let is_beside = |last: &&mut StridedRecords| {
            let layout = (last.storage, last.count, last.stride);
            layout == (records.storage, records.count, records.stride)
                && last.start + last.size == records.start
                && last.size + records.size <= records.stride
        };
        match joined.last_mut().filter(is_beside) {
            Some(last) => last.size += records.size,
            None => joined.push(records),
        }
    }
    *all = joined;
}

/// A face order as an order of vertices, where each face is three vertices in a row.
pub(super) fn triples(order: &FaceOrder) -> Vec<u32> {
    let faces = order.new_to_old().iter().enumerate();
    let vertices = faces.flat_map(|(new, &old)| {
        let rotation = u32::from(order.rotation(new));
        [0, 1, 2].map(|corner| 3 * old + (corner + rotation) % 3)
    });
    vertices.collect()
}

/// The faces of a tight list of unsigned integers of 1, 2 or 4 bytes, three a face.
pub(super) fn faces(bytes: &[u8], records: &StridedRecords) -> Vec<[u32; 3]> {
    debug_assert_eq!(records.stride, records.size);
    let list = &bytes[records.start..records.end()];
    match records.size {
        1 => faces_of(list, |[number]: [u8; 1]| u32::from(number)),
        2 => faces_of(list, |word| u32::from(u16::from_le_bytes(word))),
        _ => faces_of(list, u32::from_le_bytes),
    }
}

/// The faces of a list whose numbers take `WIDTH` bytes each.
fn faces_of<const WIDTH: usize>(list: &[u8], number: impl Fn([u8; WIDTH]) -> u32) -> Vec<[u32; 3]> {
    let (words, _) = list.as_chunks::<WIDTH>();
    let (faces, _) = words.as_chunks::<3>();
    faces.iter().map(|face| face.map(&number)).collect()
}

/// The largest number that a list of unsigned integers can hold. glTF takes it for the restart of a
/// strip, not for a vertex.
pub(super) fn largest_number(list: &StridedRecords) -> u32 {
    debug_assert!((1..=4).contains(&list.size));
    u32::MAX >> (32 - 8 * list.size)
}

/// The vertex numbers of a tight list of unsigned integers.
pub(super) fn numbers(bytes: &[u8], records: &StridedRecords) -> Vec<u32> {
    let list = &bytes[records.start..records.end()];
    list.chunks_exact(records.size)
        .map(|chunk| {
            let mut word = [0; 4];
            word[..records.size].copy_from_slice(chunk);
            u32::from_le_bytes(word)
        })
        .collect()
}

/// Writes vertex numbers into a tight list of unsigned integers, whose type holds them all.
pub(super) fn write_numbers(
    bytes: &mut [u8],
    records: &StridedRecords,
    numbers: impl IntoIterator<Item = u32>,
) {
    let list = &mut bytes[records.start..records.end()];

    // The usual type.
    if records.size == 4 {
        let (words, _) = list.as_chunks_mut::<4>();
        let pairs = words.iter_mut().zip(numbers);
        return pairs.for_each(|(word, number)| *word = number.to_le_bytes());
    }

    for (chunk, number) in list.chunks_exact_mut(records.size).zip(numbers) {
        debug_assert!(number >> (8 * records.size) == 0, "number cut off");
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
        let records = StridedRecords {
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
    fn records_of_any_size_move_alike() {
        for size in 1..50 {
            for stride in [size, size + 3] {
                let records = StridedRecords {
                    storage: 0,
                    start: 5,
                    count: 4,
                    stride,
                    size,
                };
                let old: Vec<u8> = (0..5 + 4 * 60).collect();
                let mut bytes = old.clone();
                permute(&mut bytes, &records, &[3, 0, 2, 1]);
                let mut expected = old.clone();
                for (new, from) in [3, 0, 2, 1].into_iter().enumerate() {
                    let from = &old[5 + from * stride..][..size];
                    expected[5 + new * stride..][..size].copy_from_slice(from);
                }
                assert_eq!(bytes, expected, "{size} {stride}");
            }
        }
    }

    #[test]
    fn interleaved_neighbours_are_joined() {
        let records = |start, size| StridedRecords {
            storage: 0,
            start,
            count: 3,
            stride: 16,
            size,
        };
        let mut all = vec![
            records(0, 4),
            records(4, 8),
            records(13, 3),
            records(48, 12),
            records(60, 8),
        ];
        join(&mut all);
        assert_eq!(
            all,
            [
                records(0, 12),
                records(13, 3),
                records(48, 12),
                records(60, 8)
            ]
        );
    }

    #[test]
    fn faces_without_indices_move_three_vertices() {
        let order = FaceOrder::new(Permutation::new(vec![1, 0]).unwrap(), vec![2, 0]).unwrap();
        assert_eq!(triples(&order), [5, 3, 4, 0, 1, 2]);
    }

    #[test]
    fn numbers_keep_their_width() {
        for size in [1, 2, 4] {
            let records = StridedRecords {
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
