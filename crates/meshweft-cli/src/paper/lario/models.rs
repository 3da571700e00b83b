//! The meshes of tables 1 to 3 and figures 7 and 8, and the walks around them.

use std::path::{Path, PathBuf};

use anyhow::Result;
use indicatif::ProgressBar;
use meshweft::Limits;
use meshweft::files::Document;
use meshweft::operations::{
    CameraPath, EvictionPolicy, LodWalkOptions, LodWalkReport, WalkRecorder, WalkedMesh,
};

use super::printed::{MODELS, PrintedModel, TOLERANCE};
use super::walked::{Faster, POLICIES, PathWalk, Walked};
use crate::paper::meshes::{LARGE, find, stem};

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
        let full = meshes.filter(|it| it.level.is_none());
        full.map(|it| it.mesh.face_count()).sum()
    }

    pub(super) fn is_large(&self) -> bool {
        self.face_count() > LARGE
    }

    /// The name of its file without endings.
    pub(super) fn stem(&self) -> String {
        stem(&self.file)
    }
}

/// A mesh with all its walks.
pub(super) struct WalkedModel {
    pub(super) printed: Option<&'static PrintedModel>,
    pub(super) mesh: WalkedMesh,
    pub(super) build_seconds: f64,
    /// Of each tolerance each path.
    pub(super) walked: Walked,
}

/// Tolerances: the paper's, and one that gives the paper's load.
pub(super) fn tolerances(load: f64) -> Vec<f64> {
    match load == TOLERANCE {
        true => vec![load],
        false => vec![TOLERANCE, load],
    }
}

/// How many steps a mesh takes.
pub(super) fn steps(load: f64) -> usize {
    1 + tolerances(load).len() * PATHS.len()
}

/// Walks around a mesh.
pub(super) fn walk(
    named: &Named,
    frames: usize,
    load: f64,
    clock: &dyn Fn() -> f64,
    bar: &ProgressBar,
) -> Result<WalkedModel> {
    bar.set_message(format!("{}: levels of detail", named.name));
    let start = clock();
    let recorder = WalkRecorder::new(&named.document, clock)?;
    let build_seconds = clock() - start;
    bar.inc(1);

    // Each path is walked once.
    let mut walks = Vec::new();
    for tolerance in tolerances(load) {
        for (path, (shape, letter)) in PATHS.iter().enumerate() {
            bar.set_message(format!("{}: {tolerance} px, {letter}", named.name));
            let mut options = LodWalkOptions::default();
            options.path = shape.clone();
            options.frames = Some(frames);
            options.tolerance = tolerance;
            let walk = recorder.record(&options, clock, &())?;
            let replay = |policy: EvictionPolicy| walk.replay(policy, clock);
            let reports: Result<Vec<LodWalkReport>, _> = POLICIES.into_iter().map(replay).collect();
            walks.push(PathWalk {
                tolerance,
                letter,
                faster: named.printed.map_or(Faster::default(), |printed| {
                    let [array, first, lru, queue] = printed.speed_ups[path];
                    [Some(array), Some(first), Some(lru), Some(queue), None]
                }),
                overfull: walk.limited_frames(),
                most_active: walk.path().most_active(),
                distinct: walk.path().distinct_vertices(),
                fewest: walk.path().fewest_inserts(options.slots),
                slots: options.slots,
                vertex_size: options.vertex_size,
                frames: reports?.into_iter().map(|report| report.frames).collect(),
            });
            bar.inc(1);
        }
    }
    Ok(WalkedModel {
        printed: named.printed,
        mesh: recorder.mesh(),
        build_seconds,
        walked: Walked {
            name: named.name.clone(),
            stem: named.stem(),
            walks,
        },
    })
}
