//! Random search over the weights of a preset of the library's search (`order/search/preset.rs`).
//!
//! ```text
//! cargo run --release --bin tune -- [--target TARGET] [--effort EFFORT] [--rounds N] [--seed N]
//!     [--all] [mesh files]
//! ```
//!
//! It starts from the present numbers. Each round changes each number with a chance of one in four,
//! by a random factor from 1/1.3 to 1.3, never beyond a quarter and four times its present value.
//! What has the least mean of misses per face, over the target's caches, the meshes and two seeds of
//! the search, is kept and printed as Rust to paste. No cache may miss more on a mesh than in
//! meshoptimizer's order, or than at the start where the start loses already. `horizon.margin` is not
//! changed: it buys quality with time.
//!
//! At the end it prints the means with seeds that it was not tuned on, and the *spread*: how far each
//! number alone may move before the mean grows by .001.
//!
//! A preset that computes numbers from the size of a cache has no such literals: what is printed then
//! is their values for that size.
//!
//! The meshes are those of up to 25,000 faces that the presets were tuned on; `--all` takes all of
//! them.

mod literal;

use std::path::PathBuf;
use std::process::ExitCode;

use compare::rivals::Meshopt;
use meshweft::order::tuning::{self, LONGEST, NAMES, Numbers, WHOLE};
use meshweft::order::{Effort, Target};
use meshweft::{CacheModel, Mesh, cache};
use rayon::prelude::*;

use literal::{Literal, decimal};

const SMALL_MESHES: [&str; 5] = [
    "cow.off.gz",
    "spot.obj.gz",
    "dragon_res4.ply.gz",
    "bunny_res2.ply.gz",
    "mannequin.off.gz",
];
const LARGE_MESHES: [&str; 4] = [
    "horse_20k.off.gz",
    "lion_statue.obj.gz",
    "teapot_65k.off.gz",
    "maneki_neko.off.gz",
];

/// Seeds of the search to tune on; one alone would be tuned to its luck.
const SEEDS: [u64; 2] = [0, 1];
/// Seeds to check the result with.
const OTHER_SEEDS: [u64; 6] = [100, 101, 102, 103, 104, 105];
/// The largest factor that a round changes a number by.
const MOST_CHANGE: f64 = 1.3;
/// The largest factor from the start to the result.
const MOST_AWAY: f64 = 4.0;
/// By how much the mean may grow within the spread.
const TOLERATED: f64 = 0.001;
/// The factors that the spread is looked for at.
const MOVES: [f64; 9] = [1.02, 1.05, 1.1, 1.2, 1.4, 1.7, 2.0, 3.0, 4.0];

fn main() -> ExitCode {
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let arguments = Arguments::parse()?;
    let tuning = Tuning::new(&arguments)?;
    let start = tuning.start;
    let mut best = (start, tuning.score(&start, &SEEDS).mean);
    println!("start: {:.5} misses a face", best.1);
    println!("{}", Literal(&start));

    let mut random = Random(arguments.seed);
    for round in 1..=arguments.rounds {
        let changed = tuning.changed(&best.0, &mut random);
        let score = tuning.score(&changed, &SEEDS);
        if score.mean < best.1 && tuning.is_allowed(&score) {
            println!("round {round}: {:.5} instead of {:.5}", score.mean, best.1);
            println!("{}", Literal(&changed));
            best = (changed, score.mean);
        }
    }

    let [before, after] = [&start, &best.0].map(|numbers| tuning.means(numbers, &OTHER_SEEDS));
    println!(
        "with {} other seeds: {:.5} at the start, {:.5} now; one seed's mean deviates by {:.5}",
        OTHER_SEEDS.len(),
        mean(&before),
        mean(&after),
        deviation(&before),
    );
    tuning.print_spread(&best.0, best.1);
    Ok(())
}

/// What the command line asks for.
struct Arguments {
    target: Target,
    effort: Effort,
    rounds: u32,
    seed: u64,
    files: Vec<PathBuf>,
}

