//! `cull build`: files with culling tables.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use clap::Args;
use meshweft::files::Document;
use meshweft::operations::{self, CullOptions, CullOutcome, CullReport};
use meshweft::order::Target;

use crate::run::arguments::{Reading, Run};
use crate::run::ending::{Ending, where_it_went};
use crate::run::jobs::{Job, Jobs};
use crate::run::output::Report;
use crate::run::watch::Watch;
use crate::run::{self, Outcome};
use crate::usage::Usage;

#[derive(Debug, Args)]
pub(super) struct Build {
    /// Files, folders with files, or patterns such as 'assets/**/*.glb'
    ///
    /// .gltf, .glb, .vrm, .obj, .ply, .off, .stl, .wrl or .vrml, optionally followed by .gz.
    #[arg(required = true, value_name = "IN")]
    inputs: Vec<PathBuf>,
    #[command(flatten)]
    run: Run,
    /// The eyes that clusters are made for: near, far or orthographic, all around each mesh, or those that a file lists
    /// [default: all around, at 2, 4 and 10 radii of the mesh and orthographic]
    ///
    /// What an eye is expected to cost is the mean over them; none is shown less than it sees. A file is a JSON array of 1 to 448
    /// camera positions in the space of the meshes, such as [[0, 1.5, 4], [2, 1.5, 0]]; [x, y, z, 0] is a direction towards
    /// the viewer. A position that comes more often weighs more.
    #[arg(
        long,
        value_name = "near|far|orthographic|FILE.json",
        display_order = 1
    )]
    eyes: Option<String>,
    /// Cost of one more visible face, in transformed vertices: with more, clusters fit what is seen more tightly
    #[arg(long, value_name = "COST", display_order = 1, default_value_t = CullOptions::default().clusters.face_cost, value_parser = cost)]
    face_cost: f32,
    /// Cost of one more visible cluster, in transformed vertices: with more, clusters are fewer and larger
    #[arg(long, value_name = "COST", display_order = 1, default_value_t = CullOptions::default().clusters.draw_cost, value_parser = cost)]
    draw_cost: f32,
    /// Stripes by the normals of faces instead of clusters, this many, as by Kim and Lee; each of their 512 ranges is a cluster
    ///
    /// They leave out about as many faces, but faces of a range are far from each other, so more vertices are transformed.
    #[arg(long, value_name = "V", display_order = 1, conflicts_with_all = ["eyes", "face_cost", "draw_cost"])]
    stripes: Option<u32>,
    /// What the faces of each cluster are ordered for: a cache, a GPU or universal, as --cache of optimize
    #[arg(long, value_name = "MODEL", display_order = 1, default_value_t = CullOptions::default().clusters.optimizer.target)]
    cache: Target,
    /// For formats other than .gltf and .glb: keep only names of meshes, positions and faces; without this, a file that has
    /// more is refused, and the message lists it
    #[arg(long, display_order = 2)]
    drop_attributes: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    report: Report,
}

/// A finite number from 0 on.
fn cost(text: &str) -> Result<f32, String> {
    let cost: Option<f32> = text.parse().ok();
    cost.filter(|cost| (0.0..f32::INFINITY).contains(cost))
        .ok_or_else(|| "a number from 0 on".to_owned())
}

impl Build {
    /// The flags for the library, checked.
    fn options(&self) -> Result<CullOptions, Usage> {
        let mut options = CullOptions::default();
        options.drop_attributes = self.drop_attributes;
        if let Some(eyes) = &self.eyes {
            set_eyes(&mut options, eyes)?;
        }
        options.clusters.face_cost = self.face_cost;
        options.clusters.draw_cost = self.draw_cost;
        options.clusters.optimizer.target = self.cache;
        options.stripes = self.stripes;
        let checked = options.check();
        checked.map_err(|error| Usage(error.to_string()))?;
        Ok(options)
    }
}

