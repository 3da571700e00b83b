//! Values of OBJ files, by hand and by law.

use meshweft::Limits;
use meshweft::files::{Document, Edit, Format};

use super::data::folder;
use super::follow::{all, assert_follow, assert_same, listed, values};
use super::{broken, open, written};
use crate::random::Random;

/// Puts the records in random orders, and asserts that all values follow, in memory and in what is
/// written.
pub(crate) fn check_values(bytes: &[u8], format: Format, seed: u64) -> usize {
    let mut random = Random(seed);
    let mut document = open(bytes, format);
    if document.meshes().is_empty() {
        return 0;
    }
    for _ in 0..2 {
        let entry = document.meshes()[0].clone();
        let before = all(&document, 0);
        let (faces, vertices) = random.orders(&entry);
        document
            .edit(Edit::order(0, &faces, vertices.as_ref()))
            .unwrap();
        let after = all(&document, 0);
        assert_follow(&before, &entry, &after, &faces, vertices.as_ref());
        assert_same(&after, &all(&open(&written(&document), format), 0));
    }
    document.attributes(0).len()
}

const VERTICES: &str = "v 0 0 0 1 0 .5 1\nv 1 0 0 0 1 0 .25\nv 0 1 0 0 0 1 0\nv 0 0 1 1 1 1 1\n";

/// Polygons with numbers that count back, while the lines they name are still being added.
const POLYGONS: &str = "vt 0 0\nvt 1 0 9\nvn 0 0 1\nf 1/1/1 2/-1/1 3/-2/-1 4/2/1\nvt .5 .75\n\
vn 0 1 0\nf 1/-1/-1 2/1/-2 3/2/2\nf 1 2\nf -1/3/1 -2/3/1 -3/3/1\n";

#[test]
fn obj_values_are_those_of_the_lines() {
    let text = format!("{VERTICES}{POLYGONS}");
    let document = open(text.as_bytes(), Format::Obj);
    let expected = [
        "POSITION Vertex 3 F32",
        "COLOR_0 Vertex 4 F32",
        "TEXCOORD_0 Corner 2 F32",
        "NORMAL Corner 3 F32",
    ];
    assert_eq!(listed(&document, 0), expected);
    let positions = [0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.];
    assert_eq!(values(&document, 0, "POSITION"), positions);
    let fourth = document.positions(0).unwrap().unwrap()[3];
    assert_eq!(fourth, [0., 0., 1.]);
    let colors = [1., 0., 0.5, 1., 0., 1., 0., 0.25];
    assert_eq!(values(&document, 0, "COLOR_0")[..8], colors);
    let [a, b, c] = [[0., 0.], [1., 0.], [0.5, 0.75]];
    let texture = [[a, b, a], [a, a, b], [c, a, b], [c, c, c]];
    assert_eq!(
        values(&document, 0, "TEXCOORD_0"),
        texture.as_flattened().as_flattened()
    );
    let [z, y] = [[0., 0., 1.], [0., 1., 0.]];
    let normals = [[z, z, z], [z, z, z], [y, z, y], [z, z, z]];
    assert_eq!(
        values(&document, 0, "NORMAL"),
        normals.as_flattened().as_flattened()
    );
    for seed in 1..20 {
        assert_eq!(check_values(text.as_bytes(), Format::Obj, seed), 4);
    }
}

#[test]
fn obj_values_are_turned_with_their_triangles() {
    let faces = "f 1/1 2/2 3/3\nf 3/3 2/2 4/1\nf 4/2 1/2 \\\n 2/-3 # here\n";
    let text = format!("{VERTICES}vt 1\nvt 2 3\nvt 4 5 6\n{faces}usemtl x\nf 1/1 4/1 3/1\n");
    let document = open(text.as_bytes(), Format::Obj);
    assert!(document.meshes()[0].corners_turnable);
    let texture = [1., 0., 2., 3., 4., 5.];
    assert_eq!(values(&document, 0, "TEXCOORD_0")[..6], texture);
    for seed in 1..40 {
        assert_eq!(check_values(text.as_bytes(), Format::Obj, seed), 3);
    }
}

#[test]
fn obj_attributes_are_listed_where_everything_has_them() {
    let infos = |text: &str| {
        let listed = listed(&open(text.as_bytes(), Format::Obj), 0);
        assert_eq!(listed[0], "POSITION Vertex 3 F32");
        listed[1..].join(", ")
    };
    let three = |line: &str| format!("{line}\n{line}\n{line}\n");
    let face = "f 1 2 3\n";
    assert_eq!(infos(&(three("v 0 0 0 1") + face)), "");
    assert_eq!(
        infos(&(three("v 0 0 0 1 1 1") + face)),
        "COLOR_0 Vertex 3 F32"
    );
    let mixed = three("v 0 0 0 1 1 1 # a") + "v 0 0 0 1 1 1 1\n" + face;
    assert_eq!(infos(&mixed), "COLOR_0 Vertex 3 F32");
    assert_eq!(infos(&(three("v 0 0 0 1 1 1") + "v 0 0 0\n" + face)), "");
    assert_eq!(infos(&(three("v 0 0 0 1 1 1 1 1") + face)), "");

    let solid = three("v 0 0 0") + "vt 0 0 1\nvt 1 1 1\n";
    let all = "f 1/1 2/2 3/1\n";
    assert_eq!(infos(&(solid.clone() + all)), "TEXCOORD_0 Corner 3 F32");
    // A line that no face names does not count.
    let text = solid.clone() + "vt 0 0\n" + all;
    assert_eq!(infos(&text), "TEXCOORD_0 Corner 3 F32");
    let flat = text + "f 1/3 2/1 3/1\n";
    assert_eq!(infos(&flat), "TEXCOORD_0 Corner 2 F32");
    assert_eq!(infos(&(solid.clone() + all + face)), "");
    assert_eq!(
        infos(&(solid + all + "f 1/1/1 2/1/1 3/1/1\n")),
        "TEXCOORD_0 Corner 3 F32"
    );
    assert_eq!(infos(&(three("v 0 0 0") + all)), "");
}

