//! Faces around the same hubs with the same score, changed and compared as one.
//!
//! While no vertex of a face but hubs is in the list, only hubs change its score: it stays equal to those
//! of all faces that have the same hubs and the same score now. Such faces are a *class*: its score is
//! changed once, and only the face is compared that stands first in the row of the hub. Adding the same
//! to all classes with the same hubs keeps their order, and may round two scores to one; these classes
//! become one.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::open_faces::OpenFaces;
use crate::index::index32;

/// No class, no group, no place in a row, no hub.
pub(super) const NONE: u32 = u32::MAX;

/// Fewest faces of a group; others are always loose. This bounds memory where many hubs share faces. The number was
/// not tuned, and changes no order.
const LEAST_GROUP: usize = 8;

/// Stale entries that a class may have, beside as many as it has faces, before they are dropped.
const MOST_STALE: usize = 32;

/// All faces at hubs.
#[derive(Default)]
pub(super) struct ScoreClasses {
    pub(super) groups: Vec<HubGroup>,
    classes: Vec<ScoreClass>,
    /// Classes that are not in use.
    unused: Vec<u32>,
    /// Every face of the mesh.
    pub(super) faces: Vec<FaceAtHubs>,
}

/// All faces that have the same hubs.
pub(super) struct HubGroup {
    /// The hubs of each face, as [`hubs_at`] has them.
    hubs: [u32; 3],
    /// How many of its faces are not drawn yet.
    pub(super) open_faces: u32,
    /// Its classes by rising score.
    pub(super) classes: Vec<u32>,
}

/// Faces of a group that have the same score.
#[derive(Default)]
struct ScoreClass {
    score: f32,
    /// The hubs of its group.
    hubs: [u32; 3],
    face_count: usize,
    /// For each hub of the group the places of the faces in its row, the first on top. Of a face that
    /// stands there more than once, the first place is in the first heap of that hub, and so on. An entry is
    /// stale if no face of the class stands there.
    places: [BinaryHeap<Reverse<u32>>; 3],
}

/// What is known of a face.
#[derive(Clone, Copy)]
pub(super) struct FaceAtHubs {
    /// [`NONE`] if it has no hub, or is always loose.
    pub(super) group: u32,
    /// [`NONE`] while it is loose, and once it is drawn.
    pub(super) class: u32,
    /// For each corner at a hub its place in that row, until it is drawn.
    pub(super) places: [u32; 3],
}

/// The greatest score in the row of a hub, and the first place of it.
#[derive(Default)]
pub(super) struct FirstPlace {
    /// 0 where none was offered.
    pub(super) score: f32,
    pub(super) place: u32,
}

impl FirstPlace {
    #[inline]
    pub(super) fn offer(&mut self, score: f32, place: u32) {
        if score > self.score || (score == self.score && place < self.place) {
            *self = Self { score, place };
        }
    }
}

/// The hubs of a face by rising number, one that it names twice twice; then [`NONE`].
pub(super) fn hubs_at(open: &OpenFaces<'_>, face: u32) -> [u32; 3] {
    let is_hub = |vertex: u32| open.vertices[vertex as usize].is_hub();
    let corners = open.corners[face as usize];
    let mut hubs = corners.map(|vertex| if is_hub(vertex) { vertex } else { NONE });
    hubs.sort_unstable();
    hubs
}

/// The hubs of a face, each once.
pub(super) fn distinct_hubs(open: &OpenFaces<'_>, face: u32) -> impl Iterator<Item = u32> + use<> {
    each_once(hubs_at(open, face))
}

fn each_once(hubs: [u32; 3]) -> impl Iterator<Item = u32> {
    let is_first = move |&at: &usize| hubs[at] != NONE && (at == 0 || hubs[at - 1] != hubs[at]);
    (0..3).filter(is_first).map(move |at| hubs[at])
}

impl HubGroup {
    pub(super) fn distinct_hubs(&self) -> impl Iterator<Item = u32> + use<> {
        each_once(self.hubs)
    }
}

impl ScoreClasses {
    /// The groups of a mesh, all faces in no class yet.
    pub(super) fn new(open: &OpenFaces<'_>) -> Self {
        let mut made = Self::default();
        let unknown = FaceAtHubs {
            group: NONE,
            class: NONE,
            places: [NONE; 3],
        };
        made.faces = vec![unknown; open.corners.len()];

        // Where faces stand in the rows of hubs. A face that stands there twice has two such corners.
        for (vertex, hub) in (0..).zip(&open.vertices).filter(|(_, it)| it.is_hub()) {
            for (place, &face) in (0..).zip(hub.row(&open.rows)) {
                let corners = open.corners[face as usize];
                let places = &mut made.faces[face as usize].places;
                if let Some(free) = (0..3).find(|&at| corners[at] == vertex && places[at] == NONE) {
                    places[free] = place;
                }
            }
        }

        // Faces with the same hubs are a group.
        let all = (0..index32(open.corners.len())).map(|face| (hubs_at(open, face), face));
        let mut by_hubs: Vec<_> = all.filter(|(hubs, _)| hubs[0] != NONE).collect();
        by_hubs.sort_unstable();
        for same in by_hubs.chunk_by(|(a, _), (b, _)| a == b) {
            if same.len() < LEAST_GROUP {
                continue;
            }
            for &(_, face) in same {
                made.faces[face as usize].group = index32(made.groups.len());
            }
            made.groups.push(HubGroup {
                hubs: same[0].0,
                open_faces: index32(same.len()),
                classes: Vec::new(),
            });
        }
        made
    }

