//! What was simplified, as JSON.

use serde_json::{Map, Value, json};

use super::removals::Removals;
use super::report::{SimplifiedObject, SimplifyReport};
use crate::operations::json;
use crate::operations::optimize::CountChange;
use crate::progressive::StopReason;

impl SimplifyReport {
    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let options = &self.options;
        let mut report = self.of_file.json_head("simplify");
        let mut insert = |key: &str, value: Value| report.insert(key.into(), value);
        insert("ratio", json!(options.ratio));
        insert("faces", json!(options.faces));
        insert("error", json!(options.error.map(|error| error.to_string())));
        insert("cache", json!(options.ordering.target.to_string()));
        insert("effort", json!(options.ordering.effort.to_string()));
        insert("stopped", json!(self.is_stopped));
        insert("meshes", Value::Null);
        insert(
            "objects",
            self.objects.iter().map(SimplifiedObject::json).collect(),
        );
        insert("total", change(&self.total).into());
        insert("notes", json::notes(&self.of_file.notes));
        let meshes = self.meshes.iter().map(|mesh| {
            let mut object = change(&mesh.change);
            object.shift_insert(0, "name".into(), json!(mesh.name));
            Value::Object(object)
        });
        json::with_list(&report, "meshes", meshes)
    }

    /// What was counted on all meshes together, before and after, as one line of JSON: the member
    /// `total` of the report.
    #[must_use]
    pub fn total_to_json(&self) -> String {
        Value::Object(change(&self.total)).to_string()
    }

    /// Which vertices left, in which order, and what stands for them, as one line of JSON.
    ///
    /// For each mesh `vertex_new_to_old` (`out[i] = in[new_to_old[i]]`) and `fine_to_coarse`, both by numbers of
    /// the source; for each object the columns of its [`Removals`], if the options asked for
    /// them.
    #[must_use]
    pub fn removals_to_json(&self) -> String {
        let convention = "vertices by their numbers in the source: out[i] = in[vertex_new_to_old[i]]; \
                          fine_to_coarse[v] stands for v";
        let objects = self.objects.iter().map(|object| {
            json!({
                "meshes": object.meshes,
                "removals": object.removals.as_ref().map(Removals::json),
            })
        });
        let mut report = Map::new();
        report.insert("schema".into(), json!(json::SCHEMA));
        report.insert(
            "file".into(),
            json!(self.of_file.file.display().to_string()),
        );
        report.insert("convention".into(), json!(convention));
        report.insert("meshes".into(), Value::Null);
        report.insert("objects".into(), objects.collect());
        let meshes = self.meshes.iter().map(|mesh| {
            json!({
                "name": mesh.name,
                "vertex_new_to_old": mesh.vertices,
                "fine_to_coarse": mesh.fine_to_coarse,
            })
        });
        json::with_list(&report, "meshes", meshes)
    }
}

impl SimplifiedObject {
    fn json(&self) -> Value {
        let distances = self.distances.map(|found| {
            json!({
                "max": found.max,
                "mean": found.mean,
                "rms": found.rms,
                "points": found.points,
                "max_of_diagonal": self.of_diagonal(found.max),
                "mean_of_diagonal": self.of_diagonal(found.mean),
                "rms_of_diagonal": self.of_diagonal(found.rms),
            })
        });
        json!({
            "meshes": self.meshes,
            "faces": {"before": self.faces[0], "after": self.faces[1]},
            "goal": self.goal,
            "stop": match (&self.refused, self.stop) {
                (Some(_), _) => "refused",
                (None, StopReason::Faces) => "faces",
                (None, StopReason::Error) => "error",
                (None, StopReason::NothingLeft) => "nothing_left",
            },
            "reason": self.refused,
            "estimated_error": self.estimated_error,
            "distances": distances,
            "diagonal": self.diagonal,
        })
    }
}

/// What was counted, before and after.
fn change(change: &CountChange) -> Map<String, Value> {
    let mut object = json::change(&change.before, &change.after);
    let counts = [
        ("vertices", change.before.vertices, change.after.vertices),
        (
            "used_vertices",
            change.before.used_vertices,
            change.after.used_vertices,
        ),
        ("faces", change.before.faces, change.after.faces),
    ];
    for (key, before, after) in counts {
        object.insert(key.into(), json!({"before": before, "after": after}));
    }
    object
}
