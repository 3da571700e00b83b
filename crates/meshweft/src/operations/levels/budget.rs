//! How coarse each object is at each level, so that all have one error budget.

use super::options::LevelGoals;
use crate::geometry::double::rounded_up;
use crate::operations::simplify::ErrorLimit;
use crate::progressive::ProgressiveMesh;

/// How far a level may be off to have as few faces as asked for, in diagonals of the largest object. The last vertices that
/// can go (seams, borders, topology) may be any distance off: with such an error a level would be drawn where all is a few
/// pixels large.
const MOST_ERROR: f64 = 0.1;

/// An object that gets coarser.
pub(super) struct Budgeted<'a> {
    pub(super) progressive: &'a ProgressiveMesh,
    /// How many units of a scene one of its own is.
    pub(super) scale: f64,
    /// The diagonal of its bounding box, in its own units.
    pub(super) diagonal: f64,
}

impl Budgeted<'_> {
    /// The coarsest level within an error of the scene, that has faces.
    fn level_within(&self, error: f32) -> usize {
        #[expect(clippy::cast_possible_truncation, reason = "an estimate is compared")]
        let own = (f64::from(error) / self.scale) as f32;
        self.with_faces(self.progressive.level_of_error(own))
    }

    /// This level, or the next finer one that has faces.
    fn with_faces(&self, mut level: usize) -> usize {
        while level > 0 && self.progressive.face_count(level) == 0 {
            level -= 1;
        }
        level
    }

    /// The error of the last removal of a vertex, in units of the scene. Parts that leave as a whole may be larger.
    fn largest_error(&self) -> f32 {
        let progressive = self.progressive;
        let is_of_vertex = |level: &usize| !progressive.collapse(*level).is_of_part();
        let last = (0..progressive.last_level()).rev().find(is_of_vertex);
        let own = last.map_or(0.0, |last| progressive.error(last + 1));
        rounded_up(f64::from(own) * self.scale)
    }

    fn faces(&self, level: usize) -> usize {
        self.progressive.face_count(level)
    }

    pub(super) fn most_faces(&self) -> usize {
        self.faces(0)
    }

    /// How many faces are left within an error of the scene.
    pub(super) fn faces_within(&self, error: f32) -> usize {
        self.faces(self.level_within(error))
    }
}

