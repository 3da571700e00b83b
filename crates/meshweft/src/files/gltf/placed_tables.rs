//! The culling tables of all primitives, each with the positions that its primitive draws.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::GltfFile;
use super::tables::PlacedCulling;
use crate::files::error::{Place, Problem};
use crate::files::stored_culling::PlacedTable;

/// More tables of the same faces are not looked at: the time would be that of all of them for each.
const MOST_TABLES: usize = 64;

impl GltfFile {
    /// See [`Content::each_table`](crate::files::content::Content::each_table).
    ///
    /// A table that several primitives have with the same faces and positions is one. Time and space O(JSON), and those of
    /// positions and tables.
    pub(super) fn each_table(&self, visit: &mut dyn FnMut(PlacedTable<'_>)) -> Result<(), Problem> {
        let attributes = &self.view.table_attributes;
        let mut positions = BTreeMap::new();
        let mut seen = BTreeSet::new();
        let mut count_of: BTreeMap<usize, usize> = BTreeMap::new();
        for (number, placed) in self.view.entries.tables.placed.iter().enumerate() {
            let PlacedCulling { mesh, culling, .. } = *placed;

            // Which positions it is of.
            let infos = attributes.of_mesh(number, self.json());
            let info = infos.into_iter().find(|info| info.is_vertex_position());
            let store = info
                .as_ref()
                .and_then(|info| attributes.store(number, info, self.json()));

            // Each once, and one more than are looked at, to be told.
            if !seen.insert((mesh, culling.key(), store)) {
                continue;
            }
            let count = count_of.entry(mesh).or_default();
            *count += 1;
            if *count > MOST_TABLES + 1 {
                continue;
            }

            // The positions, decoded once.
            let known = store.and_then(|store| positions.get(&store));
            let found: Option<Rc<[[f32; 3]]>> = match (known, &info) {
                (Some(known), _) => Some(Rc::clone(known)),
                (None, None) => None,
                (None, Some(info)) => {
                    let (json, vertices) = (self.json(), placed.vertex_count);
                    let read = attributes.read(number, info, json, vertices, &self.buffers)?;
                    Some(read.to_f32().as_chunks().0.into())
                }
            };
            if let (Some(store), Some(found)) = (store, &found) {
                positions.insert(store, Rc::clone(found));
            }

            visit(PlacedTable {
                mesh,
                place: Place::Json(placed.primitive.pointer()),
                is_first: *count == 1,
                table: (*count <= MOST_TABLES).then(|| culling.stored(&self.buffers)),
                positions: found.as_deref(),
            });
        }
        Ok(())
    }
}
