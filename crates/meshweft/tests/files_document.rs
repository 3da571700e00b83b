//! What a document says of itself: its size, what it wrote, and itself to a debugger.
#![cfg(feature = "files")]

use std::fmt::Debug;
use std::fs;
use std::path::{Path, PathBuf};

use meshweft::attribute::{Attribute, Semantic};
use meshweft::files::{
    Document, Edit, FileError, FileErrorKind, Format, MeshEntry, NewMesh, NewVertices, Note, Place,
    ReadOptions, Surroundings, Written, is_gzip,
};
use meshweft::{FaceOrder, Limits, Permutation};

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n";

/// An empty folder that goes when it is dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let name = format!("meshweft-document-{name}-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn values_cross_threads_and_can_be_debugged() {
    fn is<T: Send + Sync + Debug>() {}
    is::<Document>();
    is::<Written>();
    is::<MeshEntry>();
    is::<(ReadOptions, Surroundings<'static>)>();
    is::<(Format, Note, Place)>();
    is::<(FileError, FileErrorKind)>();
}

#[test]
fn debug_output_counts_bytes_and_does_not_list_them() {
    let stl = [
        &[0; 80][..],
        &200_u32.to_le_bytes(),
        &[1; 50].repeat(200)[..],
    ]
    .concat();
    let vrml = format!(
        "#VRML V2.0 utf8\nIndexedFaceSet {{ coord Coordinate {{ point [ 0 0 0, 1 0 0, 0 1 0 ] }} \
         coordIndex [ {} ] }}",
        "0 1 2 -1 ".repeat(200)
    );
    let glb = Path::new("a.gltf");
    let gltf = b"{\"buffers\":[{\"byteLength\":600,\"uri\":\"data:;base64,".to_vec();
    let gltf = [&gltf[..], "AAAA".repeat(200).as_bytes(), b"\"}]}"].concat();
    for (bytes, format, path, expected) in [
        (OBJ.into(), Format::Obj, Path::new("a.obj"), "bytes: 40"),
        (stl, Format::Stl, Path::new("a.stl"), "bytes: 10084"),
        (vrml.into(), Format::Vrml, Path::new("a.wrl"), "bytes: 1"),
        (gltf, Format::Gltf, glb, "bytes: 600"),
    ] {
        let document = Document::from_bytes(bytes, format, path, Limits::default()).unwrap();
        let text = format!("{document:?}");
        assert!(text.contains(expected), "{text}");
        assert!(text.len() < 500, "{text}");
    }
}

#[test]
fn sizes_are_those_on_the_disk() {
    let folder = Folder::new("sizes");
    let plain = folder.0.join("mesh.obj");
    let size = |path: &Path| fs::metadata(path).unwrap().len();
    fs::write(&plain, OBJ).unwrap();
    let document = Document::open(&plain, Limits::default()).unwrap();
    assert_eq!(document.source_bytes(), OBJ.len() as u64);

    let copy = folder.0.join("copy.obj");
    let written = document.write(&copy).unwrap();
    assert_eq!(written.files, [copy]);
    assert_eq!(written.bytes, OBJ.len() as u64);

    let compressed = folder.0.join("mesh.obj.gz");
    assert!(is_gzip(&compressed) && !is_gzip(&plain));
    let written = document.write(&compressed).unwrap();
    assert_eq!(written.files, [compressed.as_path()]);
    assert_eq!(written.bytes, size(&compressed));
    assert_ne!(written.bytes, OBJ.len() as u64);
    let again = Document::open(&compressed, Limits::default()).unwrap();
    assert_eq!(again.source_bytes(), size(&compressed));

    let in_memory = Document::from_bytes(OBJ.into(), Format::Obj, &plain, Limits::default());
    assert_eq!(in_memory.unwrap().source_bytes(), OBJ.len() as u64);
}

/// A glTF of one strip, as text with its data inside or as a GLB.
fn strip(format: Format) -> Vec<u8> {
    let position = |i: u16| [f32::from(i / 2), f32::from(i % 2), 0.5];
    let positions: Vec<[f32; 3]> = (0..62).map(position).collect();
    let attributes = [Attribute::of_vertices(Semantic::Position, &positions)];
    let face = |i: u32| [i, i + 1, i + 2];
    let faces: Vec<[u32; 3]> = (0..60).map(|i| face(i * 23 % 60)).collect();
    let mesh = NewMesh::new("strip", NewVertices::Stored(&attributes), &faces);
    let document = Document::create(format, Path::new("strip"), &[mesh]).unwrap();
    document.to_main_bytes().unwrap()
}

