//! What orders cost on the card, relative to the first.

use meshweft::Mesh;
use serde_json::{Value, json};

use crate::clock::Clock;
use crate::draw::Draw;
use crate::error::GpuError;
use crate::meshes::NamedMesh;
use crate::model::{Model, Prediction};
use crate::orders::Order;
use crate::renderer::{Counts, Renderer, Sampling};
use crate::workload::Workload;

/// Faces that are drawn for one sample, so that a small mesh takes long enough to be timed.
const FACES_A_SAMPLE: usize = 1 << 20;

/// Columns before the times.
const COUNTED: [&str; 3] = ["invocations", "warps", "cycles"];
/// How many figures an order has.
const FIGURES: usize = COUNTED.len() + Workload::ALL.len();

/// One order of one mesh.
#[derive(Debug)]
struct Measured {
    counts: Counts,
    prediction: Option<Prediction>,
    /// Nanoseconds of a draw for each workload, twice.
    times: [[f64; 2]; Workload::ALL.len()],
    /// Nanoseconds of a cycle of primitive setup at that time, on a card.
    cycle: Option<f64>,
}

impl Measured {
    /// The figures of a row: invocations, warps, cycles by the model, then the mean time of each workload.
    fn figures(&self) -> [Option<f64>; FIGURES] {
        let predicted =
            |figure: fn(&Prediction) -> Option<u64>| self.prediction.as_ref().and_then(figure);
        let counted = [
            Some(self.counts.invocations),
            self.counts.warps.or_else(|| predicted(|p| p.warps)),
            predicted(|p| p.cycles),
        ];
        let times = self.times.map(|[a, b]| Some((a + b) / 2.0));
        let mut figures = [None; FIGURES];
        for (to, from) in figures.iter_mut().zip(counted) {
            *to = from.map(|count| count as f64);
        }
        figures[COUNTED.len()..].copy_from_slice(&times);
        figures
    }

    /// How far the two times of each workload are apart, relative to their mean.
    fn repeat_differences(&self) -> [f64; Workload::ALL.len()] {
        self.times
            .map(|[a, b]| 2.0 * (a - b).abs() / (a + b).abs().max(f64::MIN_POSITIVE))
    }

    /// Cycles of primitive setup a face: by the model, and as the time of a draw says.
    fn cycles_a_face(&self, faces: usize) -> Option<(f64, f64)> {
        let cycles = self.prediction?.cycles? as f64;
        let [a, b] = self.times[0];
        let timed = (a + b) / 2.0 / self.cycle?;
        Some((cycles / faces as f64, timed / faces as f64))
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
    let clock = match renderer.gpu().times_mean_something() {
        true => Some(Clock::new(renderer)?),
        false => {
            println!(
                "A program draws here, not a card: its times say nothing of a card. Counts do.\n"
            );
            None
        }
    };
    let mut rows = Vec::new();
    // For each order the logarithms of its figures relative to the first order's, added up.
    let mut logarithms = vec![[Some(0.0_f64); FIGURES]; orders.len()];
    let mut repeats = [0.0_f64; Workload::ALL.len()];
    for NamedMesh { name, mesh } in meshes {
        let measured = measure(clock.as_ref(), renderer, mesh, orders)?;
        println!(
            "{name}: {} faces, {} vertices",
            mesh.face_count(),
            mesh.vertex_count()
        );
        let has_cycles = measured[0].cycles_a_face(mesh.face_count()).is_some();
        let more = if has_cycles {
            "  cycles a face: model, timed"
        } else {
            ""
        };
        heading(orders[0], more);
        let base = measured[0].figures();
        for ((order, measured), sums) in orders.iter().zip(&measured).zip(&mut logarithms) {
            let relative = relative(&measured.figures(), &base);
            for (sum, figure) in sums.iter_mut().zip(relative) {
                *sum = sum.zip(figure).map(|(sum, figure)| sum + figure.ln());
            }
            for (most, difference) in repeats.iter_mut().zip(measured.repeat_differences()) {
                *most = most.max(difference);
            }
            let cycles = measured.cycles_a_face(mesh.face_count());
            let cycles = cycles.map(|(model, timed)| format!("  {model:>9.4} {timed:>9.4}"));
            line(&order.to_string(), &relative, &cycles.unwrap_or_default());
            rows.push(row_json(name, mesh, *order, measured));
        }
        println!("{}\n", absolute(&base));
    }

    println!("Geometric mean of {} meshes", meshes.len());
    heading(orders[0], "");
    for (order, sums) in orders.iter().zip(&logarithms) {
        let mean = |sum: Option<f64>| sum.map(|sum| (sum / meshes.len() as f64).exp());
        line(&order.to_string(), &sums.map(mean), "");
    }
    print!("{:<16} {:>11} {:>9} {:>9}", "repeats differ", "", "", "");
    for difference in &repeats {
        print!(" {:>9}", format!("{:.2} %", 100.0 * difference));
    }
    println!("  (at most)");
    Ok(Value::Array(rows))
}

/// Every order of one mesh: all are timed once, then all once more.
fn measure(
    clock: Option<&Clock<'_, '_>>,
    renderer: &Renderer<'_>,
    mesh: &Mesh,
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
            prediction: model.predict(&draw),
            times: [[0.0; 2]; Workload::ALL.len()],
            cycle: None,
        });
        geometries.push(geometry);
    }

    renderer.warm_up(&geometries[0], sampling)?;
    for round in 0..2 {
        for (at, &workload) in Workload::ALL.iter().enumerate() {
            let cycle = clock.map(Clock::cycle).transpose()?;
            for (geometry, measured) in geometries.iter().zip(&mut measured) {
                measured.times[at][round] = renderer.time(geometry, workload, sampling)?;
                // That of the first workload, which counts cycles; the mean of both rounds.
                if at == 0 {
                    let earlier = measured.cycle.or(cycle);
                    measured.cycle = earlier.zip(cycle).map(|(a, b)| (a + b) / 2.0);
                }
            }
        }
    }
    Ok(measured)
}

