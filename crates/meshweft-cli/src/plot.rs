//! Curves as SVG: misses per face over the cache size, and over the faces of levels.

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

/// A named line.
pub(crate) struct Curve {
    name: String,
    /// From left to right.
    points: Vec<[f64; 2]>,
}

impl Curve {
    /// A line through these points, from left to right.
    pub(crate) fn new(name: String, points: Vec<[f64; 2]>) -> Self {
        Self { name, points }
    }

    /// Leaves out the points without a height.
    pub(crate) fn leave_out_zeros(&mut self) {
        self.points.retain(|point| point[1] > 0.0);
    }

    /// Misses per face over the cache size, of several meshes: their misses over their faces, together.
    pub(crate) fn of_cache_sizes<'a>(
        name: String,
        meshes: impl Iterator<Item = &'a [[u32; 3]]> + Clone,
    ) -> Self {
        let face_count: usize = meshes.clone().map(<[_]>::len).sum();
        let point = |size: u32| {
            let misses = |faces: &[[u32; 3]]| cache::misses(faces, CacheModel::fifo(size));
            let sum: u64 = meshes.clone().map(misses).sum();
            [f64::from(size), sum as f64 / face_count.max(1) as f64]
        };
        Self::new(name, SIZES.map(point).to_vec())
    }
}

/// One direction of a plot.
pub(crate) struct Axis {
    name: &'static str,
    low: f64,
    high: f64,
    /// By the logarithm.
    is_log: bool,
    /// Lines of the grid, with their labels.
    ticks: Vec<(f64, String)>,
}

impl Axis {
    /// The sizes of caches.
    pub(crate) fn of_cache_sizes() -> Self {
        let ticks = [3, 4, 6, 8, 10, 12, 16, 24, 32, 48, 64, 96, 128];
        Self {
            name: "FIFO cache size in vertices",
            low: f64::from(SIZES[0]),
            high: f64::from(SIZES[SIZES.len() - 1]),
            is_log: true,
            ticks: ticks
                .map(|size| (f64::from(size), size.to_string()))
                .to_vec(),
        }
    }

    /// Misses per face, of these curves. No figure is above 3, the misses of a face without any hit.
    pub(crate) fn of_misses(curves: &[Curve]) -> Self {
        let greatest = values(curves, 1).fold(1.0, f64::max);
        let high = (greatest * 5.0).ceil() / 5.0;

        // Every 0.1, or every 0.5 where those are too many.
        let steps = ((high - BOTTOM) * 10.0).round();
        let every = if steps > 15.0 { 5.0 } else { 1.0 };
        let mut ticks = Vec::new();
        let mut step = 0.0;
        while step <= steps {
            let acmr = BOTTOM + step / 10.0;
            ticks.push((acmr, format!("{acmr:.1}")));
            step += every;
        }
        Self {
            name: "misses per face (ACMR)",
            low: BOTTOM,
            high,
            is_log: false,
            ticks,
        }
    }

    /// From 0 to 1, or as far as the curves go.
    pub(crate) fn of_shares(name: &'static str, curves: &[Curve]) -> Self {
        let greatest = values(curves, 1).fold(1.0, f64::max);
        let tenths = (10.0 * greatest).ceil();
        let mut ticks = Vec::new();
        let mut tenth = 0.0;
        while tenth <= tenths {
            let share = tenth / 10.0;
            ticks.push((share, format!("{share:.1}")));
            tenth += 1.0;
        }
        Self {
            name,
            low: 0.0,
            high: tenths / 10.0,
            is_log: false,
            ticks,
        }
    }

    /// Numbers from 0 to below a count.
    pub(crate) fn of_numbers(name: &'static str, count: usize) -> Self {
        let high = count.max(2) as f64 - 1.0;
        // Steps of 1, 2 or 5 in their first digit, ten at most.
        let decade = 10_f64.powf((high / 10.0).log10().floor().max(0.0));
        let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade);
        let step = steps.into_iter().find(|step| high / step <= 10.0);
        let step = step.unwrap_or(10.0 * decade);
        let mut ticks = Vec::new();
        let mut value = 0.0;
        while value <= high {
            ticks.push((value, format!("{value}")));
            value += step;
        }
        Self {
            name,
            low: 0.0,
            high,
            is_log: false,
            ticks,
        }
    }

    /// Whole decades around one coordinate of these curves.
    pub(crate) fn of_decades(name: &'static str, curves: &[Curve], coordinate: usize) -> Self {
        let found = || values(curves, coordinate).filter(|value| *value > 0.0);
        let low = found().fold(f64::INFINITY, f64::min);
        let low = if low.is_finite() { low } else { 1.0 };
        let high = found().fold(low, f64::max);
        let (first, last) = (
            low.log10().floor(),
            high.log10().ceil().max(low.log10().floor() + 1.0),
        );
        let mut ticks = Vec::new();
        let mut decade = first;
        while decade <= last {
            let value = 10_f64.powf(decade);
            ticks.push((value, format!("{value}")));
            decade += 1.0;
        }
        Self {
            name,
            low: 10_f64.powf(first),
            high: 10_f64.powf(last),
            is_log: true,
            ticks,
        }
    }

    /// Where a value is, from 0 to 1.
    fn place(&self, value: f64) -> f64 {
        let scale = |value: f64| if self.is_log { value.ln() } else { value };
        let value = value.max(self.low);
        (scale(value) - scale(self.low)) / (scale(self.high) - scale(self.low))
    }
}

