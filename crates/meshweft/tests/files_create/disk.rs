//! New files on the disk.

use std::fs;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::attribute::{Attribute, Semantic};
use meshweft::files::{
    Document, FileErrorKind, Format, NewMesh, NewVertices, WriteOptions, create,
};
use meshweft::operations::{Options, optimize};

const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// A folder that goes with its test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let name = format!("meshweft-create-{name}-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn faces_of(path: &Path) -> Vec<[u32; 3]> {
    let document = Document::open(path, Limits::default()).unwrap();
    document.meshes()[0].mesh.faces().to_vec()
}

#[test]
fn a_name_says_the_format() {
    let folder = Folder::new("formats");
    let mesh = NewMesh::plain("triangle", &TRIANGLE, &[[2, 0, 1]]);
    for name in [
        "a.glb", "a.gltf", "a.ply", "a.obj", "a.off", "a.stl", "a.OFF.gz",
    ] {
        let path = folder.0.join("below").join(name);
        let written = create(&path, &[mesh], false).unwrap();
        assert_eq!(written.files, [&*path]);
        assert_eq!(written.bytes, fs::metadata(&path).unwrap().len());
        let expected = [[2, 0, 1]];
        // The corners of an STL file get numbers by their bits.
        let expected = if name == "a.stl" {
            [[1, 0, 2]]
        } else {
            expected
        };
        assert_eq!(faces_of(&path), expected, "{name}");
        let is_gzip = fs::read(&path).unwrap().starts_with(b"\x1f\x8b");
        assert_eq!(is_gzip, name.ends_with(".gz"));
    }

    for name in ["a", "a.fbx", "a.wrl"] {
        let path = folder.0.join(name);
        let refused = create(&path, &[mesh], false).unwrap_err().to_string();
        assert!(refused.contains(".obj"), "{refused}");
    }
    assert_eq!(folder.names(), ["below"]);
}

#[test]
fn nothing_is_replaced_unasked() {
    let folder = Folder::new("replaced");
    let path = folder.0.join("a.off");
    let [first, second] =
        [&[[0, 1, 2]], &[[2, 1, 0]]].map(|faces| NewMesh::plain("", &TRIANGLE, faces));
    create(&path, &[first], false).unwrap();

    let refused = create(&path, &[second], false).unwrap_err();
    assert!(matches!(refused.kind, FileErrorKind::Exists), "{refused}");
    assert!(
        refused
            .to_string()
            .ends_with("a.off: it is there already, and is not replaced unasked"),
        "{refused}"
    );
    assert_eq!(faces_of(&path), [[0, 1, 2]]);
    create(&path, &[second], true).unwrap();
    assert_eq!(faces_of(&path), [[2, 1, 0]]);

    // A folder is in the way, too.
    let folder_name = folder.0.join("b.off");
    fs::create_dir(&folder_name).unwrap();
    let refused = create(&folder_name, &[second], false).unwrap_err();
    assert!(matches!(refused.kind, FileErrorKind::Exists), "{refused}");

    // What cannot be made leaves what was there, and nothing else.
    let broken = NewMesh::plain("", &[[f32::NAN; 3]], &[[0, 0, 0]]);
    assert!(create(&path, &[broken], true).is_err());
    assert_eq!(faces_of(&path), [[2, 1, 0]]);
    assert_eq!(folder.names(), ["a.off", "b.off"]);
}

#[test]
fn the_option_holds_for_any_document() {
    let folder = Folder::new("option");
    let (plain, packed) = (folder.0.join("a.off"), folder.0.join("a.off.gz"));
    let mesh = NewMesh::plain("", &TRIANGLE, &[[0, 1, 2]]);
    let mut options = WriteOptions::default();
    options.replace_existing = false;
    for path in [&plain, &packed] {
        create(path, &[mesh], false).unwrap();
        let before = fs::read(path).unwrap();
        let document = Document::open(path, Limits::default()).unwrap();
        // Over itself, and as a copy.
        let copy = path.with_file_name(format!("copy-{}", path.file_name().unwrap().display()));
        document.write_with(&copy, &options).unwrap();
        for taken in [path, &copy] {
            let refused = document.write_with(taken, &options).unwrap_err();
            assert!(matches!(refused.kind, FileErrorKind::Exists), "{refused}");
            assert_eq!(fs::read(taken).unwrap(), before);
        }
    }
    assert_eq!(folder.names().len(), 4);
}

#[test]
fn of_several_writers_one_makes_the_file() {
    let folder = Folder::new("writers");
    let path = folder.0.join("a.ply");
    let faces = [[[0, 1, 2]], [[1, 2, 0]], [[2, 0, 1]], [[2, 1, 0]]];
    let made: Vec<bool> = std::thread::scope(|scope| {
        let write = |faces| {
            let path = &path;
            scope.spawn(move || {
                let mesh = NewMesh::plain("", &TRIANGLE, faces);
                match create(path, &[mesh], false) {
                    Ok(_) => true,
                    Err(error) => {
                        assert!(matches!(error.kind, FileErrorKind::Exists), "{error}");
                        false
                    }
                }
            })
        };
        let threads: Vec<_> = faces.iter().map(|faces| write(faces)).collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .collect()
    });
    assert_eq!(made.iter().filter(|made| **made).count(), 1);
    let winner = made.iter().position(|made| *made).unwrap();
    assert_eq!(faces_of(&path), faces[winner]);
    assert_eq!(folder.names(), ["a.ply"]);
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
        let folder = Folder::new("ordered");
        let path = folder.0.join(name);
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
    }
}
