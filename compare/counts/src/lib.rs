//! What `compare/instructions` counts, on meshes that are quick to load.
//!
//! The same code has to compile against two revisions of the library.

use std::hint::black_box;
use std::path::Path;
use std::{fs, io};

use meshweft::order::{self, Effort, KCacheReorder, Optimizer, Target};
use meshweft::{CacheModel, FaceOrder, Mesh, VertexOrder, cache};

#[path = "../../src/counting.rs"]
pub mod counting;
#[path = "../../src/oracle.rs"]
pub mod oracle;

/// Where the meshes are that [`flatten`] wrote.
pub const FOLDER: &str = "MESHWEFT_COUNTS";

/// The five meshes of the README's tables: the name here and the file below `meshes` of the test
/// data.
pub const MESHES: [(&str, &str); 5] = [
    ("fandisk", "fandisk.off.gz"),
    ("bunny", "bunny.ply.gz"),
    ("horse", "horse.obj.gz"),
    ("nefertiti", "nefertiti.obj.gz"),
    ("dragon", "dragon.ply.gz"),
];

/// Writes the faces of the five meshes as plain numbers: reading text under the counting tool takes
/// longer than what is counted.
///
/// # Errors
/// If a mesh cannot be read or written.
pub fn flatten(data: &Path, folder: &Path) -> Result<(), String> {
    fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for (name, file) in MESHES {
        let mesh = oracle::read(&data.join("meshes").join(file))?;
        let vertex_count = u32::try_from(mesh.vertex_count()).map_err(|error| error.to_string())?;
        let corners = mesh.faces().iter().flatten().copied();
        let numbers = std::iter::once(vertex_count).chain(corners);
        let bytes: Vec<u8> = numbers.flat_map(u32::to_le_bytes).collect();
        let path = folder.join(name);
        fs::write(&path, bytes).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}

/// One of the five meshes, from the folder that [`FOLDER`] names. It is never freed, so
/// that freeing is not counted.
///
/// # Panics
/// If [`flatten`] was not run.
#[must_use]
pub fn mesh(name: &str) -> &'static Mesh {
    let read = || -> io::Result<Vec<u8>> {
        let folder = std::env::var_os(FOLDER).ok_or(io::ErrorKind::NotFound)?;
        fs::read(Path::new(&folder).join(name))
    };
    let bytes = read().unwrap_or_else(|error| panic!("{FOLDER}/{name}: {error}"));
    let numbers: Vec<u32> = bytes
        .as_chunks()
        .0
        .iter()
        .map(|&four| u32::from_le_bytes(four))
        .collect();
    let (vertex_count, corners) = numbers.split_first().expect("a number of vertices");
    let faces = corners.as_chunks().0.to_vec();
    let mesh = Mesh::connectivity_only(*vertex_count as usize, faces);
    Box::leak(Box::new(mesh.expect("faces that were written here")))
}

/// Something to count.
#[derive(Debug)]
pub struct Job {
    /// As its benchmark is called.
    pub name: &'static str,
    /// Whether it is quick enough for every mesh.
    pub is_quick: bool,
    /// Does it.
    pub run: fn(&Mesh),
}

/// All that is counted.
pub const JOBS: [Job; 6] = [
    Job {
        name: "fifo12_fast",
        is_quick: true,
        run: |mesh| drop(fifo12_fast(mesh)),
    },
    Job {
        name: "universal_fast",
        is_quick: true,
        run: |mesh| drop(universal_fast(mesh)),
    },
    Job {
        name: "universal_best",
        is_quick: false,
        run: |mesh| drop(universal_best(mesh)),
    },
    Job {
        name: "k_cache_reorder_controllable12",
        is_quick: true,
        run: |mesh| drop(k_cache_reorder_controllable12(mesh)),
    },
    Job {
        name: "misses_fifo16",
        is_quick: true,
        run: |mesh| {
            black_box(misses_fifo16(mesh));
        },
    },
    Job {
        name: "vertex_fetch",
        is_quick: true,
        run: |mesh| drop(vertex_fetch(mesh)),
    },
];

/// The meshes for jobs that are not quick.
pub const SMALL_MESHES: [&str; 2] = ["fandisk", "bunny"];

/// An order for one cache.
#[must_use]
pub fn fifo12_fast(mesh: &Mesh) -> FaceOrder {
    Optimizer::for_cache(CacheModel::fifo(12)).face_order(mesh)
}

/// The order that the program makes when nothing is asked for.
#[must_use]
pub fn universal_fast(mesh: &Mesh) -> FaceOrder {
    Optimizer::default().face_order(mesh)
}

/// The search.
#[must_use]
pub fn universal_best(mesh: &Mesh) -> FaceOrder {
    let optimizer = Optimizer {
        target: Target::Universal,
        effort: Effort::Best,
        ..Optimizer::default()
    };
    optimizer.face_order(mesh)
}

/// The method of Lin and Yu for the cache that their paper proposes.
#[must_use]
pub fn k_cache_reorder_controllable12(mesh: &Mesh) -> FaceOrder {
    let algorithm = KCacheReorder {
        cache: "controllable:12".parse().expect("a cache model"),
        ..KCacheReorder::default()
    };
    algorithm.face_order(mesh)
}

/// A replay of the faces.
#[must_use]
pub fn misses_fifo16(mesh: &Mesh) -> u64 {
    cache::misses(mesh.faces(), CacheModel::fifo(16))
}

/// The vertices by first use.
#[must_use]
pub fn vertex_fetch(mesh: &Mesh) -> VertexOrder {
    first_use(order::vertex_fetch, mesh)
}

fn first_use<'a, A>(by: impl FirstUse<'a, A>, mesh: &'a Mesh) -> VertexOrder {
    by.of(mesh)
}

/// `vertex_fetch` as it is called with faces and a number, and as it is called with a mesh:
/// whichever the revision has.
trait FirstUse<'a, Arguments> {
    fn of(self, mesh: &'a Mesh) -> VertexOrder;
}

impl<'a, F: Fn(&'a [[u32; 3]], usize) -> VertexOrder> FirstUse<'a, (&'a [[u32; 3]], usize)> for F {
    fn of(self, mesh: &'a Mesh) -> VertexOrder {
        self(mesh.faces(), mesh.vertex_count())
    }
}

impl<'a, F: Fn(&'a Mesh) -> VertexOrder> FirstUse<'a, &'a Mesh> for F {
    fn of(self, mesh: &'a Mesh) -> VertexOrder {
        self(mesh)
    }
}