impl Arguments {
    fn parse() -> Result<Self, String> {
        let mut parsed = Self {
            target: Target::Universal,
            effort: Effort::Best,
            rounds: 200,
            seed: 1,
            files: Vec::new(),
        };
        let mut is_all = false;
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            let mut value = || {
                let value = arguments.next();
                value.ok_or(format!("{argument} needs a value"))
            };
            match argument.as_str() {
                "--target" => parsed.target = value()?.parse().map_err(|e| format!("{e}"))?,
                "--effort" => parsed.effort = effort(&value()?)?,
                "--rounds" => parsed.rounds = value()?.parse().map_err(|e| format!("{e}"))?,
                "--seed" => parsed.seed = value()?.parse().map_err(|e| format!("{e}"))?,
                "--all" => is_all = true,
                _ => parsed.files.push(PathBuf::from(argument)),
            }
        }

        let is_greedy = !parsed.target.models().iter().any(CacheModel::is_gpu);
        if parsed.effort == Effort::Fast && is_greedy {
            let target = parsed.target;
            return Err(format!(
                "{target} is not searched at effort fast: nothing to tune"
            ));
        }

        parsed.files = compare::files_or(parsed.files, |data| {
            let mut files = compare::named_mesh_files(data, &SMALL_MESHES);
            if is_all {
                files.extend(compare::named_mesh_files(data, &LARGE_MESHES));
            }
            files
        })?;
        Ok(parsed)
    }
}

fn effort(name: &str) -> Result<Effort, String> {
    let mut known = [Effort::Fast, Effort::Best, Effort::Max].into_iter();
    let found = known.find(|effort| effort.to_string() == name);
    found.ok_or(format!("{name} is not an effort: fast, best or max"))
}

/// What numbers are judged by.
struct Tuning {
    target: Target,
    effort: Effort,
    meshes: Vec<Mesh>,
    start: Numbers,
    /// Most misses a face of each mesh in each cache.
    allowed: Vec<Vec<f64>>,
}

/// How good an order is.
struct Score {
    /// Misses a face of each mesh in each cache.
    figures: Vec<Vec<f64>>,
    mean: f64,
}

impl Tuning {
    fn new(arguments: &Arguments) -> Result<Self, String> {
        let meshes = arguments
            .files
            .iter()
            .map(|file| compare::oracle::read(file));
        let mut tuning = Self {
            target: arguments.target,
            effort: arguments.effort,
            meshes: meshes.collect::<Result<_, String>>()?,
            start: tuning::numbers(arguments.target, arguments.effort),
            allowed: Vec::new(),
        };

        let at_start = tuning.score(&tuning.start, &SEEDS).figures;
        let mut lost = 0;
        for (mesh, figures) in tuning.meshes.iter().zip(at_start) {
            let theirs = tuning.figures(&Meshopt::VertexCache.ordered(mesh));
            lost += figures.iter().zip(&theirs).filter(|(a, b)| a > b).count();
            let most = figures.iter().zip(&theirs).map(|(a, b)| a.max(*b));
            tuning.allowed.push(most.collect());
        }
        println!(
            "{} at effort {}, {} meshes; at the start {lost} of {} figures lose to meshoptimizer",
            tuning.target,
            tuning.effort,
            tuning.meshes.len(),
            tuning.meshes.len() * tuning.target.models().len(),
        );
        Ok(tuning)
    }

    /// Misses a face in each cache.
    fn figures(&self, faces: &[[u32; 3]]) -> Vec<f64> {
        let acmr = |&model| cache::acmr(faces, model);
        self.target.models().iter().map(acmr).collect()
    }

    /// The means over the seeds.
    fn score(&self, numbers: &Numbers, seeds: &[u64]) -> Score {
        let runs: Vec<(&Mesh, u64)> = self
            .meshes
            .iter()
            .flat_map(|mesh| seeds.iter().map(move |&seed| (mesh, seed)))
            .collect();
        let run = |&(mesh, seed): &(&Mesh, u64)| {
            let order = tuning::face_order(mesh, self.target, self.effort, numbers, seed);
            self.figures(&order.apply(mesh.faces()))
        };
        let figures: Vec<Vec<f64>> = runs.par_iter().map(run).collect();

        let caches = 0..self.target.models().len();
        let over_seeds = |runs: &[Vec<f64>]| {
            let of_cache = |i: usize| mean(&runs.iter().map(|run| run[i]).collect::<Vec<_>>());
            caches.clone().map(of_cache).collect()
        };
        let figures: Vec<Vec<f64>> = figures.chunks(seeds.len()).map(over_seeds).collect();
        Score {
            mean: mean(&figures.concat()),
            figures,
        }
    }

