//! Files made of new meshes hold what was given, and say what they cannot hold.
#![cfg(feature = "files")]

#[path = "data/folder.rs"]
mod data;
#[path = "files_create/disk.rs"]
mod disk;
#[path = "files_create/plain.rs"]
mod plain;
#[path = "files_create/polygons.rs"]
mod polygons;
#[path = "files_create/real.rs"]
mod real;
#[path = "files_create/refused.rs"]
mod refused;

use meshweft::Limits;
use meshweft::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use meshweft::files::{Document, Format, NewMesh, NewVertices};

/// Four vertices, two faces.
const FACES: [[u32; 3]; 2] = [[0, 1, 2], [2, 1, 3]];
const VERTICES: u8 = 4;

fn positions() -> Attribute {
    let corners = [
        [0.1, 0.0, -0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 3e-40],
    ];
    Attribute::of_vertices(Semantic::Position, &corners)
}

/// Values that differ, `elements` of `components` each.
fn values(kind: ComponentType, elements: u8, components: u8) -> Values {
    let numbers = (0..elements * components).map(|i| i * 5 + 1);
    match kind {
        ComponentType::I8 => Values::I8(numbers.map(|n| -i8::try_from(n).unwrap()).collect()),
        ComponentType::U8 => Values::U8(numbers.collect()),
        ComponentType::I16 => Values::I16(numbers.map(|n| -300 - i16::from(n)).collect()),
        ComponentType::U16 => Values::U16(numbers.map(|n| 300 + u16::from(n)).collect()),
        ComponentType::I32 => Values::I32(numbers.map(|n| -70_000 - i32::from(n)).collect()),
        ComponentType::U32 => Values::U32(numbers.map(|n| u32::MAX - u32::from(n)).collect()),
        ComponentType::F32 => Values::F32(numbers.map(|n| 1.0 / f32::from(n)).collect()),
        _ => Values::F64(numbers.map(|n| 1.0 / f64::from(n)).collect()),
    }
}

fn attribute(semantic: Semantic, domain: Domain, components: u8, kind: ComponentType) -> Attribute {
    let elements = match domain {
        Domain::Vertex => VERTICES,
        Domain::Corner => 6,
        _ => 2,
    };
    let info = AttributeInfo::new(semantic, domain, components.into(), kind);
    Attribute::new(info, values(kind, elements, components))
}

fn by_vertex(semantic: Semantic, components: u8, kind: ComponentType) -> Attribute {
    attribute(semantic, Domain::Vertex, components, kind)
}

fn normalized(mut attribute: Attribute) -> Attribute {
    attribute.info.is_normalized = true;
    attribute
}

fn of_target(target: u32, mut attribute: Attribute) -> Attribute {
    attribute.info.morph_target = Some(target);
    attribute
}

fn create(format: Format, attributes: &[Attribute]) -> Result<Document, String> {
    let vertices = NewVertices::Stored(attributes);
    let mesh = NewMesh::new("new", vertices, &FACES);
    let created = Document::create(format, "new".as_ref(), &[mesh]);
    created.map_err(|error| error.to_string())
}

/// The file holds these attributes, in any order, and no others; read again it is the same.
fn check(format: Format, attributes: &[Attribute]) {
    let document = create(format, attributes).unwrap();
    let bytes = document.to_main_bytes().unwrap();
    let again = Document::from_bytes(bytes.clone(), format, "new".as_ref(), Limits::default());
    let again = again.unwrap();
    assert_eq!(again.meshes(), document.meshes());
    assert!(document.notes().is_empty(), "{:?}", document.notes());
    assert_eq!(document.meshes()[0].mesh.faces(), FACES);
    assert_eq!(
        document.meshes()[0].mesh.vertex_count(),
        usize::from(VERTICES)
    );

    let infos = document.attributes(0);
    assert_eq!(infos.len(), attributes.len(), "{infos:?}");
    for expected in attributes {
        assert!(
            infos.contains(&expected.info),
            "{:?} of {infos:?}",
            expected.info
        );
        let read = document.attribute(0, &expected.info).unwrap();
        assert_eq!(
            read.values.to_le_bytes(),
            expected.values.to_le_bytes(),
            "{:?}",
            expected.info
        );
    }
    assert_eq!(again.to_main_bytes().unwrap(), bytes);
}

