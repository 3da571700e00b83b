//! What orders cost on the card, relative to the first.
//!
//! `measured` counts and times one mesh, `table` has what is printed.

mod measured;
mod table;

use serde_json::Value;

use crate::clock::Clock;
use crate::error::GpuError;
use crate::meshes::NamedMesh;
use crate::orders::Order;
use crate::renderer::Renderer;
use crate::workload::Workload;
pub(crate) use measured::sampling;
use measured::{Measured, measure};
use table::Means;

/// Counts and times every mesh in every order, prints a table for each mesh and one of geometric means,
/// and returns all figures.
///
/// # Errors
/// If the card has no timestamps, or fails.
pub fn run(
    renderer: &Renderer<'_>,
    meshes: &[NamedMesh],
    orders: &[Order],
) -> Result<Value, GpuError> {
    let clock = match renderer.gpu().times_mean_something() {
        true => Some(Clock::new(renderer)?),
        false => {
            println!("A program draws here, not a card: its times say nothing of a card.\n");
            None
        }
    };
    let mut rows = Vec::new();
    let mut means: Vec<Means> = orders.iter().map(|_| Means::new()).collect();
    let mut repeats = [0.0_f64; Workload::ALL.len()];

    // A table a mesh.
    for mesh in meshes {
        let measured = measure(clock.as_ref(), renderer, &mesh.mesh, orders)?;
        print_mesh(mesh, orders, &measured, &mut means);
        for (order, measured) in orders.iter().zip(&measured) {
            for (most, difference) in repeats.iter_mut().zip(measured.repeat_differences()) {
                *most = most.max(difference);
            }
            rows.push(measured.json(&mesh.name, &mesh.mesh, *order));
        }
    }

    // One of all.
    println!("Geometric mean of {} meshes", meshes.len());
    println!("{}", table::heading(orders[0], ""));
    for (order, means) in orders.iter().zip(&means) {
        println!("{}", table::line(&order.to_string(), &means.figures(), ""));
    }
    println!("{}", table::repeats(&repeats));
    Ok(Value::Array(rows))
}

/// Prints a mesh's figures over those of the first order, and adds them to the means.
fn print_mesh(mesh: &NamedMesh, orders: &[Order], measured: &[Measured], means: &mut [Means]) {
    let NamedMesh { name, mesh } = mesh;
    let (faces, vertices) = (mesh.face_count(), mesh.vertex_count());
    println!("{name}: {faces} faces, {vertices} vertices");
    let more = match measured[0].cycles_a_face(faces) {
        Some(_) => "  cycles a face: model, timed",
        None => "",
    };
    println!("{}", table::heading(orders[0], more));

    let base = measured[0].figures();
    for ((order, measured), means) in orders.iter().zip(measured).zip(means) {
        let relative = table::relative(&measured.figures(), &base);
        means.add(&relative);
        let cycles = measured.cycles_a_face(faces);
        let cycles = cycles.map(|(model, timed)| format!("  {model:>9.4} {timed:>9.4}"));
        let line = table::line(&order.to_string(), &relative, &cycles.unwrap_or_default());
        println!("{line}");
    }
    println!("{}\n", table::absolute(&base));
}
