//! Counts on the card against its model.

use serde_json::{Value, json};

use crate::draw::Draw;
use crate::error::GpuError;
use crate::meshes::NamedMesh;
use crate::model::Model;
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
        "{:<24} {:<16} {:>9} {:>10} {:>10} {:>10} {:>10} {:>8} {:>8} {:>8}",
        "mesh",
        "order",
        "faces",
        "statistics",
        "counter",
        model_column(model),
        "difference",
        "warps",
        "model",
        "differ."
    );
    let (mut outcome, mut rows) = (Outcome::default(), Vec::new());
    for NamedMesh { name, mesh } in meshes {
        for order in orders {
            let ordered = order.applied(mesh);
            let draw = Draw::list(ordered.faces().as_flattened());
            let counts = renderer.count(&renderer.upload(&draw)?)?;
            let row = row(model, &draw, &counts, &mut outcome);
            println!(
                "{name:<24} {order:<16} {:>9} {}",
                mesh.face_count(),
                row.text
            );
            let mut json = row.json;
            json["mesh"] = json!(name);
            json["order"] = json!(order.to_string());
            json["faces"] = json!(mesh.face_count());
            rows.push(json);
        }
    }
    Ok((outcome, Value::Array(rows)))
}

/// A draw's counts beside the model's.
#[derive(Debug)]
struct Row {
    text: String,
    json: Value,
}

fn row(model: Model, draw: &Draw<'_>, counts: &Counts, outcome: &mut Outcome) -> Row {
    let prediction = model.predict(draw);
    let invocations = prediction.map(|p| p.invocations);
    // Only where both the model and the shader know warps.
    let warps = prediction
        .and_then(|p| p.warps)
        .filter(|_| counts.warps.is_some());
    let difference = |counted: u64, predicted: Option<u64>| {
        predicted.map(|predicted| i128::from(counted) - i128::from(predicted))
    };
    let off = difference(counts.invocations, invocations);
    let warps_off = counts.warps.and_then(|counted| difference(counted, warps));

    outcome.draws += 1;
    let is_disputed = counts.statistics.is_some_and(|s| s != counts.invocations);
    outcome.disputed += usize::from(is_disputed);
    let is_off = off.is_some_and(|off| off != 0) || warps_off.is_some_and(|off| off != 0);
    outcome.unpredicted += usize::from(is_off);

    let cell = |value: Option<u64>| value.map_or_else(|| "-".to_owned(), |v| v.to_string());
    let signed = |value: Option<i128>| value.map_or_else(|| "-".to_owned(), |v| v.to_string());
    Row {
        text: format!(
            "{:>10} {:>10} {:>10} {:>10} {:>8} {:>8} {:>8}",
            cell(counts.statistics),
            counts.invocations,
            cell(invocations),
            signed(off),
            cell(counts.warps),
            cell(warps),
            signed(warps_off),
        ),
        json: json!({
            "statistics": counts.statistics,
            "counter": counts.invocations,
            "warps": counts.warps,
            "predicted_invocations": invocations,
            "predicted_warps": prediction.and_then(|p| p.warps),
        }),
    }
}

fn model_column(model: Model) -> &'static str {
    match model {
        Model::Nvidia => "NVIDIA",
        Model::Lavapipe => "lavapipe",
    }
}
