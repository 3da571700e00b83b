//! What levels a document got.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde_json::{Map, Value, json};

use super::made::MadeLevels;
use super::options::{LevelGoals, LevelsOptions};
use crate::files::MeshEntry;
use crate::operations::counts::{Counts, USUAL_CACHES};
use crate::operations::file_report::FileReport;
use crate::operations::json;

/// What [`levels`](super::levels) did. The caller may add where it went, its size there and the time it took.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LevelsReport {
    /// The file, and where it went.
    pub of_file: FileReport,
    /// What was asked for.
    pub options: LevelsOptions,
    /// What a GLB of the document does not have of it, if one was made.
    pub lost: Vec<String>,
    /// The levels of the file, the full one first.
    pub levels: Vec<FileLevel>,
    /// What got coarser together, or stayed.
    pub objects: Vec<LeveledObject>,
    /// The files of the levels, if each has one of its own: set by the caller.
    pub files: Vec<PathBuf>,
    /// How many faces there are at the coarsest, where that is more than asked for.
    pub floor: Option<usize>,
    /// Whether the caller stopped it before it was done.
    pub is_stopped: bool,
}

/// A level of a file: all that is drawn at it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FileLevel {
    /// 0 is the full one.
    pub number: usize,
    /// How far it is from the full one as it is drawn, the largest of all objects, in units of the scene.
    pub error: f64,
    /// What is counted of it. Its vertices are those that a reader needs: the first ones of each vertex view, up to the last
    /// that is used.
    pub counts: Counts,
}

/// An object and its levels.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LeveledObject {
    /// The name of its first mesh.
    pub name: String,
    /// The numbers of its meshes.
    pub meshes: Vec<usize>,
    /// The faces of each level, the full one first. Just these if it has no other level.
    pub faces: Vec<usize>,
    /// How far each level is from it, in units of its positions.
    pub errors: Vec<f64>,
    /// How many units of the scene one of these is.
    pub scale: f64,
    /// Why it is the same at all levels, if it cannot get coarser.
    pub refused: Option<String>,
}

/// What a report is made of.
pub(super) struct LevelsParts<'a> {
    pub(super) of_file: FileReport,
    pub(super) options: &'a LevelsOptions,
    pub(super) lost: Vec<String>,
    pub(super) made: MadeLevels,
    /// The name of the first mesh of each object.
    pub(super) names: Vec<String>,
    /// Of each level, the full one first.
    pub(super) counts: Vec<Counts>,
    pub(super) is_stopped: bool,
}

impl LevelsReport {
    pub(super) fn new(parts: LevelsParts<'_>) -> Self {
        let objects = parts.made.objects.iter().zip(parts.names);
        let objects = objects.map(|(object, name)| {
            let faces = object.levels.iter().map(|level| level.faces);
            let errors = object.levels.iter().map(|level| level.error);
            LeveledObject {
                name,
                meshes: object.meshes.clone(),
                faces: [object.faces].into_iter().chain(faces).collect(),
                errors: [0.0].into_iter().chain(errors).collect(),
                scale: object.scale,
                refused: object.stop.as_ref().err().cloned(),
            }
        });
        let objects: Vec<LeveledObject> = objects.collect();
        let level = |(number, counts): (usize, Counts)| {
            let errors = objects.iter().map(|object| {
                let last = object.errors.len() - 1;
                object.errors[number.min(last)] * object.scale
            });
            FileLevel {
                error: errors.fold(0.0, f64::max),
                number,
                counts,
            }
        };
        let levels = parts.counts.into_iter().enumerate().map(level).collect();
        Self {
            of_file: parts.of_file,
            options: parts.options.clone(),
            lost: parts.lost,
            files: Vec::new(),
            floor: parts.made.floor,
            is_stopped: parts.is_stopped,
            levels,
            objects,
        }
    }

    /// Whether there are levels below the full one.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.levels.len() > 1
    }

    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut report = self.of_file.json_head("levels");
        let mut insert = |key: &str, value: Value| report.insert(key.into(), value);
        let (key, goals) = goals(&self.options.goals);
        insert(key, goals);
        insert("lock_border", json!(self.options.lock_border));
        insert("drop_parts", json!(self.options.drop_parts));
        insert("cross_seams", json!(self.options.cross_seams));
        insert("cache", json!(self.options.optimizer.target.to_string()));
        insert("effort", json!(self.options.optimizer.effort.to_string()));
        insert("stopped", json!(self.is_stopped));
        insert("lost", json!(self.lost));
        let files = self.files.iter().map(|file| file.display().to_string());
        insert("files", files.collect());
        insert("floor", json!(self.floor));
        insert("levels", self.levels.iter().map(FileLevel::json).collect());
        insert("objects", Value::Null);
        insert("notes", json::notes(&self.of_file.notes));
        let objects = self.objects.iter().map(LeveledObject::json);
        json::with_list(&report, "objects", objects)
    }

    /// The levels of the file as one line of JSON: the member `levels` of the report.
    #[must_use]
    pub fn total_to_json(&self) -> String {
        let levels = self.levels.iter().map(FileLevel::json);
        json!({ "levels": levels.collect::<Value>() }).to_string()
    }
}

impl FileLevel {
    fn json(&self) -> Value {
        let mut object = Map::new();
        object.insert("level".into(), json!(self.number));
        object.insert("error".into(), json!(self.error));
        object.append(&mut self.counts.json());
        Value::Object(object)
    }
}

impl LeveledObject {
    fn json(&self) -> Value {
        json!({
            "name": self.name,
            "meshes": self.meshes,
            "faces": self.faces,
            "errors": self.errors,
            "scale": self.scale,
            "reason": self.refused,
        })
    }
}

/// What was asked for: the name and the list.
fn goals(goals: &LevelGoals) -> (&'static str, Value) {
    match goals {
        LevelGoals::Ratios(ratios) => ("ratios", json!(ratios)),
        LevelGoals::Faces(counts) => ("faces", json!(counts)),
        LevelGoals::Errors(errors) => {
            let texts = errors.iter().map(ToString::to_string);
            ("errors", texts.collect())
        }
    }
}

/// The counts of what is drawn at a level.
pub(super) fn counts_of(drawn: &[MeshEntry], options: &LevelsOptions) -> Counts {
    let mut models = options.optimizer.target.models().to_vec();
    let usual = USUAL_CACHES.into_iter();
    let usual: Vec<_> = usual.filter(|model| !models.contains(model)).collect();
    models.extend(usual);
    let counts = Counts::of_each(drawn, &models);
    let mut total = Counts::total(drawn, &counts, &models);
    total.vertices = needed_vertices(drawn);
    total
}

/// How many vertices a reader needs to draw these, from the beginning of each group.
fn needed_vertices(drawn: &[MeshEntry]) -> usize {
    let mut of_groups = BTreeMap::new();
    for entry in drawn {
        let largest = entry.mesh.faces().as_flattened().iter().max();
        let needed = largest.map_or(0, |&largest| largest as usize + 1);
        let most: &mut usize = of_groups.entry(entry.vertex_group).or_default();
        *most = needed.max(*most);
    }
    of_groups.values().sum()
}
