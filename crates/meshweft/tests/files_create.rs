//! Files made of new meshes hold what was given, and say what they cannot hold.
#![cfg(feature = "files")]

use meshweft::Limits;
use meshweft::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use meshweft::files::{Document, Format, NewMesh, NewVertices};
use meshweft::operations::{Options, optimize};

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
fn what_a_format_cannot_hold_is_said() {
    use ComponentType::{F32, F64, I32, U8, U16};
    use Semantic::{Color, Joints, Normal, Other, Position, TexCoord, Weights};
    let far = by_vertex(Position, 3, F32);
    let mut infinite = far.clone();
    infinite.values = Values::F32(vec![f32::INFINITY; 12]);
    let mut unknown = by_vertex(Normal, 3, F32);
    unknown.values = Values::F32([&[0.5; 11][..], &[f32::NAN]].concat());
    let mut short = by_vertex(Normal, 3, F32);
    short.values = Values::F32(vec![0.0; 9]);
    for (format, attributes, expected) in [
        (
            Format::Glb,
            vec![],
            "new: a new mesh needs the attribute POSITION, one element a vertex",
        ),
        (
            Format::Ply,
            vec![by_vertex(Position, 2, F32)],
            "new: POSITION must have three components",
        ),
        (
            Format::Ply,
            vec![by_vertex(Position, 3, U8)],
            "new: POSITION must have three components",
        ),
        (
            Format::Glb,
            vec![far.clone(), far.clone()],
            "new: two attributes are POSITION: leave one out",
        ),
        (
            Format::Ply,
            vec![far.clone(), short],
            "new: NORMAL has 3 elements, but the mesh needs 4: one for each vertex",
        ),
        (
            Format::Glb,
            vec![by_vertex(Position, 3, F64)],
            "new: POSITION has components of type F64, which glTF does not store: convert them to 32-bit \
             floats",
        ),
        (
            Format::Glb,
            vec![infinite],
            "new: POSITION of vertex 0 is not finite, which glTF does not allow",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Color(1), 4, F32)],
            "new: glTF does not store COLOR_1 without COLOR_0",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Joints(0), 4, U8)],
            "new: glTF does not store JOINTS_0 without WEIGHTS_0",
        ),
        (
            Format::Glb,
            vec![positions(), of_target(0, by_vertex(Normal, 3, F32))],
            "new: a morph target has NORMAL, which the mesh itself does not have",
        ),
        (
            Format::Glb,
            vec![positions(), unknown],
            "new: NORMAL of vertex 3 is not finite, which glTF does not allow",
        ),
        (
            Format::Glb,
            vec![positions(), attribute(TexCoord(0), Domain::Corner, 2, F32)],
            "new: TEXCOORD_0 is stored by Corner: glTF stores attributes of vertices only, so give each \
             corner a vertex of its own",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Other("age".into()), 1, F32)],
            "new: glTF has no attribute age: start the name with an underscore, as in _age",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Other("_A".into()), 1, I32)],
            "new: _A has components of type I32",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Color(0), 3, U8)],
            "new: glTF does not store COLOR_0 as 3 components of type U8",
        ),
        (
            Format::Glb,
            vec![positions(), normalized(by_vertex(Joints(0), 4, U16))],
            "new: glTF does not store JOINTS_0 as 4 components of type U16, normalized",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Weights(0), 3, F32)],
            "new: glTF does not store WEIGHTS_0 as 3 components of type F32",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Other("_A".into()), 5, U8)],
            "new: glTF does not store _A as 5 components of type U8",
        ),
        (
            Format::Glb,
            vec![positions(), of_target(1, far.clone())],
            "new: there are attributes of morph target 1, but none of 0",
        ),
        (
            Format::Glb,
            vec![positions(), of_target(u32::MAX, far.clone())],
            "new: there are attributes of morph target 4294967295, but none of 0",
        ),
        (
            Format::Ply,
            vec![positions(), of_target(0, far)],
            "new: a PLY file has no morph targets: create a .glb",
        ),
        (
            Format::Ply,
            vec![positions(), by_vertex(Color(0), 3, U8)],
            "new: COLOR_0: in a PLY file colors of unsigned integers are fractions",
        ),
        (
            Format::Ply,
            vec![positions(), by_vertex(Normal, 2, F32)],
            "new: NORMAL has 2 components, a PLY file stores 3 of it",
        ),
        (
            Format::Ply,
            vec![positions(), by_vertex(Other("x".into()), 1, F32)],
            "new: two properties would be called x: rename one",
        ),
        (
            Format::Ply,
            vec![positions(), by_vertex(Other("a b".into()), 1, F32)],
            "new: \"a b\" cannot be the name of a PLY property",
        ),
        (
            Format::Ply,
            vec![positions(), attribute(Normal, Domain::Corner, 3, F32)],
            "new: NORMAL is stored by corner: of corners a PLY file holds TEXCOORD_0 alone",
        ),
        (
            Format::Obj,
            vec![positions()],
            "new: OBJ files are not made from nothing: create a .glb or a .ply",
        ),
    ] {
        let refused = create(format, &attributes).unwrap_err();
        assert!(refused.starts_with(expected), "{refused}");
    }

    let shared = NewMesh::new("", NewVertices::Shared(0), &FACES);
    for (format, expected) in [
        (
            Format::Glb,
            "new: the vertices of mesh 0 cannot be shared: there are 0 meshes",
        ),
        (
            Format::Ply,
            "new: a new file has no vertices that could be shared: give their attributes",
        ),
    ] {
        let refused = Document::create(format, "new".as_ref(), &[shared]).unwrap_err();
        assert!(refused.to_string().starts_with(expected), "{refused}");
    }
    let refused = Document::create(Format::Ply, "new".as_ref(), &[]).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "new: a PLY file holds one mesh, not 0: create a .glb"
    );
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

#[test]
fn a_new_document_is_ordered_and_written_as_any_other() {
    let side = 40_u32;
    let corners: Vec<[f32; 3]> = (0..side * side)
        .map(|i| [(i % side) as f32, (i / side) as f32, 0.0])
        .collect();
    let cell = |i: u32| (i % (side - 1)) + (i / (side - 1)) * side;
    let cells = (0..(side - 1) * (side - 1)).map(|i| cell(i * 977 % ((side - 1) * (side - 1))));
    let faces: Vec<[u32; 3]> = cells
        .flat_map(|c| [[c, c + 1, c + side], [c + side, c + 1, c + side + 1]])
        .collect();
    let attributes = [Attribute::of_vertices(Semantic::Position, &corners)];
    let mesh = NewMesh::new("grid", NewVertices::Stored(&attributes), &faces);
    for (format, name) in [
        (Format::Glb, "grid.glb"),
        (Format::Gltf, "grid.gltf"),
        (Format::Ply, "grid.ply"),
    ] {
        let folder = std::env::temp_dir().join(format!("meshweft-create-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join(name);
        let mut document = Document::create(format, &path, &[mesh]).unwrap();
        assert!(
            optimize(&mut document, &Options::default(), &())
                .unwrap()
                .is_changed()
        );
        document.write(&path).unwrap();
        let again = Document::open(&path, Limits::default()).unwrap();
        assert_eq!(again.meshes(), document.meshes());
        assert_eq!(again.positions(0).unwrap(), document.positions(0).unwrap());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
