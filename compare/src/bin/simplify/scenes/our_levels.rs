//! The levels that the library puts into a scene, as a reader finds them there.

use std::collections::BTreeMap;
use std::path::Path;

use meshweft::Budget;
use meshweft::Limits;
use meshweft::files::Document;
use meshweft::operations::{LevelGoals, LevelsError, LevelsOptions, levels};
use meshweft::order::Effort;

use super::object::{SceneObject, ScenePrimitive, Triangles};

/// A scene with levels of detail; with none if nothing gets coarser.
pub(crate) struct LeveledScene {
    /// As it was.
    full: Document,
    /// With its levels.
    document: Document,
    /// The meshes of each object, and how many units of the scene one of its own is.
    objects: Vec<(Vec<usize>, f64)>,
    /// How many faces there are at each level, the full one first.
    face_counts: Vec<usize>,
    /// The levels of each mesh that has some, by number, and their meshes.
    levels: BTreeMap<usize, BTreeMap<usize, Vec<usize>>>,
}

impl LeveledScene {
    /// The scene after `operations::levels` with these goals, at its defaults but for what is named here.
    pub(crate) fn new(
        file: &Path,
        goals: LevelGoals,
        effort: Effort,
        keeps_parts: bool,
    ) -> Result<Self, String> {
        let open = || Document::open(file, Limits::default());
        let [full, document] = [open(), open()].map(|it| it.map_err(|it| it.to_string()));
        let (full, mut document) = (full?, document?);
        let mut options = LevelsOptions::default();
        options.goals = goals;
        options.drop_parts = !keeps_parts;
        // Neither are errors read, nor orders.
        options.samples = 0;
        options.optimizer.effort = effort;
        options.optimizer.budget = Budget::Steps(0);
        let (objects, face_counts) = match levels(&mut document, &options, &()) {
            Ok(report) => {
                let counts = (0..report.levels.len()).map(|level| {
                    let objects = report.objects.iter();
                    let faces = objects.map(|it| it.faces[level.min(it.faces.len() - 1)]);
                    faces.sum()
                });
                let counts = counts.collect();
                let objects = report.objects.into_iter();
                let objects = objects.map(|it| (it.meshes, it.scale)).collect();
                (objects, counts)
            }
            Err(LevelsError::NothingLeaves { .. }) => {
                let faces = full.meshes().iter().map(|it| it.mesh.face_count());
                let with_faces = faces.clone().enumerate().filter(|&(_, count)| count > 0);
                let objects = with_faces.map(|(mesh, _)| (vec![mesh], 1.0));
                (objects.collect(), vec![faces.sum()])
            }
            Err(error) => return Err(error.to_string()),
        };

        let mut levels: BTreeMap<usize, BTreeMap<usize, Vec<usize>>> = BTreeMap::new();
        for (mesh, entry) in document.meshes().iter().enumerate() {
            if let Some(level) = entry.level {
                let of_mesh = levels.entry(level.of).or_default();
                of_mesh.entry(level.number).or_default().push(mesh);
            }
        }
        Ok(Self {
            full,
            document,
            objects,
            face_counts,
            levels,
        })
    }

    /// The objects at full resolution.
    pub(crate) fn objects(&self) -> Result<Vec<SceneObject>, String> {
        let object = |(meshes, scale): &(Vec<usize>, f64)| {
            let read = |&mesh: &usize| ScenePrimitive::new(&self.full, mesh);
            Ok(SceneObject {
                primitives: meshes.iter().map(read).collect::<Result<_, String>>()?,
                scale: *scale,
            })
        };
        self.objects.iter().map(object).collect()
    }

    pub(crate) fn face_count(&self, level: usize) -> usize {
        self.face_counts[level]
    }

    /// The finest level with at most so many faces, else the coarsest. A level that would be like the one before it is
    /// left out of a file, so they are not the goals by number.
    pub(crate) fn level_within(&self, face_count: usize) -> usize {
        let within = self.face_counts.iter().position(|&it| it <= face_count);
        within.unwrap_or(self.face_counts.len() - 1)
    }

    /// A mesh as it is drawn at a level: what is not stored for that is what is drawn at the next finer one.
    pub(crate) fn drawn(&self, mesh: usize, level: usize) -> Result<Triangles, String> {
        let mut drawn = Triangles::default();
        let mut add = |document: &Document, mesh: usize| {
            let positions = document.positions(mesh).map_err(|it| it.to_string())?;
            let entry = &document.meshes()[mesh];
            let positions = positions.ok_or_else(|| format!("{}: no positions", entry.name))?;
            drawn.add(&positions, entry.mesh.faces());
            Ok::<(), String>(())
        };
        let of_mesh = self.levels.get(&mesh);
        let stored = of_mesh.and_then(|it| it.range(..=level).next_back());
        match stored {
            _ if level == 0 => add(&self.full, mesh)?,
            None => add(&self.document, mesh)?,
            Some((_, meshes)) => {
                for &mesh in meshes {
                    add(&self.document, mesh)?;
                }
            }
        }
        Ok(drawn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is read back has as many faces as was reported, but for one of each mesh that has lost all, and
    /// every triangle's corners are where the scene has vertices.
    #[test]
    fn levels_are_what_was_reported() {
        let Some(data) = compare::data_folder() else {
            compare::say("levels of scenes: no test data, skipped");
            return;
        };
        for name in [
            "Duck.glb",
            "2CylinderEngine.glb",
            "Fox.glb",
            "CesiumMilkTruck.glb",
        ] {
            let file = data.join("gltf").join(name);
            let goals = LevelGoals::Ratios(vec![0.5, 0.25, 0.1, 0.05]);
            let scene =
                LeveledScene::new(&file, goals, Effort::Fast, false).expect("a sound scene");
            assert!(scene.face_counts.len() > 2, "{name}");
            let bits = |position: [f32; 3]| position.map(f32::to_bits);
            for level in 0..scene.face_counts.len() {
                let (mut count, mut meshes) = (0, 0);
                for &mesh in scene.objects.iter().flat_map(|(meshes, _)| meshes) {
                    let full = scene.drawn(mesh, 0).expect("it is there");
                    let places: std::collections::BTreeSet<_> =
                        full.positions.iter().copied().map(bits).collect();
                    let drawn = scene.drawn(mesh, level).expect("it is there");
                    let corners = drawn.faces.as_flattened().iter();
                    let mut corners = corners.map(|&it| bits(drawn.positions[it as usize]));
                    assert!(corners.all(|it| places.contains(&it)), "{name}, {mesh}");
                    count += drawn.faces.len();
                    meshes += 1;
                }
                let reported = scene.face_count(level);
                let all = reported..=reported + meshes;
                assert!(all.contains(&count), "{name}, {level}: {count}, {reported}");
                let found = scene.level_within(reported);
                assert_eq!(scene.face_count(found), reported, "{name}, {level}");
            }
        }
    }
}