/// What glTF can store.
fn of_gltf() -> Vec<Attribute> {
    use ComponentType::{F32, I8, I16, U8, U16};
    use Semantic::{Color, Joints, Normal, Other, Position, Tangent, TexCoord, Weights};
    vec![
        positions(),
        by_vertex(Normal, 3, F32),
        by_vertex(Tangent, 4, F32),
        by_vertex(TexCoord(0), 2, F32),
        normalized(by_vertex(TexCoord(1), 2, U8)),
        normalized(by_vertex(TexCoord(2), 2, U16)),
        normalized(by_vertex(Color(0), 3, U8)),
        by_vertex(Color(1), 4, F32),
        by_vertex(Joints(0), 4, U8),
        by_vertex(Joints(1), 4, U16),
        normalized(by_vertex(Weights(0), 4, U8)),
        by_vertex(Weights(1), 4, F32),
        by_vertex(Other("_A".into()), 1, I8),
        normalized(by_vertex(Other("_B".into()), 3, I16)),
        by_vertex(Other("_C \"\u{e9}".into()), 2, F32),
        of_target(0, by_vertex(Position, 3, F32)),
        of_target(1, by_vertex(Normal, 3, F32)),
        of_target(1, by_vertex(Tangent, 3, F32)),
    ]
}

#[test]
fn gltf_holds_every_attribute_that_it_allows() {
    for format in [Format::Glb, Format::Gltf] {
        check(format, &of_gltf());
        check(format, &[positions()]);
    }
}

#[test]
fn a_ply_holds_every_type_and_every_domain() {
    use ComponentType::{F32, F64, I8, I16, I32, U8, U16, U32};
    use Semantic::{Color, Normal, Other, TexCoord};
    let mut attributes = vec![
        positions(),
        by_vertex(Normal, 3, F64),
        normalized(by_vertex(Color(0), 4, U8)),
        by_vertex(Color(1), 3, F32),
        by_vertex(TexCoord(0), 2, F32),
        by_vertex(TexCoord(1), 2, F64),
        attribute(TexCoord(0), Domain::Corner, 2, F32),
        attribute(Normal, Domain::Face, 3, F32),
        normalized(attribute(Color(0), Domain::Face, 3, U16)),
    ];
    for (i, kind) in [I8, U8, I16, U16, I32, U32, F32, F64]
        .into_iter()
        .enumerate()
    {
        for domain in [Domain::Vertex, Domain::Face] {
            attributes.push(attribute(Other(format!("p{i}")), domain, 1, kind));
        }
    }
    check(Format::Ply, &attributes);
    check(Format::Ply, &[by_vertex(Semantic::Position, 3, F64)]);

    // Several numbers under one name become as many properties.
    let pair = by_vertex(Other("w".into()), 2, F32);
    let document = create(Format::Ply, &[positions(), pair]).unwrap();
    let names = document
        .attributes(0)
        .into_iter()
        .map(|info| info.semantic.to_string());
    assert_eq!(names.collect::<Vec<_>>(), ["POSITION", "w_0", "w_1"]);
}

#[test]
fn wide_and_narrow_indices_hold_every_vertex() {
    for (vertex_count, width) in [(65_535_u32, 2), (65_536, 4)] {
        let corners: Vec<[f32; 3]> = (0..vertex_count).map(|i| [i as f32, 0.0, 0.0]).collect();
        let attributes = [Attribute::of_vertices(Semantic::Position, &corners)];
        let faces = [[0, 1, vertex_count - 1]];
        let mesh = NewMesh::new("", NewVertices::Stored(&attributes), &faces);
        let document = Document::create(Format::Glb, "a.glb".as_ref(), &[mesh]).unwrap();
        assert_eq!(document.meshes()[0].mesh.faces(), faces);
        let views = corners.len() * 12 + (3_usize * width).next_multiple_of(4);
        let bytes = document.to_main_bytes().unwrap();
        let chunk = bytes.len() - views - 8;
        assert_eq!(&bytes[chunk + 4..chunk + 8], b"BIN\0", "{vertex_count}");
    }
}
