//! A scene at a level of ours, and what gltfpack leaves at the same numbers of faces.

use std::path::Path;

use meshweft::geometry::{Surface, deviation};
use meshweft::operations::LevelGoals;
use meshweft::order::Effort;

use super::gltfpack::GltfpackPrimitive;
use super::object::{SceneObject, Triangles};
use super::our_levels::LeveledScene;
use super::summary::{Comparison, SceneRow};
use crate::diagonal;

/// Points of an object, however few faces it has.
const LEAST_SAMPLES: usize = 10_000;
/// How often ours is made again with as many faces as gltfpack leaves.
const TRIES: usize = 4;

/// What may be different from the defaults.
#[derive(Debug, Clone)]
pub(crate) struct Variants {
    /// Of the faces of a scene, falling.
    pub(crate) percents: Vec<usize>,
    /// No part of ours leaves as a whole; gltfpack's may.
    pub(crate) keeps_parts: bool,
    /// Rows of each object, too.
    pub(crate) prints_objects: bool,
}

/// A scene with the levels that are compared, by both efforts, and how gltfpack sees it.
pub(crate) struct Contest<'a> {
    file: &'a Path,
    variants: &'a Variants,
    efforts: [(Effort, LeveledScene); 2],
    objects: Vec<ContestedObject>,
    face_count: usize,
    /// The diagonal of the largest object, as it is drawn.
    diagonal: f64,
}

struct ContestedObject {
    object: SceneObject,
    full: Triangles,
    theirs: Vec<GltfpackPrimitive>,
    /// As it is drawn.
    area: f64,
    samples: usize,
}

/// What is left of an object by both.
struct LeftOfObject {
    ours: Vec<Triangles>,
    /// With pruning, and without.
    theirs: [Vec<Vec<[u32; 3]>>; 2],
}

impl Default for Variants {
    fn default() -> Self {
        Self {
            percents: vec![50, 25, 10, 5],
            keeps_parts: false,
            prints_objects: false,
        }
    }
}

impl<'a> Contest<'a> {
    /// `samples` points of either surface are measured, of all objects together.
    pub(crate) fn new(
        file: &'a Path,
        samples: usize,
        variants: &'a Variants,
    ) -> Result<Self, String> {
        let made = |effort| {
            let ratios = variants
                .percents
                .iter()
                .map(|&percent| percent as f64 / 100.0);
            let goals = LevelGoals::Ratios(ratios.collect());
            let scene = LeveledScene::new(file, goals, effort, variants.keeps_parts)?;
            Ok::<_, String>((effort, scene))
        };
        let efforts = [made(Effort::Fast)?, made(Effort::Best)?];
        let objects = efforts[0].1.objects()?;
        let face_count: usize = objects.iter().map(SceneObject::face_count).sum();
        let objects = objects.into_iter().map(|object| {
            let full = object.full();
            let share = samples * object.face_count() / face_count;
            ContestedObject {
                theirs: object
                    .primitives
                    .iter()
                    .map(GltfpackPrimitive::new)
                    .collect(),
                area: full.area() * object.scale.powi(2),
                samples: share.max(LEAST_SAMPLES).min(samples),
                full,
                object,
            }
        });
        let objects: Vec<ContestedObject> = objects.collect();
        let diagonals = objects.iter().map(ContestedObject::diagonal);
        Ok(Self {
            file,
            variants,
            diagonal: diagonals.fold(0.0, f64::max),
            efforts,
            objects,
            face_count,
        })
    }

    /// The row of a level, then those of its objects if they are asked for.
    pub(crate) fn rows(&self, name: &str, percent: usize) -> Result<Vec<SceneRow>, String> {
        let goal = self.face_count * percent / 100;
        let mut rows = vec![SceneRow::new(name, percent, self.face_count)];
        let of_objects = self.objects.iter().enumerate().map(|(number, it)| {
            let name = format!("{name}, object {number}");
            SceneRow::new(&name, percent, it.object.face_count())
        });
        rows.extend(of_objects);
        for (number, (effort, scene)) in self.efforts.iter().enumerate() {
            let (left, our_faces) = self.left(*effort, scene, goal)?;
            let mut sum = Comparison::default();
            for ((left, contested), row) in left.iter().zip(&self.objects).zip(&mut rows[1..]) {
                let mut compared = contested.compared(left);
                sum.add(&compared);
                compared.finish(contested.area, contested.diagonal());
                row.efforts[number] = compared;
            }
            sum.finish(self.objects.iter().map(|it| it.area).sum(), self.diagonal);
            sum.stops_above = our_faces > goal;
            rows[0].efforts[number] = sum;
        }
        if !self.variants.prints_objects {
            rows.truncate(1);
        }
        Ok(rows)
    }

