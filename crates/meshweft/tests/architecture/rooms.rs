//! Rooms: the modules directly below the root, and which may name which.

use std::collections::BTreeSet;

use crate::paths::Names;
use crate::sources::Sources;

/// The rooms from the ground up, with the groups of rooms that each may name beside itself: only
/// such as stand above it in this list, so that every arrow points one way.
const ROOMS: [(&str, &[&[&str]]); 25] = [
    ("error", &[]),
    ("index", &[&["error"]]),
    ("limits", &[BOUNDS]),
    ("parallel", &[BOUNDS]),
    ("random", &[BOUNDS, &["parallel"]]),
    ("progress", &[]),
    ("geometry", &[GROUND]),
    ("bits", &[&["random"]]),
    ("faces", &[BOUNDS]),
    ("first_use", &[BOUNDS, &["faces"]]),
    ("permutation", &[BOUNDS, &["random", "faces"]]),
    ("attribute", &[]),
    ("height_grid", &[BOUNDS]),
    ("mesh", &[GROUND, &["faces", "permutation"]]),
    ("topology", &[GROUND, &["faces"]]),
    ("partition", &[GROUND, &["faces", "topology"]]),
    // What a cache does is known to those who order, not the other way round.
    ("cache", &[GROUND, &["faces", "permutation", "topology"]]),
    ("order", &[GROUND, VALUES, ALGORITHMS]),
    // Its sequences start from orders.
    ("progressive", &[GROUND, VALUES, ALGORITHMS, &["order"]]),
    ("connectivity", &[GROUND, VALUES, &["bits", "topology"]]),
    (
        "compression",
        &[GROUND, VALUES, &["bits", "connectivity", "topology"]],
    ),
    ("culling", &[GROUND, VALUES, ALGORITHMS, &["order"]]),
    // Its hierarchies are made of removals.
    (
        "lod",
        &[GROUND, VALUES, &["bits", "topology", "progressive"]],
    ),
    // Readers and writers know no algorithm, and no algorithm knows them.
    ("files", &[GROUND, VALUES]),
    // The only place that joins both.
    (
        "operations",
        &[
            GROUND,
            VALUES,
            ALGORITHMS,
            &[
                "bits",
                "order",
                "progressive",
                "compression",
                "connectivity",
                "culling",
                "lod",
                "files",
            ],
        ],
    ),
];

const BOUNDS: &[&str] = &["error", "index"];
const GROUND: &[&str] = &["error", "index", "limits", "parallel", "random", "progress"];
const VALUES: &[&str] = &[
    "geometry",
    "faces",
    "first_use",
    "permutation",
    "attribute",
    "height_grid",
    "mesh",
];
const ALGORITHMS: &[&str] = &["topology", "partition", "cache"];

/// What the program may name of the library: these rooms whole …
const OPEN_TO_THE_PROGRAM: [&str; 6] = [
    "operations",
    "cache",
    "connectivity",
    "files",
    "geometry",
    "attribute",
];
/// … the types at the root …
const ROOT_TYPES: [&str; 12] = [
    "Budget",
    "Progress",
    "Mesh",
    "HeightGrid",
    "HeightGridError",
    "Faces",
    "FaceOrder",
    "VertexOrder",
    "Permutation",
    "CacheModel",
    "Limits",
    "MeshError",
];
/// … what says how to order; the ordering is done by `operations`.
const OF_ORDER: [&str; 3] = ["Target", "Effort", "Mode"];
/// … and the history of a mesh, a value that `operations` makes and follows.
const OF_PROGRESSIVE: [&str; 1] = ["History"];

/// The arrows between rooms that the table does not have, a text each.
pub(crate) fn wrong_arrows(sources: &Sources) -> Vec<String> {
    let names = Names::of(sources);
    let mut wrong = Vec::new();
    for (file, paths) in names.paths.iter().enumerate() {
        let source = &sources.files[file];
        // The root shows what there is.
        if source.module.is_empty() {
            continue;
        }
        let Some((room, allowed)) = ROOMS.iter().find(|(room, _)| *room == source.room()) else {
            wrong.push(format!(
                "{}: {} is not a room of the table",
                source.name,
                source.room()
            ));
            continue;
        };
        let mut told = BTreeSet::new();
        for path in paths {
            let Some(definition) = names.definition(file, path) else {
                continue;
            };
            let named = sources.files[definition].room();
            let is_wrong = named != *room && !allowed.concat().contains(&named);
            if is_wrong && told.insert(definition) {
                let path = path.segments.join("::");
                wrong.push(format!(
                    "{}: {room} may not name {named} ({path})",
                    source.name
                ));
            }
        }
    }
    wrong
}

