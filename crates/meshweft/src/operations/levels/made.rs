//! The objects of a document, each at its levels.

use super::budget::{Budgeted, goals_in_faces, largest_error, levels_of_objects};
use super::coarser::{ObjectLevel, levels_of_object};
use super::options::{LevelsError, LevelsOptions};
use crate::files::{Document, Note, Place, VerticesOfLevels};
use crate::operations::simplify::{ProgressiveObject, objects};
use crate::operations::stage::Stage;
use crate::parallel;
use crate::progressive::{Collapses, StopReason};

/// The levels of all objects.
pub(super) struct MadeLevels {
    pub(super) objects: Vec<MadeObject>,
    /// For each mesh of the document, which vertices its levels can have.
    pub(super) vertices_of: Vec<VerticesOfLevels>,
    /// Where the faces asked for cannot be reached: how many there are at the coarsest.
    pub(super) floor: Option<usize>,
    pub(super) notes: Vec<Note>,
}

/// An object and its levels.
pub(super) struct MadeObject {
    /// The numbers of its meshes, which have faces.
    pub(super) meshes: Vec<usize>,
    pub(super) faces: usize,
    /// How many units of a scene one of its own is.
    pub(super) scale: f64,
    /// For each of its meshes, how far what is drawn with it is from the middle at most.
    pub(super) radii: Vec<f64>,
    /// Fine to coarse; none if nothing leaves at any.
    pub(super) levels: Vec<ObjectLevel>,
    /// Why it does not get coarser, or no coarser.
    pub(super) stop: Result<StopReason, String>,
}

impl MadeLevels {
    /// Makes the levels of a document that has none; it is only read.
    ///
    /// # Errors
    /// It has some, or no object gets coarser.
    pub(super) fn checked(
        document: &Document,
        options: &LevelsOptions,
        stage: &Stage<'_>,
    ) -> Result<Self, LevelsError> {
        let file = || document.path().to_owned();
        let entries = document.meshes();
        if let Some(level) = entries.iter().find_map(|entry| entry.level) {
            return Err(LevelsError::HasLevels {
                file: file(),
                mesh: entries[level.of].name.clone(),
            });
        }
        let made = Self::new(document, options, stage);
        if !stage.is_stopped() && made.level_count() == 0 {
            return Err(LevelsError::NothingLeaves {
                file: file(),
                why: made.why_nothing_leaves(document),
            });
        }
        Ok(made)
    }

    fn new(document: &Document, options: &LevelsOptions, stage: &Stage<'_>) -> Self {
        let entries = document.meshes();
        let scales = document.drawn_scales();
        let is_alike = document.draws_alike();
        let vertices_of = document.vertices_of_levels();
        let mut sets = objects(entries);
        for meshes in &mut sets {
            meshes.retain(|&mesh| entries[mesh].mesh.face_count() > 0);
        }
        sets.retain(|meshes| !meshes.is_empty());
        let faces_of = |meshes: &[usize]| -> usize {
            let faces = meshes.iter().map(|&mesh| entries[mesh].mesh.face_count());
            faces.sum()
        };
        let total = sets.iter().map(|meshes| faces_of(meshes)).sum();

        // All resolutions of each.
        let removing = stage.part(0.0, 0.6, total);
        let progressive = parallel::map(sets.iter().collect(), |meshes: &Vec<usize>| {
            if removing.is_stopped() {
                return Err("the work was stopped".to_owned());
            }
            if !meshes.iter().all(|&mesh| is_alike[mesh]) {
                return Err("several primitives draw its faces with different vertices".to_owned());
            }
            let has_none = |&mesh: &usize| vertices_of[mesh] == VerticesOfLevels::None;
            if meshes.iter().any(has_none) {
                return Err("it has no index list, and its vertices cannot be copied".to_owned());
            }
            let object = ProgressiveObject::new(document, meshes, |_| collapses(options));
            removing.add(faces_of(meshes));
            object
        });

        // How coarse each is to be.
        let scale_of = |meshes: &[usize]| {
            let scales = meshes.iter().map(|&mesh| scales[mesh]);
            scales.fold(0.0, f64::max)
        };
        let found = sets.iter().zip(&progressive);
        let found = found.filter_map(|(meshes, object)| Some((meshes, object.as_ref().ok()?)));
        let budgeted: Vec<Budgeted<'_>> = found
            .map(|(meshes, object)| Budgeted {
                progressive: &object.progressive,
                scale: scale_of(meshes),
                diagonal: object.diagonal,
            })
            .collect();
        let chosen = levels_of_objects(&budgeted, &options.goals);
        let (chosen, notes) = without_repeated(chosen);
        let floor = floor(&budgeted, options);

        // What each then is.
        let measuring = stage.part(0.6, 1.0, total);
        let mut number = 0;
        let jobs = sets.into_iter().zip(progressive).map(|(meshes, object)| {
            let removals: Vec<usize> = match &object {
                Err(_) => Vec::new(),
                Ok(_) => chosen.iter().map(|levels| levels[number]).collect(),
            };
            number += usize::from(object.is_ok());
            (meshes, object, removals)
        });
        let objects = parallel::map(jobs.collect(), |(meshes, object, removals)| {
            let faces = faces_of(&meshes);
            let samples = (options.samples as u128 * faces as u128).div_ceil(total as u128);
            let samples = usize::try_from(samples).unwrap_or(usize::MAX);
            let mut made = MadeObject {
                scale: scale_of(&meshes),
                radii: Vec::new(),
                levels: Vec::new(),
                stop: Ok(StopReason::Faces),
                faces,
                meshes,
            };
            match object {
                Err(why) => made.stop = Err(why),
                Ok(object) => {
                    made.stop = Ok(object.progressive.stop());
                    made.levels =
                        levels_of_object(document, &made.meshes, &object, &removals, samples);
                    let radii = object.radii(|mesh| entries[mesh].object);
                    let radius = |&mesh: &usize| radii.get(&entries[mesh].object).copied();
                    let radii = made.meshes.iter().map(radius);
                    made.radii = radii.map(Option::unwrap_or_default).collect();
                }
            }
            measuring.add(faces);
            made
        });
        let mut made = Self {
            objects,
            vertices_of,
            floor,
            notes,
        };
        made.note_what_stays(document);
        made
    }

