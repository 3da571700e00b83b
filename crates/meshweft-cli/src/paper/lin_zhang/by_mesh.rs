//! Table 1, and what it is made of.

use std::path::PathBuf;

use meshweft::connectivity::{
    FanCode, FirstVertex, MinimumTimeRendering, TrimmedListCode, TrimmedLists, buffer_bound,
};
use meshweft::{Mesh, Permutation};
use serde_json::json;

use super::printed::Printed;
use crate::paper::figure::{Figure, cells, head};

/// First vertices that are tried at random.
const TRIED: usize = 20;

/// A mesh, and the paper's row where it is (a version of) one of the paper's.
pub(super) struct Found {
    pub(super) name: String,
    pub(super) file: PathBuf,
    pub(super) mesh: Mesh,
    pub(super) printed: Option<&'static Printed>,
}

/// Of one first vertex: bits per face, and the required buffer size.
fn measured(mesh: &Mesh, first: u32) -> (f64, usize) {
    let (code, vertices, order) = TrimmedListCode::new(mesh, first);
    let faces = vertices.renumber(&order.apply(mesh.faces()));
    let rendering = MinimumTimeRendering::new(&faces);
    let bits = code.bits().total() / mesh.face_count().max(1) as f64;
    (bits, rendering.buffer_size())
}

impl Found {
    fn constant(&self, buffer: f64) -> f64 {
        buffer / (self.mesh.vertex_count() as f64).sqrt()
    }
}

/// Bits per face and buffer sizes, of the first vertex and of twenty others.
pub(super) fn table_1(found: &[Found]) -> Figure {
    let columns = [
        "",
        "V",
        "F",
        "bits/face",
        "ours",
        "best",
        "worst",
        "b",
        "C",
        "ours b",
        "C",
        "best b",
        "worst b",
    ];
    let mut rows = vec![head(&columns)];
    let mut json = Vec::new();
    for it in found {
        let (bits, buffer) = measured(&it.mesh, 0);
        let tried = Permutation::random(it.mesh.vertex_count(), 1);
        let tried = tried.new_to_old().iter().take(TRIED);
        let tried: Vec<_> = tried.map(|&first| measured(&it.mesh, first)).collect();
        let least = tried.iter().map(|it| it.0).fold(f64::INFINITY, f64::min);
        let most = tried.iter().map(|it| it.0).fold(0.0, f64::max);
        let buffers = tried.iter().map(|it| it.1);
        let (smallest, largest) = (
            buffers.clone().min().unwrap_or(0),
            buffers.max().unwrap_or(0),
        );

        let [paper_bits, paper_b, paper_c] = match it.printed {
            Some(row) => [
                format!("{:.3}", row.bits_per_face),
                row.buffer.to_string(),
                format!("{:.3}", row.constant),
            ],
            None => [const { String::new() }; 3],
        };
        rows.push(vec![
            it.name.clone(),
            it.mesh.vertex_count().to_string(),
            it.mesh.face_count().to_string(),
            paper_bits,
            format!("{bits:.3}"),
            format!("{least:.3}"),
            format!("{most:.3}"),
            paper_b,
            paper_c,
            buffer.to_string(),
            format!("{:.3}", it.constant(buffer as f64)),
            smallest.to_string(),
            largest.to_string(),
        ]);
        json.push(json!({
            "mesh": it.name,
            "file": it.file.file_name().map(|name| name.to_string_lossy()),
            "vertices": it.mesh.vertex_count(),
            "faces": it.mesh.face_count(),
            "paper": it.printed.map(|row| json!({
                "bits_per_face": row.bits_per_face, "buffer_size": row.buffer, "constant": row.constant,
            })),
            "ours": {"bits_per_face": bits, "buffer_size": buffer, "constant": it.constant(buffer as f64)},
            "of_20_first_vertices": {
                "bits_per_face": [least, most], "buffer_size": [smallest, largest],
            },
        }));
    }

    Figure {
        title: "Bits per face and the required buffer size b, C = b / √V: the paper's columns, ours from \
                vertex 0,\nbest and worst of 20 random first vertices. * another version of the paper's mesh. \
                Bar-Yehuda and\nGotsman: C between 1.649 and 12.72 for any mesh, with a buffer that the \
                program controls."
            .to_owned(),
        rows,
        json: json!(json),
    }
}

