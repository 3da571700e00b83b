//! Tables 1 to 3.

use serde_json::json;

use super::policy_order::PolicyOrder;
use super::printed::MODELS;
use super::walked::{NAMES, PathWalk, Walked, bytes};
use crate::paper::figure::{Figure, head};

/// Vertices and faces.
pub(super) fn table_1(walked: &[Walked]) -> Figure {
    let mut rows = vec![head(&[
        "",
        "paper: vertices",
        "faces",
        "ours: vertices",
        "faces",
        "coarsest",
        "s",
    ])];
    let mut json = Vec::new();
    for it in walked {
        let of_paper = it.printed.map(|printed| [printed.vertices, printed.faces]);
        let seconds = it.walks[0].reports[0].build_seconds;
        let mut row = vec![it.name.clone()];
        row.extend(match of_paper {
            Some(counts) => counts.map(|count| count.to_string()),
            None => ["", ""].map(str::to_owned),
        });
        let ours = [it.mesh.vertices, it.mesh.faces, it.mesh.roots];
        row.extend(ours.map(|count| count.to_string()));
        row.push(format!("{seconds:.1}"));
        rows.push(row);
        json.push(json!({
            "mesh": it.name, "vertices": it.mesh.vertices, "faces": it.mesh.faces,
            "coarsest_vertices": it.mesh.roots, "build_seconds": seconds,
            "paper": of_paper.map(|[vertices, faces]| json!({"vertices": vertices, "faces": faces})),
        }));
    }
    Figure {
        title: "The meshes, the vertices of the coarsest level, and the seconds that it takes to make all levels. * another\n\
                version of the paper's mesh. Faces with two corners at one place are left out."
            .to_owned(),
        rows,
        json: json!(json),
    }
}

/// Inserts.
pub(super) fn table_2(walked: &[Walked]) -> Figure {
    let mut rows = vec![head(&["", "px", "path", "most active", "different"])];
    rows[0].extend(head(&NAMES));
    rows[0].extend(head(&["fewest", "FA >= LRU >= queue"]));

    // The paper's own.
    for printed in &MODELS {
        for (inserts, letter) in printed.inserts.iter().flatten().zip(["A", "B", "C"]) {
            let verdict = PolicyOrder::of(*inserts, false, None).verdict();
            let [first, lru, queue] = inserts.map(|count| count.to_string());
            rows.push(
                [
                    &format!("{}, paper", printed.mesh),
                    "1.5",
                    letter,
                    "",
                    "",
                    "",
                ]
                .into_iter()
                .chain([first.as_str(), &lru, &queue, "", "", verdict])
                .map(str::to_owned)
                .collect(),
            );
        }
    }

    // Ours.
    let mut json = Vec::new();
    let mut limited_walks = 0;
    for it in walked {
        for walk in &it.walks {
            let inserts = walk.inserts();
            let of_paper = [1, 2, 3].map(|policy| inserts[policy]);
            let fits = walk.distinct <= walk.slots();
            let order = PolicyOrder::of(of_paper, fits, walk.fewest);
            let reason = order.text();
            let limited = if walk.limited > 0 { "+" } else { "" };
            limited_walks += usize::from(walk.limited > 0);
            let mut row = vec![
                it.name.clone(),
                walk.tolerance.to_string(),
                format!("{}*", walk.letter()),
                format!("{}{limited}", walk.most_active),
                walk.distinct.to_string(),
            ];
            row.extend(inserts.iter().map(u64::to_string));
            row.push(
                walk.fewest
                    .map_or_else(String::new, |fewest| fewest.to_string()),
            );
            row.push(reason.clone());
            rows.push(row);
            json.push(json!({
                "mesh": it.name, "tolerance": walk.tolerance, "path": walk.letter(),
                "most_active": walk.most_active, "limited_frames": walk.limited,
                "distinct_vertices": walk.distinct, "inserts": named(&inserts),
                "fewest_inserts": walk.fewest, "ordered": order.is_as_there, "order": reason,
            }));
        }
    }
    let limited = match limited_walks {
        0 => "",
        _ => {
            "\n+ frames that need more vertices than there are slots have the best mesh that fits."
        }
    };
    Figure {
        title: format!(
            "Vertices inserted into {} slots on all {} frames. Paths A circle, B small turns, C in and out; * the paper only \
             draws\nits own, these are of that kind. different: vertices that are active in any frame; fewest: what no policy can \
             beat. The\npaper needs 32,768 vertices at 1.5 px; here that tolerance needs far fewer, and the other one is nearer \
             to that load.{limited}",
            slots(walked),
            frames(walked),
        ),
        rows,
        json: json!(json),
    }
}

