//! `simplify`: fewer faces.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Args;
use meshweft::CacheModel;
use meshweft::files::Document;
use meshweft::operations::{
    self, AttributeWeights, LEVEL_CACHES, LevelFigures, SimplifiedObject, SimplifyOptions,
    SimplifyReport, StopReason,
};

use crate::plot::{self, Axis, Curve};
use crate::run::arguments::{Reading, Run};
use crate::run::ending::{Ending, where_it_went};
use crate::run::error_limit::Error;
use crate::run::jobs::{Job, Jobs};
use crate::run::ordering::Ordering;
use crate::run::output::Report;
use crate::run::side_file::{LEVELS, PLOT, PendingFile, SideFile};
use crate::run::watch::Watch;
use crate::run::{self, Outcome, write};
use crate::usage::Usage;

#[derive(Debug, Args)]
pub(crate) struct Simplify {
    /// Files, folders with files, or patterns such as 'assets/**/*.glb'
    ///
    /// .gltf, .glb, .vrm, .obj, .ply, .off or .stl, optionally followed by .gz.
    #[arg(required = true, value_name = "IN")]
    inputs: Vec<PathBuf>,
    #[command(flatten)]
    run: Run,
    /// Share of the faces to keep, from 0 to 1, of each object of a file
    #[arg(long, value_name = "R", display_order = 1)]
    ratio: Option<f64>,
    /// Faces to keep in a file; each of its objects keeps a share in proportion
    #[arg(long, value_name = "N", display_order = 1)]
    faces: Option<usize>,
    /// Largest error of a removal: in units of the positions, or 1% of the bounding box's diagonal
    ///
    /// It is an estimate; the report has the error as measured.
    #[arg(long, value_name = "E", display_order = 1)]
    error: Option<Error>,
    /// Keep the vertices at open edges, so that meshes that meet there keep meeting
    #[arg(long, display_order = 2)]
    lock_border: bool,
    /// Let small parts leave as a whole, once none of their vertices can, and small holes close
    #[arg(long, display_order = 2)]
    drop_parts: bool,
    /// What a change of a normal by 1 counts, as hundredths of the bounding box's diagonal
    #[arg(long, value_name = "W", display_order = 3, default_value_t = AttributeWeights::default().normal)]
    normal_weight: f32,
    /// What a change of a texture coordinate by 1 counts, likewise
    #[arg(long, value_name = "W", display_order = 3, default_value_t = AttributeWeights::default().tex_coord)]
    uv_weight: f32,
    /// What a change of a colour by 1 counts, likewise
    #[arg(long, value_name = "W", display_order = 3, default_value_t = AttributeWeights::default().color)]
    color_weight: f32,
    /// Points of either surface from which the error of the result is measured; 0 leaves that out
    #[arg(long, value_name = "N", display_order = 4, default_value_t = SimplifyOptions::default().samples)]
    samples: usize,
    /// Write the order in which vertices leave, down to the coarsest mesh, and what stands for each, as JSON
    #[arg(long, value_name = "FILE", display_order = 4)]
    write_levels: Option<PathBuf>,
    /// Draw the error, and the misses per face of levels edited in place and ordered afresh, over the faces
    ///
    /// Of the object with most faces, down to its coarsest mesh.
    #[arg(long, value_name = "FILE.svg", display_order = 4)]
    plot: Option<PathBuf>,
    #[command(flatten)]
    ordering: Ordering,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    report: Report,
}

/// Levels of a plot.
const PLOTTED_LEVELS: usize = 48;

impl Simplify {
    /// The files that it writes beside the meshes.
    fn side_files(&self) -> impl Iterator<Item = (&PathBuf, &'static SideFile)> {
        let levels = self.write_levels.iter().map(|path| (path, &LEVELS));
        levels.chain(self.plot.iter().map(|path| (path, &PLOT)))
    }

