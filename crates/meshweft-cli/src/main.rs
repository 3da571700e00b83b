//! The program `meshweft`: optimise, simplify, compress, inspect and compare mesh files.
#![forbid(unsafe_code)]

mod caches;
mod columns;
mod compare;
mod compress;
mod cull;
mod decompress;
mod demo;
mod inspect;
mod levels;
mod lod;
mod optimize;
mod paper;
mod plot;
mod raster;
mod run;
mod simplify;
mod terrain;
mod usage;
mod walks;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use compare::Compare;
use compress::Compress;
use cull::Cull;
use decompress::Decompress;
use demo::Demo;
use inspect::Inspect;
use levels::Levels;
use lod::Lod;
use optimize::Optimize;
use paper::Paper;
use run::output::is_broken_pipe;
use simplify::Simplify;
use terrain::Terrain;
use usage::Usage;

/// Puts the triangles of a mesh in the order in which a GPU transforms each vertex about once.
#[derive(Debug, Parser)]
#[command(name = "meshweft", version, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Re-order the faces and vertices of a file and keep every other byte
    ///
    /// Faces are put in the order in which a vertex cache misses least, vertices in the order of
    /// their first use, more than 65,536 in blocks of that many. Nothing else in the file changes. A mesh
    /// whose order would not get better is left as it is.
    ///
    ///   meshweft optimize scene.glb -o ordered.glb
    ///   meshweft optimize scan.ply --in-place --cache nvidia --effort best --json
    ///   meshweft optimize assets -o ordered --jobs 8 --keep-going --manifest done.jsonl
    #[command(verbatim_doc_comment)]
    Optimize(Optimize),
    /// Take faces away and keep what every vertex stores
    ///
    /// Vertices leave one after the other, the least noticeable first; none is moved, and none is invented.
    /// So texture coordinates, skins and morph targets stay as they are. The primitives of a glTF mesh keep
    /// meeting where they meet, and so do the sides of seams. What is left is ordered as by optimize.
    /// Give --ratio, --faces or --error; of several, it stops at whichever comes first.
    ///
    ///   meshweft simplify scan.ply --ratio .1 -o coarse.ply
    ///   meshweft simplify scene.glb --error .5% --in-place
    ///   meshweft simplify assets --faces 5000 --effort best -o coarse --keep-going --json
    #[command(verbatim_doc_comment)]
    Simplify(Simplify),
    /// Add levels of detail to a file: one ordinary GLB that every loader shows
    ///
    /// Each level is an index list over the first vertices of the views that are there, in an order of its own; nodes name
    /// their levels by MSFT_lod, with the share of a picture below which each is enough. What was there keeps its bytes, but
    /// vertices change places. Skins, morph targets, seams and meshes of several primitives stay whole, and all objects have
    /// one error budget.
    ///
    ///   meshweft levels scene.glb -o levels.glb
    ///   meshweft levels scene.glb --ratios 0.5,0.2,0.05 --effort best -o levels.glb
    ///   meshweft levels scan.ply --errors .1%,.5%,2% -o scan.glb
    ///   meshweft levels scene.glb --layout stream -o streamed.glb
    ///   meshweft levels --ranges streamed.glb --json
    #[command(verbatim_doc_comment)]
    Levels(Levels),
    /// Store the positions and faces of a file in few bytes, in the order to be drawn
    ///
    /// Every mesh comes back with each face and vertex, whatever its edges: nothing is split or joined. The result is
    /// decoded and compared before it is written. Vertices and faces get another order: that in which each vertex
    /// is sent once to a first-in first-out buffer. Names of meshes, positions and faces are stored. A file that holds
    /// anything else is refused, unless --drop-attributes leaves it out: no attribute, material, group or node is lost
    /// without a word.
    ///
    ///   meshweft compress scan.ply -o scan.mwz
    ///   meshweft compress scene.glb -o scene.mwz --position-bits 14 --drop-attributes
    #[command(verbatim_doc_comment)]
    Compress(Compress),
    /// Turn a .mwz file into a mesh file
    ///
    ///   meshweft decompress scan.mwz -o scan.glb
    #[command(verbatim_doc_comment)]
    Decompress(Decompress),
    /// Say which faces need not be drawn, from wherever a mesh is seen
    Cull(Cull),
    /// Make, extract, walk around and measure view-dependent levels of detail
    Lod(Lod),
    /// Make, extract, walk over and measure terrain
    Terrain(Terrain),
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

fn main() -> ExitCode {
    let done = match &Arguments::parse().verb {
        Verb::Optimize(arguments) => optimize::run(arguments),
        Verb::Simplify(arguments) => simplify::run(arguments),
        Verb::Levels(arguments) => levels::run(arguments),
        Verb::Compress(arguments) => compress::run(arguments),
        Verb::Decompress(arguments) => decompress::run(arguments),
        Verb::Cull(arguments) => cull::run(arguments),
        Verb::Lod(arguments) => lod::run(arguments),
        Verb::Terrain(arguments) => terrain::run(arguments),
        Verb::Inspect(arguments) => inspect::run(arguments),
        Verb::Compare(arguments) => compare::run(arguments),
        Verb::Demo(arguments) => demo::run(arguments),
        Verb::Paper(arguments) => paper::run(arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {}", usage::message(&error));
            ExitCode::from(match error.is::<Usage>() {
                true => 2,
                false => 1,
            })
        }
    }
}