fn values(curves: &[Curve], coordinate: usize) -> impl Iterator<Item = f64> {
    let points = curves.iter().flat_map(|curve| &curve.points);
    points.map(move |point| point[coordinate])
}

/// The curves in one picture.
pub(crate) fn svg(title: &str, [across, up]: &[Axis; 2], curves: &[Curve]) -> String {
    let x = |value: f64| LEFT + across.place(value) * PLOT_WIDTH;
    let y = |value: f64| TOP + (1.0 - up.place(value)) * PLOT_HEIGHT;

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

    // The grid.
    for (value, label) in &up.ticks {
        let y = y(*value);
        line(format!(
            "<path d=\"M{LEFT} {y:.1}H{right}\" stroke=\"#ddd\"/>\
             <text x=\"{:.0}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
            LEFT - 6.0,
            y + 4.0
        ));
    }
    for (value, label) in &across.ticks {
        let x = x(*value);
        line(format!(
            "<path d=\"M{x:.1} {TOP}V{foot}\" stroke=\"#eee\"/>\
             <text x=\"{x:.1}\" y=\"{:.0}\" text-anchor=\"middle\">{label}</text>",
            foot + 16.0
        ));
    }

    // Names of the axes.
    line(format!(
        "<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"middle\">{}</text>\n\
         <text transform=\"translate(16 {:.0}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        LEFT + PLOT_WIDTH / 2.0,
        foot + 36.0,
        across.name,
        TOP + PLOT_HEIGHT / 2.0,
        up.name
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
        for &[across, up] in &curve.points {
            write!(points, " {:.1},{:.1}", x(across), y(up)).expect("a string takes all");
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

/// Two pictures, one below the other.
pub(crate) fn stacked(upper: &str, lower: &str) -> String {
    let placed = |picture: &str, row: f64| {
        let place = format!(
            "<svg y=\"{}\" width=\"{WIDTH}\" height=\"{HEIGHT}\"",
            row * HEIGHT
        );
        picture.replacen("<svg", &place, 1)
    };
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {}\">\n{}{}</svg>\n",
        2.0 * HEIGHT,
        placed(upper, 0.0),
        placed(lower, 1.0)
    )
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
        let curve = |name: &str| Curve::of_cache_sizes(name.to_owned(), [&faces[..]].into_iter());
        assert_eq!(curve("").points[1], [4.0, 4.0 / 3.0]);
        let curves = ["a<b", "c & d"].map(curve);
        let axes = [Axis::of_cache_sizes(), Axis::of_misses(&curves)];
        let svg = svg("two", &axes, &curves);
        assert_eq!(svg.matches("<polyline").count(), 2);
        assert!(svg.contains(">a&lt;b<") && svg.contains(">c &amp; d<"));
        assert_eq!(svg.matches("<svg").count(), svg.matches("</svg>").count());
        let both = stacked(&svg, &svg);
        assert_eq!(both.matches("<svg").count(), 3);
        assert_eq!(both.matches("</svg>").count(), 3);
    }

    #[test]
    fn numbers_have_few_ticks() {
        let last = |count| {
            let axis = Axis::of_numbers("frame", count);
            let last = axis.ticks.last().map(|(value, _)| *value);
            (axis.ticks.len(), last)
        };
        assert_eq!(last(1), (2, Some(1.0)));
        assert_eq!(last(11), (11, Some(10.0)));
        assert_eq!(last(60), (6, Some(50.0)));
        assert_eq!(last(1001), (11, Some(1000.0)));
        assert_eq!(last(1_000_000), (10, Some(900_000.0)));
    }

    #[test]
    fn decades_are_whole() {
        let curve = Curve::new("".into(), vec![[30.0, 0.0], [2000.0, 0.02]]);
        let axis = Axis::of_decades("faces", std::slice::from_ref(&curve), 0);
        assert!((axis.place(10.0), axis.place(10_000.0)) == (0.0, 1.0));
        assert_eq!(axis.ticks.len(), 4);
        assert_eq!(axis.ticks[2].1, "1000");
        let axis = Axis::of_decades("error", &[curve], 1);
        assert_eq!((axis.ticks.len(), axis.place(0.0)), (2, 0.0));
        assert_eq!(Axis::of_decades("none", &[], 0).ticks.len(), 2);
    }
}
