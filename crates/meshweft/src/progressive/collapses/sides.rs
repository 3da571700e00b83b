//! The vertices at a point, and where they go.

use super::attributes::{Lengths, is_a_name, moves_a_vertex};
use super::fan::{Fan, MOST_FACES};
use super::points::WeldedPoints;
use super::remaining::RemainingMesh;
use crate::attribute::Attribute;
use crate::progressive::records::SidePair;

/// How far a vertex without a partner counts as moved at least, in diagonals of the bounding box: partners are
/// preferred down to about half of the faces.
const LEAST_PRICE: f64 = 0.01;

/// What is known of vertices at one point that are not the same.
#[derive(Debug)]
pub(super) struct SidePairing {
    pub(super) lengths: Option<Lengths>,
    /// Of vertices at one point that move together in every pose the first; empty where all do.
    moves_as: Vec<u32>,
    /// Of vertices with the same names the first; empty where none have any.
    named_as: Vec<u32>,
    /// Whether a vertex may go without a partner.
    cross_seams: bool,
    least_price: f64,
    /// The vertices at the neighbour.
    there: Vec<u32>,
}

impl SidePairing {
    pub(super) fn new(
        rest: &RemainingMesh<'_>,
        attributes: &[&Attribute],
        lengths: Option<Lengths>,
        cross_seams: bool,
        diagonal: f64,
    ) -> Self {
        let moving = attributes.iter().copied();
        let moving: Vec<&Attribute> = moving.filter(|it| moves_a_vertex(it)).collect();
        let moves_as = match rest.is_seamless() || moving.is_empty() {
            true => Vec::new(),
            false => WeldedPoints::new(rest.positions(), &moving).same_as,
        };
        let names = attributes.iter().copied();
        let names: Vec<&Attribute> = names.filter(|it| is_a_name(it)).collect();
        let named_as = match rest.is_seamless() || names.is_empty() {
            true => Vec::new(),
            // As if all were at one point.
            false => WeldedPoints::new(&vec![[0.0; 3]; rest.positions().len()], &names).same_as,
        };
        Self {
            lengths,
            moves_as,
            named_as,
            cross_seams,
            least_price: LEAST_PRICE * diagonal,
            there: Vec::new(),
        }
    }

    /// Whether two vertices at one point are at one point in every pose.
    fn move_alike(&self, a: u32, b: u32) -> bool {
        self.moves_as.is_empty() || self.moves_as[a as usize] == self.moves_as[b as usize]
    }

    /// Whether two vertices are of the same part, or whatever else is named by numbers.
    fn are_named_alike(&self, a: u32, b: u32) -> bool {
        self.named_as.is_empty() || self.named_as[a as usize] == self.named_as[b as usize]
    }

    /// The neighbours to which borders between parts go from the point of a fan, if just two do.
    pub(super) fn ends_of_border(&self, rest: &RemainingMesh<'_>, fan: &Fan) -> Option<[u32; 2]> {
        if self.named_as.is_empty() {
            return None;
        }
        let mut ends = fan.faces.iter().filter_map(|face| {
            let end = face.ring[1];
            let next = fan.faces.iter().find(|next| next.ring[0] == end)?;
            let sides = [face, next].map(|face| rest.side(face.corner));
            (!self.are_named_alike(sides[0], sides[1])).then_some(end)
        });
        let two = [ends.next()?, ends.next()?];
        ends.next().is_none().then_some(two)
    }

    /// How much two vertices differ, as a length.
    fn difference(&self, a: u32, b: u32) -> f64 {
        let difference = self.lengths.as_ref().map_or(0.0, |it| it.between(a, b));
        if difference.is_finite() {
            difference
        } else {
            0.0
        }
    }

    /// Pairs each vertex at the point of a fan with one at `to`: the one that has a leaving face in common
    /// with it. Where a vertex has none or two, and seams may be crossed, its attributes change, and the nearest vertex is
    /// taken, of those with the same names. Returns what that costs as a distance, 0 where all have partners; `None`
    /// where there is none, seams are not crossed, or vertices would come apart, or together, in another pose.
    pub(super) fn pair(
        &mut self,
        rest: &mut RemainingMesh<'_>,
        fan: &Fan,
        to: u32,
        pairs: &mut Vec<SidePair>,
    ) -> Option<f64> {
        // By leaving faces.
        pairs.clear();
        let mut price = 0.0_f64;
        for face in &fan.faces {
            let Some(other) = face.corner_at(to) else {
                continue;
            };
            let (from, to) = (rest.side(face.corner), rest.side(other));
            match pairs.iter_mut().find(|pair| pair.from == from) {
                Some(pair) if pair.to == to => {}
                Some(pair) => {
                    if !self.cross_seams || !self.move_alike(pair.to, to) {
                        return None;
                    }
                    price = price
                        .max(self.difference(pair.to, to))
                        .max(self.least_price);
                    if self.difference(from, to) < self.difference(from, pair.to) {
                        pair.to = to;
                    }
                }
                None => pairs.push(SidePair { from, to }),
            }
        }
        if rest.is_seamless() {
            return Some(price);
        }

        // By likeness.
        let partners = pairs.len();
        self.there.clear();
        for face in &fan.faces {
            let from = rest.side(face.corner);
            if pairs.iter().any(|pair| pair.from == from) {
                continue;
            }
            if !self.cross_seams {
                return None;
            }
            let as_one = |pair: &&SidePair| self.move_alike(pair.from, from);
            let guide = pairs[..partners].iter().find(as_one)?.to;
            if self.there.is_empty() {
                rest.put_sides(to, MOST_FACES, &mut self.there);
            }
            let alike = self.there.iter().copied();
            let alike = alike.filter(|&side| self.move_alike(side, guide));
            let alike = alike.chain([guide]);
            let named = alike.filter(|&side| self.are_named_alike(side, from));
            let to = named.min_by(|&a, &b| {
                let [near, far] = [a, b].map(|side| self.difference(from, side));
                near.total_cmp(&far).then(a.cmp(&b))
            })?;
            price = price.max(self.difference(from, to)).max(self.least_price);
            pairs.push(SidePair { from, to });
        }
        Some(price)
    }

    /// The vertex in use that is most like one at the same point that no face uses any more.
    pub(super) fn stand_in(
        &mut self,
        rest: &mut RemainingMesh<'_>,
        side: u32,
        point: u32,
    ) -> Option<u32> {
        rest.put_sides(point, MOST_FACES, &mut self.there);
        let there = self.there.iter().copied();
        let named = there.filter(|&it| self.are_named_alike(side, it));
        named.min_by(|&a, &b| {
            let apart = [a, b].map(|it| !self.move_alike(side, it));
            let [near, far] = [a, b].map(|it| self.difference(side, it));
            let nearest = near.total_cmp(&far).then(a.cmp(&b));
            apart[0].cmp(&apart[1]).then(nearest)
        })
    }
}
