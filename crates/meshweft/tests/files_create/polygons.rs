//! Polygons of new meshes.

use meshweft::Limits;
use meshweft::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use meshweft::files::{Document, Format, NewMesh, NewVertices};

/// A triangle, a quad and a pentagon.
const STARTS: [u32; 4] = [0, 1, 3, 6];
const FACES: [[u32; 3]; 6] = [
    [0, 1, 2],
    [3, 2, 1],
    [3, 1, 4],
    [6, 5, 4],
    [6, 4, 1],
    [6, 1, 0],
];

fn positions() -> Vec<[f32; 3]> {
    (0_u8..7)
        .map(|i| [f32::from(i), f32::from(i * i), 0.5])
        .collect()
}

fn bytes(format: Format, mesh: NewMesh<'_>) -> Vec<u8> {
    let document = Document::create(format, "made".as_ref(), &[mesh]).unwrap();
    document.to_main_bytes().unwrap()
}

fn read(format: Format, mesh: NewMesh<'_>) -> Document {
    Document::from_bytes(
        bytes(format, mesh),
        format,
        "made".as_ref(),
        Limits::default(),
    )
    .unwrap()
}

#[test]
fn polygons_are_records_where_the_format_has_them() {
    let positions = positions();
    let mesh = NewMesh::plain("some", &positions, &FACES);
    for format in [Format::Obj, Format::Ply, Format::Off] {
        let document = read(format, mesh.with_polygons(&STARTS));
        let entry = &document.meshes()[0];
        assert_eq!(entry.polygons.as_deref(), Some(&STARTS[..]), "{format}");
        assert_eq!(entry.mesh.faces(), FACES);
        assert_eq!(
            document.positions(0).unwrap().as_deref(),
            Some(&positions[..])
        );
        // Triangles are the same with and without polygons.
        let each = [0, 1, 2, 3, 4, 5, 6];
        assert_eq!(
            bytes(format, mesh.with_polygons(&each)),
            bytes(format, mesh)
        );
    }
    for format in [Format::Stl, Format::Glb] {
        assert_eq!(
            bytes(format, mesh.with_polygons(&STARTS)),
            bytes(format, mesh),
            "{format}"
        );
    }
}

#[test]
fn polygons_of_many_corners_are_whole_in_a_ply() {
    for count in [255_u32, 256, 70_000] {
        let positions = vec![[0.25; 3]; count as usize];
        let faces: Vec<[u32; 3]> = (2..count).map(|last| [0, last - 1, last]).collect();
        let starts = [0, count - 2];
        let mesh = NewMesh::plain("", &positions, &faces).with_polygons(&starts);
        let document = read(Format::Ply, mesh);
        assert_eq!(document.meshes()[0].polygons.as_deref(), Some(&starts[..]));
        assert_eq!(document.meshes()[0].mesh.faces(), faces);
    }
}

#[test]
fn what_is_no_polygon_is_refused() {
    let positions = positions();
    let mesh = NewMesh::plain("some", &positions, &FACES);
    for format in [
        Format::Obj,
        Format::Ply,
        Format::Off,
        Format::Stl,
        Format::Glb,
    ] {
        let refusal = |starts: &[u32]| {
            let created = Document::create(format, "made".as_ref(), &[mesh.with_polygons(starts)]);
            created.unwrap_err().to_string()
        };
        for starts in [
            &[][..],
            &[0, 1],
            &[1, 6],
            &[0, 3, 3, 6],
            &[0, 7],
            &[0, 4, 2, 6],
        ] {
            let error = refusal(starts);
            assert!(
                error.contains("start at 0, rise"),
                "{format}, {starts:?}: {error}"
            );
        }
        let error = refusal(&[0, 1, 4, 6]);
        assert!(
            error.contains("polygon 1 are not a fan"),
            "{format}: {error}"
        );
    }
}

#[test]
fn what_a_ply_has_by_triangle_is_not_had_by_polygon() {
    let positions = positions();
    let quality = Semantic::Other("quality".into());
    let info = AttributeInfo::new(quality, Domain::Face, 1, ComponentType::F32);
    let attributes = [
        Attribute::of_vertices(Semantic::Position, &positions),
        Attribute::new(info, Values::F32(vec![0.5; FACES.len()])),
    ];
    let mesh = NewMesh::new("", NewVertices::Stored(&attributes), &FACES);
    Document::create(Format::Ply, "made".as_ref(), &[mesh]).unwrap();
    let mesh = mesh.with_polygons(&STARTS);
    let error = Document::create(Format::Ply, "made".as_ref(), &[mesh]).unwrap_err();
    let error = error.to_string();
    assert!(error.contains("stored by triangle"), "{error}");
}
