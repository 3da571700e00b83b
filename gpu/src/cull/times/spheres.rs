//! The paper's Table 3: 125 spheres, with several numbers of stripes.

use std::f64::consts::{PI, TAU};

use meshweft::Mesh;
use meshweft::culling::Eye;
use meshweft::geometry::Ball;
use serde_json::Value;

use super::{Timed, prepared, ratio};
use crate::cull::camera::{Camera, Vector, minus};
use crate::cull::cullers::{STRIPES, cullers, stripes};
use crate::cull::lattice::on_lattice;
use crate::error::GpuError;
use crate::frames::{Frames, Shading, View};

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

/// Spheres on each side of the cube of them, how far apart they are and from where they are seen, in radii.
const SPHERES_A_SIDE: u32 = 5;
const APART: f64 = 3.0;
const AWAY: f64 = 20.0;

/// Times the first few sizes of spheres, and prints them over the conventional way, the paper's below.
pub(super) fn run(frames: &Frames<'_, '_>, sizes: usize) -> Result<Value, GpuError> {
    println!(
        "\n125 spheres: times over the conventional way; the paper's below, with its milliseconds"
    );
    let card = frames.renderer().gpu().card();
    let mut rows = Vec::new();
    for (rings_and_steps, paper) in SPHERES.into_iter().zip(TABLE_3).take(sizes) {
        // All that is compared, in place of one number of stripes several.
        let (faces, conventional, stripe_times) = paper;
        let mesh = sphere(rings_and_steps);
        let mut cullers = cullers(&mesh, card);
        cullers.retain(|culler| culler.name != STRIPES);
        let others = cullers.len();
        let counts = (1..).map(|power| 1 << power).take(stripe_times.len());
        cullers.extend(counts.map(|count| stripes(&mesh, Some(count))));
        let names: Vec<String> = cullers.iter().map(|culler| culler.name.clone()).collect();
        if rows.is_empty() {
            let names: String = names[..others]
                .iter()
                .map(|name| format!(" {name:>8}"))
                .collect();
            println!("{:>9} {:>12}{names}  V = 2, 4, 8, …", "faces", "file, ms");
        }

        // Ours.
        let prepared = prepared(frames, &mesh, cullers)?;
        let timed = Timed::new(frames, &prepared, &seen(), Shading::Cheap)?;
        let base = timed.nanoseconds[0];
        let ours = timed.nanoseconds.iter().map(|&time| ratio(time, base));
        line(mesh.face_count(), base / 1e6, ours);
        rows.push(timed.json("spheres", mesh.face_count(), Shading::Cheap, &names));

        // The paper's, which has no other than the conventional way and stripes.
        let stripes = stripe_times.iter().map(|&time| ratio(time, conventional));
        let others = (1..others).map(|_| "-".to_owned());
        line(
            faces,
            conventional,
            ["1.0000".to_owned()]
                .into_iter()
                .chain(others)
                .chain(stripes),
        );
    }
    Ok(Value::Array(rows))
}

fn line(faces: usize, milliseconds: f64, ratios: impl Iterator<Item = String>) {
    let ratios: String = ratios.map(|ratio| format!(" {ratio:>8}")).collect();
    println!("{faces:>9} {milliseconds:>12.4}{ratios}");
}

/// From where each sphere is seen in its own space, and through which matrix.
fn seen() -> Vec<(Vector, View)> {
    let eye = on_lattice([0.35, 0.25, 0.9].map(|x| x * AWAY));
    let half = APART * f64::from(SPHERES_A_SIDE - 1) / 2.0;
    let all = Ball {
        center: [0.0; 3],
        radius: 3_f64.sqrt() * half + 1.0,
    };
    let camera = Camera::new(Eye::at(eye), all, 1.0);
    let seen = |offset| (minus(eye.map(f64::from), offset), camera.view(offset));
    offsets().into_iter().map(seen).collect()
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
fn sphere((rings, around): (u32, u32)) -> Mesh {
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
        let mesh = sphere((16, 36));
        assert_eq!(mesh.face_count(), 1080);
        assert!(
            mesh.faces()
                .iter()
                .all(|[a, b, c]| a != b && b != c && c != a)
        );
        // All apart, and none around the eye.
        let seen = seen();
        assert_eq!(seen.len(), 125);
        assert!(
            seen.iter()
                .all(|(eye, _)| eye.iter().map(|x| x * x).sum::<f64>() > 4.0)
        );
    }
}
