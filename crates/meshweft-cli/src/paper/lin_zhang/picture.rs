//! Fig. 3 as a picture: the vertices in their order, over the mesh.

use std::collections::HashSet;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow};
use meshweft::Mesh;
use meshweft::connectivity::{FirstVertex, TrimmedLists};

use super::by_mesh::Found;
use crate::run::side_file::{PICTURE, PICTURE_NAME};

const FILE: &str = "figure-3.svg";
/// Meshes of more faces are not drawn: the lines would cover each other.
const MOST_FACES: usize = 20_000;
/// Longest side of the mesh in the picture, and what is left free around it.
const SIDE: f64 = 900.0;
const MARGIN: f64 = 20.0;

/// Refuses a folder in which the file is there and no such picture.
pub(super) fn check(folder: &Path, force: bool) -> Result<()> {
    Ok(PICTURE.check(&folder.join(FILE), force)?)
}

/// Writes the picture into a folder; its path.
pub(super) fn write(folder: &Path, found: &[Found]) -> Result<String> {
    let can_be_drawn = |it: &&Found| {
        let positions = it.mesh.positions();
        let is_whole = !positions.is_empty() && positions.len() == it.mesh.vertex_count();
        let is_finite = positions.as_flattened().iter().all(|x| x.is_finite());
        is_whole && is_finite && (1..=MOST_FACES).contains(&it.mesh.face_count())
    };
    // The paper shows Venus.
    let is_venus = |it: &Found| it.name.starts_with("Venus");
    let venus = found.iter().filter(can_be_drawn).find(|it| is_venus(it));
    let drawn = venus.or_else(|| found.iter().find(can_be_drawn));
    let it = drawn.ok_or_else(|| {
        anyhow!(
            "--pictures: none of the meshes found has positions and at most {MOST_FACES} faces: add one, such \
             as venus.off or spot.obj, to the folder of --data"
        )
    })?;

    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let path = folder.join(FILE);
    let svg = drawing(&it.mesh, &format!("{PICTURE_NAME}: Fig. 3, {}", it.name));
    fs::write(&path, svg).with_context(|| path.display().to_string())?;
    Ok(path.display().to_string())
}

/// The mesh as it is seen along its shortest side, far faces first, each with the steps along its edges.
fn drawing(mesh: &Mesh, name: &str) -> String {
    let view = View::of(mesh.positions());
    let first = FirstVertex::MinBuffer.choose(mesh).unwrap_or(0);
    let lists = TrimmedLists::new(mesh, first);
    let order = lists.vertices().new_to_old();

    // Faces that look at us, the farthest first.
    let seen = |face: &&[u32; 3]| {
        let [a, b, c] = face.map(|vertex| view.place(mesh.positions()[vertex as usize]));
        (b[0] - a[0]) * (c[1] - a[1]) < (b[1] - a[1]) * (c[0] - a[0])
    };
    let depth = |face: &[u32; 3]| {
        let depths = face.map(|vertex| view.depth(mesh.positions()[vertex as usize]));
        depths.into_iter().sum::<f64>()
    };
    let mut faces: Vec<[u32; 3]> = mesh.faces().iter().filter(seen).copied().collect();
    faces.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    let is_first_seen = faces.iter().any(|face| face.contains(&first));

    // Steps that no edge makes are few, and not drawn.
    let edge = |a: u32, b: u32| [a.min(b), a.max(b)];
    let steps: HashSet<[u32; 2]> = order.windows(2).map(|it| edge(it[0], it[1])).collect();
    let place = |vertex: u32| view.place(mesh.positions()[vertex as usize]);
    let mut body = String::new();
    let mut line = |text: std::fmt::Arguments<'_>| writeln!(body, "{text}").expect("a string");
    for [a, b, c] in faces {
        let [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map(place);
        line(format_args!(
            "<path d=\"M{ax:.1} {ay:.1}L{bx:.1} {by:.1}L{cx:.1} {cy:.1}Z\"/>"
        ));
        for [from, to] in [[a, b], [b, c], [c, a]] {
            if steps.contains(&edge(from, to)) {
                let [[ax, ay], [bx, by]] = [from, to].map(place);
                line(format_args!(
                    "<path d=\"M{ax:.1} {ay:.1}L{bx:.1} {by:.1}\" class=\"step\"/>"
                ));
            }
        }
    }
    if is_first_seen {
        let [x, y] = place(first);
        line(format_args!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\" fill=\"#0072b2\"/>"
        ));
    }

    let [width, height] = view.size;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\">\n\
         <desc>{name}</desc>\n\
         <style>path{{fill:white;stroke:#ccc;stroke-width:.6}} \
         .step{{fill:none;stroke:black;stroke-width:1.4;stroke-linecap:round}}</style>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{body}</svg>\n"
    )
}

