//! `cull`: tables that say which faces need not be drawn.

mod build;
mod stats;

use anyhow::Result;
use clap::{Args, Subcommand};

use build::Build;
use stats::Stats;

#[derive(Debug, Args)]
pub(crate) struct Cull {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Put faces in clusters that are seen from the same sides, and add a table that says from where
    ///
    /// Any viewer shows the file as before. A renderer that reads the table draws, for each eye, the clusters that it may
    /// see, by few draws; no face that faces the eye is left out. A .gltf or .glb keeps all other bytes; the table is the
    /// extension MESHWEFT_culling of a primitive. Of a file of another format a .glb of its positions and faces is made.
    /// Faces that are transparent or seen from both sides keep their order; what joints or morph targets move gets no
    /// table. Numbers of vertices stay: run optimize on the result to number them in the order of their first use.
    ///
    ///   meshweft cull build scene.glb -o culled.glb
    ///   meshweft cull build scan.ply -o culled.glb --drop-attributes
    #[command(verbatim_doc_comment)]
    Build(Build),
    /// Count what such tables leave out, from many sides and distances
    ///
    ///   meshweft cull stats culled.glb
    ///   meshweft cull stats culled.glb --json --plot distances.svg
    #[command(verbatim_doc_comment)]
    Stats(Stats),
}

pub(crate) fn run(arguments: &Cull) -> Result<()> {
    match &arguments.verb {
        Verb::Build(arguments) => build::run(arguments),
        Verb::Stats(arguments) => stats::run(arguments),
    }
}
