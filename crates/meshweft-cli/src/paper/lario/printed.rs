//! What the paper printed.

/// A row of table 1, with what tables 2 and 3 have of it.
pub(super) struct PrintedModel {
    pub(super) mesh: &'static str,
    pub(super) vertices: usize,
    pub(super) faces: usize,
    /// The files that are looked for.
    pub(super) files: &'static [&'static str],
    /// Table 2: inserts of first available, LRU and LRU with the queue, for each path.
    pub(super) inserts: Option<[[u64; 3]; 3]>,
    /// Table 3: how much faster than immediate mode the rendering stage is with a standard vertex array and with these three,
    /// for each path.
    pub(super) speed_ups: [[f64; 4]; 3],
}

#[rustfmt::skip]
pub(super) const MODELS: [PrintedModel; 3] = [
    PrintedModel {
        mesh: "hand", vertices: 327_323, faces: 654_666, files: &["hand"], inserts: None,
        speed_ups: [[1.07, 2.25, 3.07, 3.06], [1.05, 2.29, 2.92, 2.91], [1.05, 2.31, 2.95, 2.95]],
    },
    PrintedModel {
        mesh: "dragon", vertices: 437_645, faces: 871_414, files: &["dragon"], inserts: None,
        speed_ups: [[1.06, 1.97, 2.69, 2.66], [1.05, 2.12, 2.83, 2.8], [1.05, 2.12, 2.76, 2.76]],
    },
    PrintedModel {
        mesh: "happy", vertices: 543_652, faces: 1_087_716, files: &["happy", "happy_buddha", "buddha", "buddha_123k"],
        inserts: Some([[322_353, 228_694, 200_126], [329_214, 63_465, 63_465], [102_097, 64_688, 64_690]]),
        speed_ups: [[1.07, 2.14, 2.97, 2.92], [1.07, 2.21, 2.89, 2.88], [1.07, 2.13, 2.79, 2.78]],
    },
];

/// The paper's tolerance in pixels.
pub(super) const TOLERANCE: f64 = 1.5;

/// The paper's terrain.
pub(super) struct PrintedGround {
    pub(super) name: &'static str,
    pub(super) vertices: usize,
    /// Tiles of the same place that are looked for.
    pub(super) files: &'static [&'static str],
    /// Table 4: inserts of first available, LRU and LRU with the queue, for each path.
    pub(super) inserts: [[u64; 3]; 3],
    /// Table 5: how much faster the rendering stage is with these three, for each path.
    pub(super) faster: [[f64; 3]; 3],
}

#[rustfmt::skip]
pub(super) const GROUND: PrintedGround = PrintedGround {
    name: "Puget Sound", vertices: 2_563_548, files: &["N47W122", "N47W123", "N48W123"],
    inserts: [[171_873, 169_928, 169_972], [302_288, 286_331, 281_707], [290_747, 66_453, 66_436]],
    faster: [[2.68, 1.69, 1.13], [2.7, 1.65, 1.06], [2.71, 2.24, 1.9]],
};
