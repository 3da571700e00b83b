//! Attributes: what is listed, and that values follow the vertices.

use meshweft::VertexOrder;
use meshweft::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use meshweft::files::{Document, Edit, FileErrorKind, Place};
use serde_json::{Value, json};

use crate::builder::{Builder, F32, U8, U16, faces};
use crate::data::scenes;
use crate::moves::open;
use crate::{Random, random_orders};

const I8: usize = 5120;
const I16: usize = 5122;
const F64: usize = 5130;
const I64: usize = 5134;

/// The components as 64-bit patterns, element after element.
fn bits(attribute: &Attribute) -> Vec<Vec<u64>> {
    let bits: Vec<u64> = match &attribute.values {
        Values::I8(values) => values
            .iter()
            .map(|&v| u64::from(v.cast_unsigned()))
            .collect(),
        Values::U8(values) => values.iter().map(|&v| u64::from(v)).collect(),
        Values::I16(values) => values
            .iter()
            .map(|&v| u64::from(v.cast_unsigned()))
            .collect(),
        Values::U16(values) => values.iter().map(|&v| u64::from(v)).collect(),
        Values::I32(values) => values
            .iter()
            .map(|&v| u64::from(v.cast_unsigned()))
            .collect(),
        Values::U32(values) => values.iter().map(|&v| u64::from(v)).collect(),
        Values::F32(values) => values.iter().map(|v| u64::from(v.to_bits())).collect(),
        Values::F64(values) => values.iter().map(|v| v.to_bits()).collect(),
        other => panic!("{other:?}"),
    };
    let elements = bits.chunks(attribute.info.components);
    elements.map(<[u64]>::to_vec).collect()
}

fn info(
    semantic: Semantic,
    components: usize,
    component_type: ComponentType,
    is_normalized: bool,
) -> AttributeInfo {
    let mut info = AttributeInfo::new(semantic, Domain::Vertex, components, component_type);
    info.is_normalized = is_normalized;
    info
}

/// The attribute that is written like this: `POSITION`, and `0: POSITION` of a morph target.
fn named(document: &Document, mesh: usize, name: &str) -> Attribute {
    let infos = document.attributes(mesh);
    let is_it = |info: &&AttributeInfo| match info.morph_target {
        Some(target) => format!("{target}: {}", info.semantic) == name,
        None => info.semantic.to_string() == name,
    };
    let info = infos.iter().find(is_it);
    let info = info.unwrap_or_else(|| panic!("{name} is not listed"));
    document.attribute(mesh, info).unwrap()
}

const COUNT: usize = 40;

/// A tight accessor whose bytes are those that `bytes` gives for each vertex.
fn of_each<const SIZE: usize>(
    builder: &mut Builder,
    component: usize,
    name: &str,
    bytes: impl Fn(u8) -> [u8; SIZE],
) -> usize {
    let bytes: Vec<u8> = (0..COUNT)
        .flat_map(|vertex| bytes(u8::try_from(vertex).unwrap()))
        .collect();
    let view = builder.view(&bytes, None);
    builder.accessor(view, 0, component, COUNT, name)
}

fn float(vertex: u8) -> [u8; 4] {
    f32::from(vertex).to_le_bytes()
}

fn sparse(builder: &mut Builder, numbers: &[u8], values: &[u8]) -> Value {
    let (indices, values) = (builder.view(numbers, None), builder.view(values, None));
    json!({"count": numbers.len(),
        "indices": {"bufferView": indices, "componentType": U8},
        "values": {"bufferView": values}})
}

