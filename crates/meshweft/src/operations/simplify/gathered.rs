//! The meshes of an object as one mesh: what stands at a corner is a vertex of it.
//!
//! A vertex of a file may have several things at its corners: texture coordinates of an OBJ, faces of several
//! materials or primitives. Each is a *side*, a vertex of the mesh that is simplified. So a border between
//! materials is treated as a seam is: its points move along it, and the sides at a point together.

use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

use crate::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use crate::cache::CacheModel;
use crate::faces::Faces;
use crate::files::{Document, FileError, MeshEntry};
use crate::first_use::FirstUse;
use crate::index::index32;
use crate::mesh::Mesh;
use crate::order::KCacheReorder;

/// Some meshes of a file, as one.
pub(super) struct GatheredMesh {
    /// Its vertices are the sides.
    pub(super) mesh: Mesh,
    /// What is stored with the sides.
    pub(super) attributes: Vec<Attribute>,
    pub(super) sides: Vec<Side>,
    /// Where each face is in the file.
    pub(super) faces: Vec<MeshFace>,
}

/// A vertex of a mesh, as some of its corners have it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Side {
    /// The number of the mesh in the file.
    pub(super) mesh: u32,
    pub(super) vertex: u32,
    /// The first corner of the mesh that has it: three times a face, and 0, 1 or 2.
    pub(super) corner: u32,
    kind: u32,
}

impl Side {
    /// Equal for sides that nothing keeps apart but what they store.
    pub(super) fn part(self) -> (u32, u32) {
        (self.mesh, self.kind)
    }
}

/// A face of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct MeshFace {
    /// The number of the mesh in the file.
    pub(super) mesh: u32,
    pub(super) face: u32,
}

impl GatheredMesh {
    /// These meshes of a document as one, mesh after mesh, each in a sequence where near faces are near.
    ///
    /// # Errors
    /// Why they cannot be simplified.
    ///
    /// # Complexity
    /// Time O(faces), and what it takes to read the attributes; about 100 bytes a face and what they take.
    pub(super) fn new(document: &Document, meshes: &[usize]) -> Result<Self, String> {
        let mut gathered = Self {
            mesh: Mesh::default(),
            attributes: Vec::new(),
            sides: Vec::new(),
            faces: Vec::new(),
        };
        let refused = |error: FileError| error.kind.to_string();

        // Faces and sides.
        let mut corners = Vec::new();
        let mut starts = Vec::new();
        for &mesh in meshes {
            let kinds = document.corner_kinds(mesh).map_err(refused)?;
            starts.push(gathered.sides.len());
            gathered.add(
                index32(mesh),
                &document.meshes()[mesh],
                &kinds,
                &mut corners,
            );
        }
        starts.push(gathered.sides.len());

        // What is stored with each.
        let mut columns = Columns::new(gathered.sides.len());
        for (&mesh, range) in meshes.iter().zip(starts.windows(2)) {
            let sides = &gathered.sides[range[0]..range[1]];
            columns.read(document, mesh, range[0], sides)?;
        }
        let Columns {
            positions, values, ..
        } = columns;
        gathered.attributes = values
            .into_iter()
            .map(|(info, values)| Attribute::new(info, values))
            .collect();
        let is_one = meshes.len() == 1 && gathered.sides.iter().all(|side| side.kind == 0);
        if !is_one {
            gathered.attributes.push(gathered.parts());
        }
        let mesh = Mesh::new(positions, corners);
        gathered.mesh = mesh.map_err(|error| error.to_string())?;
        Ok(gathered)
    }

    /// Adds the faces of a mesh; `kinds` are of its corners.
    fn add(&mut self, number: u32, entry: &MeshEntry, kinds: &[u32], corners: &mut Vec<[u32; 3]>) {
        // Sides by what they hold.
        let all = entry.mesh.faces();
        let mut numbers = FirstUse::new(entry.mesh.vertex_count(), 3 * all.len());
        let mut by_kind: HashMap<(u32, u32), u32> = HashMap::new();
        let mut sides: Vec<Side> = Vec::new();
        let mut local = all.to_vec();
        for (corner, slot) in local.as_flattened_mut().iter_mut().enumerate() {
            let (vertex, kind) = (*slot, kinds.get(corner).copied().unwrap_or(0));
            let next = index32(sides.len());
            *slot = match kinds.is_empty() {
                true => numbers.number(vertex),
                false => *by_kind.entry((vertex, kind)).or_insert(next),
            };
            if *slot == next {
                let (mesh, corner) = (number, index32(corner));
                sides.push(Side {
                    mesh,
                    vertex,
                    corner,
                    kind,
                });
            }
        }

        // Near faces near each other, sides by their first use.
        let sequence = KCacheReorder {
            cache: CacheModel::fifo(15),
            keep_corners: true,
            ..KCacheReorder::default()
        };
        let order = sequence.face_order(Faces::of_checked(&local, sides.len()));
        let local = order.apply(&local);
        let mut numbers = FirstUse::new(sides.len(), 3 * local.len());
        let base = index32(self.sides.len());
        let numbered = local
            .iter()
            .map(|face| face.map(|side| base + numbers.number(side)));
        corners.extend(numbered);
        let used = numbers.finish();
        self.sides
            .extend(used.into_iter().map(|side| sides[side as usize]));
        let faces = order.new_to_old().iter();
        self.faces
            .extend(faces.map(|&face| MeshFace { mesh: number, face }));
    }

