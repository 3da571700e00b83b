//! Figures over the cache size: 4 and 8, and the universality of all orders.

use meshweft::operations::{Method, grid_orders, linear_arrangement_cost};
use meshweft::order::Target;
use meshweft::{Mesh, cache};
use serde_json::json;

use super::found::{Found, fifo, ordered};
use crate::paper::figure::{Figure, cells, head, mean};
use crate::paper::irregular::Irregular;

/// Cache sizes of figures 4 and 8, which the paper drew as curves from 2 to 64.
const SIZES: [u32; 9] = [4, 6, 8, 10, 12, 16, 24, 32, 64];

fn sizes_head(name: &str) -> Vec<String> {
    let sizes = SIZES.iter().map(|size| format!("K={size}"));
    [name.to_owned()].into_iter().chain(sizes).collect()
}

/// The regular mesh of figure 2 under the sequences of figure 4.
pub(super) fn fig_4a() -> Figure {
    let (mesh, [snake, hilbert, primed]) = grid_orders(16, 8, 10);
    let faces = mesh.faces();
    let sequences = [
        ("random", ordered(Method::Random { seed: 1 }, &mesh)),
        ("snake (Fig. 2a)", snake.1.apply(faces)),
        ("Hilbert (2b)", hilbert.1.apply(faces)),
        ("recursive cut (2c)", ordered(Method::RecursiveCut, &mesh)),
        (
            "linear arrangement (2d)",
            ordered(Method::LinearArrangement, &mesh),
        ),
        ("primed rows, K=10", primed.1.apply(faces)),
    ];
    let sequences = sequences.map(|(name, faces)| (name.to_owned(), faces));
    curves(
        "The regular grid of 16 by 8 squares of Fig. 2: misses per face over the cache size,\n\
         and the cost of the linear arrangement. The paper drew curves and printed no numbers.",
        sequences.into_iter().chain(ours(&mesh)),
    )
}

/// An irregular mesh like that of figure 3.
pub(super) fn fig_4b() -> Figure {
    let mesh = Irregular::of_the_paper().drawing();
    curves(
        "An irregular mesh of 509 vertices and 950 faces, as that of Fig. 3, made here: misses per face\n\
         over the cache size, and the cost of the linear arrangement. The paper drew curves and printed\n\
         no numbers.",
        fig_4b_sequences(&mesh),
    )
}

/// The irregular mesh under the sequences of its figure, and ours.
pub(super) fn fig_4b_sequences(mesh: &Mesh) -> impl Iterator<Item = Sequence> {
    let sequences = [
        ("random", Method::Random { seed: 1 }),
        ("recursive cut (3a)", Method::RecursiveCut),
        ("linear arrangement (3b)", Method::LinearArrangement),
    ];
    let sequences = sequences.map(|(name, method)| (name.to_owned(), ordered(method, mesh)));
    sequences.into_iter().chain(ours(mesh))
}

/// A name, and faces in the order of drawing.
type Sequence = (String, Vec<[u32; 3]>);

/// The library's own sequences that are fast.
fn ours(mesh: &Mesh) -> impl Iterator<Item = Sequence> {
    let methods = Method::SHOWN.into_iter();
    let methods = methods.filter(|method| method.name().contains("fast"));
    methods.map(|method| (method.to_string(), ordered(method, mesh)))
}

/// Misses over the cache size of these sequences.
fn curves(title: &str, sequences: impl IntoIterator<Item = Sequence>) -> Figure {
    let mut rows = vec![sizes_head("")];
    rows[0].push("cost".to_owned());
    let mut json = Vec::new();
    for (name, faces) in sequences {
        let acmr = SIZES.map(|size| fifo(&faces, size));
        let cost = linear_arrangement_cost(&faces);
        let mut row = cells(&*name, acmr);
        row.push(cost.to_string());
        rows.push(row);
        json.push(json!({"sequence": name, "acmr": acmr, "linear_arrangement_cost": cost}));
    }

    Figure {
        title: title.to_owned(),
        rows,
        json: json!({"sizes": SIZES, "sequences": json}),
    }
}

pub(super) fn fig_8(found: &[Found]) -> Figure {
    let mut rows = vec![sizes_head("")];
    let mut json = Vec::new();
    for it in found {
        for method in [Method::RecursiveCut, Method::LinearArrangement] {
            let name = method.name();
            let faces = ordered(method, &it.mesh);
            let acmr = SIZES.map(|size| fifo(&faces, size));
            rows.push(cells(format!("{}, {name}", it.name()), acmr));
            json.push(json!({"mesh": it.printed.mesh, "sequence": name, "acmr": acmr}));
        }
    }

    Figure {
        title:
            "Misses per face over the cache size. The paper drew curves that nearly coincide for \
                all meshes.\n* the file is another version of the mesh than the paper's."
                .to_owned(),
        rows,
        json: json!({"sizes": SIZES, "rows": json}),
    }
}

pub(super) fn universality(meshes: &[Mesh]) -> Figure {
    let mut rows = vec![head(&[
        "", "K=10", "12", "16", "24", "32", "64", "mean", "NVIDIA", "AMD", "Intel",
    ])];
    let mut json = Vec::new();
    for method in Method::SHOWN {
        let mut figures = [0.0; Target::UNIVERSAL.len()];
        for mesh in meshes {
            let faces = ordered(method, mesh);
            for (sum, model) in figures.iter_mut().zip(Target::UNIVERSAL) {
                let figure = match model.is_gpu() {
                    true => cache::atvr(&faces, model),
                    false => cache::acmr(&faces, model),
                };
                *sum += figure / meshes.len() as f64;
            }
        }

        let (acmr, atvr) = figures.split_at(6);
        let numbers = acmr.iter().copied().chain([mean(acmr.iter().copied())]);
        rows.push(cells(
            method.to_string(),
            numbers.chain(atvr.iter().copied()),
        ));
        json.push(json!({"method": method.to_string(), "acmr": acmr, "atvr": atvr}));
    }

    let models = Target::UNIVERSAL.map(|model| model.to_string());
    Figure {
        title: format!(
            "Every order in every cache (Lin and Yu's Fig. 10): misses per face of FIFO caches and \
             their\nmean, misses per vertex of GPUs; means over {} meshes.",
            meshes.len()
        ),
        rows,
        json: json!({"models": models, "meshes": meshes.len(), "methods": json}),
    }
}
