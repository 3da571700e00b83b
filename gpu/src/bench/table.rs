//! Figures of orders, relative to those of the first.

use crate::orders::Order;
use crate::workload::Workload;

/// Columns before the times.
pub(super) const COUNTED: [&str; 3] = ["invocations", "warps", "cycles"];
/// How many figures an order has.
pub(super) const FIGURES: usize = COUNTED.len() + Workload::ALL.len();

/// What was counted, then the time of each workload; nothing where something is not known.
pub(super) type Figures = [Option<f64>; FIGURES];

/// Geometric means over meshes, an order at a time.
#[derive(Debug)]
pub(super) struct Means {
    /// Logarithms, added up.
    sums: Figures,
    count: u32,
}

impl Means {
    pub(super) fn new() -> Self {
        Self {
            sums: [Some(0.0); FIGURES],
            count: 0,
        }
    }

    pub(super) fn add(&mut self, figures: &Figures) {
        for (sum, figure) in self.sums.iter_mut().zip(figures) {
            *sum = sum.zip(*figure).map(|(sum, figure)| sum + figure.ln());
        }
        self.count += 1;
    }

    /// The means; nothing where a mesh has nothing.
    pub(super) fn figures(&self) -> Figures {
        self.sums
            .map(|sum| sum.map(|sum| (sum / f64::from(self.count.max(1))).exp()))
    }
}

/// Figures over those of the first order.
pub(super) fn relative(figures: &Figures, base: &Figures) -> Figures {
    let mut relative = [None; FIGURES];
    for (to, (figure, base)) in relative.iter_mut().zip(figures.iter().zip(base)) {
        // A time may be 0 or less where a program draws on a busy machine.
        *to = figure
            .zip(*base)
            .filter(|&(f, b)| f > 0.0 && b > 0.0)
            .map(|(f, b)| f / b);
    }
    relative
}

/// What the columns are.
pub(super) fn heading(base: Order, more: &str) -> String {
    let times = Workload::ALL.map(|workload| workload.to_string());
    let names = COUNTED.map(str::to_owned).into_iter().chain(times);
    row(&format!("over {base}"), names, more)
}

/// A row of figures.
pub(super) fn line(name: &str, figures: &Figures, more: &str) -> String {
    let text = |figure: &Option<f64>| figure.map_or_else(|| "-".to_owned(), |x| format!("{x:.4}"));
    row(name, figures.iter().map(text), more)
}

/// How far repeats differ, below the columns of times.
pub(super) fn repeats(differences: &[f64; Workload::ALL.len()]) -> String {
    let blanks = COUNTED.map(|_| String::new()).into_iter();
    let times = differences.map(|difference| format!("{:.2} %", 100.0 * difference));
    row("repeats differ", blanks.chain(times), "  (at most)")
}

fn row(name: &str, cells: impl Iterator<Item = String>, more: &str) -> String {
    let cells: String = cells.map(|cell| format!(" {cell:>11}")).collect();
    format!("{name:<26}{cells}{more}")
}

/// The figures that the others are relative to.
pub(super) fn absolute(base: &Figures) -> String {
    let (counts, times) = base.split_at(COUNTED.len());
    let counts = COUNTED.iter().zip(counts);
    let counts = counts.filter_map(|(name, count)| count.map(|count| format!("{count} {name}")));
    let times = Workload::ALL.iter().zip(times);
    let times = times.filter_map(|(name, ns)| ns.map(|ns| format!("{name} {:.2}", ns / 1000.0)));
    format!(
        "1 is: {}; microseconds: {}",
        counts.collect::<Vec<_>>().join(", "),
        times.collect::<Vec<_>>().join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_geometric_and_only_of_what_all_meshes_have() {
        let mut means = Means::new();
        let mut figures = [Some(2.0); FIGURES];
        means.add(&figures);
        figures[0] = Some(8.0);
        figures[1] = None;
        means.add(&figures);
        let mean = means.figures();
        assert!((mean[0].unwrap() - 4.0).abs() < 1e-12);
        assert_eq!(mean[1], None);
    }

    #[test]
    fn a_time_that_is_not_above_zero_has_no_ratio() {
        let mut figures = [Some(3.0); FIGURES];
        figures[5] = Some(0.0);
        let relative = relative(&figures, &[Some(2.0); FIGURES]);
        assert_eq!((relative[0], relative[5]), (Some(1.5), None));
    }
}
