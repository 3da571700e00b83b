//! Files made from nothing, with an attribute of every kind that they hold.

use std::error::Error;
use std::path::Path;

use meshweft::attribute::{Attribute, AttributeInfo, Domain, Semantic, Values};
use meshweft::files::{self, Document, Format, NewMesh, NewVertices};

/// Four vertices, two faces.
const FACES: [[u32; 3]; 2] = [[0, 1, 2], [2, 1, 3]];
const POSITIONS: [[f32; 3]; 4] = [
    [0.1, 0.0, 0.0],
    [1.0, 0.0, 0.25],
    [0.0, 1.0, 0.5],
    [1.0, 1.0, 0.75],
];
/// As bytes, of three and of four components.
const COLORS: [u8; 16] = [255, 0, 0, 255, 0, 254, 1, 128, 2, 3, 253, 64, 9, 8, 7, 0];

/// Positions that need all their digits, or many zeros.
const MORE: [[f32; 3]; 3] = [
    [1.0 / 3.0, -1.25e-7, 3e20],
    [-16_777_216.0, 0.0, 1.1754944e-38],
    [0.1, 7.0, -2e-5],
];

/// Writes `new.glb`, `new.gltf` and `new.ply` of attributes, `plain` files of positions and faces alone, and
/// `several` meshes in formats that hold such.
pub(crate) fn all(folder: &Path) -> Result<(), Box<dyn Error>> {
    let files = [
        (Format::Glb, "new.glb", of_gltf()),
        (Format::Gltf, "new.gltf", of_gltf()),
        (Format::Ply, "new.ply", of_ply()),
    ];
    for (format, name, attributes) in files {
        let path = folder.join(name);
        let mesh = NewMesh::new("new", NewVertices::Stored(&attributes), &FACES);
        Document::create(format, &path, &[mesh])?.write(&path)?;
    }

    let plain = NewMesh::plain("plain", &POSITIONS, &FACES);
    let several = [
        plain,
        NewMesh::plain("nothing", &[], &[]),
        NewMesh::plain("more # 2", &MORE, &[[2, 0, 1], [0, 0, 1]]),
    ];
    for ending in ["glb", "ply", "obj", "off", "stl"] {
        files::create(&folder.join("plain").with_extension(ending), &[plain], true)?;
    }
    for ending in ["glb", "gltf", "obj"] {
        files::create(
            &folder.join("several").with_extension(ending),
            &several,
            true,
        )?;
    }
    Ok(())
}

fn attribute(semantic: Semantic, components: usize, values: Values) -> Attribute {
    let kind = values.component_type();
    Attribute::new(
        AttributeInfo::new(semantic, Domain::Vertex, components, kind),
        values,
    )
}

fn normalized(mut attribute: Attribute) -> Attribute {
    attribute.info.is_normalized = true;
    attribute
}

fn of_target(target: u32, mut attribute: Attribute) -> Attribute {
    attribute.info.morph_target = Some(target);
    attribute
}

/// What a glTF stores for each vertex, sound as the format asks: units, signs, weights that add up.
fn of_gltf() -> Vec<Attribute> {
    use Semantic::{Color, Normal, Other, Position, Tangent, TexCoord};
    let three = COLORS.chunks(4).flat_map(|color| &color[..3]);
    let normals = [
        [0.0, 0.0, 1.0],
        [0.0, 0.6, 0.8],
        [0.6, 0.0, 0.8],
        [0.0, 1.0, 0.0],
    ];
    let tangents = [
        [1.0, 0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, -1.0],
        [0.8, 0.0, -0.6, 1.0],
        [1.0, 0.0, 0.0, 1.0],
    ];
    let moves = POSITIONS.map(|[x, y, z]| [y / 2.0, x / 4.0, z + 1.0]);
    vec![
        Attribute::of_vertices(Position, &POSITIONS),
        Attribute::of_vertices(Normal, &normals),
        Attribute::of_vertices(Tangent, &tangents),
        attribute(TexCoord(0), 2, Values::F32((0..8).map(unit).collect())),
        normalized(attribute(
            TexCoord(1),
            2,
            Values::U8((0..8).map(|i| i * 31).collect()),
        )),
        normalized(attribute(
            TexCoord(2),
            2,
            Values::U16((0..8).map(|i| i * 9001).collect()),
        )),
        normalized(attribute(Color(0), 3, Values::U8(three.copied().collect()))),
        attribute(Color(1), 4, Values::F32((0..16).map(unit).collect())),
        attribute(Other("_A".into()), 1, Values::I8(vec![-1, 2, -3, 4])),
        normalized(attribute(
            Other("_B".into()),
            3,
            Values::I16((0..12).map(|i| i * -300).collect()),
        )),
        attribute(
            Other("_C".into()),
            2,
            Values::F32((0..8).map(unit).collect()),
        ),
        of_target(0, Attribute::of_vertices(Position, &moves)),
        of_target(1, Attribute::of_vertices(Position, &moves)),
        of_target(1, Attribute::of_vertices(Normal, &[[0.0, 0.125, 0.0]; 4])),
    ]
}

/// What a PLY file holds, of vertices, corners and faces.
fn of_ply() -> Vec<Attribute> {
    use Semantic::{Color, Normal, Other, Position, TexCoord};
    let by = |domain: Domain, mut attribute: Attribute| {
        attribute.info.domain = domain;
        attribute
    };
    vec![
        Attribute::of_vertices(Position, &POSITIONS),
        Attribute::of_vertices(Normal, &[[0.0, 0.0, 1.0]; 4]),
        normalized(attribute(Color(0), 4, Values::U8(COLORS.to_vec()))),
        attribute(TexCoord(0), 2, Values::F32((0..8).map(unit).collect())),
        attribute(
            Other("age".into()),
            1,
            Values::F64(vec![0.25, 1e300, -2.0, 4.0]),
        ),
        by(
            Domain::Face,
            attribute(Other("part".into()), 1, Values::I32(vec![-7, 70_000])),
        ),
    ]
}

fn unit(i: u8) -> f32 {
    f32::from(i) / 16.0
}
