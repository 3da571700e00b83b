//! Meshes made on the spot, so that a bench needs no files.

use meshweft::Mesh;
use meshweft::order::{baselines, vertex_fetch};

/// `side` × `side` quads, each cut along a random diagonal, as a scanner might deliver them: blocks
/// of 32 × 32 quads row by row, the faces inside a block shuffled, the vertices by first use.
pub(crate) fn scanned(side: u32) -> Mesh {
    const BLOCK: u32 = 32;
    let row = side + 1;

    // Faces, block by block. The parity of a random number is a random diagonal.
    let random = baselines::random(side as usize * side as usize, 3);
    let blocks = side.div_ceil(BLOCK);
    let mut faces = Vec::new();
    for block in 0..blocks * blocks {
        let (left, top) = (block % blocks * BLOCK, block / blocks * BLOCK);
        let mut in_block = Vec::new();
        for y in top..(top + BLOCK).min(side) {
            for x in left..(left + BLOCK).min(side) {
                let at = y * row + x;
                let [a, b, c, d] = [at, at + 1, at + row, at + row + 1];
                let is_odd = random.new_to_old()[(y * side + x) as usize] % 2 == 1;
                in_block.extend(match is_odd {
                    true => [[a, b, d], [a, d, c]],
                    false => [[a, b, c], [c, b, d]],
                });
            }
        }
        let order = baselines::random(in_block.len(), u64::from(block));
        faces.extend(order.apply(&in_block));
    }

    // Vertices by first use, on gentle waves.
    let position = |vertex: u32| {
        let [x, y] = [vertex % row, vertex / row].map(|i| i as f32 / side as f32);
        [x, y, x * (1.0 - x) * y]
    };
    let positions: Vec<_> = (0..row * row).map(position).collect();
    let mesh = Mesh::new(positions, faces).expect("a grid is in range");
    let by_use = vertex_fetch(&mesh);
    mesh.with_vertex_order(&by_use)
}
