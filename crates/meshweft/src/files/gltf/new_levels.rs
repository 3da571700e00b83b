//! Levels of detail of meshes that are there: index lists at the end of a buffer, meshes that draw them, and
//! nodes that stand in for others (the extension `MSFT_lod`).

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use serde_json::json;

use super::GltfFile;
use super::culling;
use super::growth::Growth;
use super::json::Value;
use super::level_nodes::{
    LevelNodes, LeveledMesh, extensions_without, level_name, member, members_without,
};
use super::levels::{EXTRAS, NAME};
use super::movable::PrimitiveNumber;
use super::new_meshes::NewMeshes;
use super::object::{Object, primitives_of, primitives_of_mesh};
use super::vertex_copies::VertexCopier;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::new_levels::{NewLevels, screen_coverage};
use crate::files::note::Note;
use crate::index::index32;
use crate::permutation::renumber;

/// Extensions of a primitive that are of its own list of faces.
const OF_FACES: [&str; 2] = [culling::NAME, "CESIUM_primitive_outline"];

impl GltfFile {
    /// See [`Edit::Levels`](crate::files::Edit::Levels); on an error nothing is changed.
    pub(super) fn add_levels(&mut self, meshes: &[NewLevels]) -> Result<Vec<Note>, Problem> {
        let json = super::read_json(&self.container, &self.options.limits)?;
        let root = Object::new(json.root(), String::new())?;
        let growth = Growth::new(&root, &self.container, &self.buffers);
        let mut new = NewMeshes::new(&root, growth.buffer, growth.start)?;

        // Index lists, and copies of vertices.
        let mut lists = BTreeMap::new();
        let copier = match meshes.iter().any(|levels| !levels.copies.is_empty()) {
            true => Some(VertexCopier::new(self, &root)?),
            false => None,
        };
        for levels in meshes {
            lists.insert(levels.mesh, self.lists(levels, copier.as_ref(), &mut new)?);
        }

        // A mesh for each level of a mesh, and nodes that draw it.
        let mut leveled: BTreeMap<usize, LeveledMesh> = BTreeMap::new();
        for (number, value) in root.array("meshes")?.into_iter().enumerate() {
            let source = SourceMesh { number, value };
            if let Some(mesh) = self.levels_of(&source, &lists, &mut new)? {
                leveled.insert(number, mesh);
            }
        }
        let mut notes = LevelNodes::new(&root, &leveled)?.add_to(&mut new);

        let used = root.array("extensionsUsed")?;
        if !used
            .iter()
            .any(|name| name.text().is_some_and(|it| it == NAME))
        {
            new.value(["extensionsUsed", "-"], json!(NAME).to_string());
        }
        let (bytes, additions) = new.finish();
        notes.extend(self.grow(growth, bytes, additions)?);
        Ok(notes)
    }

    /// See [`Content::draws_alike`](crate::files::content::Content::draws_alike). Time O(JSON log JSON).
    pub(super) fn found_alike(&self) -> Vec<bool> {
        let entries = &self.view.entries;
        let mut is_alike = vec![true; entries.meshes.len()];
        // It was read before, and is an object.
        let Ok(json) = super::read_json(&self.container, &self.options.limits) else {
            return is_alike;
        };
        let meshes = primitives_of(json.root());
        let vertices = |number: PrimitiveNumber| {
            let primitive = meshes[number.mesh as usize][number.primitive as usize];
            ["attributes", "targets"].map(|name| primitive.get(name).map(Value::raw))
        };
        for (&other, &first) in &entries.repeated {
            if let Some(mesh) = entries.mesh_of(first) {
                is_alike[mesh] &= vertices(other) == vertices(first);
            }
        }
        is_alike
    }

