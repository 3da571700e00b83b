//! Table 3 and Fig. 13: what the numbers of stripes and ranges change.

use meshweft::operations::{Method, StripedMesh, ViewFrom};
use meshweft::order::Mode;
use meshweft::{CacheModel, Mesh, cache};
use serde_json::json;

use super::found::{DISTANCE, Found, RANGES, mean_over, sphere};
use super::printed::{PrintedSphere, SPHERES};
use crate::paper::figure::{Figure, head};
use crate::paper::meshes::LARGE;

/// The cache whose misses are counted.
pub(super) const CACHE: u32 = 16;
/// How many directions a mean is taken over.
const DIRECTIONS: usize = 32;
/// Numbers of ranges, as in the paper.
const RANGE_COUNTS: [u32; 5] = [32, 64, 128, 256, 512];

/// The faces of a mesh in our order for that cache.
pub(super) fn ordered(mesh: &Mesh) -> Mesh {
    let order = Method::k_cache_reorder(CACHE, Mode::Fast).order(mesh);
    mesh.with_face_order(&order)
}

/// Misses of some faces of a mesh.
pub(super) fn misses(mesh: &Mesh, faces: &[[u32; 3]]) -> f64 {
    let faces = meshweft::Faces::new(faces, mesh.vertex_count());
    let faces = faces.expect("faces of the mesh");
    cache::misses(faces, CacheModel::fifo(CACHE)) as f64
}

/// A row of Table 3, as it is counted.
struct Counted {
    stripes: Option<u32>,
    order: &'static str,
    /// Shares of the faces.
    drawn: f64,
    draws: f64,
    misses_per_drawn: f64,
    misses_per_face: f64,
    paper_ms: Option<f64>,
}

impl Counted {
    fn whole(order: &'static str, mesh: &Mesh, paper_ms: Option<f64>) -> Self {
        let misses = misses(mesh, mesh.faces()) / mesh.face_count() as f64;
        Self {
            stripes: None,
            order,
            drawn: 1.0,
            draws: 1.0,
            misses_per_drawn: misses,
            misses_per_face: misses,
            paper_ms,
        }
    }

    fn in_stripes(mesh: &Mesh, stripes: u32, paper_ms: f64) -> Self {
        let striped = StripedMesh::new(mesh, Some(stripes), RANGES);
        let views = ViewFrom::uniform(DIRECTIONS, Some(DISTANCE));
        let faces = mesh.face_count() as f64;
        let drawn = mean_over(&views, |view| striped.ranges(view).face_count() as f64);
        let misses = mean_over(&views, |view| misses(mesh, &striped.drawn(view)));
        Self {
            stripes: Some(stripes),
            order: "stripes",
            drawn: drawn / faces,
            draws: mean_over(&views, |view| striped.ranges(view).as_slice().len() as f64),
            misses_per_drawn: misses / drawn,
            misses_per_face: misses / faces,
            paper_ms: Some(paper_ms),
        }
    }
}

/// All rows of a sphere: as it is made, in our order, and in stripes.
fn counted(printed: &PrintedSphere) -> (usize, Vec<Counted>) {
    let mesh = sphere(printed.rings, printed.around);
    let mut rows = vec![
        Counted::whole("as made", &mesh, Some(printed.conventional)),
        Counted::whole("ours", &ordered(&mesh), None),
    ];
    let numbers = (1..).map(|power| 1 << power).zip(printed.by_stripes);
    rows.extend(numbers.map(|(stripes, &ms)| Counted::in_stripes(&mesh, stripes, ms)));
    (mesh.face_count(), rows)
}

/// Spheres by their faces and by the number of stripes.
pub(super) fn table_3(skip_large: bool) -> Figure {
    let columns = [
        "sphere",
        "F",
        "order",
        "V",
        "drawn",
        "draws",
        "misses/drawn",
        "misses/face",
        "paper ms",
    ];
    let mut rows = vec![head(&columns)];
    let mut json = Vec::new();
    for printed in &SPHERES {
        if skip_large && printed.face_count() > LARGE {
            continue;
        }
        let (faces, counted) = counted(printed);
        for it in counted {
            rows.push(vec![
                printed.faces.to_owned(),
                faces.to_string(),
                it.order.to_owned(),
                it.stripes
                    .map_or_else(String::new, |count| count.to_string()),
                format!("{:.3}", it.drawn),
                format!("{:.1}", it.draws),
                format!("{:.3}", it.misses_per_drawn),
                format!("{:.3}", it.misses_per_face),
                it.paper_ms
                    .map_or_else(String::new, |ms| format!("{ms:.2}")),
            ]);
            json.push(json!({
                "sphere": printed.faces, "faces": faces, "order": it.order, "stripes": it.stripes,
                "drawn": it.drawn, "draws": it.draws, "misses_per_drawn_face": it.misses_per_drawn,
                "misses_per_face": it.misses_per_face, "paper_ms": it.paper_ms,
            }));
        }
    }
    Figure {
        title: format!(
            "Spheres drawn whole and in V stripes of {RANGES} ranges, from 4r, means over {DIRECTIONS} directions: the share \
             that is drawn,\nthe calls, and what a FIFO cache of {CACHE} misses, of each face drawn and of each face of the \
             sphere. The paper's\nmilliseconds are of 125 spheres; a card's frame times are measured by `cull` of the program in gpu/. \
             On a sphere alone faces\nwith like normals are near each other, so here stripes cost no vertices: Table 4 has other meshes."
        ),
        rows,
        json: json!({"cache": CacheModel::fifo(CACHE).to_string(), "rows": json}),
    }
}

/// What is drawn, and by how many calls, by the number of ranges.
pub(super) fn fig_13(found: &[Found]) -> Figure {
    let mut rows = vec![head(&["", "V"])];
    rows[0].extend(RANGE_COUNTS.map(|count| format!("N = {count}")));
    let mut json = Vec::new();
    for it in found {
        let views = ViewFrom::uniform(DIRECTIONS, Some(DISTANCE));
        let mut stripes = 0;
        let counted = RANGE_COUNTS.map(|ranges| {
            let striped = StripedMesh::new(&it.mesh, None, ranges);
            stripes = striped.stripe_count();
            let drawn = |view: ViewFrom| it.share(striped.ranges(view).face_count());
            let draws = |view: ViewFrom| striped.ranges(view).as_slice().len() as f64;
            [mean_over(&views, drawn), mean_over(&views, draws)]
        });
        let mut row = vec![it.name.clone(), stripes.to_string()];
        row.extend(counted.map(|[drawn, draws]| format!("{drawn:.4} / {draws:.1}")));
        rows.push(row);
        json.push(json!({
            "mesh": it.name, "stripes": stripes,
            "drawn": counted.map(|[drawn, _]| drawn), "draws": counted.map(|[_, draws]| draws),
        }));
    }
    Figure {
        title: format!(
            "The share of the faces that is drawn, and the calls, by the number of ranges, from 4r, means over {DIRECTIONS} \
             directions;\nV by the paper's rule. The paper shows frame times that fall with N."
        ),
        rows,
        json: json!({"range_counts": RANGE_COUNTS, "rows": json}),
    }
}
