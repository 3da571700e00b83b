//! The faces at a root that are left to be written.

use std::collections::BTreeSet;

use crate::index::index32;

/// A face at the root: the two corners that follow it.
#[derive(Debug, Clone, Copy)]
pub(super) struct RootFace {
    pub(super) from: u32,
    pub(super) to: u32,
    pub(super) face: u32,
}

impl RootFace {
    /// `from`, or the other one.
    #[inline]
    fn corner(&self, slot: usize) -> u32 {
        match slot {
            0 => self.from,
            _ => self.to,
        }
    }
}

/// What comes first among faces of one edge: those with new vertices, by their old numbers, then the others
/// by their new numbers. A mesh that was decoded has the same order.
pub(super) type Rank = u64;

/// The faces at a root, to be taken one by one, by either corner.
#[derive(Debug, Default)]
pub(super) struct AtRoot {
    faces: Vec<RootFace>,
    is_taken: Vec<bool>,
    /// How many are not taken.
    left: usize,
    /// Faces by `from`, and by `to`: a corner and a place, rising. Made where there are many, or several at a corner.
    by_corner: [Vec<(u32, u32)>; 2],
    /// Where a corner has several faces.
    ranked: Option<Ranked>,
    /// Where it has none: all places, those to begin a fan with first, once they were asked for; and how many
    /// of them were looked at.
    rest: Vec<u32>,
    passed: usize,
}

/// Faces by what comes first, kept up as vertices are met.
#[derive(Debug, Default)]
struct Ranked {
    by_corner: [BTreeSet<(u32, Rank, u32)>; 2],
    rest: BTreeSet<(Rank, Rank, u32)>,
}

impl AtRoot {
    /// Takes the faces of another root; `rank` of a vertex.
    pub(super) fn set(
        &mut self,
        faces: impl Iterator<Item = RootFace>,
        rank: impl Fn(u32) -> Rank,
    ) {
        self.faces.clear();
        self.faces.extend(faces);
        self.is_taken.clear();
        self.is_taken.resize(self.faces.len(), false);
        self.rest.clear();
        self.passed = 0;
        self.ranked = None;
        self.left = self.faces.len();
        let is_short = self.is_short();
        if !is_short {
            self.sort_by_corner();
        }

        // Whether a corner has several.
        let has_twins = match is_short {
            true => (1..self.faces.len()).any(|place| {
                let RootFace { from, to, .. } = self.faces[place];
                let mut before = self.faces[..place].iter();
                before.any(|face| face.from == from || face.to == to)
            }),
            false => {
                let twins = |by: &Vec<(u32, u32)>| by.windows(2).any(|pair| pair[0].0 == pair[1].0);
                self.by_corner.iter().any(twins)
            }
        };
        if has_twins {
            if is_short {
                self.sort_by_corner();
            }
            let mut ranked = Ranked::default();
            for (place, face) in (0..).zip(&self.faces) {
                ranked.insert(place, *face, &rank);
            }
            self.ranked = Some(ranked);
        }
    }

    /// Whether faces are found by looking at each.
    fn is_short(&self) -> bool {
        self.faces.len() <= 12
    }

    fn sort_by_corner(&mut self) {
        for (slot, by_corner) in self.by_corner.iter_mut().enumerate() {
            by_corner.clear();
            by_corner.extend(self.faces.iter().map(|face| face.corner(slot)).zip(0..));
            by_corner.sort_unstable();
        }
    }

    pub(super) fn face(&self, place: u32) -> RootFace {
        self.faces[place as usize]
    }

    /// The first face that is left with a corner: `from`, or `to` if it `is_backward`.
    #[inline]
    pub(super) fn first_at(&self, corner: u32, is_backward: bool) -> Option<u32> {
        let slot = usize::from(is_backward);
        if let Some(ranked) = &self.ranked {
            let mut at = ranked.by_corner[slot].range((corner, 0, 0)..);
            let &(found, _, place) = at.next()?;
            return (found == corner).then_some(place);
        }
        if self.is_short() {
            let is_it = |face: &RootFace| face.corner(slot) == corner;
            let place = self.faces.iter().position(is_it)?;
            return (!self.is_taken[place]).then(|| index32(place));
        }
        let by_corner = &self.by_corner[slot];
        let at = by_corner.partition_point(|entry| entry.0 < corner);
        let &(found, place) = by_corner.get(at)?;
        (found == corner && !self.is_taken[place as usize]).then_some(place)
    }

    /// The first face that is left.
    pub(super) fn first(&mut self, rank: impl Fn(u32) -> Rank) -> Option<u32> {
        if self.left == 0 {
            return None;
        }
        if let Some(ranked) = &self.ranked {
            return ranked.rest.first().map(|&(.., place)| place);
        }
        // Without twins, a vertex that was met since belongs to a face that was taken.
        if self.rest.is_empty() {
            let places = 0..index32(self.faces.len());
            self.rest
                .extend(places.filter(|&place| !self.is_taken[place as usize]));
            self.rest.sort_by_key(|&place| {
                let RootFace { from, to, .. } = self.faces[place as usize];
                [rank(from), rank(to)]
            });
        }
        let left = |&place: &u32| !self.is_taken[place as usize];
        self.passed += self.rest[self.passed..].iter().position(left)?;
        Some(self.rest[self.passed])
    }

    /// A face is written; its corners have ranks.
    pub(super) fn take(&mut self, place: u32, rank: impl Fn(u32) -> Rank) {
        self.is_taken[place as usize] = true;
        self.left -= 1;
        if let Some(ranked) = &mut self.ranked {
            ranked.remove(place, self.faces[place as usize], &rank);
        }
    }

    /// A vertex is met, so that its rank changes from one to another; `rank` has those of all others.
    pub(super) fn meet(&mut self, vertex: u32, old: Rank, new: Rank, rank: impl Fn(u32) -> Rank) {
        let Some(ranked) = &mut self.ranked else {
            return;
        };
        for slot in 0..2 {
            let at = self.by_corner[slot].partition_point(|entry| entry.0 < vertex);
            for &(corner, place) in &self.by_corner[slot][at..] {
                if corner != vertex {
                    break;
                }
                if !self.is_taken[place as usize] {
                    let face = self.faces[place as usize];
                    let with = |of: Rank| {
                        let rank = &rank;
                        move |it: u32| if it == vertex { of } else { rank(it) }
                    };
                    ranked.remove(place, face, &with(old));
                    ranked.insert(place, face, &with(new));
                }
            }
        }
    }
}

impl Ranked {
    fn insert(&mut self, place: u32, face: RootFace, rank: &impl Fn(u32) -> Rank) {
        let RootFace { from, to, .. } = face;
        self.by_corner[0].insert((from, rank(to), place));
        self.by_corner[1].insert((to, rank(from), place));
        self.rest.insert((rank(from), rank(to), place));
    }

    fn remove(&mut self, place: u32, face: RootFace, rank: &impl Fn(u32) -> Rank) {
        let RootFace { from, to, .. } = face;
        self.by_corner[0].remove(&(from, rank(to), place));
        self.by_corner[1].remove(&(to, rank(from), place));
        self.rest.remove(&(rank(from), rank(to), place));
    }
}
