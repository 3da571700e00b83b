//! The terrain of tables 4 and 5 and figures 10 and 11, and the walks over it.

use std::path::{Path, PathBuf};

use anyhow::Result;
use indicatif::ProgressBar;
use meshweft::operations::{
    TerrainError, TerrainFacts, TerrainHeights, TerrainPath, TerrainReadOptions, TerrainSource,
    TerrainWalkOptions, TerrainWalker, WalkFrame,
};

use super::printed::GROUND;
use super::walked::{Faster, POLICIES, PathWalk, Walked};
use crate::paper::meshes::{LARGE, stem};

/// The paths, the first three with the paper's letters.
pub(super) const PATHS: [(TerrainPath, &str); 4] = [
    (TerrainPath::Circle, "A"),
    (TerrainPath::Rotate, "B"),
    (TerrainPath::Straight, "C"),
    (TerrainPath::Fly, "D"),
];

/// A terrain to walk over.
pub(super) struct Ground {
    /// With a star if it is of the same place as the paper's.
    pub(super) name: String,
    pub(super) stem: String,
    pub(super) counts: GroundCounts,
    kind: Kind,
}

/// What became of heights that were read.
#[derive(Clone, Copy, Default)]
pub(super) struct GroundCounts {
    /// Voids that were filled.
    pub(super) filled: usize,
    /// Places at which two files differ.
    pub(super) disagreeing: usize,
}

/// What it is made of.
enum Kind {
    Heights(Box<TerrainHeights>),
    /// A `.mwt` file.
    Stored(TerrainSource),
}

impl Ground {
    /// The tiles of the paper's terrain that are in a folder, as one.
    pub(super) fn in_folder(folder: &Path) -> Result<Option<Self>> {
        let folders = [folder.to_owned(), folder.join("terrain")];
        let tile = |name: &&str| {
            let names = [format!("{name}.hgt"), format!("{name}.hgt.gz")];
            let mut paths = folders
                .iter()
                .flat_map(|folder| names.iter().map(|name| folder.join(name)));
            paths.find(|path| path.is_file())
        };
        let tiles: Vec<PathBuf> = GROUND.files.iter().filter_map(tile).collect();
        match tiles.is_empty() {
            true => Ok(None),
            false => Self::of(&tiles).map(Some),
        }
    }

    /// Height maps that become one terrain, with their voids filled, or a `.mwt` file.
    pub(super) fn of(files: &[PathBuf]) -> Result<Self> {
        let mut options = TerrainReadOptions::default();
        options.fill_voids = true;
        let (kind, counts) = match TerrainHeights::open(files, &options) {
            Ok(heights) => {
                let counts = GroundCounts {
                    filled: heights.filled,
                    disagreeing: heights.disagreeing,
                };
                (Kind::Heights(Box::new(heights)), counts)
            }
            Err(TerrainError::Built { .. }) if files.len() == 1 => {
                let source = TerrainSource::open(files, &options)?;
                (Kind::Stored(source), GroundCounts::default())
            }
            Err(error) => return Err(error.into()),
        };
        let stems: Vec<String> = files.iter().map(|file| stem(file)).collect();
        let is_like_the_papers = stems.iter().all(|it| GROUND.files.contains(&it.as_str()));
        Ok(Self {
            name: match is_like_the_papers {
                true => format!("{}*", GROUND.name),
                false => stems[0].clone(),
            },
            stem: stems[0].clone(),
            counts,
            kind,
        })
    }

    /// Whether it has more faces than a mesh that is left out.
    pub(super) fn is_large(&self) -> bool {
        let Kind::Heights(heights) = &self.kind else {
            return false;
        };
        let size = heights.grid().map(|grid| grid.size());
        size.is_some_and(|size| 2 * size[0] as usize * size[1] as usize > LARGE)
    }
}

/// A terrain with all its walks.
pub(super) struct WalkedGround {
    pub(super) facts: TerrainFacts,
    pub(super) counts: GroundCounts,
    pub(super) build_seconds: f64,
    /// Of each path.
    pub(super) walked: Walked,
}

/// How many steps a terrain takes.
pub(super) const STEPS: usize = 1 + PATHS.len();

/// Walks over a terrain, at the paper's tolerance.
pub(super) fn walk(
    ground: Ground,
    frames: usize,
    clock: &dyn Fn() -> f64,
    bar: &ProgressBar,
) -> Result<WalkedGround> {
    bar.set_message(format!("{}: levels of detail", ground.name));
    let start = clock();
    let source = match ground.kind {
        Kind::Heights(heights) => TerrainSource::of_heights(*heights)?,
        Kind::Stored(source) => source,
    };
    let build_seconds = clock() - start;
    let mut walker = TerrainWalker::new(source);
    bar.inc(1);

    // Each path is walked once, if all its frames fit into the slots.
    let mut walks = Vec::new();
    for (path, (shape, letter)) in PATHS.iter().enumerate() {
        let mut options = TerrainWalkOptions::default();
        options.path = shape.clone();
        options.frames = Some(frames);
        options.optimum = true;
        bar.set_message(format!(
            "{}: {} px, {letter}",
            ground.name, options.tolerance
        ));
        let mut reports = walker.walk(&options, &POLICIES, clock, &())?;
        let vertices = |frame: &WalkFrame| frame.vertices;
        let needed = reports[0].frames.iter().map(vertices);
        let overfull = needed.filter(|it| *it > options.slots).count();
        if overfull > 0 {
            // Again with the best surfaces that fit, as the paper asks of an application.
            options.limit = Some(options.slots);
            reports = walker.walk(&options, &POLICIES, clock, &())?;
        }
        let drawn = reports[0].frames.iter().map(vertices);
        let optimum = reports[0].optimum;
        let printed = GROUND.faster.get(path);
        walks.push(PathWalk {
            tolerance: options.tolerance,
            letter,
            faster: printed.map_or(Faster::default(), |&[first, lru, queue]| {
                [None, Some(first), Some(lru), Some(queue), None]
            }),
            overfull,
            most_active: drawn.max().unwrap_or_default(),
            distinct: reports[0].distinct[0],
            fewest: optimum.and_then(|optimum| optimum.fewest_inserts),
            slots: options.slots,
            vertex_size: options.vertex_size,
            frames: reports.into_iter().map(|report| report.frames).collect(),
        });
        bar.inc(1);
    }
    Ok(WalkedGround {
        facts: walker.terrain(),
        counts: ground.counts,
        build_seconds,
        walked: Walked {
            name: ground.name,
            stem: ground.stem,
            walks,
        },
    })
}