/// The largest error that a number of faces is reached by, in units of the scene: that of the last vertex that leaves, as a
/// part may leave as a whole where it is smaller, and no more than a share of the largest object.
pub(super) fn largest_error(objects: &[Budgeted<'_>]) -> f32 {
    let errors = objects.iter().map(Budgeted::largest_error);
    let most = MOST_ERROR * largest_diagonal(objects);
    errors.fold(0.0, f32::max).min(rounded_up(most))
}

/// The diagonal of the largest object as it is drawn.
fn largest_diagonal(objects: &[Budgeted<'_>]) -> f64 {
    let diagonals = objects.iter().map(|it| it.diagonal * it.scale);
    diagonals.fold(0.0, f64::max)
}

/// The level of each object, for each goal.
///
/// # Complexity
/// Time O(goals · objects · log removals).
pub(super) fn levels_of_objects(objects: &[Budgeted<'_>], goals: &LevelGoals) -> Vec<Vec<usize>> {
    let total = objects.iter().map(Budgeted::most_faces).sum();
    match goals {
        LevelGoals::Faces(_) | LevelGoals::Ratios(_) => goals_in_faces(goals, total)
            .into_iter()
            .map(|most| within_faces(objects, most))
            .collect(),
        LevelGoals::Errors(errors) => {
            let largest = largest_diagonal(objects);
            let within = |error: &ErrorLimit| {
                let error = error.of_diagonal(largest);
                objects.iter().map(|it| it.level_within(error)).collect()
            };
            errors.iter().map(within).collect()
        }
    }
}

/// How many faces each level may have; none where errors are the goals.
pub(super) fn goals_in_faces(goals: &LevelGoals, total: usize) -> Vec<usize> {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "at most the number of faces"
    )]
    #[expect(clippy::cast_sign_loss, reason = "a ratio is not negative")]
    let of_ratio = |&ratio: &f64| (ratio * total as f64) as usize;
    match goals {
        LevelGoals::Faces(counts) => counts.clone(),
        LevelGoals::Ratios(ratios) => ratios.iter().map(of_ratio).collect(),
        LevelGoals::Errors(_) => Vec::new(),
    }
}

/// The levels of least error that have at most `most` faces together, or the coarsest ones.
fn within_faces(objects: &[Budgeted<'_>], most: usize) -> Vec<usize> {
    let levels = |error: u32| -> Vec<usize> {
        let error = f32::from_bits(error);
        objects.iter().map(|it| it.level_within(error)).collect()
    };
    let faces = |levels: &[usize]| -> usize {
        let all = objects.iter().zip(levels);
        all.map(|(object, &level)| object.faces(level)).sum()
    };

    // Errors are not negative: as bits they rise as they do as numbers.
    let (mut above, mut within) = (None, largest_error(objects).to_bits());
    let mut next = 0;
    loop {
        match faces(&levels(next)) <= most {
            true => within = next,
            false => above = Some(next),
        }
        let low = above.map_or(0, |above| above + 1);
        if low >= within {
            break;
        }
        next = low + (within - low) / 2;
    }
    let coarse = levels(within);

    // All that have removals of the last error need not take all of them.
    let mut chosen = above.map_or_else(|| vec![0; objects.len()], levels);
    let mut too_many = faces(&chosen).saturating_sub(most);
    for ((object, level), &coarsest) in objects.iter().zip(&mut chosen).zip(&coarse) {
        if too_many == 0 {
            break;
        }
        let before = object.faces(*level);
        let goal = before.saturating_sub(too_many);
        let enough = object.progressive.level_of_faces(goal);
        *level = object.with_faces(enough.min(coarsest));
        too_many = too_many.saturating_sub(before - object.faces(*level));
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;
    use crate::progressive::Collapses;
    use crate::progressive::made::grid;

    /// A sheet with waves of this height.
    fn sheet(side: u8, height: f32) -> ProgressiveMesh {
        let row = side + 1;
        let place = |v: u16| {
            let [x, y] = [v % u16::from(row), v / u16::from(row)].map(f32::from);
            [x, y, height * (0.9 * x).sin() * (0.7 * y).cos()]
        };
        let positions: Vec<[f32; 3]> = (0..u16::from(row) * u16::from(row)).map(place).collect();
        let mesh = Mesh::new(positions, grid(side.into(), side.into())).unwrap();
        Collapses::default().build(&mesh, &[]).unwrap()
    }

    #[test]
    fn the_largest_error_of_any_object_is_the_least_that_will_do() {
        let meshes = [sheet(9, 0.3), sheet(5, 2.0), sheet(7, 0.0)];
        // Exact in binary, so that nothing is rounded.
        let objects: Vec<Budgeted<'_>> = meshes
            .iter()
            .zip([1.0, 0.25, 4.0])
            .map(|(progressive, scale)| Budgeted {
                progressive,
                scale,
                diagonal: 1000.0,
            })
            .collect();
        let faces_at = |levels: &[usize]| -> usize {
            let all = objects.iter().zip(levels);
            all.map(|(object, &level)| object.faces(level)).sum()
        };
        let total = faces_at(&[0; 3]);
        assert_eq!(total, 2 * (81 + 25 + 49));
        let error_of = |(object, &level): (&Budgeted<'_>, &usize)| {
            let own = object.progressive.error(level);
            f64::from(own) * object.scale
        };
        let fewest = faces_at(&within_faces(&objects, 0));
        for most in fewest..=total {
            let levels = within_faces(&objects, most);
            assert!(faces_at(&levels) <= most);
            let errors = objects.iter().zip(&levels).map(error_of);
            let error = errors.fold(0.0, f64::max);

            // All that is less far off is too much, and nothing left that need not.
            let nearer = |object: &Budgeted<'_>| {
                let all = 0..=object.progressive.last_level();
                let is_nearer = |level: &usize| error_of((object, level)) < error;
                all.rev().find(is_nearer)
            };
            if let Some(nearer) = objects.iter().map(nearer).collect::<Option<Vec<_>>>() {
                assert!(
                    faces_at(&nearer) > most,
                    "{most} faces within less than {error}"
                );
            }
            let most_that_leave = objects.iter().zip(&levels).map(|(object, &level)| {
                let finer = level.saturating_sub(1);
                object.faces(finer) - object.faces(level)
            });
            let step = most_that_leave.max().unwrap_or(0);
            assert!(faces_at(&levels) + step.max(1) > most, "{most}: {levels:?}");
        }
        assert_eq!(within_faces(&objects, total), [0; 3]);
    }
}
