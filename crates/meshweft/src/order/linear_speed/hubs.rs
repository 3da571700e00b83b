//! Vertices with many faces, whose faces are not gone through one by one.
//!
//! Most faces of a hub have none of their other vertices in the list: they are in
//! [classes](super::score_classes) of one score. A face with another vertex in the list is *loose*: it has its
//! score in [`OpenFaces::scores`], and is gone through as everywhere else. There are few of them at a time.

use super::best_face::BestFace;
use super::open_faces::OpenFaces;
use super::recent_vertices::RecentVertices;
use super::score_classes::{FaceAtHubs, FirstPlace, NONE, ScoreClasses, distinct_hubs};
use crate::index::index32;

/// The hubs of a mesh.
#[derive(Default)]
pub(super) struct Hubs {
    hubs: Vec<Hub>,
    classes: ScoreClasses,
}

/// A vertex with many faces.
#[derive(Default)]
struct Hub {
    /// The groups that it has faces in.
    groups: Vec<u32>,
    /// Its loose faces.
    loose: Vec<u32>,
}

impl Hubs {
    /// Vertices with more faces than `most_walked` as hubs where that pays, no vertex in the list.
    pub(super) fn new(open: &mut OpenFaces<'_>, most_walked: u32) -> Self {
        let mut made = Self::default();
        let numbered = (0..).zip(&open.vertices);
        let has_many = numbered.filter(|(_, vertex)| vertex.live > most_walked);
        let mut hubs: Vec<u32> = has_many.map(|(vertex, _)| vertex).collect();
        if hubs.is_empty() {
            return made;
        }
        open.number_hubs(&hubs);
        made.classes = ScoreClasses::new(open);

        // It does not where most faces would be loose for good. Without such hubs the groups of others only grow.
        let grouped = made.classes.grouped_corners(open, hubs.len());
        let mut grouped = grouped.into_iter();
        let all = hubs.len();
        hubs.retain(|&vertex| grouped.next() >= Some(open.vertices[vertex as usize].live / 2));
        if hubs.len() < all {
            open.number_hubs(&hubs);
            made.classes = ScoreClasses::new(open);
        }

        // Put each face into a class, or make it loose for good.
        made.hubs.resize_with(hubs.len(), Hub::default);
        for face in 0..index32(open.corners.len()) {
            match made.classes.faces[face as usize].group {
                NONE => made.loosen(open, face),
                _ => made.classes.add(open, face),
            }
        }

        // Each hub knows its groups.
        for (group, it) in (0..).zip(&made.classes.groups) {
            for hub in it.distinct_hubs() {
                made.hubs[open.vertices[hub as usize].hub as usize]
                    .groups
                    .push(group);
            }
        }
        made
    }

    pub(super) fn is_empty(&self) -> bool {
        self.hubs.is_empty()
    }

    fn hub_mut(&mut self, open: &OpenFaces<'_>, vertex: u32) -> &mut Hub {
        &mut self.hubs[open.vertices[vertex as usize].hub as usize]
    }

    /// Takes a face that is drawn out of its class and of the rows of its hubs.
    pub(super) fn draw(&mut self, open: &mut OpenFaces<'_>, face: u32) {
        let FaceAtHubs { group, class, .. } = self.classes.faces[face as usize];
        if group != NONE {
            self.classes.groups[group as usize].open_faces -= 1;
        }
        match class {
            NONE => self.tie(open, face),
            _ => self.classes.remove(face),
        }
        for corner in open.corners[face as usize] {
            if open.vertices[corner as usize].is_hub() {
                self.classes.take_out_of_row(open, face, corner);
            }
        }
    }

    /// Makes all faces loose at vertices that are in the list now.
    pub(super) fn enter(&mut self, open: &mut OpenFaces<'_>, vertices: [u32; 3]) {
        for vertex in vertices.map(|vertex| open.vertices[vertex as usize]) {
            if vertex.is_hub() {
                continue;
            }
            for &face in vertex.row(&open.rows) {
                let class = self.classes.faces[face as usize].class;
                if class != NONE {
                    open.scores[face as usize] = self.classes.score(class);
                    self.classes.remove(face);
                    self.loosen(open, face);
                }
            }
        }
    }

    /// Puts loose faces into classes that have no vertex but hubs in the list any more.
    pub(super) fn leave(&mut self, open: &OpenFaces<'_>, recent: &RecentVertices) {
        for vertex in recent.left() {
            let vertex = open.vertices[*vertex as usize];
            if vertex.is_hub() {
                continue;
            }
            for &face in vertex.row(&open.rows) {
                let FaceAtHubs { group, class, .. } = self.classes.faces[face as usize];
                let is_listed = |corner: &u32| {
                    !open.vertices[*corner as usize].is_hub() && recent.listed().contains(corner)
                };
                let corners = open.corners[face as usize];
                if group == NONE || class != NONE || corners.iter().any(is_listed) {
                    continue;
                }
                self.tie(open, face);
                self.classes.add(open, face);
            }
        }
    }

    /// Makes a face loose at all its hubs.
    fn loosen(&mut self, open: &OpenFaces<'_>, face: u32) {
        for hub in distinct_hubs(open, face) {
            self.hub_mut(open, hub).loose.push(face);
        }
    }

    /// Makes a face loose no more.
    fn tie(&mut self, open: &OpenFaces<'_>, face: u32) {
        for hub in distinct_hubs(open, face) {
            let loose = &mut self.hub_mut(open, hub).loose;
            if let Some(at) = loose.iter().position(|&other| other == face) {
                loose.swap_remove(at);
            }
        }
    }

    /// Adds the change of a hub's score to its faces, and offers them as if in the order of its row; returns how many
    /// scores changed.
    pub(super) fn change(
        &mut self,
        open: &mut OpenFaces<'_>,
        vertex: u32,
        change: f32,
        best: &mut BestFace,
    ) -> u64 {
        let classes = &mut self.classes;
        let Hub { groups, loose } = &mut self.hubs[open.vertices[vertex as usize].hub as usize];
        let mut first = FirstPlace::default();
        let mut changed = loose.len();

        groups.retain(|&group| classes.groups[group as usize].open_faces > 0);
        for &group in &*groups {
            changed += classes.groups[group as usize].classes.len();
            classes.change(open, group, vertex, change, &mut first);
        }

        for &face in &*loose {
            for place in classes.places_at(open, face, vertex) {
                let score = &mut open.scores[face as usize];
                *score += change;
                first.offer(*score, place);
            }
        }

        if first.score > 0.0 {
            let row = open.vertices[vertex as usize].row(&open.rows);
            best.offer(first.score, row[first.place as usize]);
        }
        changed as u64
    }
}
