//! Any bytes as VRML: no panic, and what is accepted survives being permuted.
#![no_main]

mod round_trip;

use libfuzzer_sys::fuzz_target;
use meshweft::files::Format;

fuzz_target!(|data: &[u8]| round_trip::check(data, Format::Vrml, "mesh.wrl"));
