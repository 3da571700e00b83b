//! What the paper printed.

use meshweft::connectivity::Membership::{self, Left, List, Previous};

/// A row of Table 1.
pub(super) struct Printed {
    pub(super) mesh: &'static str,
    /// Vertices and faces.
    pub(super) size: [usize; 2],
    pub(super) bits_per_face: f64,
    /// The required buffer size b, and C = b / √V.
    pub(super) buffer: usize,
    pub(super) constant: f64,
    pub(super) files: &'static [&'static str],
}

/// None of these files is to be had in the paper's version; the nearest ones are looked for.
#[rustfmt::skip]
pub(super) const TABLE_1: [Printed; 6] = [
    Printed { mesh: "Ronny", size: [2486, 4968], bits_per_face: 2.165, buffer: 100, constant: 2.006, files: &["ronny"] },
    Printed { mesh: "Bunny", size: [7124, 13784], bits_per_face: 2.154, buffer: 164, constant: 1.943, files: &["bunny_7k", "bunny_res2"] },
    Printed { mesh: "Venus", size: [2838, 5668], bits_per_face: 2.302, buffer: 84, constant: 1.577, files: &["venus", "venus_711"] },
    Printed { mesh: "Mannequin", size: [2732, 5420], bits_per_face: 2.307, buffer: 117, constant: 2.238, files: &["mannequin"] },
    Printed { mesh: "Horse", size: [11135, 22258], bits_per_face: 2.048, buffer: 120, constant: 1.137, files: &["horse_11k", "horse_20k"] },
    Printed { mesh: "Crocodile", size: [17332, 34404], bits_per_face: 2.479, buffer: 245, constant: 1.861, files: &["crocodile"] },
];

/// Meshes that others use today.
pub(super) const OTHERS: [&str; 7] = [
    "cow_poly",
    "spot",
    "fandisk",
    "bunny_clean",
    "horse",
    "nefertiti",
    "dragon",
];

/// Fig. 1 in the order of Table 2, with its memberships.
pub(super) const TABLE_2: [([u32; 3], Membership); 17] = [
    ([0, 1, 2], List),
    ([0, 2, 3], List),
    ([0, 3, 4], List),
    ([0, 4, 5], List),
    ([0, 5, 6], List),
    ([0, 6, 1], List),
    ([1, 6, 7], Previous),
    ([1, 7, 8], List),
    ([1, 8, 2], List),
    ([2, 8, 9], Previous),
    ([2, 9, 3], List),
    ([3, 9, 4], Previous),
    ([4, 9, 10], Previous),
    ([4, 10, 11], List),
    ([4, 11, 12], List),
    ([4, 12, 5], List),
    ([5, 7, 6], Left),
];
