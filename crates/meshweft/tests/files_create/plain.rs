//! Meshes of positions and faces: what is written is what a reader finds.

use meshweft::Limits;
use meshweft::files::{Document, Format, NewMesh, NewVertices};

use crate::FACES;

/// Every format of which files are made.
pub(crate) const FORMATS: [Format; 6] = [
    Format::Glb,
    Format::Gltf,
    Format::Ply,
    Format::Obj,
    Format::Off,
    Format::Stl,
];

fn written(format: Format, meshes: &[NewMesh<'_>]) -> Vec<u8> {
    let document = Document::create(format, "new".as_ref(), meshes).unwrap();
    document.to_main_bytes().unwrap()
}

fn positions<'a>(mesh: &NewMesh<'a>) -> &'a [[f32; 3]] {
    match mesh.vertices {
        NewVertices::Positions(positions) => positions,
        _ => panic!("a plain mesh"),
    }
}

fn index32(index: usize) -> u32 {
    u32::try_from(index).unwrap()
}

fn bits(positions: &[[f32; 3]]) -> Vec<[u32; 3]> {
    let bits = positions.iter().map(|position| position.map(f32::to_bits));
    bits.collect()
}

/// A reader finds the meshes as they were given: positions bit for bit, faces in their order, names where
/// the format has them.
pub(crate) fn check(format: Format, meshes: &[NewMesh<'_>]) {
    let bytes = written(format, meshes);
    let again = Document::from_bytes(bytes.clone(), format, "new".as_ref(), Limits::default());
    let again = again.unwrap();
    assert_eq!(again.to_main_bytes().unwrap(), bytes);
    let found = |mesh: usize| {
        let positions = again.positions(mesh).unwrap().unwrap();
        (bits(&positions), again.meshes()[mesh].mesh.faces())
    };

    match format {
        Format::Glb | Format::Gltf => {
            assert_eq!(again.meshes().len(), meshes.len());
            for (number, mesh) in meshes.iter().enumerate() {
                assert_eq!(found(number), (bits(positions(mesh)), mesh.faces));
                match mesh.name {
                    "" => assert_eq!(again.meshes()[number].name, format!("mesh {number}")),
                    name => assert_eq!(again.meshes()[number].name, name),
                }
            }
        }
        // The readers of others find one mesh, here with a run for each object.
        Format::Obj => {
            let (mut all, mut faces, mut starts) = (Vec::new(), Vec::new(), Vec::new());
            for mesh in meshes {
                let first = index32(all.len());
                starts.push(index32(faces.len()));
                all.extend(bits(positions(mesh)));
                faces.extend(mesh.faces.iter().map(|face| face.map(|v| v + first)));
            }
            assert_eq!(found(0), (all, &*faces));
            assert_eq!(again.meshes()[0].runs, starts);
            assert_eq!(again.meshes().len(), 1);
            match meshes {
                [mesh] if mesh.name.is_empty() => assert_eq!(again.meshes()[0].name, "mesh"),
                _ => assert_eq!(again.meshes()[0].name, meshes[0].name),
            }
        }
        Format::Stl => {
            let (found, faces) = found(0);
            let given = bits(positions(&meshes[0]));
            let corners = |positions: &[[u32; 3]], faces: &[[u32; 3]]| -> Vec<[u32; 3]> {
                let corners = faces.as_flattened().iter();
                corners.map(|&v| positions[v as usize]).collect()
            };
            assert_eq!(corners(&found, faces), corners(&given, meshes[0].faces));
            assert!(found.is_sorted_by(|a, b| a < b));
        }
        _ => assert_eq!(found(0), (bits(positions(&meshes[0])), meshes[0].faces)),
    }
}

/// Floats that have long or rare digits.
const RARE: [[f32; 3]; 4] = [
    [0.1, -0.0, 1.0 / 3.0],
    [f32::MAX, f32::MIN, f32::MIN_POSITIVE],
    [1e-45, -1e-45, 16_777_216.0],
    [1.1754942e-38, 9.999999e15, 1e16],
];

#[test]
fn all_formats_keep_positions_faces_and_names() {
    let flat = [[0.5, 0.25, 2.0]; 5];
    let repeated = [[3, 3, 3], [0, 1, 2], [0, 1, 2], [2, 1, 0]];
    let meshes = [
        NewMesh::plain("left arm", &RARE, &FACES),
        NewMesh::plain("", &flat, &repeated),
        NewMesh::plain("c", &RARE[..3], &[[2, 1, 0]]),
    ];
    for format in FORMATS {
        for mesh in meshes {
            check(format, &[mesh]);
        }
    }
    for format in [Format::Glb, Format::Gltf, Format::Obj] {
        check(format, &meshes);
        // The one that is first has no name.
        check(Format::Glb, &meshes[1..]);
    }
}

#[test]
fn text_is_short() {
    let square = [[0.0, 0.0, 0.5], [1.0, 0.0, 1e-7], [0.0, -1.0, 3e20]];
    let mesh = NewMesh::plain("a # b\nv 1", &square, &[[0, 1, 2], [2, 1, 0]]);
    let version = env!("CARGO_PKG_VERSION");
    let text = |format, meshes: &[NewMesh<'_>]| String::from_utf8(written(format, meshes)).unwrap();
    let object = "v 0 0 0.5\nv 1 0 1e-7\nv 0 -1 3e20\n";
    assert_eq!(
        text(
            Format::Obj,
            &[mesh, NewMesh::plain("", &square, &[[0, 1, 2]])]
        ),
        format!(
            "# made by meshweft {version}\no a _ b_v 1\n{object}f 1 2 3\nf 3 2 1\no mesh_1\n{object}f 4 5 6\n"
        )
    );
    assert_eq!(
        text(Format::Off, &[mesh]),
        "OFF\n3 2 0\n0 0 0.5\n1 0 1e-7\n0 -1 3e20\n3 0 1 2\n3 2 1 0\n"
    );
    let ply = written(Format::Ply, &[mesh]);
    let header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment made by meshweft {version}\ncomment mesh a # b_v 1\n\
         element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    );
    assert!(ply.starts_with(header.as_bytes()));
    assert_eq!(ply.len(), header.len() + 3 * 12 + 2 * 13);
}

#[test]
fn a_binary_stl_has_a_header_and_normals() {
    let corners = [
        [0.0, 0.0, 1.0],
        [2.0, 0.0, 1.0],
        [0.0, 3.0, 1.0],
        [f32::NAN, 0.0, 0.0],
    ];
    let faces = [[0, 1, 2], [1, 0, 2], [0, 1, 1], [0, 1, 3]];
    let long = format!("COLOR={}", "\u{e9}".repeat(60));
    let bytes = written(Format::Stl, &[NewMesh::plain(&long, &corners, &faces)]);
    assert_eq!(bytes.len(), 84 + 4 * 50);
    let start = format!(
        "made by meshweft {}: COLOR_\u{e9}",
        env!("CARGO_PKG_VERSION")
    );
    assert!(bytes.starts_with(start.as_bytes()));
    // The character that has no room is left out.
    let text = std::str::from_utf8(&bytes[..80]).unwrap();
    assert!(text.trim_end_matches('\0').len() >= 79, "{text:?}");
    assert_eq!(bytes[80..84], [4, 0, 0, 0]);

    let facets = bytes[84..].chunks(50);
    let normals = facets.map(|facet| -> Vec<f32> {
        let numbers = facet[..12].as_chunks().0.iter();
        numbers.map(|&bytes| f32::from_le_bytes(bytes)).collect()
    });
    let expected = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0; 3], [0.0; 3]];
    assert_eq!(normals.collect::<Vec<_>>(), expected);
    assert!(bytes[84..].chunks(50).all(|facet| facet[48..] == [0, 0]));
}

