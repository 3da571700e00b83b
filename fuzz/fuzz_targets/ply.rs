//! Any bytes as PLY: no panic, and what is accepted survives being permuted, its strips as faces too.
#![no_main]

mod round_trip;

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use meshweft::Limits;
use meshweft::files::{Document, Format, ReadOptions};

fuzz_target!(|data: &[u8]| {
    round_trip::check(data, Format::Ply, "mesh.ply");

    let mut options = ReadOptions::from(Limits::default());
    options.strips_to_lists = true;
    let read = |bytes: &[u8], options: &ReadOptions| {
        Document::from_bytes(bytes.to_vec(), Format::Ply, Path::new("mesh.ply"), options)
    };
    if let Ok(document) = read(data, &options) {
        let bytes = document.to_main_bytes().expect("a name of the same format");
        let again = read(&bytes, &ReadOptions::default()).expect("what is written can be read");
        assert_eq!(document.meshes().len(), again.meshes().len());
        for (made, read) in document.meshes().iter().zip(again.meshes()) {
            assert_eq!(made.mesh.faces(), read.mesh.faces());
        }
        round_trip::check(&bytes, Format::Ply, "mesh.ply");
    }
});
