//! Figures as pictures: 5, 6, 11, 12 and 14.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use meshweft::geometry::{cross, dot, normalized, sub, vertex_normals};
use meshweft::operations::{StripedMesh, ViewFrom};

use super::found::{DISTANCE, Found, RANGES};
use crate::raster::{Raster, png};
use crate::run::side_file::{PICTURE, PICTURE_NAME};

/// Pixels of each panel, on each side.
const SIZE: usize = 480;
/// Stripes of what is drawn; figure 5 has three.
const STRIPES: u32 = 64;

type Color = [f32; 3];

const GRAY: Color = [0.78, 0.78, 0.76];
const BLUE: Color = [0.20, 0.45, 0.85];
const GREEN: Color = [0.45, 0.75, 0.35];
const RED: Color = [0.85, 0.10, 0.10];
/// Of the stripes in figure 5, upward normals first; then of faces in none.
const OF_STRIPES: [Color; 4] = [
    [0.90, 0.60, 0.10],
    [0.00, 0.60, 0.50],
    [0.35, 0.35, 0.80],
    GRAY,
];

/// The eye of figures 11, 12 and 14, where y is upward.
const LEFT: [f64; 3] = [-1.0, 0.0, 0.0];
/// From where figures show it: from the front and above; from the right of that; from behind.
const FRONT: [f32; 3] = [0.25, 0.25, 0.95];
const SIDE: [f32; 3] = [0.75, 0.25, 0.75];
const BEHIND: [f32; 3] = [0.95, 0.20, 0.25];

/// The panels of a picture, and in how many columns they are.
type Panels = (Vec<Vec<[u8; 3]>>, usize);

/// What draws a picture of the meshes found.
type DrawPanels = fn(&[Found]) -> Panels;

/// The files, what they show, and what draws them.
const PICTURES: [(&str, &str, DrawPanels); 5] = [
    ("figure-5.png", "Fig. 5", fig_5),
    ("figure-6.png", "Fig. 6", fig_6),
    ("figure-11.png", "Fig. 11", fig_11),
    ("figure-12.png", "Fig. 12", fig_12),
    ("figure-14.png", "Fig. 14", fig_14),
];

/// Refuses a folder in which one of the files is there and no such picture.
pub(super) fn check(folder: &Path, force: bool) -> Result<()> {
    for (file, ..) in PICTURES {
        PICTURE.check(&folder.join(file), force)?;
    }
    Ok(())
}

/// Writes the pictures into a folder; their paths.
pub(super) fn write(folder: &Path, found: &[Found]) -> Result<Vec<String>> {
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let mut written = Vec::new();
    for (file, figure, panels) in PICTURES {
        let path = folder.join(file);
        let (panels, columns) = panels(found);
        let bytes = png(
            &panels,
            SIZE,
            columns,
            Some(&format!("{PICTURE_NAME}: {figure}")),
        );
        fs::write(&path, bytes).with_context(|| path.display().to_string())?;
        written.push(path.display().to_string());
    }
    Ok(written)
}

/// The meshes of a figure that are found, or any one.
fn named<'a>(found: &'a [Found], names: &[&str]) -> Vec<&'a Found> {
    let of_name = |name: &&str| found.iter().find(|it| it.printed.mesh == *name);
    let mut meshes: Vec<&Found> = names.iter().filter_map(of_name).collect();
    if meshes.is_empty() {
        meshes.extend(found.first());
    }
    meshes
}

/// Three stripes in colors.
fn fig_5(found: &[Found]) -> Panels {
    let draw = |it: &&Found| {
        let stripes = StripedMesh::new(&it.mesh, Some(3), RANGES).stripe_of_faces();
        let colors = stripes.iter().map(|stripe| OF_STRIPES[stripe.unwrap_or(3)]);
        Panel::new(it, FRONT).mesh(colors).finish()
    };
    (
        named(found, &["Hand", "Venus"]).iter().map(draw).collect(),
        2,
    )
}