fn reversed(document: &mut Document) {
    let count = u32::try_from(document.meshes()[0].record_count()).unwrap();
    let order = Permutation::new((0..count).rev().collect()).unwrap();
    let order = FaceOrder::from(order);
    document.edit(Edit::order(0, &order, None)).unwrap();
}

#[test]
fn bytes_tell_the_format_where_the_name_does_not() {
    let folder = Folder::new("content");
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nelement face 1\n\
               property list uchar int vertex_indices\nend_header\n0\n1\n2\n3 0 1 2\n";
    let stl = [&[b'a'; 80][..], &1_u32.to_le_bytes(), &[0; 50]].concat();
    for (name, bytes, format) in [
        ("avatar.vrm", strip(Format::Glb), Format::Glb),
        ("scene.gltf", strip(Format::Glb), Format::Glb),
        ("scene.glb", strip(Format::Gltf), Format::Gltf),
        ("mesh.obj", ply.into(), Format::Ply),
        ("mesh.dat", ply.into(), Format::Ply),
        ("mesh", OBJ.into(), Format::Obj),
        ("part.bin", stl, Format::Stl),
        (
            "cube.txt",
            "OFF\n1 1 0\n0 0 0\n3 0 0 0\n".into(),
            Format::Off,
        ),
    ] {
        let path = folder.0.join(name);
        fs::write(&path, &bytes).unwrap();
        let mut document = Document::open(&path, Limits::default()).unwrap();
        assert_eq!(document.format(), format, "{name}");
        assert_eq!(document.meshes().len(), 1);
        reversed(&mut document);
        let expected = document.to_main_bytes().unwrap();

        // In place, under another name that ends so, and under one that says the format.
        let ending = path.extension().map(|e| e.to_str().unwrap().to_owned());
        let same = ending.map_or("other".into(), |ending| format!("other.{ending}"));
        let right = match format {
            Format::Glb => "right.glb",
            Format::Gltf => "right.gltf",
            Format::Ply => "right.ply",
            Format::Obj => "right.obj",
            Format::Stl => "right.stl",
            _ => "right.off",
        };
        for output in [name, &same, right] {
            let output = folder.0.join(output);
            document.write(&output).unwrap();
            assert_eq!(fs::read(&output).unwrap(), expected, "{}", output.display());
        }
        let refused = document.write(&folder.0.join("wrong.vrml")).unwrap_err();
        assert!(
            refused
                .to_string()
                .contains("give the output the same ending as")
        );
    }
}

#[test]
fn gzip_data_is_told_by_its_bytes() {
    let folder = Folder::new("gzip");
    let at = |name: &str| folder.0.join(name);
    fs::write(at("plain.obj"), OBJ).unwrap();
    let open = |name: &str| Document::open(&at(name), Limits::default());
    open("plain.obj").unwrap().write(&at("a.obj.gz")).unwrap();
    fs::copy(at("a.obj.gz"), at("inside.obj")).unwrap();
    let is_packed = |name: &str| fs::read(at(name)).unwrap().starts_with(b"\x1f\x8b");

    // Compressed under a name that does not say so, it stays so; the name of the output may ask for it.
    let mut document = open("inside.obj").unwrap();
    assert!(document.is_gzip());
    assert_eq!(
        document.source_bytes(),
        fs::metadata(at("inside.obj")).unwrap().len()
    );
    reversed(&mut document);
    for name in ["inside.obj", "b.obj", "b.obj.gz"] {
        let written = document.write(&at(name)).unwrap();
        assert!(is_packed(name), "{name}");
        assert_eq!(written.bytes, fs::metadata(at(name)).unwrap().len());
        let again = open(name).unwrap();
        assert_eq!(
            again.to_main_bytes().unwrap(),
            document.to_main_bytes().unwrap()
        );
    }
    // A name that says so can be left.
    let named = open("a.obj.gz").unwrap();
    named.write(&at("c.obj")).unwrap();
    assert_eq!(fs::read(at("c.obj")).unwrap(), OBJ.as_bytes());

    // The limit is one on what comes out.
    let mut limits = Limits::default();
    limits.file_bytes = 39;
    let error = Document::open(&at("b.obj"), limits).unwrap_err();
    assert!(
        matches!(error.kind, FileErrorKind::OverLimit { .. }),
        "{error}"
    );

    fs::write(at("not.obj.gz"), OBJ).unwrap();
    let error = open("not.obj.gz").unwrap_err().to_string();
    assert!(error.ends_with(
        "its name ends in .gz, but what is in it is not compressed: remove .gz from the name"
    ));
    fs::write(at("cut.wrl"), b"\x1f\x8b\x08\0").unwrap();
    let error = open("cut.wrl").unwrap_err().to_string();
    assert!(error.contains("the compressed data is damaged"), "{error}");
}

