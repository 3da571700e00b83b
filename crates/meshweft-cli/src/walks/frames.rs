//! The frames of a walk, as a table and as a plot.

use meshweft::operations::{WalkFrame, WalkOptimum, WalkQuantity, WalkSummary};

use crate::columns::columns;
use crate::plot::{self, Axis, Curve};

/// What is shown of any walk.
pub(crate) struct WalkedFrames<'a> {
    pub(crate) frames: &'a [WalkFrame],
    /// The size of a file of which only what is needed is read.
    pub(crate) file_bytes: Option<u64>,
    /// How many frames were streamed, or drawn in passes.
    pub(crate) overfull: [usize; 2],
    /// Whether vertices are kept in slots.
    pub(crate) is_caching: bool,
    pub(crate) optimum: Option<WalkOptimum>,
}

/// What is shown of a quantity, and its digits after the point.
const ROWS: [(WalkQuantity, &str, usize); 13] = [
    (WalkQuantity::Vertices, "active vertices", 0),
    (WalkQuantity::Faces, "faces", 0),
    (WalkQuantity::Added, "vertices added", 0),
    (WalkQuantity::Removed, "vertices removed", 0),
    (WalkQuantity::Inserts, "inserts", 0),
    (WalkQuantity::VertexRanges, "vertex ranges", 0),
    (WalkQuantity::VertexBytes, "vertex bytes", 0),
    (WalkQuantity::PatchedFaces, "faces patched", 0),
    (WalkQuantity::IndexRanges, "index ranges", 0),
    (WalkQuantity::IndexBytes, "index bytes", 0),
    (WalkQuantity::UpdateMilliseconds, "ms, level of detail", 3),
    (WalkQuantity::CacheMilliseconds, "ms, slots", 3),
    (WalkQuantity::IndexMilliseconds, "ms, indices", 3),
];

/// Points of a curve at most.
const PLOTTED: usize = 500;

impl WalkedFrames<'_> {
    fn summary(&self, quantity: WalkQuantity) -> WalkSummary {
        WalkSummary::of(self.frames, quantity)
    }

    /// A table, and a line for each thing beside it.
    pub(crate) fn text(&self) -> String {
        let head = ["a frame", "first", "mean", "median", "worst", "all frames"];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        let read = self
            .file_bytes
            .map(|_| (WalkQuantity::ReadBytes, "file bytes read", 0));
        for (quantity, name, digits) in ROWS.into_iter().chain(read) {
            let it = self.summary(quantity);
            let [count, part] = [digits, digits.max(1)];
            let later = [(it.mean, part), (it.median, part), (it.worst, count)];
            let later = later.map(|(value, digits)| match self.frames.len() {
                1 => "-".to_owned(),
                _ => format!("{value:.digits$}"),
            });
            let [first, all] = [it.first, it.total].map(|value| format!("{value:.count$}"));
            rows.push([&[name.to_owned(), first], &later[..], &[all]].concat());
        }
        let mut text = columns(&rows);

        if let Some(length) = self.file_bytes {
            let read = self.summary(WalkQuantity::ReadBytes).total;
            let percent = 100.0 * read / length as f64;
            text += &format!("\nbytes of the file: {length}; read: {read}, {percent:.2} %");
        }
        let [streamed, in_passes] = self.overfull;
        if streamed > 0 && self.is_caching {
            text += &format!(
                "\nframes of more vertices than slots: {streamed}, streamed (--passes or more --slots send less)"
            );
        }
        if in_passes > 0 {
            let passes = self.summary(WalkQuantity::Passes).total;
            text += &format!(
                "\nframes of more vertices than slots: {in_passes}, all in {passes} passes"
            );
        }
        if let Some(optimum) = self.optimum {
            let inserts = self.summary(WalkQuantity::Inserts).total;
            let (distinct, fewest) = optimum.times(inserts);
            let vertices = optimum.distinct_vertices;
            text += &format!(
                "\nvertices active at some time: {vertices}; inserts: {distinct:.3} times"
            );
            text += &match optimum.fewest_inserts.zip(fewest) {
                Some((fewest, times)) => {
                    format!(" that, {times:.3} times the fewest possible, {fewest}")
                }
                None => {
                    " that; the fewest possible is not known, as a frame has more vertices than there are slots".to_owned()
                }
            };
        }
        text
    }

    /// Counts of the frames above, times below; the first frame left out, means where there are many frames.
    pub(crate) fn svg(&self) -> String {
        let later = self.frames.get(1..).unwrap_or_default();
        let together = later.len().div_ceil(PLOTTED).max(1);
        let curve = |quantity: WalkQuantity, name: &str| {
            let point = |(number, frames): (usize, &[WalkFrame])| {
                let sum: f64 = frames.iter().map(|frame| quantity.of(frame)).sum();
                [(1 + number * together) as f64, sum / frames.len() as f64]
            };
            let points = later.chunks(together).enumerate().map(point);
            Curve::new(name.to_owned(), points.collect())
        };
        let picture = |title: &str, unit: &'static str, quantities: &[(WalkQuantity, &str)]| {
            let curves = quantities
                .iter()
                .map(|&(quantity, name)| curve(quantity, name));
            let curves: Vec<Curve> = curves.collect();
            let frames = self.frames.len();
            let axes = [
                Axis::of_numbers("frame", frames),
                Axis::of_decades(unit, &curves, 1),
            ];
            plot::svg(title, &axes, &curves)
        };

        let counts = [
            (WalkQuantity::Vertices, "active vertices"),
            (WalkQuantity::Faces, "faces"),
            (WalkQuantity::Inserts, "inserts"),
            (WalkQuantity::PatchedFaces, "faces patched"),
        ];
        let times = [
            (WalkQuantity::UpdateMilliseconds, "level of detail"),
            (WalkQuantity::CacheMilliseconds, "slots"),
            (WalkQuantity::IndexMilliseconds, "indices"),
        ];
        plot::stacked(
            &picture("Frames of a walk", "number", &counts),
            &picture("Times of these frames", "milliseconds", &times),
        )
    }
}
