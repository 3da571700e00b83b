//! Faces as pixels, in integers: the same picture everywhere, whatever the order of faces and corners.

use crate::camera::{Placed, SIDE, STEPS};

/// What is seen in a pixel: how deep, then the number of the face. At one depth the lower number is seen, so that no
/// order of drawing matters.
pub(crate) type Pixel = (i128, u32);

/// A picture; `None` where there is no face.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Picture {
    pixels: Vec<Option<Pixel>>,
}

impl Picture {
    pub(crate) fn new() -> Self {
        let count = usize::try_from(SIDE * SIDE).unwrap();
        Self {
            pixels: vec![None; count],
        }
    }

    /// Draws a face in the colour of its number: the pixels whose middle is in it, and of middles on its edge those
    /// that are on a left or top one.
    pub(crate) fn draw(&mut self, number: u32, [a, mut b, mut c]: [Placed; 3]) {
        // Counter-clockwise; nothing of what has no area.
        let area = match turn(a, b, c.x, c.y) {
            0 => return,
            area if area < 0 => {
                (b, c) = (c, b);
                -area
            }
            area => area,
        };

        // The pixels around it.
        let first = |low: i64| low.div_euclid(STEPS).clamp(0, SIDE);
        let last = |high: i64| (high.div_euclid(STEPS) + 1).clamp(0, SIDE);
        let (left, right) = (first(a.x.min(b.x).min(c.x)), last(a.x.max(b.x).max(c.x)));
        let (bottom, top) = (first(a.y.min(b.y).min(c.y)), last(a.y.max(b.y).max(c.y)));

        // Those in it.
        for row in bottom..top {
            for column in left..right {
                let (x, y) = (column * STEPS + STEPS / 2, row * STEPS + STEPS / 2);
                let sides = [(b, c), (c, a), (a, b)].map(|(from, to)| {
                    let side = turn(from, to, x, y);
                    (side, side > 0 || (side == 0 && is_left_or_top(from, to)))
                });
                if !sides.iter().all(|&(_, is_in)| is_in) {
                    continue;
                }
                let weighted = sides.iter().zip([a, b, c]);
                let depth: i128 = weighted
                    .map(|(&(side, _), corner)| i128::from(side) * i128::from(corner.depth))
                    .sum();
                let seen = (depth.div_euclid(i128::from(area)), number);
                let pixel = &mut self.pixels[usize::try_from(row * SIDE + column).unwrap()];
                *pixel = Some(pixel.map_or(seen, |before| before.min(seen)));
            }
        }
    }

    /// How many pixels show a face.
    pub(crate) fn covered(&self) -> usize {
        self.pixels.iter().flatten().count()
    }

    /// Both pixels where two pictures differ.
    pub(crate) fn differences<'a>(
        &'a self,
        other: &'a Self,
    ) -> impl Iterator<Item = (Option<Pixel>, Option<Pixel>)> + 'a {
        let pairs = self.pixels.iter().zip(&other.pixels);
        pairs
            .filter(|(mine, others)| mine != others)
            .map(|(mine, others)| (*mine, *others))
    }
}

/// Twice the area of a face on the screen, above 0 if its corners turn left.
pub(crate) fn area([a, b, c]: [Placed; 3]) -> i64 {
    turn(a, b, c.x, c.y)
}

/// Above 0 for a point on the left of a line.
fn turn(from: Placed, to: Placed, x: i64, y: i64) -> i64 {
    (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x)
}

/// Of a face whose corners turn left: its left edges go down, its top ones to the left.
fn is_left_or_top(from: Placed, to: Placed) -> bool {
    to.y < from.y || (to.y == from.y && to.x < from.x)
}
