//! Culling tables of meshes that are there, as bytes of a buffer and values of the JSON.

use std::collections::BTreeMap;

use serde_json::json;

use super::GltfFile;
use super::accessors::{FLOAT, UNSIGNED_INT};
use super::culling::NAME;
use super::growth::Growth;
use super::movable::PrimitiveNumber;
use super::new_meshes::NewMeshes;
use super::object::Object;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::note::Note;
use crate::files::stored_culling::StoredCulling;

impl GltfFile {
    /// See [`Edit::Cull`](crate::files::Edit::Cull); on an error nothing is changed.
    pub(super) fn cull(
        &mut self,
        tables: &[(usize, &StoredCulling)],
    ) -> Result<Vec<Note>, Problem> {
        let json = super::read_json(&self.container, &self.options.limits)?;
        let root = Object::new(json.root(), String::new())?;
        let growth = Growth::new(&root, &self.container, &self.buffers);
        let mut new = NewMeshes::new(&root, growth.buffer, growth.start)?;
        let entries = &self.view.entries;
        let mut repeated: BTreeMap<PrimitiveNumber, Vec<PrimitiveNumber>> = BTreeMap::new();
        for (&number, &first) in &entries.repeated {
            repeated.entry(first).or_default().push(number);
        }
        for &(mesh, table) in tables {
            let first = entries.first_primitives[mesh];
            let place = || Place::Json(first.pointer());
            let face_count = entries.meshes[mesh].mesh.face_count();
            check(table, face_count).map_err(|kind| kind.at(place()))?;
            if entries.tables.of(mesh).is_some() {
                let text = "it has a culling table already";
                return Err(FileErrorKind::unsupported(text).at(place()));
            }
            let others = repeated.get(&first).into_iter().flatten().copied();
            add(table, [first].into_iter().chain(others), &mut new);
        }
        let used = root.array("extensionsUsed")?;
        if !used
            .iter()
            .any(|name| name.text().is_some_and(|name| name == NAME))
        {
            new.value(["extensionsUsed", "-"], json!(NAME).to_string());
        }
        let (bytes, additions) = new.finish();
        self.grow(growth, bytes, additions)
    }
}

/// Whether a table may be one of that number of faces.
fn check(table: &StoredCulling, face_count: usize) -> Result<(), FileErrorKind> {
    let StoredCulling {
        center,
        reach,
        starts,
        planes,
    } = table;
    let ends = starts.first().zip(starts.last());
    let is_sound = ends.is_some_and(|(&first, &last)| first == 0 && last as usize == face_count)
        && starts.windows(2).all(|pair| pair[0] < pair[1])
        && planes.len() + 1 == starts.len()
        && !planes.is_empty()
        && planes
            .as_flattened()
            .as_flattened()
            .iter()
            .all(|x| x.is_finite())
        && center.iter().all(|x| x.is_finite())
        && (0.0..=f32::MAX).contains(reach);
    match is_sound {
        true => Ok(()),
        false => Err(FileErrorKind::unsupported(
            "clusters must rise from 0 to all faces, with planes for each, all numbers finite",
        )),
    }
}

/// Adds a table of primitives.
fn add(
    table: &StoredCulling,
    primitives: impl Iterator<Item = PrimitiveNumber>,
    new: &mut NewMeshes<'_>,
) {
    let starts: Vec<u8> = table.starts.iter().flat_map(|x| x.to_le_bytes()).collect();
    let starts = new.numbers(&starts, UNSIGNED_INT, table.starts.len(), "SCALAR");
    let numbers = table.planes.as_flattened();
    let bytes = numbers.iter().flatten().flat_map(|x| x.to_le_bytes());
    let planes = new.numbers(&bytes.collect::<Vec<u8>>(), FLOAT, numbers.len(), "VEC4");
    // As 64-bit numbers, whose text is exact.
    let value = json!({
        "center": table.center.map(f64::from),
        "reach": f64::from(table.reach),
        "starts": starts,
        "planes": planes,
    });
    for PrimitiveNumber { mesh, primitive } in primitives {
        let (mesh, primitive) = (mesh.to_string(), primitive.to_string());
        let path = [
            "meshes",
            &mesh,
            "primitives",
            &primitive,
            "extensions",
            NAME,
        ];
        new.value(path, value.to_string());
    }
}
