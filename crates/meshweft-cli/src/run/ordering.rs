//! The flags by which meshes are ordered.

use std::str::FromStr;
use std::time::Duration;

use clap::{Args, ValueEnum};
use meshweft::operations::{Greedy, Options};
use meshweft::order::{self, Target};

use crate::usage::Usage;

// No doc comment: clap would take it for the text about a verb.
#[derive(Debug, Args)]
pub(crate) struct Ordering {
    /// What to order for: universal, fifo:K, lru:K, controllable:K, nvidia, amd, intel, meshopt-nvidia, or
    /// batch:K/V/F
    ///
    /// universal is good for every cache size and GPU. An order made for a larger cache than the
    /// device has is bad, one made for a smaller cache loses little.
    #[arg(long, value_name = "MODEL", default_value = "universal")]
    cache: Target,
    /// How much time the result is worth
    #[arg(long, value_enum, default_value = "fast")]
    effort: Effort,
    /// Search for about this long per file, such as 5s, 500ms or 2m, whatever the effort
    ///
    /// The result then depends on the machine.
    #[arg(long, value_name = "TIME")]
    time_budget: Option<TimeBudget>,
    /// Seed of the search; the same seed gives the same file
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// fast, or faithful to the paper of Lin and Yu; for fifo:K and controllable:K
    #[arg(long, value_enum, default_value = "fast")]
    mode: Mode,
    /// Never turn a face's corners (provoking vertex, data on edges)
    #[arg(long)]
    keep_corners: bool,
    /// Leave the vertices where they are
    #[arg(long)]
    keep_vertex_order: bool,
    /// Write the new order even where it misses more
    #[arg(long)]
    allow_worse: bool,
    /// Weight of a push [default: 1]; for fifo:K and controllable:K
    #[arg(long, value_name = "WEIGHT", value_parser = weight)]
    k1: Option<f64>,
    /// Weight of a face drawn [default: 0.5]; for fifo:K and controllable:K
    #[arg(long, value_name = "WEIGHT", value_parser = weight)]
    k2: Option<f64>,
    /// Weight of the distance from the front of a FIFO cache [default: 1.3]; for fifo:K
    #[arg(long, value_name = "WEIGHT", value_parser = weight)]
    k3: Option<f64>,
}

impl Ordering {
    /// The flags for the library, checked.
    pub(crate) fn options(&self) -> Result<Options, Usage> {
        let greedy = Greedy {
            mode: self.mode.into(),
            k1: self.k1,
            k2: self.k2,
            k3: self.k3,
        };
        let options = Options {
            target: self.cache,
            effort: self.effort.into(),
            greedy: (greedy != Greedy::default()).then_some(greedy),
            seed: self.seed,
            keep_corners: self.keep_corners,
            keep_vertex_order: self.keep_vertex_order,
            allow_worse: self.allow_worse,
            ..Options::default()
        };

        options.check().map_err(|error| Usage(error.to_string()))?;
        match options.greedy.is_some() && self.time_budget.is_some() {
            true => Err(Usage(
                "--mode faithful and weights are for one greedy pass: leave out --time-budget"
                    .into(),
            )),
            false => Ok(options),
        }
    }

    /// How long to search per file, whatever the effort.
    pub(crate) fn time(&self) -> Option<Duration> {
        self.time_budget.map(|budget| budget.0)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Mode {
    /// Faster and better than the paper
    Fast,
    /// The plain reading of the paper
    Faithful,
}

impl From<Mode> for order::Mode {
    fn from(mode: Mode) -> Self {
        match mode {
            Mode::Fast => Self::Fast,
            Mode::Faithful => Self::Faithful,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Effort {
    /// About four times meshoptimizer's time, for one cache less than that
    Fast,
    /// About thirteen times meshoptimizer's time
    Best,
    /// Up to two hundred times meshoptimizer's time
    Max,
}

impl From<Effort> for order::Effort {
    fn from(effort: Effort) -> Self {
        match effort {
            Effort::Fast => Self::Fast,
            Effort::Best => Self::Best,
            Effort::Max => Self::Max,
        }
    }
}

/// A weight: any number, but a number.
fn weight(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(weight) if weight.is_finite() => Ok(weight),
        _ => Err("not a finite number".into()),
    }
}

/// A time such as `5s`, `500ms` or `2m`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct TimeBudget(Duration);

impl FromStr for TimeBudget {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let split = text.find(|c: char| c.is_ascii_alphabetic());
        let (number, unit) = text.split_at(split.unwrap_or(text.len()));
        let seconds = match unit {
            "ms" => 0.001,
            "s" => 1.0,
            "m" => 60.0,
            "h" => 3600.0,
            _ => return Err("a number with ms, s, m or h, such as 5s".into()),
        };
        let number: f64 = number.parse().map_err(|_| "no number before the unit")?;
        let time = Duration::try_from_secs_f64(number * seconds);
        time.map(Self).map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Debug, Parser)]
    struct Line {
        #[command(flatten)]
        ordering: Ordering,
    }

    fn options(flags: &str) -> Result<Options, Usage> {
        let words = format!("order {flags}");
        Line::parse_from(words.split_whitespace())
            .ordering
            .options()
    }

    #[test]
    fn flags_become_options() {
        let found = options("--effort max --seed 7 --cache nvidia --keep-corners").unwrap();
        let expected = Options {
            target: meshweft::CacheModel::Nvidia.into(),
            effort: order::Effort::Max,
            seed: 7,
            keep_corners: true,
            ..Options::default()
        };
        assert_eq!(found, expected);
        assert_eq!(options("").unwrap(), Options::default());
        let greedy = options("--cache fifo:12 --k3 2").unwrap().greedy.unwrap();
        assert_eq!((greedy.mode, greedy.k3), (order::Mode::Fast, Some(2.0)));
        let faithful = options("--cache fifo:12 --mode faithful").unwrap();
        assert_eq!(faithful.greedy.unwrap().mode, order::Mode::Faithful);
    }

    #[test]
    fn what_does_not_go_together_is_refused() {
        for flags in [
            "--mode faithful",
            "--k3 2 --cache nvidia",
            "--mode faithful --cache fifo:12 --effort best",
            "--mode faithful --cache fifo:12 --time-budget 1s",
            "--cache fifo:1025",
        ] {
            assert!(options(flags).is_err(), "{flags}");
        }
    }

    #[test]
    fn times_have_a_unit() {
        let time = |text: &str| text.parse::<TimeBudget>().map(|budget| budget.0);
        assert_eq!(time("1.5s"), Ok(Duration::from_millis(1500)));
        assert_eq!(time("2m"), Ok(Duration::from_secs(120)));
        for bad in ["5", "s", "-1s", "1 s", "1e99h", ""] {
            assert!(time(bad).is_err(), "{bad}");
        }
    }
}
