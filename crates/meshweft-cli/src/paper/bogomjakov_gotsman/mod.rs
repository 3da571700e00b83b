//! Figures 4a, 4b and 8 and tables 1 and 2 of Bogomjakov and Gotsman 2002, beside ours, and the
//! universality table of Lin and Yu's figure 10 with every order that is available.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use meshweft::operations::{Method, grid_orders, linear_arrangement_cost};
use meshweft::order::{Effort, Target};
use meshweft::{CacheModel, Mesh, cache};
use serde_json::{Value, json};

use super::arguments::OfPaper;
use super::figure::{Figure, cells, head, mean, print};
use super::irregular::irregular_mesh;
use super::meshes::{LARGE, none_found, open};

/// Cache sizes of figures 4 and 8, which the paper drew as curves from 2 to 64.
const SIZES: [u32; 9] = [4, 6, 8, 10, 12, 16, 24, 32, 64];

/// A row of tables 1 and 2.
struct Printed {
    mesh: &'static str,
    /// Used vertices and faces.
    size: [usize; 2],
    /// Table 1: seconds for the recursive cut, on a Pentium III of 550 MHz.
    seconds: f64,
    /// Table 2: misses per face at a cache of 10 as in the file, by recursive cut and as triangle
    /// strips.
    acmr: Option<[f64; 3]>,
    files: &'static [&'static str],
}

/// Regular32 is made here.
#[rustfmt::skip]
const MESHES: [Printed; 6] = [
    Printed { mesh: "Bunny (simplified)", size: [1092, 2084], seconds: 0.6, acmr: Some([2.76, 0.81, 1.06]), files: &["bunny_simplified"] },
    Printed { mesh: "Flipper", size: [6179, 12337], seconds: 5.4, acmr: Some([1.84, 0.83, 1.10]), files: &["flipper"] },
    Printed { mesh: "Face", size: [12530, 24118], seconds: 9.5, acmr: Some([1.34, 0.83, 1.10]), files: &["face"] },
    Printed { mesh: "Horse", size: [19851, 39698], seconds: 18.0, acmr: Some([2.83, 0.81, 1.09]), files: &["horse_20k", "horse"] },
    Printed { mesh: "Buddha", size: [32316, 67240], seconds: 27.0, acmr: Some([1.00, 0.81, 1.08]), files: &["buddha_res3"] },
    Printed { mesh: "Bunny", size: [34834, 69451], seconds: 32.0, acmr: Some([1.00, 0.83, 1.08]), files: &["bunny"] },
];
const REGULAR_32: ([usize; 2], f64) = ([561, 1024], 0.3);

/// Names of the meshes of the universality table: those of Lin and Yu.
const UNIVERSALITY: [&str; 8] = [
    "eight", "cow", "fandisk", "feline", "foot", "skull", "bunny", "horse",
];

struct Found {
    printed: &'static Printed,
    file: PathBuf,
    mesh: Mesh,
}

impl Found {
    /// The paper's name of the mesh, starred if the file is another version of it.
    fn name(&self) -> String {
        let used = cache::report(self.mesh.faces(), CacheModel::fifo(10)).used_vertices;
        let is_the_papers = self.printed.size == [used, self.mesh.face_count()];
        format!(
            "{}{}",
            self.printed.mesh,
            if is_the_papers { "" } else { "*" }
        )
    }
}

/// Prints the figures for the meshes found in the data folder.
pub(super) fn run(arguments: &OfPaper) -> Result<()> {
    let mut found = Vec::new();
    for printed in &MESHES {
        if let Some((file, mesh)) = open(&arguments.data, printed.files)? {
            found.push(Found {
                printed,
                file,
                mesh,
            });
        }
    }

    let mut others = Vec::new();
    for name in UNIVERSALITY {
        others.extend(open(&arguments.data, &[name])?.map(|(_, mesh)| mesh));
    }
    others.retain(|mesh| mesh.face_count() <= LARGE);
    if arguments.skip_large {
        found.retain(|it| it.mesh.face_count() <= LARGE);
    }

    if found.is_empty() || others.is_empty() {
        return Err(none_found(&arguments.data));
    }

    print(
        &arguments.report,
        "10.1111/1467-8659.00573",
        &[
            ("Fig. 4a", "figure_4a", &fig_4a),
            ("Fig. 4b", "figure_4b", &fig_4b),
            ("Fig. 8", "figure_8", &|| fig_8(&found)),
            ("Table 1", "table_1", &|| table_1(&found)),
            ("Table 2", "table_2", &|| table_2(&found)),
            ("Universality", "universality", &|| universality(&others)),
        ],
    )
}

fn fifo(faces: &[[u32; 3]], size: u32) -> f64 {
    cache::acmr(faces, CacheModel::fifo(size))
}

fn sizes_head(name: &str) -> Vec<String> {
    let sizes = SIZES.iter().map(|size| format!("K={size}"));
    [name.to_owned()].into_iter().chain(sizes).collect()
}

fn ordered(method: Method, mesh: &Mesh) -> Vec<[u32; 3]> {
    method.order(mesh).apply(mesh.faces())
}

