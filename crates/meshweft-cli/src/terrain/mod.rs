//! `terrain`: heights on a grid, coarse where it cannot be seen.

mod build;
mod extract;
mod heights;

use anyhow::Result;
use clap::{Args, Subcommand};

use build::Build;
use extract::Extract;

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
    /// said how far they disagree. Voids are holes unless --fill is given. What is written is read back and compared, bit for bit.
    ///
    ///   meshweft terrain build N47W123.hgt.gz N48W123.hgt.gz -o puget.mwt --fill
    ///   meshweft terrain build hills.png -o hills.mwt --spacing 160,160 --height-scale .1
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
}

pub(crate) fn run(arguments: &Terrain) -> Result<()> {
    match &arguments.verb {
        Verb::Build(arguments) => build::run(arguments),
        Verb::Extract(arguments) => extract::run(arguments),
    }
}
