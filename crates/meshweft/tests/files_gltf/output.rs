//! Where the parts of a `.gltf` go.

use std::fs;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::Document;
use serde_json::json;

use crate::builder::{Builder, F32, U16, faces};
use crate::random_orders;
use crate::reader::Reader;

/// An empty folder that goes when it is dropped.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let name = format!("meshweft-{name}-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// The files below it by relative path, in order.
    pub(crate) fn files(&self) -> Vec<String> {
        let mut files = Vec::new();
        let mut folders = vec![self.0.clone()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                match path.is_dir() {
                    true => folders.push(path),
                    false => files.push(
                        path.strip_prefix(&self.0)
                            .unwrap()
                            .to_string_lossy()
                            .replace('\\', "/"),
                    ),
                }
            }
        }
        files.sort();
        files
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Text that a JSON writer would not give back: odd white space, escapes, numbers, order of fields.
pub(crate) fn text(builder: &Builder, buffers: &str) -> String {
    let views = serde_json::to_string(&builder.views).unwrap();
    let accessors = serde_json::to_string(&builder.accessors).unwrap();
    format!(
        "{{\n\t\"zeta\" : 1.0e+2, \"asset\":{{\"version\":\"2.0\"}} ,\r\n\
         \"buffers\" : {buffers} ,\n\"bufferViews\":{views},\"accessors\":{accessors},\n\
         \"meshes\":[{{\"name\":\"\\u0061\",\"primitives\":[{{\"attributes\":{{\"POSITION\":0}},\
         \"indices\":1}}]}}] , \"alpha\":[1.50,\"\\/\"]}}\n"
    )
}

pub(crate) fn builder() -> Builder {
    let mut builder = Builder::default();
    builder.data(F32, "VEC3", 20);
    builder.indices(U16, &faces(12, 20));
    builder
}

pub(crate) fn external(folder: &Folder, uri: &str, file: &str) -> PathBuf {
    let builder = builder();
    let length = builder.binary.len();
    let buffers = format!("[ {{\"byteLength\":{length}, \"uri\" :\"{uri}\" , \"x\":0}} ]");
    let path = folder.0.join("scene.gltf");
    fs::write(&path, text(&builder, &buffers)).unwrap();
    let file = folder.0.join(file);
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(file, &builder.binary).unwrap();
    path
}

/// The files called `stem.01234567.bin`, with digits of what is in them.
pub(crate) fn named_after(folder: &Folder, stem: &str) -> Vec<String> {
    let digits = |name: &str| {
        let digits = name
            .strip_prefix(stem)?
            .strip_prefix('.')?
            .strip_suffix(".bin")?;
        Some(digits.len() == 8 && digits.bytes().all(|byte| byte.is_ascii_hexdigit()))
    };
    let files = folder.files().into_iter();
    files.filter(|name| digits(name) == Some(true)).collect()
}

pub(crate) fn ordered(path: &Path) -> Document {
    let mut document = Document::open(path, Limits::default()).unwrap();
    random_orders(&mut document, 1);
    document
}

#[test]
fn another_folder_gets_the_buffers_under_their_names() {
    let folder = Folder::new("another-folder");
    let source = external(&folder, "sub%20folder/a.bin", "sub folder/a.bin");
    let before = Reader::of_file(&source, None);
    let output = folder.0.join("out/scene.gltf");
    ordered(&source).write(&output).unwrap();
    let files = [
        "out/scene.gltf",
        "out/sub folder/a.bin",
        "scene.gltf",
        "sub folder/a.bin",
    ];
    assert_eq!(folder.files(), files);
    assert_eq!(fs::read(&source).unwrap(), fs::read(&output).unwrap());
    let (old, new) = (
        fs::read(folder.0.join("sub folder/a.bin")).unwrap(),
        fs::read(folder.0.join("out/sub folder/a.bin")).unwrap(),
    );
    assert_ne!(old, new);
    assert!(before.triangles() == Reader::of_file(&output, None).triangles());
}

#[test]
fn the_same_path_is_written_over() {
    let folder = Folder::new("same-path");
    let source = external(&folder, "./a.bin", "a.bin");
    let before = Reader::of_file(&source, None);
    let json = fs::read(&source).unwrap();
    ordered(&source).write(&source).unwrap();
    assert_eq!(folder.files(), ["a.bin", "scene.gltf"]);
    assert_eq!(fs::read(&source).unwrap(), json);
    let after = Reader::of_file(&source, None);
    assert!(before.triangles() == after.triangles());
    assert_ne!(before.buffers, after.buffers);
}

#[test]
fn another_name_in_the_folder_gets_a_buffer_of_its_own() {
    let folder = Folder::new("another-name");
    let source = external(&folder, "a.bin", "a.bin");
    let before = Reader::of_file(&source, None);
    // Nothing has changed yet: both can share the buffer.
    let unchanged = Document::open(&source, Limits::default()).unwrap();
    unchanged.write(&folder.0.join("same.gltf")).unwrap();
    assert_eq!(folder.files(), ["a.bin", "same.gltf", "scene.gltf"]);

    ordered(&source)
        .write(&folder.0.join("new one.v2.gltf"))
        .unwrap();
    let files = [
        "a.bin",
        "new one.v2.bin",
        "new one.v2.gltf",
        "same.gltf",
        "scene.gltf",
    ];
    assert_eq!(folder.files(), files);
    let json = fs::read_to_string(&source).unwrap();
    let new = fs::read_to_string(folder.0.join("new one.v2.gltf")).unwrap();
    assert_eq!(new, json.replace("a.bin", "new%20one.v2.bin"));
    assert!(before.triangles() == Reader::of_file(&source, None).triangles());

    // The buffer of the source is never overwritten.
    ordered(&source).write(&folder.0.join("a.gltf")).unwrap();
    let new = fs::read_to_string(folder.0.join("a.gltf")).unwrap();
    let [name] = &named_after(&folder, "a")[..] else {
        panic!("one buffer named after its content")
    };
    assert_eq!(new, json.replace("a.bin", name));
    let after = Reader::of_file(&folder.0.join("a.gltf"), None);
    assert!(before.triangles() == after.triangles());
}

