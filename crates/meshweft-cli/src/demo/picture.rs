//! Before and after, side by side, each face coloured by its cache misses.

use meshweft::geometry::{dot, normalized, vertex_normals};
use meshweft::{CacheModel, Mesh, cache};

/// Pixels of each half.
const SIZE: usize = 800;
/// Samples of a pixel in each direction.
const SAMPLES: usize = 3;
/// Colours of a face by its misses, 0 to 3; colour-blind readers can tell them apart too.
const COLORS: [[f32; 3]; 4] = [
    [0.80, 0.82, 0.85],
    [0.25, 0.56, 0.85],
    [0.96, 0.68, 0.20],
    [0.80, 0.16, 0.22],
];
const BACKGROUND: [f32; 3] = [0.985, 0.98, 0.965];

/// A PNG of the mesh in two orders, the misses of `model` on its faces.
pub(super) fn before_and_after(before: &Mesh, after: &Mesh, model: CacheModel) -> Vec<u8> {
    let halves = [before, after].map(|mesh| draw(mesh, model));
    let mut pixels = Vec::with_capacity(SIZE * SIZE * 6);
    for y in 0..SIZE {
        for half in &halves {
            for x in 0..SIZE {
                pixels.extend(average(half, x, y));
            }
        }
    }
    let side = u32::try_from(SIZE).expect("a small picture");
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, 2 * side, side);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let written = encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(&pixels));
    written.expect("writing to memory cannot fail");
    file
}

fn average(half: &[[f32; 3]], x: usize, y: usize) -> [u8; 3] {
    let mut sum = [0.0; 3];
    for sy in 0..SAMPLES {
        for sx in 0..SAMPLES {
            let sample = half[(y * SAMPLES + sy) * SIZE * SAMPLES + x * SAMPLES + sx];
            for (sum, part) in sum.iter_mut().zip(sample) {
                *sum += part;
            }
        }
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to a byte"
    )]
    sum.map(|c| (c / (SAMPLES * SAMPLES) as f32 * 255.0).clamp(0.0, 255.0) as u8)
}

/// The mesh seen from above and the side, with a depth buffer.
fn draw(mesh: &Mesh, model: CacheModel) -> Vec<[f32; 3]> {
    let side = SIZE * SAMPLES;
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
    let scale = 0.47 * side as f32 / reach.fold(f32::MIN_POSITIVE, f32::max);
    let middle = side as f32 / 2.0;
    let on_screen = |p: [f32; 3]| [middle + p[0] * scale, middle - p[1] * scale, p[2]];

    let light = normalized([0.35, -0.45, 0.82]);
    let mut image = vec![BACKGROUND; side * side];
    let mut depth = vec![f32::MIN; side * side];
    for (face, &misses) in mesh.faces().iter().zip(&missed) {
        let corners = face.map(|v| on_screen(points[v as usize]));
        let bright = face.map(|v| 0.30 + 0.70 * dot(normals[v as usize], light).max(0.0));
        let color = COLORS[usize::from(misses.min(3))];
        fill(corners, side, |x, y, [a, b, c]| {
            let z = a * corners[0][2] + b * corners[1][2] + c * corners[2][2];
            let pixel = y * side + x;
            if z > depth[pixel] {
                depth[pixel] = z;
                let shade = (a * bright[0] + b * bright[1] + c * bright[2]).min(1.0);
                image[pixel] = color.map(|channel| channel * shade);
            }
        });
    }
    image
}

/// Calls `visit(x, y, barycentric)` for each sample inside the triangle.
fn fill(corners: [[f32; 3]; 3], side: usize, mut visit: impl FnMut(usize, usize, [f32; 3])) {
    let [a, b, c] = corners;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if area == 0.0 {
        return;
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the picture"
    )]
    let span = |i: usize| {
        let low = a[i].min(b[i]).min(c[i]).floor().clamp(0.0, side as f32);
        let high = a[i].max(b[i]).max(c[i]).ceil().clamp(0.0, side as f32);
        low as usize..high as usize
    };

    for y in span(1) {
        for x in span(0) {
            let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
            let edge = |p: [f32; 3], q: [f32; 3]| {
                ((q[0] - p[0]) * (py - p[1]) - (q[1] - p[1]) * (px - p[0])) / area
            };
            let weights = [edge(b, c), edge(c, a), edge(a, b)];
            if weights.iter().all(|&w| w >= 0.0) {
                visit(x, y, weights);
            }
        }
    }
}
