//! Table 2 of Bogomjakov and Gotsman on the card at hand.
//!
//! Alexander Bogomjakov, Craig Gotsman: *Universal Rendering Sequences for Transparent Vertex Caching of
//! Progressive Meshes*, Computer Graphics Forum 21(2), 2002, doi:10.1111/1467-8659.00573. They drew each
//! mesh in the order of its file, by recursive cuts, and as triangle strips, on a GeForce 2 whose cache
//! has ten entries. Rates of cards so far apart are compared as ratios: over the file's order.
//!
//! Where the paper leaves room: their strips are those of Xiang, Held and Mitchell, here meshoptimizer's,
//! drawn as strips with restarts. Their card spent its time on vertices; here both a shader of 3,200
//! operations and a cheap one are timed.

use meshweft::Mesh;
use meshweft::cache::{self, CacheModel};
use serde_json::{Value, json};

use crate::bench::sampling;
use crate::draw::Draw;
use crate::error::GpuError;
use crate::meshes::NamedMesh;
use crate::orders::{Sequence, strips};
use crate::renderer::{Renderer, Sampling};
use crate::vulkan::Geometry;
use crate::workload::Workload;

/// A row of the paper's table; each array has the file's order, recursive cut, strips.
#[derive(Debug)]
struct PaperRow {
    mesh: &'static str,
    acmr: [f64; 3],
    frames: [f64; 3],
}

const TABLE_2: [PaperRow; 6] = [
    PaperRow {
        mesh: "buddha",
        acmr: [1.00, 0.81, 1.08],
        frames: [227.0, 240.0, 236.0],
    },
    PaperRow {
        mesh: "bunny",
        acmr: [1.00, 0.83, 1.08],
        frames: [228.0, 229.0, 185.0],
    },
    PaperRow {
        mesh: "bunny simp.",
        acmr: [2.76, 0.81, 1.06],
        frames: [1299.0, 2439.0, 2222.0],
    },
    PaperRow {
        mesh: "face",
        acmr: [1.34, 0.83, 1.10],
        frames: [418.0, 680.0, 546.0],
    },
    PaperRow {
        mesh: "flipper",
        acmr: [1.84, 0.83, 1.10],
        frames: [508.0, 1299.0, 787.0],
    },
    PaperRow {
        mesh: "horse",
        acmr: [2.83, 0.81, 1.09],
        frames: [98.0, 327.0, 205.0],
    },
];

/// What the columns are called.
const ORDERS: [&str; 3] = ["file", "recursive cut", "strips"];

/// Draws every mesh in the paper's three ways and prints the rates over the file's, the paper's table
/// first.
///
/// # Errors
/// If the card has no timestamps, or fails.
pub fn run(renderer: &Renderer<'_>, meshes: &[NamedMesh]) -> Result<Value, GpuError> {
    if !renderer.gpu().times_mean_something() {
        println!("A program draws here, not a card: its rates say nothing of a card.\n");
    }
    println!(
        "Misses a face in a FIFO cache of 10, and frames a second over those of the file's order"
    );

    println!("The paper, GeForce 2:");
    heading();
    for PaperRow { mesh, acmr, frames } in &TABLE_2 {
        line(mesh, "", *acmr, frames.map(|rate| rate / frames[0]));
    }

    println!("This card (strips by meshoptimizer):");
    heading();
    let mut rows = Vec::new();
    for mesh in meshes {
        let ways = Ways::new(renderer, &mesh.mesh)?;
        for workload in [Workload::Compute, Workload::Setup] {
            let mut ns = [0.0; 3];
            for (time, geometry) in ns.iter_mut().zip(&ways.geometries) {
                *time = renderer.time(geometry, workload, ways.sampling)?;
            }
            let shader = workload.to_string();
            line(&mesh.name, &shader, ways.acmr, ns.map(|time| ns[0] / time));
            rows.push(json!({
                "mesh": mesh.name,
                "workload": shader,
                "orders": ORDERS,
                "acmr": ways.acmr,
                "nanoseconds": ns,
            }));
        }
    }
    Ok(Value::Array(rows))
}

/// A mesh in the paper's three ways, on a card that is warm.
#[derive(Debug)]
struct Ways<'g> {
    geometries: Vec<Geometry<'g>>,
    acmr: [f64; 3],
    sampling: Sampling,
}

impl<'g> Ways<'g> {
    fn new(renderer: &Renderer<'g>, mesh: &Mesh) -> Result<Self, GpuError> {
        let strips = strips(mesh);
        let [file, cut] = [Sequence::File, Sequence::RecursiveCut].map(|s| s.applied(mesh));
        let draws = [
            Draw::list(file.faces().as_flattened()),
            Draw::list(cut.faces().as_flattened()),
            Draw::strips(&strips),
        ];
        let positions = [&file, &cut, mesh].map(Mesh::positions);
        let mut geometries = Vec::new();
        for (draw, positions) in draws.iter().zip(positions) {
            geometries.push(renderer.upload(&Draw {
                positions: Some(positions),
                ..*draw
            })?);
        }

        let cache = CacheModel::fifo(10);
        let sampling = sampling(renderer, mesh.face_count());
        renderer.warm_up(&geometries[0], sampling)?;
        Ok(Self {
            geometries,
            acmr: [
                cache::acmr(&file, cache),
                cache::acmr(&cut, cache),
                cache::acmr(&faces_of(&strips)[..], cache),
            ],
            sampling,
        })
    }
}

/// The faces of strips, those without an area left out, as a card does not count them either.
fn faces_of(strips: &[u32]) -> Vec<[u32; 3]> {
    let pieces = strips.split(|&index| index == crate::draw::RESTART);
    let faces = pieces.flat_map(|strip| strip.windows(3).map(|w| [w[0], w[1], w[2]]));
    faces
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect()
}

fn heading() {
    println!(
        "{:<16} {:<10} {:>9} {:>13} {:>9}   {:>9} {:>13} {:>9}",
        "mesh", "shader", ORDERS[0], ORDERS[1], ORDERS[2], ORDERS[0], ORDERS[1], ORDERS[2]
    );
}

fn line(mesh: &str, workload: &str, acmr: [f64; 3], rates: [f64; 3]) {
    let ([a, b, c], [d, e, f]) = (acmr, rates);
    println!("{mesh:<16} {workload:<10} {a:>9.2} {b:>13.2} {c:>9.2}   {d:>9.2} {e:>13.2} {f:>9.2}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_of_strips_are_those_with_three_vertices() {
        let restart = crate::draw::RESTART;
        let strips = [0, 1, 2, 2, 3, restart, 4, 5, restart, 6, 7, 8];
        assert_eq!(faces_of(&strips), [[0, 1, 2], [6, 7, 8]]);
    }
}
