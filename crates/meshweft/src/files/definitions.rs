//! Lines between the faces of a run that faces name by number, as the `vt` lines of an OBJ.
//!
//! A face may not go above what it names: many readers look it up at once. So where the faces of such a
//! run move, these lines go above them: the places of both, together, take the lines first and then the
//! faces. The lines keep their order, and with it their numbers. Vertices (kind 0) do so too where
//! vertices move; then all of them stand above the last face of the first run.

use std::ops::Range;

use super::error::FileErrorKind;
use super::orders::{RecordOrders, record_in};
use super::slots::Spans;

/// How many kinds of numbers a corner has.
const KINDS: usize = 3;

/// The kind of vertices.
const VERTEX: u8 = 0;

/// The definitions between the faces of runs.
#[derive(Debug)]
pub(super) struct Definitions {
    lines: Spans,
    /// The kind of each line.
    kinds: Vec<u8>,
    /// The runs that have some.
    runs: Vec<DefinedRun>,
}

/// A run with definitions between its faces.
#[derive(Debug)]
struct DefinedRun {
    /// Which of the runs it is.
    run: usize,
    lines: Range<usize>,
    /// How many lines of each kind stand above its first face.
    above: [usize; KINDS],
}

impl Definitions {
    pub(super) fn new() -> Self {
        Self {
            lines: Spans::new(),
            kinds: Vec::new(),
            runs: Vec::new(),
        }
    }

    /// Adds the lines, of these kinds, that stand between the faces of a run; `above` its first face are
    /// so many of each kind.
    ///
    /// # Errors
    /// A line of 4 GiB or more.
    pub(super) fn push_run(
        &mut self,
        run: usize,
        lines: impl Iterator<Item = (Range<usize>, u8)>,
        above: [usize; KINDS],
    ) -> Result<(), FileErrorKind> {
        let first = self.lines.len();
        for (span, kind) in lines {
            self.lines.push(span)?;
            self.kinds.push(kind);
        }
        let lines = first..self.lines.len();
        if !lines.is_empty() {
            self.runs.push(DefinedRun { run, lines, above });
        }
        Ok(())
    }

    /// Numbers the runs again: `new_of` gives the new number of each, or `None` if its faces stay.
    pub(super) fn number_runs(&mut self, new_of: impl Fn(usize) -> Option<usize>) {
        self.runs.retain_mut(|of| match new_of(of.run) {
            Some(new) => {
                of.run = new;
                true
            }
            None => false,
        });
    }

    /// The places of the faces and of these lines, where faces of a run with such lines move, or the
    /// vertices between them; `None` if there are none. `runs` has the first record of each run.
    pub(super) fn places(
        &self,
        faces: &Spans,
        vertices: &Spans,
        runs: &[u32],
        orders: &RecordOrders,
    ) -> Option<Places<'_>> {
        let moved = self.runs.iter().filter_map(|of| {
            let end = runs
                .get(of.run + 1)
                .map_or(faces.len(), |&end| end as usize);
            let slots = runs[of.run] as usize..end;
            let is_moved = |slot| record_in(&orders.records, slot) != slot;
            let has_vertices = self.kinds[of.lines.clone()].contains(&VERTEX);
            let is_moved =
                slots.clone().any(is_moved) || (has_vertices && !orders.vertices.is_empty());
            is_moved.then(|| self.placed(of, slots))
        });
        let runs: Vec<PlacedRun> = moved.collect();
        let first = runs.first()?;

        let mut top_vertices = Spans::new();
        if !orders.vertices.is_empty() {
            let [count, ..] = match self.kinds[first.lines.clone()].contains(&VERTEX) {
                true => first.above[0],
                false => [vertices.len(); KINDS],
            };
            for vertex in 0..count {
                let pushed = top_vertices.push(vertices.span(vertex));
                pushed.expect("its length was checked before");
            }
        }

        let mut slots = Spans::new();
        let mut push = |span| slots.push(span).expect("its length was checked before");
        let mut next = 0;
        for run in &runs {
            (next..run.faces.start).for_each(|slot| push(faces.span(slot)));
            let mut lines = run.lines.clone();
            for slot in run.faces.clone() {
                let face = faces.span(slot);
                while self.lines.start(lines.start) < face.start && !lines.is_empty() {
                    push(self.lines.span(lines.start));
                    lines.start += 1;
                }
                push(face);
            }
            next = run.faces.end;
        }
        (next..faces.len()).for_each(|slot| push(faces.span(slot)));

        Some(Places {
            definitions: self,
            slots,
            top_vertices,
            runs,
            face_count: faces.len(),
        })
    }

    fn placed(&self, of: &DefinedRun, faces: Range<usize>) -> PlacedRun {
        let mut counts = of.above;
        let mut above = vec![counts];
        for &kind in &self.kinds[of.lines.clone()] {
            counts[usize::from(kind)] += 1;
            above.push(counts);
        }
        let lines = of.lines.clone();
        PlacedRun {
            faces,
            lines,
            above,
        }
    }
}