/// A mesh with every kind of accessor; vertex `i` has `i` as the first number of its position.
fn scene() -> Vec<u8> {
    let builder = &mut Builder::default();
    // Positions and colours lie between each other, with a hole.
    let interleaved: Vec<u8> = (0..COUNT)
        .flat_map(|i| {
            let i = u8::try_from(i).unwrap();
            let position = [float(i), float(i + 1), float(i + 2)].concat();
            [position, vec![i, 255 - i, 3, 4], vec![0xEE; 4]].concat()
        })
        .collect();
    let view = builder.view(&interleaved, Some(20));
    let position = builder.accessor(view, 0, F32, COUNT, "VEC3");
    let color = builder.accessor(view, 12, U8, COUNT, "VEC4");
    builder.accessors[color]["normalized"] = true.into();
    let texture = of_each(builder, U16, "VEC2", |i| [i, 1, 2, i]);
    builder.accessors[texture]["normalized"] = true.into();

    // Columns of three bytes each take four.
    let narrow = of_each(builder, U8, "MAT3", |i| {
        [i, 1, 2, 0xEE, 3, 4, 5, 0xEE, 6, 7, i, 0xEE]
    });
    let pair = of_each(builder, I8, "MAT2", |i| {
        [i, 1, 0xEE, 0xEE, 0xFF, i, 0xEE, 0xEE]
    });
    let wide = of_each(builder, F32, "MAT4", |i| {
        let mut bytes = [0; 64];
        bytes[4..8].copy_from_slice(&float(i));
        bytes[60..].copy_from_slice(&float(7));
        bytes
    });
    let short = of_each(builder, I16, "SCALAR", |i| [i, 0xFF]);
    let double = of_each(builder, F64, "SCALAR", |i| f64::from(i).to_le_bytes());
    let long = of_each(builder, I64, "SCALAR", |i| [i; 8]);

    // Morph targets: sparse over a base, sparse over zeros, zeros alone.
    let base = of_each(builder, I8, "VEC3", |i| [i, 0, 0x80]);
    builder.accessors[base]["normalized"] = true.into();
    builder.accessors[base]["sparse"] = sparse(builder, &[2, 39], &[1, 2, 3, 4, 5, 6]);
    let mut zeros = || {
        builder
            .accessors
            .push(json!({"componentType": U8, "count": COUNT, "type": "VEC2"}));
        builder.accessors.len() - 1
    };
    let (replaced, all_zeros) = (zeros(), zeros());
    builder.accessors[replaced]["sparse"] = sparse(builder, &[0, 5], &[8, 9, 10, 11]);

    let indices = builder.indices(U16, &faces(60, COUNT));
    builder.glb(
        &json!([{"primitives": [{
            "attributes": {"POSITION": position, "COLOR_0": color, "TEXCOORD_3": texture,
                "_NARROW": narrow, "_PAIR": pair, "_WIDE": wide, "_SHORT": short,
                "_DOUBLE": double, "_LONG": long},
            "targets": [{"NORMAL": base}, {"TEXCOORD_0": replaced, "_ZEROS\"": all_zeros}],
            "indices": indices,
        }]}]),
        &json!({}),
    )
}

/// Asserts that every vertex has what the vertex with its number had at first.
fn check_values(document: &Document) {
    let positions = document.positions(0).unwrap().unwrap();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "small numbers"
    )]
    let ids: Vec<u8> = positions.iter().map(|position| position[0] as u8).collect();
    let u8s = |name: &str, expected: &dyn Fn(u8) -> Vec<u8>| {
        let expected = ids.iter().flat_map(|&id| expected(id)).collect();
        assert_eq!(
            named(document, 0, name).values,
            Values::U8(expected),
            "{name}"
        );
    };
    let i8s = |name: &str, expected: &dyn Fn(i8) -> Vec<i8>| {
        let expected = ids.iter().flat_map(|&id| expected(id.cast_signed()));
        let expected = Values::I8(expected.collect());
        assert_eq!(named(document, 0, name).values, expected, "{name}");
    };

    for (position, &id) in positions.iter().zip(&ids) {
        let id = f32::from(id);
        assert_eq!(*position, [id, id + 1.0, id + 2.0]);
    }
    u8s("COLOR_0", &|i| vec![i, 255 - i, 3, 4]);
    u8s("_NARROW", &|i| vec![i, 1, 2, 3, 4, 5, 6, 7, i]);
    i8s("_PAIR", &|i| vec![i, 1, -1, i]);
    i8s("0: NORMAL", &|i| match i {
        2 => vec![1, 2, 3],
        39 => vec![4, 5, 6],
        _ => vec![i, 0, -128],
    });
    u8s("1: TEXCOORD_0", &|i| match i {
        0 => vec![8, 9],
        5 => vec![10, 11],
        _ => vec![0, 0],
    });
    u8s("1: _ZEROS\"", &|_| vec![0, 0]);

    let texture = named(document, 0, "TEXCOORD_3");
    let expected = ids
        .iter()
        .flat_map(|&i| [256 + u16::from(i), 256 * u16::from(i) + 2]);
    assert_eq!(texture.values, Values::U16(expected.collect()));
    let expected = ids.iter().map(|&i| i16::from(i) - 256);
    assert_eq!(
        named(document, 0, "_SHORT").values,
        Values::I16(expected.collect())
    );
    let expected = ids.iter().map(|&i| f64::from(i));
    assert_eq!(
        named(document, 0, "_DOUBLE").values,
        Values::F64(expected.collect())
    );
    let expected = ids.iter().flat_map(|&i| {
        let mut matrix = [0.0; 16];
        (matrix[1], matrix[15]) = (f32::from(i), 7.0);
        matrix
    });
    assert_eq!(
        named(document, 0, "_WIDE").values,
        Values::F32(expected.collect())
    );
}