/// Where the bits go, and how often the guesses are right.
pub(super) fn parts(found: &[Found]) -> Figure {
    let columns = [
        "",
        "I",
        "II",
        "III",
        "IV",
        "left",
        "differences",
        "II j<l",
        "II j=l",
        "IV",
        "left faces",
        "edges",
    ];
    let mut rows = vec![head(&columns)];
    let mut json = Vec::new();
    for it in found {
        let (code, ..) = TrimmedListCode::new(&it.mesh, 0);
        let bits = code.bits();
        let faces = it.mesh.face_count().max(1) as f64;
        let parts = [
            bits.type_1,
            bits.type_2,
            bits.type_3,
            bits.type_4,
            bits.left_counts,
            bits.left,
        ];
        let parts = parts.map(|bits| bits / faces);
        let joined = TrimmedLists::new(&it.mesh, 0).joined_share(&it.mesh);
        let rates = code.hit_rates();
        let left = code.left_count() as f64 / faces;
        let numbers = parts.into_iter().chain(rates).chain([left, joined]);
        rows.push(cells(it.name.clone(), numbers));
        json.push(json!({
            "mesh": it.name,
            "bits_per_face": parts,
            "hit_rates": rates,
            "left_faces": left,
            "consecutive_edges": joined,
        }));
    }

    Figure {
        title: "Bits per face of each part, from vertex 0; shares of bits that say that there is a face (the \
                paper:\nabove .987 for j<l, .885 for j=l); the share of left faces; the share of consecutive \
                vertices that an\nedge joins (Fig. 3: .997 on Venus)."
            .to_owned(),
        rows,
        json: json!({"parts": ["I", "II", "III", "IV", "left counts", "differences"], "rows": json}),
    }
}

/// The buffer of the best first vertex.
pub(super) fn buffers(found: &[Found]) -> Figure {
    let mut rows = vec![head(&[
        "",
        "b",
        "C",
        "bound",
        "b/bound",
        "bits/face",
        "first vertex",
        "fans",
        "fewest",
        "its b",
    ])];
    let mut json = Vec::new();
    for it in found {
        let first = FirstVertex::MinBuffer.choose(&it.mesh).unwrap_or(0);
        let (bits, buffer) = measured(&it.mesh, first);
        let bound = buffer_bound(&it.mesh);
        let mut row = vec![it.name.clone(), buffer.to_string()];
        let numbers = [
            it.constant(buffer as f64),
            bound,
            buffer as f64 / bound,
            bits,
        ];
        row.extend(numbers.map(|number| format!("{number:.3}")));
        row.push(first.to_string());

        // What the library writes, from there and from the vertex with which it is the least.
        let fewest = FirstVertex::MinBits.choose(&it.mesh).unwrap_or(0);
        let fans = [first, fewest].map(|first| {
            let bytes = FanCode::new(&it.mesh, first).bytes().len();
            8.0 * bytes as f64 / it.mesh.face_count().max(1) as f64
        });
        let (_, its_buffer) = measured(&it.mesh, fewest);
        row.extend(fans.map(|bits| format!("{bits:.3}")));
        row.push(its_buffer.to_string());
        rows.push(row);
        json.push(json!({
            "mesh": it.name, "buffer_size": buffer, "constant": numbers[0], "bound": bound,
            "bits_per_face": bits, "first_vertex": first, "fans_bits_per_face": fans[0],
            "fewest_bits": {"first_vertex": fewest, "fans_bits_per_face": fans[1], "buffer_size": its_buffer},
        }));
    }

    Figure {
        title: "The smallest buffer of 27 first vertices (extremes of the shape, an end of the graph), below \
                10,000\nvertices of 48 random ones too. The bound is (V - 1) / diameter; the diameter is one of \
                double sweeps,\nperhaps too small. fans: bits per face that the library writes; fewest: from the \
                first vertex for which\nthese are the least, and the buffer that it needs."
            .to_owned(),
        rows,
        json: json!(json),
    }
}
