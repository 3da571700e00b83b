//! Where two triangles with a common side are cut.

use std::cmp::Ordering;

use crate::geometry::signs::turn;

/// The triangles on both sides of the line from `left` to `right`; at the border there is only the first one.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointDiamond {
    pub(super) left: [f32; 3],
    pub(super) right: [f32; 3],
    pub(super) apex: [f32; 3],
    pub(super) far_apex: Option<[f32; 3]>,
}

/// The part of a point that is in none.
pub(super) const NO_PART: usize = usize::MAX;

impl PointDiamond {
    /// The outer sides, each of which has the inside on its left.
    pub(super) fn outer_sides(&self) -> impl Iterator<Item = [[f32; 3]; 2]> {
        let Self {
            left, right, apex, ..
        } = *self;
        let far = self.far_apex.map(|far| [[left, far], [far, right]]);
        let near = [[apex, left], [right, apex]];
        near.into_iter().chain(far.into_iter().flatten())
    }

    /// Whether four triangles around a place, or two at the border, are all counter-clockwise. Places that pass are the *kernel*.
    pub(super) fn has_inside(&self, place: [f32; 3]) -> bool {
        let mut sides = self.outer_sides();
        sides.all(|[a, b]| turn(a, b, place) == Ordering::Greater) && self.is_on_the_border(place)
    }

    /// Whether a place leaves the border where it is, if there is one.
    pub(super) fn is_on_the_border(&self, place: [f32; 3]) -> bool {
        self.far_apex.is_some() || turn(self.left, self.right, place) == Ordering::Equal
    }

    /// In which of the four triangles around a place of the kernel a point of the diamond is: number 2 × side + half.
    pub(super) fn part(&self, place: [f32; 3], point: [f32; 3]) -> usize {
        let of_line = |end| turn(place, end, point);
        let of_apex = of_line(self.apex);
        let Some(far) = self.far_apex else {
            return usize::from(of_apex == Ordering::Less);
        };

        // The lines from the place to apex, left, far apex and right follow each other counter-clockwise.
        let of_left = of_line(self.left);
        if of_apex != Ordering::Less && of_left != Ordering::Greater {
            return 0;
        }
        let of_far = of_line(far);
        if of_left != Ordering::Less && of_far != Ordering::Greater {
            return 3;
        }
        let of_right = of_line(self.right);
        if of_far != Ordering::Less && of_right != Ordering::Greater {
            return 2;
        }
        debug_assert!(of_right != Ordering::Less && of_apex != Ordering::Greater);
        1
    }
}
