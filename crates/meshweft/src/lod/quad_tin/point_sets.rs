//! Sets of points as they are surveyed, drawn and made up, for tests.

use std::f64::consts::TAU;

use crate::index::index32;
use crate::random::SplitMix64;

/// Numbers are multiples of 1/8192 that double, and sums of whose products 128 bits, hold exactly; so are all places between them.
pub(crate) const UNIT: f64 = 1.0 / 8192.0;
/// The corner and the side of the square that points are in.
const ORIGIN: f64 = 4096.0;
const SIDE: f64 = 4000.0;

/// A point at two fractions of the square, on hills.
fn point(u: f64, v: f64) -> [f32; 3] {
    let hills = (9.0 * u).sin() * (7.0 * v).cos() + 0.3 * (31.0 * u + 17.0 * v).sin();
    let height = 1500.0 + 300.0 * hills;
    // An f32 from 4,096 to 8,192 is a multiple of 1/2048, one from 1,024 to 2,048 of 1/8192.
    [ORIGIN + SIDE * u, height, ORIGIN + SIDE * v].map(single)
}

#[expect(clippy::cast_possible_truncation, reason = "rounded to the nearest")]
fn single(number: f64) -> f32 {
    number as f32
}

fn fraction(random: &mut SplitMix64) -> f64 {
    random.below(1 << 30) as f64 / (1 << 30) as f64
}

fn side_of(count: usize) -> usize {
    count.isqrt()
}

pub(crate) fn jittered(count: usize, random: &mut SplitMix64) -> Vec<[f32; 3]> {
    let side = side_of(count);
    let at = |i: usize, by: f64| (i as f64 + 0.2 + 0.6 * by) / side as f64;
    let places = (0..side * side).map(|i| {
        let [u, v] = [fraction(random), fraction(random)];
        point(at(i % side, u), at(i / side, v))
    });
    places.collect()
}

pub(crate) fn scattered(count: usize, random: &mut SplitMix64) -> Vec<[f32; 3]> {
    let places = (0..count).map(|_| point(fraction(random), fraction(random)));
    places.collect()
}

/// 50 clusters of different widths, each denser in its middle.
pub(crate) fn clusters(count: usize, random: &mut SplitMix64) -> Vec<[f32; 3]> {
    let middles: Vec<[f64; 3]> = (0..50)
        .map(|_| {
            let [u, v, width] = [fraction(random), fraction(random), fraction(random)];
            [0.1 + 0.8 * u, 0.1 + 0.8 * v, 0.002 + 0.03 * width]
        })
        .collect();
    let places = (0..count).map(|_| {
        let [u, v, width] = middles[random.below(50)];
        let [angle, away] = [TAU * fraction(random), fraction(random)];
        let away = 2.5 * width * away;
        point(u + away * angle.cos(), v + away * angle.sin())
    });
    places.collect()
}

/// Lines as a scanner flies them: points are ten times as close along a line as lines are.
pub(crate) fn scan_lines(count: usize, random: &mut SplitMix64) -> Vec<[f32; 3]> {
    let lines = side_of(count / 10).max(2);
    let along = count / lines;
    let places = (0..lines * along).map(|i| {
        let [u, v] = [fraction(random), fraction(random)];
        let across = (i / along) as f64 + 0.05 * v;
        point(
            ((i % along) as f64 + u) / along as f64,
            across / lines as f64,
        )
    });
    places.collect()
}

/// Lines of equal height around a hill, with points ten times as close as lines are.
pub(crate) fn contours(count: usize, _: &mut SplitMix64) -> Vec<[f32; 3]> {
    // Around a circle of radius n there are 2π n times ten points.
    let lines = (count / 31).isqrt() + 1;
    let mut points = Vec::new();
    for line in 1..=lines {
        let around = 63 * line;
        for i in 0..around {
            let angle = TAU * i as f64 / around as f64;
            let away = 0.45 * line as f64 / lines as f64 * (1.0 + 0.08 * (5.0 * angle).sin());
            let [x, _, z] = point(0.5 + away * angle.cos(), 0.5 + away * angle.sin());
            points.push([x, 2000.0 - 900.0 * line as f32 / lines as f32, z]);
        }
    }
    points
}

