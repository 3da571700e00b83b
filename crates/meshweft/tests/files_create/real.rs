//! Real meshes and scenes, where they are present, as new files of every format.

use std::path::Path;

use meshweft::Limits;
use meshweft::files::{Document, Format, NewMesh};

use crate::data::folder;
use crate::plain::{FORMATS, check};

/// Makes files of the meshes of a file, each alone in every format, and all together; whether it has some.
fn check_file(path: &Path) -> bool {
    let Ok(document) = Document::open(path, Limits::default()) else {
        return false;
    };
    let positions: Vec<_> = (0..document.meshes().len())
        .map(|mesh| document.positions(mesh).unwrap().unwrap())
        .collect();
    let meshes: Vec<NewMesh<'_>> = document
        .meshes()
        .iter()
        .zip(&positions)
        .map(|(entry, positions)| NewMesh::plain(&entry.name, positions, entry.mesh.faces()))
        .collect();

    let is_finite = positions.iter().flatten().flatten().all(|x| x.is_finite());
    for format in FORMATS {
        let takes_all = matches!(format, Format::Ply | Format::Stl);
        if is_finite || takes_all {
            meshes.iter().for_each(|&mesh| check(format, &[mesh]));
        }
    }
    if is_finite && meshes.len() > 1 {
        check(Format::Glb, &meshes);
        check(Format::Obj, &meshes);
    }
    !meshes.is_empty()
}

fn check_all(most: u64) {
    let Some(data) = folder() else { return };
    let (mut ran, mut empty, mut larger) = (0, 0, 0);
    for below in ["meshes", "gltf"] {
        for entry in std::fs::read_dir(data.join(below)).unwrap() {
            let path = entry.unwrap().path();
            match std::fs::metadata(&path).unwrap() {
                file if !file.is_file() => {}
                file if file.len() > most => larger += 1,
                _ if check_file(&path) => ran += 1,
                _ => empty += 1,
            }
        }
    }
    println!(
        "ran {ran} files; {empty} have no meshes, {larger} are larger than {most} bytes: skipped"
    );
    assert!(ran > 20);
}

#[test]
fn small_files() {
    check_all(200_000);
}

#[test]
#[ignore = "takes a minute: all files"]
fn all_files() {
    check_all(u64::MAX);
}