#[test]
fn bad_obj_values_say_where_they_are() {
    let error = |more: &str, name: &str| {
        let text = format!("v 0 0 0 1 x 1\n{more}\n");
        let document = open(text.as_bytes(), Format::Obj);
        let mut infos = document.attributes(0).into_iter();
        let info = infos
            .find(|info| info.semantic.to_string() == name)
            .unwrap();
        document.attribute(0, &info).unwrap_err().to_string()
    };
    let end = ". Fix it there, or re-export the file";
    let cases = [
        (
            "f 1 1 1",
            "COLOR_0",
            "1: \"x\" is not a value: write a number",
        ),
        (
            "vt 0 a\nf 1/1 1/1 1/1",
            "TEXCOORD_0",
            "2: \"a\" is not a value: write a number",
        ),
        (
            "vt\nf 1/1 1/1 1/1",
            "TEXCOORD_0",
            "2: 0 values on a line that needs 1",
        ),
        (
            "vn 1 2\nf 1//1 1//1 1//1",
            "NORMAL",
            "2: 2 values on a line that needs 3",
        ),
        (
            "vt 0\nf 1/1 1/2 1/1",
            "TEXCOORD_0",
            "3: a corner names vt 2, and there are 1",
        ),
        (
            "vt 0\nf 1/1 1/0 1/1",
            "TEXCOORD_0",
            "3: a corner names vt 0, and there are 1",
        ),
        (
            "vt 0\nf 1/1 1/1 1/-2\nvt 1",
            "TEXCOORD_0",
            "3: a corner names vt -2, and there are 2",
        ),
    ];
    for (more, name, expected) in cases {
        assert_eq!(error(more, name), format!("mesh.obj: line {expected}{end}"));
    }
    let document = open(b"v 0 0 0\nf 1 1 1\n", Format::Obj);
    let mut info = document.attributes(0).remove(0);
    info.components = 2;
    let error = document.attribute(0, &info).unwrap_err().to_string();
    assert_eq!(
        error,
        "mesh.obj: this mesh has no attribute POSITION: take one of those that are listed"
    );
}

/// Every attribute of a spoilt file is read or refused.
#[test]
fn values_of_spoilt_files_are_refused_or_survive() {
    let pieces: [&[u8]; 10] = [
        b"\n", b" ", b"#", b"\\\n", b"-", b"/", b"0", b"7", b"\xff", b"x",
    ];
    let mut files = broken::small_files();
    files.push((format!("{VERTICES}{POLYGONS}").into_bytes(), Format::Obj));
    files.extend(
        super::ply_values::files()
            .into_iter()
            .map(|file| (file, Format::Ply)),
    );
    let mut random = Random(5);
    for (bytes, format) in files {
        for _ in 0..4_000 {
            let spoilt = random.spoilt(&bytes, &pieces, 3);
            let name = super::name_of(format);
            let document = Document::from_bytes(spoilt, format, name, Limits::default());
            let Ok(mut document) = document else { continue };
            let Some(entry) = document.meshes().first().cloned() else {
                continue;
            };
            let (faces, vertices) = random.orders(&entry);
            document
                .edit(Edit::order(0, &faces, vertices.as_ref()))
                .unwrap();
            for info in document.attributes(0) {
                let _ = document.attribute(0, &info);
            }
        }
    }
}

#[test]
fn values_of_real_files_are_all_there() {
    let Some(folder) = folder() else { return };
    let mut counts = [0, 0];
    let mut paths: Vec<_> = std::fs::read_dir(folder.join("meshes")).unwrap().collect();
    paths.sort_by_key(|entry| entry.as_ref().unwrap().path());
    for entry in paths {
        let path = entry.unwrap().path();
        let format = Format::of_path(&path);
        let (Some(format @ (Format::Obj | Format::Ply)), Ok(document)) =
            (format, Document::open(&path, Limits::default()))
        else {
            continue;
        };
        let bytes = written(&document);
        if bytes.len() > 5_000_000 || document.meshes().is_empty() {
            continue;
        }
        let attributes = check_values(&bytes, format, 3);
        counts[0] += 1;
        counts[1] += attributes;
        eprintln!("{}: {:?}", path.display(), listed(&document, 0));
    }
    let [files, attributes] = counts;
    eprintln!("{attributes} attributes of {files} files read, moved and compared");
    assert!(files > 20);
}
