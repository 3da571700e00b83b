//! How far levels of glTF scenes are from the scenes, compared with what gltfpack leaves.

mod gltfpack;
mod object;
mod summary;

use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::Document;
use meshweft::geometry::{Surface, deviation};
use meshweft::order::Effort;
use meshweft::progressive::{ProgressiveMesh, Walk};

use super::diagonal;
use gltfpack::GltfpackObject;
use object::SceneObject;
use summary::{SceneRow, ScenesSummary};

/// Percent of the faces.
const LEVELS: [usize; 4] = [50, 25, 10, 5];
/// Scenes with fewer have no use for levels.
const LEAST_FACES: usize = 500;
const EFFORTS: [Effort; 2] = [Effort::Fast, Effort::Best];
/// Points of an object, however few faces it has.
const LEAST_SAMPLES: usize = 10_000;
/// Numbers of faces are near each other within so many and one in a hundred.
const NEAR: usize = 2;
/// Shorter distances, in parts of the diagonal, are what single precision rounds.
const ROUNDING: f64 = 1e-7;

/// What may be different from the defaults.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Variants {
    /// Parts of ours may leave, as gltfpack's may.
    pub(crate) drops_parts: bool,
    /// Rows of each object, too.
    pub(crate) prints_objects: bool,
}

/// The scenes of the test data, sorted by name.
pub(crate) fn files(data: &Path) -> Vec<PathBuf> {
    let mut folders = vec![data.join("gltf")];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).expect("the folder of scenes can be listed");
        for entry in entries {
            let path = entry.expect("an entry of the folder of scenes").path();
            let ending = path.extension().unwrap_or_default();
            match path.is_dir() {
                true => folders.push(path),
                false if ending == "glb" || ending == "gltf" => files.push(path),
                false => {}
            }
        }
    }
    files.sort();
    files
}

/// Prints a table of all scenes, then the means; `samples` points of either surface are measured, of all
/// objects of a scene together.
pub(crate) fn print(files: &[PathBuf], samples: usize, variants: Variants) -> Result<(), String> {
    println!(
        "Two-sided distances in ten thousandths of the diagonal of the scene's largest object, without the transforms of \
         nodes; means are weighed by the objects' areas. Ratios are ours over gltfpack's, which prunes parts or does not, \
         as is better. In the last column, objects: of which ours, or gltfpack, does not leave as few faces as asked for (the \
         others are compared at what ours leaves), of which gltfpack leaves no face then, and where pruning is worse.\n"
    );
    summary::print_head();
    let mut summary = ScenesSummary::default();
    let mut left_out = Vec::new();
    for file in files {
        let name = compare::mesh_name(file);
        let document = Document::open(file, Limits::default());
        let mut document = document.map_err(|it| it.to_string())?;
        let faces: usize = document
            .meshes()
            .iter()
            .map(|it| it.mesh.face_count())
            .sum();
        if faces < LEAST_FACES {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            left_out.push(format!("{name} ({faces})"));
            continue;
        }
        let objects = SceneObject::all(&mut document)?;
        for row in rows(&name, &objects, samples, variants)? {
            row.print();
            summary.add(row);
        }
    }
    summary.print(&LEVELS);
    println!(
        "\nLeft out, with fewer than {LEAST_FACES} faces that are not compressed: {}.",
        left_out.join(", ")
    );
    Ok(())
}

/// An object with its levels by both efforts, and how gltfpack sees it.
struct Contest<'a> {
    object: &'a SceneObject,
    ours: [ProgressiveMesh; 2],
    theirs: GltfpackObject,
    surface: Surface<'a>,
    area: f64,
    samples: usize,
}

