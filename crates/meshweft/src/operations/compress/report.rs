//! What a compression did.

use std::path::PathBuf;

use serde_json::{Map, Value, json};

use super::options::{CompressOptions, PositionPrecision};
use crate::compression::{CodeSizes, KeepOrder, PolygonCounts, Tier};
use crate::files::Note;
use crate::operations::json;

/// What [`compress`](super::compress) did. The caller may add where it went and the time it took.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CompressReport {
    /// The file that was read.
    pub file: PathBuf,
    /// The file that was written: set by the caller.
    pub output: Option<PathBuf>,
    /// Size of the file and of the buffers beside it that were read.
    pub bytes_before: u64,
    /// Size of the archive.
    pub bytes_after: u64,
    /// How long it took: set by the caller, who has a clock.
    pub seconds: Option<f64>,
    /// What was asked for.
    pub options: CompressOptions,
    /// The step of the lattice, if positions are on one.
    pub step: Option<f64>,
    /// Each mesh.
    pub meshes: Vec<CompressedMesh>,
    /// What the reader of the file says.
    pub notes: Vec<Note>,
}

/// A mesh that was compressed.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CompressedMesh {
    /// What the file calls it.
    pub name: String,
    /// How many vertices.
    pub vertices: usize,
    /// How many faces.
    pub faces: usize,
    /// Its bytes.
    pub bytes: usize,
    /// What they are for.
    pub sizes: CodeSizes,
    /// How many polygons of more than three corners come back, and how many as triangles.
    pub polygons: PolygonCounts,
    /// How many vertices the first-in first-out buffer holds with which each is sent once.
    pub buffer_size: usize,
}

impl CompressedMesh {
    /// Bits of the faces, a face; 0 without faces.
    #[must_use]
    pub fn connectivity_bits(&self) -> f64 {
        self.sizes.connectivity * 8.0 / self.faces.max(1) as f64
    }

    /// Bits of the polygons, a polygon of more than three corners; 0 without them.
    #[must_use]
    pub fn polygon_bits(&self) -> f64 {
        self.sizes.polygons * 8.0 / self.polygons.kept.max(1) as f64
    }

    /// Bits of the positions, a vertex; 0 without vertices.
    #[must_use]
    pub fn position_bits(&self) -> f64 {
        self.sizes.positions * 8.0 / self.vertices.max(1) as f64
    }
}

impl CompressReport {
    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut report = json::file_head(
            "compress",
            [Some(&self.file), self.output.as_deref()],
            (self.bytes_before, Some(self.bytes_after)),
            0,
            self.seconds,
        );
        let positions = match self.options.positions {
            PositionPrecision::Lossless => json!("lossless"),
            PositionPrecision::Bits(bits) => json!({"bits": bits, "step": self.step}),
            PositionPrecision::Step(step) => json!({"step": step}),
        };
        report.insert("tier".into(), json!(tier_name(self.options.tier)));
        report.insert("positions".into(), positions);
        report.insert(
            "keep_order".into(),
            json!(order_name(self.options.keep_order)),
        );
        report.insert("meshes".into(), Value::Null);
        report.insert("notes".into(), json::notes(&self.notes));
        json::with_list(&report, "meshes", self.meshes.iter().map(mesh_to_json))
    }
}

fn mesh_to_json(mesh: &CompressedMesh) -> Value {
    let members = [
        ("name", json!(mesh.name)),
        ("vertices", json!(mesh.vertices)),
        ("faces", json!(mesh.faces)),
        ("bytes", json!(mesh.bytes)),
        (
            "connectivity_bits_per_face",
            json!(mesh.connectivity_bits()),
        ),
        ("position_bits_per_vertex", json!(mesh.position_bits())),
        ("polygons", json!(mesh.polygons.kept)),
        ("polygons_cut", json!(mesh.polygons.cut)),
        ("polygon_bytes", json!(mesh.sizes.polygons)),
        ("order_bytes", json!(mesh.sizes.order)),
        ("buffer_size", json!(mesh.buffer_size)),
    ];
    let members = members.map(|(key, value)| (key.to_owned(), value));
    Value::Object(Map::from_iter(members))
}

/// What of the order is kept, as flags and reports name it.
fn order_name(keep: KeepOrder) -> Option<&'static str> {
    match keep {
        KeepOrder::Nothing => None,
        KeepOrder::Faces => Some("faces"),
        KeepOrder::Vertices => Some("vertices"),
        KeepOrder::Both => Some("both"),
    }
}

/// The tier as flags and reports name it.
fn tier_name(tier: Tier) -> &'static str {
    match tier {
        Tier::Fast => "fast",
        #[cfg(feature = "default-tier")]
        Tier::Default => "default",
    }
}
