//! What a frame takes, culled and whole, in the settings of the paper's Tables 3 and 4.
//!
//! Where the paper leaves room:
//! - Of its 125 spheres it says nothing but the number of faces. Here they are by rings, as many quads around as its
//!   counts allow, five by five by five, three radii apart, and seen from 20 radii before the middle.
//! - Its "conventional" is an order that it does not name: here the spheres' rings one after the other (`file`), and
//!   beside it the same faces in an order for the card's cache (`whole`).
//! - Each range was a call; here one call has the ranges of an object, as renderers do it now.
//! - Its times have the processor's part in them. Here that is a figure of its own: what finding the ranges takes.

use std::f64::consts::{PI, TAU};
use std::ops::Range;
use std::time::Instant;

use meshweft::Mesh;
use meshweft::culling::{Eye, Ranges};
use meshweft::geometry::Ball;
use serde_json::{Value, json};

use super::camera::{Camera, Vector, ball, direction, minus};
use super::cullers::{Culler, Prepared, cullers, file, stripes, whole};
use super::lattice::on_lattice;
use crate::error::GpuError;
use crate::frames::{Frames, Scene, Shading, View};
use crate::meshes::NamedMesh;
use crate::random::Random;
use crate::vulkan::Draws;

/// Faces of a sphere of the paper's Table 3, milliseconds of the conventional way, then for 2, 4, 8, … stripes, as
/// far as it goes.
type PaperRow = (usize, f64, &'static [f64]);

#[expect(clippy::approx_constant, reason = "6.28 is a time")]
const TABLE_3: [PaperRow; 6] = [
    (1_080, 3.59, &[4.0, 4.35, 5.11, 6.43]),
    (3_968, 3.6, &[4.04, 4.34, 4.98, 6.28]),
    (16_000, 3.6, &[3.96, 4.27, 4.93, 6.24, 8.86]),
    (65_000, 9.94, &[7.40, 7.21, 6.70, 6.46, 8.92]),
    (261_000, 37.1, &[28.15, 27.77, 26.88, 25.19, 22.76, 25.47]),
    (
        1_056_000,
        148.54,
        &[110.2, 102.6, 104.3, 100.44, 95.18, 86.72, 83.94, 80.8],
    ),
];

/// Rings and steps around of spheres with these faces, or nearly so.
const SPHERES: [(u32, u32); 6] = [
    (16, 36),
    (32, 64),
    (64, 128),
    (128, 256),
    (256, 512),
    (512, 1024),
];

/// The paper's distance for single meshes, in radii.
const DISTANCE: f64 = 4.0;

/// Spheres on each side of the cube of them, how far apart they are and from where they are seen, in radii.
const SPHERES_A_SIDE: u32 = 5;
const APART: f64 = 3.0;
const AWAY: f64 = 20.0;

/// Times spheres, then meshes, and prints both as ratios.
pub(super) fn run(frames: &Frames<'_, '_>, meshes: &[NamedMesh]) -> Result<Value, GpuError> {
    let is_card = frames.renderer().gpu().times_mean_something();
    if !is_card {
        println!(
            "A program draws here, not a card: its times say nothing of a card, and few are taken."
        );
    }
    let spheres = spheres(frames, if is_card { SPHERES.len() } else { 2 })?;
    let meshes = single(frames, meshes, if is_card { 8 } else { 1 })?;
    Ok(json!({"table_3": spheres, "table_4": meshes}))
}

/// Table 3: 125 spheres, with several numbers of stripes.
fn spheres(frames: &Frames<'_, '_>, sizes: usize) -> Result<Value, GpuError> {
    println!(
        "\n125 spheres: times over the conventional way; the paper's below, with its milliseconds"
    );
    println!(
        "{:>9} {:>12} {:>8} {:>8}  V = 2, 4, 8, …",
        "faces", "file, ms", "file", "whole"
    );
    let mut rows = Vec::new();
    for ((rings, around), (faces, conventional, stripe_times)) in
        SPHERES.into_iter().zip(TABLE_3).take(sizes)
    {
        // Ours.
        let mesh = sphere(rings, around);
        let card = frames.renderer().gpu().card();
        let counts = (1..).map(|power| 1 << power).take(stripe_times.len());
        let mut cullers = vec![file(&mesh), whole(&mesh, card)];
        cullers.extend(counts.map(|count| stripes(&mesh, Some(count))));
        let names: Vec<String> = cullers.iter().map(|culler| culler.name.clone()).collect();
        let prepared = prepared(frames, &mesh, cullers)?;
        let around = ball(&mesh).expect("a sphere has faces");
        let eye = on_lattice([0.35, 0.25, 1.0].map(|x| x * AWAY));
        let half = APART * f64::from(SPHERES_A_SIDE - 1) / 2.0;
        let all = Ball {
            radius: 3_f64.sqrt() * half + around.radius,
            ..around
        };
        let camera = Camera::new(Eye::at(eye), all, 1.0);
        let places = |offset: &Vector| (minus(eye.map(f64::from), *offset), camera.view(*offset));
        let objects: Vec<(Vector, View)> = offsets().iter().map(places).collect();
        let timed = Timed::new(frames, &prepared, &objects, Shading::Cheap)?;
        let base = timed.nanoseconds[0];
        let ratios = |times: &[f64], base: f64| -> String {
            let ratios = times.iter().map(|&time| ratio(time, base));
            ratios.map(|ratio| format!(" {ratio:>8}")).collect()
        };
        println!(
            "{:>9} {:>12.4}{}",
            mesh.face_count(),
            base / 1e6,
            ratios(&timed.nanoseconds, base)
        );

        // The paper's.
        println!(
            "{faces:>9} {conventional:>12.2} {:>8.4} {:>8}{}",
            1.0,
            "-",
            ratios(stripe_times, conventional)
        );
        rows.push(timed.json("spheres", mesh.face_count(), Shading::Cheap, &names));
    }
    Ok(Value::Array(rows))
}

/// Table 4: single meshes from four radii, from some directions.
fn single(
    frames: &Frames<'_, '_>,
    meshes: &[NamedMesh],
    directions: u32,
) -> Result<Value, GpuError> {
    println!("\nOne mesh from {DISTANCE} radii: times over those of the whole");
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

/// Where the spheres are.
fn offsets() -> Vec<Vector> {
    let along = |step: u32| {
        let middle = f64::from(SPHERES_A_SIDE - 1) / 2.0;
        (f64::from(step) - middle) * APART
    };
    let side = SPHERES_A_SIDE;
    (0..side.pow(3))
        .map(|i| [i % side, i / side % side, i / side.pow(2)].map(along))
        .collect()
}

/// A sphere with the radius 1, by rings.
fn sphere(rings: u32, around: u32) -> Mesh {
    let steps = (0..=rings).flat_map(|ring| (0..around).map(move |step| (ring, step)));
    let position = |(ring, step)| {
        let latitude = PI * f64::from(ring) / f64::from(rings);
        let longitude = TAU * f64::from(step) / f64::from(around);
        on_lattice([
            latitude.sin() * longitude.sin(),
            latitude.cos(),
            latitude.sin() * longitude.cos(),
        ])
    };
    let positions: Vec<[f32; 3]> = steps.clone().map(position).collect();
    let at = |ring: u32, step: u32| ring * around + step % around;
    let faces = steps
        .filter(|&(ring, _)| ring < rings)
        .flat_map(|(ring, step)| {
            let [a, b] = [at(ring, step), at(ring + 1, step)];
            let [c, d] = [at(ring + 1, step + 1), at(ring, step + 1)];
            // At a pole one of the two has no area.
            let upper = (ring + 1 < rings).then_some([a, b, c]);
            let lower = (ring > 0).then_some([a, c, d]);
            upper.into_iter().chain(lower)
        });
    Mesh::new(positions, faces.collect::<Vec<_>>()).expect("indices are in range")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_have_about_the_papers_faces() {
        for ((rings, around), (faces, ..)) in SPHERES.into_iter().zip(TABLE_3) {
            let count = (2 * around * (rings - 1)) as usize;
            assert!(count.abs_diff(faces) * 100 <= faces, "{count}, {faces}");
        }
        let mesh = sphere(16, 36);
        assert_eq!(mesh.face_count(), 1080);
        assert!(
            mesh.faces()
                .iter()
                .all(|[a, b, c]| a != b && b != c && c != a)
        );
        assert_eq!(offsets().len(), 125);
    }
}