/// A row a level.
fn rows(
    name: &str,
    objects: &[SceneObject],
    samples: usize,
    variants: Variants,
) -> Result<Vec<SceneRow>, String> {
    let faces = objects.iter().map(|it| it.mesh.face_count());
    let scene_faces: usize = faces.sum();
    let scale = objects
        .iter()
        .map(|it| diagonal(&it.mesh))
        .fold(0.0, f64::max);
    let mut rows = LEVELS.map(|percent| SceneRow::new(name, percent));
    for (number, object) in objects.iter().enumerate() {
        let [fast, best] = EFFORTS.map(|effort| object.levels(effort, variants.drops_parts));
        let ours = [fast?, best?];
        let contest = Contest {
            object,
            // Equal vertices are one for both.
            theirs: GltfpackObject::new(object, ours[0].faces()),
            ours,
            surface: Surface::new(object.mesh.positions(), object.mesh.faces()),
            area: area(&object.mesh),
            samples: LEAST_SAMPLES
                .max(samples * object.mesh.face_count() / scene_faces.max(1))
                .min(samples),
        };
        for row in &mut rows {
            let mut of_object = SceneRow::new(&format!("{name}, object {number}"), row.percent);
            contest.add_to(&mut of_object);
            row.add(&of_object);
            if variants.prints_objects {
                of_object.finish(diagonal(&object.mesh), ROUNDING);
                of_object.print();
            }
        }
    }
    for row in &mut rows {
        row.finish(scale, ROUNDING);
    }
    Ok(rows.into())
}

impl Contest<'_> {
    /// Adds what is left of the object by all three.
    fn add_to(&self, row: &mut SceneRow) {
        // As few as ours can leave of what is asked for; as near to that as gltfpack gets.
        let goal = (self.object.mesh.face_count() * row.percent / 100).max(1);
        let reached = self.ours.each_ref().map(|ours| {
            let level = level_with_a_face(ours, goal);
            ours.face_count(level)
        });
        let aim = reached[0].max(reached[1]);
        let at_goal = self.theirs.simplified(goal, true).len();
        let (theirs, distances, is_pruned) = self.theirs_near(aim);
        row.all_faces += self.object.mesh.face_count();
        row.area += self.area;
        row.our_floors += usize::from(aim > goal);
        row.their_floors += usize::from(at_goal > goal);
        row.their_losses += usize::from(at_goal == 0);
        row.unpruned += usize::from(!is_pruned);
        row.faces += theirs;
        row.theirs.add(distances, self.area);

        // Ours at their number, or one less.
        for (effort, ours) in self.ours.iter().enumerate() {
            let mut walk = Walk::new(ours);
            walk.go_to(level_with_a_face(ours, theirs));
            let mut faces = Vec::new();
            walk.emit(&mut faces);
            row.our_faces[effort] += faces.len();
            row.ours[effort].add(self.measured(&faces), self.area);
        }
    }

    /// How many faces gltfpack leaves near this number, how far these are off, and whether parts may be pruned: the
    /// better choice of both, which is the one that gets nearer, or where both get near the one with the smaller mean.
    fn theirs_near(&self, face_count: usize) -> (usize, [f64; 3], bool) {
        let choices = [true, false].map(|prunes| {
            let left = self.theirs.nearest(face_count, prunes);
            (left.len(), self.measured(&left), prunes)
        });
        let off = choices.map(|(count, ..)| count.abs_diff(face_count));
        let are_near = off.iter().all(|&off| off <= NEAR + face_count / 100);
        let second_is_better = match are_near {
            true => choices[1].1[0] < choices[0].1[0],
            false => off[1] < off[0],
        };
        choices[usize::from(second_is_better)]
    }

    /// Mean, root of the mean square, greatest.
    fn measured(&self, faces: &[[u32; 3]]) -> [f64; 3] {
        let left = Surface::new(self.object.mesh.positions(), faces);
        let found = deviation(&self.surface, &left, self.samples).two_sided;
        [found.mean, found.rms, found.max]
    }
}

/// The level with at most so many faces, if there is one, but at least one.
fn level_with_a_face(mesh: &ProgressiveMesh, most: usize) -> usize {
    let mut level = mesh.level_of_faces(most);
    while level > 0 && mesh.face_count(level) == 0 {
        level -= 1;
    }
    level
}

fn area(mesh: &meshweft::Mesh) -> f64 {
    let corner = |vertex: u32| mesh.positions()[vertex as usize].map(f64::from);
    let faces = mesh.faces().iter().map(|face| {
        let [a, b, c] = face.map(corner);
        let [u, v] = [b, c].map(|it| [0, 1, 2].map(|axis| it[axis] - a[axis]));
        let normal = [0, 1, 2].map(|axis| {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            u[next] * v[last] - u[last] * v[next]
        });
        normal.iter().map(|it| it * it).sum::<f64>().sqrt() / 2.0
    });
    faces.sum()
}
