//! `paper`: a paper's tables beside ours.

mod arguments;
mod bogomjakov_gotsman;
mod figure;
mod irregular;
mod kim_lee;
mod lario;
mod levels;
mod lin_yu;
mod lin_zhang;
mod meshes;

use anyhow::Result;
use clap::{Args, Subcommand};

use arguments::OfPaper;
use bogomjakov_gotsman::BogomjakovGotsman;
use kim_lee::KimLee;
use lario::Lario;
use lin_zhang::LinZhang;

#[derive(Debug, Args)]
pub(crate) struct Paper {
    #[command(subcommand)]
    paper: WhichPaper,
}

#[derive(Debug, Subcommand)]
enum WhichPaper {
    /// Lin, Yu: An Improved Vertex Caching Scheme for 3D Mesh Rendering (2006)
    ///
    /// Figures 3 and 6 to 12, on the meshes that are found.
    ///
    ///   meshweft paper lin-yu --data folder-with-meshes
    #[command(verbatim_doc_comment)]
    LinYu(OfPaper),
    /// Bogomjakov, Gotsman: Universal Rendering Sequences for Transparent Vertex Caching (2002)
    ///
    /// Figures 3, 4, 6, 7 and 8 and tables 1 and 2, and the universality table of Lin and Yu's figure 10 with
    /// every order that is available, on the meshes that are found and on irregular ones made here.
    ///
    ///   meshweft paper bogomjakov-gotsman --data folder-with-meshes
    ///   meshweft paper bogomjakov-gotsman --data folder-with-meshes --pictures folder
    #[command(verbatim_doc_comment)]
    BogomjakovGotsman(BogomjakovGotsman),
    /// Lin, Zhang: Joint Connectivity Compression and Mesh Rendering
    ///
    /// Tables 1 and 2 and figures 3 and 4, on the meshes that are found: bits of each part, how often the
    /// paper's guesses are right, how large the buffer must be in which each vertex is sent once, and what small
    /// caches miss in that order, as it is and reordered inside windows.
    ///
    ///   meshweft paper lin-zhang --data folder-with-meshes
    ///   meshweft paper lin-zhang --data folder-with-meshes --pictures folder
    #[command(verbatim_doc_comment)]
    LinZhang(LinZhang),
    /// Kim, Lee: Mesh Clustering and Reordering Based on Normal Locality for Efficient Rendering (2022)
    ///
    /// Tables 1 to 4 and figures 9, 10 and 13, on the meshes that are found and on spheres made here: how long it
    /// takes to put faces in stripes by their normals, how many of the back faces are then left out from where, by how
    /// many calls the rest is drawn, and what vertices cost. Frame times are not measured here.
    ///
    ///   meshweft paper kim-lee --data folder-with-meshes
    ///   meshweft paper kim-lee --data folder-with-meshes --pictures folder
    #[command(verbatim_doc_comment)]
    KimLee(KimLee),
    /// Lario, Pajarola, Tirado: Cached Geometry Manager for View-dependent LOD Rendering (2005)
    ///
    /// Tables 1 to 3 and figures 7 and 8, on the meshes that are found or named: how many vertices each policy inserts on
    /// three paths around a mesh, whether they are ordered as in the paper or why not, what is sent, and how long the level
    /// of detail, the slots and the indices take. Tables 4 and 5 and figures 10 and 11 are the same of terrain. Each path is walked
    /// once and drawn by every policy.
    ///
    ///   meshweft paper lario --data folder-with-meshes-and-terrain
    ///   meshweft paper lario dragon.ply.gz --pictures folder
    ///   meshweft paper lario --terrain N47W122.hgt.gz N47W123.hgt.gz N48W123.hgt.gz
    #[command(verbatim_doc_comment)]
    Lario(Lario),
}

/// Prints the figures of a paper for the meshes that are found.
pub(crate) fn run(arguments: &Paper) -> Result<()> {
    match &arguments.paper {
        WhichPaper::LinYu(arguments) => lin_yu::run(arguments),
        WhichPaper::BogomjakovGotsman(arguments) => bogomjakov_gotsman::run(arguments),
        WhichPaper::LinZhang(arguments) => lin_zhang::run(arguments),
        WhichPaper::KimLee(arguments) => kim_lee::run(arguments),
        WhichPaper::Lario(arguments) => lario::run(arguments),
    }
}