#[test]
fn every_kind_of_accessor_is_listed_and_follows_its_vertices() {
    let mut document = open(&scene());
    let other = |name: &str| Semantic::Other(name.to_owned());
    let target = |number, mut info: AttributeInfo| {
        info.morph_target = Some(number);
        info
    };
    let mut listed = document.attributes(0);
    listed.sort_by_key(|info| (info.morph_target, info.semantic.clone()));
    let expected = [
        info(Semantic::Position, 3, ComponentType::F32, false),
        info(Semantic::TexCoord(3), 2, ComponentType::U16, true),
        info(Semantic::Color(0), 4, ComponentType::U8, true),
        info(other("_DOUBLE"), 1, ComponentType::F64, false),
        info(other("_NARROW"), 9, ComponentType::U8, false),
        info(other("_PAIR"), 4, ComponentType::I8, false),
        info(other("_SHORT"), 1, ComponentType::I16, false),
        info(other("_WIDE"), 16, ComponentType::F32, false),
        target(0, info(Semantic::Normal, 3, ComponentType::I8, true)),
        target(1, info(Semantic::TexCoord(0), 2, ComponentType::U8, false)),
        target(1, info(other("_ZEROS\""), 2, ComponentType::U8, false)),
    ];
    assert_eq!(listed, expected);
    check_values(&document);
    assert!(document.meshes()[0].vertices_movable);
    for seed in 0..5 {
        random_orders(&mut document, seed);
        check_values(&document);
    }
    let fractions = named(&document, 0, "0: NORMAL").to_f32();
    assert!(fractions.contains(&-1.0) && fractions.iter().all(|f| f.abs() <= 1.0));
}

#[test]
fn faces_name_the_vertices_whose_values_are_read() {
    let mut document = open(&scene());
    let corners = |document: &Document| -> Vec<[u32; 3]> {
        let positions = document.positions(0).unwrap().unwrap();
        let id = |vertex: u32| positions[vertex as usize][0].to_bits();
        let faces = document.meshes()[0].mesh.faces().iter();
        faces.map(|face| face.map(id)).collect()
    };
    let before = corners(&document);
    let mut random = Random(3);
    let faces = random.face_order(60);
    let vertices = VertexOrder::from(random.permutation(COUNT));
    document.edit(Edit::order(0, &faces, &vertices)).unwrap();
    assert_eq!(corners(&document), faces.apply(&before));
}

#[test]
fn what_is_not_listed_cannot_be_read() {
    let document = open(&scene());
    let wanted = info(Semantic::Normal, 3, ComponentType::F32, false);
    let error = document.attribute(0, &wanted).unwrap_err();
    assert_eq!(
        error.to_string(),
        "scene.glb: this mesh has no attribute NORMAL: take one of those that are listed"
    );
}

#[test]
fn sparse_elements_are_read_where_they_cannot_be_moved() {
    // Numbers of one byte do not reach all vertices; and numbers that fall.
    for (numbers, is_sound) in [([7, 250], true), ([250, 7], false)] {
        let builder = &mut Builder::default();
        let position = builder.data(F32, "VEC3", 300);
        let color = builder.data(U8, "VEC4", 300);
        builder.accessors[color]["sparse"] = sparse(builder, &numbers, &[1, 2, 3, 4, 5, 6, 7, 8]);
        let indices = builder.indices(U16, &faces(300, 300));
        let primitive = json!({"attributes": {"POSITION": position, "COLOR_0": color},
            "indices": indices});
        let document = open(&builder.glb(&json!([{"primitives": [primitive]}]), &json!({})));
        assert!(!document.meshes()[0].vertices_movable);
        let wanted = info(Semantic::Color(0), 4, ComponentType::U8, false);
        match document.attribute(0, &wanted) {
            Ok(colors) => {
                assert!(is_sound);
                let elements = bits(&colors);
                assert_eq!(
                    (&elements[7][..], &elements[250][..]),
                    (&[1, 2, 3, 4][..], &[5, 6, 7, 8][..])
                );
            }
            Err(error) => {
                assert!(!is_sound);
                assert_eq!(error.place, Place::Json("/accessors/1/sparse".into()));
                assert!(matches!(error.kind, FileErrorKind::Malformed { .. }));
            }
        }
    }
}

