//! Of a buffer no more is read than about what the scene says of its length, and nothing is lost.

use std::fs;
use std::path::Path;

use meshweft::Limits;
use meshweft::files::{Document, FileErrorKind};

use crate::output::{Folder, external, ordered};
use crate::reader::Reader;

/// Makes a file longer, with a hole.
fn lengthen(path: &Path, length: u64) {
    fs::File::options()
        .append(true)
        .open(path)
        .unwrap()
        .set_len(length)
        .unwrap();
}

#[test]
fn what_follows_a_buffer_in_its_file_stays() {
    let folder = Folder::new("padding");
    let source = external(&folder, "a.bin", "a.bin");
    let length = fs::metadata(folder.0.join("a.bin")).unwrap().len();
    lengthen(&folder.0.join("a.bin"), length + 60_000);
    let before = Reader::of_file(&source, None);
    ordered(&source).write(&source).unwrap();
    let after = Reader::of_file(&source, None);
    assert!(before.triangles() == after.triangles() && before.buffers != after.buffers);
    assert_eq!(
        fs::metadata(folder.0.join("a.bin")).unwrap().len(),
        length + 60_000
    );
}

#[test]
fn a_far_longer_file_is_not_read_but_comes_along() {
    let (folder, out) = (Folder::new("longer"), Folder::new("longer-out"));
    let source = external(&folder, "a.bin", "a.bin");
    let buffer = folder.0.join("a.bin");
    lengthen(&buffer, 1 << 40);
    let mut limits = Limits::default();
    limits.file_bytes = 1 << 20;
    let document = Document::open(&source, limits).unwrap();
    assert!(document.meshes().is_empty());
    let note = &document.notes()[0].text;
    assert!(
        note.contains("its buffer is far longer than its byteLength"),
        "{note}"
    );
    // In its folder it stays.
    document.write(&source).unwrap();
    assert_eq!(fs::metadata(&buffer).unwrap().len(), 1 << 40);

    // Elsewhere all of it is needed.
    let file = fs::File::options().write(true).open(&buffer).unwrap();
    file.set_len(1 << 20).unwrap();
    let target = out.0.join("scene.gltf");
    Document::open(&source, Limits::default())
        .unwrap()
        .write(&target)
        .unwrap();
    assert_eq!(out.files(), ["a.bin", "scene.gltf"]);
    assert!(fs::read(&buffer).unwrap() == fs::read(out.0.join("a.bin")).unwrap());

    // Over no other file.
    fs::write(out.0.join("a.bin"), "mine").unwrap();
    let error = Document::open(&source, Limits::default())
        .unwrap()
        .write(&target)
        .unwrap_err();
    assert!(
        matches!(error.kind, FileErrorKind::Unsupported { .. }),
        "{error}"
    );
    assert!(
        error
            .to_string()
            .contains("another file of this name is there"),
        "{error}"
    );
    assert_eq!(fs::read(out.0.join("a.bin")).unwrap(), b"mine");
}

#[test]
fn a_compressed_buffer_is_not_unpacked_further() {
    use std::io::Write;

    let folder = Folder::new("longer-gz");
    let source = external(&folder, "a.bin.gz", "a.bin");
    let mut bytes = fs::read(folder.0.join("a.bin")).unwrap();
    let write = |bytes: &[u8]| {
        let file = fs::File::create(folder.0.join("a.bin.gz")).unwrap();
        let mut file = flate2::write::GzEncoder::new(file, flate2::Compression::fast());
        file.write_all(bytes).unwrap();
        file.finish().unwrap();
    };
    write(&bytes);
    assert_eq!(
        Document::open(&source, Limits::default())
            .unwrap()
            .meshes()
            .len(),
        1
    );
    bytes.resize(1 << 20, 0);
    write(&bytes);
    let document = Document::open(&source, Limits::default()).unwrap();
    assert!(document.meshes().is_empty());
}
