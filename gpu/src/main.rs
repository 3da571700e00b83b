//! `meshweft-gpu`: what a graphics card does with orders.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use gpu::error::GpuError;
use gpu::meshes::NamedMesh;
use gpu::model::Model;
use gpu::orders::Order;
use gpu::renderer::Renderer;
use gpu::vulkan::{Gpu, Instance};
use gpu::{bench, cull, meshes, paper, predict, probe};
use serde_json::{Value, json};

/// Draws meshes on a graphics card, through Vulkan and without a window, and compares what it counts
/// and how long it takes.
#[derive(Debug, Parser)]
#[command(name = "meshweft-gpu")]
struct Arguments {
    /// The card's number, the first if not given; `list` lists them
    #[arg(long, global = true, value_name = "N")]
    card: Option<String>,
    /// Write all figures to this file too
    #[arg(long, global = true, value_name = "FILE")]
    json: Option<PathBuf>,
    #[command(subcommand)]
    verb: Option<Verb>,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Count invocations of the vertex shader, and compare with the card's model
    Predict(Drawn),
    /// Time orders against each other
    Bench(Drawn),
    /// Print the frame rates of Bogomjakov and Gotsman's Table 2 beside this card's
    Paper(Files),
    /// Draw what cullers leave of meshes: whether it looks the same, and what it costs
    Cull(Culled),
    /// Find out how the card collects vertices, and where that differs from the model
    Probe,
}

#[derive(Debug, Args)]
struct Files {
    /// Mesh files
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Leave out files that cannot be read, and say how many
    #[arg(long)]
    skip_unreadable: bool,
}

impl Files {
    fn meshes(&self) -> Result<Vec<NamedMesh>, GpuError> {
        let (mut read, mut skipped) = (Vec::new(), 0);
        for file in &self.files {
            match meshes::read(file) {
                Ok(meshes) if meshes.is_empty() => skipped += 1,
                Ok(meshes) => read.extend(meshes),
                Err(error) if self.skip_unreadable => {
                    eprintln!("not read: {error}");
                    skipped += 1;
                }
                Err(error) => return Err(error),
            }
        }
        if read.is_empty() {
            return Err(GpuError::Input(
                "no file has a face: name a mesh file".to_owned(),
            ));
        }
        println!(
            "{} files, {} meshes, {skipped} files left out",
            self.files.len(),
            read.len()
        );
        Ok(read)
    }
}

#[derive(Debug, Args)]
struct Culled {
    #[command(flatten)]
    files: Files,
    /// Views of each mesh that are drawn whole and culled
    #[arg(long, value_name = "N", default_value_t = 48)]
    views: u32,
    /// Width and height of pictures in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 512, value_parser = clap::value_parser!(u32).range(1..=4096))]
    side: u32,
    /// Compare pictures and counts only
    #[arg(long)]
    no_times: bool,
}

#[derive(Debug, Args)]
struct Drawn {
    #[command(flatten)]
    files: Files,
    /// Orders, with commas between them: file, random, meshopt, meshopt-strip, meshopt-fifo:K,
    /// recursive-cut, linear-arrangement, or a target with its effort (universal, nvidia-best, fifo:16);
    /// +in-batches after any of them moves faces inside the batches of an NVIDIA card. The first is what times are relative to
    #[arg(long, value_delimiter = ',')]
    orders: Vec<Order>,
}

impl Drawn {
    fn orders_or(&self, names: &[&str]) -> Vec<Order> {
        match self.orders.is_empty() {
            true => names
                .iter()
                .map(|name| name.parse().expect("a known order"))
                .collect(),
            false => self.orders.clone(),
        }
    }
}

const PREDICT_ORDERS: &[&str] = &[
    "file",
    "meshopt",
    "universal",
    "nvidia",
    "fifo:16",
    "random",
];
/// The first is what the others are relative to.
const BENCH_ORDERS: &[&str] = &[
    "meshopt",
    "meshopt+in-batches",
    "universal",
    "universal-best",
    "nvidia",
    "nvidia-best",
    "fifo:16",
    "file",
    "random",
];

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &Arguments) -> Result<ExitCode, GpuError> {
    // Which card, and what to do there.
    let number = match arguments.card.as_deref() {
        None => None,
        Some("list") => {
            for (number, card) in Instance::new()?.cards()?.iter().enumerate() {
                println!("{number}: {card}");
            }
            return Ok(ExitCode::SUCCESS);
        }
        Some(text) => Some(text.parse().map_err(|_| {
            GpuError::Input(format!("--card {text}: a number or `list` is asked for"))
        })?),
    };
    let Some(verb) = &arguments.verb else {
        return Err(GpuError::Input(
            "nothing to do: predict, bench, cull, probe, paper; --help explains".to_owned(),
        ));
    };

    // The file for the figures, before anything takes time.
    let json = arguments.json.as_deref();
    let file = json.map(|json| File::create(json).map_err(|error| cannot_write(json, &error)));
    let file = file.transpose()?;

    // The job.
    let gpu = Gpu::open(number)?;
    let renderer = Renderer::new(&gpu)?;
    let card = gpu.card();
    println!("card: {card}");
    let (code, figures) = act(&renderer, verb)?;
    if let Some((json, mut file)) = json.zip(file) {
        let all = json!({"card": card.name, "driver": card.driver, "figures": figures});
        writeln!(file, "{all:#}").map_err(|error| cannot_write(json, &error))?;
    }
    Ok(code)
}

fn cannot_write(file: &Path, error: &io::Error) -> GpuError {
    GpuError::Input(format!("{} cannot be written: {error}", file.display()))
}

fn act(renderer: &Renderer<'_>, verb: &Verb) -> Result<(ExitCode, Value), GpuError> {
    let figures = match verb {
        Verb::Predict(drawn) => return predict(renderer, drawn),
        Verb::Bench(drawn) => {
            let orders = drawn.orders_or(BENCH_ORDERS);
            bench::run(renderer, &drawn.files.meshes()?, &orders)?
        }
        Verb::Paper(files) => paper::run(renderer, &files.meshes()?)?,
        Verb::Cull(culled) => {
            let options = cull::CullOptions {
                views: culled.views,
                side: culled.side,
                times: !culled.no_times,
            };
            let (is_right, figures) = cull::run(renderer, &culled.files.meshes()?, options)?;
            return Ok((ExitCode::from(u8::from(!is_right)), figures));
        }
        Verb::Probe => probe::run(renderer)?,
    };
    Ok((ExitCode::SUCCESS, figures))
}

/// Fails where counts differ from each other, or from the model if it is that of the card.
fn predict(renderer: &Renderer<'_>, drawn: &Drawn) -> Result<(ExitCode, Value), GpuError> {
    let (model, is_the_cards) = Model::of(renderer.gpu().card());
    match is_the_cards {
        true => println!("model: {model}"),
        false => println!("model: {model}, to compare with: none is known for this card"),
    }
    let orders = drawn.orders_or(PREDICT_ORDERS);
    let (outcome, figures) = predict::run(renderer, &drawn.files.meshes()?, &orders)?;
    println!(
        "{} draws: {} that the model does not say, {} that the card's statistics do not",
        outcome.draws, outcome.unpredicted, outcome.disputed
    );
    let is_wrong = outcome.disputed > 0 || (is_the_cards && outcome.unpredicted > 0);
    Ok((ExitCode::from(u8::from(is_wrong)), figures))
}
