//! What orders cost on the card, relative to the first.

use serde_json::{Value, json};

use crate::draw::Draw;
use crate::error::GpuError;
use crate::meshes::NamedMesh;
use crate::model::Model;
use crate::orders::Order;
use crate::renderer::{Counts, Renderer, Sampling};
use crate::workload::Workload;

/// Faces that are drawn for one sample, so that a small mesh takes long enough to be timed.
const FACES_A_SAMPLE: usize = 1 << 20;

/// One order of one mesh.
#[derive(Debug)]
struct Measured {
    counts: Counts,
    predicted_warps: Option<u64>,
    /// Nanoseconds of a draw for each workload, twice.
    times: Vec<[f64; 2]>,
}

impl Measured {
    /// The figures of a row: invocations, warps, then the mean time of each workload.
    fn figures(&self) -> Vec<f64> {
        let warps = self.counts.warps.or(self.predicted_warps);
        let counts = [self.counts.invocations as f64, warps.unwrap_or(0) as f64];
        let times = self.times.iter().map(|[a, b]| (a + b) / 2.0);
        counts.into_iter().chain(times).collect()
    }

    /// How far the two times of a workload are apart, relative to their mean.
    fn repeat_differences(&self) -> impl Iterator<Item = f64> {
        self.times
            .iter()
            .map(|[a, b]| 2.0 * (a - b).abs() / (a + b).max(f64::MIN_POSITIVE))
    }
}

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
    if !renderer.gpu().times_mean_something() {
        println!("A program draws here, not a card: its times say nothing of a card. Counts do.\n");
    }
    let mut rows = Vec::new();
    // For each order, the logarithms of its figures relative to the first order's, added up.
    let mut logarithms = vec![vec![0.0; 2 + Workload::ALL.len()]; orders.len()];
    let mut repeat = vec![0.0_f64; Workload::ALL.len()];
    for NamedMesh { name, mesh } in meshes {
        let measured = measure(renderer, mesh, orders)?;
        println!(
            "{name}: {} faces, {} vertices",
            mesh.face_count(),
            mesh.vertex_count()
        );
        heading(orders[0]);
        let base = measured[0].figures();
        for (at, (order, measured)) in orders.iter().zip(&measured).enumerate() {
            let relative = relative(&measured.figures(), &base);
            for (sum, figure) in logarithms[at].iter_mut().zip(&relative) {
                *sum += figure.ln();
            }
            for (most, difference) in repeat.iter_mut().zip(measured.repeat_differences()) {
                *most = most.max(difference);
            }
            line(&order.to_string(), &relative);
            rows.push(row_json(name, mesh, *order, measured));
        }
        println!("{}\n", absolute(&base));
    }

    println!("Geometric mean of {} meshes", meshes.len());
    heading(orders[0]);
    for (order, sums) in orders.iter().zip(&logarithms) {
        let means: Vec<f64> = sums
            .iter()
            .map(|sum| (sum / meshes.len() as f64).exp())
            .collect();
        line(&order.to_string(), &means);
    }
    print!("{:<16} {:>11} {:>9}", "repeats differ", "", "");
    for difference in &repeat {
        print!(" {:>9}", format!("{:.2} %", 100.0 * difference));
    }
    println!("  (at most)");
    Ok(Value::Array(rows))
}

/// Every order of one mesh: all are timed once, then all once more.
fn measure(
    renderer: &Renderer<'_>,
    mesh: &meshweft::Mesh,
    orders: &[Order],
) -> Result<Vec<Measured>, GpuError> {
    let (model, _) = Model::of(renderer.gpu().card());
    let sampling = sampling(renderer, mesh.face_count());
    let mut geometries = Vec::new();
    let mut measured = Vec::new();
    for order in orders {
        let ordered = order.applied(mesh);
        let draw = Draw {
            positions: Some(ordered.positions()),
            ..Draw::list(ordered.faces().as_flattened())
        };
        let geometry = renderer.upload(&draw)?;
        measured.push(Measured {
            counts: renderer.count(&geometry)?,
            predicted_warps: model.predict(&draw).and_then(|p| p.warps),
            times: vec![[0.0; 2]; Workload::ALL.len()],
        });
        geometries.push(geometry);
    }
    renderer.warm_up(&geometries[0], sampling)?;
    for round in 0..2 {
        for (at, &workload) in Workload::ALL.iter().enumerate() {
            for (geometry, measured) in geometries.iter().zip(&mut measured) {
                measured.times[at][round] = renderer.time(geometry, workload, sampling)?;
            }
        }
    }
    Ok(measured)
}

/// How often a mesh of so many faces is drawn.
pub(crate) fn sampling(renderer: &Renderer<'_>, faces: usize) -> Sampling {
    if !renderer.gpu().times_mean_something() {
        return Sampling {
            samples: 1,
            draws: 1,
        };
    }
    let draws = FACES_A_SAMPLE.div_ceil(faces.max(1)).clamp(2, 256);
    Sampling {
        samples: 30,
        draws: u32::try_from(draws).expect("at most 256"),
    }
}

fn relative(figures: &[f64], base: &[f64]) -> Vec<f64> {
    let ratio = |(figure, base): (&f64, &f64)| match *base > 0.0 && *figure > 0.0 {
        true => figure / base,
        false => 1.0,
    };
    figures.iter().zip(base).map(ratio).collect()
}

fn heading(base: Order) {
    print!(
        "{:<16} {:>11} {:>9}",
        format!("over {base}"),
        "invocations",
        "warps"
    );
    for workload in Workload::ALL {
        print!(" {workload:>9}");
    }
    println!();
}

fn line(name: &str, figures: &[f64]) {
    print!("{name:<16}");
    for (at, figure) in figures.iter().enumerate() {
        let width = if at == 0 { 11 } else { 9 };
        print!(" {figure:>width$.4}");
    }
    println!();
}

/// The figures that the others are relative to.
fn absolute(base: &[f64]) -> String {
    let times = base[2..].iter().zip(Workload::ALL);
    let times: Vec<String> = times
        .map(|(ns, workload)| format!("{workload} {:.2}", ns / 1000.0))
        .collect();
    format!(
        "1 is: {} invocations, {} warps; microseconds: {}",
        base[0],
        base[1],
        times.join(", ")
    )
}

fn row_json(name: &str, mesh: &meshweft::Mesh, order: Order, measured: &Measured) -> Value {
    let times = Workload::ALL.iter().zip(&measured.times);
    let times: serde_json::Map<String, Value> = times
        .map(|(workload, ns)| (workload.to_string(), json!(ns)))
        .collect();
    json!({
        "mesh": name,
        "order": order.to_string(),
        "faces": mesh.face_count(),
        "vertices": mesh.vertex_count(),
        "statistics": measured.counts.statistics,
        "counter": measured.counts.invocations,
        "warps": measured.counts.warps,
        "predicted_warps": measured.predicted_warps,
        "nanoseconds": times,
    })
}
