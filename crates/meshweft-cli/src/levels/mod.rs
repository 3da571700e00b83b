//! `levels`: levels of detail in one ordinary GLB.

mod ranges;

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use clap::{ArgAction, Args, ValueEnum};
use meshweft::files::{Document, Edit};
use meshweft::operations::{
    self, AttributeWeights, FileLevel, LevelGoals, LevelsOptions, LevelsReport,
};
use meshweft::order::Target;

use crate::run::arguments::{Reading, Run};
use crate::run::ending::{Ending, where_it_went};
use crate::run::error_limit::Error;
use crate::run::jobs::{Job, Jobs};
use crate::run::ordering::Effort;
use crate::run::output::Report;
use crate::run::watch::Watch;
use crate::run::{self, Outcome};
use crate::usage::Usage;

#[derive(Debug, Args)]
pub(crate) struct Levels {
    /// Files, folders with files, or patterns such as 'assets/**/*.glb'
    ///
    /// .gltf, .glb, .vrm; of .obj, .ply, .off, .stl, .wrl or .vrml a .glb is made. Optionally followed by .gz.
    #[arg(required = true, value_name = "IN")]
    inputs: Vec<PathBuf>,
    #[command(flatten)]
    run: Run,
    #[command(flatten)]
    goals: Goals,
    /// Keep the vertices at open edges, so that meshes that meet there keep meeting
    #[arg(long, display_order = 2)]
    lock_border: bool,
    /// Let a part leave as a whole, and a hole close, where its extent is below the error of the level
    #[arg(long, display_order = 2, value_name = "true|false", default_value_t = true, action = ArgAction::Set, num_args = 0..=1, default_missing_value = "true")]
    drop_parts: bool,
    /// Go on where only vertices without a partner across a seam are left: their texture coordinates then change
    #[arg(long, display_order = 2)]
    cross_seams: bool,
    /// Leave the vertices where they are: those of a coarse level are then not the first ones
    ///
    /// For meshes of more than 65,536 vertices on NVIDIA cards: with the vertices in bands the full mesh takes up to three times as
    /// many vertex shader invocations.
    #[arg(long, display_order = 2, conflicts_with_all = ["layout", "separate"])]
    keep_vertex_order: bool,
    /// What a change of a normal by 1 counts, as hundredths of the bounding box's diagonal
    #[arg(long, value_name = "W", display_order = 3, default_value_t = AttributeWeights::default().normal)]
    normal_weight: f32,
    /// What a change of a texture coordinate by 1 counts, likewise
    #[arg(long, value_name = "W", display_order = 3, default_value_t = AttributeWeights::default().tex_coord)]
    uv_weight: f32,
    /// What a change of a colour by 1 counts, likewise
    #[arg(long, value_name = "W", display_order = 3, default_value_t = AttributeWeights::default().color)]
    color_weight: f32,
    /// Points of either surface from which the error of each level is measured; 0 takes the estimate
    #[arg(long, value_name = "N", display_order = 4, default_value_t = LevelsOptions::default().samples)]
    samples: usize,
    /// What the faces of each level are ordered for: a cache, a GPU or universal, as --cache of optimize
    #[arg(long, value_name = "MODEL", display_order = 4, default_value_t = LevelsOptions::default().optimizer.target)]
    cache: Target,
    /// How much time the result is worth
    #[arg(long, value_enum, display_order = 4, default_value = "fast")]
    effort: Effort,
    /// Lay the new file out for a client that reads it by byte ranges: geometry first, coarse to fine, images last
    ///
    /// In the JSON only byte offsets of buffer views change. --ranges says what a client needs for each level.
    #[arg(long, value_enum, display_order = 5, conflicts_with = "separate")]
    layout: Option<Layout>,
    /// Write nothing, but print which byte ranges of each file a client needs for each of its levels
    #[arg(long, display_order = 5, conflicts_with_all = ["output", "in_place", "dry_run", "separate", "layout", "ratios", "faces", "errors"])]
    ranges: bool,
    /// Write each level to a file of its own with the vertices that it needs: OUT_LOD1.glb, OUT_LOD2.glb …
    ///
    /// Of any format that simplify writes; the full mesh is the input.
    #[arg(long, display_order = 5, conflicts_with = "in_place")]
    separate: bool,
    /// For formats other than .gltf and .glb: keep only names of meshes, positions and faces; without this, a file that has
    /// more is refused, and the message lists it
    #[arg(long, display_order = 5)]
    drop_attributes: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    report: Report,
}

