//! A document as one mesh with all its levels of detail.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::options::LodError;
use crate::attribute::{Attribute, AttributeInfo, Values};
use crate::error::MeshError;
use crate::files::Document;
use crate::geometry::Ball;
use crate::index::index32;
use crate::lod::fast_mesh::{FastMesh, VertexHierarchy};
use crate::mesh::Mesh;
use crate::operations::plain_meshes::{SeparateMesh, plain_meshes};
use crate::progress::Progress;

/// What is walked around.
#[derive(Debug)]
pub(super) struct Loaded {
    pub(super) hierarchy: VertexHierarchy,
    /// The smallest that has all vertices of the hierarchy in it.
    pub(super) ball: Ball,
}

/// Joins the meshes of a document, and makes the hierarchy of all. Positions and faces count, as the file stores them.
pub(super) fn load(document: &Document, progress: &dyn Progress) -> Result<Loaded, LodError> {
    let file = || document.path().to_owned();
    let JoinedMesh { mesh, .. } = joined(document, &[])?;
    let hierarchy = FastMesh::default().build_with(&mesh, &[], progress);
    let hierarchy = hierarchy.map_err(|error| LodError::Mesh {
        file: file(),
        error,
    })?;
    match hierarchy.ball() {
        Some(ball) if hierarchy.face_count() > 0 => Ok(Loaded { hierarchy, ball }),
        _ => Err(no_faces(document)),
    }
}

/// That there is nothing to draw.
pub(super) fn no_faces(document: &Document) -> LodError {
    let file = document.path().to_owned();
    LodError::NoFaces { file }
}

/// The meshes of a document as one.
pub(super) struct JoinedMesh {
    pub(super) mesh: Mesh,
    pub(super) attributes: Vec<Attribute>,
}

/// All meshes at full resolution as one, the vertices of each after those of the one before, with attributes of vertices that all have.
pub(super) fn joined(document: &Document, kept: &[AttributeInfo]) -> Result<JoinedMesh, LodError> {
    let file = || document.path().to_owned();
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    let mut columns = JoinedColumns::new(kept);
    for SeparateMesh { number, name, mesh } in plain_meshes(document)? {
        if mesh.face_count() == 0 {
            continue;
        }
        if mesh.positions().len() != mesh.vertex_count() {
            return Err(LodError::NoPositions {
                file: file(),
                mesh: name,
            });
        }
        let is_finite = |&vertex: &u32| {
            let position = mesh.positions()[vertex as usize];
            position.iter().all(|x| x.is_finite())
        };
        let mut corners = mesh.faces().as_flattened().iter();
        if !corners.all(is_finite) {
            return Err(LodError::NotFinite {
                file: file(),
                mesh: name,
            });
        }

        // What does not fit is refused by `Mesh::new`, which sees all positions.
        let first = index32(positions.len().min(u32::MAX as usize));
        let moved = |face: &[u32; 3]| face.map(|vertex| vertex.saturating_add(first));
        faces.extend(mesh.faces().iter().map(moved));
        positions.extend_from_slice(mesh.positions());
        columns.read(document, number, &mesh)?;
    }
    let mesh = Mesh::new(positions, faces).map_err(|error| LodError::Mesh {
        file: file(),
        error,
    })?;
    let attributes = columns.finish();
    Ok(JoinedMesh { mesh, attributes })
}

/// The values of attributes, of one mesh after the other.
struct JoinedColumns<'a> {
    kept: &'a [AttributeInfo],
    /// The bytes of each attribute.
    bytes: Vec<Vec<u8>>,
    /// What meshes share, by where it is stored.
    known: BTreeMap<usize, Rc<Attribute>>,
}

impl<'a> JoinedColumns<'a> {
    fn new(kept: &'a [AttributeInfo]) -> Self {
        Self {
            kept,
            bytes: vec![Vec::new(); kept.len()],
            known: BTreeMap::new(),
        }
    }

    /// Adds the values of a mesh; `plain` is the same with vertices of its own.
    fn read(&mut self, document: &Document, number: usize, plain: &Mesh) -> Result<(), LodError> {
        if self.kept.is_empty() {
            return Ok(());
        }
        // The vertex of the document for each. Those that no face has do not matter.
        let entry = &document.meshes()[number];
        let count = index32(plain.vertex_count());
        let sources: Vec<u32> = match plain.vertex_count() == entry.mesh.vertex_count() {
            true => (0..count).collect(),
            false => {
                let mut sources = vec![0; plain.vertex_count()];
                let own = entry.mesh.faces().as_flattened();
                for (&vertex, &source) in plain.faces().as_flattened().iter().zip(own) {
                    sources[vertex as usize] = source;
                }
                sources
            }
        };

        for (place, info) in self.kept.iter().enumerate() {
            let attribute = self.attribute(document, number, info)?;
            if attribute.len() < entry.mesh.vertex_count() {
                return Err(LodError::Mesh {
                    file: document.path().to_owned(),
                    error: MeshError::LengthMismatch {
                        what: "attribute of vertices",
                        expected: entry.mesh.vertex_count(),
                        found: attribute.len(),
                    },
                });
            }
            let components = info.components;
            let mut values = Values::zeros(info.component_type, sources.len() * components);
            values.put(0, &attribute.values, components, sources.iter().copied());
            self.bytes[place].extend(values.to_le_bytes());
        }
        Ok(())
    }

    /// The values of an attribute, read once where meshes share them.
    fn attribute(
        &mut self,
        document: &Document,
        mesh: usize,
        info: &AttributeInfo,
    ) -> Result<Rc<Attribute>, LodError> {
        let store = document.store(mesh, info);
        let known = store.and_then(|store| self.known.get(&store));
        if let Some(known) = known.filter(|known| known.info == *info) {
            return Ok(Rc::clone(known));
        }
        let read = Rc::new(document.attribute(mesh, info)?);
        if let Some(store) = store {
            self.known.insert(store, Rc::clone(&read));
        }
        Ok(read)
    }

    fn finish(self) -> Vec<Attribute> {
        let attribute = |(info, bytes): (&AttributeInfo, Vec<u8>)| {
            let values = Values::from_le_bytes(info.component_type, &bytes);
            Attribute::new(info.clone(), values)
        };
        self.kept.iter().zip(self.bytes).map(attribute).collect()
    }
}
