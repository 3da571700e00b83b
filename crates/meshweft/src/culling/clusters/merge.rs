//! Clusters merged from faces, those that save most first.

use std::collections::BinaryHeap;

use super::masks::{self, Mask};
use crate::faces::Faces;
use crate::index::index32;
use crate::topology::Adjacency;

/// A vertex of more faces is a *hub*: it joins only clusters that share another vertex too. A fan of many faces would take time
/// by the square of them.
pub(super) const MOST_AROUND: usize = 64;

/// A cluster does not grow larger: one that always gains, in a mesh of faces that all eyes see, would take time by the square of it.
const MOST_FACES: u32 = 1 << 13;

/// What a cluster is expected to cost: the share of eyes that see something of it, times `vertex` for each of its vertices, plus
/// `face` for each of its faces, plus `draw`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Price {
    pub(super) vertex: f32,
    pub(super) face: f32,
    pub(super) draw: f32,
}

impl Price {
    #[inline]
    pub(super) fn weight(self, vertices: u32, faces: u32) -> f32 {
        self.vertex * vertices as f32 + self.face * faces as f32 + self.draw
    }
}

#[derive(Debug, Clone, Copy)]
struct Cluster<const WORDS: usize> {
    is_fixed: bool,
    mask: Mask<WORDS>,
    seen: u32,
    vertices: u32,
    faces: u32,
    /// Rises when it changes.
    version: u32,
}

impl<const WORDS: usize> Default for Cluster<WORDS> {
    fn default() -> Self {
        Self {
            is_fixed: false,
            mask: [0; WORDS],
            seen: 0,
            vertices: 0,
            faces: 0,
            version: 0,
        }
    }
}

/// A vertex more that is shared with a cluster.
fn count_shared(links: &mut Vec<Neighbor>, with: u32) {
    match links.iter_mut().find(|link| link.to == with) {
        Some(link) => link.shared += 1,
        None => links.push(Neighbor {
            to: with,
            shared: 1,
            hubs: 0,
        }),
    }
}

/// A neighbour, and how many vertices are in both: hubs, which have more than [`MOST_AROUND`] faces, and others.
#[derive(Debug, Clone, Copy)]
struct Neighbor {
    to: u32,
    shared: u32,
    hubs: u32,
}

impl Neighbor {
    fn all(self) -> u32 {
        self.shared + self.hubs
    }
}

/// What a cluster saves most by; of no use any more when one of both has changed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Offer {
    gain: f32,
    from: u32,
    to: u32,
    versions: [u32; 2],
}

impl Eq for Offer {}

impl Ord for Offer {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.gain
            .total_cmp(&other.gain)
            .then(other.from.cmp(&self.from))
    }
}

impl PartialOrd for Offer {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

pub(super) struct Merging<const WORDS: usize> {
    adjacency: Adjacency,
    price: Price,
    /// The cluster that a face or a cluster went into; clusters have the number of one of their faces.
    into: Vec<u32>,
    clusters: Vec<Cluster<WORDS>>,
    links: Vec<Vec<Neighbor>>,
    /// Vertices that may be in other clusters too.
    borders: Vec<Vec<u32>>,
    offers: BinaryHeap<Offer>,
}

impl<const WORDS: usize> Merging<WORDS> {
    /// Begins with clusters, each of which has the number of one of its faces. Those that have one of the fixed vertices
    /// stay as they are.
    pub(super) fn new(
        faces: Faces<'_>,
        masks: &[Mask<WORDS>],
        into: Vec<u32>,
        price: Price,
        is_fixed: impl Fn(u32) -> bool,
    ) -> Self {
        let adjacency = Adjacency::new(faces);
        let mut clusters = vec![Cluster::default(); faces.len()];
        for (mask, &cluster) in masks.iter().zip(&into) {
            let cluster: &mut Cluster<WORDS> = &mut clusters[cluster as usize];
            cluster.mask = masks::union(&cluster.mask, mask);
            cluster.faces += 1;
        }
        let mut links: Vec<Vec<Neighbor>> = vec![Vec::new(); faces.len()];
        let mut borders: Vec<Vec<u32>> = vec![Vec::new(); faces.len()];
        let mut around = Vec::new();
        let mut hubs = Vec::new();
        for vertex in 0..index32(faces.vertex_count()) {
            around.clear();
            around.extend(
                adjacency
                    .faces_of(vertex)
                    .iter()
                    .map(|&face| into[face as usize]),
            );
            around.sort_unstable();
            around.dedup();
            let is_fixed = is_fixed(vertex);
            let is_hub = adjacency.faces_of(vertex).len() > MOST_AROUND;
            for &cluster in &around {
                clusters[cluster as usize].vertices += 1;
                clusters[cluster as usize].is_fixed |= is_fixed;
                if around.len() < 2 || is_hub {
                    continue;
                }
                borders[cluster as usize].push(vertex);
                for &other in around.iter().filter(|&&other| other != cluster) {
                    count_shared(&mut links[cluster as usize], other);
                }
            }
            if is_hub {
                hubs.push(around.clone());
            }
        }
        for around in hubs {
            for &cluster in &around {
                let links = links[cluster as usize].iter_mut();
                for link in links.filter(|link| around.binary_search(&link.to).is_ok()) {
                    link.hubs += 1;
                }
            }
        }

        let mut merging = Self {
            adjacency,
            price,
            into,
            clusters,
            links,
            borders,
            offers: BinaryHeap::new(),
        };
        for cluster in 0..index32(faces.len()) {
            let state = &mut merging.clusters[cluster as usize];
            state.seen = masks::count(&state.mask);
            merging.offer(cluster);
        }
        merging
    }

