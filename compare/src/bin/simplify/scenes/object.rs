//! An object of a scene as one mesh, with all that is stored with its vertices.

use std::ops::Range;

use compare::greedy;
use meshweft::Mesh;
use meshweft::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use meshweft::files::Document;
use meshweft::operations::{SimplifyOptions, simplify};
use meshweft::order::{Effort, KCacheReorder, vertex_fetch};
use meshweft::progressive::{Collapses, ProgressiveMesh};

/// Meshes of a file that are simplified together, as `operations::simplify` joins them: the primitives of a
/// glTF mesh.
pub(crate) struct SceneObject {
    /// Primitive after primitive; no vertex is of two of them.
    pub(crate) mesh: Mesh,
    /// Of the vertices; the last one is the primitive.
    pub(crate) attributes: Vec<Attribute>,
    /// The faces of each primitive.
    pub(crate) primitives: Vec<Range<usize>>,
    /// Whether other faces may meet these, so that open edges stay.
    has_other_faces: bool,
}

impl SceneObject {
    /// All objects of a document that have faces.
    pub(crate) fn all(document: &mut Document) -> Result<Vec<Self>, String> {
        // A run that takes nothing away says which meshes belong together.
        let options = SimplifyOptions {
            ratio: Some(1.0),
            samples: 0,
            ..SimplifyOptions::default()
        };
        let report = simplify(document, &options, &()).map_err(|it| it.to_string())?;
        let objects = report.objects.iter();
        objects.map(|it| Self::new(document, &it.meshes)).collect()
    }

    fn new(document: &Document, meshes: &[usize]) -> Result<Self, String> {
        let (mut positions, mut faces) = (Vec::new(), Vec::new());
        let (mut primitives, mut parts) = (Vec::new(), Vec::new());
        let mut columns: Vec<(AttributeInfo, Vec<f32>)> = Vec::new();
        for &number in meshes {
            // Near faces near each other, and the vertices that are used, by first use.
            let entry = &document.meshes()[number];
            let sequence = KCacheReorder {
                keep_corners: true,
                ..greedy(15)
            };
            let own = entry
                .mesh
                .with_face_order(&sequence.face_order(&entry.mesh));
            let order = vertex_fetch(&own);
            let own = order.renumber(own.faces());
            let count = own.as_flattened().iter().max().map_or(0, |&most| most + 1);
            let used = &order.new_to_old()[..count as usize];
            let start = positions.len();
            let base = u32::try_from(start).map_err(|_| "too many vertices")?;
            primitives.push(faces.len()..faces.len() + own.len());
            faces.extend(own.iter().map(|face| face.map(|vertex| base + vertex)));
            parts.extend(used.iter().map(|_| index(number)));

            // What they store; zeros where a primitive does not have it.
            let read = document.positions(number).map_err(|it| it.to_string())?;
            let read = read.ok_or_else(|| format!("{}: no positions", entry.name))?;
            positions.extend(used.iter().map(|&vertex| read[vertex as usize]));
            for info in document.attributes(number) {
                let is_position =
                    info.semantic == Semantic::Position && info.morph_target.is_none();
                if is_position || info.domain != Domain::Vertex {
                    continue;
                }
                let attribute = document.attribute(number, &info);
                let values = attribute.map_err(|it| it.to_string())?.to_f32();
                let found = columns.iter().position(|(known, _)| *known == info);
                let column = found.unwrap_or_else(|| {
                    columns.push((info.clone(), Vec::new()));
                    columns.len() - 1
                });
                let column = &mut columns[column].1;
                column.resize(start * info.components, 0.0);
                for &vertex in used {
                    let element = &values[vertex as usize * info.components..][..info.components];
                    column.extend_from_slice(element);
                }
            }
        }

        let attributes = columns.into_iter().map(|(mut info, mut values)| {
            values.resize(positions.len() * info.components, 0.0);
            info.component_type = ComponentType::F32;
            info.is_normalized = false;
            Attribute::new(info, Values::F32(values))
        });
        let mut attributes: Vec<Attribute> = attributes.collect();
        let part = Semantic::Other("part".to_owned());
        let part = AttributeInfo::new(part, Domain::Vertex, 1, ComponentType::U32);
        attributes.push(Attribute::new(part, Values::U32(parts)));
        Ok(Self {
            mesh: Mesh::new(positions, faces).map_err(|it| it.to_string())?,
            attributes,
            primitives,
            has_other_faces: meshes
                .iter()
                .any(|&mesh| document.meshes()[mesh].has_other_faces),
        })
    }

    /// The object with all its levels, as far as it goes, with the settings of `operations::simplify`.
    pub(crate) fn levels(
        &self,
        effort: Effort,
        drop_parts: bool,
    ) -> Result<ProgressiveMesh, String> {
        let settings = Collapses {
            effort,
            drop_parts,
            lock_border: self.has_other_faces,
            ..Collapses::default()
        };
        let built = settings.build(&self.mesh, &self.attributes);
        built.map_err(|it| it.to_string())
    }
}

fn index(number: usize) -> u32 {
    u32::try_from(number).expect("fewer meshes than that")
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshweft::Limits;

    /// The table is about what the program makes: as many faces an object as `simplify` leaves of it.
    #[test]
    fn levels_are_those_of_simplify() {
        let Some(data) = compare::data_folder() else {
            compare::say("levels of scenes: no test data, skipped");
            return;
        };
        for name in ["Duck.glb", "2CylinderEngine.glb", "Fox.glb"] {
            let file = data.join("gltf").join(name);
            let open = || Document::open(&file, Limits::default()).expect("a sound scene");
            let objects = SceneObject::all(&mut open()).expect("it can be simplified");
            let options = SimplifyOptions {
                ratio: Some(0.25),
                ..SimplifyOptions::default()
            };
            let report = simplify(&mut open(), &options, &()).expect("it can be simplified");
            assert_eq!(objects.len(), report.objects.len(), "{name}");
            for (object, expected) in objects.iter().zip(&report.objects) {
                let levels = object.levels(Effort::Fast, false).expect("sound faces");
                let level = levels.level_of_faces(expected.goal);
                let found = [object.mesh.face_count(), levels.face_count(level)];
                assert_eq!(found, expected.faces, "{name}");
                assert_eq!(levels.error(level), expected.estimated_error, "{name}");
            }
        }
    }
}