/// The rendering stage by bytes.
pub(super) fn table_3(walked: &[Walked]) -> Figure {
    let mut rows = vec![head(&[
        "",
        "px",
        "path",
        "policy",
        "vertex bytes",
        "index bytes",
        "fewer bytes",
        "all indices",
        "paper: faster",
    ])];
    let mut json = Vec::new();
    for it in walked {
        for walk in &it.walks {
            let means = FrameMeans::of(walk);
            let paper = |policy: usize| {
                let speed_ups = it.printed?.speed_ups[walk.path];
                speed_ups.get(policy).copied()
            };
            for (policy, name) in NAMES.into_iter().enumerate() {
                let mean = means.row(policy);
                rows.push(vec![
                    it.name.clone(),
                    walk.tolerance.to_string(),
                    format!("{}*", walk.letter()),
                    name.to_owned(),
                    format!("{:.0}", mean.vertex_bytes),
                    format!("{:.0}", mean.index_bytes),
                    format!("{:.1}", mean.fewer),
                    format!("{:.1}", mean.fewer_with_all_indices),
                    paper(policy).map_or_else(String::new, |times| format!("{times:.2}")),
                ]);
                json.push(json!({
                    "mesh": it.name, "tolerance": walk.tolerance, "path": walk.letter(), "policy": name,
                    "vertex_bytes": mean.vertex_bytes, "index_bytes": mean.index_bytes,
                    "times_fewer": mean.fewer, "times_fewer_with_all_indices": mean.fewer_with_all_indices,
                    "paper_times_faster": paper(policy),
                }));
            }
        }
    }
    Figure {
        title: "The rendering stage. The paper: how many times faster than immediate mode. Ours: bytes of vertices (36 each) and \
                of\nindices a frame, means of all frames, and how many times fewer bytes than immediate mode, which sends three \
                vertices a face.\nall indices: the same if the whole index array is sent in every frame, as in the paper; here \
                only faces that change are.\nA card's times are not measured here; Fig. 7 has those of slots and indices."
            .to_owned(),
        rows,
        json: json!(json),
    }
}

/// Means of all frames, of each policy.
struct FrameMeans {
    vertex_bytes: Vec<f64>,
    index_bytes: Vec<f64>,
    all: Vec<f64>,
    faces: f64,
    vertex_size: f64,
    index_size: f64,
}

/// Those of one policy.
struct PolicyMeans {
    vertex_bytes: f64,
    index_bytes: f64,
    fewer: f64,
    fewer_with_all_indices: f64,
}

impl FrameMeans {
    fn of(walk: &PathWalk) -> Self {
        Self {
            vertex_bytes: walk.means(|frame| frame.vertex_bytes as f64),
            index_bytes: walk.means(|frame| frame.index_bytes as f64),
            all: walk.means(bytes),
            faces: walk.means(|frame| frame.faces as f64)[0],
            vertex_size: walk.reports[0].options.vertex_size as f64,
            index_size: if walk.slots() > 1 << 16 { 4.0 } else { 2.0 },
        }
    }

    fn row(&self, policy: usize) -> PolicyMeans {
        let immediate = 3.0 * self.faces * self.vertex_size;
        let all_indices = 3.0 * self.faces * self.index_size;
        PolicyMeans {
            vertex_bytes: self.vertex_bytes[policy],
            index_bytes: self.index_bytes[policy],
            fewer: immediate / self.all[policy],
            fewer_with_all_indices: immediate / (self.vertex_bytes[policy] + all_indices),
        }
    }
}

/// A number of each policy, by its name.
pub(super) fn named<T: Copy + Into<serde_json::Value>>(values: &[T]) -> serde_json::Value {
    let members = NAMES.into_iter().zip(values);
    let members = members.map(|(name, &value)| (name.to_owned(), value.into()));
    serde_json::Value::Object(members.collect())
}

/// How many slots all walks have.
fn slots(walked: &[Walked]) -> usize {
    walked[0].walks[0].slots()
}

/// How many frames all walks have.
pub(super) fn frames(walked: &[Walked]) -> usize {
    walked[0].walks[0].reports[0].frames.len()
}
