//! The set of bytes against a plain one of flags.

use super::*;

fn bytes(start: u64, end: u64) -> FileBytes {
    let file = 0;
    FileBytes { file, start, end }
}

fn place(byte: u64) -> usize {
    usize::try_from(byte).unwrap()
}

#[test]
fn a_set_of_bytes_is_what_flags_say() {
    let mut random = crate::random::SplitMix64(3);
    let mut below = |bound: usize| random.below(bound);
    for _ in 0..200 {
        let (mut set, mut flags) = (Fetched::default(), [false; 64]);
        for _ in 0..8 {
            let start = below(60);
            let range = bytes(start as u64, (start + 1 + below(64 - start)) as u64);
            let mut missing = Vec::new();
            set.missing_of(range, |bytes| missing.extend(bytes.start..bytes.end));
            let expected = (range.start..range.end).filter(|&byte| !flags[place(byte)]);
            assert_eq!(missing, expected.collect::<Vec<u64>>());

            set.add(range);
            (range.start..range.end).for_each(|byte| flags[place(byte)] = true);
            let found = set.ends.iter().flat_map(|(&(_, start), &end)| start..end);
            let found: Vec<u64> = found.collect();
            let expected: Vec<u64> = (0..64).filter(|&byte| flags[place(byte)]).collect();
            assert_eq!(found, expected);
            assert_eq!(set.length(), expected.len() as u64);
            let pairs = set.ends.iter().zip(set.ends.iter().skip(1));
            assert!(
                pairs.clone().all(|((_, end), ((_, next), _))| end < next),
                "none touch"
            );
        }
    }
}

#[test]
fn ranges_that_are_close_are_one() {
    let mut set = Fetched::default();
    for range in [bytes(0, 10), bytes(14, 20), bytes(20, 21), bytes(26, 30)] {
        set.add(range);
    }
    set.add(FileBytes {
        file: 1,
        start: 31,
        end: 40,
    });
    let joined_within = |gap, most_waste| {
        set.joined(&LevelRangesOptions { gap, most_waste })
            .iter()
            .map(|it| (it.file, it.start, it.end))
            .collect::<Vec<_>>()
    };
    let joined = |gap| joined_within(gap, f64::INFINITY);
    assert_eq!(
        joined(0),
        [(0, 0, 10), (0, 14, 21), (0, 26, 30), (1, 31, 40)]
    );
    assert_eq!(joined(4), joined(0));
    assert_eq!(joined(5), [(0, 0, 21), (0, 26, 30), (1, 31, 40)]);
    assert_eq!(joined(6), [(0, 0, 30), (1, 31, 40)]);

    // 30 bytes, and 4 or 9 between them.
    assert_eq!(joined_within(6, 8.9 / 30.0), joined(5));
    assert_eq!(joined_within(6, 9.1 / 30.0), joined(6));
    assert_eq!(joined_within(6, 0.1), joined(0));
}
