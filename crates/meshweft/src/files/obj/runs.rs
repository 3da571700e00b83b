//! Which faces may change places.

use std::collections::BTreeMap;
use std::ops::Range;

use super::state::FaceState;
use crate::files::definitions::Definitions;
use crate::files::error::FileErrorKind;
use crate::index::index32;

/// What faces name, as it numbers them: the kinds of [`Definitions`].
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Defined {
    Vertex,
    Texture,
    Normal,
}

/// Cuts the faces of a file in runs, one statement after the other.
pub(super) struct Runs<'a> {
    pub(super) state: FaceState<'a>,
    /// The first face of each run.
    pub(super) starts: Vec<u32>,
    /// The material of each run, as a number of `materials`; 0 if it has none.
    material_of: Vec<u32>,
    /// The materials that faces have, numbered from 1.
    materials: BTreeMap<&'a [u8], u32>,
    /// The definitions between the faces of runs.
    pub(super) definitions: Definitions,
    /// Whether the next face may belong to the last run.
    is_open: bool,
    /// The definitions since the first face of the last run.
    since: Vec<(Range<usize>, Defined)>,
    /// How many of these stand above its last face.
    between: usize,
    /// How many definitions of each kind stand above its first face.
    above: [usize; 3],
    /// The kinds of definitions that must not go above something since its first face.
    barred: [bool; 3],
}

impl<'a> Runs<'a> {
    pub(super) fn new(source: &'a [u8]) -> Self {
        Self {
            state: FaceState::new(source),
            starts: Vec::new(),
            material_of: Vec::new(),
            materials: BTreeMap::new(),
            definitions: Definitions::new(),
            is_open: false,
            since: Vec::new(),
            between: 0,
            above: [0; 3],
            barred: [false; 3],
        }
    }

    /// Takes the next face, number `face`, above which so many definitions of each kind stand.
    pub(super) fn face(&mut self, face: usize, above: [usize; 3]) -> Result<(), FileErrorKind> {
        let is_of_run = self.state.continues() && self.is_open;
        if is_of_run {
            self.between = self.since.len();
            return Ok(());
        }

        self.close()?;
        self.starts.push(index32(face));
        self.material_of
            .push(self.state.material().map_or(0, |name| {
                let next = index32(self.materials.len() + 1);
                *self.materials.entry(name).or_insert(next)
            }));
        self.above = above;
        self.barred = [false; 3];
        self.is_open = true;
        Ok(())
    }

    /// Takes a line that faces may name.
    pub(super) fn definition(&mut self, span: Range<usize>, kind: Defined) {
        // What stands between has another state: a face that came to its place would take it on.
        if self.barred[kind as usize] || !self.state.is_that_of_last_face() {
            self.end();
        }
        if self.is_open {
            self.since.push((span, kind));
        }
    }

    /// No definition of this kind that comes below goes above this place.
    pub(super) fn bar(&mut self, kind: Defined) {
        self.barred[kind as usize] = true;
    }

    /// No face below is of the last run.
    pub(super) fn end(&mut self) {
        self.is_open = false;
    }

    /// Keeps the definitions between the faces of the last run. This is last, too.
    pub(super) fn close(&mut self) -> Result<(), FileErrorKind> {
        let between = self.since.drain(..).take(self.between);
        let between = between.map(|(span, kind)| (span, kind as u8));
        if let Some(run) = self.starts.len().checked_sub(1) {
            self.definitions.push_run(run, between, self.above)?;
        }
        self.between = 0;
        Ok(())
    }

    /// The materials that faces have.
    pub(super) fn materials(&self) -> impl Iterator<Item = &'a [u8]> + Clone {
        self.materials.keys().copied()
    }

    /// Keeps each of `face_count` faces where it is whose material `stays`. Says in how many runs, and in
    /// the first of them, which face is the first and what the material is.
    pub(super) fn keep(
        &mut self,
        face_count: usize,
        stays: impl Fn(&[u8]) -> bool,
    ) -> Option<(usize, usize, &'a [u8])> {
        let kept = self.materials.iter().filter(|&(name, _)| stays(name));
        let kept: BTreeMap<u32, &'a [u8]> = kept.map(|(&name, &number)| (number, name)).collect();
        let run = |run: usize| {
            let end = self
                .starts
                .get(run + 1)
                .map_or(face_count, |&end| end as usize);
            (self.starts[run] as usize, end, self.material_of[run])
        };
        let runs = (0..self.starts.len()).map(run);
        let mut kept_runs = runs
            .clone()
            .filter(|(.., number)| kept.contains_key(number));
        let (face, _, number) = kept_runs.next()?;
        let found = Some((1 + kept_runs.count(), face, kept[&number]));

        let mut starts = Vec::new();
        let mut new_of = Vec::new();
        for (start, end, number) in runs {
            let stays = kept.contains_key(&number);
            new_of.push((!stays).then_some(starts.len()));
            match stays {
                true => starts.extend(index32(start)..index32(end)),
                false => starts.push(index32(start)),
            }
        }
        self.definitions.number_runs(|run| new_of[run]);
        self.starts = starts;
        found
    }
}
