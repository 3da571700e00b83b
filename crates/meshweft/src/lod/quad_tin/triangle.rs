//! The triangles of a hierarchy of bisections.

/// No vertex.
pub(super) const NONE: u32 = u32::MAX;

/// A triangle that is cut in two from its apex to a vertex on the opposite side, or near it.
///
/// Apex, left, right go round counter-clockwise, seen from above. The two triangles at the side from `left` to `right` are a *diamond*:
/// they are cut at the same vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TinTriangle {
    pub(super) apex: u32,
    pub(super) left: u32,
    pub(super) right: u32,
    /// Where it is cut; [`NONE`] if it cannot be.
    pub(super) split: u32,
    /// Which of the two of its diamond it is.
    pub(super) side: u8,
    /// Its number: four times that of the apex, and which of the four triangles that came with it.
    pub(super) id: u32,
}

/// What there is of a triangle, before it is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Detail {
    /// Nothing of the surface.
    Outside,
    /// Some of the surface: it is cut wherever the eye is.
    Crossing,
    /// All of it is surface, or nothing.
    Inside(NodeBound),
    /// It cannot be cut.
    Finest,
    /// A block that was not read yet says it.
    Missing(usize),
}

/// The vertex that cuts a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NodeBound {
    pub(super) position: [f32; 3],
    /// The largest vertical distance of an input point below to the surface without the vertex, or without those below.
    pub(super) error: f32,
    /// Around the vertex, all that there is below.
    pub(super) radius: f32,
    /// Of each triangle of the diamond, whether it is surface.
    pub(super) surface: [bool; 2],
}

/// A hierarchy of bisections: a forest of two triangles.
pub(super) trait BisectionTree {
    /// The two triangles of the coarsest surface: one diamond.
    fn roots(&self) -> [TinTriangle; 2];
    /// The halves of a triangle that can be cut: at its left corner, at its right corner.
    fn halves(&self, triangle: &TinTriangle) -> [TinTriangle; 2];
    /// Whether a triangle is all in the terrain's rectangle, so that the other one of its diamond tells what there is of it.
    fn is_inside(&self, triangle: &TinTriangle) -> bool;
    /// What there is of a triangle.
    fn detail(&self, triangle: &TinTriangle) -> Detail;
    /// Whether a triangle that cannot be cut is surface.
    fn is_surface(&self, triangle: &TinTriangle) -> bool;
    /// The number of a vertex, from 0.
    fn number(&self, vertex: u32) -> u32;
}

/// A hierarchy that may read blocks while it is drawn.
pub(super) trait DrawnTree {
    type Tree: BisectionTree;
    fn tree(&self) -> &Self::Tree;
    /// Reads a block; `false` if that is not possible.
    fn read(&mut self, block: usize) -> bool;
}

/// What was not read stays so.
impl<T: BisectionTree> DrawnTree for &T {
    type Tree = T;

    fn tree(&self) -> &T {
        self
    }

    fn read(&mut self, _: usize) -> bool {
        false
    }
}

impl<D: DrawnTree> DrawnTree for &mut D {
    type Tree = D::Tree;

    fn tree(&self) -> &D::Tree {
        (**self).tree()
    }

    fn read(&mut self, block: usize) -> bool {
        (**self).read(block)
    }
}

impl TinTriangle {
    /// What there is of it, after its block was read if need be.
    #[inline]
    pub(super) fn detail_in(&self, drawn: &mut impl DrawnTree) -> Detail {
        match drawn.tree().detail(self) {
            Detail::Missing(block) if drawn.read(block) => drawn.tree().detail(self),
            detail => detail,
        }
    }
}
