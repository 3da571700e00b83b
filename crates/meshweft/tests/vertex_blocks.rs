//! Meshes of more than 65,536 vertices: numbered in blocks, ordered block by block.

use meshweft::cache::nvidia;
use meshweft::order::{Effort, Optimizer, Target, baselines, vertex_blocks, vertex_fetch};
use meshweft::{FaceOrder, Faces, Mesh, Permutation, VertexOrder};

const SIDE: u32 = 370;

/// A grid of squares with more than two blocks of vertices, all shuffled.
fn grid() -> Mesh {
    let square = |i: u32| {
        let corner = i / SIDE * (SIDE + 1) + i % SIDE;
        let above = corner + SIDE + 1;
        [[corner, corner + 1, above], [corner + 1, above + 1, above]]
    };
    let faces: Vec<_> = (0..SIDE * SIDE).flat_map(square).collect();
    let faces = baselines::random(faces.len(), 1).apply(&faces);
    let vertex_count = (SIDE as usize + 1).pow(2);
    let vertices = VertexOrder::from(Permutation::random(vertex_count, 2));
    Mesh::connectivity_only(vertex_count, vertices.renumber(&faces)).unwrap()
}

fn in_blocks(mesh: &Mesh) -> Mesh {
    let order = vertex_blocks(mesh);
    Mesh::connectivity_only(mesh.vertex_count(), order.renumber(mesh.faces())).unwrap()
}

fn optimizer(target: &str, effort: Effort) -> Optimizer {
    Optimizer {
        target: target.parse::<Target>().unwrap(),
        effort,
        ..Optimizer::default()
    }
}

#[test]
fn orders_stay_in_a_block_and_keep_batches_aligned() {
    let mesh = in_blocks(&grid());
    // Warps over the fewest there can be.
    for (target, effort, most) in [
        ("universal", Effort::Fast, 1.012),
        ("nvidia", Effort::Fast, 1.008),
        ("nvidia", Effort::Best, 1.002),
        ("fifo:12", Effort::Fast, 1.06),
        ("lru:16", Effort::Fast, 1.06),
        ("controllable:12", Effort::Fast, 1.2),
        ("amd", Effort::Fast, 1.06),
    ] {
        let order = optimizer(target, effort).face_order(&mesh);
        let drawn = mesh.with_face_order(&order);
        let counts = nvidia::counts(&drawn);
        let warps = counts.warps_over_floor();
        assert!(warps <= most, "{target}: {warps}");

        // Vertices then move in their blocks alone.
        let fetch = vertex_fetch(&drawn);
        let stay = (0_u32..)
            .zip(fetch.new_to_old())
            .all(|(new, old)| new >> 16 == old >> 16);
        assert!(stay, "{target}");
    }
}

#[test]
fn the_same_order_on_any_number_of_threads() {
    let mesh = in_blocks(&grid());
    for target in ["universal", "nvidia", "fifo:12"] {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| {
                let order = optimizer(target, Effort::Fast).face_order(&mesh);
                (order, vertex_blocks(&mesh))
            })
        };
        assert!(on(1) == on(3), "{target}");
    }
}

#[test]
fn polygons_stay_whole_and_corners_as_they_are() {
    // Two faces a square, squares shuffled.
    let square = |i: u32| {
        let corner = i / SIDE * (SIDE + 1) + i % SIDE;
        let above = corner + SIDE + 1;
        [[corner, corner + 1, above], [corner + 1, above + 1, above]]
    };
    let squares = Permutation::random((SIDE * SIDE) as usize, 3);
    let faces: Vec<_> = squares
        .new_to_old()
        .iter()
        .flat_map(|&i| square(i))
        .collect();
    let starts: Vec<u32> = (0..=SIDE * SIDE).map(|i| 2 * i).collect();
    let vertex_count = (SIDE as usize + 1).pow(2);
    let faces = vertex_blocks(Faces::new(&faces, vertex_count).unwrap()).renumber(&faces);
    let faces = Faces::new(&faces, vertex_count).unwrap();
    let is_kept = |order: &FaceOrder| order.rotations().iter().all(|&rotation| rotation == 0);

    for target in ["universal", "nvidia", "fifo:12", "controllable:12"] {
        let optimizer = optimizer(target, Effort::Fast);
        let order = optimizer.polygon_order(faces, &starts);
        let pairs = order.new_to_old().chunks(2);
        assert!(
            pairs
                .into_iter()
                .all(|pair| pair[0] % 2 == 0 && pair[0] + 1 == pair[1])
        );
        assert!(is_kept(&order), "{target}");

        let optimizer = Optimizer {
            keep_corners: true,
            ..optimizer
        };
        let order = optimizer.face_order(faces);
        assert!(is_kept(&order), "{target}");
        let drawn = order.apply(faces.as_slice());
        let drawn = Faces::new(&drawn, vertex_count).unwrap();
        assert!(nvidia::counts(drawn).warps_over_floor() < 1.3, "{target}");
    }
}
