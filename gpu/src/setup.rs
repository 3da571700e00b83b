//! What the faces of a batch cost in NVIDIA's primitive setup.

/// Places for vertices, filled in turn.
const SLOTS: usize = 9;
/// A place that is empty.
const EMPTY: u32 = u32::MAX;

/// The cycles of one batch: one, and for each face one for each of its vertices that is in no slot, at
/// least one. Faces name lanes.
///
/// A vertex that is in no slot takes the next one in turn that holds no vertex of the same face.
#[must_use]
pub fn cycles(faces: &[[u32; 3]]) -> u64 {
    let mut slots = [EMPTY; SLOTS];
    let mut hand = 0;
    let mut cycles = 1;
    for face in faces {
        let mut misses = 0;
        for lane in face {
            if slots.contains(lane) {
                continue;
            }
            misses += 1;
            while face.contains(&slots[hand]) {
                hand = (hand + 1) % SLOTS;
            }
            slots[hand] = *lane;
            hand = (hand + 1) % SLOTS;
        }
        cycles += misses.max(1);
    }
    cycles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_face_costs_its_misses_and_at_least_one_cycle() {
        assert_eq!(cycles(&[]), 1);
        assert_eq!(cycles(&[[0, 1, 2]; 32]), 35);
        let strip: Vec<[u32; 3]> = (0..26).map(|i| [i, i + 1, i + 2]).collect();
        assert_eq!(cycles(&strip), 1 + 3 + 25);
        // Three faces fit into nine slots, four do not.
        let disjoint = |faces: u32| (0..faces).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        assert_eq!(
            cycles(&disjoint(3).cycle().take(32).collect::<Vec<_>>()),
            1 + 9 + 29
        );
        assert_eq!(
            cycles(&disjoint(4).cycle().take(32).collect::<Vec<_>>()),
            97
        );
    }

    #[test]
    fn slots_of_the_same_face_are_passed_over() {
        // 0 to 8 fill the slots; 9 then passes over 0 and takes the slot of 1, so 0 is still there.
        let faces = [
            [0, 1, 2],
            [3, 4, 5],
            [6, 7, 8],
            [0, 9, 3],
            [0, 0, 0],
            [1, 1, 1],
        ];
        assert_eq!(cycles(&faces), 1 + 3 + 3 + 3 + 1 + 1 + 1);
        assert_eq!(
            cycles(&[[0, 1, 2], [3, 4, 5], [6, 7, 8], [0, 9, 3], [1, 2, 9]]),
            1 + 9 + 1 + 1
        );
    }
}
