//! The real scenes and the broken ones, where they are present.

use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::{Document, Format};

use crate::data_folder::folder;
use crate::random_orders;
use crate::reader::Reader;

/// Every `.gltf` and `.glb` below a folder, in a fixed order.
pub(crate) fn scenes_below(folder: &Path) -> Vec<PathBuf> {
    let mut scenes = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            let format = Format::of_path(&path);
            if path.is_dir() {
                folders.push(path);
            } else if matches!(format, Some(Format::Gltf | Format::Glb)) {
                scenes.push(path);
            }
        }
    }
    scenes.sort();
    scenes
}

/// The real scenes; none where there is no data.
pub(crate) fn scenes() -> Vec<PathBuf> {
    folder().map_or(Vec::new(), |folder| scenes_below(&folder.join("gltf")))
}

#[test]
fn real_scenes_keep_their_triangles() {
    let Some(folder) = folder() else { return };
    let scenes = scenes_below(&folder.join("gltf"));
    let mut mesh_count = 0;
    for path in &scenes {
        let mut document = Document::open(path, Limits::default()).unwrap();
        let before = document.to_main_bytes().unwrap();
        assert_eq!(before, std::fs::read(path).unwrap(), "{}", path.display());
        let triangles = Reader::of_file(path, None).triangles();
        mesh_count += document.meshes().len();
        println!(
            "{}: {} meshes, {} movable",
            path.display(),
            document.meshes().len(),
            document
                .meshes()
                .iter()
                .filter(|m| m.vertices_movable)
                .count(),
        );
        for note in document.notes() {
            println!("    {:?}: {}", note.place, note.text);
        }
        random_orders(&mut document, 7);
        let outputs = std::env::temp_dir().join(format!("meshweft-gltf-{}", std::process::id()));
        std::fs::create_dir_all(&outputs).unwrap();
        let output = outputs.join(path.file_name().unwrap());
        document.write(&output).unwrap();
        assert!(triangles == Reader::of_file(&output, None).triangles());
        let again = Document::open(&output, Limits::default()).unwrap();
        assert_eq!(again.meshes(), document.meshes());
        std::fs::remove_dir_all(&outputs).unwrap();
    }
    let count = scenes.len();
    assert!(count > 0, "no scenes below {}", folder.display());
    println!("ran {count} scenes, {mesh_count} meshes; skipped 0");
}

#[test]
fn broken_scenes_give_an_error_or_a_result() {
    let Some(folder) = folder() else { return };
    let scenes = scenes_below(&folder.join("malformed"));
    for path in &scenes {
        let name = path.file_name().unwrap().to_string_lossy();
        match Document::open(path, Limits::default()) {
            Ok(mut document) => {
                random_orders(&mut document, 3);
                document.to_main_bytes().unwrap();
                println!(
                    "{name}: {} meshes, {:?}",
                    document.meshes().len(),
                    document.notes()
                );
            }
            Err(error) => println!("{error}"),
        }
    }
    let count = scenes.len();
    assert!(count > 0, "no scenes below {}", folder.display());
    println!("ran {count} broken scenes; skipped 0");
}
