//! Meshes in the plane with their rendering sequences, as SVG.

use std::fmt::Write;

use meshweft::Mesh;

use super::steps::{Removal, is_jump};

/// Width and height of a panel, and the radius of the circle that the mesh is in.
const PANEL: f64 = 640.0;
const RADIUS: f64 = 300.0;
/// Height of the line of text below each panel.
const TEXT: f64 = 40.0;

/// Meshes next to each other, each with a line of text below.
pub(super) struct Drawing<'a> {
    positions: &'a [[f32; 3]],
    panels: usize,
    svg: String,
}

impl<'a> Drawing<'a> {
    /// Nothing so far; the mesh lies in the circle of radius 1 around the origin, seen from above.
    pub(super) fn new(mesh: &'a Mesh) -> Self {
        Self {
            positions: mesh.positions(),
            panels: 0,
            svg: String::new(),
        }
    }

    /// Begins a panel with these faces.
    pub(super) fn panel(&mut self, faces: &[[u32; 3]], text: &str) {
        self.panels += 1;
        self.edges(faces, "stroke=\"#bbb\" stroke-width=\"0.8\"");
        let left = (self.panels - 1) as f64 * PANEL;
        let line = format!(
            "<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"middle\">{text}</text>",
            left + PANEL / 2.0,
            PANEL + TEXT / 3.0
        );
        self.line(&line);
    }

    /// A line through the middles of faces in the order of drawing, dashed where it jumps.
    pub(super) fn sequence(&mut self, faces: &[[u32; 3]]) {
        let (mut along, mut jumping) = (String::new(), String::new());
        for pair in faces.windows(2) {
            let path = match is_jump(pair[0], pair[1]) {
                true => &mut jumping,
                false => &mut along,
            };
            let [[ax, ay], [bx, by]] = [pair[0], pair[1]].map(|face| self.middle(face));
            let _ = write!(path, "M{ax:.1} {ay:.1}L{bx:.1} {by:.1}");
        }
        for (path, style) in [
            (
                along,
                "stroke=\"#0072b2\" stroke-width=\"1.6\" stroke-linecap=\"round\"",
            ),
            (
                jumping,
                "stroke=\"#d55e00\" stroke-width=\"1\" stroke-dasharray=\"4 3\"",
            ),
        ] {
            self.line(&format!("<path d=\"{path}\" {style} fill=\"none\"/>"));
        }
        if let Some(&first) = faces.first() {
            let [x, y] = self.middle(first);
            self.line(&format!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"#0072b2\"/>"
            ));
        }
    }

    /// The star of a vertex that leaves next.
    pub(super) fn star(&mut self, removal: &Removal) {
        self.edges(&removal.star, "stroke=\"black\" stroke-width=\"2.4\"");
        let [x, y] = self.at(self.positions[removal.vertex as usize]);
        self.line(&format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\"/>"));
    }

    /// The faces that filled the hole of a vertex that left.
    pub(super) fn hole(&mut self, removal: &Removal) {
        self.edges(
            &removal.hole,
            "stroke=\"black\" stroke-width=\"2.4\" stroke-dasharray=\"7 5\"",
        );
    }

    /// The file; `name` says what it is.
    pub(super) fn finish(self, name: &str) -> String {
        let (width, height) = (self.panels as f64 * PANEL, PANEL + TEXT);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"sans-serif\" font-size=\"16\">\n<desc>{name}</desc>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{}</svg>\n",
            self.svg
        )
    }

    fn line(&mut self, text: &str) {
        self.svg += text;
        self.svg.push('\n');
    }

    /// The edges of faces, each once.
    fn edges(&mut self, faces: &[[u32; 3]], style: &str) {
        let sides = faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let mut edges: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        let mut path = String::new();
        for edge in edges {
            let [[ax, ay], [bx, by]] = edge.map(|vertex| self.at(self.positions[vertex as usize]));
            let _ = write!(path, "M{ax:.1} {ay:.1}L{bx:.1} {by:.1}");
        }
        self.line(&format!("<path d=\"{path}\" {style} fill=\"none\"/>"));
    }

    fn middle(&self, face: [u32; 3]) -> [f64; 2] {
        let corners = face.map(|vertex| self.at(self.positions[vertex as usize]));
        [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0)
    }

    /// Where a position is in the panel.
    fn at(&self, [x, y, _]: [f32; 3]) -> [f64; 2] {
        let left = (self.panels - 1) as f64 * PANEL;
        let [x, y] = [x, y].map(|it| f64::from(it) * RADIUS);
        [left + PANEL / 2.0 + x, PANEL / 2.0 - y]
    }
}