    /// How many levels there are below the full one.
    pub(super) fn level_count(&self) -> usize {
        let counts = self.objects.iter().map(|object| object.levels.len());
        counts.max().unwrap_or(0)
    }

    /// What the first mesh of each object is called.
    pub(super) fn names(&self, document: &Document) -> Vec<String> {
        let firsts = self.objects.iter().map(|object| object.meshes[0]);
        firsts
            .map(|mesh| document.meshes()[mesh].name.clone())
            .collect()
    }

    /// Says which objects cannot get coarser, and why.
    fn note_what_stays(&mut self, document: &Document) {
        for object in &self.objects {
            if let Err(why) = &object.stop {
                let name = &document.meshes()[object.meshes[0]].name;
                let text = format!("{name}: it is the same at all levels: {why}");
                self.notes.push(Note::new(Place::File, text));
            }
        }
    }

    /// Why the largest object has no level.
    fn why_nothing_leaves(&self, document: &Document) -> String {
        let largest = self.objects.iter().max_by_key(|object| object.faces);
        let Some(object) = largest else {
            return "there are no faces that could leave".to_owned();
        };
        let name = &document.meshes()[object.meshes[0]].name;
        let why = match &object.stop {
            Err(why) => why,
            Ok(StopReason::Error) => "its first vertex would leave with a larger error",
            Ok(StopReason::NothingLeft) => "no vertex can go (seams, borders, topology)",
            Ok(StopReason::Faces) => "the levels asked for have all of its faces",
        };
        format!("{name}: {why}")
    }
}

fn collapses(options: &LevelsOptions) -> Collapses {
    Collapses {
        effort: options.optimizer.effort,
        lock_border: options.lock_border,
        drop_parts: options.drop_parts,
        cross_seams: options.cross_seams,
        weights: options.weights,
        // Which error is enough is known once all objects are.
        faces: 0,
        error: f32::INFINITY,
    }
}

/// The levels that differ from the one before, and a note for each that does not.
fn without_repeated(all: Vec<Vec<usize>>) -> (Vec<Vec<usize>>, Vec<Note>) {
    let mut notes = Vec::new();
    let mut kept: Vec<Vec<usize>> = Vec::with_capacity(all.len());
    for (asked, levels) in (1..).zip(all) {
        let is_repeated = match kept.last() {
            None => levels.iter().all(|&level| level == 0),
            Some(last) => *last == levels,
        };
        match is_repeated {
            false => kept.push(levels),
            true => {
                let text = format!(
                    "level {asked} of those asked for is left out: no face leaves that was there at the one before it"
                );
                notes.push(Note::new(Place::File, text));
            }
        }
    }
    (kept, notes)
}

/// How many faces are left at the coarsest, if that is more than asked for.
fn floor(objects: &[Budgeted<'_>], options: &LevelsOptions) -> Option<usize> {
    let error = largest_error(objects);
    let coarsest: usize = objects.iter().map(|it| it.faces_within(error)).sum();
    let total: usize = objects.iter().map(Budgeted::most_faces).sum();
    let goals = goals_in_faces(&options.goals, total);
    let least = goals.into_iter().min()?;
    (coarsest > least).then_some(coarsest)
}
