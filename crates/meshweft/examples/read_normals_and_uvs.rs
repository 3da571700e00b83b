//! Normals and texture coordinates of a file, read when they are asked for.
//!
//! ```text
//! cargo run --example read_normals_and_uvs --features files
//! ```

use std::error::Error;
use std::path::Path;

use meshweft::attribute::{Domain, Semantic};
use meshweft::files::{Document, Format, ReadOptions};

fn main() -> Result<(), Box<dyn Error>> {
    let (bytes, name) = (OBJ.as_bytes().to_vec(), Path::new("square.obj"));
    let document = Document::from_bytes(bytes, Format::Obj, name, ReadOptions::default())?;
    for info in document.attributes(0) {
        let values = document.attribute(0, &info)?.to_f32();
        println!("{} by {:?}: {values:?}", info.semantic, info.domain);
        assert_eq!(
            info.domain == Domain::Vertex,
            info.semantic == Semantic::Position
        );
    }
    assert_eq!(document.attributes(0).len(), 3);
    Ok(())
}

/// A square of two triangles with a normal and texture coordinates at each corner.
const OBJ: &str = "\
v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0
vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1
vn 0 0 1
f 1/1/1 2/2/1 3/3/1
f 3/3/1 2/2/1 4/4/1
";