/// What is drawn in green and what is left out in blue, from an eye at the height of the mesh, from anywhere, and from above.
fn fig_6(found: &[Found]) -> Panels {
    let [it, ..] = named(found, &["Venus"])[..] else {
        return (Vec::new(), 1);
    };
    let eyes = [LEFT, [-0.6, 0.55, 0.6], [0.0, 1.0, 0.0]];
    let draw = |direction: [f64; 3]| {
        let colors = by_drawn(it, direction, DISTANCE, GREEN);
        Panel::new(it, SIDE).mesh(colors).line(direction).finish()
    };
    (eyes.map(draw).into(), 3)
}

/// What is left out at three distances.
fn fig_11(found: &[Found]) -> Panels {
    let [it, ..] = named(found, &["Venus"])[..] else {
        return (Vec::new(), 1);
    };
    let draw = |radii: f64| {
        let colors = by_drawn(it, LEFT, radii, GRAY);
        Panel::new(it, SIDE).mesh(colors).finish()
    };
    ([2.0, 4.0, 6.0].map(draw).into(), 3)
}

/// What is left out, and all back faces, seen from behind.
fn fig_12(found: &[Found]) -> Panels {
    let draw = |it: &&Found| {
        let view = ViewFrom {
            direction: LEFT,
            radii: Some(DISTANCE),
        };
        let back = it.planes.is_back(view).into_iter();
        let back = back.map(|is_back| if is_back { BLUE } else { GRAY });
        let left_out = by_drawn(it, LEFT, DISTANCE, GRAY);
        [
            Panel::new(it, BEHIND).mesh(left_out).finish(),
            Panel::new(it, BEHIND).mesh(back).finish(),
        ]
    };
    let panels = named(found, &["Bunny", "Venus"])
        .iter()
        .flat_map(draw)
        .collect();
    (panels, 2)
}

/// What is left out of each mesh.
fn fig_14(found: &[Found]) -> Panels {
    let draw = |it: &Found| {
        let colors = by_drawn(it, LEFT, DISTANCE, GRAY);
        Panel::new(it, SIDE).mesh(colors).finish()
    };
    (found.iter().map(draw).collect(), found.len().min(3))
}

/// The color of each face: blue where it is left out.
fn by_drawn(
    it: &Found,
    direction: [f64; 3],
    radii: f64,
    drawn: Color,
) -> impl Iterator<Item = Color> {
    let view = ViewFrom {
        direction,
        radii: Some(radii),
    };
    let striped = StripedMesh::new(&it.mesh, Some(STRIPES), RANGES);
    let is_drawn = striped.is_drawn(view).into_iter();
    is_drawn.map(move |is_drawn| if is_drawn { drawn } else { BLUE })
}

/// A mesh in parallel projection, its bounding ball as large as the panel.
struct Panel<'a> {
    it: &'a Found,
    raster: Raster,
    right: [f32; 3],
    up: [f32; 3],
    toward: [f32; 3],
}

impl<'a> Panel<'a> {
    fn new(it: &'a Found, from: [f32; 3]) -> Self {
        let toward = normalized(from);
        let right = normalized(cross([0.0, 1.0, 0.0], toward));
        Self {
            it,
            raster: Raster::new(SIZE),
            right,
            up: cross(toward, right),
            toward,
        }
    }

    /// To the right, downward and toward us, in samples, of a point in radii from the middle of the ball.
    fn on_screen(&self, p: [f32; 3]) -> [f32; 3] {
        let (scale, middle) = (0.40 * self.raster.side(), self.raster.side() / 2.0);
        [
            middle + scale * dot(p, self.right),
            middle - scale * dot(p, self.up),
            dot(p, self.toward),
        ]
    }

