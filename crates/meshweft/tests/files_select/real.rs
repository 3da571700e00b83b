//! Real meshes and scenes, where they are present: half of the faces with the vertices they use.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::{Document, Edit, SelectedFaces, SelectedVertices};

use crate::choice::Choice;
use crate::data::folder;
use crate::random::Random;

/// The files of a folder and those below, up to a size, in a fixed order; and how many are larger.
fn files_below(folder: &Path, most: u64) -> (Vec<PathBuf>, usize) {
    let (mut files, mut folders, mut larger) = (Vec::new(), vec![folder.to_owned()], 0);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            let size = std::fs::metadata(&path).map_or(0, |data| data.len());
            match path.is_dir() {
                true => folders.push(path),
                false if size <= most => files.push(path),
                false => larger += 1,
            }
        }
    }
    files.sort();
    (files, larger)
}

/// Selects half of the faces of all meshes, with the vertices that they use where these can leave, and
/// compares what a reader sees with that; what was refused.
fn check(path: &Path, random: &mut Random) -> Option<String> {
    let mut document = Document::open(path, Limits::default()).ok()?;
    let has_vertices = |document: &Document, mesh: usize| document.meshes()[mesh].vertices_movable;
    let choices: Vec<(usize, Choice)> = (0..document.meshes().len())
        .filter(|&mesh| document.meshes()[mesh].mesh.face_count() > 0)
        .map(|mesh| {
            let entry = &document.meshes()[mesh];
            let all = 0..entry.mesh.face_count() as u32;
            let mut half: Vec<u32> = all.filter(|_| random.below(2) == 0).collect();
            if half.is_empty() {
                half.push(0);
            }
            (mesh, Choice::of_faces(entry, half))
        })
        .collect();
    if choices.is_empty() {
        return None;
    }

    let mut used: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for (mesh, choice) in &choices {
        if has_vertices(&document, *mesh) {
            let group = document.meshes()[*mesh].vertex_group;
            used.entry(group).or_default().extend(choice.used());
        }
    }
    for vertices in used.values_mut() {
        vertices.sort_unstable();
        vertices.dedup();
    }
    let before: Vec<_> = choices
        .iter()
        .map(|(mesh, _)| document.positions(*mesh).unwrap().unwrap_or_default())
        .collect();
    let faces = choices
        .iter()
        .map(|(mesh, choice)| SelectedFaces::new(*mesh, &choice.faces));
    let vertices = used
        .iter()
        .map(|(&vertex_group, vertices)| SelectedVertices {
            vertex_group,
            vertices,
        });
    let (faces, vertices): (Vec<_>, Vec<_>) = (faces.collect(), vertices.collect());
    if let Err(error) = document.edit(Edit::select(&faces, &vertices)) {
        return Some(error.to_string());
    }

    // A reader finds the same, at the same places.
    let out = std::env::temp_dir().join(format!("meshweft-half-{}", std::process::id()));
    std::fs::create_dir_all(&out).unwrap();
    let output = out.join(path.file_name().unwrap());
    document.write(&output).unwrap();
    let again = Document::open(&output, Limits::default()).unwrap();
    assert_eq!(document.meshes().len(), again.meshes().len());
    for ((mesh, choice), before) in choices.iter().zip(&before) {
        let after = again.positions(*mesh).unwrap().unwrap_or_default();
        let faces = again.meshes()[*mesh].mesh.faces();
        assert_eq!(faces, document.meshes()[*mesh].mesh.faces());
        assert_eq!(faces.len(), choice.faces.len());
        let kept = used.get(&again.meshes()[*mesh].vertex_group);
        for (face, selected) in faces.iter().zip(&choice.faces) {
            for (new, old) in face.iter().zip(selected.corners) {
                if let (Some(kept), true) = (kept, has_vertices(&document, *mesh)) {
                    assert_eq!(kept[*new as usize], old);
                }
                let places = [(&after, *new), (before, old)];
                let places =
                    places.map(|(all, v)| all.get(v as usize).map(|p| p.map(f32::to_bits)));
                assert_eq!(places[0], places[1]);
            }
        }
    }
    std::fs::remove_dir_all(&out).unwrap();
    None
}

fn check_all(most: u64) {
    let Some(folder) = folder() else { return };
    let mut random = Random(5);
    let mut refused = 0;
    let mut ran = 0;
    let mut larger = 0;
    for below in ["meshes", "gltf"] {
        let (files, too_large) = files_below(&folder.join(below), most);
        larger += too_large;
        for path in files {
            if let Some(error) = check(&path, &mut random) {
                println!("{error}");
                refused += 1;
            }
            ran += 1;
        }
    }
    println!("ran {ran} files, {refused} refused; skipped {larger} larger than {most} bytes");
    assert!(ran > 0 && refused * 4 < ran);
}

#[test]
fn half_of_the_faces_of_small_files() {
    check_all(200_000);
}

#[test]
#[ignore = "takes minutes: all files"]
fn half_of_the_faces_of_all_files() {
    check_all(u64::MAX);
}
