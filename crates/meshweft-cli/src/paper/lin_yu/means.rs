//! Figures of means over the meshes: 7, 8 and 10.

use meshweft::operations::{Greedy, Method};
use meshweft::order::Mode;
use meshweft::{CacheModel, Mesh, cache};
use serde_json::json;

use super::found::{Found, SIZE, control, fifo};
use super::printed::{FIG_7, SIZES};
use crate::paper::figure::{Figure, cells, head, mean};
use crate::paper::meshes::LARGE;

/// Grid of Fig. 8; the paper drew a surface over k2 and k3 and printed no numbers.
const K2: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
const K3: [f64; 5] = [0.0, 0.65, 1.3, 1.95, 2.6];

/// The meshes that many runs can be made on.
fn not_large(found: &[Found]) -> Vec<&Mesh> {
    let some = found.iter().filter(|it| !it.is_large());
    some.map(|it| &it.mesh).collect()
}

/// Misses per face over the cache size.
pub(super) fn fig_7(found: &[Found]) -> Figure {
    let meshes = not_large(found);
    let mut ours = [[0.0; 6]; 5];
    for (i, &size) in SIZES.iter().enumerate() {
        for (which, mode) in [Mode::Faithful, Mode::Fast].into_iter().enumerate() {
            ours[which][i] = mean(meshes.iter().map(|mesh| fifo(mesh, size, mode)));
        }
        let faithful = meshes
            .iter()
            .map(|mesh| control(mesh, size, Mode::Faithful)[0]);
        ours[2][i] = mean(faithful);
        let fast: Vec<_> = meshes
            .iter()
            .map(|mesh| control(mesh, size, Mode::Fast))
            .collect();
        ours[3][i] = mean(fast.iter().map(|c| c[0]));
        ours[4][i] = mean(fast.iter().map(|c| c[1]));
    }

    // The rows of `ours`.
    let names = [
        "FIFO, faithful",
        "FIFO, fast",
        "controllable, faithful",
        "controllable, fast",
        "controllable, fast, Belady",
    ];

    let mut rows = vec![head(&["", "K=10", "12", "16", "24", "32", "64"])];
    rows.push(cells("FIFO, paper (30 meshes)", FIG_7[0]));
    rows.extend(
        names
            .iter()
            .zip(ours)
            .take(2)
            .map(|(name, row)| cells(*name, row)),
    );
    rows.push(cells("controllable, paper (30 meshes)", FIG_7[1]));
    rows.extend(
        names
            .iter()
            .zip(ours)
            .skip(2)
            .map(|(name, row)| cells(*name, row)),
    );

    let title = format!(
        "Mean misses per face, ours over the {} meshes up to {LARGE} faces.",
        meshes.len()
    );
    let json = json!({
        "sizes": SIZES, "paper": {"fifo": FIG_7[0], "control": FIG_7[1]}, "meshes": meshes.len(),
        "ours": {"faithful_fifo": ours[0], "fast_fifo": ours[1],
                 "faithful_control": ours[2], "fast_control": {"scheduled": ours[3], "belady": ours[4]}},
    });
    Figure { title, rows, json }
}

/// Misses per face over the weights.
pub(super) fn fig_8(found: &[Found]) -> Figure {
    let meshes = not_large(found);
    let model = CacheModel::fifo(SIZE);

    let grid = K2.map(|k2| {
        K3.map(|k3| {
            let greedy = Greedy {
                k2: Some(k2),
                k3: Some(k3),
                ..Greedy::default()
            };
            let algorithm = Method::KCacheReorder {
                cache: model,
                greedy,
                first_focus: None,
            };
            let acmr =
                |&mesh: &&Mesh| cache::acmr(&algorithm.order(mesh).apply(mesh.faces()), model);
            mean(meshes.iter().map(acmr))
        })
    });

    let least = grid.iter().flatten().copied().fold(f64::MAX, f64::min);
    let mut rows = vec![cells("k2 \\ k3", K3)];
    for (k2, line) in K2.iter().zip(&grid) {
        let mark = |&x: &f64| format!("{x:.3}{}", if x == least { "<" } else { "" });
        let name = [format!("{k2:.2}")].into_iter();
        rows.push(name.chain(line.iter().map(mark)).collect());
    }

    let title = format!(
        "Mean misses per face of the fast mode by weights (k1 = 1, K = {SIZE}) over {} meshes; < least.\n\
         The paper drew a surface and chose k2 = 0.5, k3 = 1.3.",
        meshes.len()
    );
    Figure {
        title,
        rows,
        json: json!({"k2": K2, "k3": K3, "fast": grid}),
    }
}

/// Orders for one cache size, used at others.
pub(super) fn fig_10(found: &[Found]) -> Figure {
    let meshes = not_large(found);
    let methods = [
        ("faithful", Method::k_cache_reorder(SIZE, Mode::Faithful)),
        ("fast", Method::k_cache_reorder(SIZE, Mode::Fast)),
        ("Tipsify", Method::Tipsify { size: SIZE }),
    ];

    let mut ours = [[0.0; 6]; 3];
    for &mesh in &meshes {
        for (row, (_, method)) in ours.iter_mut().zip(methods) {
            let faces = method.order(mesh).apply(mesh.faces());
            for (sum, &size) in row.iter_mut().zip(&SIZES) {
                *sum += cache::acmr(&faces, CacheModel::fifo(size)) / meshes.len() as f64;
            }
        }
    }

    let mut rows = vec![head(&[
        "made for 12, used at",
        "K=10",
        "12",
        "16",
        "24",
        "32",
        "64",
    ])];
    rows.extend(
        methods
            .iter()
            .zip(ours)
            .map(|((name, _), row)| cells(*name, row)),
    );

    let title = format!(
        "Universality: mean misses per face of orders made for K = {SIZE}, over {} meshes.\n\
         The paper drew curves and printed no numbers.",
        meshes.len()
    );
    let json = json!({"sizes": SIZES, "faithful": ours[0], "fast": ours[1], "tipsify": ours[2]});
    Figure { title, rows, json }
}
