//! Faces of any kind, for tests.

use crate::index::index32;
use crate::random::SplitMix64;

/// Faces of any kind: parts of surfaces, flipped, repeated, with a vertex twice, many at one edge or vertex.
pub(crate) fn soup(random: &mut SplitMix64) -> (Vec<[u32; 3]>, usize) {
    let vertex_count = 1 + random.below(30);
    let mut faces: Vec<[u32; 3]> = Vec::new();
    if random.below(3) > 0 {
        // A piece of a grid, perhaps closed to a torus.
        let (width, height) = (3 + index32(random.below(4)), 3 + index32(random.below(4)));
        let closes = random.below(2) == 0;
        let vertex = |x: u32, y: u32| (y % height) * width + x % width;
        for y in 0..height - u32::from(!closes) {
            for x in 0..width - u32::from(!closes) {
                let [a, b] = [vertex(x, y), vertex(x + 1, y)];
                let [c, d] = [vertex(x + 1, y + 1), vertex(x, y + 1)];
                faces.extend([[a, b, c], [a, c, d]]);
            }
        }
        for _ in 0..random.below(6) {
            faces.swap_remove(random.below(faces.len()));
        }
    }
    for _ in 0..random.below(24) {
        let any = |random: &mut SplitMix64| index32(random.below(vertex_count));
        let face = match (random.below(8), faces.last()) {
            (0, Some(&face)) => face,
            (1, Some(&[a, b, c])) => [a, c, b],
            (2..5, Some(&[a, b, _])) => [b, a, any(random)],
            (5, Some(&[a, b, _])) => [a, b, any(random)],
            _ => [any(random), any(random), any(random)],
        };
        faces.push(face);
    }

    // Any numbers, in any order.
    let most = faces.as_flattened().iter().copied().max().unwrap_or(0);
    let count = most as usize + 1 + random.below(4);
    let numbers = crate::random::shuffled(count, random.next());
    let mut faces: Vec<[u32; 3]> = crate::random::shuffled(faces.len(), random.next())
        .into_iter()
        .map(|face| faces[face as usize].map(|vertex| numbers[vertex as usize]))
        .collect();
    faces
        .iter_mut()
        .for_each(|face| face.rotate_left(random.below(3)));
    (faces, count)
}
