//! What Lin and Yu printed.

/// A row of Fig. 3: misses per face at a cache of 12.
pub(super) struct Printed {
    pub(super) mesh: &'static str,
    pub(super) vertices: usize,
    pub(super) faces: usize,
    pub(super) random: f64,
    pub(super) original: f64,
    pub(super) bog: f64,
    pub(super) hoppe: f64,
    pub(super) fifo: f64,
    pub(super) control: f64,
    /// Names that a file of this mesh, or of another version of it, may have.
    pub(super) files: &'static [&'static str],
}

const fn row(
    mesh: &'static str,
    [vertices, faces]: [usize; 2],
    [random, original, bog, hoppe, fifo, control]: [f64; 6],
    files: &'static [&'static str],
) -> Printed {
    Printed {
        mesh,
        vertices,
        faces,
        random,
        original,
        bog,
        hoppe,
        fifo,
        control,
        files,
    }
}

/// Fig. 3.
#[rustfmt::skip]
pub(super) const FIG_3: [Printed; 30] = [
    row("chain", [240, 480], [2.883, 0.575, 0.721, 0.575, 0.588, 0.500], &["chain"]),
    row("dolphin", [287, 563], [2.874, 0.950, 0.787, 0.698, 0.650, 0.602], &["dolphin"]),
    row("sphere", [380, 756], [2.931, 1.029, 0.765, 0.631, 0.590, 0.611], &["sphere"]),
    row("venus", [711, 1419], [2.958, 0.963, 0.764, 0.691, 0.655, 0.600], &["venus", "venus_711"]),
    row("eight", [766, 1536], [2.962, 0.878, 0.803, 0.663, 0.633, 0.635], &["eight"]),
    row("torus", [800, 1600], [2.966, 1.388, 0.794, 0.648, 0.613, 0.611], &["torus"]),
    row("teapot", [2022, 3751], [2.986, 1.010, 0.755, 0.665, 0.648, 0.631], &["teapot"]),
    row("shape", [2562, 5120], [2.987, 0.906, 0.794, 0.617, 0.589, 0.639], &["shape", "icosphere4"]),
    row("beethoven", [2655, 5028], [2.990, 0.975, 0.779, 0.697, 0.658, 0.637], &["beethoven"]),
    row("cow", [3066, 5804], [2.993, 1.007, 0.794, 0.674, 0.652, 0.635], &["cow"]),
    row("cat", [3644, 7163], [2.991, 1.500, 0.768, 0.709, 0.664, 0.629], &["cat"]),
    row("female-torso", [4654, 9095], [2.992, 1.787, 0.783, 0.657, 0.640, 0.629], &["female-torso"]),
    row("distcap", [6253, 12339], [2.995, 1.535, 0.770, 0.688, 0.650, 0.625], &["distcap"]),
    row("fandisk", [6475, 12946], [2.996, 1.023, 0.794, 0.640, 0.625, 0.625], &["fandisk"]),
    row("zahn-a", [6586, 13168], [2.994, 2.051, 0.748, 0.732, 0.646, 0.583], &["zahn-a"]),
    row("blob", [8036, 16068], [2.998, 1.072, 0.784, 0.662, 0.640, 0.617], &["blob", "standingblob"]),
    row("mannequin", [11704, 23402], [2.998, 0.935, 0.794, 0.636, 0.619, 0.616], &["mannequin"]),
    row("face", [12530, 24118], [2.997, 1.366, 0.788, 0.694, 0.657, 0.644], &["face"]),
    row("dinosaur", [14070, 28136], [2.998, 2.853, 0.765, 0.654, 0.652, 0.610], &["dinosaur"]),
    row("aircraft-f14", [15111, 29261], [2.998, 1.020, 0.788, 0.644, 0.634, 0.632], &["aircraft-f14"]),
    row("toilet", [22926, 45864], [2.999, 2.883, 0.763, 0.710, 0.650, 0.612], &["toilet"]),
    row("david", [24085, 47753], [2.999, 2.430, 0.766, 0.720, 0.655, 0.617], &["david"]),
    row("sculpture", [25386, 50780], [2.999, 2.941, 0.766, 0.701, 0.649, 0.609], &["sculpture"]),
    row("foot", [25845, 51690], [2.999, 1.129, 0.785, 0.637, 0.623, 0.630], &["foot"]),
    row("skull", [33419, 65244], [2.999, 1.828, 0.781, 0.661, 0.642, 0.643], &["skull"]),
    row("bunny", [35947, 69451], [2.999, 2.085, 0.789, 0.641, 0.628, 0.635], &["bunny"]),
    row("horse", [48485, 96966], [2.998, 2.777, 0.786, 0.657, 0.630, 0.631], &["horse"]),
    row("feline", [49864, 99732], [2.954, 1.376, 0.772, 0.692, 0.649, 0.621], &["feline"]),
    row("dragon", [437_645, 871_414], [2.747, 1.725, 0.762, 0.708, 0.653, 0.616], &["dragon"]),
    row("buddha", [543_652, 1_087_716], [2.732, 1.656, 0.759, 0.709, 0.651, 0.610], &["buddha", "buddha_123k"]),
];

