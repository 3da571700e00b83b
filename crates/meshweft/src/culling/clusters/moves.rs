//! Faces at the borders of clusters, moved where they cost less.

use super::masks::{self, Mask};
use super::merge::{MOST_AROUND, Price};
use crate::cache::nvidia::BATCH_FACES;
use crate::faces::Faces;
use crate::index::index32;
use crate::topology::{Adjacency, distinct};

/// How often all faces are looked at, at most; after three times hardly any is moved.
const ROUNDS: u32 = 3;

/// How many neighbouring clusters a face chooses from, at most.
const MOST_BESIDE: usize = 12;

/// Moves faces to a neighbouring cluster as long as that costs less: in the order of faces, each to the cluster where it saves most.
///
/// Merging never takes back what it did; this does, face by face. `faces` are those that the clusters have by place, with a mask each.
///
/// # Complexity
/// Time O(faces · eyes); space 20 bytes a face, 100 a cluster, and 4 bytes an eye and cluster of more than one face.
pub(super) fn improve<const WORDS: usize>(
    faces: Faces<'_>,
    masks: &[Mask<WORDS>],
    first_of: &mut [u32],
    price: Price,
) {
    let mut moves = Moves::new(faces, masks, first_of, price);
    for _ in 0..ROUNDS {
        let mut is_done = true;
        for face in 0..index32(faces.len()) {
            is_done &= !(moves.is_due(face) && moves.improve_face(face));
        }
        if is_done {
            break;
        }
    }
    moves.number(first_of);
}

/// What each face costs that a cluster has more or less than whole batches, from round to round, in faces that all eyes see: the
/// cheapest moves come first. A higher price than that of a face makes more batches full, and more of them seen.
const RAGGED: [f32; 7] = [0.125, 0.18, 0.25, 0.35, 0.5, 0.7, 1.0];

/// Moves faces to a neighbouring cluster so that more clusters have whole batches of an NVIDIA card, those first that cost least.
///
/// # Complexity
/// As [`improve`].
pub(super) fn fill_batches<const WORDS: usize>(
    faces: Faces<'_>,
    masks: &[Mask<WORDS>],
    first_of: &mut [u32],
    price: Price,
) {
    let mut moves = Moves::new(faces, masks, first_of, price);
    for ragged in RAGGED {
        moves.ragged = ragged * (64 * WORDS) as f32;
        moves.due.fill(true);
        for face in 0..index32(faces.len()) {
            if moves.is_due(face) {
                moves.improve_face(face);
            }
        }
    }
    moves.number(first_of);
}

/// How many faces a cluster has more than whole batches, or less if that is nearer.
fn ragged(faces: u32) -> f32 {
    let over = faces % BATCH_FACES;
    over.min(BATCH_FACES - over) as f32
}

/// A cluster, with how many of its faces each eye sees.
#[derive(Debug, Clone)]
struct Tally<const WORDS: usize> {
    mask: Mask<WORDS>,
    /// Eyes that see just one face of it.
    once: Mask<WORDS>,
    /// How many see it by each eye; none for a single face, as in soups most clusters are.
    counts: Option<Box<[[u32; 64]; WORDS]>>,
    vertices: u32,
    faces: u32,
}

impl<const WORDS: usize> Tally<WORDS> {
    fn empty() -> Self {
        Self {
            mask: [0; WORDS],
            once: [0; WORDS],
            counts: None,
            vertices: 0,
            faces: 0,
        }
    }

    fn add(&mut self, mask: &Mask<WORDS>) {
        self.faces += 1;
        if self.faces == 1 && self.counts.is_none() {
            (self.mask, self.once) = (*mask, *mask);
            return;
        }
        let alone = self.once;
        let counts = self.counts.get_or_insert_with(|| {
            let mut counts = Box::new([[0; 64]; WORDS]);
            for (counts, bits) in counts.iter_mut().zip(alone) {
                ones(bits).for_each(|bit| counts[bit] = 1);
            }
            counts
        });
        for (word, &bits) in mask.iter().enumerate() {
            for bit in ones(bits) {
                let count = &mut counts[word][bit];
                *count += 1;
                let flag = 1 << bit;
                match *count {
                    1 => {
                        self.mask[word] |= flag;
                        self.once[word] |= flag;
                    }
                    2 => self.once[word] &= !flag,
                    _ => {}
                }
            }
        }
    }

    fn remove(&mut self, mask: &Mask<WORDS>) {
        self.faces -= 1;
        let Some(counts) = &mut self.counts else {
            (self.mask, self.once) = ([0; WORDS], [0; WORDS]);
            return;
        };
        for (word, &bits) in mask.iter().enumerate() {
            for bit in ones(bits) {
                let count = &mut counts[word][bit];
                *count -= 1;
                let flag = 1 << bit;
                match *count {
                    0 => {
                        self.mask[word] &= !flag;
                        self.once[word] &= !flag;
                    }
                    1 => self.once[word] |= flag,
                    _ => {}
                }
            }
        }
    }
}

/// The places of the bits that are set.
fn ones(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (place < 64).then_some(place as usize)
    })
}

