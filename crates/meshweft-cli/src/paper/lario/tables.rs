//! Tables 1 to 5.

use serde_json::json;

use super::ground::WalkedGround;
use super::models::WalkedModel;
use super::policy_order::PolicyOrder;
use super::printed::{GROUND, MODELS};
use super::walked::{NAMES, PathWalk, Walked, bytes};
use crate::paper::figure::{Figure, head};

/// Vertices and faces.
pub(super) fn table_1(walked: &[WalkedModel]) -> Figure {
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
        let seconds = it.build_seconds;
        let mut row = vec![it.walked.name.clone()];
        row.extend(match of_paper {
            Some(counts) => counts.map(|count| count.to_string()),
            None => ["", ""].map(str::to_owned),
        });
        let ours = [it.mesh.vertices, it.mesh.faces, it.mesh.roots];
        row.extend(ours.map(|count| count.to_string()));
        row.push(format!("{seconds:.1}"));
        rows.push(row);
        json.push(json!({
            "mesh": it.walked.name, "vertices": it.mesh.vertices, "faces": it.mesh.faces,
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

/// The terrain, as table 1 has the meshes.
pub(super) fn terrain(ground: &WalkedGround) -> Figure {
    let facts = &ground.facts;
    let of_paper = (ground.walked.name.ends_with('*')).then_some(GROUND.vertices);
    let counts = &ground.counts;
    let [columns, rows] = facts.grid_size.map_or([None; 2], |size| size.map(Some));
    let count = |count: Option<u32>| count.map_or_else(String::new, |count| count.to_string());
    let head = head(&[
        "",
        "paper: vertices",
        "ours: vertices",
        "faces",
        "columns",
        "rows",
        "filled",
        "two heights",
        "s",
    ]);
    let row = vec![
        ground.walked.name.clone(),
        of_paper.map_or_else(String::new, |count| count.to_string()),
        facts.vertices.to_string(),
        facts.faces.to_string(),
        count(columns),
        count(rows),
        counts.filled.to_string(),
        counts.disagreeing.to_string(),
        format!("{:.1}", ground.build_seconds),
    ];
    Figure {
        title: "The terrain at full detail, and the seconds that it takes to make or open all levels. filled: places of height maps \
                without\na height, filled from around them; two heights: places where height maps differ, of which the first counts. * of \
                the same\nplace as the paper's, not the same heights: those are not at hand."
            .to_owned(),
        rows: vec![head, row],
        json: json!({
            "terrain": ground.walked.name, "vertices": facts.vertices, "faces": facts.faces,
            "columns": columns, "rows": rows, "filled": counts.filled, "disagreeing": counts.disagreeing,
            "build_seconds": ground.build_seconds, "paper": of_paper.map(|vertices| json!({"vertices": vertices})),
        }),
    }
}

/// Inserts around meshes.
pub(super) fn table_2(walked: &[&Walked]) -> Figure {
    let printed = MODELS.iter().filter_map(|it| Some((it.mesh, it.inserts?)));
    let printed: Vec<_> = printed.collect();
    let title = format!(
        "Vertices inserted into {} slots on all {} frames. Paths A circle, B small turns, C in and out; * the paper only draws\n\
         its own, these are of that kind. different: vertices that are active in any frame; fewest: what no policy can beat. The\n\
         paper needs 32,768 vertices at 1.5 px; here that tolerance needs far fewer, and the other one is nearer to that load.",
        slots(walked),
        frames(walked),
    );
    let overfull =
        "frames that need more vertices than there are slots have the best mesh that fits.";
    inserts_of("mesh", walked, &printed, ("1.5", title, overfull))
}

/// Inserts over terrain.
pub(super) fn table_4(walked: &[&Walked]) -> Figure {
    let title = format!(
        "Vertices inserted into {} slots on all {} frames over the terrain. Paths A circle, B turning in one place, C straight on;\n\
         * the paper only draws its own, these are of that kind. D, a flight to and fro, is ours. different: vertices that are\n\
         active in any frame; fewest: what no policy can beat.",
        slots(walked),
        frames(walked),
    );
    let overfull =
        "frames that need more vertices than there are slots have the best surface that fits.";
    let printed = [(GROUND.name, GROUND.inserts)];
    inserts_of("terrain", walked, &printed, ("1", title, overfull))
}

/// Inserts with every policy, below those that the paper printed. The words are the paper's tolerance, the title and what is said
/// of frames that do not fit.
fn inserts_of(
    kind: &str,
    walked: &[&Walked],
    printed: &[(&str, [[u64; 3]; 3])],
    (tolerance, mut title, overfull): (&str, String, &str),
) -> Figure {
    let mut rows = vec![head(&["", "px", "path", "most active", "different"])];
    rows[0].extend(head(&NAMES));
    rows[0].extend(head(&["fewest", "FA >= LRU >= queue"]));

    // The paper's own.
    for (name, inserts) in printed {
        for (inserts, letter) in inserts.iter().zip(["A", "B", "C"]) {
            let verdict = PolicyOrder::of(*inserts, false, None).verdict();
            let [first, lru, queue] = inserts.map(|count| count.to_string());
            let name = format!("{name}, paper");
            let row = [&name, tolerance, letter, "", "", ""];
            let of_policies = [first.as_str(), &lru, &queue, "", "", verdict];
            let row = row.into_iter().chain(of_policies);
            rows.push(row.map(str::to_owned).collect());
        }
    }

    // Ours.
    let mut json = Vec::new();
    for (it, walk) in all(walked) {
        let inserts = walk.inserts();
        let of_paper = [1, 2, 3].map(|policy| inserts[policy]);
        let fits = walk.distinct <= walk.slots;
        let order = PolicyOrder::of(of_paper, fits, walk.fewest);
        let reason = order.text();
        let plus = if walk.overfull > 0 { "+" } else { "" };
        let mut row = vec![
            it.name.clone(),
            walk.tolerance.to_string(),
            format!("{}*", walk.letter),
            format!("{}{plus}", walk.most_active),
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
            kind: it.name, "tolerance": walk.tolerance, "path": walk.letter,
            "most_active": walk.most_active, "limited_frames": walk.overfull,
            "distinct_vertices": walk.distinct, "inserts": named(&inserts),
            "fewest_inserts": walk.fewest, "ordered": order.is_as_there, "order": reason,
        }));
    }
    if all(walked).any(|(_, walk)| walk.overfull > 0) {
        title += &format!("\n+ {overfull}");
    }
    Figure {
        title,
        rows,
        json: json!(json),
    }
}

/// The rendering stage of meshes by bytes.
pub(super) fn table_3(walked: &[&Walked]) -> Figure {
    let title = "The rendering stage. The paper: how many times faster than immediate mode.";
    bytes_of("mesh", walked, title, "")
}

/// The rendering stage of terrain by bytes.
pub(super) fn table_5(walked: &[&Walked]) -> Figure {
    let title = "The rendering stage. The paper: how many times faster; it does not say than what.";
    let strips = " The paper's terrain is a strip, which has fewer indices.";
    bytes_of("terrain", walked, title, strips)
}

fn bytes_of(kind: &str, walked: &[&Walked], title: &str, more: &str) -> Figure {
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
    for (it, walk) in all(walked) {
        let means = FrameMeans::of(walk);
        for (policy, name) in NAMES.into_iter().enumerate() {
            let mean = means.row(policy);
            let faster = walk.faster[policy];
            rows.push(vec![
                it.name.clone(),
                walk.tolerance.to_string(),
                format!("{}*", walk.letter),
                name.to_owned(),
                format!("{:.0}", mean.vertex_bytes),
                format!("{:.0}", mean.index_bytes),
                format!("{:.1}", mean.fewer),
                format!("{:.1}", mean.fewer_with_all_indices),
                faster.map_or_else(String::new, |times| format!("{times:.2}")),
            ]);
            json.push(json!({
                kind: it.name, "tolerance": walk.tolerance, "path": walk.letter, "policy": name,
                "vertex_bytes": mean.vertex_bytes, "index_bytes": mean.index_bytes,
                "times_fewer": mean.fewer, "times_fewer_with_all_indices": mean.fewer_with_all_indices,
                "paper_times_faster": faster,
            }));
        }
    }
    Figure {
        title: format!(
            "{title} Ours: bytes of vertices ({} each) and\nof indices a frame, means of all frames, and how many times fewer bytes \
             than immediate mode, which sends three vertices a\nface. all indices: the same if the whole index array is sent in every \
             frame, as in the paper; here only faces that change\nare.{more} A card's times are not measured here; Fig. {} has those of \
             slots and indices.",
            walked[0].walks[0].vertex_size,
            if kind == "mesh" { "7" } else { "10" },
        ),
        rows,
        json: json!(json),
    }
}

/// Every walk, with what it is of.
pub(super) fn all<'a>(walked: &'a [&Walked]) -> impl Iterator<Item = (&'a Walked, &'a PathWalk)> {
    let walks = |it: &&'a Walked| {
        let it: &'a Walked = it;
        it.walks.iter().map(move |walk| (it, walk))
    };
    walked.iter().flat_map(walks)
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
            vertex_size: walk.vertex_size as f64,
            index_size: if walk.slots > 1 << 16 { 4.0 } else { 2.0 },
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
fn slots(walked: &[&Walked]) -> usize {
    walked[0].walks[0].slots
}

/// How many frames all walks have.
fn frames(walked: &[&Walked]) -> usize {
    walked[0].walks[0].frames[0].len()
}