/// From where the mesh is seen: along one of the axes, y upward where that can be.
struct View {
    /// The axes to the right and upward with their directions, and the one toward us.
    right: (usize, f64),
    up: (usize, f64),
    toward: usize,
    /// Of what is at the left and at the top.
    origin: [f64; 2],
    scale: f64,
    size: [f64; 2],
}

impl View {
    fn of(positions: &[[f32; 3]]) -> Self {
        let along = |axis: usize| {
            let values = positions.iter().map(move |p| f64::from(p[axis]));
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            values.fold(ends, |(low, high), x| (low.min(x), high.max(x)))
        };
        let ends = [0, 1, 2].map(along);
        let extent = |axis: &usize| ends[*axis].1 - ends[*axis].0;
        let toward = [2, 0, 1]
            .into_iter()
            .min_by(|a, b| extent(a).total_cmp(&extent(b)))
            .unwrap_or(2);
        let (right, up) = match toward {
            0 => ((2, -1.0), (1, 1.0)),
            1 => ((0, 1.0), (2, -1.0)),
            _ => ((0, 1.0), (1, 1.0)),
        };

        let [width, height] = [extent(&right.0), extent(&up.0)];
        let longest = width.max(height);
        let scale = if longest > 0.0 { SIDE / longest } else { 1.0 };
        let least = |(axis, sign): (usize, f64)| {
            let (low, high) = ends[axis];
            (low * sign).min(high * sign)
        };
        Self {
            right,
            up,
            toward,
            origin: [least(right), least(up) + height],
            scale,
            size: [width, height].map(|side| side * scale + 2.0 * MARGIN),
        }
    }

    /// To the right and downward.
    fn place(&self, position: [f32; 3]) -> [f64; 2] {
        let along = |(axis, sign): (usize, f64)| f64::from(position[axis]) * sign;
        [
            (along(self.right) - self.origin[0]) * self.scale + MARGIN,
            (self.origin[1] - along(self.up)) * self.scale + MARGIN,
        ]
    }

    /// Larger nearer to us.
    fn depth(&self, position: [f32; 3]) -> f64 {
        f64::from(position[self.toward])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_that_look_away_are_not_drawn_and_every_edge_of_the_order_is() {
        // Two squares back to back; seen along z, which is the shortest side.
        let corner = |i: u32, z: f32| [(i % 2) as f32, (i / 2) as f32 * 2.0, z];
        let positions = (0..8).map(|i| corner(i % 4, if i < 4 { 0.0 } else { 0.5 }));
        let faces = vec![[0, 3, 1], [0, 2, 3], [4, 5, 7], [4, 7, 6]];
        let mesh = Mesh::new(positions.collect::<Vec<_>>(), faces).unwrap();
        let svg = drawing(&mesh, "meshweft paper: Fig. 3");
        assert!((PICTURE.is_own)(svg.as_bytes()));
        assert_eq!(svg.matches("Z\"").count(), 2);
        assert!(svg.contains("viewBox=\"0 0 490 940\""));
        assert!(svg.matches("class=\"step\"").count() >= 3);
    }
}
