//! What Bogomjakov and Gotsman 2002 print, on the paper's own meshes where they are at hand.
#![cfg(feature = "files")]

mod data;

use data::{meshes, open};
use meshweft::order::bogomjakov_gotsman::{
    LinearArrangement, RecursiveCut, linear_arrangement_cost,
};
use meshweft::order::{Grid, baselines};
use meshweft::{CacheModel, Mesh, cache};

fn recursive_cut(mesh: &Mesh) -> Vec<[u32; 3]> {
    RecursiveCut::default().face_order(mesh).apply(mesh.faces())
}

fn fifo(faces: &[[u32; 3]], size: u32) -> f64 {
    cache::acmr(faces, CacheModel::fifo(size))
}

#[test]
fn table_2_on_the_papers_horse() {
    let Some(folder) = meshes() else { return };
    let horse = open(&folder, "horse_20k.off.gz");
    assert_eq!((horse.vertex_count(), horse.face_count()), (19851, 39698));
    assert_eq!(format!("{:.2}", fifo(horse.faces(), 10)), "2.83");
    let cut = fifo(&recursive_cut(&horse), 10);
    assert!((cut - 0.81).abs() < 0.015, "{cut}");
    let bunny = open(&folder, "bunny_clean.obj.gz");
    assert_eq!((bunny.vertex_count(), bunny.face_count()), (34834, 69451));
    let cut = fifo(&recursive_cut(&bunny), 10);
    assert!((cut - 0.83).abs() < 0.02, "{cut}");
}

#[test]
fn the_column_that_lin_and_yu_print_of_it() {
    let Some(folder) = meshes() else { return };
    for (name, printed) in [
        ("fandisk.off.gz", 0.794),
        ("bunny.ply.gz", 0.789),
        ("horse.obj.gz", 0.786),
    ] {
        let cut = fifo(&recursive_cut(&open(&folder, name)), 12);
        assert!((cut - printed).abs() < 0.01, "{name}: {cut}, {printed}");
    }
}

#[test]
fn curves_of_all_meshes_nearly_coincide() {
    let Some(folder) = meshes() else { return };
    let names = ["bunny_clean.obj.gz", "horse_20k.off.gz", "fandisk.off.gz"];
    let cuts = names.map(|name| recursive_cut(&open(&folder, name)));
    for size in [8, 10, 16, 32, 64] {
        let figures = cuts.each_ref().map(|faces| fifo(faces, size));
        let spread = figures.iter().fold(f64::MIN, |a, &b| a.max(b))
            - figures.iter().fold(f64::MAX, |a, &b| a.min(b));
        assert!(spread < 0.035, "{size}: {figures:?}");
    }
}

#[test]
fn sequences_of_the_regular_grid() {
    let grid = Grid {
        columns: 16,
        rows: 8,
    };
    let mesh = Mesh::connectivity_only(17 * 9, grid.faces()).unwrap();
    let faces = mesh.faces();
    let arrangement = LinearArrangement::default().face_order(&mesh).apply(faces);
    let sequences = [
        grid.hilbert().apply(faces),
        recursive_cut(&mesh),
        arrangement.clone(),
    ];
    let random = baselines::random(faces.len(), 1).apply(faces);
    let snake = grid.snake().apply(faces);
    for sequence in &sequences {
        for size in [10, 12, 16, 24] {
            // As in Fig. 4a: a little better than the snake in the middle, far from random.
            assert!(fifo(sequence, size) < fifo(&snake, size));
            assert!(fifo(sequence, size) < 0.4 * fifo(&random, size));
        }
        // The cut is not much worse than the curve that only a grid has.
        assert!(fifo(sequence, 16) < fifo(&sequences[0], 16) * 1.1);
    }
    let costs = sequences.map(|sequence| linear_arrangement_cost(&sequence));
    assert!(linear_arrangement_cost(&arrangement) <= costs.into_iter().min().unwrap());
}

#[test]
fn the_arrangement_costs_less_than_the_cut() {
    let Some(folder) = meshes() else { return };
    let mesh = open(&folder, "fandisk.off.gz");
    let arrangement = LinearArrangement::default().face_order(&mesh);
    let cost = linear_arrangement_cost(&arrangement.apply(mesh.faces()));
    assert!(cost < linear_arrangement_cost(&recursive_cut(&mesh)));
}
