//! Counts on the card against its model.

use std::fmt;

use serde_json::{Value, json};

use crate::draw::Draw;
use crate::error::GpuError;
use crate::meshes::NamedMesh;
use crate::model::{Model, Prediction};
use crate::orders::Order;
use crate::renderer::{Counts, Renderer};

/// How many draws were counted, and what was wrong with them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Outcome {
    /// Draws.
    pub draws: usize,
    /// Those that the model says something else of.
    pub unpredicted: usize,
    /// Those of which the card's statistics and the shader count differently.
    pub disputed: usize,
}

/// Counts every mesh in every order and prints a row for each.
///
/// # Errors
/// If the card fails.
pub fn run(
    renderer: &Renderer<'_>,
    meshes: &[NamedMesh],
    orders: &[Order],
) -> Result<(Outcome, Value), GpuError> {
    let (model, _) = Model::of(renderer.gpu().card());
    println!(
        "{:<24} {:<20} {:>9} {:>10} {:>10} {:>10} {:>10} {:>8} {:>8} {:>10}",
        "mesh",
        "order",
        "faces",
        "statistics",
        "counter",
        "model",
        "difference",
        "warps",
        "model",
        "difference"
    );
    let (mut outcome, mut rows) = (Outcome::default(), Vec::new());
    for NamedMesh { name, mesh } in meshes {
        for order in orders {
            let ordered = order.applied(mesh);
            let draw = Draw::list(ordered.faces().as_flattened());
            let row = Row {
                counts: renderer.count(&renderer.upload(&draw)?)?,
                prediction: model.predict(&draw),
            };
            outcome.add(&row);
            println!("{name:<24} {order:<20} {:>9} {row}", mesh.face_count());
            rows.push(json!({
                "mesh": name,
                "order": order.to_string(),
                "faces": mesh.face_count(),
                "statistics": row.counts.statistics,
                "counter": row.counts.invocations,
                "warps": row.counts.warps,
                "predicted_invocations": row.prediction.map(|p| p.invocations),
                "predicted_warps": row.prediction.and_then(|p| p.warps),
            }));
        }
    }
    Ok((outcome, Value::Array(rows)))
}

/// A draw's counts beside the model's.
#[derive(Debug)]
struct Row {
    counts: Counts,
    prediction: Option<Prediction>,
}

impl Row {
    /// Invocations counted beyond those predicted.
    fn difference(&self) -> Option<i128> {
        let predicted = self.prediction?.invocations;
        Some(i128::from(self.counts.invocations) - i128::from(predicted))
    }

    /// The warps that are predicted, where shaders can count them.
    fn warps(&self) -> Option<u64> {
        self.counts.warps.and(self.prediction?.warps)
    }

    fn warps_difference(&self) -> Option<i128> {
        Some(i128::from(self.counts.warps?) - i128::from(self.warps()?))
    }
}

impl Outcome {
    fn add(&mut self, row: &Row) {
        let differences = [row.difference(), row.warps_difference()];
        let is_off = differences
            .into_iter()
            .flatten()
            .any(|difference| difference != 0);
        let statistics = row.counts.statistics;
        let is_disputed = statistics.is_some_and(|counted| counted != row.counts.invocations);
        self.draws += 1;
        self.unpredicted += usize::from(is_off);
        self.disputed += usize::from(is_disputed);
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fn text(value: Option<impl ToString>) -> String {
            value.map_or_else(|| "-".to_owned(), |value| value.to_string())
        }
        write!(
            f,
            "{:>10} {:>10} {:>10} {:>10} {:>8} {:>8} {:>10}",
            text(self.counts.statistics),
            self.counts.invocations,
            text(self.prediction.map(|p| p.invocations)),
            text(self.difference()),
            text(self.counts.warps),
            text(self.warps()),
            text(self.warps_difference()),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_is_counted() {
        let row = |statistics, warps| Row {
            counts: Counts {
                statistics,
                invocations: 10,
                warps,
            },
            prediction: Some(Prediction {
                invocations: 10,
                warps: Some(2),
                distinct_vertices: None,
                cycles: None,
            }),
        };
        let mut outcome = Outcome::default();
        for row in [
            row(None, None),
            row(Some(10), Some(2)),
            row(Some(11), Some(3)),
        ] {
            outcome.add(&row);
        }
        let expected = Outcome {
            draws: 3,
            unpredicted: 1,
            disputed: 1,
        };
        assert_eq!(outcome, expected);
    }
}
