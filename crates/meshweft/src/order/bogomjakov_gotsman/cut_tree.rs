//! A mesh cut into halves, recursively.

use crate::index::index32;
use crate::parallel;
use crate::partition::{Bisection, Graph, coarser, halves};
use crate::random::SplitMix64;

/// Faces cut in two, recursively, down to pieces.
#[derive(Debug)]
pub(super) enum CutTree {
    /// A piece: its faces, in rising order.
    Piece(Vec<u32>),
    /// Two halves, and how many faces they have together.
    Cut(Box<[CutTree; 2]>, usize),
}

/// How to cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cutting {
    /// Most faces in a piece.
    pub(super) piece: u32,
    pub(super) seed: u64,
    pub(super) cutter: Cutter,
}

/// Which algorithm finds a balanced cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Cutter {
    /// This library ([`partition`](crate::partition)).
    #[default]
    Multilevel,
    /// METIS.
    #[cfg(feature = "metis")]
    Metis,
}

/// The halves of a graph of more weight are cut on two threads.
const ALONE: u64 = 1 << 14;
/// Most faces in a cluster. Large parts are cut along clusters, which is faster than face by face.
const CLUSTER: u32 = 16;
/// Parts of at most this many faces are cut face by face.
const PART: u64 = 128;

impl CutTree {
    /// Cuts the dual graph of a mesh.
    ///
    /// A graph of clusters is cut into parts of about a hundred faces. Then faces at the borders
    /// move to the part that has most of their neighbours, and each part is cut face by face.
    ///
    /// Time O(faces · log faces).
    pub(super) fn new(graph: &Graph, cutting: &Cutting) -> Self {
        if graph.weight() <= PART {
            let all = (0..).take(graph.vertex_count()).collect();
            return cut(graph, all, cutting.piece.into(), cutting, cutting.seed);
        }

        // The upper tree, of clusters.
        let (clusters, cluster_of) = clusters(graph, cutting.seed);
        let all = (0..).take(clusters.vertex_count()).collect();
        let mut tree = cut(&clusters, all, PART, cutting, cutting.seed);

        // The part of each face: its piece of that tree, smoothed.
        let mut part_of_cluster = vec![0; clusters.vertex_count()];
        let mut parts = 0;
        tree.for_each_piece(&mut |piece| {
            for &mut cluster in &mut *piece {
                part_of_cluster[cluster as usize] = parts;
            }
            parts += 1;
        });
        let mut part_of: Vec<u32> = cluster_of
            .iter()
            .map(|&cluster| part_of_cluster[cluster as usize])
            .collect();
        smooth(graph, &mut part_of);

        // The faces of each part, and the place of each face among them.
        let mut members: Vec<Vec<u32>> = vec![Vec::new(); parts as usize];
        let mut place = Vec::with_capacity(part_of.len());
        for (face, &part) in (0..).zip(&part_of) {
            let members = &mut members[part as usize];
            place.push(index32(members.len()));
            members.push(face);
        }

        // Cut each part, and replace its piece by the tree.
        let jobs = (0..parts).zip(members).collect();
        let cut_part = |(part, faces): (u32, Vec<u32>)| {
            let number = |face: u32| (part_of[face as usize] == part).then(|| place[face as usize]);
            let graph = graph.induced(&faces, number);
            cut(
                &graph,
                faces,
                cutting.piece.into(),
                cutting,
                cutting.seed ^ u64::from(part),
            )
        };
        let mut parts = parallel::map(jobs, cut_part).into_iter();
        tree.graft(&mut parts);
        tree
    }

    /// How many faces it has.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Piece(faces) => faces.len(),
            Self::Cut(_, len) => *len,
        }
    }

    pub(super) fn for_each_face(&self, visit: &mut impl FnMut(u32)) {
        match self {
            Self::Piece(faces) => faces.iter().for_each(|&face| visit(face)),
            Self::Cut(halves, _) => halves.iter().for_each(|half| half.for_each_face(visit)),
        }
    }

    fn for_each_piece(&mut self, visit: &mut impl FnMut(&mut Vec<u32>)) {
        match self {
            Self::Piece(faces) => visit(faces),
            Self::Cut(halves, _) => halves
                .iter_mut()
                .for_each(|half| half.for_each_piece(visit)),
        }
    }

    /// Replaces each piece by the next of `trees`.
    fn graft(&mut self, trees: &mut impl Iterator<Item = Self>) {
        match self {
            Self::Piece(_) => *self = trees.next().unwrap_or(Self::Piece(Vec::new())),
            Self::Cut(halves, len) => {
                halves.iter_mut().for_each(|half| half.graft(trees));
                *len = halves.iter().map(Self::len).sum();
            }
        }
    }
}

