//! Which triangles are drawn: one way down from the coarsest, without any list of what depends on what.

use super::triangle::{BisectionTree, Detail, NodeBound, TinTriangle};
use crate::lod::view::CameraView;

/// The faces of a surface, in the order of a Sierpiński curve: each has a side in common with the one before, but where the
/// surface has holes.
#[derive(Debug, Clone, Default)]
pub struct TinSurface {
    pub(super) faces: Vec<(u32, [u32; 3])>,
    /// Blocks that have to be read before the surface is what was asked for.
    pub(super) missing: Vec<usize>,
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
        self.missing.clear();
        self.largest_error = 0.0;
    }
}

/// Draws what a view needs.
pub(super) fn draw<T: BisectionTree>(tree: &T, view: &CameraView, surface: &mut TinSurface) {
    let needs = |_, bound: &NodeBound| view.needs(&bound.detail());
    Descent {
        tree,
        needs,
        surface,
    }
    .run();
}

/// How often a triangle is halved at most, more than in any hierarchy that is built.
const MOST_DEPTH: u32 = 300;

/// Draws what is needed.
pub(super) struct Descent<'a, T, N> {
    pub(super) tree: &'a T,
    /// Whether a triangle has to be cut at this vertex; if so, then all triangles that it came from.
    pub(super) needs: N,
    pub(super) surface: &'a mut TinSurface,
}

impl<T: BisectionTree, N: FnMut(u32, &NodeBound) -> bool> Descent<'_, T, N> {
    pub(super) fn run(&mut self) {
        self.surface.clear();
        for root in self.tree.roots() {
            self.visit(&root, 0);
        }
    }

    /// Draws a triangle along the curve from its left corner to its right one, or back at odd depths.
    fn visit(&mut self, triangle: &TinTriangle, depth: u32) {
        // Only a file that someone made up goes deeper.
        let detail = match depth < MOST_DEPTH {
            true => self.tree.detail(triangle),
            false => Detail::Finest,
        };
        let is_cut = match detail {
            Detail::Outside => return,
            Detail::Crossing => true,
            Detail::Finest => {
                if self.tree.is_surface(triangle) {
                    self.draw(triangle);
                }
                return;
            }
            Detail::Missing(block) => {
                self.surface.missing.push(block);
                return;
            }
            Detail::Inside(bound) => {
                let is_cut = (self.needs)(triangle.split, &bound);
                if !is_cut && bound.is_surface {
                    self.surface.largest_error = self.surface.largest_error.max(bound.error);
                    self.draw(triangle);
                }
                is_cut
            }
        };
        if is_cut {
            let [first, second] = self.tree.halves(triangle);
            let [first, second] = match depth % 2 {
                0 => [first, second],
                _ => [second, first],
            };
            self.visit(&first, depth + 1);
            self.visit(&second, depth + 1);
        }
    }

    fn draw(&mut self, triangle: &TinTriangle) {
        let TinTriangle {
            apex, left, right, ..
        } = *triangle;
        let corners = [apex, left, right].map(|it| self.tree.number(it));
        self.surface.faces.push((triangle.id, corners));
    }
}