/// What a program names of the library beyond what it may, a text each.
pub(crate) fn wrong_names_of_the_library(program: &Sources) -> Vec<String> {
    let names = Names::of(program);
    let mut wrong = Vec::new();
    for (file, paths) in names.paths.iter().enumerate() {
        let mut told = BTreeSet::new();
        for path in paths {
            let path = names.written_out(file, path);
            let path: Vec<&str> = path.iter().map(String::as_str).take(3).collect();
            let is_allowed = match path[..] {
                ["meshweft", "order", name, ..] => OF_ORDER.contains(&name),
                ["meshweft", "progressive", name, ..] => OF_PROGRESSIVE.contains(&name),
                // Brought in to be named through: what is named then counts.
                ["meshweft"] | ["meshweft", "order"] => true,
                ["meshweft", name, ..] => {
                    OPEN_TO_THE_PROGRAM.contains(&name) || ROOT_TYPES.contains(&name)
                }
                _ => true,
            };
            let path = path.join("::");
            if !is_allowed && told.insert(path.clone()) {
                wrong.push(format!("{}: {path}", program.files[file].name));
            }
        }
    }
    wrong
}

#[test]
fn the_table_points_one_way() {
    for (at, (room, allowed)) in ROOMS.iter().enumerate() {
        for named in allowed.concat() {
            let is_below = ROOMS[..at].iter().any(|(below, _)| *below == named);
            assert!(
                is_below,
                "{room} may name {named}, which does not stand above it"
            );
        }
    }
}

#[test]
fn an_arrow_that_points_upward_is_found() {
    let files = [
        (
            "lib.rs",
            "mod cache;\nmod files;\nmod mesh;\nmod operations;\nmod order;\npub use cache::CacheModel;",
        ),
        (
            "mesh.rs",
            "pub struct Mesh;\nfn up() { crate::operations::optimize() }",
        ),
        ("cache/mod.rs", "mod fifo;\npub enum CacheModel {}"),
        (
            "cache/fifo.rs",
            "use super::CacheModel;\nuse crate::{mesh::Mesh, order::greedy};\nfn f() { greedy::g() }",
        ),
        (
            "order/mod.rs",
            "use crate::{CacheModel, cache, mesh::Mesh};\npub use crate::files::Format;",
        ),
        (
            "files.rs",
            "use crate::CacheModel;\n// crate::order\npub struct Format;\n#[cfg(test)]\nmod tests { use crate::order; }",
        ),
        ("order/greedy.rs", ""),
        (
            "operations.rs",
            "use crate::{files::Format, order::Target};\npub fn optimize() {}",
        ),
        ("attic.rs", ""),
    ];
    let expected = [
        "cache/fifo.rs: cache may not name mesh (crate::mesh::Mesh)",
        "cache/fifo.rs: cache may not name order (greedy::g)",
        "files.rs: files may not name cache (crate::CacheModel)",
        "mesh.rs: mesh may not name operations (crate::operations::optimize)",
        "order/mod.rs: order may not name files (crate::files::Format)",
    ];
    let mut wrong = wrong_arrows(&Sources::planted(&files));
    wrong.sort();
    let (attic, wrong) = wrong.split_first().unwrap();
    assert_eq!(attic, "attic.rs: attic is not a room of the table");
    assert_eq!(wrong, expected);
}

#[test]
fn what_the_program_may_not_name_is_found() {
    let files = [
        (
            "main.rs",
            "mod args;\nuse meshweft::{CacheModel, files::Document, operations};",
        ),
        (
            "args.rs",
            "use meshweft::order::{self, Effort, Grid, Target as Aim};
             fn f() { order::Mode::Fast; order::vertex_fetch(); meshweft::cache::acmr(); Aim::X }
             use meshweft::partition::Graph;
             use meshweft::progressive::{Collapses, History};
             use meshweft::order::*;",
        ),
    ];
    let wrong = wrong_names_of_the_library(&Sources::planted(&files));
    let expected = [
        "args.rs: meshweft::order::Grid",
        "args.rs: meshweft::order::vertex_fetch",
        "args.rs: meshweft::partition::Graph",
        "args.rs: meshweft::progressive::Collapses",
        "args.rs: meshweft::order::*",
    ];
    assert_eq!(wrong, expected);
}
