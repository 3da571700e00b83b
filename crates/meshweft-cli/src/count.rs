//! Counting misses of the meshes of a file.

use std::collections::BTreeMap;

use meshweft::files::MeshEntry;
use meshweft::{CacheModel, Mesh, cache};
use serde_json::{Map, Value, json};

/// Bytes of a vertex record that overfetch is counted for: position, normal, texture coordinates.
const VERTEX_SIZE: usize = 32;

/// What is counted on a mesh, or summed over meshes.
#[derive(Debug, Clone, Default)]
pub(crate) struct Counts {
    pub(crate) vertices: usize,
    pub(crate) used_vertices: usize,
    pub(crate) faces: usize,
    /// Misses under each model, in the order that was asked for.
    pub(crate) misses: Vec<(CacheModel, u64)>,
    overfetch: f64,
}

impl Counts {
    /// Counts one mesh.
    pub(crate) fn of(mesh: &Mesh, models: &[CacheModel]) -> Self {
        let faces = mesh.faces();
        let reports = models
            .iter()
            .map(|&model| (model, cache::report(faces, model)));
        let reports: Vec<_> = reports.collect();
        Self {
            vertices: mesh.vertex_count(),
            used_vertices: reports
                .first()
                .map_or(0, |(_, report)| report.used_vertices),
            faces: mesh.face_count(),
            misses: reports
                .iter()
                .map(|(model, report)| (*model, report.misses))
                .collect(),
            overfetch: cache::overfetch(faces, VERTEX_SIZE),
        }
    }

    /// The sum over meshes, vertices that several share counted once.
    pub(crate) fn total(entries: &[MeshEntry], counts: &[Self], models: &[CacheModel]) -> Self {
        let mut total = Self {
            misses: models.iter().map(|&model| (model, 0)).collect(),
            ..Self::default()
        };

        let mut groups: BTreeMap<usize, Vec<bool>> = BTreeMap::new();
        let mut fetched = 0.0;
        for (entry, count) in entries.iter().zip(counts) {
            let group = groups.entry(entry.vertex_group).or_insert_with(|| {
                total.vertices += count.vertices;
                vec![false; count.vertices]
            });

            for &vertex in entry.mesh.faces().iter().flatten() {
                let used = &mut group[vertex as usize];
                total.used_vertices += usize::from(!std::mem::replace(used, true));
            }

            total.faces += count.faces;
            for (sum, (_, misses)) in total.misses.iter_mut().zip(&count.misses) {
                sum.1 += misses;
            }
            fetched += count.overfetch * count.used_vertices as f64;
        }

        total.overfetch = ratio(fetched, total.used_vertices);
        total
    }

    /// Misses per face under each model.
    pub(crate) fn acmr(&self) -> impl Iterator<Item = (CacheModel, f64)> {
        self.misses
            .iter()
            .map(|&(model, misses)| (model, ratio(misses as f64, self.faces)))
    }

    /// Misses per used vertex under each model.
    pub(crate) fn atvr(&self) -> impl Iterator<Item = (CacheModel, f64)> {
        let used = self.used_vertices;
        self.misses
            .iter()
            .map(move |&(model, misses)| (model, ratio(misses as f64, used)))
    }

    /// The counts as the members of a JSON object.
    pub(crate) fn json(&self) -> Map<String, Value> {
        let mut object = Map::new();
        object.insert("vertices".into(), json!(self.vertices));
        object.insert("used_vertices".into(), json!(self.used_vertices));
        object.insert("faces".into(), json!(self.faces));
        let misses = self
            .misses
            .iter()
            .map(|(model, n)| (model.to_string(), json!(n)));
        object.insert("misses".into(), Value::Object(misses.collect()));
        object.insert("acmr".into(), by_model(self.acmr()));
        object.insert("atvr".into(), by_model(self.atvr()));
        object.insert("overfetch".into(), json!(self.overfetch));
        object
    }
}

/// An object from model names to numbers.
pub(crate) fn by_model(values: impl Iterator<Item = (CacheModel, f64)>) -> Value {
    let members = values.map(|(model, value)| (model.to_string(), json!(value)));
    Value::Object(members.collect())
}

/// `a / b`, 0 where there is nothing.
pub(crate) fn ratio(a: f64, b: usize) -> f64 {
    if b == 0 { 0.0 } else { a / b as f64 }
}
