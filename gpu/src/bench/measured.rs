//! What one mesh costs in every order.

use meshweft::Mesh;
use serde_json::{Value, json};

use super::table::{COUNTED, FIGURES, Figures};
use crate::clock::Clock;
use crate::draw::Draw;
use crate::error::GpuError;
use crate::model::{Model, Prediction};
use crate::orders::Order;
use crate::renderer::{Counts, Renderer, Sampling};
use crate::workload::Workload;

/// Faces that are drawn for one sample, so that a small mesh takes long enough to be timed.
const FACES_A_SAMPLE: usize = 1 << 20;

/// One order of one mesh.
#[derive(Debug)]
pub(super) struct Measured {
    counts: Counts,
    /// By the model of this card, if there is one.
    prediction: Option<Prediction>,
    /// Nanoseconds of a draw for each workload, twice.
    times: [[f64; 2]; Workload::ALL.len()],
    /// Nanoseconds of a cycle of primitive setup at that time, on a card.
    cycle: Option<f64>,
}

impl Measured {
    /// The figures of a row: invocations, warps, cycles by the model, then the mean time of each workload.
    pub(super) fn figures(&self) -> Figures {
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
    pub(super) fn repeat_differences(&self) -> [f64; Workload::ALL.len()] {
        self.times
            .map(|[a, b]| 2.0 * (a - b).abs() / (a + b).abs().max(f64::MIN_POSITIVE))
    }

    /// Cycles of primitive setup a face: by the model, and as the time of a draw says.
    pub(super) fn cycles_a_face(&self, faces: usize) -> Option<(f64, f64)> {
        let cycles = self.prediction?.cycles? as f64;
        let [a, b] = self.times[0];
        let timed = (a + b) / 2.0 / self.cycle?;
        Some((cycles / faces as f64, timed / faces as f64))
    }

    /// All that was counted and timed.
    pub(super) fn json(&self, name: &str, mesh: &Mesh, order: Order) -> Value {
        let times = Workload::ALL.iter().zip(&self.times);
        let times: serde_json::Map<String, Value> = times
            .map(|(workload, ns)| (workload.to_string(), json!(ns)))
            .collect();
        json!({
            "mesh": name,
            "order": order.to_string(),
            "faces": mesh.face_count(),
            "vertices": mesh.vertex_count(),
            "statistics": self.counts.statistics,
            "counter": self.counts.invocations,
            "warps": self.counts.warps,
            "predicted_invocations": self.prediction.map(|p| p.invocations),
            "predicted_warps": self.prediction.and_then(|p| p.warps),
            "predicted_distinct_vertices": self.prediction.and_then(|p| p.distinct_vertices),
            "predicted_cycles": self.prediction.and_then(|p| p.cycles),
            "nanoseconds": times,
            "nanoseconds_a_cycle": self.cycle,
        })
    }
}

/// Every order of one mesh: all are timed once, then all once more.
pub(super) fn measure(
    clock: Option<&Clock<'_, '_>>,
    renderer: &Renderer<'_>,
    mesh: &Mesh,
    orders: &[Order],
) -> Result<Vec<Measured>, GpuError> {
    let (model, is_the_cards) = Model::of(renderer.gpu().card());
    let sampling = sampling(renderer, mesh.face_count());

    // Every order on the card, and counted.
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
            prediction: is_the_cards.then(|| model.predict(&draw)).flatten(),
            times: [[0.0; 2]; Workload::ALL.len()],
            cycle: None,
        });
        geometries.push(geometry);
    }

    // All orders in turn, and once more.
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
