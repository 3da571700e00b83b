//! What the faces of a batch cost, timed: batches of 32 faces that share vertices in known ways.

use serde_json::{Value, json};

use crate::batch_rule::BatchRule;
use crate::clock::{Clock, FACES};
use crate::draw::Draw;
use crate::error::GpuError;
use crate::random::Random;
use crate::renderer::Renderer;
use crate::setup;

/// Most lanes of a template: from 29 on another limit holds a card up.
const MOST_LANES: u32 = 28;
/// How far a time may be off before it is listed, in cycles a batch.
const TOLERANCE: f64 = 0.25;

/// A batch that is drawn again and again with other vertices.
#[derive(Debug)]
struct Template {
    name: String,
    indices: Vec<u32>,
}

impl Template {
    /// What the model says of it, if it is one batch of few lanes.
    fn cycles(&self) -> Option<u64> {
        let batches = BatchRule::NVIDIA.batches(&Draw::list(&self.indices));
        let [batch] = batches.as_slice() else {
            return None;
        };
        let is_narrow = batch.vertices.len() <= MOST_LANES as usize;
        is_narrow.then(|| setup::cycles(&batch.faces))
    }
}

/// Times all templates relative to one face drawn 32 times, which the model says takes 35 cycles, and
/// prints those that take something else than the model says. Nothing where times say nothing.
pub(super) fn run(renderer: &Renderer<'_>) -> Result<Value, GpuError> {
    if !renderer.gpu().times_mean_something() {
        println!("setup cycles: not timed, as a program draws here and not a card");
        return Ok(Value::Null);
    }

    let clock = Clock::new(renderer)?;
    let (mut worst, mut off, mut rows) = (0.0_f64, 0, Vec::new());
    for template in templates() {
        let Some(model) = template.cycles() else {
            continue;
        };
        let cycles = clock.cycles(&template.indices)?;
        let difference = cycles - model as f64;
        worst = worst.max(difference.abs());
        if difference.abs() > TOLERANCE {
            off += 1;
            println!("  {}: {cycles:.2} cycles, model {model}", template.name);
        }
        rows.push(json!({"name": template.name, "cycles": cycles, "model": model}));
    }

    println!(
        "setup cycles: {} batches timed, {off} more than {TOLERANCE} off the model, at most {worst:.2}; a \
         cycle takes {:.4} ns",
        rows.len(),
        clock.cycle()?
    );
    Ok(Value::Array(rows))
}

fn templates() -> Vec<Template> {
    let mut templates = Vec::new();
    let mut add = |name: String, corner: &mut dyn FnMut(u32) -> u32| {
        let indices = (0..3 * FACES).map(corner).collect();
        templates.push(Template { name, indices });
    };
    for faces in 1..=9 {
        add(format!("cycle of {faces} faces"), &mut |corner| {
            corner % (3 * faces)
        });
    }
    for vertices in 4..=MOST_LANES {
        add(format!("cycle of {vertices} vertices"), &mut |corner| {
            corner % vertices
        });
        // Up and down, as a strip that turns round.
        let turn = vertices - 2;
        add(
            format!("strip of {turn} faces, again and again"),
            &mut |corner| corner / 3 % turn + corner % 3,
        );
        add(
            format!("fan of {turn} faces, again and again"),
            &mut |corner| match corner % 3 {
                0 => 0,
                side => 1 + (corner / 3 + side - 1) % (vertices - 1),
            },
        );
    }
    for width in [4, 6, 8, 10, 12, 14, 16] {
        for seed in 0..8 {
            let mut random = Random::new(seed);
            // The window moves by 12 over the batch.
            add(format!("window {width}, {seed}"), &mut |corner| {
                corner / 3 * 12 / FACES + random.below(width)
            });
        }
    }
    templates
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::{BATCHES, repeated};
    use crate::model::Model;

    #[test]
    fn a_template_is_a_batch_each_time_it_is_drawn() {
        let (mut narrow, mut cycles) = (0, Vec::new());
        for template in templates() {
            let Some(model) = template.cycles() else {
                continue;
            };
            let drawn = repeated(&template.indices);
            let prediction = Model::Nvidia.predict(&Draw::list(&drawn)).unwrap();
            assert_eq!(prediction.warps, Some(BATCHES.into()), "{}", template.name);
            let all = model * u64::from(BATCHES);
            assert_eq!(prediction.cycles, Some(all), "{}", template.name);
            narrow += 1;
            cycles.push(model);
        }
        // Enough of them, and between what a batch takes at least and at most.
        assert!(narrow > 100, "{narrow}");
        assert!(cycles.iter().all(|cycles| (34..=97).contains(cycles)));
        assert!(cycles.contains(&35) && cycles.contains(&97));
    }
}
