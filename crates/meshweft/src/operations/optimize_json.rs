//! What was optimised, as JSON.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use super::json;
use super::optimize::{OptimizeReport, OptimizedMesh};
use crate::cache::ratio;
use crate::permutation::VertexOrder;

impl OptimizeReport {
    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let meshes = 0..self.meshes.len();
        let mode = self.options.greedy.unwrap_or_default().mode;
        let mut report = self.of_file.json_head("optimize");
        let mut insert = |key: &str, value: Value| report.insert(key.into(), value);
        insert("cache", json!(self.options.target.to_string()));
        insert("effort", json!(self.options.effort.to_string()));
        insert("mode", json!(mode.to_string()));
        insert("stopped", json!(self.is_stopped));
        insert("meshes", Value::Null);
        insert("total", self.total_json_value());
        let worse_in = self.worse_in().map(|model| json!(model.to_string()));
        insert("worse_in", worse_in.collect());
        insert("notes", json::notes(&self.of_file.notes));
        json::with_list(&report, "meshes", meshes.map(|mesh| self.mesh_json(mesh)))
    }

    /// What was counted on all meshes together, before and after, as one line of JSON: the member
    /// `total` of the report.
    #[must_use]
    pub fn total_to_json(&self) -> String {
        self.total_json_value().to_string()
    }

    fn total_json_value(&self) -> Value {
        Value::Object(json::change(&self.total.before, &self.total.after))
    }

    fn mesh_json(&self, number: usize) -> Value {
        let mesh: &OptimizedMesh = &self.meshes[number];
        let vertices_moved = self.vertex_order(number).is_some();
        let mut object = json::change(&mesh.change.before, &mesh.change.after);
        object.shift_insert(0, "name".into(), json!(mesh.name));
        if let Some(level) = mesh.level {
            object.shift_insert(1, "level".into(), json!(level.number));
            object.shift_insert(2, "level_of".into(), json!(level.of));
        }
        object.insert("changed".into(), json!(mesh.is_changed()));
        object.insert("vertices_moved".into(), json!(vertices_moved));
        if let Some(reason) = mesh.reason {
            object.insert("reason".into(), json!(reason));
        }
        if let Some(pushes) = mesh.scheduled {
            let per_face = ratio(pushes, mesh.change.after.faces);
            object.insert("scheduled".into(), json!(per_face));
        }
        Value::Object(object)
    }

    /// Where every face record and vertex went, as one line of JSON: `out[i] = in[new_to_old[i]]`.
    ///
    /// The vertex order of meshes that share their vertices is that of the first of them, to which the
    /// others refer by number, `vertex_order_of`.
    #[must_use]
    pub fn permutations_to_json(&self) -> String {
        let mut first_of_group = BTreeMap::new();
        let meshes = self.meshes.iter().enumerate().map(|(i, mesh)| {
            let order = &mesh.faces;
            let rotations: Vec<u8> = (0..order.len()).map(|i| order.rotation(i)).collect();
            let first = *first_of_group.entry(mesh.vertex_group).or_insert(i);
            let vertices = self.vertex_order(i);
            let mut object = json!({
                "name": mesh.name,
                "face_new_to_old": order.new_to_old(),
                "corner_rotations": rotations,
                "vertex_new_to_old": vertices.filter(|_| first == i).map(VertexOrder::new_to_old),
            });
            if vertices.is_some() && first != i {
                object["vertex_order_of"] = json!(first);
            }
            object
        });
        let convention = "out[i] = in[new_to_old[i]]; new corner j = old corner (j + rotation) % 3";
        let mut report = Map::new();
        report.insert("schema".into(), json!(json::SCHEMA));
        report.insert(
            "file".into(),
            json!(self.of_file.file.display().to_string()),
        );
        report.insert("convention".into(), json!(convention));
        report.insert("meshes".into(), Value::Null);
        json::with_list(&report, "meshes", meshes)
    }
}