    /// For each hub how many places of its row faces of groups have.
    pub(super) fn grouped_corners(&self, open: &OpenFaces<'_>, hub_count: usize) -> Vec<u32> {
        let mut counts = vec![0; hub_count];
        for group in &self.groups {
            for &hub in group.hubs.iter().filter(|&&hub| hub != NONE) {
                counts[open.vertices[hub as usize].hub as usize] += group.open_faces;
            }
        }
        counts
    }

    /// The score of all faces of a class.
    pub(super) fn score(&self, class: u32) -> f32 {
        self.classes[class as usize].score
    }

    /// The places of a face in the row of a hub, the first one first.
    pub(super) fn places_at(
        &self,
        open: &OpenFaces<'_>,
        face: u32,
        hub: u32,
    ) -> impl Iterator<Item = u32> + use<> {
        let corners = open.corners[face as usize];
        let places = self.faces[face as usize].places;
        let mut at_hub = [0, 1, 2].map(|at: usize| match corners[at] == hub {
            true => places[at],
            false => NONE,
        });
        at_hub.sort_unstable();
        at_hub.into_iter().take_while(|&place| place != NONE)
    }

    /// The hubs of a face and its places in their rows, in the order of [`HubGroup::hubs`].
    pub(super) fn sorted_places(&self, open: &OpenFaces<'_>, face: u32) -> [(u32, u32); 3] {
        let corners = open.corners[face as usize];
        let places = self.faces[face as usize].places;
        let mut sorted = [0, 1, 2].map(|at: usize| match places[at] {
            NONE => (NONE, NONE),
            place => (corners[at], place),
        });
        sorted.sort_unstable();
        sorted
    }

    /// Takes the first place of a face that is drawn out of the row of a hub. The last face of the
    /// row then stands there.
    pub(super) fn take_out_of_row(&mut self, open: &mut OpenFaces<'_>, face: u32, hub: u32) {
        // The corner that stands first.
        let corners = open.corners[face as usize];
        let places = &mut self.faces[face as usize].places;
        let at_hub = (0..3).filter(|&at| corners[at] == hub);
        let Some(first) = at_hub.min_by_key(|&at| places[at]) else {
            return;
        };
        let place = std::mem::replace(&mut places[first], NONE);

        // The last face takes its place.
        let vertex = &mut open.vertices[hub as usize];
        vertex.live -= 1;
        let last = vertex.live;
        let moved = open.rows[(vertex.start + last) as usize];
        open.rows[(vertex.start + place) as usize] = moved;

        // It has to know.
        let corners = open.corners[moved as usize];
        let places = &mut self.faces[moved as usize].places;
        if let Some(at) = (0..3).find(|&at| corners[at] == hub && places[at] == last) {
            places[at] = place;
        }
        if self.faces[moved as usize].class != NONE {
            self.enter_places(open, moved);
        }
    }

    /// Puts a face into the class of its score, which is made if there is none.
    pub(super) fn add(&mut self, open: &OpenFaces<'_>, face: u32) {
        let score = open.scores[face as usize];
        let group = &mut self.groups[self.faces[face as usize].group as usize];
        let all = &mut self.classes;
        let is_less = |&class: &u32| all[class as usize].score < score;
        let at = group.classes.partition_point(is_less);
        let class = match group.classes.get(at) {
            Some(&class) if all[class as usize].score == score => class,
            _ => {
                let class = self.unused.pop().unwrap_or_else(|| {
                    all.push(ScoreClass::default());
                    index32(all.len() - 1)
                });
                all[class as usize].score = score;
                all[class as usize].hubs = group.hubs;
                group.classes.insert(at, class);
                class
            }
        };
        self.add_to(open, class, face);
    }

    fn add_to(&mut self, open: &OpenFaces<'_>, class: u32, face: u32) {
        self.faces[face as usize].class = class;
        self.classes[class as usize].face_count += 1;
        self.enter_places(open, face);
    }