pub(crate) fn circle(count: usize, random: &mut SplitMix64) -> Vec<[f32; 3]> {
    let places = (0..count).map(|i| {
        let angle = TAU * i as f64 / count as f64;
        let [x, _, z] = point(0.5 + 0.5 * angle.cos(), 0.5 + 0.5 * angle.sin());
        [x, 1100.0 + random.below(800) as f32, z]
    });
    places.collect()
}

/// Every point once more, and each third one with another height.
pub(crate) fn repeated(count: usize, random: &mut SplitMix64) -> Vec<[f32; 3]> {
    let mut points = scattered(count / 2, random);
    for i in 0..points.len() {
        let [x, y, z] = points[i];
        points.push([x, if i % 3 == 0 { y + 1.0 } else { y }, z]);
    }
    points
}

/// Half of the points in a thousandth of the square's side.
pub(crate) fn two_scales(count: usize, random: &mut SplitMix64) -> Vec<[f32; 3]> {
    let mut points = scattered(count / 2, random);
    let places = (0..count / 2).map(|_| {
        let [u, v] = [fraction(random), fraction(random)];
        point(0.3 + 0.001 * u, 0.6 + 0.001 * v)
    });
    points.extend(places);
    points
}

/// On the four sides and the two diagonals of the square only.
pub(crate) fn on_lines(count: usize, random: &mut SplitMix64) -> Vec<[f32; 3]> {
    let places = (0..count).map(|i| {
        // A multiple of what both axes are multiples of.
        let along = random.below(1 << 22) as f64 / (1 << 22) as f64;
        let [u, v] = match i % 6 {
            0 => [0.0, along],
            1 => [1.0, along],
            2 => [along, 0.0],
            3 => [along, 1.0],
            4 => [along, along],
            _ => [along, 1.0 - along],
        };
        point(u, v)
    });
    places.collect()
}

/// A grid with this number of points a side, row by row.
pub(crate) fn grid(side: usize) -> Vec<[f32; 3]> {
    let at = |i: usize| i as f64 / (side - 1) as f64;
    let places = (0..side * side).map(|i| {
        let [_, height, _] = point(at(i % side), at(i / side));
        let [column, row] = [index32(i % side), index32(i / side)];
        [4096.0 + column as f32, height, 4096.0 + row as f32]
    });
    places.collect()
}

/// Makes a number of points.
pub(crate) type MakePoints = fn(usize, &mut SplitMix64) -> Vec<[f32; 3]>;

/// Every kind of set in which places between points are exact.
pub(crate) const SETS: [(&str, MakePoints); 10] = [
    ("jittered grid", jittered),
    ("scattered", scattered),
    ("clusters", clusters),
    ("scan lines", scan_lines),
    ("contours", contours),
    ("circle", circle),
    ("repeated", repeated),
    ("two scales", two_scales),
    ("on lines", on_lines),
    ("full grid", |count, _| grid(side_of(count))),
];

/// Sets with which an `f32` is at its end.
pub(crate) const DIFFICULT_SETS: [(&str, MakePoints); 3] =
    [("spiral", spiral), ("burst", burst), ("ladder", ladder)];

/// Towards a point, by a factor of 10^30 for 650 points.
fn spiral(count: usize, _: &mut SplitMix64) -> Vec<[f32; 3]> {
    let place = |i: u32| {
        let [angle, away] = [0.3 * f64::from(i), 0.9_f64.powf(f64::from(i))];
        [away * angle.cos(), away, away * angle.sin()].map(single)
    };
    (0..index32(count)).map(place).collect()
}

/// A few numbers around one point.
fn burst(count: usize, random: &mut SplitMix64) -> Vec<[f32; 3]> {
    let mut place = || {
        let [x, y, z] = [0, 1, 2].map(|_| random.below(16) as f32);
        [1e6 + x / 16.0, y, -2e6 - z / 8.0]
    };
    (0..count).map(|_| place()).collect()
}

/// Two lines that are a number apart.
fn ladder(count: usize, _: &mut SplitMix64) -> Vec<[f32; 3]> {
    let place = |i: usize| {
        let z = if i.is_multiple_of(2) { 1e7 } else { 1e7 + 1.0 };
        [i as f32, (i % 7) as f32, z]
    };
    (0..count).map(place).collect()
}
