//! The paper's Table 4: single meshes from four radii.

use meshweft::culling::Eye;
use serde_json::Value;

use super::{Timed, prepared, ratio};
use crate::cull::camera::{Camera, ball, direction};
use crate::cull::cullers::cullers;
use crate::cull::lattice::on_lattice;
use crate::error::GpuError;
use crate::frames::{Frames, Shading};
use crate::meshes::NamedMesh;
use crate::random::Random;

/// A mesh of the paper's Table 4, its faces, milliseconds without and with stripes.
type PaperRow = (&'static str, usize, f64, f64);

const TABLE_4: [PaperRow; 11] = [
    ("Spot", 5_856, 2.67, 2.96),
    ("Vase", 21_312, 2.77, 2.97),
    ("Venus", 39_569, 6.97, 3.84),
    ("Sphere", 65_024, 7.8, 5.14),
    ("Bunny", 69_630, 11.81, 6.31),
    ("Armadillo", 212_574, 34.14, 16.63),
    ("Hand", 654_666, 107.53, 64.95),
    ("Dragon", 871_414, 139.69, 86.01),
    ("Venus & Cupid", 960_026, 149.0, 86.39),
    ("Buddha", 1_087_451, 167.79, 102.76),
    ("Demon", 1_363_152, 216.6, 115.1),
];

/// The paper's distance for single meshes, in radii.
const DISTANCE: f64 = 4.0;

/// Times meshes from some directions, and prints them over the whole in the card's order, the paper's first.
pub(super) fn run(
    frames: &Frames<'_, '_>,
    meshes: &[NamedMesh],
    directions: u32,
) -> Result<Value, GpuError> {
    println!("\nOne mesh from {DISTANCE} radii: times over those of the whole");
    for (name, faces, without, with) in TABLE_4 {
        let name = format!("{name}, {faces} faces");
        println!(
            "the paper: {name:<28} {without:>8.2} ms, with stripes {}",
            ratio(with, without)
        );
    }
    println!(
        "{:<16} {:<8} {:<10} {:>12} {:>8} {:>8} {:>12}",
        "mesh", "shader", "culler", "ms", "time", "draws", "ranges, us"
    );
    let mut rows = Vec::new();
    for (NamedMesh { name, mesh }, seed) in meshes.iter().zip(1..) {
        let Some(around) = ball(mesh) else { continue };
        let cullers = cullers(mesh, frames.renderer().gpu().card());
        let names: Vec<String> = cullers.iter().map(|culler| culler.name.clone()).collect();
        let prepared = prepared(frames, mesh, cullers)?;
        for shading in Shading::ALL {
            // All directions added up.
            let mut random = Random::new(seed);
            let mut sum: Option<Timed> = None;
            for _ in 0..directions {
                let way = direction(&mut random);
                let distance = DISTANCE * around.radius;
                let eye = [0, 1, 2].map(|axis| around.center[axis] + distance * way[axis]);
                let view = Camera::new(Eye::at(on_lattice(eye)), around, 1.0).view([0.0; 3]);
                let timed = Timed::new(frames, &prepared, &[(eye, view)], shading)?;
                match &mut sum {
                    None => sum = Some(timed),
                    Some(sum) => sum.add(&timed),
                }
            }
            let Some(timed) = sum else { continue };

            // The second is the whole in the card's order.
            for (at, culler) in names.iter().enumerate() {
                let count = f64::from(directions);
                println!(
                    "{name:<16} {:<8} {culler:<10} {:>12.4} {:>8} {:>8.1} {:>12.2}",
                    shading.name(),
                    timed.nanoseconds[at] / count / 1e6,
                    ratio(timed.nanoseconds[at], timed.nanoseconds[1]),
                    f64::from(timed.draws[at]) / count,
                    timed.ranges[at] / count / 1e3,
                );
            }
            rows.push(timed.json(name, mesh.face_count(), shading, &names));
        }
    }
    Ok(Value::Array(rows))
}