/// A list of eyes is not longer.
const MOST_BYTES: u64 = 1 << 20;

/// Takes the eyes that `--eyes` names, or those of the file.
fn set_eyes(options: &mut CullOptions, text: &str) -> Result<(), Usage> {
    if let Some(eyes) = operations::eyes_by_name(text) {
        options.clusters.eyes = eyes;
        return Ok(());
    }
    let refused = |what: String| Usage(format!("--eyes {text}: {what}"));
    let mut list = String::new();
    let read = File::open(text).and_then(|file| file.take(MOST_BYTES).read_to_string(&mut list));
    let bytes = read.map_err(|error| {
        refused(format!(
            "neither near, far, orthographic nor a file of eyes: {error}"
        ))
    })?;
    if bytes as u64 == MOST_BYTES {
        return Err(refused(format!("the file has {MOST_BYTES} bytes or more")));
    }
    let eyes = operations::eyes_of_json(&list);
    options.clusters.eyes = eyes.map_err(|error| refused(error.to_string()))?;
    Ok(())
}

/// Adds tables to each file.
pub(super) fn run(arguments: &Build) -> Result<()> {
    // What cannot be done is reported before a file is touched.
    let options = arguments.options()?;
    let jobs = Jobs::new(&arguments.inputs, &arguments.run)?;
    let shows_bar = jobs.list.len() == 1 && arguments.report.shows_progress();
    let work = |job: &Job| build(job, &jobs, &options, shows_bar, arguments);
    run::over_files(
        "cull build",
        &jobs.list,
        &arguments.run,
        &arguments.report,
        work,
    )
}

/// Adds tables to a file, and writes it.
fn build(
    job: &Job,
    jobs: &Jobs,
    options: &CullOptions,
    shows_bar: bool,
    arguments: &Build,
) -> Result<Outcome> {
    let start = Instant::now();
    let mut document = Document::open(&job.input, arguments.reading.options(&jobs.shared_buffers))?;
    job.check_that_glb_fits(document.format(), &arguments.run)?;

    let watch = Watch::new(None, shows_bar);
    let mut report = operations::cull_build(&mut document, options, &watch)?;
    watch.finish();

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

/// A line for the file, one for its clusters, one for each reason why meshes have none, one for where it was written.
fn text(report: &CullReport) -> String {
    let [meshes, faces, clusters] = report.count(|it| *it == CullOutcome::Clusters);
    let mut text = format!(
        "{}\n  {} with {faces} faces in {clusters} clusters",
        report.of_file.file.display(),
        counted(meshes, "mesh", "meshes")
    );
    for line in reasons(report) {
        text += &format!("\n  {line}");
    }
    if !report.lost.is_empty() {
        text += &format!("\n  left out: {}", report.lost.join(", "));
    }
    let unchanged = ["no table", "left as it is"];
    text + &where_it_went(&report.of_file, report.is_changed(), unchanged)
}

/// Each reason why meshes are always drawn or have no table, with the first of them.
fn reasons(report: &CullReport) -> Vec<String> {
    let mut firsts: BTreeMap<(bool, &str), (&str, usize)> = BTreeMap::new();
    for mesh in &report.meshes {
        if let Some(why) = mesh.outcome.reason() {
            let is_left = matches!(mesh.outcome, CullOutcome::Left(_));
            let first = firsts.entry((is_left, why)).or_insert((&mesh.name, 0));
            first.1 += 1;
        }
    }
    let line = |((is_left, why), (name, count)): ((bool, &str), (&str, usize))| {
        let what = if is_left { "no table" } else { "always drawn" };
        let more = match count {
            1 => String::new(),
            _ => format!(" and {} more", count - 1),
        };
        format!("{what}: {name}{more}: {why}")
    };
    firsts.into_iter().map(line).collect()
}

/// A number of things.
pub(super) fn counted(count: usize, one: &str, several: &str) -> String {
    match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {several}"),
    }
}