/// A graph of clusters of up to [`CLUSTER`] vertices, and the cluster of each vertex.
fn clusters(graph: &Graph, seed: u64) -> (Graph, Vec<u32>) {
    let mut random = SplitMix64(seed);
    let mut found: Option<(Graph, Vec<u32>)> = None;
    let mut heaviest = 2;
    while heaviest <= CLUSTER {
        let coarsest = found.as_ref().map_or(graph, |(graph, _)| graph);
        let Some((coarse, group_of)) = coarser(coarsest, heaviest.into(), &mut random) else {
            break;
        };
        let cluster_of = match found {
            None => group_of,
            Some((_, finer)) => finer.iter().map(|&c| group_of[c as usize]).collect(),
        };
        found = Some((coarse, cluster_of));
        heaviest *= 2;
    }
    found.unwrap_or_else(|| (graph.clone(), (0..).take(graph.vertex_count()).collect()))
}

/// Moves vertices at a border to the part across it, if more of their neighbours are there.
fn smooth(graph: &Graph, part_of: &mut [u32]) {
    for _ in 0..2 {
        for vertex in 0..index32(part_of.len()) {
            let here = part_of[vertex as usize];
            let part = |(other, _): (u32, u32)| part_of[other as usize];
            let away = graph
                .neighbours(vertex)
                .map(part)
                .find(|&part| part != here);
            let Some(there) = away else { continue };
            let links = |to| {
                graph
                    .neighbours(vertex)
                    .map(part)
                    .filter(|&p| p == to)
                    .count()
            };
            if links(there) > links(here) {
                part_of[vertex as usize] = there;
            }
        }
    }
}

/// Cuts a graph down to pieces of at most `most` faces; `names` has the number of each vertex in
/// the whole graph, which the pieces use.
fn cut(graph: &Graph, names: Vec<u32>, most: u64, cutting: &Cutting, seed: u64) -> CutTree {
    let weight = graph.weight();
    if weight <= most || names.len() < 2 {
        return CutTree::Piece(names);
    }

    let mut side = sides(graph, cutting, seed);
    if side.iter().all(|&second| second == side[0]) {
        // One side is empty: without this fallback the recursion would not end.
        let half = side.len() / 2;
        let places = side.iter_mut().enumerate();
        places.for_each(|(i, side)| *side = i < half);
    }

    // Each half has a seed that depends on what it is, not on the thread.
    let next = |(graph, inside): (Graph, Vec<u32>)| {
        let names: Vec<u32> = inside.iter().map(|&i| names[i as usize]).collect();
        let first = u64::from(names[0]) + 1;
        let seed = seed ^ first.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        cut(&graph, names, most, cutting, seed)
    };
    let halves = graph.split(&side);
    let halves = match weight > ALONE {
        true => {
            let mut halves = parallel::map(halves.into(), next).into_iter();
            [(); 2].map(|()| halves.next().unwrap_or(CutTree::Piece(Vec::new())))
        }
        false => halves.map(next),
    };

    let len = halves.iter().map(CutTree::len).sum();
    CutTree::Cut(Box::new(halves), len)
}

/// Whether each vertex is on the second side of a cut.
fn sides(graph: &Graph, cutting: &Cutting, seed: u64) -> Vec<bool> {
    match cutting.cutter {
        Cutter::Multilevel => {
            let weight = graph.weight();
            let most = (weight * 2 / 3).max(weight.div_ceil(2));
            let asked = Bisection {
                first: weight / 2,
                most: [most; 2],
                seed,
                coarsest: COARSEST,
                tries: 2,
                passes: 1,
                patience: 6,
            };
            halves(graph, &asked)
        }
        #[cfg(feature = "metis")]
        Cutter::Metis => {
            let metis = crate::partition::Metis {
                imbalance: 1.05,
                seed,
                ..Default::default()
            };
            match metis.partition(graph) {
                Ok(parts) => parts.into_iter().map(|part| part == 1).collect(),
                // Where METIS refuses, the caller's fallback cuts.
                Err(_) => vec![false; graph.vertex_count()],
            }
        }
    }
}

/// Graphs of at most this many vertices are cut without making them coarser.
const COARSEST: usize = 2000;