    /// What is left of all objects, ours with so many faces as near as it gets; then how many these are. Where gltfpack
    /// cannot get near, ours with as many as gltfpack has.
    fn left(
        &self,
        effort: Effort,
        scene: &LeveledScene,
        goal: usize,
    ) -> Result<(Vec<LeftOfObject>, usize), String> {
        let level = scene.level_within(goal);
        let mut best = self.left_at(scene, level)?;
        let our_faces = scene.face_count(level);
        for _ in 0..TRIES {
            let sum = |of: fn(&LeftOfObject) -> usize| -> usize { best.iter().map(of).sum() };
            let [ours, theirs] = [sum(LeftOfObject::our_faces), sum(LeftOfObject::their_faces)];
            let apart = sum(LeftOfObject::apart);
            if super::are_near(apart, ours) || theirs == ours {
                break;
            }
            let goals = LevelGoals::Faces(vec![theirs]);
            let again = LeveledScene::new(self.file, goals, effort, self.variants.keeps_parts)?;
            let next = self.left_at(&again, again.level_within(theirs))?;
            let next_apart: usize = next.iter().map(LeftOfObject::apart).sum();
            if 2 * next_apart > apart {
                break;
            }
            best = next;
        }
        Ok((best, our_faces))
    }

    fn left_at(&self, scene: &LeveledScene, level: usize) -> Result<Vec<LeftOfObject>, String> {
        let objects = self.objects.iter();
        objects.map(|it| it.left_at(scene, level)).collect()
    }
}

impl LeftOfObject {
    fn our_faces(&self) -> usize {
        self.ours.iter().map(|it| it.faces.len()).sum()
    }

    fn their_faces(&self) -> usize {
        self.theirs[self.nearer()].iter().map(Vec::len).sum()
    }

    /// The sum of the differences of all primitives, in faces.
    fn apart(&self) -> usize {
        self.apart_if(0).min(self.apart_if(1))
    }

    fn apart_if(&self, variant: usize) -> usize {
        let primitives = self.ours.iter().zip(&self.theirs[variant]);
        primitives
            .map(|(ours, theirs)| ours.faces.len().abs_diff(theirs.len()))
            .sum()
    }

    fn nearer(&self) -> usize {
        usize::from(self.apart_if(1) < self.apart_if(0))
    }
}

impl ContestedObject {
    /// As it is drawn.
    fn diagonal(&self) -> f64 {
        let mesh = meshweft::Mesh::new(self.full.positions.as_slice(), self.full.faces.as_slice());
        diagonal(&mesh.expect("they come from meshes")) * self.object.scale
    }

    fn left_at(&self, scene: &LeveledScene, level: usize) -> Result<LeftOfObject, String> {
        let primitives = self.object.primitives.iter();
        let ours = primitives.map(|it| scene.drawn(it.number, level));
        let ours: Vec<Triangles> = ours.collect::<Result<_, _>>()?;
        let theirs = [true, false].map(|prunes| {
            let left = |least: usize| -> Vec<Vec<[u32; 3]>> {
                let primitives = self.theirs.iter().zip(&ours);
                primitives
                    .map(|(theirs, ours)| theirs.nearest(ours.faces.len(), least, prunes))
                    .collect()
            };
            // A primitive may go, the object may not.
            let found = left(0);
            match found.iter().all(Vec::is_empty) {
                true => left(1),
                false => found,
            }
        });
        Ok(LeftOfObject { ours, theirs })
    }

    /// Sums over the object. What is better of what gltfpack leaves with pruning and without is what gets nearer, or where both
    /// get near what has the smaller mean.
    fn compared(&self, left: &LeftOfObject) -> Comparison {
        let our_faces = left.our_faces();
        let mut ours = Triangles::default();
        for primitive in &left.ours {
            ours.add(&primitive.positions, &primitive.faces);
        }
        let [pruned, unpruned] = [0, 1].map(|variant| {
            if variant == 1 && left.theirs[1] == left.theirs[0] {
                return None;
            }
            let mut theirs = Triangles::default();
            for (primitive, faces) in self.object.primitives.iter().zip(&left.theirs[variant]) {
                theirs.add(primitive.mesh.positions(), faces);
            }
            Some(self.measured(&theirs))
        });
        let are_near = [0, 1].map(|variant| super::are_near(left.apart_if(variant), our_faces));
        let variant = match are_near {
            [true, true] => {
                let means = [pruned, unpruned].map(|it| it.map(|it| it[0]));
                usize::from(means[1].is_some() && means[1] < means[0])
            }
            _ => left.nearer(),
        };
        let mut compared = Comparison {
            our_faces,
            their_faces: left.theirs[variant].iter().map(Vec::len).sum(),
            unpruned: variant,
            ..Comparison::default()
        };
        for (ours, theirs) in left.ours.iter().zip(&left.theirs[variant]) {
            let [ours, theirs] = [ours.faces.len(), theirs.len()];
            compared.more += theirs.saturating_sub(ours);
            compared.fewer += ours.saturating_sub(theirs);
        }
        compared.ours.add(self.measured(&ours), self.area);
        compared
            .theirs
            .add([pruned, unpruned][variant].unwrap_or_default(), self.area);
        compared
    }

    /// Mean, root of the mean square, greatest, as it is drawn.
    fn measured(&self, left: &Triangles) -> [f64; 3] {
        let [full, left] = [&self.full, left].map(|it| Surface::new(&it.positions, &it.faces));
        let found = deviation(&full, &left, self.samples).two_sided;
        [found.mean, found.rms, found.max].map(|it| it * self.object.scale)
    }
}
