//! `lod`: detail that follows the eye.

mod build;
mod extract;
mod verify;
mod walk;

use anyhow::Result;
use clap::{Args, Subcommand};

use build::Build;
use extract::Extract;
use verify::Verify;
use walk::Walk;

#[derive(Debug, Args)]
pub(crate) struct Lod {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Write a mesh with every level of detail to a .mwl file
    ///
    /// All meshes of the file become one. What is written is read back and compared: full detail is the input, face for face and
    /// bit for bit, without faces that have two corners at one place and vertices that no face uses. What all vertices store besides their positions is kept. A file that holds more is refused without
    /// --drop-attributes.
    ///
    ///   meshweft lod build scan.ply -o scan.mwl
    ///   meshweft lod build scene.glb -o scene.mwl --drop-attributes
    ///   meshweft lod build scan.ply --dry-run --json
    #[command(verbatim_doc_comment)]
    Build(Build),
    /// Take one mesh from a .mwl file
    ///
    /// Only the blocks of the file are read that the mesh needs. --error 0 gives the mesh that the file was built of, bit for bit, but for
    /// faces with two corners at one place, which the file does not have. Faces and vertices come in an order to be drawn.
    ///
    ///   meshweft lod extract scan.mwl --error .01 -o coarse.glb
    ///   meshweft lod extract scan.mwl --vertices 10000 -o small.ply
    ///   meshweft lod extract scan.mwl --camera cameras.json --frame 3 --tolerance 1 --size 1920x1080 -o seen.glb
    #[command(verbatim_doc_comment)]
    Extract(Extract),
    /// Move the eye around a mesh, and count what each frame sends to a graphics card
    ///
    /// The mesh is refined where its error could be seen and coarsened elsewhere, frame by frame. Its active vertices are
    /// kept in the slots of a vertex buffer, its faces in an index buffer that is patched. All meshes of the file are one here,
    /// with their positions as the file stores them. Only positions and faces count. No mesh is written. Of a .mwl file only what
    /// the path needs is read; all else is counted as for the mesh of which it was made.
    ///
    ///   meshweft lod walk scan.ply
    ///   meshweft lod walk scan.mwl --path zoom
    ///   meshweft lod walk scan.ply --path fly --tolerance .5 --slots 32768 --policy lru --optimum
    ///   meshweft lod walk scan.ply --path cameras.json --json --plot frames.svg
    ///
    /// A file of cameras has one for each frame; fov is in degrees from the bottom of the picture to its top:
    /// `{"fov":45,"frames":[{"eye":[0,0,9],"target":[0,0,0],"up":[0,1,0]}]}`
    #[command(verbatim_doc_comment)]
    Walk(Walk),
    /// Measure how far what is drawn is from the mesh at full detail
    ///
    /// In some frames of a path every vertex at full detail that is in the picture and faces the eye is measured: its distance to
    /// the nearest point of the drawn faces, in pixels, divided by the tolerance. Nothing is estimated. A face is turned if it
    /// looks against the mean of the normals that its vertices have at full detail. Nothing is written.
    ///
    ///   meshweft lod verify scan.ply
    ///   meshweft lod verify scan.mwl --path zoom --frames 20 --tolerance .5
    ///   meshweft lod verify scan.ply --path cameras.json --min-share 99.9 --max-error 2.5 --json
    #[command(verbatim_doc_comment)]
    Verify(Verify),
}

pub(crate) fn run(arguments: &Lod) -> Result<()> {
    match &arguments.verb {
        Verb::Build(arguments) => build::run(arguments),
        Verb::Extract(arguments) => extract::run(arguments),
        Verb::Walk(arguments) => walk::run(arguments),
        Verb::Verify(arguments) => verify::run(arguments),
    }
}