#[test]
fn names_of_a_glb_are_any_text() {
    let names = ["a \"b\" \\ \n\u{1}", "\u{1f600}", " ", "{\"mesh\":0}"];
    let meshes = names.map(|name| NewMesh::plain(name, &RARE, &FACES));
    check(Format::Glb, &meshes);
    check(Format::Gltf, &meshes);
}

#[test]
fn a_glb_says_what_is_in_it() {
    let positions = [[0.5, -1.0, 0.1], [0.25, 2.0, 0.1], [0.0, 0.0, 0.1]];
    let meshes = [
        NewMesh::plain("a", &positions, &[[0, 1, 2]]),
        NewMesh::plain("", &positions, &[[2, 1, 0]]),
    ];
    let bytes = written(Format::Glb, &meshes);
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    assert_eq!(json["scenes"], serde_json::json!([{ "nodes": [0, 1] }]));
    let nodes = serde_json::json!([{ "mesh": 0, "name": "a" }, { "mesh": 1 }]);
    assert_eq!(json["nodes"], nodes);
    assert_eq!(json["meshes"][0]["name"], "a");
    assert_eq!(json["meshes"][1]["name"], serde_json::Value::Null);
    let bounds = |name: &str| -> Vec<f64> {
        let numbers = json["accessors"][0][name].as_array().unwrap().iter();
        numbers.map(|number| number.as_f64().unwrap()).collect()
    };
    assert_eq!(bounds("min"), [0.0, -1.0, f64::from(0.1_f32)]);
    assert_eq!(bounds("max"), [0.5, 2.0, f64::from(0.1_f32)]);
    assert_eq!(json["accessors"][1]["componentType"], 5123);
    for view in json["bufferViews"].as_array().unwrap() {
        assert_eq!(view["byteOffset"].as_u64().unwrap() % 4, 0);
    }
    assert_eq!(bytes.len() % 4, 0);
}

