//! The flags of `optimize`.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use clap::{Args, ValueEnum};
use meshweft::order::Target;

use crate::run::arguments::{Reading, Run};
use crate::run::output::Report;

#[derive(Debug, Args)]
pub(crate) struct Optimize {
    /// Files, folders with files, or patterns such as 'assets/**/*.glb'
    ///
    /// .gltf, .glb, .obj, .ply, .off, .stl, .wrl or .vrml, optionally followed by .gz. A folder
    /// stands for every such file in it and in the folders below it.
    #[arg(required = true, value_name = "IN")]
    pub(super) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(super) run: Run,
    /// What to order for: universal, fifo:K, lru:K, controllable:K, nvidia, amd or intel
    ///
    /// universal is good for every cache size and GPU. An order made for a larger cache than the
    /// device has is bad, one made for a smaller cache loses little.
    #[arg(long, value_name = "MODEL", default_value = "universal")]
    pub(super) cache: Target,
    /// How much time the order is worth
    #[arg(long, value_enum, default_value_t = Effort::Fast)]
    pub(super) effort: Effort,
    /// Search for about this long per file, such as 5s, 500ms or 2m, whatever the effort
    ///
    /// The result then depends on the machine.
    #[arg(long, value_name = "TIME")]
    pub(super) time_budget: Option<TimeBudget>,
    /// Seed of the search; the same seed gives the same file
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) seed: u64,
    /// fast, or faithful to the paper of Lin and Yu; for fifo:K and controllable:K
    #[arg(long, value_enum, default_value_t = Mode::Fast)]
    pub(super) mode: Mode,
    /// Never turn a face's corners (provoking vertex, data on edges)
    #[arg(long)]
    pub(super) keep_corners: bool,
    /// Leave the vertices where they are
    #[arg(long)]
    pub(super) keep_vertex_order: bool,
    /// Write the new order even where it misses more
    #[arg(long)]
    pub(super) allow_worse: bool,
    /// Weight of a push [default: 1]; for fifo:K and controllable:K
    #[arg(long, value_name = "WEIGHT")]
    pub(super) k1: Option<f64>,
    /// Weight of a face drawn [default: 0.5]; for fifo:K and controllable:K
    #[arg(long, value_name = "WEIGHT")]
    pub(super) k2: Option<f64>,
    /// Weight of the distance from the front of a FIFO cache [default: 1.3]; for fifo:K and controllable:K
    #[arg(long, value_name = "WEIGHT")]
    pub(super) k3: Option<f64>,
    /// Write what was moved as JSON
    ///
    /// Read it as `out[i] = in[new_to_old[i]]`, for faces and vertices; new corner j of a face is
    /// its old corner (j + rotation) % 3.
    #[arg(long, value_name = "FILE")]
    pub(super) write_permutation: Option<PathBuf>,
    #[command(flatten)]
    pub(super) reading: Reading,
    #[command(flatten)]
    pub(super) report: Report,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Mode {
    /// Faster and better than the paper
    Fast,
    /// The plain reading of the paper
    Faithful,
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Fast => "fast",
            Self::Faithful => "faithful",
        })
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Effort {
    /// About three times meshoptimizer's time, for one cache less than that
    Fast,
    /// About ten times meshoptimizer's time
    Best,
    /// Up to two hundred times meshoptimizer's time
    Max,
}

impl fmt::Display for Effort {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Fast => "fast",
            Self::Best => "best",
            Self::Max => "max",
        })
    }
}

/// A time such as `5s`, `500ms` or `2m`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TimeBudget(pub(super) Duration);

impl FromStr for TimeBudget {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let split = text.find(|c: char| c.is_ascii_alphabetic());
        let (number, unit) = text.split_at(split.unwrap_or(text.len()));
        let unit = match unit {
            "ms" => 0.001,
            "s" => 1.0,
            "m" => 60.0,
            "h" => 3600.0,
            _ => return Err("a number with ms, s, m or h, such as 5s".into()),
        };
        let number: f64 = number.parse().map_err(|_| "no number before the unit")?;
        let time = Duration::try_from_secs_f64(number * unit);
        time.map(Self).map_err(|error| error.to_string())
    }
}
