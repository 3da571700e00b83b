//! An object of a scene: primitives that get coarser together.

use std::collections::BTreeMap;

use meshweft::Mesh;
use meshweft::attribute::{Attribute, Domain};
use meshweft::files::Document;

/// Triangles, which are measured.
#[derive(Debug, Clone, Default)]
pub(crate) struct Triangles {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) faces: Vec<[u32; 3]>,
}

impl Triangles {
    pub(crate) fn add(&mut self, positions: &[[f32; 3]], faces: &[[u32; 3]]) {
        let base = u32::try_from(self.positions.len()).expect("as many as 32 bits number");
        self.positions.extend(positions);
        let based = faces.iter().map(|face| face.map(|vertex| base + vertex));
        self.faces.extend(based);
    }

    /// Their area.
    pub(crate) fn area(&self) -> f64 {
        let corner = |vertex: u32| self.positions[vertex as usize].map(f64::from);
        let faces = self.faces.iter().map(|face| {
            let [a, b, c] = face.map(corner);
            let [u, v] = [b, c].map(|it| [0, 1, 2].map(|axis| it[axis] - a[axis]));
            let normal = [0, 1, 2].map(|axis| {
                let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
                u[next] * v[last] - u[last] * v[next]
            });
            normal.iter().map(|it| it * it).sum::<f64>().sqrt() / 2.0
        });
        faces.sum()
    }
}

/// A primitive of a scene, with all that is stored with its vertices.
pub(crate) struct ScenePrimitive {
    /// Its number among the meshes of the document.
    pub(crate) number: usize,
    /// With positions. Of vertices that store the same the first one is meant.
    pub(crate) mesh: Mesh,
    /// Of the vertices.
    pub(crate) attributes: Vec<Attribute>,
}

impl ScenePrimitive {
    pub(crate) fn new(document: &Document, number: usize) -> Result<Self, String> {
        let entry = &document.meshes()[number];
        let positions = document.positions(number).map_err(|it| it.to_string())?;
        let positions = positions.ok_or_else(|| format!("{}: no positions", entry.name))?;
        let listed = document.attributes(number).into_iter();
        let of_vertices = listed.filter(|info| info.domain == Domain::Vertex);
        let attributes = of_vertices.map(|info| document.attribute(number, &info));
        let attributes: Result<Vec<Attribute>, _> = attributes.collect();
        let attributes = attributes.map_err(|it| it.to_string())?;

        // Vertices by all that they store, bit by bit.
        let columns = attributes.iter();
        let columns: Vec<(Vec<f32>, usize)> = columns
            .map(|it| (it.to_f32(), it.info.components))
            .collect();
        let mut firsts = BTreeMap::new();
        let mut first_like = |vertex: u32| {
            let at = vertex as usize;
            let stored = columns.iter();
            let stored = stored.flat_map(|(values, count)| &values[at * count..][..*count]);
            let bits: Vec<u32> = stored.map(|value| value.to_bits()).collect();
            *firsts.entry(bits).or_insert(vertex)
        };
        let faces = entry.mesh.faces().iter();
        let faces: Vec<[u32; 3]> = faces.map(|face| face.map(&mut first_like)).collect();
        Ok(Self {
            number,
            mesh: Mesh::new(positions, faces).map_err(|it| it.to_string())?,
            attributes,
        })
    }
}

/// Primitives of a file that get coarser together.
pub(crate) struct SceneObject {
    pub(crate) primitives: Vec<ScenePrimitive>,
    /// How many units of the scene one of its own is.
    pub(crate) scale: f64,
}

impl SceneObject {
    pub(crate) fn face_count(&self) -> usize {
        let counts = self.primitives.iter().map(|it| it.mesh.face_count());
        counts.sum()
    }

    /// All primitives at full resolution.
    pub(crate) fn full(&self) -> Triangles {
        let mut full = Triangles::default();
        for ScenePrimitive { mesh, .. } in &self.primitives {
            full.add(mesh.positions(), mesh.faces());
        }
        full
    }
}