/// How often a mesh of so many faces is drawn.
pub(crate) fn sampling(renderer: &Renderer<'_>, faces: usize) -> Sampling {
    let (samples, faces_a_sample, most) = match renderer.gpu().times_mean_something() {
        true => (30, FACES_A_SAMPLE, 256),
        false => (2, FACES_A_SAMPLE / 64, 16),
    };
    let draws = faces_a_sample.div_ceil(faces.max(1)).clamp(1, most);
    Sampling {
        samples,
        draws: u32::try_from(draws).expect("at most 256"),
    }
}

fn relative(
    figures: &[Option<f64>; FIGURES],
    base: &[Option<f64>; FIGURES],
) -> [Option<f64>; FIGURES] {
    let mut relative = [None; FIGURES];
    for (to, (figure, base)) in relative.iter_mut().zip(figures.iter().zip(base)) {
        // A time may be 0 or less where a program draws on a busy machine.
        *to = figure
            .zip(*base)
            .filter(|&(f, b)| f > 0.0 && b > 0.0)
            .map(|(f, b)| f / b);
    }
    relative
}

fn heading(base: Order, more: &str) {
    print!("{:<16}", format!("over {base}"));
    let names = COUNTED.map(str::to_owned).into_iter();
    for (at, name) in names
        .chain(Workload::ALL.map(|w| w.to_string()))
        .enumerate()
    {
        print!(" {name:>width$}", width = width(at));
    }
    println!("{more}");
}

fn line(name: &str, figures: &[Option<f64>; FIGURES], more: &str) {
    print!("{name:<16}");
    for (at, figure) in figures.iter().enumerate() {
        let figure = figure.map_or_else(|| "-".to_owned(), |figure| format!("{figure:.4}"));
        print!(" {figure:>width$}", width = width(at));
    }
    println!("{more}");
}

/// The width of a column.
fn width(at: usize) -> usize {
    COUNTED.get(at).map_or(9, |name| name.len().max(9))
}

/// The figures that the others are relative to.
fn absolute(base: &[Option<f64>; FIGURES]) -> String {
    let (counts, times) = base.split_at(COUNTED.len());
    let counts = COUNTED.iter().zip(counts);
    let counts = counts.filter_map(|(name, count)| count.map(|count| format!("{count} {name}")));
    let times = Workload::ALL.iter().zip(times);
    let times = times.filter_map(|(name, ns)| ns.map(|ns| format!("{name} {:.2}", ns / 1000.0)));
    format!(
        "1 is: {}; microseconds: {}",
        counts.collect::<Vec<_>>().join(", "),
        times.collect::<Vec<_>>().join(", ")
    )
}

fn row_json(name: &str, mesh: &Mesh, order: Order, measured: &Measured) -> Value {
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
        "predicted_invocations": measured.prediction.map(|p| p.invocations),
        "predicted_warps": measured.prediction.and_then(|p| p.warps),
        "predicted_distinct_vertices": measured.prediction.and_then(|p| p.distinct_vertices),
        "predicted_cycles": measured.prediction.and_then(|p| p.cycles),
        "nanoseconds": times,
        "nanoseconds_a_cycle": measured.cycle,
    })
}
