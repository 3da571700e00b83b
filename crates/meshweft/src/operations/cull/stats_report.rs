//! What culling tables leave out, as a report.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::options::CullStatsOptions;
use super::views::{CACHE, ViewSums};
use crate::files::Note;
use crate::operations::json;

/// What [`cull_stats`](super::cull_stats) counted.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CullStatsReport {
    /// The file.
    pub file: PathBuf,
    /// Its size and that of the buffers beside it that were read.
    pub bytes: u64,
    /// From where it was looked at.
    pub options: CullStatsOptions,
    /// Each table that can be used, of the primitives of all meshes.
    pub meshes: Vec<CullingFigures>,
    /// How many meshes have none that can be used.
    pub without: usize,
    /// Tables that cannot be used, or leave out what is seen: which and where.
    pub wrong: Vec<Note>,
    /// All tables together, the faces of each seen from as far in their own radii.
    pub total: CullingFigures,
    /// What the reader of the file leaves as it is.
    pub notes: Vec<Note>,
}

/// What a culling table leaves out.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CullingFigures {
    /// What the file calls the mesh.
    pub name: String,
    /// How many faces it has.
    pub faces: usize,
    /// How many clusters its table has.
    pub clusters: usize,
    /// Misses of the whole mesh in a first-in first-out cache of 16 vertices.
    pub whole_misses: u64,
    /// Sums over the views of each distance, in the order of the options.
    pub views: Vec<ViewSums>,
}

impl CullingFigures {
    pub(super) fn none(name: &str, distances: usize) -> Self {
        Self {
            name: name.to_owned(),
            faces: 0,
            clusters: 0,
            whole_misses: 0,
            views: vec![ViewSums::default(); distances],
        }
    }

    /// Adds those of another mesh, seen in the same views.
    pub(super) fn add(&mut self, other: &Self) {
        self.faces += other.faces;
        self.clusters += other.clusters;
        self.whole_misses += other.whole_misses;
        for (sum, view) in self.views.iter_mut().zip(&other.views) {
            let views = sum.views.max(view.views);
            sum.add(view);
            sum.views = views;
        }
    }

    /// Misses of the whole mesh per face.
    #[must_use]
    pub fn whole_misses_per_face(&self) -> f64 {
        self.whole_misses as f64 / self.faces.max(1) as f64
    }

    /// Draws of a view at a distance of the options, by its number.
    #[must_use]
    pub fn draws(&self, distance: usize) -> f64 {
        let view = &self.views[distance];
        view.draws as f64 / view.views.max(1) as f64
    }

    fn json(&self, distances: &[f64]) -> Value {
        let views = distances.iter().zip(&self.views).enumerate();
        let views = views.map(|(number, (distance, view))| {
            json!({
                "distance": distance.is_finite().then_some(distance),
                "drawn": view.drawn_share(),
                "back_faces_rejected": view.back_rejected_share(),
                "front_faces_rejected": view.wrongly_rejected,
                "draws": self.draws(number),
                "misses_per_face": view.misses_per_face(),
            })
        });
        json!({
            "name": self.name,
            "faces": self.faces,
            "clusters": self.clusters,
            "whole_misses_per_face": self.whole_misses_per_face(),
            "views": views.collect::<Value>(),
        })
    }
}

impl CullStatsReport {
    /// Whether every table can be used, and leaves out no face that faces the eye.
    #[must_use]
    pub fn is_true(&self) -> bool {
        self.wrong.is_empty()
    }

    /// The report as one line of JSON. An orthographic view has the distance `null`.
    #[must_use]
    pub fn to_json(&self) -> String {
        let distances = &self.options.distances;
        let mut report = json::head("cull stats");
        report.insert("file".into(), json!(self.file.display().to_string()));
        report.insert("bytes".into(), json!(self.bytes));
        report.insert("eyes".into(), json!(self.options.eyes));
        report.insert("cache".into(), json!(CACHE.to_string()));
        report.insert("meshes".into(), Value::Null);
        report.insert("without_table".into(), json!(self.without));
        report.insert("wrong_tables".into(), json::notes(&self.wrong));
        report.insert("total".into(), self.total.json(distances));
        report.insert("notes".into(), json::notes(&self.notes));
        let meshes = self.meshes.iter().map(|mesh| mesh.json(distances));
        json::with_list(&report, "meshes", meshes)
    }
}
