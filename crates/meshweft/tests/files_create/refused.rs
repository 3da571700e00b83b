//! What a format cannot hold is said, with the mesh.

use meshweft::attribute::{ComponentType, Domain, Semantic, Values};
use meshweft::files::{Document, Format, NewMesh, NewVertices};

use crate::{FACES, attribute, by_vertex, create, normalized, of_target, positions};

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
            "a new mesh needs the attribute POSITION, one element a vertex",
        ),
        (
            Format::Ply,
            vec![by_vertex(Position, 2, F32)],
            "POSITION must have three components",
        ),
        (
            Format::Ply,
            vec![by_vertex(Position, 3, U8)],
            "POSITION must have three components",
        ),
        (
            Format::Glb,
            vec![far.clone(), far.clone()],
            "two attributes are POSITION: leave one out",
        ),
        (
            Format::Ply,
            vec![far.clone(), short],
            "NORMAL has 3 elements, but the mesh needs 4: one for each vertex",
        ),
        (
            Format::Glb,
            vec![by_vertex(Position, 3, F64)],
            "POSITION has components of type F64, which glTF does not store: convert them to 32-bit \
             floats",
        ),
        (
            Format::Glb,
            vec![infinite],
            "POSITION of vertex 0 is not finite, which glTF does not allow",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Color(1), 4, F32)],
            "glTF does not store COLOR_1 without COLOR_0",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Joints(0), 4, U8)],
            "glTF does not store JOINTS_0 without WEIGHTS_0",
        ),
        (
            Format::Glb,
            vec![positions(), of_target(0, by_vertex(Normal, 3, F32))],
            "a morph target has NORMAL, which the mesh itself does not have",
        ),
        (
            Format::Glb,
            vec![positions(), unknown],
            "NORMAL of vertex 3 is not finite, which glTF does not allow",
        ),
        (
            Format::Glb,
            vec![positions(), attribute(TexCoord(0), Domain::Corner, 2, F32)],
            "TEXCOORD_0 is stored by Corner: glTF stores attributes of vertices only, so give each \
             corner a vertex of its own",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Other("age".into()), 1, F32)],
            "glTF has no attribute age: start the name with an underscore, as in _age",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Other("_A".into()), 1, I32)],
            "_A has components of type I32",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Color(0), 3, U8)],
            "glTF does not store COLOR_0 as 3 components of type U8",
        ),
        (
            Format::Glb,
            vec![positions(), normalized(by_vertex(Joints(0), 4, U16))],
            "glTF does not store JOINTS_0 as 4 components of type U16, normalized",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Weights(0), 3, F32)],
            "glTF does not store WEIGHTS_0 as 3 components of type F32",
        ),
        (
            Format::Glb,
            vec![positions(), by_vertex(Other("_A".into()), 5, U8)],
            "glTF does not store _A as 5 components of type U8",
        ),
        (
            Format::Glb,
            vec![positions(), of_target(1, far.clone())],
            "there are attributes of morph target 1, but none of 0",
        ),
        (
            Format::Glb,
            vec![positions(), of_target(u32::MAX, far.clone())],
            "there are attributes of morph target 4294967295, but none of 0",
        ),
        (
            Format::Ply,
            vec![positions(), of_target(0, far)],
            "a PLY file has no morph targets: create a .glb",
        ),
        (
            Format::Ply,
            vec![positions(), by_vertex(Color(0), 3, U8)],
            "COLOR_0: in a PLY file colors of unsigned integers are fractions",
        ),
        (
            Format::Ply,
            vec![positions(), by_vertex(Normal, 2, F32)],
            "NORMAL has 2 components, a PLY file stores 3 of it",
        ),
        (
            Format::Ply,
            vec![positions(), by_vertex(Other("x".into()), 1, F32)],
            "two properties would be called x: rename one",
        ),
        (
            Format::Ply,
            vec![positions(), by_vertex(Other("a b".into()), 1, F32)],
            "\"a b\" cannot be the name of a PLY property",
        ),
        (
            Format::Ply,
            vec![positions(), attribute(Normal, Domain::Corner, 3, F32)],
            "NORMAL is stored by corner: of corners a PLY file holds TEXCOORD_0 alone",
        ),
        (
            Format::Obj,
            vec![positions(), by_vertex(Normal, 3, F32)],
            "OBJ files are made of positions and faces alone: leave NORMAL out, or create a .glb or a .ply",
        ),
        (
            Format::Stl,
            vec![by_vertex(Position, 3, F64)],
            "POSITION has 64-bit floats: convert them to 32-bit floats, or create a .ply",
        ),
        (
            Format::Off,
            vec![positions(), of_target(0, positions())],
            "OFF files are made of positions and faces alone: leave POSITION out",
        ),
        (
            Format::Off,
            vec![],
            "a new mesh needs the attribute POSITION, one element a vertex",
        ),
    ] {
        let refused = create(format, &attributes).unwrap_err();
        let refused = refused.strip_prefix("new: mesh 0, \"new\": ").unwrap();
        assert!(refused.starts_with(expected), "{refused}");
    }
}

