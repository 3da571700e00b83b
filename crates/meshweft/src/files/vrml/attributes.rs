//! The values of a face set: positions, normals, colors, texture coordinates.

use super::lexer::index;
use super::lists::{Polygons, numbers};
use super::scene::{List, Role};
use crate::attribute::{AttributeInfo, ComponentType, Domain, Semantic};
use crate::files::entry::MeshEntry;
use crate::files::error::Fault;
use crate::files::orders::{RecordOrders, record_in};
use crate::files::rewrite::fan;
use crate::files::slots::Spans;

/// A list of values, and which element belongs to what.
#[derive(Debug)]
pub(super) struct RoleValues {
    role: Role,
    list: List,
    elements: PlacedElements,
}

/// Which element of a list belongs to what.
#[derive(Debug, Clone, Copy)]
pub(super) enum PlacedElements {
    /// The first to the first vertex.
    Vertices,
    /// To corners, as the polygons of the indices with this number name them.
    Corners(usize),
    /// The first to the first polygon.
    Faces,
    /// To polygons, as the indices of the companion with this number name them.
    FaceIndices(usize),
}

impl RoleValues {
    pub(super) fn new(role: Role, list: &List, elements: PlacedElements) -> Self {
        let list = list.clone();
        Self {
            role,
            list,
            elements,
        }
    }

    pub(super) fn info(&self) -> AttributeInfo {
        let semantic = match self.role {
            Role::Coord => Semantic::Position,
            Role::Normal => Semantic::Normal,
            Role::Color => Semantic::Color(0),
            Role::TexCoord => Semantic::TexCoord(0),
        };
        let domain = match self.elements {
            PlacedElements::Vertices => Domain::Vertex,
            PlacedElements::Corners(_) => Domain::Corner,
            PlacedElements::Faces | PlacedElements::FaceIndices(_) => Domain::Face,
        };
        AttributeInfo::new(semantic, domain, self.role.components(), ComponentType::F32)
    }
}

/// These vertices in rising order, each once.
pub(super) fn used_vertices(mut vertices: Vec<u32>) -> Vec<u32> {
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// A face set whose values are read.
pub(super) struct ValueReader<'a> {
    pub(super) text: &'a [u8],
    pub(super) polygons: &'a [Spans],
    pub(super) companions: &'a [Spans],
    /// Where its points stand, if they are shared.
    pub(super) shared: Option<&'a Spans>,
    pub(super) entry: &'a MeshEntry,
    pub(super) orders: &'a RecordOrders,
}

impl ValueReader<'_> {
    /// The values of one role.
    ///
    /// Time O(bytes of the lists), but for the vertices of shared points, which are sorted.
    pub(super) fn read(&self, values: &RoleValues) -> Result<Vec<f32>, Fault> {
        let (role, components) = (values.role, values.role.components());
        let mut read = Vec::new();
        if let (Role::Coord, Some(points)) = (role, self.shared) {
            for vertex in self.used()? {
                numbers(self.text, points.span(vertex), &mut read)?;
            }
            return Ok(read);
        }

        let mut list = Vec::with_capacity(values.list.count);
        numbers(self.text, values.list.content.clone(), &mut list)?;
        let count = list.len() / components;
        let add = |element: usize| {
            read.extend_from_slice(&list[element * components..][..components]);
        };

        match values.elements {
            PlacedElements::Vertices if self.shared.is_some() => {
                self.used()?.into_iter().for_each(add)
            }
            PlacedElements::Vertices => {
                let vertices = 0..self.entry.mesh.vertex_count();
                let records = vertices.map(|vertex| record_in(&self.orders.vertices, vertex));
                records.for_each(add);
            }
            PlacedElements::Corners(polygons) => {
                self.each_corner(&self.polygons[polygons], role, count, add)?;
            }
            PlacedElements::Faces => self.each_face(Ok, add)?,
            PlacedElements::FaceIndices(companion) => {
                let spans = &self.companions[companion];
                let element = |record| {
                    let span = spans.span(record);
                    let at = span.start;
                    let number = index(&self.text[span]).unwrap_or(-1);
                    existing(number, count, role, at)
                };
                self.each_face(element, add)?;
            }
        }
        Ok(read)
    }

    /// Hands over the element of each face.
    fn each_face(
        &self,
        element: impl Fn(usize) -> Result<usize, Fault>,
        mut add: impl FnMut(usize),
    ) -> Result<(), Fault> {
        for slot in 0..self.entry.record_count() {
            let face_count = match &self.entry.polygons {
                Some(starts) => starts[slot + 1] - starts[slot],
                None => 1,
            };
            if face_count == 0 {
                continue;
            }
            let element = element(record_in(&self.orders.records, slot))?;
            (0..face_count).for_each(|_| add(element));
        }
        Ok(())
    }

    /// Hands over the element of each corner of each face.
    fn each_corner(
        &self,
        polygons: &Spans,
        role: Role,
        count: usize,
        mut add: impl FnMut(usize),
    ) -> Result<(), Fault> {
        for slot in 0..self.entry.record_count() {
            let span = polygons.span(record_in(&self.orders.records, slot));
            let at = span.start;
            let list = List {
                content: span,
                count: 0,
            };
            let mut polygon = Polygons::new(self.text, &list);
            polygon.next()?;
            for corner in fan(polygon.numbers.len(), self.orders.rotation(slot)) {
                add(existing(polygon.numbers[corner], count, role, at)?);
            }
        }
        Ok(())
    }

    /// The numbers of the points that faces name, in the order of the vertices.
    fn used(&self) -> Result<Vec<usize>, Fault> {
        let mut used = Vec::with_capacity(self.entry.mesh.face_count() * 3);
        // Checked when the file was read.
        let vertex = |number: usize| used.push(u32::try_from(number).unwrap_or(u32::MAX));
        self.each_corner(&self.polygons[0], Role::Coord, usize::MAX, vertex)?;
        let used = used_vertices(used).into_iter();
        Ok(used.map(|vertex| vertex as usize).collect())
    }
}

/// The element with this number, if the list has it.
fn existing(number: i64, count: usize, role: Role, at: usize) -> Result<usize, Fault> {
    let element = usize::try_from(number).ok();
    element.filter(|&element| element < count).ok_or_else(|| {
        let (field, index_field) = (role.field(), role.index_field());
        let text = format!("{index_field} names {field} {number}, and there are {count}");
        Fault::malformed(at, text)
    })
}