#[test]
fn two_buffers_over_one_file_are_one() {
    let folder = Folder::new("one-file");
    let mut builder = builder();
    builder.views[1]["buffer"] = json!(1);
    let length = builder.binary.len();
    let buffers = format!(
        "[{{\"uri\":\"a.bin\",\"byteLength\":{length}}},{{\"uri\":\"./a.bin\",\"byteLength\":{length}}}]"
    );
    let source = folder.0.join("scene.gltf");
    fs::write(&source, text(&builder, &buffers)).unwrap();
    fs::write(folder.0.join("a.bin"), &builder.binary).unwrap();
    ordered(&source).write(&folder.0.join("b.gltf")).unwrap();
    assert_eq!(folder.files(), ["a.bin", "b.bin", "b.gltf", "scene.gltf"]);
    let before = Reader::of_file(&source, None);
    fs::copy(folder.0.join("b.bin"), folder.0.join("x.bin")).unwrap();
    let new = fs::read_to_string(folder.0.join("b.gltf")).unwrap();
    assert_eq!(new.matches("\"b.bin\"").count(), 2);
    let after = Reader::of_file(&folder.0.join("b.gltf"), None);
    assert!(before.triangles() == after.triangles());
}

#[test]
fn only_the_text_of_a_data_uri_is_replaced() {
    let folder = Folder::new("data-uri");
    let builder = builder();
    let base64 = encode(&builder.binary);
    let length = builder.binary.len();
    let buffers = format!("[{{ \"uri\":\"data:a/b;base64,{base64}\", \"byteLength\":{length} }}]");
    let source = folder.0.join("scene.gltf");
    fs::write(&source, text(&builder, &buffers)).unwrap();
    let before = Reader::of_file(&source, None);
    let document = Document::open(&source, Limits::default()).unwrap();
    assert_eq!(
        document.to_main_bytes().unwrap(),
        fs::read(&source).unwrap()
    );
    let output = folder.0.join("out.gltf");
    ordered(&source).write(&output).unwrap();
    let after = Reader::of_file(&output, None);
    assert!(before.triangles() == after.triangles());
    let new_base64 = encode(after.buffers[0].as_ref().unwrap());
    assert_ne!(base64, new_base64);
    let expected = text(&builder, &buffers).replace(&base64, &new_base64);
    assert_eq!(fs::read_to_string(&output).unwrap(), expected);
}

#[test]
fn the_buffer_is_never_written_over_the_text() {
    let folder = Folder::new("name-clash");
    let source = external(&folder, "out.gltf", "out.gltf");
    let output = folder.0.join("x/out.gltf");
    let error = ordered(&source).write(&output).unwrap_err().to_string();
    assert!(
        error.ends_with("is the name of a buffer of the file: choose another for the output"),
        "{error}"
    );
}

#[test]
fn a_compressed_text_keeps_its_buffer_beside_it() {
    let folder = Folder::new("gz");
    let source = external(&folder, "a.bin", "a.bin");
    let output = folder.0.join("out.gltf.gz");
    ordered(&source).write(&output).unwrap();
    let files = ["a.bin", "out.bin", "out.gltf.gz", "scene.gltf"];
    assert_eq!(folder.files(), files);
    let again = Document::open(&output, Limits::default()).unwrap();
    assert_eq!(again.meshes(), ordered(&source).meshes());
}

#[test]
fn sizes_are_of_all_files_on_the_disk() {
    let folder = Folder::new("sizes");
    let source = external(&folder, "a.bin", "a.bin");
    let size = |path: &Path| fs::metadata(path).unwrap().len();
    let document = ordered(&source);
    let buffer = folder.0.join("a.bin");
    assert_eq!(document.source_bytes(), size(&source) + size(&buffer));

    let (output, new) = (folder.0.join("out.gltf.gz"), folder.0.join("out.bin"));
    let written = document.write(&output).unwrap();
    assert_eq!(written.files, [new.as_path(), output.as_path()]);
    assert_eq!(written.bytes, size(&new) + size(&output));

    // Nothing has changed: the buffer is shared, and neither written nor counted.
    let unchanged = Document::open(&source, Limits::default()).unwrap();
    let output = folder.0.join("same.gltf");
    let written = unchanged.write(&output).unwrap();
    assert_eq!(written.files, [output.as_path()]);
    assert_eq!(written.bytes, size(&output));
}

/// Base64, bit by bit.
fn encode(bytes: &[u8]) -> String {
    let alphabet: Vec<char> = ('A'..='Z')
        .chain('a'..='z')
        .chain('0'..='9')
        .chain(['+', '/'])
        .collect();
    let bits: Vec<usize> = bytes
        .iter()
        .flat_map(|&byte| (0..8).rev().map(move |i| usize::from(byte >> i & 1)))
        .collect();
    let mut text: String = bits
        .chunks(6)
        .map(|six| alphabet[(0..6).fold(0, |n, i| n << 1 | six.get(i).unwrap_or(&0))])
        .collect();
    while !text.len().is_multiple_of(4) {
        text.push('=');
    }
    text
}