/// Cache sizes of Fig. 6.
pub(super) const FIG_6_SIZES: [u32; 8] = [10, 12, 16, 24, 32, 64, 96, 128];

/// Fig. 6: seconds of K-Cache-Reorder for a FIFO cache, on an AMD Athlon of 2.09 GHz.
#[rustfmt::skip]
#[expect(clippy::approx_constant, reason = "3.14 seconds is what the paper prints")]
pub(super) const FIG_6: [(&str, [f64; 8]); 15] = [
    ("dolphin", [0.02, 0.02, 0.03, 0.02, 0.03, 0.02, 0.03, 0.03]),
    ("venus", [0.03, 0.03, 0.03, 0.05, 0.06, 0.11, 0.13, 0.16]),
    ("teapot", [0.08, 0.06, 0.09, 0.13, 0.16, 0.22, 0.24, 0.25]),
    ("shape", [0.11, 0.14, 0.20, 0.28, 0.34, 0.72, 1.38, 1.41]),
    ("beethoven", [0.09, 0.11, 0.16, 0.19, 0.25, 0.42, 0.58, 0.73]),
    ("cow", [0.11, 0.14, 0.17, 0.23, 0.28, 0.52, 0.67, 0.95]),
    ("blob", [0.34, 0.44, 0.55, 0.70, 0.92, 1.77, 2.80, 3.69]),
    ("mannequin", [0.53, 0.67, 0.88, 1.19, 1.58, 3.14, 4.92, 6.69]),
    ("face", [0.59, 0.73, 0.88, 1.03, 1.30, 2.41, 3.61, 5.06]),
    ("dinosaur", [0.70, 0.83, 1.02, 1.19, 1.48, 2.70, 3.69, 4.66]),
    ("david", [1.92, 2.20, 2.05, 2.39, 2.73, 4.66, 7.02, 9.52]),
    ("bunny", [2.38, 3.03, 3.16, 3.92, 4.70, 8.94, 14.47, 20.31]),
    ("horse", [3.23, 4.14, 4.28, 5.20, 6.42, 11.34, 18.05, 24.02]),
    ("dragon", [181.83, 194.06, 179.83, 149.69, 133.69, 140.42, 166.53, 205.44]),
    ("buddha", [279.64, 274.56, 238.66, 183.86, 167.25, 155.48, 199.63, 248.77]),
];

/// Cache sizes of Figs. 7 and 10.
pub(super) const SIZES: [u32; 6] = [10, 12, 16, 24, 32, 64];

/// Fig. 7: means over the paper's 30 meshes, FIFO and controllable.
pub(super) const FIG_7: [[f64; 6]; 2] = [
    [0.664, 0.638, 0.606, 0.579, 0.566, 0.543],
    [0.635, 0.618, 0.594, 0.571, 0.557, 0.536],
];

/// Fig. 9: mean, least, most and standard deviation over 20 first focus vertices.
pub(super) const FIG_9: [(&str, [f64; 4]); 5] = [
    ("venus", [0.65528, 0.653_277, 0.655_391, 0.000_485]),
    ("cow", [0.652_028, 0.65162, 0.654_721, 0.000_701]),
    ("mannequin", [0.619_322, 0.619_178, 0.621_913, 0.000_627]),
    ("bunny", [0.628_079, 0.628_054, 0.628_126, 2.48e-5]),
    ("dragon", [0.653_256, 0.653_158, 0.654_203, 0.000_23]),
];

/// Percent of the vertices in use that are left in the rows of Fig. 12.
pub(super) const FIG_12_PERCENT: [usize; 3] = [80, 50, 20];

/// What a sequence update has to do up to a level.
pub(super) struct Work {
    /// Deleted vertices, deleted faces, inserted faces.
    pub(super) counts: [usize; 3],
    /// For the update, from full resolution.
    pub(super) seconds: f64,
    /// For a new order of the level; the paper has no such column.
    pub(super) new_order: Option<f64>,
}

const fn work(counts: [usize; 3], seconds: f64) -> Work {
    Work {
        counts,
        seconds,
        new_order: None,
    }
}

/// Fig. 12: the adaptive update.
#[rustfmt::skip]
pub(super) const FIG_12: [(&str, [Work; 3]); 4] = [
    ("cow", [
        work([581, 3475, 2315], 0.016), work([1467, 8618, 5716], 0.047), work([2389, 13487, 8844], 0.047),
    ]),
    ("mannequin", [
        work([2340, 13644, 8964], 0.078), work([5851, 33369, 21667], 0.14), work([9361, 52306, 33584], 0.203),
    ]),
    ("bunny", [
        work([6957, 41195, 27304], 0.266), work([17377, 102_464, 67738], 0.469),
        work([27811, 162_469, 106_908], 0.687),
    ]),
    ("buddha", [
        work([108_772, 598_959, 381_415], 4.484), work([271_929, 1_505_322, 961_464], 7.688),
        work([435_086, 2_401_098, 1_530_926], 11.406),
    ]),
];