#[test]
fn a_buffer_that_looks_compressed_is_data() {
    let folder = Folder::new("buffer");
    let json = br#"{ "asset": { "version": "2.0" }, "buffers": [{ "uri": "a.bin", "byteLength": 42 }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 6 }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 },
            { "bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 3 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }] }"#;
    let mut buffer = vec![0; 42];
    buffer[..4].copy_from_slice(b"\x1f\x8b\x08\0");
    (buffer[38], buffer[40]) = (1, 2);
    fs::write(folder.0.join("a.gltf"), json).unwrap();
    fs::write(folder.0.join("a.bin"), buffer).unwrap();
    let document = Document::open(&folder.0.join("a.gltf"), Limits::default()).unwrap();
    assert_eq!(document.meshes()[0].mesh.faces(), [[0, 1, 2]]);
}

#[test]
fn what_is_no_mesh_is_named() {
    let folder = Folder::new("foreign");
    let error = |name: &str, bytes: &[u8]| {
        let path = folder.0.join(name);
        fs::write(&path, bytes).unwrap();
        let error = Document::open(&path, Limits::default()).unwrap_err();
        error.to_string().replace(path.to_str().unwrap(), name)
    };
    let html = b"<!DOCTYPE html>\n<html><body>404 Not Found</body></html>";
    for name in [
        "a.obj", "a.stl", "a.ply", "a.off", "a.gltf", "a.glb", "a.dat",
    ] {
        assert_eq!(
            error(name, html),
            format!(
                "{name}: this is an HTML page, and no mesh file that is read. Fetch the mesh itself"
            )
        );
        assert!(error(name, b"{\"error\": 404}").contains("this is JSON text"));
        assert!(error(name, b"PK\x03\x04").contains("this is a ZIP archive"));
    }
    assert!(error("a.wrl", html).contains("this is an HTML page"));
    assert!(error("a.wrl", b"<?xml version='1.0'?><X3D>").contains("X3D is not read"));
    assert!(error("a.obj", b"Not Found").contains("no line is an OBJ statement"));
    assert!(error("a.dat", b"?").contains("unknown format: neither the name"));

    // What is not there is not of an unknown format.
    for name in ["missing.obj", "missing.dat", "missing"] {
        let error = Document::open(&folder.0.join(name), Limits::default()).unwrap_err();
        let FileErrorKind::Io(error) = error.kind else {
            panic!("{error}");
        };
        assert_eq!(error.kind(), std::io::ErrorKind::NotFound);
    }
}

#[cfg(unix)]
#[test]
fn pipes_devices_and_folders_are_refused_at_once() {
    let folder = Folder::new("not-files");
    for name in ["mesh.obj", "mesh.glb", "mesh.off.gz", "without ending"] {
        let path = folder.0.join(name);
        let refused = |what: &str| {
            let error = Document::open(&path, Limits::default()).unwrap_err();
            assert_eq!(error.place, Place::File, "{what} {name}");
            let text = error.to_string();
            assert!(text.contains("it is not a file"), "{what}: {text}");
        };
        let status = std::process::Command::new("mkfifo").arg(&path).status();
        assert!(status.unwrap().success());
        refused("pipe");
        fs::remove_file(&path).unwrap();

        std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
        refused("device");
        fs::remove_file(&path).unwrap();

        fs::create_dir(&path).unwrap();
        refused("folder");
    }
}
