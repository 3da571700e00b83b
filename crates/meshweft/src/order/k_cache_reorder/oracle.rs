//! The fast mode compared with its definition, which is computed by brute force.

use super::KCacheReorder;
use super::fast_fifo::{MAX_TENTATIVE, candidate_count};
use crate::cache::CacheModel;
use crate::index::index32;
use crate::mesh::Mesh;
use crate::order::baselines::random;
use crate::order::greedy::Costs;

/// A FIFO cache as a list, the oldest first.
#[derive(Clone)]
struct Buffer {
    size: usize,
    held: Vec<u32>,
    pushes: u32,
    /// Vertices that left, with the number of the push that made them leave.
    left: Vec<(u32, u32)>,
}

impl Buffer {
    fn push(&mut self, vertex: u32) {
        self.pushes += 1;
        self.held.push(vertex);
        if self.held.len() > self.size {
            self.left.push((self.pushes, self.held.remove(0)));
        }
    }

    /// Draws a face as hardware does after its corners are turned so that hits come first.
    fn draw(&mut self, corners: [u32; 3], keep_corners: bool) -> u8 {
        let there = corners.map(|v| self.held.contains(&v));
        let hits_first = |&r: &usize| {
            let turned = [0, 1, 2].map(|i| there[(i + r) % 3]);
            turned.is_sorted_by_key(|&hit| !hit)
        };
        let all_same = there == [there[0]; 3];
        let rotation = match keep_corners || all_same {
            true => 0,
            false => (0..3).find(hits_first).expect("two hits are neighbours"),
        };
        for i in 0..3 {
            let vertex = corners[(i + rotation) % 3];
            if !self.held.contains(&vertex) {
                self.push(vertex);
            }
        }
        u8::try_from(rotation).expect("below 3")
    }
}

/// The order and rotations that the definition of the fast mode gives.
fn by_definition(mesh: &Mesh, algorithm: &KCacheReorder) -> (Vec<u32>, Vec<u8>) {
    let each: Vec<u32> = (0..=index32(mesh.face_count())).collect();
    of_polygons(mesh, &each, algorithm)
}

/// As [`by_definition`], with faces `starts[i]..starts[i + 1]` drawn together.
fn of_polygons(mesh: &Mesh, starts: &[u32], algorithm: &KCacheReorder) -> (Vec<u32>, Vec<u8>) {
    let size = algorithm.cache.size();
    let costs = Costs::new(algorithm.k1, algorithm.k2, algorithm.k3, size);
    let faces = mesh.faces();
    let mut drawn = vec![false; faces.len()];
    let mut buffer = Buffer {
        size: size as usize,
        held: Vec::new(),
        pushes: 0,
        left: Vec::new(),
    };
    let (mut order, mut rotations) = (Vec::new(), Vec::new());
    let mut next = algorithm.first_focus;

    loop {
        let live_faces = |v: u32| -> Vec<usize> {
            let all = 0..faces.len();
            all.filter(|&f| !drawn[f] && faces[f].contains(&v))
                .collect()
        };
        let live = |v: u32| index32(live_faces(v).len());

        // What drawing `v` draws: its live faces and those of their polygons, each once.
        let to_draw = |v: u32| -> Vec<usize> {
            let polygon = |&f: &usize| starts.partition_point(|&start| start as usize <= f) - 1;
            let mut polygons: Vec<usize> = live_faces(v).iter().map(polygon).collect();
            polygons.dedup();
            let faces = |&p: &usize| starts[p] as usize..starts[p + 1] as usize;
            polygons.iter().flat_map(faces).collect()
        };

        // The exact cost, on a copy of the cache.
        let cost = |v: u32| {
            let mut run = buffer.clone();
            for face in to_draw(v) {
                run.draw(faces[face], algorithm.keep_corners);
            }
            // The age may pass the size: count it from the last push of `v`.
            let after = run.held.iter().rev().position(|&h| h == v);
            let left = run.left.iter().rev().find(|l| l.1 == v);
            let age = match (after, left) {
                (Some(after), _) => index32(after) + 1,
                (None, Some(left)) => run.pushes - left.0 + size + 1,
                (None, None) => unreachable!("a candidate is in the cache"),
            };
            costs.after_run(run.pushes - buffer.pushes, live(v), age)
        };

        let candidates = buffer.held.iter().copied().filter(|&v| live(v) > 0);
        let candidates = candidates.take(candidate_count(size));

        // The lower bound, from a plain count of white corners.
        let estimate = |v: u32| {
            let corners = live_faces(v).into_iter().flat_map(|f| faces[f]);
            let white = index32(corners.filter(|c| !buffer.held.contains(c)).count());
            let age = buffer.held.iter().rev().position(|&h| h == v);
            let neighbours = white.div_ceil(2).max((white + 1).saturating_sub(live(v)));
            costs.of(neighbours, live(v), index32(age.unwrap_or(0)) + 1)
        };

        // Candidates by estimate, until an exact cost is at most the next estimate.
        let mut by_estimate: Vec<(i64, usize, u32)> = candidates
            .enumerate()
            .map(|(place, v)| (estimate(v), place, v))
            .collect();
        by_estimate.sort_unstable();
        let mut cheapest: Option<(i64, usize, u32)> = None;
        for &(estimate, place, v) in by_estimate.iter().take(MAX_TENTATIVE as usize) {
            if cheapest.is_none_or(|c| (estimate, place) < (c.0, c.1)) {
                // An estimate is a lower bound on a surface; elsewhere it may be above the cost.
                let run = (cost(v).max(estimate), place, v);
                cheapest = cheapest.min(Some(run)).or(Some(run));
            }
        }
        let cheapest = cheapest.map(|c| c.2);

        // Dead ends, then the end.
        let unfinished = buffer.left.iter().rev().filter(|l| live(l.1) > 0);
        let stranded = unfinished.min_by_key(|l| live(l.1).min(8)).map(|l| l.1);
        let untouched = (0..index32(mesh.vertex_count())).find(|&v| live(v) > 0);
        let focus = next.take().or(cheapest).or(stranded).or(untouched);
        let Some(focus) = focus else {
            return (order, rotations);
        };

        for face in to_draw(focus) {
            drawn[face] = true;
            order.push(index32(face));
            rotations.push(buffer.draw(faces[face], algorithm.keep_corners));
        }
    }
}

