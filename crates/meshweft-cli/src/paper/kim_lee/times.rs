//! Table 1 and Fig. 9: how long it takes to put faces in stripes.

use std::time::Instant;

use meshweft::operations::StripedMesh;
use serde_json::json;

use super::found::{Found, RANGES};
use crate::paper::figure::{Figure, head};

/// So often each is measured; the middle one counts.
const RUNS: usize = 3;

/// Seconds, by number of faces.
pub(super) fn table_1(found: &[Found]) -> Figure {
    let columns = ["", "F", "V", "paper s", "ours s", "paper ns/face", "ours"];
    let mut rows = vec![head(&columns)];
    let mut json = Vec::new();
    for it in found {
        let mut stripe_count = 0;
        let mut once = || {
            let start = Instant::now();
            let striped = StripedMesh::new(&it.mesh, None, RANGES);
            let seconds = start.elapsed().as_secs_f64();
            stripe_count = striped.stripe_count();
            seconds
        };
        let mut seconds = [(); RUNS].map(|()| once());
        seconds.sort_by(f64::total_cmp);
        let seconds = seconds[RUNS / 2];

        let faces = it.mesh.face_count();
        let printed = it.printed;
        rows.push(vec![
            it.name.clone(),
            faces.to_string(),
            stripe_count.to_string(),
            format!("{:.3}", printed.seconds),
            format!("{seconds:.4}"),
            format!("{:.0}", 1e9 * printed.seconds / printed.faces as f64),
            format!("{:.0}", 1e9 * seconds / faces as f64),
        ]);
        json.push(json!({
            "mesh": it.name, "faces": faces, "stripes": stripe_count, "seconds": seconds,
            "paper": {"faces": printed.faces, "seconds": printed.seconds},
        }));
    }
    Figure {
        title: "Pre-computation, also Fig. 9: seconds to put the faces in stripes, by the number of faces; V by the \
                paper's\nrule. * another version of the paper's mesh, with another number of faces."
            .to_owned(),
        rows,
        json: json!(json),
    }
}