    /// Enters the places of a face into the heaps of its class.
    fn enter_places(&mut self, open: &OpenFaces<'_>, face: u32) {
        let sorted = self.sorted_places(open, face);
        let number = self.faces[face as usize].class;
        let class = &mut self.classes[number as usize];
        for (heap, (_, place)) in class.places.iter_mut().zip(sorted) {
            if place != NONE {
                heap.push(Reverse(place));
            }
        }

        // Stale entries are dropped where they are more than the others.
        if class.places[0].len() > 2 * class.face_count + MOST_STALE {
            for face in self.take_faces(open, number) {
                self.add_to(open, number, face);
            }
        }
    }

    /// Takes a face out of its class, and the class out of its group if that was the last face.
    pub(super) fn remove(&mut self, face: u32) {
        let class = self.leave(face);
        if self.classes[class as usize].face_count > 0 {
            return;
        }
        let score = self.score(class);
        let group = &mut self.groups[self.faces[face as usize].group as usize];
        let is_less = |&class: &u32| self.classes[class as usize].score < score;
        group.classes.remove(group.classes.partition_point(is_less));
        self.reuse(class);
    }

    /// Takes a face out of its class, which may be empty then.
    fn leave(&mut self, face: u32) -> u32 {
        let class = std::mem::replace(&mut self.faces[face as usize].class, NONE);
        self.classes[class as usize].face_count -= 1;
        class
    }

    /// Adds the change of a hub's score to the classes of a group, and offers their first places, once
    /// for each time that a face names the hub.
    pub(super) fn change(
        &mut self,
        open: &OpenFaces<'_>,
        group: u32,
        hub: u32,
        change: f32,
        first: &mut FirstPlace,
    ) {
        let hubs = self.groups[group as usize].hubs;
        let heaps = move || (0..3).filter(move |&heap| hubs[heap] == hub);
        let mut classes = std::mem::take(&mut self.groups[group as usize].classes);

        // From the greatest on, until they are less than what was offered.
        for &class in classes.iter().rev() {
            let mut score = self.score(class);
            let mut is_enough = false;
            for heap in heaps() {
                score += change;
                if score >= first.score {
                    is_enough = true;
                    if let Some(place) = self.first_place(open, class, heap) {
                        first.offer(score, place);
                    }
                }
            }
            if !is_enough {
                break;
            }
        }

        // Change the classes, from the least on. Two that are the same now become one.
        if change != 0.0 {
            let mut kept = 0;
            for at in 0..classes.len() {
                let class = classes[at];
                let changed = heaps().fold(self.score(class), |score, _| score + change);
                self.classes[class as usize].score = changed;
                if kept > 0 && self.score(classes[kept - 1]) == changed {
                    classes[kept - 1] = self.merge(open, classes[kept - 1], class);
                } else {
                    classes[kept] = class;
                    kept += 1;
                }
            }
            classes.truncate(kept);
        }
        self.groups[group as usize].classes = classes;
    }

    /// The first place of a class in one of its heaps.
    fn first_place(&mut self, open: &OpenFaces<'_>, class: u32, heap: usize) -> Option<u32> {
        loop {
            let &Reverse(place) = self.classes[class as usize].places[heap].peek()?;
            if self.face_at(open, class, heap, place).is_some() {
                return Some(place);
            }
            self.classes[class as usize].places[heap].pop();
        }
    }

    /// The face that an entry of a heap stands for, unless the entry is stale.
    fn face_at(&self, open: &OpenFaces<'_>, class: u32, heap: usize, place: u32) -> Option<u32> {
        let hub = self.classes[class as usize].hubs[heap];
        let vertex = open.vertices[hub as usize];
        let &face = vertex.row(&open.rows).get(place as usize)?;
        let is_there = self.faces[face as usize].class == class
            && self.sorted_places(open, face)[heap] == (hub, place);
        is_there.then_some(face)
    }

    /// Makes one of two classes of a group, and returns it.
    fn merge(&mut self, open: &OpenFaces<'_>, a: u32, b: u32) -> u32 {
        let [of_a, of_b] = [a, b].map(|class| self.classes[class as usize].face_count);
        let (smaller, larger) = if of_a < of_b { (a, b) } else { (b, a) };
        for face in self.take_faces(open, smaller) {
            self.add_to(open, larger, face);
        }
        self.reuse(smaller);
        larger
    }

    /// Empties a class; returns its faces, which are in no class then.
    fn take_faces(&mut self, open: &OpenFaces<'_>, class: u32) -> Vec<u32> {
        let [first, ..] = std::mem::take(&mut self.classes[class as usize].places);
        let mut faces = Vec::with_capacity(self.classes[class as usize].face_count);
        for Reverse(place) in first.into_vec() {
            if let Some(face) = self.face_at(open, class, 0, place) {
                self.leave(face);
                faces.push(face);
            }
        }
        faces
    }

    /// Keeps a class that no group has any more for another use.
    fn reuse(&mut self, class: u32) {
        self.classes[class as usize] = ScoreClass::default();
        self.unused.push(class);
    }
}