/// A grid of quads with random diagonals, closed to a torus or open, all numbers shuffled.
fn grid(width: u32, height: u32, closed: bool, seed: u64) -> Mesh {
    let quads = if closed {
        (width, height)
    } else {
        (width - 1, height - 1)
    };
    let vertices = random((width * height) as usize, seed);
    let diagonals = random((width * height) as usize, seed + 1);
    let vertex =
        |x: u32, y: u32| vertices.new_to_old()[((y % height) * width + x % width) as usize];
    let mut faces = Vec::new();
    for y in 0..quads.1 {
        for x in 0..quads.0 {
            let [a, b] = [vertex(x, y), vertex(x + 1, y)];
            let [c, d] = [vertex(x, y + 1), vertex(x + 1, y + 1)];
            match diagonals.new_to_old()[(y * width + x) as usize] % 2 {
                0 => faces.extend([[a, b, c], [c, b, d]]),
                _ => faces.extend([[a, b, d], [a, d, c]]),
            }
        }
    }
    let faces = random(faces.len(), seed + 2).apply(&faces);
    Mesh::connectivity_only((width * height) as usize, faces).unwrap()
}

#[test]
fn the_fast_mode_is_the_greedy_that_it_claims_to_be() {
    for (round, size) in [3, 4, 5, 7, 10, 12, 16, 24, 32, 64].into_iter().enumerate() {
        for closed in [false, true] {
            for keep_corners in [false, true] {
                let mesh = grid(9, 8, closed, round as u64);
                let algorithm = KCacheReorder {
                    cache: CacheModel::fifo(size),
                    keep_corners,
                    ..Default::default()
                };
                let order = algorithm.face_order(&mesh);
                let (faces, rotations) = by_definition(&mesh, &algorithm);
                assert_eq!(order.new_to_old(), faces, "{algorithm:?}, closed: {closed}");
                assert_eq!(order.rotations(), rotations, "{algorithm:?}");
            }
        }
    }
}