    /// What two clusters save if they are one.
    fn gain(&self, a: u32, b: u32, shared: u32) -> f32 {
        let [a, b] = [a, b].map(|cluster| &self.clusters[cluster as usize]);
        let seen = masks::count(&masks::union(&a.mask, &b.mask));
        let weight = |cluster: &Cluster<WORDS>| self.price.weight(cluster.vertices, cluster.faces);
        let apart = a.seen as f32 * weight(a) + b.seen as f32 * weight(b);
        let together = self
            .price
            .weight(a.vertices + b.vertices - shared, a.faces + b.faces);
        apart - seen as f32 * together
    }

    /// Offers what a cluster saves most by, if it saves anything.
    fn offer(&mut self, cluster: u32) {
        if self.clusters[cluster as usize].is_fixed {
            return;
        }
        let own_faces = self.clusters[cluster as usize].faces;
        let mut best = (0.0, u32::MAX);
        for link in self.links[cluster as usize]
            .iter()
            .filter(|link| link.all() > 1)
        {
            let other = &self.clusters[link.to as usize];
            if other.is_fixed || own_faces + other.faces > MOST_FACES {
                continue;
            }
            let gain = self.gain(cluster, link.to, link.all());
            if gain > best.0 || (gain == best.0 && link.to < best.1) {
                best = (gain, link.to);
            }
        }
        let (gain, to) = best;
        if gain > 0.0 {
            let version = |cluster: u32| self.clusters[cluster as usize].version;
            self.offers.push(Offer {
                gain,
                from: cluster,
                to,
                versions: [version(cluster), version(to)],
            });
        }
    }

    fn cluster_of(&mut self, face: u32) -> u32 {
        let mut at = face;
        while self.into[at as usize] != at {
            let next = self.into[self.into[at as usize] as usize];
            self.into[at as usize] = next;
            at = next;
        }
        at
    }

    /// Merges as long as that saves something; the cluster of each face.
    pub(super) fn run(mut self) -> Vec<u32> {
        let mut around = Vec::new();
        while let Some(offer) = self.offers.pop() {
            let version = |cluster: u32| self.clusters[cluster as usize].version;
            let is_now = [version(offer.from), version(offer.to)] == offer.versions;
            match is_now {
                true => self.merge(offer.from, offer.to, &mut around),
                false if version(offer.from) == offer.versions[0] => self.offer(offer.from),
                false => {}
            }
        }
        (0..index32(self.into.len()))
            .map(|face| self.cluster_of(face))
            .collect()
    }

    fn merge(&mut self, a: u32, b: u32, around: &mut Vec<u32>) {
        // The one with the longer border stays.
        let length = |cluster: u32| self.borders[cluster as usize].len();
        let (a, b) = if length(a) >= length(b) {
            (a, b)
        } else {
            (b, a)
        };
        let mut links = std::mem::take(&mut self.links[a as usize]);
        let old_links = std::mem::take(&mut self.links[b as usize]);
        let shared = links
            .iter()
            .find(|link| link.to == b)
            .map_or(0, |link| link.all());
        links.retain(|link| link.to != b);

        // Vertices of the other: what they are shared with. Each of them that is new here is shared by one more.
        let border = std::mem::take(&mut self.borders[b as usize]);
        for vertex in border {
            around.clear();
            for place in 0..self.adjacency.faces_of(vertex).len() {
                let face = self.adjacency.faces_of(vertex)[place];
                let cluster = self.cluster_of(face);
                if !around.contains(&cluster) {
                    around.push(cluster);
                }
            }
            if around.contains(&a) {
                continue;
            }
            if around.len() > 1 {
                self.borders[a as usize].push(vertex);
            }
            for &cluster in around.iter().filter(|&&cluster| cluster != b) {
                count_shared(&mut links, cluster);
            }
        }

        // One cluster of both.
        let other = self.clusters[b as usize];
        self.into[b as usize] = a;
        self.clusters[b as usize].version += 1;
        let state = &mut self.clusters[a as usize];
        state.mask = masks::union(&state.mask, &other.mask);
        state.seen = masks::count(&state.mask);
        state.vertices += other.vertices - shared;
        state.faces += other.faces;
        state.version += 1;

        // Neighbours of the other are its neighbours now.
        for old in &old_links {
            if old.to == a {
                continue;
            }
            let link = links.iter_mut().find(|link| link.to == old.to);
            let link = link.expect("what has a vertex of one has a vertex of both");
            link.hubs = link.hubs.max(old.hubs);
            let new = Neighbor { to: a, ..*link };
            let back = &mut self.links[old.to as usize];
            let slot = back
                .iter()
                .position(|back| back.to == b)
                .expect("links go both ways");
            match back.iter_mut().find(|back| back.to == a) {
                Some(back_to_a) => {
                    *back_to_a = new;
                    back.swap_remove(slot);
                }
                None => back[slot] = new,
            }
        }
        self.links[a as usize] = links;
        self.offer(a);
    }
}
