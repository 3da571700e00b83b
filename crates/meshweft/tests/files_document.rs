//! What a document says of itself: its size, what it wrote, and itself to a debugger.
#![cfg(feature = "files")]

use std::fmt::Debug;
use std::fs;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::{
    Document, FileError, FileErrorKind, Format, MeshEntry, Note, Place, ReadOptions, Surroundings,
    Written, is_gzip,
};

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