    /// Stores the index lists of the levels of a mesh, and the vertices that they have copies of.
    fn lists<'l>(
        &self,
        levels: &'l NewLevels,
        copier: Option<&VertexCopier<'_>>,
        new: &mut NewMeshes<'_>,
    ) -> Result<StoredLevels<'l>, Problem> {
        let entries = &self.view.entries;
        let first = entries.first_primitives[levels.mesh];
        let mut vertex_count = entries.meshes[levels.mesh].mesh.vertex_count();
        levels
            .check(vertex_count)
            .map_err(|kind| kind.at(Place::Json(first.pointer())))?;

        // The vertices of the primitive, or copies with numbers of their own.
        if self.has_indices(levels.mesh) != levels.copies.is_empty() {
            let text = match levels.copies.is_empty() {
                true => "it has no index list, so its levels need copies of its vertices",
                false => "it has an index list, so its levels have its own vertices and no copies",
            };
            return Err(FileErrorKind::unsupported(text).at(Place::Json(first.pointer())));
        }
        let copier = copier.filter(|_| !levels.copies.is_empty());
        let mut copies = None;
        let mut numbers = Vec::new();
        if let Some(copier) = copier {
            copies = Some(copier.copy(levels.mesh, &levels.copies, new)?);
            numbers.resize(vertex_count, 0);
            for (copy, &vertex) in (0_u32..).zip(&levels.copies) {
                numbers[vertex as usize] = copy;
            }
            vertex_count = levels.copies.len();
        }

        let mut lists: Vec<Option<usize>> = Vec::with_capacity(levels.levels.len());
        for level in &levels.levels {
            let mut stored = level.faces.as_deref().map(Cow::Borrowed);
            if copies.is_some() {
                stored = stored.map(|mut faces| {
                    renumber(faces.to_mut(), &numbers);
                    faces
                });
            }
            let stored = stored.map(|faces| new.indices(&faces, vertex_count));
            lists.push(stored.or(lists.last().copied().flatten()));
        }
        Ok(StoredLevels {
            lists,
            copies,
            levels,
        })
    }

    /// Adds the levels of a mesh, if one of its primitives has some.
    fn levels_of(
        &self,
        source: &SourceMesh<'_>,
        lists: &BTreeMap<usize, StoredLevels<'_>>,
        new: &mut NewMeshes<'_>,
    ) -> Result<Option<LeveledMesh>, Problem> {
        let primitives = primitives_of_mesh(source.value);
        let of_primitive: Vec<Option<&StoredLevels<'_>>> = (0..primitives.len())
            .map(|primitive| {
                let (mesh, primitive) = (index32(source.number), index32(primitive));
                let number = PrimitiveNumber { mesh, primitive };
                lists.get(&self.view.entries.mesh_of(number)?)
            })
            .collect();
        let with_levels = of_primitive.iter().flatten();
        let counts: BTreeSet<usize> = with_levels.clone().map(|it| it.lists.len()).collect();
        let Some(&count) = counts.first() else {
            return Ok(None);
        };
        if counts.len() > 1 {
            let text = "its primitives are to have different numbers of levels";
            let place = Place::Json(format!("/meshes/{}", source.number));
            return Err(FileErrorKind::unsupported(text).at(place));
        }

        // One radius and one error for all that is drawn together.
        let radius = with_levels.clone().map(|it| it.levels.radius);
        let radius = radius.fold(0.0, f64::max);
        let mut meshes = Vec::with_capacity(count);
        let mut coverages = Vec::with_capacity(count + 1);
        let mut least_coverage = 1.0_f64;
        for level in 0..count {
            let errors = with_levels.clone().map(|it| it.levels.levels[level].error);
            let error = errors.fold(0.0, f64::max);
            least_coverage = least_coverage.min(screen_coverage(radius, error));
            coverages.push(least_coverage);

            let texts = primitives.iter().zip(&of_primitive);
            let texts = texts.map(|(primitive, stored)| {
                let stored = stored.and_then(|it| Some((it, it.lists[level]?)));
                primitive_text(*primitive, stored)
            });
            let texts: Vec<String> = texts.collect();
            let stored = of_primitive.iter();
            let vertices = stored.map(|it| it.map(|it| it.levels.levels[level].vertices));
            let vertices: Vec<Option<usize>> = vertices.collect();
            let said = json!({ "level": level + 1, "error": error, "vertices": vertices });
            let members = source.members(level + 1, &texts.join(","), &said.to_string());
            meshes.push(new.mesh(format!("{{{members}}}")));
        }
        coverages.push(0.0);
        Ok(Some(LeveledMesh { meshes, coverages }))
    }
}

/// The index lists of the levels of a mesh.
struct StoredLevels<'l> {
    /// The accessor of each; `None` for the full mesh.
    lists: Vec<Option<usize>>,
    /// The members of a primitive that are of its vertices, if the lists are of copies.
    copies: Option<Vec<String>>,
    levels: &'l NewLevels,
}

/// A mesh of the file.
struct SourceMesh<'a> {
    number: usize,
    value: Value<'a>,
}

impl SourceMesh<'_> {
    /// The text of a level of it, without braces: what is not of its own faces is as in the mesh.
    fn members(&self, level: usize, primitives: &str, said: &str) -> String {
        let mut members = Vec::new();
        members.extend(level_name(self.value, level));
        members.push(format!(r#""primitives":[{primitives}]"#));
        let weights = self.value.get("weights");
        members.extend(weights.map(|weights| format!(r#""weights":{}"#, weights.raw())));

        // The names of morph targets are in its extras.
        let extras = self.value.get("extras").filter(|extras| extras.is_object());
        let extras = extras.map(|extras| members_without(extras, &[EXTRAS]));
        let mut extras = extras.unwrap_or_default();
        extras.push(member(EXTRAS, said));
        members.push(format!(r#""extras":{{{}}}"#, extras.join(",")));
        members.join(",")
    }
}

/// The text of a primitive at a level, if it has a list of faces there.
fn primitive_text(primitive: Value<'_>, stored: Option<(&StoredLevels<'_>, usize)>) -> String {
    let Some((levels, indices)) = stored else {
        return primitive.raw().to_owned();
    };
    let of_vertices: &[&str] = match &levels.copies {
        Some(_) => &["attributes", "targets"],
        None => &[],
    };
    let left_out = [&["indices", "extensions"], of_vertices].concat();
    let mut members = members_without(primitive, &left_out);
    members.extend(levels.copies.iter().flatten().cloned());
    let extensions = primitive.get("extensions");
    members.extend(extensions.and_then(|all| extensions_without(all, &OF_FACES)));
    members.push(format!(r#""indices":{indices}"#));
    format!("{{{}}}", members.join(","))
}
