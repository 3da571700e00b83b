//! The walks that all tables and figures are of: each path once for a tolerance, drawn by every policy.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};
use meshweft::Limits;
use meshweft::files::Document;
use meshweft::operations::{
    CameraPath, EvictionPolicy, LodWalkOptions, LodWalkReport, WalkFrame, WalkQuantity,
    WalkRecorder, WalkedMesh,
};

use super::printed::{MODELS, PrintedModel, TOLERANCE};
use crate::paper::meshes::{LARGE, find};

/// The paper's policies and the library's own.
pub(super) const POLICIES: [EvictionPolicy; 5] = EvictionPolicy::ALL;
/// What they are called in a column.
pub(super) const NAMES: [&str; 5] = ["vertex array", "FA", "LRU", "LRU+queue", "finest"];
/// The paths, with the paper's letters.
pub(super) const PATHS: [(CameraPath, &str); 3] = [
    (CameraPath::Circle, "A"),
    (CameraPath::Rotate, "B"),
    (CameraPath::Zoom, "C"),
];

/// A mesh to walk around.
pub(super) struct Named {
    /// With a star unless it is the paper's.
    pub(super) name: String,
    file: PathBuf,
    document: Document,
    pub(super) printed: Option<&'static PrintedModel>,
}

impl Named {
    /// The paper's meshes that are in a folder.
    pub(super) fn in_folder(folder: &Path) -> Result<Vec<Self>> {
        let mut found = Vec::new();
        for printed in &MODELS {
            if let Some(file) = find(folder, printed.files) {
                found.push(Self::open(file, Some(printed))?);
            }
        }
        Ok(found)
    }

    /// A file. Whether it is a mesh of the paper is known by its name and the number of its faces.
    pub(super) fn file(file: &Path) -> Result<Self> {
        let stem = stem(file);
        let printed = MODELS.iter().find(|it| it.files.contains(&stem.as_str()));
        let named = Self::open(file.to_owned(), printed)?;
        Ok(match named.is_the_papers() {
            true => named,
            false => Self {
                name: stem,
                printed: None,
                ..named
            },
        })
    }

    fn open(file: PathBuf, printed: Option<&'static PrintedModel>) -> Result<Self> {
        let document = Document::open(&file, Limits::default())?;
        let mut named = Self {
            name: String::new(),
            file,
            document,
            printed,
        };
        if let Some(printed) = printed {
            let star = if named.is_the_papers() { "" } else { "*" };
            named.name = format!("{}{star}", printed.mesh);
        }
        Ok(named)
    }

    fn is_the_papers(&self) -> bool {
        self.printed
            .is_some_and(|printed| printed.faces == self.face_count())
    }

    fn face_count(&self) -> usize {
        let meshes = self.document.meshes().iter();
        meshes.map(|it| it.mesh.face_count()).sum()
    }

    pub(super) fn is_large(&self) -> bool {
        self.face_count() > LARGE
    }

    /// The name of its file without endings.
    pub(super) fn stem(&self) -> String {
        stem(&self.file)
    }
}

fn stem(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    name.split('.').next().unwrap_or_default().to_owned()
}

/// A mesh with all its walks.
pub(super) struct Walked {
    pub(super) name: String,
    pub(super) stem: String,
    pub(super) printed: Option<&'static PrintedModel>,
    pub(super) mesh: WalkedMesh,
    /// Of each tolerance each path.
    pub(super) walks: Vec<PathWalk>,
}

/// A path with a tolerance, drawn by every policy.
pub(super) struct PathWalk {
    pub(super) tolerance: f64,
    /// Its place in [`PATHS`].
    pub(super) path: usize,
    /// How many frames need more vertices than there are slots.
    pub(super) limited: usize,
    pub(super) most_active: usize,
    pub(super) distinct: usize,
    /// The fewest inserts that are possible; `None` if even the coarsest mesh has more vertices than there are slots.
    pub(super) fewest: Option<u64>,
    /// As [`POLICIES`].
    pub(super) reports: Vec<LodWalkReport>,
}

