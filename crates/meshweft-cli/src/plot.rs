//! Misses per face over the cache size, as SVG.

use std::fmt::Write;

use meshweft::{CacheModel, cache};

/// Cache sizes of a curve.
const SIZES: [u32; 22] = [
    3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 16, 20, 24, 28, 32, 40, 48, 64, 80, 96, 128,
];
/// The colours of Okabe and Ito, which colour-blind readers can tell apart too.
const COLORS: [&str; 8] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#999999",
];

const WIDTH: f64 = 860.0;
const HEIGHT: f64 = 520.0;
const LEFT: f64 = 60.0;
const TOP: f64 = 40.0;
const PLOT_WIDTH: f64 = 520.0;
const PLOT_HEIGHT: f64 = 420.0;

/// A named line through misses per face.
pub(crate) struct Curve {
    name: String,
    acmr: Vec<f64>,
}

impl Curve {
    /// Of several meshes: their misses over their faces, together.
    pub(crate) fn new<'a>(
        name: String,
        meshes: impl Iterator<Item = &'a [[u32; 3]]> + Clone,
    ) -> Self {
        let face_count: usize = meshes.clone().map(<[_]>::len).sum();
        let acmr = |size: &u32| {
            let misses = |faces: &[[u32; 3]]| cache::misses(faces, CacheModel::fifo(*size));
            let sum: u64 = meshes.clone().map(misses).sum();
            sum as f64 / face_count.max(1) as f64
        };
        Self {
            name,
            acmr: SIZES.iter().map(acmr).collect(),
        }
    }
}

/// The curves in one picture. No figure is above 3, the misses of a face without any hit.
pub(crate) fn svg(title: &str, curves: &[Curve]) -> String {
    let greatest = curves.iter().flat_map(|curve| &curve.acmr).copied();
    let greatest = greatest.fold(1.0, f64::max);
    let top = (greatest * 5.0).ceil() / 5.0;

    // Scales: sizes by their logarithm.
    let (least, most) = (
        f64::from(SIZES[0]).ln(),
        f64::from(SIZES[SIZES.len() - 1]).ln(),
    );
    let x = |size: u32| LEFT + (f64::from(size).ln() - least) / (most - least) * PLOT_WIDTH;
    let y = |acmr: f64| TOP + (1.0 - (acmr - BOTTOM) / (top - BOTTOM)) * PLOT_HEIGHT;

    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{LEFT}\" y=\"20\" font-size=\"14\">{}</text>\n",
        escaped(title)
    );
    let mut line = |text: String| {
        svg += &text;
        svg.push('\n');
    };

    let (right, foot) = (LEFT + PLOT_WIDTH, TOP + PLOT_HEIGHT);

    // Horizontal lines of the grid: every 0.1, or every 0.5 where those are too many.
    let steps = ((top - BOTTOM) * 10.0).round();
    let every = if steps > 15.0 { 5.0 } else { 1.0 };
    let mut step = 0.0;
    while step <= steps {
        let acmr = BOTTOM + step / 10.0;
        let y = y(acmr);
        line(format!(
            "<path d=\"M{LEFT} {y:.1}H{right}\" stroke=\"#ddd\"/>\
             <text x=\"{:.0}\" y=\"{:.1}\" text-anchor=\"end\">{acmr:.1}</text>",
            LEFT - 6.0,
            y + 4.0
        ));
        step += every;
    }

    // Vertical lines of the grid.
    for size in [3, 4, 6, 8, 10, 12, 16, 24, 32, 48, 64, 96, 128] {
        let x = x(size);
        line(format!(
            "<path d=\"M{x:.1} {TOP}V{foot}\" stroke=\"#eee\"/>\
             <text x=\"{x:.1}\" y=\"{:.0}\" text-anchor=\"middle\">{size}</text>",
            foot + 16.0
        ));
    }

    // Names of the axes.
    line(format!(
        "<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"middle\">FIFO cache size in vertices</text>\n\
         <text transform=\"translate(16 {:.0}) rotate(-90)\" text-anchor=\"middle\">misses per face \
         (ACMR)</text>",
        LEFT + PLOT_WIDTH / 2.0,
        foot + 36.0,
        TOP + PLOT_HEIGHT / 2.0
    ));

    // Curves and their legend.
    for (i, curve) in curves.iter().enumerate() {
        let color = COLORS[i % COLORS.len()];
        // When the colours run out, they are used again with dashes.
        let dashes = match i / COLORS.len() {
            0 => String::new(),
            n => format!(" stroke-dasharray=\"{}\"", 3 * n),
        };
        let mut points = String::new();
        for (&size, &acmr) in SIZES.iter().zip(&curve.acmr) {
            write!(points, " {:.1},{:.1}", x(size), y(acmr)).expect("a string takes all");
        }

        let row = TOP + 14.0 + 18.0 * i as f64;
        line(format!(
            "<polyline fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"{dashes} points=\"{}\"/>\n\
             <path d=\"M{:.0} {:.0}h24\" stroke=\"{color}\" stroke-width=\"2\"{dashes}/>\
             <text x=\"{:.0}\" y=\"{row:.0}\">{}</text>",
            points.trim_start(),
            right + 14.0,
            row - 4.0,
            right + 44.0,
            escaped(&curve.name)
        ));
    }
    svg + "</svg>\n"
}

/// No closed mesh has fewer misses per face.
const BOTTOM: f64 = 0.5;

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_for_each_name() {
        let faces = [[0, 1, 2], [2, 1, 3], [0, 1, 2]];
        let curve = |name: &str| Curve::new(name.to_owned(), [&faces[..]].into_iter());
        assert_eq!(curve("").acmr[1], 4.0 / 3.0);
        let names = ["a<b", "c & d"];
        let svg = svg("two", &names.map(curve));
        assert_eq!(svg.matches("<polyline").count(), 2);
        assert!(svg.contains(">a&lt;b<") && svg.contains(">c &amp; d<"));
        assert_eq!(svg.matches("<svg").count(), svg.matches("</svg>").count());
    }
}