    /// The flags for the library, checked.
    fn options(&self) -> Result<SimplifyOptions, Usage> {
        let options = SimplifyOptions {
            ratio: self.ratio,
            faces: self.faces,
            error: self.error.map(|error| error.0),
            lock_border: self.lock_border,
            drop_parts: self.drop_parts,
            weights: AttributeWeights {
                normal: self.normal_weight,
                tex_coord: self.uv_weight,
                color: self.color_weight,
            },
            samples: self.samples,
            with_removals: self.write_levels.is_some(),
            levels: if self.plot.is_some() {
                PLOTTED_LEVELS
            } else {
                0
            },
            ordering: self.ordering.options()?,
        };
        let is_limited =
            options.ratio.is_some() || options.faces.is_some() || options.error.is_some();
        if !is_limited {
            return Err(Usage("how far? Give --ratio, --faces or --error".into()));
        }
        let checked = options.check();
        checked.map_err(|error| Usage(error.to_string()))?;
        Ok(options)
    }
}

/// Simplifies each file.
pub(crate) fn run(arguments: &Simplify) -> Result<()> {
    // What cannot be done is reported before a file is touched.
    let options = arguments.options()?;
    let jobs = Jobs::new(&arguments.inputs, &arguments.run)?;
    for (path, side_file) in arguments.side_files() {
        write::check_side_file(side_file, path, &jobs, &arguments.run)?;
    }
    if let (Some(plot), Some(levels)) = (&arguments.plot, &arguments.write_levels) {
        PLOT.check_other(plot, levels, LEVELS.flag)?;
    }
    let shows_bar = jobs.list.len() == 1 && arguments.report.shows_progress();
    let work = |job: &Job| simplify(job, &jobs, &options, shows_bar, arguments);
    run::over_files(
        "simplify",
        &jobs.list,
        &arguments.run,
        &arguments.report,
        work,
    )
}

/// Simplifies the meshes of a file, and writes it.
fn simplify(
    job: &Job,
    jobs: &Jobs,
    options: &SimplifyOptions,
    shows_bar: bool,
    arguments: &Simplify,
) -> Result<Outcome> {
    let start = Instant::now();
    let mut document = Document::open(&job.input, arguments.reading.options(&jobs.shared_buffers))?;

    let watch = Watch::new(arguments.ordering.time(), shows_bar);
    let mut report = operations::simplify(&mut document, options, &watch)?;
    watch.finish();

    let levels = || report.removals_to_json();
    let beside = arguments.write_levels.as_deref();
    let beside = beside.map(|path| (&LEVELS, path, &levels as &dyn Fn() -> String));
    let ending = Ending {
        job,
        jobs,
        run: &arguments.run,
        start,
        beside,
    };
    let ended = ending.write(&document, report.is_changed())?;
    if let Some(file) = arguments.plot.as_ref().filter(|_| !arguments.run.dry_run) {
        PLOT.check(file, arguments.run.force)?;
        let written = PendingFile::new(file, plot(&report)).and_then(PendingFile::commit);
        written.with_context(|| file.display().to_string())?;
    }
    let notes = ended.tell(&mut report.of_file);
    Ok(Outcome {
        json: report.to_json(),
        total: report.total_to_json(),
        text: text(&report),
        notes,
    })
}

/// The error, and the misses of levels, of the object with most faces.
fn plot(report: &SimplifyReport) -> String {
    let largest = report.objects.iter().max_by_key(|object| object.faces[0]);
    let levels = largest.map_or(&[][..], |object| &object.levels);
    let curve = |name: String, figure: &dyn Fn(&LevelFigures) -> f64| {
        let points = levels.iter().rev();
        let point = |level: &LevelFigures| [level.faces as f64, figure(level)];
        Curve::new(name, points.map(point).collect())
    };
    let percent = |level: &LevelFigures| {
        100.0 * largest.map_or(0.0, |object| object.of_diagonal(level.error.into()))
    };
    // The full mesh has none, which is nowhere on a scale of decades.
    let mut error = curve("estimated error".into(), &percent);
    error.leave_out_zeros();
    let errors = [error];
    let mut misses = Vec::new();
    for (which, size) in LEVEL_CACHES.into_iter().enumerate() {
        let name = |how: &str| format!("fifo:{size}, {how}");
        misses.push(curve(name("edited in place"), &|level| level.edited[which]));
        misses.push(curve(name("ordered afresh"), &|level| level.fresh[which]));
    }
    let faces = |curves| Axis::of_decades("faces", curves, 0);
    let error_axis = Axis::of_decades("error in % of the diagonal", &errors, 1);
    plot::stacked(
        &plot::svg("Error over faces", &[faces(&misses), error_axis], &errors),
        &plot::svg(
            "Misses per face over faces",
            &[faces(&misses), Axis::of_misses(&misses)],
            &misses,
        ),
    )
}

