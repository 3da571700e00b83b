//! Meshes added to a scene that is there.

use std::error::Error;
use std::path::Path;

use meshweft::Limits;
use meshweft::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use meshweft::files::{Document, Edit, NewMesh, NewVertices};

/// How many meshes of a scene get a second list of faces.
const MOST: usize = 20;

/// Three corners in different directions and distances, so that none is mistaken for another.
const CORNERS: [[f32; 3]; 3] = [[0.5, 0.25, -0.125], [3.0, 0.5, 0.25], [1.0, 2.0, -0.5]];
const NORMALS: [[f32; 3]; 3] = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.6, 0.0, 0.8]];
/// Three bytes a vertex, which glTF stores at whole words.
const COLORS: [u8; 9] = [255, 0, 0, 0, 254, 1, 2, 3, 253];

/// Adds meshes to the file and writes it; prints what it has added.
pub(crate) fn append(from: &Path, to: &Path) -> Result<(), Box<dyn Error>> {
    let mut document = Document::open(from, Limits::default())?;
    let sources: Vec<usize> = (0..document.meshes().len()).take(MOST).collect();
    let halves: Vec<Vec<[u32; 3]>> = sources
        .iter()
        .map(|&mesh| every_second(&document, mesh))
        .collect();

    // The halves of what is there, and a triangle.
    let mut color = AttributeInfo::new(Semantic::Color(0), Domain::Vertex, 3, ComponentType::U8);
    color.is_normalized = true;
    let attributes = [
        Attribute::of_vertices(Semantic::Position, &CORNERS),
        Attribute::of_vertices(Semantic::Normal, &NORMALS),
        Attribute::new(color, Values::U8(COLORS.to_vec())),
    ];
    let named = sources.iter().map(|mesh| format!("half of {mesh}"));
    let named: Vec<String> = named.collect();
    let shared = sources.iter().zip(&named).zip(&halves);
    let mut meshes: Vec<NewMesh<'_>> = shared
        .filter(|(_, faces)| !faces.is_empty())
        .map(|((&mesh, name), faces)| NewMesh::new(name, NewVertices::Shared(mesh), faces))
        .collect();
    let vertices = NewVertices::Stored(&attributes);
    meshes.push(NewMesh::new("triangle", vertices, &[[0, 1, 2]]));

    // Told before, when the numbers are those of the source.
    for mesh in &meshes {
        let source = match mesh.vertices {
            NewVertices::Shared(mesh) => document.meshes()[mesh].name.clone(),
            _ => String::new(),
        };
        println!("{}\t{}\t{source}", mesh.name, mesh.faces.len());
    }
    document.edit(Edit::append(&meshes))?;
    document.write(to)?;
    Ok(())
}

fn every_second(document: &Document, mesh: usize) -> Vec<[u32; 3]> {
    let faces = document.meshes()[mesh].mesh.faces();
    faces.iter().copied().step_by(2).collect()
}
