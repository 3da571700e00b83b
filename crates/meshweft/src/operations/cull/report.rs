//! What became of the meshes of a document.

use serde_json::{Value, json};

use super::options::CullOptions;
use crate::culling::SampledEyes;
use crate::files::MeshEntry;
use crate::operations::file_report::FileReport;
use crate::operations::json;
use crate::permutation::FaceOrder;

/// What [`cull_build`](super::cull_build) did. The caller may add where it went, its size there and the time it took.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CullReport {
    /// The file, and where it went.
    pub of_file: FileReport,
    /// What was asked for.
    pub options: CullOptions,
    /// What the GLB does not have that was made of a file of another format.
    pub lost: Vec<String>,
    /// Each mesh.
    pub meshes: Vec<CulledMesh>,
    /// Whether the caller stopped it before all meshes had tables.
    pub is_stopped: bool,
}

/// A mesh, and what became of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CulledMesh {
    /// What the file calls it.
    pub name: String,
    /// How many faces it has.
    pub face_count: usize,
    /// How many clusters its table has; 0 without one.
    pub clusters: usize,
    /// The order that its face records were put in.
    pub faces: FaceOrder,
    /// What became of it.
    pub outcome: CullOutcome,
}

/// What became of a mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum CullOutcome {
    /// Its faces are in clusters, each drawn from where it may be seen.
    Clusters,
    /// Its faces keep their order and are always drawn: why.
    AlwaysDrawn(&'static str),
    /// It has no table: why.
    Left(String),
}

impl CullOutcome {
    /// Why its faces are not in clusters, if so.
    #[must_use]
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Clusters => None,
            Self::AlwaysDrawn(why) => Some(why),
            Self::Left(why) => Some(why),
        }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Clusters => "clusters",
            Self::AlwaysDrawn(_) => "always_drawn",
            Self::Left(_) => "left",
        }
    }
}

impl CulledMesh {
    /// One that stays as it is.
    pub(super) fn left(entry: &MeshEntry, why: String) -> Self {
        Self {
            name: entry.name.clone(),
            face_count: entry.mesh.face_count(),
            clusters: 0,
            faces: FaceOrder::identity(entry.record_count()),
            outcome: CullOutcome::Left(why),
        }
    }

    fn json(&self) -> Value {
        json!({
            "name": self.name,
            "faces": self.face_count,
            "clusters": self.clusters,
            "outcome": self.outcome.name(),
            "reason": self.outcome.reason(),
        })
    }
}

impl CullReport {
    /// Whether any mesh has a table.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.meshes.iter().any(|mesh| mesh.clusters > 0)
    }

    /// How many meshes, faces and clusters there are with this in common.
    #[must_use]
    pub fn count(&self, which: impl Fn(&CullOutcome) -> bool) -> [usize; 3] {
        let meshes = self.meshes.iter().filter(|mesh| which(&mesh.outcome));
        meshes.fold([0; 3], |[meshes, faces, clusters], mesh| {
            [
                meshes + 1,
                faces + mesh.face_count,
                clusters + mesh.clusters,
            ]
        })
    }

    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut report = self.of_file.json_head("cull build");
        let clusters = &self.options.clusters;
        report.insert("eyes".into(), eyes(&clusters.eyes));
        report.insert("face_cost".into(), json!(clusters.face_cost));
        report.insert("draw_cost".into(), json!(clusters.draw_cost));
        let target = clusters.optimizer.target.to_string();
        report.insert("cache".into(), json!(target));
        report.insert("stripes".into(), json!(self.options.stripes));
        report.insert("stopped".into(), json!(self.is_stopped));
        report.insert("lost".into(), json!(self.lost));
        report.insert("meshes".into(), Value::Null);
        report.insert("total".into(), self.total());
        report.insert("notes".into(), json::notes(&self.of_file.notes));
        json::with_list(&report, "meshes", self.meshes.iter().map(CulledMesh::json))
    }

    /// The sums over all meshes, as one line of JSON: the member `total` of the report.
    #[must_use]
    pub fn total_to_json(&self) -> String {
        self.total().to_string()
    }

    fn total(&self) -> Value {
        let [_, faces, clusters] = self.count(|_| true);
        let of = |which: fn(&CullOutcome) -> bool| {
            let [meshes, faces, _] = self.count(which);
            json!({"meshes": meshes, "faces": faces})
        };
        json!({
            "faces": faces,
            "clusters": clusters,
            "in_clusters": of(|it| matches!(it, CullOutcome::Clusters)),
            "always_drawn": of(|it| matches!(it, CullOutcome::AlwaysDrawn(_))),
            "left": of(|it| matches!(it, CullOutcome::Left(_))),
        })
    }
}

/// For which eyes clusters were made. An orthographic view has the distance `null`.
fn eyes(eyes: &SampledEyes) -> Value {
    match eyes {
        SampledEyes::Around(spheres) => spheres
            .iter()
            .map(|(distance, count)| {
                json!({"distance": distance.is_finite().then_some(distance), "count": count})
            })
            .collect(),
        SampledEyes::These(eyes) => eyes.iter().map(|eye| json!(eye.point)).collect(),
    }
}