/// A line for the file, one for its error, one for its caches, one for what stopped it, one for where it was
/// written.
fn text(report: &SimplifyReport) -> String {
    let (before, after) = (&report.total.before, &report.total.after);
    let mut text = format!(
        "{}\n  {} -> {} faces, {} -> {} vertices",
        report.of_file.file.display(),
        before.faces,
        after.faces,
        before.vertices,
        after.vertices,
    );

    if let Some(line) = error_line(report) {
        text += &format!("\n  {line}");
    }
    let target = report.options.ordering.target;
    let is_shown = |model: &CacheModel| !model.is_gpu() && target.models().contains(model);
    let caches = before.acmr().zip(after.acmr());
    let caches = caches.filter(|((model, _), _)| is_shown(model));
    let caches = caches.map(|((model, a), (_, b))| format!("{model} {a:.4} -> {b:.4}"));
    let caches: Vec<_> = caches.collect();
    if !caches.is_empty() {
        text += &format!("\n  misses per face: {}", caches.join(", "));
    }
    for line in stop_lines(report) {
        text += &format!("\n  {line}");
    }

    let unchanged = ["nothing left", "the file stays as it is"];
    text + &where_it_went(&report.of_file, report.is_changed(), unchanged)
}

/// The object that is farthest from its source, as a share of its diagonal.
fn error_line(report: &SimplifyReport) -> Option<String> {
    let measured = report.objects.iter().filter_map(|object| {
        let distances = object.distances?;
        Some((object, distances, object.of_diagonal(distances.max)))
    });
    let (object, distances, _) = measured.max_by(|a, b| a.2.total_cmp(&b.2))?;
    let figures = [distances.max, distances.mean, distances.rms];
    let [max, mean, rms] = figures.map(|length| {
        let percent = 100.0 * object.of_diagonal(length);
        format!("{length:.4e} ({percent:.4} %)")
    });
    let of = match report.objects.len() {
        1 => String::new(),
        _ => format!(", largest of all objects: {}", name(report, object)),
    };
    Some(format!(
        "error (of the diagonal): greatest {max}, mean {mean}, root mean square {rms}{of}"
    ))
}

/// Why objects have more faces than asked for, each reason once.
fn stop_lines(report: &SimplifyReport) -> Vec<String> {
    let mut lines = Vec::new();
    for reason in [StopReason::Error, StopReason::NothingLeft] {
        let stopped = report.objects.iter().filter(|object| {
            object.refused.is_none() && object.stop == reason && object.faces[1] > object.goal
        });
        let stopped: Vec<&SimplifiedObject> = stopped.collect();
        let Some(object) = stopped
            .iter()
            .max_by_key(|object| object.faces[1] - object.goal)
        else {
            continue;
        };
        let percent = 100.0 * object.faces[1] as f64 / object.faces[0].max(1) as f64;
        let why = match reason {
            StopReason::Error => "the next vertices would have a larger error",
            _ => "no other vertex can go (seams, borders, topology)",
        };
        let more = match stopped.len() {
            1 => String::new(),
            count => format!(", and so in {} other objects", count - 1),
        };
        lines.push(format!(
            "stopped: {percent:.1} % of the faces of {} are left: {why}{more}",
            name(report, object)
        ));
    }
    if report.is_stopped {
        lines.push("stopped before it was done".to_owned());
    }
    lines
}

/// The name of the first mesh of an object.
fn name<'a>(report: &'a SimplifyReport, object: &SimplifiedObject) -> &'a str {
    let first = object.meshes.first();
    first.map_or("", |&mesh| &report.meshes[mesh].name)
}
