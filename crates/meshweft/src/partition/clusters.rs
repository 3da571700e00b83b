//! Small compact clusters of vertices: the first step to a coarser graph, cheaper than pairing.

use std::collections::VecDeque;

use super::graph::Graph;
use super::links::Links;
use crate::index::index32;

/// A cluster with less than this share of the vertices that it may have joins one next to it.
const SCRAP: usize = 4;

/// A vertex that is in no cluster (yet).
const NONE: u32 = u32::MAX;

/// The graph whose vertices are clusters of up to `most` vertices, with scraps up to twice as many,
/// and the cluster of each vertex; `u32::MAX` for vertices on no face.
///
/// A cluster is grown breadth first, the next one from a vertex beside those that are finished.
/// Small pieces of the mesh that are not connected share clusters.
///
/// Time and space O(vertices + faces).
pub(super) fn clustered(links: &Links<'_>, most: usize) -> (Graph, Vec<u32>) {
    let mut growth = GrowingClusters {
        links,
        most,
        cluster_of: vec![NONE; links.vertex_count()],
        sizes: Vec::new(),
        members: Vec::new(),
        beside: VecDeque::new(),
        is_beside: vec![false; links.vertex_count()],
    };
    growth.grow_all();
    let GrowingClusters {
        cluster_of, sizes, ..
    } = growth;

    let ends = links
        .edges()
        .map(|ends| ends.map(|v| cluster_of[v as usize]));
    let between = ends.filter(|[a, b]| a != b).map(|[a, b]| (a, b, 1));
    let mut graph = Graph::from_edges(sizes.len(), &between.collect::<Vec<_>>());
    graph.weights = sizes;
    (graph, cluster_of)
}

/// Clusters that are being grown.
struct GrowingClusters<'a> {
    links: &'a Links<'a>,
    most: usize,
    cluster_of: Vec<u32>,
    sizes: Vec<u32>,
    /// The vertices of the cluster that is being grown.
    members: Vec<u32>,
    /// Vertices beside clusters, where the next ones start.
    beside: VecDeque<u32>,
    is_beside: Vec<bool>,
}

impl GrowingClusters<'_> {
    /// Puts each vertex that is used into a cluster.
    fn grow_all(&mut self) {
        let mut unseen = 0..index32(self.cluster_of.len());
        loop {
            // Beside a cluster, else in another piece of the mesh.
            let is_free = |v: u32| self.cluster_of[v as usize] == NONE && self.links.is_used(v);
            let beside = std::iter::from_fn(|| self.beside.pop_front()).find(|&v| is_free(v));
            let Some(start) = beside.or_else(|| unseen.find(|&v| is_free(v))) else {
                break;
            };

            // A cluster of whole pieces takes more of them until it is full.
            let is_enclosed = self.grow(start);
            if self.members.len() >= self.most || is_enclosed {
                self.finish(is_enclosed);
            }
        }
        self.finish(false);
    }

    /// Grows the current cluster from a vertex; returns whether it touches other clusters.
    fn grow(&mut self, start: u32) -> bool {
        let cluster = index32(self.sizes.len());
        let mut is_enclosed = false;
        let mut next = self.members.len();
        self.cluster_of[start as usize] = cluster;
        self.members.push(start);

        while let Some(&vertex) = self.members.get(next) {
            next += 1;
            for other in self.links.corners(vertex) {
                let cluster_of = &mut self.cluster_of[other as usize];
                if *cluster_of != NONE {
                    is_enclosed |= *cluster_of != cluster;
                } else if self.members.len() < self.most {
                    *cluster_of = cluster;
                    self.members.push(other);
                } else if !std::mem::replace(&mut self.is_beside[other as usize], true) {
                    self.beside.push_back(other);
                }
            }
        }
        is_enclosed
    }

    /// Ends the current cluster, if it has vertices; a scrap joins one that it touches.
    fn finish(&mut self, is_enclosed: bool) {
        let size = self.members.len();
        if size == 0 {
            return;
        }
        let host = match is_enclosed && size * SCRAP < self.most {
            true => self.host(),
            false => None,
        };
        match host {
            Some(host) => {
                for &vertex in &self.members {
                    self.cluster_of[vertex as usize] = host;
                }
                self.sizes[host as usize] += index32(size);
            }
            None => self.sizes.push(index32(size)),
        }
        self.members.clear();
    }

    /// The cluster with most edges to the members that has room for them.
    fn host(&self) -> Option<u32> {
        let cluster = index32(self.sizes.len());
        let mut edges: Vec<(u32, usize)> = Vec::new();
        for &vertex in &self.members {
            for other in self.links.others(vertex) {
                let beside = self.cluster_of[other as usize];
                match edges.iter().position(|&(known, _)| known == beside) {
                    Some(i) => edges[i].1 += 1,
                    None if beside != cluster && edges.len() < self.most => edges.push((beside, 1)),
                    None => {}
                }
            }
        }
        let has_room = |&&(host, _): &&(u32, usize)| {
            self.sizes[host as usize] as usize + self.members.len() <= 2 * self.most
        };
        let best = edges.iter().filter(has_room);
        best.max_by_key(|&&(host, count)| (count, u32::MAX - host))
            .map(|&(host, _)| host)
    }
}
