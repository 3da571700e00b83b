//! A second list of indices over the vertices of a mesh, added to a GLB as one more mesh.
//!
//! ```text
//! cargo run --example append_index_list --features files
//! ```

use std::error::Error;
use std::path::Path;

use meshweft::attribute::{Attribute, Semantic};
use meshweft::files::{Document, Edit, Format, NewMesh, NewVertices, ReadOptions};

fn main() -> Result<(), Box<dyn Error>> {
    let (bytes, name) = (strip()?, Path::new("strip.glb"));
    let mut document = Document::from_bytes(bytes, Format::Glb, name, ReadOptions::default())?;
    let faces = [[0, 1, 198], [198, 1, 199]];
    let coarse = NewMesh::new("coarse", NewVertices::Shared(0), &faces);
    document.edit(Edit::append(&[coarse]))?;
    println!("{} bytes", document.to_main_bytes()?.len());

    let [fine, coarse] = document.meshes() else {
        panic!("two meshes")
    };
    assert_eq!((fine.mesh.face_count(), coarse.mesh.face_count()), (198, 2));
    assert_eq!(fine.vertex_group, coarse.vertex_group);
    Ok(())
}

/// A flat strip of 198 faces.
fn strip() -> Result<Vec<u8>, Box<dyn Error>> {
    let position = |i: u16| [f32::from(i / 2), f32::from(i % 2), 0.0];
    let positions: Vec<[f32; 3]> = (0..200).map(position).collect();
    let attributes = [Attribute::of_vertices(Semantic::Position, &positions)];
    let face = |i: u32| [i + i % 2, i + 1 - i % 2, i + 2];
    let faces: Vec<[u32; 3]> = (0..198).map(face).collect();
    let mesh = NewMesh::new("strip", NewVertices::Stored(&attributes), &faces);
    let document = Document::create(Format::Glb, Path::new("strip.glb"), &[mesh])?;
    Ok(document.to_main_bytes()?)
}