    fn is_allowed(&self, score: &Score) -> bool {
        let (figures, most) = (
            score.figures.iter().flatten(),
            self.allowed.iter().flatten(),
        );
        figures.zip(most).all(|(figure, most)| figure <= most)
    }

    /// The mean with each seed alone.
    fn means(&self, numbers: &Numbers, seeds: &[u64]) -> Vec<f64> {
        let seeds = seeds.iter();
        seeds
            .map(|&seed| self.score(numbers, &[seed]).mean)
            .collect()
    }

    /// Whether the target's search looks at a number: the longer windows are for two caches only.
    fn is_used(&self, i: usize) -> bool {
        let is_longer_window = (1..WHOLE).contains(&i);
        self.start[i] != 0.0 && (!is_longer_window || self.target == Target::Universal)
    }

    /// Some numbers changed, at least one.
    fn changed(&self, from: &Numbers, random: &mut Random) -> Numbers {
        loop {
            let mut numbers = *from;
            for (i, number) in numbers.iter_mut().enumerate() {
                if random.below_one() < 0.25 && self.is_used(i) && !buys_with_time(i) {
                    let factor = MOST_CHANGE.powf(2.0 * random.below_one() - 1.0);
                    *number = moved(i, *number, factor, self.start[i]);
                }
            }
            if numbers != *from {
                return numbers;
            }
        }
    }

    fn print_spread(&self, best: &Numbers, best_mean: f64) {
        println!("\n| number | value | mean grows by less than {TOLERATED} from | to |");
        println!("|---|--:|--:|--:|");
        for (i, (name, &value)) in NAMES.iter().zip(best).enumerate() {
            if !self.is_used(i) {
                continue;
            }
            let limit = |is_up: bool| {
                let mut limit = (value, true);
                for factor in MOVES {
                    let factor = if is_up { factor } else { 1.0 / factor };
                    let mut numbers = *best;
                    numbers[i] = moved(i, value, factor, value);
                    if self.score(&numbers, &SEEDS).mean >= best_mean + TOLERATED {
                        limit.1 = false;
                        break;
                    }
                    limit.0 = numbers[i];
                }
                // Factors beyond the last one are not tried.
                format!(
                    "{}{}",
                    decimal(limit.0),
                    if limit.1 { " or beyond" } else { "" }
                )
            };
            println!(
                "| {name} | {} | {} | {} |",
                decimal(value),
                limit(false),
                limit(true)
            );
        }
    }
}

/// Whether it gives fewer misses for more time; a round then leaves it alone.
fn buys_with_time(i: usize) -> bool {
    NAMES[i] == "horizon.margin"
}

/// A number times a factor: whole ones by one at least, others in whole 1024ths, as presets keep
/// them.
fn moved(i: usize, number: f64, factor: f64, start: f64) -> f64 {
    let (least, most) = (start.abs() / MOST_AWAY, start.abs() * MOST_AWAY);
    let size = (number.abs() * factor).clamp(least, most);
    if i < WHOLE {
        let step = if factor < 1.0 { -1.0 } else { 1.0 };
        let whole = match size.round() == number {
            true => number + step,
            false => size.round(),
        };
        return whole.clamp(3.0, f64::from(LONGEST[i]));
    }
    (size.copysign(number) * 1024.0).round() / 1024.0
}

fn mean(figures: &[f64]) -> f64 {
    figures.iter().sum::<f64>() / figures.len() as f64
}

/// The standard deviation of one of them.
fn deviation(figures: &[f64]) -> f64 {
    let mean = mean(figures);
    let squares = figures.iter().map(|figure| (figure - mean).powi(2));
    (squares.sum::<f64>() / (figures.len() as f64 - 1.0)).sqrt()
}

/// SplitMix64.
struct Random(u64);

impl Random {
    /// Uniform from 0 to 1.
    fn below_one(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
