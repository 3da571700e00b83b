//! `terrain`: heights on a grid, coarse where it cannot be seen.

mod build;
mod extract;
mod heights;
mod verify;
mod walk;

use anyhow::Result;
use clap::{Args, Subcommand};

use build::Build;
use extract::Extract;
use verify::Verify;
use walk::Walk;

#[derive(Debug, Args)]
pub(crate) struct Terrain {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Write a terrain with every level of detail to a .mwt file
    ///
    /// Height maps are PNG and PGM images in grey, GeoTIFF, SRTM tiles (.hgt) and USGS models (.dem), each also followed by .gz. Several
    /// that lie beside each other become one terrain without cracks; where they share samples, those of the first one are taken, and it is
    /// said how far they disagree. Voids are holes unless --fill is given.
    /// Points at any places, of meshes or without faces, become a terrain too. What is written is read back and compared, bit for bit.
    ///
    ///   meshweft terrain build N47W123.hgt.gz N48W123.hgt.gz -o puget.mwt --fill
    ///   meshweft terrain build hills.png -o hills.mwt --spacing 160,160 --height-scale .1
    ///   meshweft terrain build scan.ply -o scan.mwt --up z
    ///   meshweft terrain build valley.dem --dry-run --json
    #[command(verbatim_doc_comment)]
    Build(Build),
    /// Take one surface from a terrain
    ///
    /// Of a .mwt file only the blocks are read that the surface needs. With --error no height is farther from it than that, vertically; 0
    /// gives all heights. Positions are metres from the middle of the grid: x to the east, y up, z to the south. Each face has a side in
    /// common with the one before, but at holes, and vertices come by their first use.
    ///
    ///   meshweft terrain extract puget.mwt --error 10 -o coarse.glb
    ///   meshweft terrain extract N47W122.hgt.gz --faces 10000 -o small.ply
    ///   meshweft terrain extract puget.mwt --camera cameras.json --frame 3 --tolerance 1 --size 1920x1080 -o seen.glb
    #[command(verbatim_doc_comment)]
    Extract(Extract),
    /// Move the eye over a terrain, and count what each frame sends to a graphics card
    ///
    /// Each frame draws the surface that keeps the tolerance in the picture. Its vertices are kept in the slots of a vertex buffer, its faces in an
    /// index buffer of slots; only what is new is sent. Memory is in proportion to what is drawn, not to the terrain, and of a .mwt file only
    /// what the path needs is read.
    ///
    /// Paths are measured in the width W of the terrain, from west to east, with a field of view of 45 degrees. The eye is 3000 m above 0
    /// where W is 92160 m, 1900 to 3700 m on the path fly, and as much higher or lower as W is more or less. Where that would be less than a tenth above
    /// the highest place, the path is lifted.
    ///
    ///   meshweft terrain walk puget.mwt --path fly --optimum --plot frames.svg
    ///   meshweft terrain walk puget.mwt --path straight --frames 1000 --slots 16384 --passes --json
    ///   meshweft terrain walk N47W122.hgt.gz --path cameras.json --limit 20000
    #[command(verbatim_doc_comment)]
    Walk(Walk),
    /// Measure how far a terrain is off, at every height
    ///
    /// On a path: in pixels, for every height in the picture, in some of its frames. With --error: in metres, for every height, of the surface of
    /// that error. Also counted are places that no face covers, voids that are covered, heights in two faces, turned faces, and cracks. Exits with 1 if
    /// any height is farther off than asked for, or any of these is not 0. Nothing is taken from what the file says of its errors. SOURCE are the
    /// height maps or the points of which the file was built, read again with the same flags; without them it is compared with its own heights, over
    /// points with those of its vertices that are points.
    ///
    ///   meshweft terrain verify puget.mwt N47W123.hgt.gz N48W123.hgt.gz --fill --path fly --tolerance 1
    ///   meshweft terrain verify puget.mwt --error 10 --json
    ///   meshweft terrain verify scan.mwt scan.ply --up z --error 0.5
    #[command(verbatim_doc_comment)]
    Verify(Verify),
}

pub(crate) fn run(arguments: &Terrain) -> Result<()> {
    match &arguments.verb {
        Verb::Build(arguments) => build::run(arguments),
        Verb::Extract(arguments) => extract::run(arguments),
        Verb::Walk(arguments) => walk::run(arguments),
        Verb::Verify(arguments) => verify::run(arguments),
    }
}
