//! Table 4 by counts: what vertices cost with the method and without it.

use meshweft::operations::{StripedMesh, ViewFrom};
use serde_json::json;

use super::found::{DISTANCE, Found, RANGES, mean_over};
use super::sweeps::{CACHE, misses, ordered};
use crate::paper::figure::{Figure, head};

/// How many directions a mean is taken over.
const DIRECTIONS: usize = 16;

/// Misses for each face of the mesh: drawn whole, and of what is drawn in stripes.
pub(super) fn table_4(found: &[Found]) -> Figure {
    let columns = [
        "",
        "F",
        "V",
        "whole: file",
        "ours",
        "drawn",
        "stripes: file",
        "ours",
        "a face drawn",
        "paper's gain",
    ];
    let mut rows = vec![head(&columns)];
    let mut json = Vec::new();
    for it in found {
        let views = ViewFrom::uniform(DIRECTIONS, Some(DISTANCE));
        let faces = it.mesh.face_count() as f64;
        let ours = ordered(&it.mesh);
        let [whole, whole_ours] = [&it.mesh, &ours].map(|mesh| misses(mesh, mesh.faces()) / faces);

        // Faces of a range stay in the order of the mesh.
        let striped = StripedMesh::new(&it.mesh, None, RANGES);
        let of_ours = StripedMesh::new(&ours, None, RANGES);
        let drawn = mean_over(&views, |view| it.share(striped.ranges(view).face_count()));
        let [in_stripes, ours_in_stripes] = [&striped, &of_ours].map(|striped| {
            let count = |view: ViewFrom| misses(&it.mesh, &striped.drawn(view)) / faces;
            mean_over(&views, count)
        });

        let numbers = [
            whole,
            whole_ours,
            drawn,
            in_stripes,
            ours_in_stripes,
            ours_in_stripes / drawn,
        ];
        let mut row = vec![
            it.name.clone(),
            it.mesh.face_count().to_string(),
            striped.stripe_count().to_string(),
        ];
        row.extend(numbers.map(|number| format!("{number:.3}")));
        row.push(format!("{:+.1} %", it.printed.improvement));
        rows.push(row);
        json.push(json!({
            "mesh": it.name, "faces": it.mesh.face_count(), "stripes": striped.stripe_count(),
            "whole": {"file_order": whole, "our_order": whole_ours},
            "drawn": drawn,
            "in_stripes": {"file_order": in_stripes, "our_order": ours_in_stripes},
            "paper_improvement": it.printed.improvement / 100.0,
        }));
    }
    Figure {
        title: format!(
            "Vertex work from 4r: what a FIFO cache of {CACHE} misses for each face of the mesh, drawn whole in the file's order and in \
             ours,\nand of what stripes draw, whose ranges keep the file's order or ours; means over {DIRECTIONS} directions. Beyond \
             spheres,\nstripes cost vertex work: faces with like normals are scattered over the surface, and the two thirds that are \
             drawn miss\nmore than all faces do in a good order. They pay where faces are the limit, or against a bad order. The \
             paper's gain is\nof frame times, against an order that it does not name; a card's are measured by `cull` of the program in gpu/."
        ),
        rows,
        json: json!({"cache_size": CACHE, "rows": json}),
    }
}