#[test]
fn sparse_matrices_have_room_between_them() {
    let builder = &mut Builder::default();
    let position = of_each(builder, U8, "VEC3", |i| [i; 3]);
    let narrow = of_each(builder, U8, "MAT3", |_| [0; 12]);
    // The room at the end of the last one may be left out.
    let matrix = |i: u8| [i, 1, 2, 0xEE, 3, 4, 5, 0xEE, 6, 7, i, 0xEE];
    let matrices = &[matrix(5), matrix(20)].concat()[..23];
    builder.accessors[narrow]["sparse"] = sparse(builder, &[5, 20], matrices);
    let meshes = json!([{"primitives": [{"indices": builder.indices(U16, &faces(60, COUNT)),
        "attributes": {"POSITION": position, "_NARROW": narrow}}]}]);
    let mut document = open(&builder.glb(&meshes, &json!({})));
    for seed in 0..5 {
        let [ids, matrices] = ["POSITION", "_NARROW"].map(|name| bits(&named(&document, 0, name)));
        for (id, matrix) in ids.iter().zip(matrices) {
            let scale = u64::from([5, 20].contains(&id[0]));
            let replaced = [id[0], 1, 2, 3, 4, 5, 6, 7, id[0]];
            assert_eq!(matrix, replaced.map(|n| n * scale));
        }
        random_orders(&mut document, seed);
    }
}

#[test]
fn a_mesh_of_several_primitives_lists_those_of_the_first() {
    let builder = &mut Builder::default();
    let first = builder.data(F32, "VEC3", 20);
    let second = builder.data(F32, "VEC3", 20);
    let color = builder.data(U8, "VEC4", 20);
    let indices = builder.indices(U8, &faces(12, 20));
    let document = open(&builder.glb(
        &json!([{"primitives": [
            {"attributes": {"POSITION": first}, "indices": indices},
            {"attributes": {"POSITION": second, "COLOR_0": color}, "indices": indices},
            {"attributes": {"POSITION": second, "COLOR_0": color}},
            {"attributes": {"POSITION": second, "COLOR_0": color}, "mode": 0},
        ]}]),
        &json!({}),
    ));
    assert_eq!(document.meshes().len(), 1);
    let position = info(Semantic::Position, 3, ComponentType::F32, false);
    assert_eq!(document.attributes(0), [position]);
}

/// Of each vertex all its values, sorted.
fn vertices(document: &Document, mesh: usize) -> Vec<Vec<u64>> {
    let count = document.meshes()[mesh].mesh.vertex_count();
    let mut vertices = vec![Vec::new(); count];
    for info in document.attributes(mesh) {
        let attribute = document.attribute(mesh, &info).unwrap();
        assert_eq!((&attribute.info, attribute.len()), (&info, count));
        for (vertex, element) in vertices.iter_mut().zip(bits(&attribute)) {
            vertex.extend(element);
        }
    }
    vertices.sort_unstable();
    vertices
}

#[test]
fn real_scenes_have_the_same_values_in_any_order() {
    let (scenes, mut attribute_count) = (scenes(), 0);
    for path in &scenes {
        let mut document = Document::open(path, meshweft::Limits::default()).unwrap();
        let meshes = 0..document.meshes().len();
        let all = |document: &Document| -> Vec<_> {
            meshes
                .clone()
                .map(|mesh| vertices(document, mesh))
                .collect()
        };
        let before = all(&document);
        random_orders(&mut document, 5);
        assert!(before == all(&document), "{}", path.display());
        for mesh in meshes.clone() {
            assert!(document.positions(mesh).unwrap().is_some());
            attribute_count += document.attributes(mesh).len();
        }
    }
    println!(
        "ran {} scenes, {attribute_count} attributes; skipped 0",
        scenes.len()
    );
}