#[test]
fn polygons_are_ordered_by_the_same_rules() {
    for (seed, size) in [3, 4, 6, 8, 12, 16, 32].into_iter().enumerate() {
        // Quads, some joined to strips of more, a few single faces.
        let (width, height) = (9, 8);
        let numbers = random(width * height, seed as u64);
        let vertex = |x: usize, y: usize| numbers.new_to_old()[y * width + x];
        let mut polygons = Vec::new();
        for i in 0..(width - 1) * (height - 1) {
            let (x, y) = (i % (width - 1), i / (width - 1));
            let [a, b] = [vertex(x, y), vertex(x + 1, y)];
            let [c, d] = [vertex(x, y + 1), vertex(x + 1, y + 1)];
            match (i + seed) % 7 {
                0 => polygons.extend([vec![[a, b, d]], vec![[a, d, c]]]),
                1 if x + 2 < width => {
                    let e = vertex(x + 2, y);
                    polygons.push(vec![[a, b, e], [a, e, d], [a, d, c]]);
                }
                _ => polygons.push(vec![[a, b, d], [a, d, c]]),
            }
        }

        // Shuffled, as flat faces and where each polygon starts.
        let shuffled = random(polygons.len(), seed as u64 + 9);
        let polygons: Vec<_> = shuffled
            .new_to_old()
            .iter()
            .map(|&p| &polygons[p as usize])
            .collect();
        let mut starts = vec![0];
        for polygon in &polygons {
            starts.push(starts[starts.len() - 1] + index32(polygon.len()));
        }
        let faces: Vec<_> = polygons.into_iter().flatten().copied().collect();
        let mesh = Mesh::connectivity_only(width * height, faces).unwrap();

        // The fast FIFO mode follows the definition.
        let algorithm = KCacheReorder {
            cache: CacheModel::fifo(size),
            keep_corners: true,
            ..Default::default()
        };
        let order = algorithm.polygon_order(&mesh, &starts);
        let (faces, rotations) = of_polygons(&mesh, &starts, &algorithm);
        assert_eq!(order.new_to_old(), faces, "size {size}");
        assert!(rotations.iter().all(|&r| r == 0) && order.rotations().iter().all(|&r| r == 0));

        // The other modes keep polygons together.
        for other in [CacheModel::controllable(size), CacheModel::fifo(size)] {
            let algorithm = KCacheReorder {
                cache: other,
                mode: super::Mode::Faithful,
                ..Default::default()
            };
            let order = algorithm.polygon_order(&mesh, &starts);
            let polygon = |face: &u32| starts.partition_point(|start| start <= face);
            let runs = order
                .new_to_old()
                .chunk_by(|a, b| a + 1 == *b && polygon(a) == polygon(b));
            assert_eq!(runs.count(), starts.len() - 1, "polygons stay together");
        }
    }
}

#[test]
fn what_is_no_surface_is_ordered_by_the_same_rules() {
    for (seed, vertices) in [6, 12, 25, 60].into_iter().enumerate() {
        let corners = random(180, seed as u64);
        let corner = |i: usize| corners.new_to_old()[i] % vertices;
        let faces: Vec<_> = (0..60)
            .map(|f| [corner(3 * f), corner(3 * f + 1), corner(3 * f + 2)])
            .filter(|&[a, b, c]| a != b && b != c && c != a)
            .collect();
        let mesh = Mesh::connectivity_only(vertices as usize, faces).unwrap();
        for size in [3, 6, 12] {
            let algorithm = KCacheReorder {
                cache: CacheModel::fifo(size),
                ..Default::default()
            };
            let order = algorithm.face_order(&mesh);
            assert_eq!(order.new_to_old(), by_definition(&mesh, &algorithm).0);
        }
    }
}

#[test]
fn weights_and_first_focus_are_obeyed() {
    for (seed, (k1, k2, k3)) in [(1.0, 0.0, 0.0), (2.0, 0.7, 0.3), (0.7, 1.5, 1.3)]
        .into_iter()
        .enumerate()
    {
        let mesh = grid(8, 8, true, seed as u64);
        let algorithm = KCacheReorder {
            cache: CacheModel::fifo(8),
            first_focus: Some(17),
            k1,
            k2,
            k3,
            ..Default::default()
        };
        let order = algorithm.face_order(&mesh);
        assert_eq!(order.new_to_old(), by_definition(&mesh, &algorithm).0);
        assert!(mesh.faces()[order.new_to_old()[0] as usize].contains(&17));
    }
}

#[test]
fn a_cache_larger_than_the_mesh_is_no_different() {
    let mesh = grid(9, 9, true, 5);
    for cache in [CacheModel::fifo, CacheModel::controllable] {
        for mode in [super::Mode::Fast, super::Mode::Faithful] {
            let algorithm = KCacheReorder {
                cache: cache(u32::MAX),
                mode,
                ..Default::default()
            };
            let ordered = mesh.with_face_order(&algorithm.face_order(&mesh));
            assert_eq!(crate::cache::misses(ordered.faces(), cache(81)), 81);
        }
    }
}
