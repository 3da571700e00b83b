//! What is left as it is, said once for each reason.

use std::collections::BTreeMap;

use super::buffers::Buffers;
use super::companions::Companions;
use super::entries::Entries;
use super::movable::{Draws, PrimitiveNumber};
use super::primitives::Primitives;
use crate::files::error::Place;
use crate::files::note::Note;

/// Why the order of transparent faces stays.
const TRANSPARENT: &str = "its material is transparent (alphaMode BLEND)";

/// What stays as it is, and why.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Reason<'a> {
    Primitive(&'a str),
    Order(&'a str),
    Transparent,
    Vertices(&'a str),
}

impl Reason<'_> {
    fn note(self, place: Place) -> Note {
        match self {
            Self::Primitive(why) => Note::new(place, format!("left as it is: {why}")),
            Self::Order(why) => Note::new(place, format!("its order stays: {why}")),
            Self::Transparent => Note::transparent(place, TRANSPARENT),
            Self::Vertices(why) => Note::vertices_stay(place, why),
        }
    }
}

/// The first primitive that a reason holds for, and how many there are.
struct First<'a> {
    number: PrimitiveNumber,
    /// What in the primitive it is, if not all of it.
    pointer: Option<&'a str>,
    count: usize,
}

/// All notes: primitives and vertices in the order of the file, then buffers, then other files.
pub(super) fn notes(
    primitives: &Primitives,
    entries: &Entries,
    buffers: &Buffers,
    companions: &Companions,
) -> Vec<Note> {
    let mut notes = of_primitives(primitives, entries);
    let note = |pointer: &str, text: String| Note::new(Place::Json(pointer.to_owned()), text);

    for (buffer, why) in buffers.unreadable() {
        notes.push(note(
            &format!("/buffers/{buffer}/uri"),
            format!("not read: {why}"),
        ));
    }

    if let Some((why, more)) = &companions.refused {
        let note = Note::new(Place::File, format!("not copied to another folder: {why}"));
        notes.push(Note {
            more: *more,
            ..note
        });
    }
    notes
}

/// One note for each reason, at the first place: a reason may hold for very many.
fn of_primitives(primitives: &Primitives, entries: &Entries) -> Vec<Note> {
    let staying = primitives.staying.iter();
    let staying = staying.map(|staying| (Reason::Primitive(&staying.why), staying.number, None));
    let movable = primitives.movable.iter();
    let in_order = movable.filter_map(|primitive| {
        let why = match primitive.draws {
            Draws::Faces => return None,
            Draws::FacesInOrder => Reason::Transparent,
            Draws::Other(why) => Reason::Order(why),
        };
        Some((why, primitive.number, None))
    });
    let obstacles = entries.vertex_obstacles.iter();
    let obstacles = obstacles.map(|(number, obstacle)| {
        let reason = Reason::Vertices(&obstacle.why);
        (reason, *number, Some(obstacle.pointer.as_str()))
    });

    let mut firsts: BTreeMap<Reason<'_>, First<'_>> = BTreeMap::new();
    for (reason, number, pointer) in staying.chain(in_order).chain(obstacles) {
        let first = firsts.entry(reason).or_insert(First {
            number,
            pointer,
            count: 0,
        });
        if number < first.number {
            (first.number, first.pointer) = (number, pointer);
        }
        first.count += 1;
    }

    let mut firsts: Vec<_> = firsts.into_iter().collect();
    firsts.sort_by_key(|(_, first)| first.number);
    let notes = firsts.into_iter().map(|(reason, first)| {
        let pointer = first.pointer.map(str::to_owned);
        let pointer = pointer.unwrap_or_else(|| first.number.pointer());
        Note {
            more: first.count - 1,
            ..reason.note(Place::Json(pointer))
        }
    });
    notes.collect()
}
