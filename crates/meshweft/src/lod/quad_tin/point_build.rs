//! How the hierarchy over points comes about: triangles are cut as long as they have points inside, level by level.

use super::point_bounds::contain_all_below;
use super::point_diamond::{NO_PART, PointDiamond};
use super::point_distance::FacePlane;
use super::point_input::{CheckedPoints, MOST_VERTICES, PointCounts, PointsError};
use super::point_lists::{ListRange, ListedPoint, PointLists};
use super::point_places::NumberSpacing;
use super::points::{PointHierarchy, PointNode, ROOTS, UnreadPoints};
use super::triangle::NONE;
use crate::geometry::double::rounded_up;
use crate::geometry::signs::turn;
use crate::index::index32;
use crate::progress::Progress;

/// How often a triangle is cut at most.
pub(super) const MOST_CUTS: u8 = 250;

impl PointHierarchy {
    /// The hierarchy over points: x east, y up, z south. Positions stay as they are, bit for bit.
    ///
    /// # Errors
    /// [`PointsError`] if the points have no area, or are too many.
    ///
    /// # Complexity
    /// Time O(n × depth) for n points, which is near O(n log n); space about 200 bytes a point, of which 41 a vertex stay.
    pub fn over(positions: &[[f32; 3]]) -> Result<Self, PointsError> {
        Self::over_with(positions, &())
    }

    /// The same, and says how far it is. Where `progress` stops it, the points that are no vertices yet count as left out.
    ///
    /// # Errors
    /// As [`over`](Self::over).
    pub fn over_with(positions: &[[f32; 3]], progress: &dyn Progress) -> Result<Self, PointsError> {
        let CheckedPoints {
            points,
            corners,
            counts,
        } = CheckedPoints::new(positions)?;
        let mut build = PointBuild::new(points, corners, counts);
        build.run(progress)?;

        let PointBuild {
            mut nodes,
            mut sources,
            apexes,
            mut counts,
            ..
        } = build;
        contain_all_below(&mut nodes, &apexes);
        let is_steiner: Vec<bool> = sources.iter().map(|&it| it == NONE).collect();
        let steiner = is_steiner.iter().filter(|&&it| it).count();
        counts.steiner = index32(steiner);
        nodes.shrink_to_fit();
        sources.shrink_to_fit();
        Ok(Self {
            nodes,
            sources,
            is_steiner,
            counts,
            unread: UnreadPoints::default(),
        })
    }
}

/// A triangle that is not cut yet.
#[derive(Debug, Clone, Copy)]
struct WholeTriangle {
    /// Apex, left, right.
    corners: [u32; 3],
    /// The triangles at the sides from left to right, from apex to left, from right to apex; [`NONE`] at the border.
    beside: [u32; 3],
    points: ListRange,
    /// Where the vertex that cuts it is written: four times the apex, and the place among its children.
    place: u32,
    level: u8,
    cannot_be_cut: bool,
}

/// The place of the coarsest triangles, which no vertex names.
const ROOT: u32 = NONE;

#[derive(Debug)]
struct PointBuild {
    nodes: Vec<PointNode>,
    sources: Vec<u32>,
    apexes: Vec<[u32; 2]>,
    triangles: Vec<WholeTriangle>,
    lists: PointLists,
    counts: PointCounts,
    numbers: NumberSpacing,
    /// Triangles of the next level that have points.
    next: Vec<u32>,
    /// Triangles that wait for the one after them to be cut.
    waiting: Vec<u32>,
}

impl PointBuild {
    /// The two coarsest triangles.
    fn new(points: Vec<ListedPoint>, corners: [ListedPoint; 4], counts: PointCounts) -> Self {
        let [north_west, _, _, south_east] = corners.map(|it| it.position);
        let (lists, ranges) = PointLists::new(points, |it| {
            usize::from(turn(north_west, south_east, it.position).is_lt())
        });
        let triangle = |side: usize| WholeTriangle {
            corners: ROOTS[side],
            beside: [index32(1 - side), NONE, NONE],
            points: ranges[side],
            place: ROOT,
            level: 0,
            cannot_be_cut: false,
        };
        let mut build = Self {
            nodes: Vec::new(),
            sources: Vec::new(),
            apexes: Vec::new(),
            triangles: vec![triangle(0), triangle(1)],
            lists,
            counts,
            numbers: NumberSpacing::of(&corners.map(|it| it.position)),
            next: Vec::new(),
            waiting: Vec::new(),
        };
        for corner in corners {
            build.add(corner, 0.0, [NONE; 2]);
        }
        build
    }

    fn add(&mut self, point: ListedPoint, error: f32, apexes: [u32; 2]) {
        self.nodes.push(PointNode {
            position: point.position,
            error,
            radius: 0.0,
            children: [NONE; 4],
        });
        self.sources.push(point.source);
        self.apexes.push(apexes);
    }

    fn run(&mut self, progress: &dyn Progress) -> Result<(), PointsError> {
        let mut queue: Vec<u32> = (0..2).filter(|&it| self.has_points(it)).collect();
        let whole = f64::from(self.counts.points);
        for level in 0.. {
            if queue.is_empty() {
                break;
            }
            let rest = queue.iter().map(|&it| self.triangles[it as usize].points);
            let rest: usize = rest.map(ListRange::len).sum();
            let is_stopped = progress.report(1.0 - rest as f64 / whole).is_break();
            for &triangle in &queue {
                // The other triangle of its diamond may have been cut, and this one with it.
                let is_whole = self.triangles[triangle as usize].level == level;
                if is_whole && (is_stopped || !self.cut(triangle)?) {
                    self.leave_out(triangle);
                }
            }
            queue.clear();
            std::mem::swap(&mut queue, &mut self.next);
            self.lists.go_on();
        }
        Ok(())
    }

