//! OBJ by `tobj`.

use std::io::Cursor;
use std::path::Path;

use meshweft::attribute::{AttributeInfo, Domain, Semantic};
use tobj::Model;

use crate::tally::{Opened, Tally, bits, bits_of_f32};

/// What `tobj` has for the vertices that it makes of corners.
struct Layer {
    components: usize,
    of_model: fn(&Model) -> &[f32],
}

impl Layer {
    /// That of an attribute.
    fn of(semantic: &Semantic) -> Self {
        match semantic {
            Semantic::Position => Self {
                components: 3,
                of_model: |model| &model.mesh.positions,
            },
            Semantic::Color(0) => Self {
                components: 3,
                of_model: |model| &model.mesh.vertex_color,
            },
            Semantic::TexCoord(0) => Self {
                components: 2,
                of_model: |model| &model.mesh.texcoords,
            },
            Semantic::Normal => Self {
                components: 3,
                of_model: |model| &model.mesh.normals,
            },
            other => panic!("tobj has no {other}"),
        }
    }

    fn is_anywhere(&self, models: &[Model]) -> bool {
        models
            .iter()
            .any(|model| !(self.of_model)(model).is_empty())
    }

    /// Whether every vertex has one.
    fn is_everywhere(&self, models: &[Model]) -> bool {
        let has_all = |model: &Model| {
            let vertices = model.mesh.positions.len() / 3;
            (self.of_model)(model).len() == vertices * self.components
        };
        models.iter().all(has_all)
    }

    /// The values of all corners, if every vertex has one.
    fn of_corners(&self, models: &[Model]) -> Vec<u64> {
        let components = self.components;
        let of_model = |model: &Model| {
            let values = bits_of_f32((self.of_model)(model));
            let element =
                |&corner: &u32| values[corner as usize * components..][..components].to_vec();
            model
                .mesh
                .indices
                .iter()
                .flat_map(element)
                .collect::<Vec<u64>>()
        };
        models.iter().flat_map(of_model).collect()
    }
}

/// The triangles of all models, which are in the order of the file.
fn read(bytes: &[u8]) -> Result<Vec<Model>, String> {
    let options = tobj::LoadOptions {
        single_index: true,
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
    };
    let no_materials = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let read = tobj::load_obj_buf(&mut Cursor::new(bytes), &options, no_materials);
    read.map(|(models, _)| models)
        .map_err(|error| error.to_string())
}

fn compare(file: &Opened, tally: &mut Tally) -> Result<(), String> {
    let models = read(&file.bytes)?;
    let infos = file.attributes();
    for info in &infos {
        compare_attribute(file, info, &models, tally);
    }

    // What is not listed must not be there for every corner.
    let listed = |semantic: &Semantic| infos.iter().any(|info| info.semantic == *semantic);
    for semantic in [Semantic::Color(0), Semantic::TexCoord(0), Semantic::Normal] {
        let layer = Layer::of(&semantic);
        if listed(&semantic) || !layer.is_anywhere(&models) {
            continue;
        }
        let name = &file.name;
        assert!(
            !layer.is_everywhere(&models),
            "{name}: {semantic} is not listed"
        );
        tally.leave_out(1, &format!("{semantic} that only some corners have"));
    }

    // Vertices are compared as corners, so those that are not a corner are not.
    let mesh = &file.document.meshes()[0].mesh;
    let mut is_named = vec![false; mesh.vertex_count()];
    for &vertex in mesh.faces().as_flattened() {
        is_named[vertex as usize] = true;
    }
    let unnamed = is_named.iter().filter(|named| !**named).count();
    tally.leave_out(unnamed, "vertices that no face names, which tobj drops");
    Ok(())
}

fn compare_attribute(file: &Opened, info: &AttributeInfo, models: &[Model], tally: &mut Tally) {
    let layer = Layer::of(&info.semantic);

    // Ours by corner, without what tobj drops.
    let mut ours = bits(&file.read(info).values);
    let components = info.components;
    if info.domain == Domain::Vertex {
        ours = file.of_corners(&ours, components);
    }
    if components > layer.components {
        let first = |element: &[u64]| element[..layer.components].to_vec();
        ours = ours.chunks(components).flat_map(first).collect();
        let what = format!(
            "component {components} of {}, which tobj drops",
            info.semantic
        );
        tally.leave_out(1, &what);
    }

    // Every corner must have one.
    assert!(
        layer.is_everywhere(models),
        "{}: tobj has not {} for every corner",
        file.name,
        info.semantic
    );
    let theirs = layer.of_corners(models);
    tally.compare((file, info), layer.components, &ours, &theirs);
}

#[test]
fn tobj_reads_the_same_values() {
    Tally::of_files("OBJ, tobj", "obj", crate::made::obj(), compare);
}
