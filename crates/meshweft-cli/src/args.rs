//! The command line.

use std::fmt;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use clap::{Args, Parser, Subcommand, ValueEnum};
use meshweft::CacheModel;
use meshweft::order::Target;

use crate::inputs::Shard;

/// Puts the triangles of a mesh in the order in which a GPU transforms each vertex about once.
#[derive(Debug, Parser)]
#[command(name = "meshweft", version, arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Re-order the faces and vertices of a file and keep every other byte
    ///
    /// Faces are put in the order in which a vertex cache misses least, vertices in the order of
    /// their first use. Nothing else in the file changes. A mesh whose order would not get better
    /// is left as it is.
    ///
    ///   meshweft optimize scene.glb -o ordered.glb
    ///   meshweft optimize scan.ply --in-place --cache nvidia --effort best --json
    ///   meshweft optimize assets -o ordered --jobs 8 --keep-going --manifest done.jsonl
    #[command(verbatim_doc_comment)]
    Optimize(Optimize),
    /// Count cache misses of files as they are
    ///
    ///   meshweft inspect scene.glb --cache fifo:12 --cache nvidia --json
    ///   meshweft inspect scan.ply --plot curves.svg --methods
    #[command(verbatim_doc_comment)]
    Inspect(Inspect),
    /// Tell whether two files hold the same triangles, and whose order is better
    ///
    ///   meshweft compare before.obj after.obj --cache fifo:12
    #[command(verbatim_doc_comment)]
    Compare(Compare),
    /// Show it all on meshes made here: no file needed
    ///
    /// Makes a knotted tube and an isosurface, scan-like and shuffled, orders them by every method,
    /// prints misses and times, and writes the ordered mesh and a picture of before and after.
    ///
    ///   meshweft demo -o folder
    #[command(verbatim_doc_comment)]
    Demo(Demo),
    /// Print a paper's tables beside ours
    Paper(Paper),
}

#[derive(Debug, Args)]
pub(crate) struct Optimize {
    /// Files, folders with files, or patterns such as 'assets/**/*.glb'
    ///
    /// .gltf, .glb, .obj, .ply, .off, .stl, .wrl, .vrml, also with .gz behind. Of a folder every
    /// such file is taken, and those in folders below.
    #[arg(required = true, value_name = "IN")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Where to write: a file, or a folder that repeats the folders of the inputs
    #[arg(short, long, value_name = "OUT", conflicts_with = "in_place")]
    pub(crate) output: Option<PathBuf>,
    /// Replace the input once the new file is whole
    #[arg(long)]
    pub(crate) in_place: bool,
    /// Do everything but write
    #[arg(long)]
    pub(crate) dry_run: bool,
    /// What to order for: universal, fifo:K, lru:K, controllable:K, nvidia, amd or intel
    ///
    /// universal is good for every cache size and GPU. An order made for a larger cache than the
    /// device has is bad, one made for a smaller cache loses little.
    #[arg(long, value_name = "MODEL", default_value = "universal")]
    pub(crate) cache: Target,
    /// How much time the order is worth
    #[arg(long, value_enum, default_value_t = Effort::Fast)]
    pub(crate) effort: Effort,
    /// Search for about this long a file, such as 5s, 500ms or 2m, whatever the effort
    ///
    /// The result then depends on the machine.
    #[arg(long, value_name = "TIME")]
    pub(crate) time_budget: Option<TimeBudget>,
    /// Where the random numbers of a search start: the same seed gives the same file
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// fast, or faithful to the paper of Lin and Yu; for fifo:K and controllable:K
    #[arg(long, value_enum, default_value_t = Mode::Fast)]
    pub(crate) mode: Mode,
    /// Never turn a face's corners (provoking vertex, data on edges)
    #[arg(long)]
    pub(crate) keep_corners: bool,
    /// Leave the vertices where they are
    #[arg(long)]
    pub(crate) keep_vertex_order: bool,
    /// Write the new order even where it misses more
    #[arg(long)]
    pub(crate) allow_worse: bool,
    /// Weight of a push [default: 1]; for fifo:K and controllable:K
    #[arg(long, value_name = "WEIGHT")]
    pub(crate) k1: Option<f64>,
    /// Weight of a face drawn [default: 0.5]; for fifo:K and controllable:K
    #[arg(long, value_name = "WEIGHT")]
    pub(crate) k2: Option<f64>,
    /// Weight of the distance from the front of a FIFO cache [default: 1.3]; for fifo:K and controllable:K
    #[arg(long, value_name = "WEIGHT")]
    pub(crate) k3: Option<f64>,
    /// Write what was moved as JSON
    ///
    /// Read it as `out[i] = in[new_to_old[i]]`, for faces and vertices; new corner j of a face is
    /// its old corner (j + rotation) % 3.
    #[arg(long, value_name = "FILE")]
    pub(crate) write_permutation: Option<PathBuf>,
    /// Go on with the next file when one fails
    #[arg(long)]
    pub(crate) keep_going: bool,
    /// Files to work on at once [default: as many as there are cores]
    #[arg(long, value_name = "N")]
    pub(crate) jobs: Option<NonZeroUsize>,
    /// Threads for the meshes of one file, large ones in parts; the output is the same for any
    /// number [default: the cores that the jobs leave]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
    /// List what is done as JSON lines; a run with the same list goes on where it was cut off
    ///
    /// What the list has as done, and whose output is there, is not done again. Remove the list to
    /// start anew.
    #[arg(long, value_name = "FILE")]
    pub(crate) manifest: Option<PathBuf>,
    /// Do every N-th file only, from the I-th on: 1/4, 2/4, 3/4 and 4/4 together do all
    #[arg(long, value_name = "I/N")]
    pub(crate) shard: Option<Shard>,
    /// Refuse files with something that is not known and may depend on the order
    ///
    /// A glTF extension on a primitive, accessor or buffer view, a PLY element, an OBJ statement.
    /// Without this flag, what they may depend on stays where it is, and a note says so.
    #[arg(long)]
    pub(crate) strict: bool,
    /// An extension, element or statement that does not depend on the order; may be repeated
    #[arg(long, value_name = "NAME")]
    pub(crate) assume_order_safe: Vec<String>,
    /// Let faces of an OBJ cross g and o lines: groups may lose and gain faces
    ///
    /// Materials and smoothing groups are never crossed.
    #[arg(long)]
    pub(crate) across_groups: bool,
    #[command(flatten)]
    pub(crate) report: Report,
}

