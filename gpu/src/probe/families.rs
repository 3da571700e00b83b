//! The draws that a card is asked.

use crate::draw::{Draw, RESTART, Topology};
use crate::random::Random;

/// A draw with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// What it is.
    pub name: String,
    indices: Vec<u32>,
    topology: Topology,
    short: bool,
    vertex_offset: i32,
    instances: u32,
}

impl Probe {
    fn new(name: impl Into<String>, indices: Vec<u32>) -> Self {
        Self {
            name: name.into(),
            indices,
            topology: Topology::TriangleList,
            short: false,
            vertex_offset: 0,
            instances: 1,
        }
    }

    /// The draw.
    #[must_use]
    pub fn draw(&self) -> Draw<'_> {
        Draw {
            topology: self.topology,
            restart: self.topology == Topology::TriangleStrip,
            short: self.short,
            vertex_offset: self.vertex_offset,
            instances: self.instances,
            ..Draw::list(&self.indices)
        }
    }
}

/// All probes whose indices a card draws that draws up to `largest`.
#[must_use]
pub(super) fn all(largest: u32) -> Vec<Probe> {
    let mut probes = Vec::new();
    limits(&mut probes);
    strips_and_fans(&mut probes);
    returns(&mut probes);
    windows(&mut probes);
    degenerate(&mut probes);
    numbers(&mut probes);
    draws(&mut probes);
    probes.retain(|probe| {
        let top = probe
            .indices
            .iter()
            .filter(|&&index| index != RESTART)
            .max();
        let top = i64::from(top.copied().unwrap_or(0));
        top + i64::from(probe.vertex_offset.max(0)) <= i64::from(largest)
    });
    probes
}

/// How many faces and how many vertices end a batch.
fn limits(probes: &mut Vec<Probe>) {
    for faces in (1..=100).chain([127, 128, 129, 255, 256, 257]) {
        probes.push(Probe::new(
            format!("repeated {faces}"),
            [0, 1, 2].repeat(faces),
        ));
    }
    for faces in (1..=50_u32).chain([85, 86, 100, 128]) {
        probes.push(Probe::new(
            format!("all new {faces}"),
            (0..3 * faces).collect(),
        ));
    }
    // So many faces with one new vertex each, then all new: the limit is met at every remainder.
    for sharing in 1..=34 {
        let mut indices: Vec<u32> = (0..sharing).flat_map(|i| [i, i + 1, i + 2]).collect();
        indices.extend(100..100 + 3 * 20);
        probes.push(Probe::new(
            format!("strip of {sharing}, then all new"),
            indices,
        ));
    }
    for vertices in 3..=64 {
        let indices = (0..300).map(|i| i % vertices).collect();
        probes.push(Probe::new(format!("cycle of {vertices}"), indices));
    }
}

fn strips_and_fans(probes: &mut Vec<Probe>) {
    for faces in [1, 2, 15, 29, 30, 31, 32, 33, 60, 100, 400] {
        let list = (0..faces).flat_map(|i| [i, i + 1, i + 2]).collect();
        probes.push(Probe::new(format!("strip as list {faces}"), list));
        let list = (0..faces).flat_map(|i| [0, i + 1, i + 2]).collect();
        probes.push(Probe::new(format!("fan as list {faces}"), list));
        for (name, topology) in [
            ("strip", Topology::TriangleStrip),
            ("fan", Topology::TriangleFan),
        ] {
            probes.push(Probe {
                topology,
                ..Probe::new(format!("{name} {faces}"), (0..faces + 2).collect())
            });
        }
    }

    // Strips that are cut, some too short for a face.
    for piece in 1..=40_u32 {
        let mut indices = Vec::new();
        for start in 0..8 {
            indices.extend((0..piece).map(|i| 4 * start + i));
            indices.push(RESTART);
        }
        probes.push(Probe {
            topology: Topology::TriangleStrip,
            ..Probe::new(format!("strips of {piece}"), indices)
        });
    }
}

/// A vertex comes back after so many corners, of few vertices and of new ones.
fn returns(probes: &mut Vec<Probe>) {
    for between in 1..=72 {
        for before in 0..3 {
            let mut indices = vec![9; before];
            indices.push(0);
            indices.extend([1, 2, 3, 4].iter().cycle().take(between));
            indices.push(0);
            indices.resize(indices.len().next_multiple_of(3), 9);
            let name = format!("return after {between} corners at {before}");
            probes.push(Probe::new(name, indices));
        }
    }
    for new in 1..=30 {
        let mut indices = vec![0, 50, 51];
        indices.extend((1..=new).flat_map(|i| [i, i, i]));
        indices.extend([0, 50, 51]);
        probes.push(Probe::new(format!("return after {new} new"), indices));
    }
}

