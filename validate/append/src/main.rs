//! Adds meshes to a glTF, leaves faces out of it, or makes files from nothing, for `../append.mjs` and
//! `../select.mjs` to judge.
//!
//! `meshweft-append scene IN OUT` adds to each of the first meshes every second of its faces, over its
//! vertices, and one mesh of its own; a line of output tells of each new mesh which one it shares
//! vertices with. `meshweft-append select IN OUT` leaves every second face of each mesh.
//! `meshweft-append create FOLDER` makes files from nothing, of every format of which such are made.

mod create;
mod scene;
mod select;

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["scene", from, to] => scene::append(Path::new(from), Path::new(to)),
        ["select", from, to] => select::select(Path::new(from), Path::new(to)),
        ["create", folder] => create::all(Path::new(folder)),
        _ => {
            let usage = "use: meshweft-append scene IN OUT | meshweft-append select IN OUT | \
                         meshweft-append create FOLDER";
            Err(usage.into())
        }
    }
}
