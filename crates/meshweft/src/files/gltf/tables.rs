//! The culling tables of all primitives, by the mesh whose faces they are of.

use std::collections::{BTreeMap, BTreeSet};

use super::buffers::Buffers;
use super::culling::{self, Culling};
use super::movable::{Movable, PrimitiveNumber};
use super::primitives::Primitives;
use super::strided_records::StridedRecords;
use crate::files::error::Place;
use crate::files::note::Note;

/// The first primitive that stays because its culling table is damaged, and how many more there are.
pub(super) fn damaged(primitives: &Primitives) -> Option<Note> {
    let staying = primitives.staying.iter();
    let mut damaged = staying.filter(|staying| culling::is_damage(&staying.why));
    let first = damaged.next()?;
    let place = Place::Json(first.number.pointer());
    let mut note = Note::new(place, first.why.clone());
    note.more = damaged.count();
    Some(note)
}

/// The table of a primitive that draws the faces of a mesh.
#[derive(Debug)]
pub(super) struct PlacedCulling {
    pub(super) mesh: usize,
    pub(super) primitive: PrimitiveNumber,
    pub(super) vertex_count: usize,
    pub(super) culling: Culling,
}

/// The tables of meshes.
#[derive(Debug, Default)]
pub(super) struct Tables {
    /// All, in the order of primitives.
    pub(super) placed: Vec<PlacedCulling>,
    /// The first table of each mesh that has some.
    of_mesh: BTreeMap<usize, Culling>,
    seen: BTreeSet<(usize, StridedRecords)>,
    runs: BTreeMap<usize, Vec<u32>>,
}

impl Tables {
    /// Adds the table of a primitive that draws the faces of a mesh.
    pub(super) fn add(&mut self, mesh: usize, primitive: &Movable, buffers: &Buffers) {
        let Some(&culling) = primitive.culling() else {
            return;
        };
        self.placed.push(PlacedCulling {
            mesh,
            primitive: primitive.number,
            vertex_count: primitive.vertex_count,
            culling,
        });
        let table = &culling;
        if !self.seen.insert((mesh, table.starts)) {
            return;
        }
        self.of_mesh.entry(mesh).or_insert(culling);
        let runs = self.runs.entry(mesh).or_default();
        runs.extend(table.runs(buffers));
    }

    /// For each mesh where the clusters of its tables begin, in any order.
    pub(super) fn take_runs(&mut self) -> BTreeMap<usize, Vec<u32>> {
        std::mem::take(&mut self.runs)
    }

    /// The primitives that have one.
    pub(super) fn primitives(&self) -> Vec<PrimitiveNumber> {
        self.placed.iter().map(|it| it.primitive).collect()
    }

    pub(super) fn of(&self, mesh: usize) -> Option<&Culling> {
        self.of_mesh.get(&mesh)
    }
}
