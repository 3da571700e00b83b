//! Before and after, side by side, each face coloured by its cache misses.

use meshweft::geometry::{dot, normalized, vertex_normals};
use meshweft::{CacheModel, Mesh, cache};

use crate::raster::{Raster, png};

/// Pixels of each half.
const SIZE: usize = 800;
/// Colours of a face by its misses, 0 to 3; colour-blind readers can tell them apart too.
const COLORS: [[f32; 3]; 4] = [
    [0.80, 0.82, 0.85],
    [0.25, 0.56, 0.85],
    [0.96, 0.68, 0.20],
    [0.80, 0.16, 0.22],
];

/// A PNG of the mesh in two orders, the misses of `model` on its faces.
pub(super) fn before_and_after(before: &Mesh, after: &Mesh, model: CacheModel) -> Vec<u8> {
    let halves = [before, after].map(|mesh| draw(mesh, model).finish());
    png(&halves, SIZE, 2, None)
}

/// The mesh seen from above and the side, with a depth buffer.
fn draw(mesh: &Mesh, model: CacheModel) -> Raster {
    let mut raster = Raster::new(SIZE);
    let side = raster.side();
    let missed = cache::misses_per_face(mesh.faces(), model);
    let normals = vertex_normals(mesh.positions(), mesh.faces());

    // The camera.
    let right = normalized([0.80, 0.60, 0.0]);
    let up = normalized([-0.30, 0.40, 0.866]);
    let toward = normalized([0.52, -0.69, 0.5]);
    let seen = |p: [f32; 3]| [dot(p, right), dot(p, up), dot(p, toward)];

    // The mesh fills the picture.
    let points: Vec<[f32; 3]> = mesh.positions().iter().map(|&p| seen(p)).collect();
    let reach = points.iter().flat_map(|p| [p[0].abs(), p[1].abs()]);
    let scale = 0.47 * side / reach.fold(f32::MIN_POSITIVE, f32::max);
    let middle = side / 2.0;
    let on_screen = |p: [f32; 3]| [middle + p[0] * scale, middle - p[1] * scale, p[2]];

    let light = normalized([0.35, -0.45, 0.82]);
    for (face, &misses) in mesh.faces().iter().zip(&missed) {
        let corners = face.map(|v| on_screen(points[v as usize]));
        let bright = face.map(|v| 0.30 + 0.70 * dot(normals[v as usize], light).max(0.0));
        let color = COLORS[usize::from(misses.min(3))];
        raster.triangle(corners, |[a, b, c]| {
            let shade = (a * bright[0] + b * bright[1] + c * bright[2]).min(1.0);
            color.map(|channel| channel * shade)
        });
    }
    raster
}