#[derive(Debug, Args)]
#[group(required = false, multiple = false)]
struct Goals {
    /// Shares of the faces of each level, falling, such as 0.5,0.25,0.1 [default: 0.5,0.25,0.1]
    ///
    /// All objects of a file have one error budget: some lose more faces than others.
    #[arg(long, value_name = "R,…", value_delimiter = ',', display_order = 1)]
    ratios: Vec<f64>,
    /// Faces of each level in the whole file, falling
    #[arg(long, value_name = "N,…", value_delimiter = ',', display_order = 1)]
    faces: Vec<usize>,
    /// Largest errors of the removals of each level, rising: in units of the scene, or % of the diagonal of the largest object
    #[arg(long, value_name = "E,…", value_delimiter = ',', display_order = 1)]
    errors: Vec<Error>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Layout {
    /// Geometry first, coarse to fine, images last
    Stream,
}

impl Levels {
    /// The flags for the library, checked.
    fn options(&self) -> Result<LevelsOptions, Usage> {
        let mut options = LevelsOptions::default();
        let goals = &self.goals;
        if !goals.ratios.is_empty() {
            options.goals = LevelGoals::Ratios(goals.ratios.clone());
        } else if !goals.faces.is_empty() {
            options.goals = LevelGoals::Faces(goals.faces.clone());
        } else if !goals.errors.is_empty() {
            options.goals = LevelGoals::Errors(goals.errors.iter().map(|error| error.0).collect());
        }
        options.lock_border = self.lock_border;
        options.drop_parts = self.drop_parts;
        options.cross_seams = self.cross_seams;
        options.keep_vertex_order = self.keep_vertex_order;
        options.weights.normal = self.normal_weight;
        options.weights.tex_coord = self.uv_weight;
        options.weights.color = self.color_weight;
        options.samples = self.samples;
        options.optimizer.target = self.cache;
        options.optimizer.effort = self.effort.into();
        options.drop_attributes = self.drop_attributes;
        let checked = options.check();
        checked.map_err(|error| Usage(error.to_string()))?;
        Ok(options)
    }
}

/// Adds levels to each file.
pub(crate) fn run(arguments: &Levels) -> Result<()> {
    if arguments.ranges {
        let Levels {
            inputs,
            reading,
            report,
            ..
        } = arguments;
        return ranges::run(inputs, reading, report);
    }

    // What cannot be done is reported before a file is touched.
    let options = arguments.options()?;
    let (inputs, flags) = (&arguments.inputs, &arguments.run);
    let jobs = match arguments.separate {
        true => Jobs::in_levels(inputs, flags, options.goals.len())?,
        false => Jobs::new(inputs, flags)?,
    };
    let shows_bar = jobs.list.len() == 1 && arguments.report.shows_progress();
    let work = |job: &Job| match arguments.separate {
        true => write_apart(job, &jobs, &options, shows_bar, arguments),
        false => add_levels(job, &jobs, &options, shows_bar, arguments),
    };
    run::over_files(
        "levels",
        &jobs.list,
        &arguments.run,
        &arguments.report,
        work,
    )
}

/// Adds levels to a file, and writes it.
fn add_levels(
    job: &Job,
    jobs: &Jobs,
    options: &LevelsOptions,
    shows_bar: bool,
    arguments: &Levels,
) -> Result<Outcome> {
    let start = Instant::now();
    let mut document = Document::open(&job.input, arguments.reading.options(&jobs.shared_buffers))?;
    job.check_that_glb_fits(document.format(), &arguments.run)?;

    let watch = Watch::new(None, shows_bar);
    let mut report = operations::levels(&mut document, options, &watch)?;
    watch.finish();
    if arguments.layout == Some(Layout::Stream) {
        document.edit(Edit::StreamLayout)?;
    }

    let ending = Ending {
        job,
        jobs,
        run: &arguments.run,
        start,
        beside: None,
    };
    let ended = ending.write(&document, report.is_changed())?;
    let notes = ended.tell(&mut report.of_file);
    Ok(Outcome {
        json: report.to_json(),
        total: report.total_to_json(),
        text: text(&report),
        notes,
    })
}

/// Writes each level of a file to one of its own.
fn write_apart(
    job: &Job,
    jobs: &Jobs,
    options: &LevelsOptions,
    shows_bar: bool,
    arguments: &Levels,
) -> Result<Outcome> {
    let start = Instant::now();
    let read = || Document::open(&job.input, arguments.reading.options(&jobs.shared_buffers));
    let document = read()?;
    let watch = Watch::new(None, shows_bar);
    let (apart, mut report) = operations::levels_apart(&document, &mut || read(), options, &watch)?;
    watch.finish();

    let mut notes = Vec::new();
    let mut of_level = report.of_file.clone();
    for (number, level) in (1..).zip(&apart) {
        let job = job.at_level(number);
        let ending = Ending {
            job: &job,
            jobs,
            run: &arguments.run,
            start,
            beside: None,
        };
        let ended = ending.write(level, true)?;
        notes.extend(ended.tell(&mut of_level));
        report.files.extend(of_level.output.take());
        of_level.notes.clear();
    }
    (report.of_file.copied, report.of_file.seconds) = (of_level.copied, of_level.seconds);
    Ok(Outcome {
        json: report.to_json(),
        total: report.total_to_json(),
        text: text(&report),
        notes,
    })
}

/// A line for the file, one for each level, one for what stopped it, one for where it was written.
fn text(report: &LevelsReport) -> String {
    let mut text = report.of_file.file.display().to_string();
    let full = report.levels.first().map_or(0, |level| level.counts.faces);
    for level in &report.levels {
        text += &format!("\n  {}", line(level, full));
    }
    if let Some(floor) = report.floor {
        let percent = 100.0 * floor as f64 / full.max(1) as f64;
        let further = match report.options.cross_seams {
            true => "--errors goes further, with larger errors",
            false => "--cross-seams goes further, or --errors",
        };
        text += &format!(
            "\n  floor {} faces ({percent:.1} %): {further}",
            grouped(floor)
        );
    }
    if !report.lost.is_empty() {
        text += &format!("\n  left out: {}", report.lost.join(", "));
    }
    if report.is_stopped {
        text += "\n  stopped before it was done";
    }
    if !report.files.is_empty() {
        let files = report.files.iter().map(|file| file.display().to_string());
        let files: Vec<String> = files.collect();
        return text + &format!("\n  written to {}", files.join(", "));
    }
    let unchanged = ["no level", "left as it is"];
    text + &where_it_went(&report.of_file, report.is_changed(), unchanged)
}

/// What there is to say of a level.
fn line(level: &FileLevel, full: usize) -> String {
    let counts = &level.counts;
    let percent = 100.0 * counts.faces as f64 / full.max(1) as f64;
    let misses = counts.acmr().next();
    let misses = misses.map_or(String::new(), |(model, acmr)| {
        format!(", {acmr:.3} misses a face ({model})")
    });
    format!(
        "level {}: {} faces ({percent:.1} %), {} vertices, error {:.3e}{misses}",
        level.number,
        grouped(counts.faces),
        grouped(counts.vertices),
        level.error
    )
}

/// A number with commas between groups of three digits.
fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
