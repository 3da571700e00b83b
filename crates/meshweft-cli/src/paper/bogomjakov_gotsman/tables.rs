//! Tables 1 and 2.

use std::time::Instant;

use meshweft::Mesh;
use meshweft::operations::{Method, grid_orders};
use meshweft::order::Effort;
use serde_json::{Value, json};

use super::found::{Found, REGULAR_32, fifo, ordered};
use crate::paper::figure::{Figure, cells, head};

pub(super) fn table_1(found: &[Found]) -> Figure {
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

pub(super) fn table_2(found: &[Found]) -> Figure {
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
