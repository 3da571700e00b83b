//! Tables 1 to 5 and figures 7, 8, 10 and 11 of Lario, Pajarola and Tirado, beside ours: the first three and two on meshes, the others
//! on terrain.

mod figures;
mod ground;
mod models;
mod pictures;
mod policy_order;
mod printed;
mod tables;
mod walked;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Result, anyhow};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use meshweft::operations::{LodWalkOptions, TerrainWalkOptions};

use super::figure::{MakeFigure, print};
use super::meshes::none_like;
use crate::run::output::Report;
use crate::usage::Usage;
use figures::{along_the_path, times};
use ground::{Ground, WalkedGround};
use models::{Named, WalkedModel};
use tables::{table_1, table_2, table_3, table_4, table_5, terrain};
use walked::Walked;

#[derive(Debug, Args)]
pub(super) struct Lario {
    /// Meshes to walk around instead of the paper's: files of any format that is read
    #[arg(value_name = "MESH", required_unless_present_any = ["data", "terrain"])]
    meshes: Vec<PathBuf>,
    /// Height maps that make one terrain to walk over instead of the paper's, or a .mwt file. Voids of height maps are filled; of images make a .mwt file
    /// first, which says how far places are apart
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with = "data")]
    terrain: Vec<PathBuf>,
    /// A folder with the paper's meshes (hand.off, dragon.ply, happy.ply, optionally followed by .gz), or one that
    /// contains a folder `meshes`; and with tiles of its terrain (N47W122.hgt, N47W123.hgt, N48W123.hgt, likewise), or a folder
    /// `terrain` of these
    #[arg(long, value_name = "DIR", conflicts_with = "meshes")]
    data: Option<PathBuf>,
    /// Leave out meshes and terrain of more than 200 thousand faces
    #[arg(long)]
    skip_large: bool,
    /// How many frames each path has [default: 1000 around meshes, 3000 over terrain, as in the paper]
    #[arg(long, value_name = "N")]
    frames: Option<usize>,
    /// A second tolerance for meshes beside the paper's 1.5 pixels: the default gives a mesh of 870 thousand faces the paper's load
    #[arg(long, value_name = "PIXELS", default_value_t = 0.12)]
    tolerance: f64,
    /// Also draw figures 7 and 8, of the second tolerance, and 10 and 11 over the frames, as SVG files in this folder
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// Let --pictures replace files that another program wrote
    #[arg(long, requires = "pictures")]
    force: bool,
    #[command(flatten)]
    report: Report,
}

/// The figures that are drawn of meshes, and those of terrain.
const PICTURES: [pictures::Figures; 2] = [["7", "8"], ["10", "11"]];

/// Prints the tables for the meshes and the terrain that are named, or found in the data folder.
pub(super) fn run(arguments: &Lario) -> Result<()> {
    let mut options = LodWalkOptions::default();
    options.frames = arguments.frames;
    options.tolerance = arguments.tolerance;
    options
        .check()
        .map_err(|error| Usage(format!("--{error}")))?;

    // What there is, before any of it is walked around.
    let (meshes, ground) = found(arguments)?;
    if let Some(folder) = &arguments.pictures {
        check_pictures(arguments, folder, &meshes, ground.as_ref())?;
    }

    let (models, ground) = walk_all(arguments, &meshes, ground)?;
    let meshes: Vec<&Walked> = models.iter().map(|it| &it.walked).collect();
    let grounds: Vec<&Walked> = ground.iter().map(|it| &it.walked).collect();
    let mut written = Vec::new();
    if let Some(folder) = &arguments.pictures {
        let load = Some(arguments.tolerance);
        written.extend(pictures::write(folder, PICTURES[0], &meshes, load)?);
        written.extend(pictures::write(folder, PICTURES[1], &grounds, None)?);
    }

    // Tables of what is there.
    let of_meshes: [MakeFigure<'_>; 5] = [
        ("Table 1", "table_1", &|| Ok(table_1(&models))),
        ("Table 2", "table_2", &|| Ok(table_2(&meshes))),
        ("Table 3", "table_3", &|| Ok(table_3(&meshes))),
        ("Fig. 7", "figure_7", &|| Ok(times("mesh", &meshes))),
        ("Fig. 8", "figure_8", &|| {
            Ok(along_the_path("mesh", &meshes))
        }),
    ];
    let of_terrain: [MakeFigure<'_>; 5] = [
        ("Terrain", "terrain", &|| {
            let ground = ground.as_ref().expect("printed if there is one");
            Ok(terrain(ground))
        }),
        ("Table 4", "table_4", &|| Ok(table_4(&grounds))),
        ("Table 5", "table_5", &|| Ok(table_5(&grounds))),
        ("Fig. 10", "figure_10", &|| Ok(times("terrain", &grounds))),
        ("Fig. 11", "figure_11", &|| {
            Ok(along_the_path("terrain", &grounds))
        }),
    ];
    let figures = [(&of_meshes, &meshes), (&of_terrain, &grounds)];
    let figures = figures.iter().filter(|(_, walked)| !walked.is_empty());
    let figures: Vec<MakeFigure<'_>> = figures.flat_map(|(figures, _)| **figures).collect();
    print(&arguments.report, "ISBN 80-903100-7-9", &figures, &written)
}