    fn has_points(&self, triangle: u32) -> bool {
        self.triangles[triangle as usize].points.len() > 0
    }

    /// Cuts a triangle, and those before it that have to be; `false` if that is not possible.
    fn cut(&mut self, triangle: u32) -> Result<bool, PointsError> {
        self.waiting.clear();
        self.waiting.push(triangle);
        while let Some(&last) = self.waiting.last() {
            let across = self.triangles[last as usize].beside[0];
            let is_diamond = across == NONE || self.triangles[across as usize].beside[0] == last;
            if !is_diamond {
                // The triangle across is of the level before.
                self.waiting.push(across);
                continue;
            }
            // The coarsest triangles are first and second whichever has points.
            let [first, second] = match self.triangles[last as usize].place {
                ROOT => [0, 1],
                _ => [last, across],
            };
            if !self.cut_diamond(first, second)? {
                for &triangle in &self.waiting {
                    self.triangles[triangle as usize].cannot_be_cut = true;
                }
                return Ok(false);
            }
            self.waiting.pop();
        }
        Ok(true)
    }

    /// Cuts two triangles with the same longest side, or one at the border; `false` if there is no place for a vertex.
    fn cut_diamond(&mut self, first: u32, across: u32) -> Result<bool, PointsError> {
        let near = self.triangles[first as usize];
        let far = (across != NONE).then(|| self.triangles[across as usize]);
        let is_final = near.cannot_be_cut || far.is_some_and(|it| it.cannot_be_cut);
        if is_final || near.level == MOST_CUTS {
            return Ok(false);
        }
        if self.nodes.len() == MOST_VERTICES {
            return Err(PointsError::TooMany);
        }

        // The vertex.
        let [apex, left, right] = near.corners.map(|it| self.nodes[it as usize].position);
        let far_apex = far.map(|it| self.nodes[it.corners[0] as usize].position);
        let diamond = PointDiamond {
            left,
            right,
            apex,
            far_apex,
        };
        let lists = [
            near.points,
            far.map_or(ListRange::default(), |it| it.points),
        ];
        let [inside, far_inside] = lists.map(|it| self.lists.points(it));
        let points = inside.iter().chain(far_inside);
        let Some(vertex) = self.numbers.choose(&diamond, points) else {
            return Ok(false);
        };

        // How far the points are from the surface without it.
        let mut error = FacePlane::new([apex, left, right]).largest_distance(inside);
        if let Some(far_apex) = far_apex {
            let plane = FacePlane::new([far_apex, right, left]);
            error = error.max(plane.largest_distance(far_inside));
        }

        let lists = self.lists.divide(lists, |it| match it.source {
            source if source == vertex.source => NO_PART,
            _ => diamond.part(vertex.position, it.position),
        });
        let number = index32(self.nodes.len());
        let far_corner = far.map_or(NONE, |it| it.corners[0]);
        self.add(vertex, rounded_up(error), [near.corners[0], far_corner]);
        self.replace(number, [first, across], lists);
        Ok(true)
    }

    /// Puts four triangles around a vertex in the place of a diamond's two, or two in the place of one.
    fn replace(&mut self, vertex: u32, diamond: [u32; 2], lists: [ListRange; 4]) {
        // The halves at the left corners keep their numbers.
        let has_far = diamond[1] != NONE;
        let start = index32(self.triangles.len());
        let numbers = [
            [diamond[0], start],
            match has_far {
                true => [diamond[1], start + 1],
                false => [NONE; 2],
            },
        ];
        let old = diamond.map(|it| self.triangles.get(it as usize).copied());
        for (side, old) in old.into_iter().enumerate() {
            let Some(old) = old else { continue };
            if let Some(parent) = self.nodes.get_mut((old.place >> 2) as usize) {
                parent.children[(old.place & 3) as usize] = vertex << 1 | index32(side);
            }

            let [apex, left, right] = old.corners;
            let [own, other] = [numbers[side], numbers[1 - side]];
            let half = |half: usize, corners: [u32; 3], beside: [u32; 3]| WholeTriangle {
                corners,
                beside,
                points: lists[2 * side + half],
                place: vertex << 2 | index32(2 * side + half),
                level: old.level + 1,
                cannot_be_cut: false,
            };
            let halves = [
                half(0, [vertex, apex, left], [old.beside[1], own[1], other[1]]),
                half(1, [vertex, right, apex], [old.beside[2], other[0], own[0]]),
            ];
            self.triangles[own[0] as usize] = halves[0];
            self.triangles.push(halves[1]);

            // The neighbour of the half with a new number.
            if let Some(neighbour) = self.triangles.get_mut(old.beside[2] as usize) {
                let beside = neighbour.beside.iter_mut();
                for it in beside.filter(|it| **it == own[0]) {
                    *it = own[1];
                }
            }
            let with_points = own
                .into_iter()
                .filter(|&it| self.triangles[it as usize].points.len() > 0);
            self.next.extend(with_points);
            self.counts.depth = self.counts.depth.max(old.level + 1);
        }
    }

    /// Counts the points of a triangle that cannot be cut.
    fn leave_out(&mut self, triangle: u32) {
        let triangle = &mut self.triangles[triangle as usize];
        triangle.cannot_be_cut = true;
        let points = self.lists.points(triangle.points);
        let corners = triangle.corners.map(|it| self.nodes[it as usize].position);
        let distance = rounded_up(FacePlane::new(corners).largest_distance(points));
        self.counts.left_out += index32(points.len());
        self.counts.largest_left_out = self.counts.largest_left_out.max(distance);
    }
}
