//! Strips and fans made lists of triangles: new lists at the end of a buffer, and in the text the numbers
//! that name them. What they were made of stays where it is.

use std::collections::BTreeMap;

use super::accessors::Accessors;
use super::buffers::Buffers;
use super::container::Container;
use super::growth::Growth;
use super::json::Value;
use super::new_meshes::NewMeshes;
use super::object::Object;
use super::patch;
use super::primitives::{Strip, strips};
use crate::files::error::{Place, Problem};
use crate::files::note::Note;
use crate::files::options::ReadOptions;
use crate::index::index32;

/// How many times the size of the file the lists may take: three corners a vertex, and twice the bytes a
/// corner, need six times the strips. Only a file made to waste memory, with very many strips over the
/// same bytes, needs more; the rest of its strips stays.
const MOST_GROWTH: usize = 8;

/// The file with every strip and fan that nothing keeps as a list of its triangles, and a note about the
/// first; `None` if there is none. The lists are added to the buffers.
///
/// Triangles with a vertex twice are left out.
///
/// # Errors
/// The file is not sound, or would be longer than a GLB can be.
pub(super) fn to_lists(
    root: &Object,
    container: &Container,
    buffers: &mut Buffers,
    options: &ReadOptions,
) -> Result<Option<(Container, Note)>, Problem> {
    let growth = Growth::new(root, container, buffers);
    let mut new = NewMeshes::new(root, growth.buffer, growth.start)?;
    let accessors = Accessors::new(root, buffers, &options.assume_order_safe)?;

    // The lists, one for all primitives that draw the same.
    let mut room = MOST_GROWTH.saturating_mul(container.head.len() + buffers.byte_count());
    let mut list_of = BTreeMap::new();
    let mut changed = Vec::new();
    for strip in strips(root, &accessors, options)? {
        let key = (strip.is_fan, strip.indices, strip.vertex_count);
        let list = match list_of.get(&key) {
            Some(&list) => list,
            None => {
                let faces = Some(&strip).filter(|strip| strip.largest_list() <= room);
                let faces = faces.and_then(|strip| strip.faces(&accessors));
                let list = faces.map(|faces| {
                    room -= strip.largest_list();
                    new.indices(&faces, strip.vertex_count)
                });
                list_of.insert(key, list);
                list
            }
        };
        changed.extend(list.map(|list| (strip.number, list)));
    }
    let Some(&(first, _)) = changed.first() else {
        return Ok(None);
    };

    // The numbers that name them.
    let (bytes, mut additions) = new.finish();
    let mut splices = Vec::new();
    let meshes: Vec<Value<'_>> = root.array("meshes")?;
    let mut primitives: Option<(u32, Vec<Value<'_>>)> = None;
    for &(number, list) in &changed {
        if primitives
            .as_ref()
            .is_none_or(|(mesh, _)| *mesh != number.mesh)
        {
            let all = meshes[number.mesh as usize].get("primitives");
            let all = all.into_iter().flat_map(Value::elements).collect();
            primitives = Some((number.mesh, all));
        }
        let Some((_, primitives)) = &primitives else {
            continue;
        };
        let primitive = primitives[number.primitive as usize];
        splices.extend(
            primitive
                .get("mode")
                .map(|mode| (mode.span(), "4".to_owned())),
        );
        match primitive.get("indices") {
            Some(indices) => splices.push((indices.span(), list.to_string())),
            None => {
                let [mesh, primitive] = [number.mesh, number.primitive].map(|n| n.to_string());
                let path = ["meshes", &mesh, "primitives", &primitive, "indices"];
                additions.value(path, list.to_string());
            }
        }
    }

    let container = growth.container(container, root, &bytes, additions, splices)?;
    growth.add(buffers, &bytes);
    let note = Note {
        more: changed.len() - 1,
        ..Note::new(
            Place::Json(first.pointer()),
            "it was a strip or fan, and is a list of triangles now",
        )
    };
    Ok(Some((container, note)))
}

impl Strip {
    /// The most bytes that its list can take.
    fn largest_list(&self) -> usize {
        let corners = self.indices.map_or(self.vertex_count, |list| list.count);
        corners.saturating_mul(12)
    }

    /// Its triangles; `None` if it has none or names a vertex that is not there.
    fn faces(&self, accessors: &Accessors) -> Option<Vec<[u32; 3]>> {
        let numbers = match &self.indices {
            Some(list) => patch::numbers(accessors.bytes(list), list),
            None => (0..index32(self.vertex_count)).collect(),
        };
        // The largest number of a type begins another strip.
        let restart = self.indices.as_ref().map(patch::largest_number);
        let pieces = numbers.split(|&number| Some(number) == restart);
        let mut faces = Vec::new();
        for piece in pieces {
            add_faces(piece, self.is_fan, &mut faces);
        }
        let is_sound = |face: &[u32; 3]| face.iter().all(|&v| (v as usize) < self.vertex_count);
        (!faces.is_empty() && faces.iter().all(is_sound)).then_some(faces)
    }
}

/// Adds the triangles of a strip or fan, as glTF 2.0 gives their corners, but those with a vertex twice.
fn add_faces(numbers: &[u32], is_fan: bool, faces: &mut Vec<[u32; 3]>) {
    let Some(&first) = numbers.first() else {
        return;
    };
    for (place, corners) in numbers.windows(3).enumerate() {
        let &[a, b, c] = corners else {
            continue;
        };
        let face = match (is_fan, place % 2) {
            (true, _) => [b, c, first],
            (false, 0) => [a, b, c],
            (false, _) => [a, c, b],
        };
        let [a, b, c] = face;
        if a != b && b != c && a != c {
            faces.push(face);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_have_the_corners_that_the_format_gives() {
        let triangles = |numbers: &[u32], is_fan| {
            let mut faces = Vec::new();
            add_faces(numbers, is_fan, &mut faces);
            faces
        };
        let numbers = [5, 6, 7, 8, 9];
        let strip = [[5, 6, 7], [6, 8, 7], [7, 8, 9]];
        assert_eq!(triangles(&numbers, false), strip);
        let fan = [[6, 7, 5], [7, 8, 5], [8, 9, 5]];
        assert_eq!(triangles(&numbers, true), fan);
        // Stitched: two triangles with a vertex twice, and the winding goes on.
        let stitched = [[0, 1, 2], [2, 4, 3]];
        assert_eq!(triangles(&[0, 1, 2, 2, 3, 4], false), stitched);
        assert!(triangles(&[0, 1], false).is_empty() && triangles(&[], true).is_empty());
    }
}