/// The meshes and the terrain that are named, or in the data folder.
fn found(arguments: &Lario) -> Result<(Vec<Named>, Option<Ground>)> {
    let (mut meshes, mut ground) = match &arguments.data {
        Some(folder) => (Named::in_folder(folder)?, Ground::in_folder(folder)?),
        None => {
            let named = arguments.meshes.iter().map(|file| Named::file(file));
            let ground = match arguments.terrain.as_slice() {
                [] => None,
                files => Some(Ground::of(files)?),
            };
            (named.collect::<Result<Vec<_>>>()?, ground)
        }
    };
    if let Some(folder) = &arguments.data
        && meshes.is_empty()
        && ground.is_none()
    {
        let none = none_like(folder, "dragon.ply, hand.off or happy.ply");
        return Err(anyhow!(
            "{none}; and for tiles of its terrain, such as N47W123.hgt, also in a folder `terrain`"
        ));
    }
    if arguments.skip_large {
        meshes.retain(|it| !it.is_large());
        ground = ground.filter(|it| !it.is_large());
    }
    match meshes.is_empty() && ground.is_none() {
        true => Err(Usage("everything is left out by --skip-large".to_owned()).into()),
        false => Ok((meshes, ground)),
    }
}

/// Refuses a folder in which a picture would replace a file of others.
fn check_pictures(
    arguments: &Lario,
    folder: &Path,
    meshes: &[Named],
    ground: Option<&Ground>,
) -> Result<()> {
    let stems: Vec<String> = meshes.iter().map(Named::stem).collect();
    let letters = models::PATHS.map(|(_, letter)| letter);
    pictures::check(folder, PICTURES[0], &stems, &letters, arguments.force)?;
    let stems: Vec<String> = ground.iter().map(|it| it.stem.clone()).collect();
    let letters = ground::PATHS.map(|(_, letter)| letter);
    pictures::check(folder, PICTURES[1], &stems, &letters, arguments.force)
}

/// Walks around all meshes and over the terrain.
fn walk_all(
    arguments: &Lario,
    meshes: &[Named],
    ground: Option<Ground>,
) -> Result<(Vec<WalkedModel>, Option<WalkedGround>)> {
    // One bar for all.
    let of_meshes = meshes.len() * models::steps(arguments.tolerance);
    let of_ground = ground.as_ref().map_or(0, |_| ground::STEPS);
    let style = ProgressStyle::with_template("[{elapsed}] {msg} {wide_bar} {pos}/{len}")?;
    let bar = match arguments.report.shows_progress() {
        true => ProgressBar::new((of_meshes + of_ground) as u64).with_style(style),
        false => ProgressBar::hidden(),
    };
    bar.enable_steady_tick(Duration::from_millis(500));

    // Meshes, then terrain; each with its own number of frames, unless one is given.
    let start = Instant::now();
    let clock = || start.elapsed().as_secs_f64();
    let frames = arguments.frames.unwrap_or(FRAMES);
    let load = arguments.tolerance;
    let models = meshes
        .iter()
        .map(|it| models::walk(it, frames, load, &clock, &bar));
    let models = models.collect::<Result<Vec<_>>>()?;

    let mut options = TerrainWalkOptions::default();
    options.frames = arguments.frames;
    let frames = options.path.frame_count(options.frames);
    let ground = ground.map(|it| ground::walk(it, frames, &clock, &bar));
    let ground = ground.transpose()?;
    bar.finish_and_clear();
    Ok((models, ground))
}

/// Frames of a path around a mesh, as in the paper.
const FRAMES: usize = 1000;