    /// The faces in colors.
    fn mesh(mut self, colors: impl Iterator<Item = Color>) -> Self {
        let ball = self.it.planes.ball();
        #[expect(clippy::cast_possible_truncation, reason = "for a picture")]
        let (center, radius) = (ball.center.map(|x| x as f32), ball.radius as f32);
        let mesh = &self.it.mesh;
        let normals = vertex_normals(mesh.positions(), mesh.faces());
        let radius = radius.max(f32::MIN_POSITIVE);
        let points = mesh.positions().iter();
        let points = points.map(|&p| self.on_screen(sub(p, center).map(|x| x / radius)));
        let points: Vec<[f32; 3]> = points.collect();

        // A light above our left shoulder.
        let light = [0, 1, 2].map(|i| self.toward[i] + 0.5 * self.up[i] - 0.4 * self.right[i]);
        let light = normalized(light);
        for (face, color) in mesh.faces().iter().zip(colors) {
            let corners = face.map(|v| points[v as usize]);
            let bright = face.map(|v| 0.35 + 0.65 * dot(normals[v as usize], light).max(0.0));
            self.raster.triangle(corners, |[a, b, c]| {
                let shade = (a * bright[0] + b * bright[1] + c * bright[2]).min(1.0);
                color.map(|channel| channel * shade)
            });
        }
        self
    }

    /// A line from the middle of the ball toward an eye.
    fn line(mut self, direction: [f64; 3]) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "for a picture")]
        let direction = normalized(direction.map(|x| x as f32));
        let ends = [0.0, 1.15].map(|far| self.on_screen(direction.map(|x| far * x)));
        let [from, to] = ends.map(|[x, y, _]| [x, y, f32::MAX]);
        let across = normalized([from[1] - to[1], to[0] - from[0], 0.0]);
        let beside = |p: [f32; 3], way: f32| [0, 1, 2].map(|i| p[i] + way * 3.0 * across[i]);
        let [a, b] = [beside(from, -1.0), beside(from, 1.0)];
        let [c, d] = [beside(to, -1.0), beside(to, 1.0)];
        self.raster.triangle([a, b, c], |_| RED);
        self.raster.triangle([c, b, d], |_| RED);
        self
    }

    fn finish(self) -> Vec<[u8; 3]> {
        self.raster.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::kim_lee::found::{of_mesh, sphere};
    use crate::paper::kim_lee::printed::MESHES;

    /// How many pixels of a panel are nearer to a color than to all others, whatever the light.
    fn pixels(panel: &[[u8; 3]], color: Color) -> usize {
        let direction = |color: [f32; 3]| normalized(color);
        let is_it =
            |pixel: &&[u8; 3]| dot(direction(pixel.map(f32::from)), direction(color)) > 0.995;
        panel.iter().filter(is_it).count()
    }

    #[test]
    fn pictures_show_what_is_left_out() {
        let sphere = of_mesh(sphere(32, 64), &MESHES[3]).unwrap();
        let found = [sphere];

        // More at a larger distance, and never what is turned to the eye.
        let (panels, _) = fig_11(&found);
        let blue: Vec<usize> = panels.iter().map(|panel| pixels(panel, BLUE)).collect();
        assert!(
            blue.is_sorted_by(|near, far| near < far) && blue[0] > 10_000,
            "{blue:?}"
        );

        // All back faces are more than those left out.
        let (panels, columns) = fig_12(&found);
        assert_eq!((panels.len(), columns), (2, 2));
        assert!(pixels(&panels[0], BLUE) < pixels(&panels[1], BLUE));

        // Three stripes, and a line to the eye.
        let (panels, _) = fig_5(&found);
        assert!(
            OF_STRIPES[..3]
                .iter()
                .all(|&color| pixels(&panels[0], color) > 1000)
        );
        let (panels, _) = fig_6(&found);
        assert!(panels.iter().all(|panel| pixels(panel, RED) > 100));
        assert!(panels.iter().all(|panel| pixels(panel, GREEN) > 1000));
        assert_eq!(fig_14(&found).0.len(), 1);
    }

    #[test]
    fn pictures_are_known_again() {
        let file = png(
            &[vec![[0; 3]; 4]],
            2,
            1,
            Some(&format!("{PICTURE_NAME}: Fig. 5")),
        );
        assert!((PICTURE.is_own)(&file));
        assert!(!(PICTURE.is_own)(&png(&[vec![[0; 3]; 4]], 2, 1, None)));
    }
}
