//! Finds out how a card collects vertices: draws that differ in one thing each, every invocation written
//! down, and the rule's numbers fitted again.
//!
//! `families` has the draws, `fit` the search for the numbers, `cycles` what faces cost.

mod cycles;
mod families;
mod fit;

use serde_json::{Value, json};

use crate::batch_rule::BatchRule;
use crate::error::GpuError;
use crate::model::Model;
use crate::renderer::{Counts, Invocation, Renderer};

pub use families::Probe;

/// Most draws that are listed where the model differs.
const MOST_LISTED: usize = 20;

/// A probe and what the card did.
#[derive(Debug)]
struct Observed {
    probe: Probe,
    counts: Counts,
    /// The vertices of each group in lane order, the groups sorted, if shaders can tell groups.
    groups: Option<Vec<Vec<u32>>>,
}

/// Draws all probes and prints where the model differs, which numbers fit, and what faces cost.
///
/// # Errors
/// If the card fails.
pub fn run(renderer: &Renderer<'_>) -> Result<Value, GpuError> {
    // Draw.
    let mut observed = Vec::new();
    let largest = renderer.gpu().largest_index();
    for probe in families::all(largest) {
        let geometry = renderer.upload(&probe.draw())?;
        let (counts, log) = renderer.log(&geometry)?;
        let groups = counts.warps.map(|_| groups(&log));
        observed.push(Observed {
            probe,
            counts,
            groups,
        });
    }

    // Compare with the models.
    println!("{} probes drawn", observed.len());
    differences(Model::of(renderer.gpu().card()).0, &observed);
    let contents = contents(&observed);

    // Fit the rule again.
    let fitted = match Model::of(renderer.gpu().card()) {
        (Model::Lavapipe, true) => {
            println!("batches, fitted: not tried, as this renderer has none");
            Value::Null
        }
        _ => {
            let fit = fit::fit(&observed);
            fit::print(&fit, observed.len());
            fit.json()
        }
    };

    Ok(json!({
        "same_contents": contents,
        "fitted": fitted,
        "cycles": cycles::run(renderer)?,
        "probes": observed.iter().map(Observed::json).collect::<Vec<_>>(),
    }))
}

/// Prints the draws that the model says something else of.
fn differences(model: Model, observed: &[Observed]) {
    let (mut known, mut off) = (0, 0);
    for Observed { probe, counts, .. } in observed {
        let Some(prediction) = model.predict(&probe.draw()) else {
            continue;
        };
        known += 1;
        let is_statistic_off = counts
            .statistics
            .is_some_and(|s| s != prediction.invocations);
        let are_warps_off =
            matches!((counts.warps, prediction.warps), (Some(a), Some(b)) if a != b);
        if counts.invocations == prediction.invocations && !is_statistic_off && !are_warps_off {
            continue;
        }
        off += 1;
        if off <= MOST_LISTED {
            println!("  {}: counted {counts:?}, model {prediction:?}", probe.name);
        }
    }
    println!("{model}: {off} of {known} probes differ");
}

/// Prints in how many probes every group has the vertices that the NVIDIA rule says, lane by lane, and
/// returns that, if shaders can tell groups.
fn contents(observed: &[Observed]) -> Option<usize> {
    let (mut known, mut same) = (0, 0);
    for Observed { probe, groups, .. } in observed {
        let Some(groups) = groups else { continue };
        let batches = BatchRule::NVIDIA.batches(&probe.draw());
        let mut batches: Vec<_> = batches.into_iter().map(|batch| batch.vertices).collect();
        batches.sort_unstable();
        known += 1;
        same += usize::from(*groups == batches);
    }
    match known {
        0 => println!("contents: shaders of this card cannot tell groups"),
        _ => println!(
            "contents: {same} of {known} probes have the batches of {}, lane by lane",
            Model::Nvidia
        ),
    }
    (known > 0).then_some(same)
}

/// The vertices of each group in lane order, the groups sorted. Of a log that is sorted.
fn groups(log: &[Invocation]) -> Vec<Vec<u32>> {
    let groups = log.chunk_by(|a, b| a.warp == b.warp);
    let mut groups: Vec<Vec<u32>> = groups
        .map(|group| group.iter().map(|i| i.vertex).collect())
        .collect();
    groups.sort_unstable();
    groups
}

impl Observed {
    /// Whether the card counts what this rule says.
    fn fits(&self, rule: &BatchRule) -> bool {
        let (invocations, batches) = rule.counts(&self.probe.draw());
        self.counts.invocations == invocations && self.counts.warps.is_none_or(|w| w == batches)
    }

    fn json(&self) -> Value {
        json!({
            "name": self.probe.name,
            "statistics": self.counts.statistics,
            "counter": self.counts.invocations,
            "warps": self.counts.warps,
            "model": BatchRule::NVIDIA.counts(&self.probe.draw()),
        })
    }
}