#[derive(Debug, Args)]
pub(crate) struct Inspect {
    /// Files, folders with files, or patterns
    #[arg(required = true, value_name = "IN")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Draw misses per face over the size of a FIFO cache: one curve a file
    #[arg(long, value_name = "OUT.svg")]
    pub(crate) plot: Option<PathBuf>,
    /// Draw beside each file's curve those of its orders by every method here
    #[arg(long, requires = "plot")]
    pub(crate) methods: bool,
    #[command(flatten)]
    pub(crate) caches: Caches,
    #[command(flatten)]
    pub(crate) report: Report,
}

#[derive(Debug, Args)]
pub(crate) struct Compare {
    /// The first file
    pub(crate) a: PathBuf,
    /// The second file; another format is fine
    pub(crate) b: PathBuf,
    #[command(flatten)]
    pub(crate) caches: Caches,
    #[command(flatten)]
    pub(crate) report: Report,
}

#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// The folder to write to
    #[arg(short, long, value_name = "DIR", default_value = "meshweft-demo")]
    pub(crate) output: PathBuf,
    /// About how many faces each mesh has
    #[arg(long, value_name = "N", default_value_t = 100_000,
          value_parser = clap::value_parser!(u32).range(500..=4_000_000))]
    pub(crate) faces: u32,
    #[command(flatten)]
    pub(crate) report: Report,
}

#[derive(Debug, Args)]
pub(crate) struct Paper {
    #[command(subcommand)]
    pub(crate) paper: WhichPaper,
}

#[derive(Debug, Subcommand)]
pub(crate) enum WhichPaper {
    /// Lin, Yu: An Improved Vertex Caching Scheme for 3D Mesh Rendering (2006)
    ///
    /// Figures 3, 6, 7, 8, 9 and 10, on the meshes that are found.
    ///
    ///   meshweft paper lin-yu --data folder-with-meshes
    #[command(verbatim_doc_comment)]
    LinYu(OfPaper),
    /// Bogomjakov, Gotsman: Universal Rendering Sequences for Transparent Vertex Caching (2002)
    ///
    /// Figures 2, 4 and 8 and tables 1 and 2, and the universality table of Lin and Yu's figure 10 with
    /// every order there is here, on the meshes that are found.
    ///
    ///   meshweft paper bogomjakov-gotsman --data folder-with-meshes
    #[command(verbatim_doc_comment)]
    BogomjakovGotsman(OfPaper),
}

#[derive(Debug, Args)]
pub(crate) struct OfPaper {
    /// A folder with the meshes (fandisk.off, bunny.ply, …, also .gz), or one with a folder `meshes`
    #[arg(long, value_name = "DIR")]
    pub(crate) data: PathBuf,
    /// Leave out meshes of more than 200 thousand faces
    #[arg(long)]
    pub(crate) skip_large: bool,
    #[command(flatten)]
    pub(crate) report: Report,
}

#[derive(Debug, Args)]
pub(crate) struct Caches {
    /// A cache to count for, again for more: fifo:K, lru:K, controllable:K, nvidia, amd, intel
    /// [default: fifo:12 fifo:16 fifo:32 nvidia amd intel]
    #[arg(long = "cache", value_name = "MODEL")]
    pub(crate) models: Vec<CacheModel>,
}

impl Caches {
    /// The models asked for, each once, or the usual six.
    pub(crate) fn models(&self) -> Vec<CacheModel> {
        let usual = [
            CacheModel::fifo(12),
            CacheModel::fifo(16),
            CacheModel::fifo(32),
            CacheModel::NVIDIA,
            CacheModel::AMD,
            CacheModel::INTEL,
        ];
        let asked = match self.models.is_empty() {
            true => &usual[..],
            false => &self.models[..],
        };
        let mut models = Vec::new();
        for &model in asked {
            if !models.contains(&model) {
                models.push(model);
            }
        }
        models
    }
}

#[derive(Debug, Args)]
pub(crate) struct Report {
    /// Print the report as JSON on standard output, all text on standard error
    #[arg(long)]
    pub(crate) json: bool,
    /// Print errors only
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Mode {
    /// Faster and better than the paper
    Fast,
    /// The plain reading of the paper
    Faithful,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Effort {
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
pub(crate) struct TimeBudget(pub(crate) Duration);

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

/// What the command line asks for cannot be done; exit code 2.
#[derive(Debug)]
pub(crate) struct Usage(pub(crate) String);

impl fmt::Display for Usage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}
