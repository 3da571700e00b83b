//! How far a drawn surface is from the full mesh, in pixels.

use meshweft::Mesh;
use meshweft::geometry::Surface;
use meshweft::lod::Camera;
use rayon::prelude::*;

use crate::scene::Scene;

/// The vertices of the full mesh that a camera sees, each with how many pixels a length of 1 is there.
pub(crate) struct Seen {
    vertices: Vec<(u32, f64)>,
}

/// The picture of a camera: its axes, half its sides at distance 1, and how many pixels a length of 1 is there.
pub(crate) struct Picture {
    eye: [f64; 3],
    axes: [[f64; 3]; 3],
    half: [f64; 2],
    pub(crate) scale: f64,
}

impl Picture {
    pub(crate) fn of(camera: &Camera) -> Self {
        let ahead = unit(sub(camera.target, camera.eye));
        let right = unit(cross(ahead, camera.up));
        let [width, height] = camera.size.map(f64::from);
        let half_height = (0.5 * camera.field_of_view.to_radians()).tan();
        Self {
            eye: camera.eye,
            axes: [right, cross(right, ahead), ahead],
            half: [half_height * width / height, half_height],
            scale: 0.5 * height / half_height,
        }
    }

    /// The normals of its sides, inward; the sides go through the eye.
    pub(crate) fn sides(&self) -> [[f64; 3]; 4] {
        let [.., ahead] = self.axes;
        [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)].map(|(axis, sign)| {
            unit([0, 1, 2].map(|i| self.half[axis] * ahead[i] + sign * self.axes[axis][i]))
        })
    }

    /// Whether the way from the eye to a place is inside.
    fn has(&self, way: [f64; 3]) -> bool {
        let [right, up, depth] = self.axes.map(|axis| dot(way, axis));
        depth > 0.0 && right.abs() <= depth * self.half[0] && up.abs() <= depth * self.half[1]
    }
}

impl Seen {
    /// In the picture, with a normal that faces the eye.
    pub(crate) fn by(camera: &Camera, scene: &Scene) -> Self {
        let picture = Picture::of(camera);
        let sees = |(vertex, (position, normal)): (u32, (&[f32; 3], &[f32; 3]))| {
            let way = sub(position.map(f64::from), picture.eye);
            let faces_eye = dot(normal.map(f64::from), way) < 0.0;
            let pixels = picture.scale / dot(way, way).sqrt();
            (picture.has(way) && faces_eye).then_some((vertex, pixels))
        };
        let vertices = scene.full.positions().iter().zip(&scene.normals);
        Self {
            vertices: (0..).zip(vertices).filter_map(sees).collect(),
        }
    }

    /// The errors in pixels where these faces of a mesh are drawn.
    pub(crate) fn errors(&self, mesh: &Mesh, scene: &Scene, drawn: &[[u32; 3]]) -> Vec<f64> {
        let positions = scene.full.positions();
        let surface = Surface::new(mesh.positions(), drawn);
        let error = |&(vertex, pixels): &(u32, f64)| {
            pixels * distance(&surface, positions[vertex as usize])
        };
        self.vertices.par_iter().map(error).collect()
    }

    /// The same where the distances of all vertices are known.
    pub(crate) fn errors_by<'a>(&'a self, distances: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let error = |&(vertex, pixels): &(u32, f64)| pixels * distances[vertex as usize];
        self.vertices.iter().map(error)
    }
}

/// How far each vertex of the full mesh is from these faces of the rivals' mesh.
pub(crate) fn distances(scene: &Scene, drawn: &[[u32; 3]]) -> Vec<f64> {
    let positions = scene.full.positions();
    let surface = Surface::new(scene.for_rivals.positions(), drawn);
    let distance = |&position: &[f32; 3]| distance(&surface, position);
    positions.par_iter().map(distance).collect()
}

fn distance(surface: &Surface<'_>, position: [f32; 3]) -> f64 {
    let nearest = surface.nearest(position.map(f64::from));
    nearest.map_or(f64::INFINITY, |nearest| nearest.distance)
}

/// The error that 99.9 % of all do not exceed, and the largest.
pub(crate) fn summary(mut errors: Vec<f64>) -> [f64; 2] {
    if errors.is_empty() {
        return [0.0; 2];
    }
    let place = (errors.len() - 1) * 999 / 1000;
    let (_, &mut most_of_all, above) = errors.select_nth_unstable_by(place, f64::total_cmp);
    [
        most_of_all,
        above.iter().copied().fold(most_of_all, f64::max),
    ]
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}
