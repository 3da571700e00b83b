//! Any bytes as the material library of an OBJ, in memory: no panic, no transparent face moves, and what
//! is said of other files is a path below the folder.
#![no_main]

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use libfuzzer_sys::fuzz_target;
use meshweft::Limits;
use meshweft::files::{Document, Format, Surroundings};

/// Faces of three materials, each of them over all vertices.
const OBJ: &[u8] = b"mtllib a.mtl b c.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n\
    usemtl a\nf 1 2 3\nf 2 3 4\nusemtl b c\nf 3 4 1\nf 4 1 2\nusemtl d\nf 1 3 2\nf 2 4 3\n";

fuzz_target!(|data: &[u8]| {
    let name = Path::new("mesh.obj");
    let read = |library: Option<&[u8]>| {
        let library = library.map(|bytes| (PathBuf::from("a.mtl"), bytes.to_vec()));
        let files = BTreeMap::from_iter(library);
        let beside = Surroundings::Memory(&files);
        Document::from_bytes_in(OBJ.to_vec(), Format::Obj, name, beside, Limits::default())
            .expect("whatever a library says, the OBJ can be read")
    };
    let (without, with) = (read(None), read(Some(data)));

    // The faces are those of the OBJ; there are as many runs as without a library, or more.
    assert_eq!(with.meshes().len(), without.meshes().len());
    for (with, without) in with.meshes().iter().zip(without.meshes()) {
        assert_eq!(with.mesh.faces(), without.mesh.faces());
        assert!(without.runs.iter().all(|start| with.runs.contains(start)));
    }

    for path in with.companions() {
        let is_below = |part| matches!(part, Component::Normal(_));
        assert!(path.components().all(is_below), "{path:?}");
    }
});
