//! What a frame takes, culled and whole, in the settings of the paper's Tables 3 and 4.
//!
//! Where the paper leaves room:
//! - Of its 125 spheres it says no more than how many faces they have. Here they are made of rings, five by five by five of
//!   them, three radii apart, seen from 20 radii before the middle one.
//! - It does not name the order of its "conventional" way. Here that is ring after ring (`file`); beside it are the same
//!   faces in an order for the card's cache (`whole`), which a renderer would take.
//! - Each range was a call; here one call has the ranges of an object, as renderers do it now.
//! - Its times have the processor's part in them. Here that is a figure of its own: what finding the ranges takes.

mod meshes;
mod spheres;

use std::ops::Range;
use std::time::Instant;

use meshweft::Mesh;
use meshweft::culling::{Eye, Ranges};
use serde_json::{Value, json};

use super::camera::Vector;
use super::cullers::{Culler, Prepared};
use super::lattice::on_lattice;
use crate::error::GpuError;
use crate::frames::{Frames, Scene, Shading, View};
use crate::meshes::NamedMesh;
use crate::vulkan::Draws;

/// Times spheres, then meshes, and prints both as ratios.
pub(super) fn run(frames: &Frames<'_, '_>, meshes: &[NamedMesh]) -> Result<Value, GpuError> {
    let is_card = frames.renderer().gpu().times_mean_something();
    if !is_card {
        println!(
            "A program draws here, not a card: its times say nothing of a card, and few are taken."
        );
    }
    let spheres = spheres::run(frames, if is_card { usize::MAX } else { 2 })?;
    let meshes = meshes::run(frames, meshes, if is_card { 8 } else { 1 })?;
    Ok(json!({"table_3": spheres, "table_4": meshes}))
}

/// A mesh in all orders, on the card.
fn prepared<'g>(
    frames: &Frames<'_, 'g>,
    mesh: &Mesh,
    cullers: Vec<Culler>,
) -> Result<Vec<Prepared<'g>>, GpuError> {
    let prepare = |culler| Prepared::new(frames.renderer(), mesh, culler);
    cullers.into_iter().map(prepare).collect()
}

/// What frames of each culler took.
#[derive(Debug)]
struct Timed {
    /// On the card.
    nanoseconds: Vec<f64>,
    /// To find the ranges, on the processor.
    ranges: Vec<f64>,
    draws: Vec<u32>,
}

impl Timed {
    /// Times frames of objects, each seen from an eye in its own space through a matrix.
    fn new(
        frames: &Frames<'_, '_>,
        prepared: &[Prepared<'_>],
        objects: &[(Vector, View)],
        shading: Shading,
    ) -> Result<Self, GpuError> {
        // What is drawn.
        let gpu = frames.renderer().gpu();
        let mut ranges_found = Ranges::default();
        let (mut on_card, mut places, mut ranges, mut counts) = (vec![], vec![], vec![], vec![]);
        for prepared in prepared {
            let mut draws = Vec::new();
            let mut of_object: Vec<Range<u32>> = Vec::new();
            let start = Instant::now();
            for (eye, _) in objects {
                let first = draws.len();
                draws.extend(prepared.draws(Eye::at(on_lattice(*eye)), &mut ranges_found));
                of_object.push(word(first)..word(draws.len()));
            }
            ranges.push(start.elapsed().as_secs_f64() * 1e9);
            counts.push(word(draws.len()));
            on_card.push(Draws::new(gpu, &draws)?);
            places.push(of_object);
        }

        // As long as it takes to be measured, and no longer.
        let faces = prepared.first().map_or(1, |first| first.mesh.face_count()) * objects.len();
        let (samples, budget) = match gpu.times_mean_something() {
            true if faces > 1 << 24 => (3, 1 << 28),
            true => (9, 1 << 22),
            false => (3, 1 << 16),
        };
        let most = if faces > 1 << 24 { 2 } else { 256 };
        let repeats = word((budget / faces.max(1)).clamp(1, most));
        let scenes = prepared.iter().zip(&on_card).zip(&places);
        let scenes: Vec<Scene<'_, '_>> = scenes
            .map(|((prepared, draws), places)| Scene {
                geometry: &prepared.geometry,
                draws,
                objects: objects
                    .iter()
                    .zip(places)
                    .map(|((_, view), which)| (*view, which.clone()))
                    .collect(),
            })
            .collect();
        Ok(Self {
            nanoseconds: frames.time(&scenes, shading, samples, repeats)?,
            ranges,
            draws: counts,
        })
    }

    fn add(&mut self, other: &Self) {
        let add = |sum: &mut [f64], other: &[f64]| {
            sum.iter_mut().zip(other).for_each(|(sum, x)| *sum += x);
        };
        add(&mut self.nanoseconds, &other.nanoseconds);
        add(&mut self.ranges, &other.ranges);
        let draws = self.draws.iter_mut().zip(&other.draws);
        draws.for_each(|(sum, x)| *sum += x);
    }

    fn json(&self, mesh: &str, faces: usize, shading: Shading, names: &[String]) -> Value {
        json!({
            "mesh": mesh,
            "faces": faces,
            "shader": shading.name(),
            "cullers": names,
            "nanoseconds": self.nanoseconds,
            "nanoseconds_of_ranges": self.ranges,
            "draws": self.draws,
        })
    }
}

/// A time over another; nothing where a program draws on a busy machine and one is not above zero.
fn ratio(time: f64, base: f64) -> String {
    match time > 0.0 && base > 0.0 {
        true => format!("{:.4}", time / base),
        false => "-".to_owned(),
    }
}

fn word(count: usize) -> u32 {
    u32::try_from(count).expect("fewer than faces")
}
