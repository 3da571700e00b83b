//! Connected parts: faces that are joined by points.

use super::remaining::{NONE, RemainingMesh};
use crate::geometry::double::Bounds;
use crate::index::index32;
use crate::topology::rows::Rows;

/// The parts of a mesh, for those that leave as a whole once none of their points can go.
#[derive(Debug)]
pub(super) struct ConnectedParts {
    /// The part of each point; [`NONE`] without faces.
    of: Vec<u32>,
    points: Rows<u32>,
    /// How many points of each part wait for their turn.
    waiting: Vec<u32>,
}

impl ConnectedParts {
    pub(super) fn new(rest: &mut RemainingMesh<'_>) -> Self {
        let points = rest.point_count();
        let mut of = vec![NONE; points];
        let (mut parts, mut pending) = (0_u32, Vec::new());
        for start in 0..index32(points) {
            if of[start as usize] != NONE || !rest.is_used(start) {
                continue;
            }
            of[start as usize] = parts;
            pending.push(start);
            while let Some(point) = pending.pop() {
                rest.visit(point, |face| {
                    for neighbour in face.ring {
                        if of[neighbour as usize] == NONE {
                            of[neighbour as usize] = parts;
                            pending.push(neighbour);
                        }
                    }
                    true
                });
            }
            parts += 1;
        }
        let points = of.iter().zip(0..).filter(|&(&part, _)| part != NONE);
        let points = Rows::by_counting(parts as usize, points.map(|(&part, point)| (part, point)));
        let waiting = vec![0; parts as usize];
        Self {
            of,
            points,
            waiting,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// The part of a point that has faces.
    pub(super) fn of(&self, point: u32) -> u32 {
        self.of[point as usize]
    }

    /// A point of the part waits for its turn.
    pub(super) fn begin(&mut self, point: u32) {
        self.waiting[self.of[point as usize] as usize] += 1;
    }

    /// A point of the part waits no more.
    pub(super) fn end(&mut self, point: u32) {
        self.waiting[self.of[point as usize] as usize] -= 1;
    }

    /// Whether no point of a part waits.
    pub(super) fn is_stuck(&self, part: u32) -> bool {
        self.waiting[part as usize] == 0
    }

    /// The points that a part has left.
    pub(super) fn points<'a>(
        &'a self,
        rest: &'a RemainingMesh<'_>,
        part: u32,
    ) -> impl Iterator<Item = u32> + 'a {
        self.points
            .row(part)
            .iter()
            .copied()
            .filter(|&point| rest.is_used(point))
    }

    /// The diagonal of the bounding box of what is left of a part.
    pub(super) fn extent(&self, rest: &RemainingMesh<'_>, part: u32) -> f64 {
        let mut bounds = Bounds::default();
        self.points(rest, part)
            .for_each(|point| bounds.add(rest.position(point)));
        bounds.diagonal()
    }
}