/// The places of faces and definitions, in a file some of whose runs have their definitions on top.
pub(super) struct Places<'a> {
    definitions: &'a Definitions,
    pub(super) slots: Spans,
    /// The vertices that are not among these places; if vertices move, else none.
    pub(super) top_vertices: Spans,
    runs: Vec<PlacedRun>,
    face_count: usize,
}

/// A run whose definitions go above its faces.
struct PlacedRun {
    /// The slots of its faces.
    faces: Range<usize>,
    lines: Range<usize>,
    /// How many definitions of each kind stand above each line of the run, and below the last.
    above: Vec<[usize; KINDS]>,
}

/// What goes to a place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Filling {
    /// The face that the order puts into this slot of the faces.
    Face {
        slot: usize,
        /// The run, if its definitions go above it.
        run: Option<usize>,
    },
    /// The vertex that the order puts into this slot of the vertices.
    Vertex(usize),
    /// What stands here: a definition of another kind.
    Line(Range<usize>),
}

impl Places<'_> {
    /// What goes to each place, from the first on.
    pub(super) fn fillings(&self) -> impl Iterator<Item = Filling> {
        let ends = self.runs.iter().map(|run| run.faces.end);
        let starts = [0].into_iter().chain(ends.clone());
        let last = starts.clone().last().unwrap_or(0);
        let moved = self.runs.iter().enumerate().zip(starts);
        let moved = moved.flat_map(|((number, run), start)| {
            let lines = run.lines.clone().zip(&run.above);
            let lines = lines.map(|(line, above)| match self.definitions.kinds[line] {
                VERTEX => Filling::Vertex(above[0]),
                _ => Filling::Line(self.definitions.lines.span(line)),
            });
            let face = move |run| move |slot| Filling::Face { slot, run };
            let before = (start..run.faces.start).map(face(None));
            before
                .chain(lines)
                .chain(run.faces.clone().map(face(Some(number))))
        });
        let after = (last..self.face_count).map(|slot| Filling::Face { slot, run: None });
        moved.chain(after)
    }

    /// How many definitions of each kind stand above `at` of the file, in this run.
    pub(super) fn above(&self, run: usize, at: usize) -> [usize; KINDS] {
        let run = &self.runs[run];
        let lines = &self.definitions.lines;
        let (mut low, mut high) = (run.lines.start, run.lines.end);
        while low < high {
            let middle = low.midpoint(high);
            match lines.start(middle) < at {
                true => low = middle + 1,
                false => high = middle,
            }
        }
        run.above[low - run.lines.start]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Faces `a` to `e`, of which `b c d` are a run with lines of three kinds between.
    const TEXT: &[u8] = b"00 a b 1 2 0 c 1 d e";

    /// Which order puts what where.
    fn written(records: &[u32], vertices: &[u32]) -> Option<String> {
        let spans = |of: &dyn Fn(u8) -> bool| {
            let mut spans = Spans::new();
            let places = (0..TEXT.len()).filter(|&at| of(TEXT[at]));
            places.for_each(|at| spans.push(at..at + 1).unwrap());
            spans
        };
        let faces = spans(&|byte| byte.is_ascii_lowercase());
        let all_vertices = spans(&|byte| byte == b'0');
        let mut definitions = Definitions::new();
        let lines = [7, 9, 11, 15].map(|at| (at..at + 1, TEXT[at] - b'0'));
        definitions
            .push_run(1, lines.into_iter(), [2, 20, 30])
            .unwrap();

        let orders = RecordOrders {
            records: records.to_vec(),
            rotations: Vec::new(),
            vertices: vertices.to_vec(),
        };
        let places = definitions.places(&faces, &all_vertices, &[0, 1, 4], &orders)?;
        assert_eq!(places.slots.len(), 9);
        let top = if vertices.is_empty() { 0 } else { 2 };
        assert_eq!(places.top_vertices.len(), top);
        let above = [5, 13, 17].map(|at| places.above(0, at));
        assert_eq!(above, [[2, 20, 30], [3, 21, 31], [3, 22, 31]]);

        let text = places.fillings().map(|filling| match filling {
            Filling::Face { slot, run } => {
                assert_eq!(run.is_some(), (1..4).contains(&slot));
                char::from(TEXT[faces.span(record_in(records, slot)).start])
            }
            Filling::Vertex(slot) => {
                assert_eq!(slot, 2);
                'v'
            }
            Filling::Line(span) => char::from(TEXT[span.start]),
        });
        Some(text.collect())
    }

    #[test]
    fn lines_go_above_the_faces_of_a_run_that_moves() {
        assert_eq!(written(&[], &[]), None);
        assert_eq!(written(&[0, 2, 1, 3, 4], &[]).unwrap(), "a12v1cbde");
        assert_eq!(written(&[], &[2, 0, 1]).unwrap(), "a12v1bcde");
    }
}