struct Moves<'a, const WORDS: usize> {
    faces: &'a [[u32; 3]],
    masks: &'a [Mask<WORDS>],
    adjacency: Adjacency,
    price: Price,
    /// What each face costs that a cluster has more or less than whole batches, in eyes times vertices.
    ragged: f32,
    cluster_of: Vec<u32>,
    clusters: Vec<Tally<WORDS>>,
    /// Faces that were not looked at since one beside them was moved.
    due: Vec<bool>,
}

impl<'a, const WORDS: usize> Moves<'a, WORDS> {
    fn new(faces: Faces<'a>, masks: &'a [Mask<WORDS>], first_of: &[u32], price: Price) -> Self {
        let mut moves = Self {
            faces: faces.as_slice(),
            masks,
            adjacency: Adjacency::new(faces),
            price,
            ragged: 0.0,
            cluster_of: Vec::with_capacity(faces.len()),
            clusters: Vec::new(),
            due: vec![true; faces.len()],
        };
        let mut number = vec![u32::MAX; faces.len()];
        for (&first, mask) in first_of.iter().zip(masks) {
            let number = &mut number[first as usize];
            if *number == u32::MAX {
                *number = index32(moves.clusters.len());
                moves.clusters.push(Tally::empty());
            }
            moves.clusters[*number as usize].add(mask);
            moves.cluster_of.push(*number);
        }
        let mut around: Vec<u32> = Vec::new();
        for vertex in 0..index32(faces.vertex_count()) {
            around.clear();
            around.extend(
                moves
                    .adjacency
                    .faces_of(vertex)
                    .iter()
                    .map(|&face| moves.cluster_of[face as usize]),
            );
            around.sort_unstable();
            around.dedup();
            for &cluster in &around {
                moves.clusters[cluster as usize].vertices += 1;
            }
        }
        moves
    }

    /// Whether a face is to be looked at; it then is not any more.
    fn is_due(&mut self, face: u32) -> bool {
        std::mem::take(&mut self.due[face as usize])
    }

    /// Moves a face to the neighbouring cluster where it saves most, if it saves anything.
    fn improve_face(&mut self, face: u32) -> bool {
        let from = self.cluster_of[face as usize];
        let corners = self.faces[face as usize];

        // The clusters that have two of its vertices, and which of the vertices each has from other faces.
        let mut beside: [(u32, u32); MOST_BESIDE] = [(u32::MAX, 0); MOST_BESIDE];
        let mut count = 0;
        let mut own = 0;
        for (corner, vertex) in distinct(corners).enumerate() {
            let faces = self.adjacency.faces_of(vertex);
            if faces.len() > MOST_AROUND {
                return false;
            }
            for &other in faces.iter().filter(|&&other| other != face) {
                let cluster = self.cluster_of[other as usize];
                let flag = 1 << corner;
                if cluster == from {
                    own |= flag;
                    continue;
                }
                match beside[..count]
                    .iter_mut()
                    .find(|(known, _)| *known == cluster)
                {
                    Some((_, has)) => *has |= flag,
                    None if count < MOST_BESIDE => {
                        beside[count] = (cluster, flag);
                        count += 1;
                    }
                    None => {}
                }
            }
        }
        if count == 0 {
            return false;
        }

        // What leaving saves, and what each of them would cost more.
        let mask = &self.masks[face as usize];
        let cost = |seen: u32, vertices: u32, faces: u32| match faces {
            0 => 0.0,
            _ => seen as f32 * self.price.weight(vertices, faces) + self.ragged * ragged(faces),
        };
        let vertices = index32(distinct(corners).count());
        let left = &self.clusters[from as usize];
        let seen = masks::count(&left.mask);
        let lost = masks::count::<WORDS>(&std::array::from_fn(|i| left.once[i] & mask[i]));
        let gone = vertices - u32::count_ones(own);
        let saved = cost(seen, left.vertices, left.faces)
            - cost(seen - lost, left.vertices - gone, left.faces - 1);
        let mut best = (1e-3, u32::MAX, 0);
        for &(cluster, has) in beside[..count]
            .iter()
            .filter(|(_, has)| has.count_ones() > 1)
        {
            let to = &self.clusters[cluster as usize];
            let seen = masks::count(&to.mask);
            let both = masks::count(&masks::union(&to.mask, mask));
            let new = vertices - has.count_ones();
            let more =
                cost(both, to.vertices + new, to.faces + 1) - cost(seen, to.vertices, to.faces);
            if saved - more > best.0 {
                best = (saved - more, cluster, new);
            }
        }

        // The move.
        let (_, to, new) = best;
        if to == u32::MAX {
            return false;
        }
        let left = &mut self.clusters[from as usize];
        left.remove(mask);
        left.vertices -= gone;
        let joined = &mut self.clusters[to as usize];
        joined.add(mask);
        joined.vertices += new;
        self.cluster_of[face as usize] = to;
        for vertex in corners {
            for &other in self.adjacency.faces_of(vertex) {
                self.due[other as usize] = true;
            }
        }
        true
    }

    /// The first face of the cluster of each face.
    fn number(&self, first_of: &mut [u32]) {
        let mut first = vec![u32::MAX; self.clusters.len()];
        for ((face, &cluster), first_of) in (0..).zip(&self.cluster_of).zip(first_of) {
            let first = &mut first[cluster as usize];
            *first = (*first).min(face);
            *first_of = *first;
        }
    }
}
