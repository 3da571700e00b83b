//! What the paper printed.

/// A row of tables 1, 2 and 4.
pub(super) struct Printed {
    pub(super) mesh: &'static str,
    pub(super) faces: usize,
    /// Table 1, in seconds.
    pub(super) seconds: f64,
    /// Table 2: of all faces, back faces and those that are left out, in percent.
    pub(super) back: u32,
    pub(super) culled: u32,
    /// Table 4: how much longer a frame takes without the method, in percent.
    pub(super) improvement: f64,
    /// The files that are looked for; none for the sphere, which is made here.
    pub(super) files: &'static [&'static str],
}

impl Printed {
    /// The share of the back faces that is left out.
    pub(super) fn culled_of_back(&self) -> f64 {
        f64::from(self.culled) / f64::from(self.back)
    }
}

#[rustfmt::skip]
pub(super) const MESHES: [Printed; 11] = [
    Printed { mesh: "Spot", faces: 5856, seconds: 0.356, back: 56, culled: 38, improvement: -9.8, files: &["spot"] },
    Printed { mesh: "Vase", faces: 21312, seconds: 0.381, back: 50, culled: 42, improvement: -6.7, files: &["vase", "vase_lion"] },
    Printed { mesh: "Venus", faces: 39569, seconds: 0.436, back: 58, culled: 42, improvement: 81.5, files: &["venus", "venus_bust"] },
    Printed { mesh: SPHERE, faces: 65024, seconds: 0.533, back: 54, culled: 33, improvement: 51.8, files: &[] },
    Printed { mesh: "Bunny", faces: 69630, seconds: 0.515, back: 49, culled: 47, improvement: 87.6, files: &["bunny_filled", "bunny_clean", "bunny"] },
    Printed { mesh: "Armadillo", faces: 212574, seconds: 0.879, back: 52, culled: 40, improvement: 105.3, files: &["armadillo"] },
    Printed { mesh: "Hand", faces: 654666, seconds: 2.046, back: 52, culled: 40, improvement: 65.6, files: &["hand"] },
    Printed { mesh: "Dragon", faces: 871414, seconds: 2.589, back: 47, culled: 35, improvement: 62.4, files: &["dragon"] },
    Printed { mesh: "Venus & Cupid", faces: 960026, seconds: 2.878, back: 49, culled: 38, improvement: 72.5, files: &["venus_and_cupid", "venus_cupid"] },
    Printed { mesh: "Buddha", faces: 1087451, seconds: 3.110, back: 46, culled: 35, improvement: 63.3, files: &["buddha", "happy_buddha", "buddha_123k"] },
    Printed { mesh: "Demon", faces: 1363152, seconds: 3.967, back: 54, culled: 44, improvement: 88.2, files: &["demon"] },
];

/// The mesh that is made here.
pub(super) const SPHERE: &str = "Sphere";

/// A row of Table 3.
pub(super) struct PrintedSphere {
    pub(super) faces: &'static str,
    /// Of a sphere with about so many faces.
    pub(super) rings: u32,
    pub(super) around: u32,
    /// Milliseconds for 125 spheres, without the method, and with 2, 4, 8, … stripes.
    pub(super) conventional: f64,
    pub(super) by_stripes: &'static [f64],
}

impl PrintedSphere {
    pub(super) fn face_count(&self) -> usize {
        2 * (self.rings as usize - 1) * self.around as usize
    }
}

#[rustfmt::skip]
#[expect(clippy::approx_constant, reason = "6.28 milliseconds")]
pub(super) const SPHERES: [PrintedSphere; 6] = [
    PrintedSphere { faces: "1080", rings: 16, around: 36, conventional: 3.59, by_stripes: &[4.0, 4.35, 5.11, 6.43] },
    PrintedSphere { faces: "3968", rings: 32, around: 64, conventional: 3.68, by_stripes: &[4.04, 4.34, 4.98, 6.28] },
    PrintedSphere { faces: "16K", rings: 64, around: 128, conventional: 3.6, by_stripes: &[3.96, 4.27, 4.93, 6.24, 8.86] },
    PrintedSphere { faces: "65K", rings: 128, around: 256, conventional: 9.94, by_stripes: &[7.40, 7.21, 6.70, 6.46, 8.92] },
    PrintedSphere { faces: "261K", rings: 256, around: 512, conventional: 37.1, by_stripes: &[28.15, 27.77, 26.88, 25.19, 22.76, 25.47] },
    PrintedSphere { faces: "1056K", rings: 514, around: 1029, conventional: 148.54, by_stripes: &[110.2, 102.6, 104.3, 100.45, 95.18, 86.72, 83.94, 80.8] },
];