impl PathWalk {
    /// The letter of its path.
    pub(super) fn letter(&self) -> &'static str {
        PATHS[self.path].1
    }

    /// The inserts of each policy.
    pub(super) fn inserts(&self) -> Vec<u64> {
        let inserts = |report: &LodWalkReport| {
            let frames = report.frames.iter();
            frames.map(|frame| frame.inserts as u64).sum()
        };
        self.reports.iter().map(inserts).collect()
    }

    /// A quantity of each policy's frames.
    pub(super) fn means(&self, of: impl Fn(&WalkFrame) -> f64) -> Vec<f64> {
        let mean = |report: &LodWalkReport| {
            let sum: f64 = report.frames.iter().map(&of).sum();
            sum / report.frames.len().max(1) as f64
        };
        self.reports.iter().map(mean).collect()
    }

    pub(super) fn slots(&self) -> usize {
        self.reports[0].options.slots
    }
}

/// Tolerances: the paper's, and one that gives the paper's load.
pub(super) fn tolerances(load: f64) -> Vec<f64> {
    match load == TOLERANCE {
        true => vec![load],
        false => vec![TOLERANCE, load],
    }
}

/// Walks around all meshes.
pub(super) fn walk(
    meshes: &[Named],
    frames: usize,
    load: f64,
    shows_progress: bool,
) -> Result<Vec<Walked>> {
    let tolerances = tolerances(load);
    let steps = meshes.len() * (1 + tolerances.len() * PATHS.len());
    let style = ProgressStyle::with_template("[{elapsed}] {msg} {wide_bar} {pos}/{len}")?;
    let bar = match shows_progress {
        true => ProgressBar::new(steps as u64).with_style(style),
        false => ProgressBar::hidden(),
    };
    bar.enable_steady_tick(Duration::from_millis(500));

    // Each path is walked once.
    let start = Instant::now();
    let clock = || start.elapsed().as_secs_f64();
    let mut walked = Vec::new();
    for named in meshes {
        bar.set_message(format!("{}: levels of detail", named.name));
        let recorder = WalkRecorder::new(&named.document, &clock)?;
        bar.inc(1);
        let mut walks = Vec::new();
        for &tolerance in &tolerances {
            for (path, (shape, letter)) in PATHS.iter().enumerate() {
                bar.set_message(format!("{}: {tolerance} px, {letter}", named.name));
                let mut options = LodWalkOptions::default();
                options.path = shape.clone();
                options.frames = Some(frames);
                options.tolerance = tolerance;
                let walk = recorder.record(&options, &clock, &())?;
                let replay = |policy: EvictionPolicy| walk.replay(policy, &clock);
                let reports: Result<Vec<_>, _> = POLICIES.into_iter().map(replay).collect();
                walks.push(PathWalk {
                    tolerance,
                    path,
                    limited: walk.limited_frames(),
                    most_active: walk.path().most_active(),
                    distinct: walk.path().distinct_vertices(),
                    fewest: walk.path().fewest_inserts(options.slots),
                    reports: reports?,
                });
                bar.inc(1);
            }
        }
        walked.push(Walked {
            name: named.name.clone(),
            stem: named.stem(),
            printed: named.printed,
            mesh: recorder.mesh(),
            walks,
        });
    }
    bar.finish_and_clear();
    Ok(walked)
}

/// Milliseconds of the stage that the paper calls "build IVA".
pub(super) fn build_milliseconds(frame: &WalkFrame) -> f64 {
    frame.cache_milliseconds + frame.index_milliseconds
}

/// Bytes that are sent.
pub(super) fn bytes(frame: &WalkFrame) -> f64 {
    WalkQuantity::VertexBytes.of(frame) + WalkQuantity::IndexBytes.of(frame)
}