/// The regular mesh of figure 2 under the sequences of figure 4.
fn fig_4a() -> Figure {
    let (mesh, [snake, hilbert, primed]) = grid_orders(16, 8, 10);
    let faces = mesh.faces();
    curves(
        "The regular grid of 16 by 8 squares of Fig. 2: misses per face over the cache size,\n\
         and the cost of the linear arrangement. The paper drew curves and printed no numbers.",
        &mesh,
        [
            ("random", ordered(Method::Random { seed: 1 }, &mesh)),
            ("snake (Fig. 2a)", snake.1.apply(faces)),
            ("Hilbert (2b)", hilbert.1.apply(faces)),
            ("recursive cut (2c)", ordered(Method::RecursiveCut, &mesh)),
            (
                "linear arrangement (2d)",
                ordered(Method::LinearArrangement, &mesh),
            ),
            ("primed rows, K=10", primed.1.apply(faces)),
        ],
    )
}

/// An irregular mesh like that of figure 3.
fn fig_4b() -> Figure {
    let mesh = irregular_mesh(1);
    curves(
        "An irregular mesh of 509 vertices and 950 faces, as that of Fig. 3, made here: misses per face\n\
         over the cache size, and the cost of the linear arrangement. The paper drew curves and printed\n\
         no numbers.",
        &mesh,
        [
            ("random", ordered(Method::Random { seed: 1 }, &mesh)),
            ("recursive cut (3a)", ordered(Method::RecursiveCut, &mesh)),
            (
                "linear arrangement (3b)",
                ordered(Method::LinearArrangement, &mesh),
            ),
        ],
    )
}

/// Misses over the cache size of these sequences, and of ours.
fn curves<const N: usize>(
    title: &str,
    mesh: &Mesh,
    sequences: [(&str, Vec<[u32; 3]>); N],
) -> Figure {
    let sequences = sequences.map(|(name, faces)| (name.to_owned(), faces));
    let methods = Method::SHOWN.into_iter();
    let methods = methods.filter(|method| method.name().contains("fast"));
    let methods = methods.map(|method| (method.to_string(), ordered(method, mesh)));

    let mut rows = vec![sizes_head("")];
    rows[0].push("cost".to_owned());
    let mut json = Vec::new();
    for (name, faces) in sequences.into_iter().chain(methods) {
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

fn fig_8(found: &[Found]) -> Figure {
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

fn table_1(found: &[Found]) -> Figure {
    let mut rows = vec![head(&["", "vertices", "faces", "paper, s", "ours, s"])];
    let mut json = Vec::new();
    let mut push = |name: String, vertices: usize, mesh: &Mesh, paper: f64| {
        let start = Instant::now();
        std::hint::black_box(Method::RecursiveCut.order(mesh));
        let ours = start.elapsed().as_secs_f64();
        rows.push(vec![
            name.clone(),
            vertices.to_string(),
            mesh.face_count().to_string(),
            format!("{paper:.1}"),
            format!("{ours:.4}"),
        ]);
        json.push(json!({"mesh": name, "paper": paper, "ours": ours}));
    };

    let ([vertices, _], seconds) = REGULAR_32;
    let (regular, _) = grid_orders(32, 16, 10);
    push("Regular32".to_owned(), vertices, &regular, seconds);
    for it in found {
        push(it.name(), it.printed.size[0], &it.mesh, it.printed.seconds);
    }

    Figure {
        title: "Seconds for the recursive cut: the paper's (Pentium III, 550 MHz), ours."
            .to_owned(),
        rows,
        json: Value::Array(json),
    }
}

fn table_2(found: &[Found]) -> Figure {
    let mut rows = vec![head(&[
        "",
        "original",
        "ours",
        "rec. cut",
        "ours",
        "strips",
        "universal, fast",
        "universal, best",
    ])];
    let mut json = Vec::new();
    for it in found {
        let Some([original, cut, strips]) = it.printed.acmr else {
            continue;
        };
        let in_file = fifo(it.mesh.faces(), 10);
        let our_cut = fifo(&ordered(Method::RecursiveCut, &it.mesh), 10);
        let universal = [Effort::Fast, Effort::Best]
            .map(|effort| fifo(&ordered(Method::Universal { effort }, &it.mesh), 10));

        let numbers = [original, in_file, cut, our_cut, strips];
        rows.push(cells(it.name(), numbers.into_iter().chain(universal)));
        json.push(json!({
            "mesh": it.printed.mesh,
            "file": it.file.file_name().map(|name| name.to_string_lossy()),
            "paper": {"original": original, "recursive_cut": cut, "strips": strips},
            "ours": {"original": in_file, "recursive_cut": our_cut,
                     "universal_fast": universal[0], "universal_best": universal[1]},
        }));
    }

    Figure {
        title:
            "Misses per face at a cache of 10: the paper's columns, ours to the right of them.\n\
                The frame rates beside them are those of a GeForce 2 and are not repeated."
                .to_owned(),
        rows,
        json: Value::Array(json),
    }
}

fn universality(meshes: &[Mesh]) -> Figure {
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