/// Random corners from a window that moves on.
fn window(faces: u32, width: u32, faces_a_step: u32, seed: u64) -> Vec<u32> {
    let mut random = Random::new(seed);
    (0..3 * faces)
        .map(|corner| corner / 3 / faces_a_step + random.below(width))
        .collect()
}

fn windows(probes: &mut Vec<Probe>) {
    for width in [4, 6, 8, 12, 16, 20, 24, 28, 32, 40, 48, 64, 96] {
        for faces_a_step in [1, 2, 3] {
            for seed in 0..4 {
                let name = format!("window {width} moving every {faces_a_step}, {seed}");
                probes.push(Probe::new(name, window(200, width, faces_a_step, seed)));
            }
        }
    }
}

/// Faces that name a vertex twice.
fn degenerate(probes: &mut Vec<Probe>) {
    let shapes = [[0, 0, 1], [0, 1, 0], [1, 0, 0], [0, 0, 0]];
    for (number, shape) in shapes.iter().enumerate() {
        for faces in [1, 10, 16, 17, 31, 32, 33, 50] {
            let indices = (0..faces)
                .flat_map(|i| shape.map(|corner| 2 * i + corner))
                .collect();
            probes.push(Probe::new(format!("degenerate {number}, {faces}"), indices));
        }
    }
    for width in [2, 3, 4, 5] {
        for seed in 10..20 {
            let name = format!("degenerate window {width}, {seed}");
            probes.push(Probe::new(name, window(200, width, 1, seed)));
        }
    }
}

/// Large vertex numbers, and where the high bits change.
fn numbers(probes: &mut Vec<Probe>) {
    // A window across a border, and two windows.
    for bits in 8..=24 {
        for seed in 20..24 {
            let start = (1 << bits) - 50;
            let indices = window(150, 20, 2, seed).iter().map(|i| i + start).collect();
            probes.push(Probe::new(format!("across 2^{bits}, {seed}"), indices));
        }
        // Two windows far apart, in turn.
        let apart = window(150, 10, 3, 30);
        let indices = (0..)
            .zip(&apart)
            .map(|(at, i)| i + ((at / 3 % 2) << bits))
            .collect();
        probes.push(Probe::new(format!("2^{bits} apart, face by face"), indices));
        let indices = (0..)
            .zip(&apart)
            .map(|(at, i)| i + ((at % 2) << bits))
            .collect();
        probes.push(Probe::new(
            format!("2^{bits} apart, corner by corner"),
            indices,
        ));
    }

    // Bits that are not used.
    for shift in 0..=22 {
        let indices = window(150, 16, 2, 40).iter().map(|i| i << shift).collect();
        probes.push(Probe::new(format!("times 2^{shift}"), indices));
    }

    // Random numbers that come back.
    for bits in [16, 20, 24, 31] {
        for seed in 50..54 {
            let mut random = Random::new(seed);
            let pool: Vec<u32> = (0..100).map(|_| random.bits() >> (32 - bits)).collect();
            let indices = window(200, 12, 3, seed)
                .iter()
                .map(|&i| pool[i as usize])
                .collect();
            probes.push(Probe::new(
                format!("random of {bits} bits, {seed}"),
                indices,
            ));
        }
    }
}

/// Index width, vertex offset, instances.
fn draws(probes: &mut Vec<Probe>) {
    // Offsets of few and of many vertices.
    for (number, offset) in [
        1,
        1000,
        65_486,
        65_516,
        65_536,
        131_022,
        1 << 20,
        (1 << 24) - 300,
    ]
    .iter()
    .enumerate()
    {
        for short in [false, true] {
            let width = if short { 16 } else { 32 };
            let seed = 60 + number as u64;
            probes.push(Probe {
                vertex_offset: *offset,
                short,
                ..Probe::new(
                    format!("offset {offset}, {width} bits"),
                    window(150, 20, 2, seed),
                )
            });
        }
    }

    // Offsets that add up to a border, or lead away from it.
    let indices: Vec<u32> = window(150, 20, 2, 70).iter().map(|i| i + 65_400).collect();
    for offset in [-65_400, -1000, -64, 0, 64] {
        probes.push(Probe {
            vertex_offset: offset,
            ..Probe::new(format!("near 65,536, offset {offset}"), indices.clone())
        });
    }

    // Instances, whose last batch another one may go on with.
    for instances in [2, 3, 5, 8, 33] {
        for faces in [1, 5, 10, 11, 32, 33, 50] {
            probes.push(Probe {
                instances,
                ..Probe::new(
                    format!("{instances} instances of {faces}"),
                    window(faces, 12, 2, u64::from(faces)),
                )
            });
        }
    }
}