#[test]
fn what_is_empty_is_kept_as_far_as_the_format_goes() {
    let empty = NewMesh::plain("nothing", &[], &[]);
    let points = NewMesh::plain("points", &RARE, &[]);
    let faces = NewMesh::plain("faces", &RARE, &FACES);
    let contents = |format, meshes: &[NewMesh<'_>]| {
        let document = Document::create(format, "new".as_ref(), meshes).unwrap();
        let again = Document::from_bytes(
            document.to_main_bytes().unwrap(),
            format,
            "new".as_ref(),
            Limits::default(),
        );
        assert_eq!(again.unwrap().meshes(), document.meshes());
        document.to_main_bytes().unwrap()
    };

    // No meshes at all.
    contents(Format::Glb, &[]);
    assert_eq!(contents(Format::Obj, &[]).split(|b| *b == b'\n').count(), 2);

    // Meshes without faces.
    for mesh in [empty, points] {
        for format in [Format::Ply, Format::Obj, Format::Off, Format::Stl] {
            contents(format, &[mesh]);
        }
    }
    assert_eq!(contents(Format::Off, &[empty]), b"OFF\n0 0 0\n");
    assert_eq!(contents(Format::Stl, &[points])[80..], [0; 4]);
    assert!(contents(Format::Off, &[points]).starts_with(b"OFF\n4 0 0\n"));

    // Of a glTF the node stays, and the other meshes.
    let bytes = contents(Format::Glb, &[empty, faces]);
    let json = String::from_utf8_lossy(&bytes);
    assert!(
        json.contains(r#""nodes":[{"name":"nothing"},{"mesh":0,"name":"faces"}]"#),
        "{json}"
    );
    let refused = Document::create(Format::Glb, "new".as_ref(), &[faces, points]).unwrap_err();
    assert!(
        refused
            .to_string()
            .starts_with("new: mesh 1, \"points\": it has no faces"),
        "{refused}"
    );
}
