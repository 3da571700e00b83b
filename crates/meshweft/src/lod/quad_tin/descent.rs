//! Which triangles are drawn: one way down from the coarsest, without any list of what depends on what.

use super::triangle::{BisectionTree, Detail, DrawnTree, NONE, NodeBound, TinTriangle};
use crate::lod::view::CameraView;

/// The faces of a surface, in the order of a Sierpiński curve: each has a side in common with the one before, but where the
/// surface has holes.
#[derive(Debug, Clone, Default)]
pub struct TinSurface {
    pub(super) faces: Vec<(u32, [u32; 3])>,
    pub(super) largest_error: f32,
}

impl TinSurface {
    /// The faces: a number that stays as long as the face, and its vertices, counter-clockwise seen from above.
    #[must_use]
    pub fn faces(&self) -> &[(u32, [u32; 3])] {
        &self.faces
    }

    /// The largest vertical distance that an input point may have to this surface.
    #[must_use]
    pub fn largest_error(&self) -> f32 {
        self.largest_error
    }

    pub(super) fn clear(&mut self) {
        self.faces.clear();
        self.largest_error = 0.0;
    }
}

/// Draws what a view needs.
pub(super) fn draw(drawn: impl DrawnTree, view: &CameraView, surface: &mut TinSurface) {
    let needs = |_, bound: &NodeBound| view.needs(&bound.detail());
    Descent::new(drawn, needs, surface).run();
}

/// How often a triangle is halved at most, more than in any hierarchy that is built.
const MOST_DEPTH: u32 = 300;

/// Draws what is needed.
pub(super) struct Descent<'a, D, N> {
    drawn: D,
    /// Whether a triangle has to be cut at this vertex; if so, then all triangles that it came from.
    needs: N,
    surface: &'a mut TinSurface,
    met: Vec<MetDiamond>,
}

/// What was found of a diamond at its first triangle: the other one often comes soon.
#[derive(Debug, Clone, Copy)]
struct MetDiamond {
    split: u32,
    error: f32,
    is_cut: bool,
    surface: [bool; 2],
}

/// Two to this power is how many diamonds are kept, each at a place that follows from its vertex.
const MET_BITS: u32 = 11;

impl<'a, D: DrawnTree, N: FnMut(u32, &NodeBound) -> bool> Descent<'a, D, N> {
    pub(super) fn new(drawn: D, needs: N, surface: &'a mut TinSurface) -> Self {
        let none = MetDiamond {
            split: NONE,
            error: 0.0,
            is_cut: false,
            surface: [false; 2],
        };
        Self {
            drawn,
            needs,
            surface,
            met: vec![none; 1 << MET_BITS],
        }
    }

    pub(super) fn run(&mut self) {
        self.surface.clear();
        for root in self.drawn.tree().roots() {
            self.visit(&root, 0);
        }
    }

    /// Draws a triangle along the curve from its left corner to its right one, or back at odd depths.
    fn visit(&mut self, triangle: &TinTriangle, depth: u32) {
        if !self.is_cut(triangle, depth) {
            return;
        }
        let [first, second] = self.drawn.tree().halves(triangle);
        let [first, second] = match depth % 2 {
            0 => [first, second],
            _ => [second, first],
        };
        self.visit(&first, depth + 1);
        self.visit(&second, depth + 1);
    }

    /// Whether a triangle is cut; if not, it is drawn if it is surface.
    fn is_cut(&mut self, triangle: &TinTriangle, depth: u32) -> bool {
        // Only a file that someone made up goes deeper.
        if depth >= MOST_DEPTH {
            self.draw_finest(triangle);
            return false;
        }

        // Where its diamond was met, all is known.
        let spread = triangle.split.wrapping_mul(0x9E37_79B9) >> (32 - MET_BITS);
        let mut met = self.met[spread as usize];
        let is_met = met.split == triangle.split && triangle.split != NONE;
        if !is_met || !self.drawn.tree().is_inside(triangle) {
            let bound = match triangle.detail_in(&mut self.drawn) {
                Detail::Outside | Detail::Missing(_) => return false,
                Detail::Crossing => return true,
                Detail::Finest => {
                    self.draw_finest(triangle);
                    return false;
                }
                Detail::Inside(bound) => bound,
            };
            met = MetDiamond {
                split: triangle.split,
                error: bound.error,
                is_cut: (self.needs)(triangle.split, &bound),
                surface: bound.surface,
            };
            self.met[spread as usize] = met;
        }

        if !met.is_cut && met.surface[usize::from(triangle.side)] {
            self.surface.largest_error = self.surface.largest_error.max(met.error);
            self.draw(triangle);
        }
        met.is_cut
    }

    /// Draws a triangle that cannot be cut, if it is surface.
    fn draw_finest(&mut self, triangle: &TinTriangle) {
        if self.drawn.tree().is_surface(triangle) {
            self.draw(triangle);
        }
    }

    fn draw(&mut self, triangle: &TinTriangle) {
        let TinTriangle {
            apex, left, right, ..
        } = *triangle;
        let tree = self.drawn.tree();
        let corners = [apex, left, right].map(|it| tree.number(it));
        self.surface.faces.push((triangle.id, corners));
    }
}