fn refusal(format: Format, meshes: &[NewMesh<'_>]) -> String {
    Document::create(format, "new".as_ref(), meshes)
        .unwrap_err()
        .to_string()
}

#[test]
fn there_is_nothing_to_share_in_a_new_file() {
    let shared = NewMesh::new("", NewVertices::Shared(0), &FACES);
    let expected = "new: the vertices of mesh 0 cannot be shared: there are 0 meshes before";
    let refused = refusal(Format::Glb, &[shared]);
    assert!(refused.starts_with(expected), "{refused}");
    for format in [Format::Ply, Format::Obj, Format::Off, Format::Stl] {
        assert_eq!(
            refusal(format, &[shared]),
            "new: mesh 0: a new file has no vertices that could be shared: give their attributes"
        );
    }
}

#[test]
fn a_format_of_one_mesh_names_those_of_several() {
    let mesh = NewMesh::plain("", &[[0.0; 3]; 4], &FACES);
    for (format, meshes) in [
        (Format::Ply, 0),
        (Format::Ply, 2),
        (Format::Off, 2),
        (Format::Stl, 0),
    ] {
        assert_eq!(
            refusal(format, &vec![mesh; meshes]),
            format!("new: {format} files hold one mesh, not {meshes}: create a .glb or an .obj")
        );
    }
    assert_eq!(
        refusal(Format::Vrml, &[mesh]),
        "new: VRML files are not made from nothing: create a .glb or an .obj"
    );
}

#[test]
fn what_is_not_finite_is_named_or_kept() {
    let sound = [[0.0; 3]; 4];
    for number in [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut positions = sound;
        positions[2][1] = number;
        let meshes = [
            NewMesh::plain("sound", &sound, &FACES),
            NewMesh::plain("broken", &positions, &FACES),
        ];
        let place = "new: mesh 1, \"broken\": POSITION of vertex 2 is not finite, which ";
        for (format, why) in [
            (Format::Glb, "glTF does not allow"),
            (Format::Obj, "OBJ files have no number for"),
        ] {
            let refused = refusal(format, &meshes);
            assert!(refused.starts_with(&format!("{place}{why}")), "{refused}");
        }
        let refused = refusal(Format::Off, &meshes[1..]);
        assert!(
            refused.contains("OFF files have no number for"),
            "{refused}"
        );

        for format in [Format::Ply, Format::Stl] {
            crate::plain::check(format, &meshes[1..]);
        }
    }
}

#[test]
fn faces_name_vertices_that_are_there() {
    let positions = [[0.0; 3]; 4];
    let wrong = [[0, 1, 2], [1, 4, 2]];
    let meshes = [
        NewMesh::plain("a", &positions, &FACES),
        NewMesh::plain("b", &positions, &wrong),
    ];
    let expected = "face 1, corner 1: index 4 is past the last vertex (3)";
    for format in [Format::Glb, Format::Obj] {
        let refused = refusal(format, &meshes);
        assert_eq!(refused, format!("new: mesh 1, \"b\": {expected}"));
    }
    for format in [Format::Ply, Format::Off, Format::Stl] {
        let refused = refusal(format, &meshes[1..]);
        assert_eq!(refused, format!("new: mesh 0, \"b\": {expected}"));
    }
}
