//! The order in which faces are decoded, made good for small caches inside windows.

use meshweft::connectivity::{
    FanCode, FirstVertex, MinimumTimeRendering, WindowOrder, WindowSize, released_buffer_size,
};
use meshweft::operations::InBatches;
use meshweft::{CacheModel, FaceOrder, Mesh, cache};
use serde_json::json;

use super::by_mesh::Found;
use crate::paper::figure::{Figure, head};

/// Sizes of FIFO caches.
const CACHES: [u32; 3] = [12, 16, 32];
/// Windows of these many times the required buffer size.
const SCALES: [u32; 4] = [2, 4, 8, 32];

/// The faces as they are decoded if the required buffer is to be small.
fn decoded(mesh: &Mesh) -> Vec<[u32; 3]> {
    let first = FirstVertex::MinBuffer.choose(mesh).unwrap_or(0);
    let code = FanCode::new(mesh, first);
    let faces = code.faces().apply(mesh.faces());
    code.vertices().renumber(&faces)
}

/// Misses, buffer and what an NVIDIA card counts, window by window size.
pub(super) fn windows(found: &[Found]) -> Figure {
    let columns = [
        "",
        "window",
        "K=12",
        "16",
        "32",
        "released/b",
        "invocations",
        "in batches",
        "cycles",
        "in batches",
    ];
    let mut rows = vec![head(&columns)];
    let mut json = Vec::new();
    for it in found {
        let faces = decoded(&it.mesh);
        let buffer = MinimumTimeRendering::new(&faces).buffer_size();
        let b = u32::try_from(buffer).unwrap_or(u32::MAX);
        let scaled = |scale: u32| WindowSize::Faces(scale.saturating_mul(b));
        let mut sizes = vec![("plain".to_owned(), None)];
        sizes.extend(SCALES.map(|scale| (format!("{scale}b"), Some(scaled(scale)))));
        sizes.push(("default".to_owned(), Some(WindowSize::default())));

        for (window, size) in sizes {
            let order = size.map(|size| WindowOrder::of_faces(&faces, size));
            let drawn = order.map_or_else(|| faces.clone(), |order| order.apply(&faces));
            let as_it_is = FaceOrder::identity(drawn.len());
            let in_batches = InBatches::default().follow(&drawn, &as_it_is).apply(&drawn);

            let acmr = CACHES.map(|size| cache::acmr(&drawn, CacheModel::fifo(size)));
            let released = released_buffer_size(&drawn) as f64 / buffer.max(1) as f64;
            let counts = [&drawn, &in_batches].map(cache::nvidia::counts);
            let vertices = it.mesh.vertex_count().max(1) as f64;
            let invocations = counts.map(|it| it.invocations as f64 / vertices);
            let cycles = counts.map(|it| it.setup_cycles as f64 / drawn.len().max(1) as f64);

            let numbers = acmr.into_iter().chain([released]);
            let numbers = numbers.chain(invocations).chain(cycles);
            let mut row = vec![it.name.clone(), window.clone()];
            row.extend(numbers.map(|number| format!("{number:.3}")));
            rows.push(row);
            json.push(json!({
                "mesh": it.name, "window": window, "acmr": acmr, "released_over_buffer_size": released,
                "nvidia_invocations_per_vertex": invocations[0],
                "nvidia_setup_cycles_per_face": cycles[0],
                "in_batches": {
                    "nvidia_invocations_per_vertex": invocations[1],
                    "nvidia_setup_cycles_per_face": cycles[1],
                },
            }));
        }
    }

    Figure {
        title: "The decoded order, columns across the rings of each window: misses a face of FIFO caches, \
                the buffer\nwhose slots are freed after a vertex's last face over b, invocations a vertex and \
                setup cycles a face of\nan NVIDIA card, and both after faces were moved inside its batches. \
                Windows of 2b to 32b faces; default:\nsix faces for each vertex that is in the buffer at the \
                time."
            .to_owned(),
        rows,
        json: json!({"cache_sizes": CACHES, "rows": json}),
    }
}
