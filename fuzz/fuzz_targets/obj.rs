//! Any bytes as OBJ, as a file of a format that they tell, and as the library of materials beside an
//! OBJ: no panic, and what is accepted survives being permuted.
#![no_main]

mod round_trip;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use libfuzzer_sys::fuzz_target;
use meshweft::Limits;
use meshweft::files::{Document, Format, Surroundings};

const OBJ: &[u8] = b"mtllib a.mtl\nv 0 0 0\nusemtl a\nf 1 1 1\nusemtl b c\nf 1 1 1\n";

fuzz_target!(|data: &[u8]| {
    let _ = Format::of_content(data);
    round_trip::check(data, Format::Obj, "mesh.obj");

    let files = BTreeMap::from([(PathBuf::from("a.mtl"), data.to_vec())]);
    let beside = Surroundings::Memory(&files);
    let name = Path::new("mesh.obj");
    let read = Document::from_bytes_in(OBJ.to_vec(), Format::Obj, name, beside, Limits::default());
    let companions = read.expect("a library refuses nothing").companions();
    assert!(companions.iter().all(|path| path.is_relative()));
});
