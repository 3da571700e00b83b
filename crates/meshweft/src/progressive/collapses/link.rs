//! What may leave without a change of the surface's topology, but for holes that close.

use super::fan::{Fan, MOST_FACES};
use super::remaining::{FanFace, NONE, RemainingMesh};
use crate::index::index32;

/// Points of a set that is emptied in no time.
#[derive(Debug)]
pub(super) struct Marks {
    of: Vec<u32>,
    stamp: u32,
}

impl Marks {
    pub(super) fn new(points: usize) -> Self {
        Self {
            of: vec![0; points],
            stamp: 0,
        }
    }

    fn clear(&mut self) {
        self.stamp = self.stamp.checked_add(1).unwrap_or_else(|| {
            self.of.fill(0);
            1
        });
    }

    fn add(&mut self, point: u32) {
        self.of[point as usize] = self.stamp;
    }

    fn has(&self, point: u32) -> bool {
        self.of[point as usize] == self.stamp
    }
}

/// The points that never leave: those whose faces are not one fan, those that are nowhere, and those on a
/// border if that stays.
pub(super) fn locked(rest: &mut RemainingMesh<'_>, lock_border: bool) -> Vec<bool> {
    let points = rest.point_count();
    let (mut firsts, mut lasts) = (Marks::new(points), Marks::new(points));
    let mut follower = vec![NONE; points];
    let mut faces: Vec<FanFace> = Vec::new();
    let mut is_locked = |point: u32| {
        faces.clear();
        rest.visit(point, |face| {
            faces.push(face);
            true
        });
        let Some(&any) = faces.first() else {
            return true;
        };

        // Around a fan each neighbour comes first once and last once.
        firsts.clear();
        lasts.clear();
        for &FanFace { ring: [a, b], .. } in &faces {
            if firsts.has(a) || lasts.has(b) {
                return true;
            }
            firsts.add(a);
            lasts.add(b);
            follower[a as usize] = b;
        }

        // From one neighbour to the next, over all faces.
        let start = faces.iter().find(|face| !lasts.has(face.ring[0]));
        let start = start.unwrap_or(&any).ring[0];
        let (mut at, mut count) = (start, 0);
        while firsts.has(at) && (count == 0 || at != start) {
            at = follower[at as usize];
            count += 1;
        }
        let is_open = at != start;
        count < faces.len() || is_open && lock_border
    };
    let locked: Vec<bool> = (0..index32(points)).map(&mut is_locked).collect();
    let is_somewhere = |point: u32| rest.position(point).iter().all(|x| x.is_finite());
    locked
        .into_iter()
        .zip(0..)
        .map(|(is_locked, point)| is_locked || !is_somewhere(point))
        .collect()
}

/// Whether the surface stays the same but for its shape when a point moves to a neighbour: the link
/// condition (T. Dey, H. Edelsbrunner, S. Guha, D. Nekhayev: *Topology preserving edge contraction*, 1999). If holes may
/// close, one of three edges does when two of them become one.
pub(super) fn keeps_topology(
    rest: &mut RemainingMesh<'_>,
    marks: &mut Marks,
    fan: &Fan,
    point: u32,
    to: u32,
    closes_holes: bool,
) -> bool {
    // The faces that leave, and the points opposite.
    let (mut tips, mut leaving) = ([NONE; 2], 0);
    for face in &fan.faces {
        let tip = match face.ring {
            [a, tip] if a == to => tip,
            [tip, b] if b == to => tip,
            _ => continue,
        };
        if leaving == 2 {
            return false;
        }
        tips[leaving] = tip;
        leaving += 1;
    }
    let expected = if fan.ends.is_some() { 1 } else { 2 };
    if leaving != expected || tips[0] == tips[1] {
        return false;
    }
    let is_between_tips =
        |face: &FanFace| tips.contains(&face.ring[0]) && tips.contains(&face.ring[1]);
    let closes = fan.faces.iter().any(is_between_tips);
    let is_ear = fan.faces.len() == leaving;
    if is_ear && leaving == 2 {
        return false;
    }

    // The third point of a hole is a common neighbour.
    let third = match closes_holes {
        true => third_of_hole(rest, fan, to, tips[0]),
        false => NONE,
    };

    // No other common neighbour, and no face that is there already; an ear leaves an edge of another face.
    marks.clear();
    for face in &fan.faces {
        face.ring.iter().for_each(|&point| marks.add(point));
    }
    let (mut seen, mut is_kept) = (0, !is_ear);
    let is_free = rest.visit(to, |face| {
        seen += 1;
        if face.ring.contains(&point) {
            return true;
        }
        let [a, b] = face.ring.map(|x| tips.contains(&x));
        let blocks = |x: u32, is_tip: bool| !is_tip && x != third && marks.has(x);
        is_kept |= a || b;
        !(blocks(face.ring[0], a) || blocks(face.ring[1], b) || closes && a && b)
            && seen <= MOST_FACES
    });
    if is_free || seen <= MOST_FACES {
        return is_free && is_kept;
    }

    // Many faces: asked from the other side.
    !is_ear && !closes && are_apart(rest, fan, to, tips)
}

/// The third point of a hole whose other points are that of a fan and a neighbour, if it can close: the edges of both to the
/// third then are one, between two faces that are not the same; [`NONE`] otherwise.
fn third_of_hole(rest: &mut RemainingMesh<'_>, fan: &Fan, to: u32, tip: u32) -> u32 {
    // The border goes on from the start of a fan, and comes from its end.
    let (third, slot) = match fan.ends {
        Some([start, end]) if start == to => (end, 0),
        Some([start, end]) if end == to => (start, 1),
        _ => return NONE,
    };
    if third == to || third == tip {
        return NONE;
    }
    let (mut seen, mut is_next, mut is_free) = (0, false, true);
    let is_all = rest.visit(to, |FanFace { ring, .. }| {
        seen += 1;
        is_next |= ring[slot] == third;
        is_free &= ring[1 - slot] != third && !(ring.contains(&third) && ring.contains(&tip));
        is_free && seen <= MOST_FACES
    });
    match is_all && is_next {
        true => third,
        false => NONE,
    }
}

/// Whether no neighbour of the point but the tips has an edge to `to`, looked for at these neighbours.
fn are_apart(rest: &mut RemainingMesh<'_>, fan: &Fan, to: u32, tips: [u32; 2]) -> bool {
    let mut neighbours = fan.faces.iter().flat_map(|face| face.ring);
    neighbours.all(|other| {
        let mut seen = 0;
        other == to
            || tips.contains(&other)
            || rest.visit(other, |face| {
                seen += 1;
                !face.ring.contains(&to) && seen <= MOST_FACES
            })
    })
}