    /// What keeps sides apart whatever they store: their meshes and kinds.
    fn parts(&self) -> Attribute {
        let name = Semantic::Other("part".into());
        let info = AttributeInfo::new(name, Domain::Vertex, 2, ComponentType::U32);
        let parts = self.sides.iter().flat_map(|side| [side.mesh, side.kind]);
        Attribute::new(info, Values::U32(parts.collect()))
    }
}

/// What is stored with sides, attribute by attribute.
struct Columns {
    side_count: usize,
    positions: Vec<[f32; 3]>,
    /// Zeros where a mesh does not have an attribute.
    values: Vec<(AttributeInfo, Values)>,
    /// What meshes share, by where it is stored.
    known: BTreeMap<usize, Rc<Attribute>>,
}

impl Columns {
    fn new(side_count: usize) -> Self {
        Self {
            side_count,
            positions: Vec::with_capacity(side_count),
            values: Vec::new(),
            known: BTreeMap::new(),
        }
    }

    /// Reads what the sides of a mesh have, which are those from `start` on.
    fn read(
        &mut self,
        document: &Document,
        mesh: usize,
        start: usize,
        sides: &[Side],
    ) -> Result<(), String> {
        for info in document.attributes(mesh) {
            let element = match info.domain {
                Domain::Vertex => |side: &Side| side.vertex,
                Domain::Corner => |side: &Side| side.corner,
                Domain::Face => continue,
            };
            let is_position = info.semantic == Semantic::Position
                && info.morph_target.is_none()
                && info.domain == Domain::Vertex;
            let attribute = self.attribute(document, mesh, &info)?;
            let entry = &document.meshes()[mesh];
            let expected = match info.domain {
                Domain::Vertex => entry.mesh.vertex_count(),
                _ => 3 * entry.mesh.face_count(),
            };
            if attribute.len() < expected {
                return Err(format!(
                    "there are {} {} for {expected} vertices",
                    attribute.len(),
                    info.semantic
                ));
            }

            if is_position && info.components == 3 && self.positions.len() == start {
                let numbers = attribute.to_f32();
                let of_side = |side: &Side| numbers.as_chunks().0[side.vertex as usize];
                self.positions.extend(sides.iter().map(of_side));
                // Nothing else is to be compared, unless they were rounded.
                if info.component_type == ComponentType::F32 {
                    continue;
                }
            }
            let components = info.components;
            let info = AttributeInfo {
                domain: Domain::Vertex,
                ..info
            };
            let found = self.values.iter().position(|(known, _)| *known == info);
            let column = found.unwrap_or_else(|| {
                let len = self.side_count * components;
                let zeros = Values::zeros(info.component_type, len);
                self.values.push((info, zeros));
                self.values.len() - 1
            });
            let numbers = sides.iter().map(element);
            self.values[column]
                .1
                .put(start, &attribute.values, components, numbers);
        }
        match self.positions.len() == start + sides.len() {
            true => Ok(()),
            false => Err("it has no positions of three coordinates".into()),
        }
    }

    /// The values of an attribute, read once where meshes share them.
    fn attribute(
        &mut self,
        document: &Document,
        mesh: usize,
        info: &AttributeInfo,
    ) -> Result<Rc<Attribute>, String> {
        let store = document.store(mesh, info);
        let known = store.and_then(|store| self.known.get(&store));
        if let Some(known) = known.filter(|known| known.info == *info) {
            return Ok(Rc::clone(known));
        }
        let read = document.attribute(mesh, info);
        let read = Rc::new(read.map_err(|error| error.kind.to_string())?);
        if let Some(store) = store {
            self.known.insert(store, Rc::clone(&read));
        }
        Ok(read)
    }
}
