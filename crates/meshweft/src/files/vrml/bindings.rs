//! What moves with the faces and vertices of a face set, and what keeps it from moving.

use super::attributes::{PlacedElements, RoleValues, used_vertices};
use super::lexer::index;
use super::lists::{self, Groups, Polygons};
use super::scene::{Child, FaceSet, List, Role, Scene};
use crate::Mesh;
use crate::error::MeshError;
use crate::files::entry::MeshEntry;
use crate::files::error::Fault;
use crate::files::face_records::{FaceRecords, check_vertex_count, corner_vertex};
use crate::files::slots::Spans;
use crate::index::index32;
use crate::limits::Limits;

/// Where the records of a face set stand.
#[derive(Debug)]
pub(super) struct Slots {
    /// The polygons of `coordIndex`, then of the other lists of indices that go by corner.
    pub(super) polygons: Vec<Spans>,
    /// What goes by face: indices, colors, normals.
    pub(super) companions: Vec<Spans>,
    /// What goes by vertex: points, and colors, normals, texture coordinates without indices.
    pub(super) vertices: Vec<Spans>,
    /// What can be read.
    pub(super) values: Vec<RoleValues>,
}

/// A face set that can be ordered.
#[derive(Debug)]
pub(super) struct Bound {
    pub(super) entry: MeshEntry,
    pub(super) slots: Slots,
    /// Why its vertices stay.
    pub(super) vertices_stay: Option<String>,
    /// The number of its points in [`Binder::shared`], if they are shared; its vertices are then
    /// those that its faces name, by number.
    pub(super) shared: Option<usize>,
}

/// Why a face set stays as it is, or what is wrong with the file.
#[derive(Debug)]
pub(super) enum Stop {
    Stays(String),
    Fault(Fault),
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

fn stays<T>(why: impl Into<String>) -> Result<T, Stop> {
    Err(Stop::Stays(why.into()))
}

/// Binds face sets; the points of shared coordinates are found once.
pub(super) struct Binder<'a> {
    pub(super) text: &'a [u8],
    pub(super) scene: &'a Scene<'a>,
    pub(super) limits: &'a Limits,
    pub(super) reorder_transparent: bool,
    /// Where the points stand, by number of [`Scene::coordinates`].
    pub(super) shared: Vec<Option<Spans>>,
}

impl Binder<'_> {
    /// Reads the lists of a face set.
    ///
    /// Time O(bytes of its lists, and of the coordinates it shares when they are read first).
    pub(super) fn bind(&mut self, set: &FaceSet, number: usize) -> Result<Bound, Stop> {
        if self.scene.script_reads_nodes {
            return stays("a Script that is handed nodes may read it by number");
        }
        let own_name = set.own_name.as_ref().map(|name| &self.text[name.clone()]);
        if own_name.is_some_and(|name| self.scene.routed.contains(name)) {
            return stays("a ROUTE may replace its fields");
        }

        // Its points.
        let points = match &set.children[Role::Coord as usize] {
            Child::None => return stays("it has no coord"),
            Child::Used(None) => return stays("no Coordinate above it has the name of its coord"),
            Child::Used(Some(shared)) => &self.scene.coordinates[*shared],
            Child::Own(_, points) => points,
        };
        if points.count % 3 != 0 {
            let text = format!(
                "the Coordinate has {} numbers, which are not three a vertex",
                points.count
            );
            return Err(Fault::malformed(points.content.start, text).into());
        }
        let vertex_count = points.count / 3;
        let at = points.content.start;
        check_vertex_count(vertex_count, self.limits).map_err(|kind| Fault { at, kind })?;

        // What goes by corner, by vertex and by face.
        let mut corners = self.corners(set, vertex_count)?;
        let mut slots = Slots {
            polygons: vec![std::mem::replace(&mut corners.spans, Spans::new())],
            companions: Vec::new(),
            vertices: Vec::new(),
            values: Vec::new(),
        };
        let mut vertices_stay = None;
        for (role, per_face) in [
            (Role::Normal, set.normal_per_face),
            (Role::Color, set.color_per_face),
            (Role::TexCoord, false),
        ] {
            match per_face {
                true => self.per_face(set, role, &corners, &mut slots)?,
                false => {
                    let why = self.per_vertex(set, role, vertex_count, &mut corners, &mut slots)?;
                    vertices_stay = vertices_stay.or(why);
                }
            }
        }

        let count = corners.records.len();
        let mut runs = vec![0];
        if corners.is_open && count > 1 {
            // The last polygon has no -1 after it, and would need one anywhere else.
            runs.push(index32(count - 1));
        }

        // Its mesh.
        let malformed =
            |error: MeshError| Stop::Fault(Fault::malformed(set.span.start, error.to_string()));
        let faces = std::mem::take(&mut corners.records.faces);
        let (mesh, obstacle, shared) = match set.children[Role::Coord as usize] {
            Child::Used(Some(shared)) => {
                self.find_shared(shared)?;
                let why = "its Coordinate is shared with another node";
                (of_used(faces), Some(why.to_owned()), Some(shared))
            }
            _ => {
                slots.vertices.insert(0, lists::points(self.text, points)?);
                let mesh = Mesh::connectivity_only(vertex_count, faces);
                (mesh, self.points_stay(set), None)
            }
        };
        let mesh = mesh.map_err(malformed)?;
        let position = RoleValues::new(Role::Coord, points, PlacedElements::Vertices);
        slots.values.insert(0, position);
        vertices_stay = obstacle.or(vertices_stay);

        let name = match &set.name {
            Some(name) => String::from_utf8_lossy(&self.text[name.clone()]).into_owned(),
            None => format!("mesh {number}"),
        };
        let entry = MeshEntry {
            name,
            mesh,
            corners_turnable: corners.records.polygons.is_none(),
            level: None,
            polygons: corners.records.polygons,
            runs,
            vertex_group: 0,
            object: 0,
            has_other_faces: false,
            faces_movable: !self.is_transparent(set),
            vertices_movable: vertices_stay.is_none(),
        };
        Ok(Bound {
            entry,
            slots,
            vertices_stay,
            shared,
        })
    }

    /// Whether the faces are drawn with a transparent material, here or by a `USE`, and may not move.
    fn is_transparent(&self, set: &FaceSet) -> bool {
        let name = set.own_name.as_ref().map(|name| &self.text[name.clone()]);
        let is_used = name.is_some_and(|name| self.scene.used_transparent.contains(name));
        !self.reorder_transparent && (set.is_transparent || is_used)
    }

    /// Whether something else may read the node that hangs on a face set.
    fn is_shared(&self, child: &Child) -> bool {
        match child {
            Child::None | Child::Own(None, _) => false,
            Child::Used(_) => true,
            Child::Own(Some(name), _) => {
                let name = &self.text[name.clone()];
                self.scene.used.contains(name) || self.scene.routed.contains(name)
            }
        }
    }

    /// Why the points cannot be moved.
    fn points_stay(&self, set: &FaceSet) -> Option<String> {
        if set.in_proto {
            return Some("it stands in a PROTO".into());
        }
        let shared = self.is_shared(&set.children[Role::Coord as usize]);
        shared.then(|| "its Coordinate is named by a USE or a ROUTE".into())
    }

    /// Reads `coordIndex`.
    fn corners(&self, set: &FaceSet, vertex_count: usize) -> Result<CoordIndex, Stop> {
        let list = set.indices[Role::Coord as usize]
            .as_ref()
            .unwrap_or(&List::EMPTY);
        let mut polygons = Polygons::new(self.text, list);
        let mut found = CoordIndex {
            records: FaceRecords::default(),
            spans: Spans::new(),
            is_open: false,
            has_empty: false,
        };

        let mut corners = Vec::new();
        while let Some(polygon) = polygons.next()? {
            let face = found.records.len();
            let at = polygon.span.start;
            corners.clear();
            for (corner, &number) in polygons.numbers.iter().enumerate() {
                let vertex = corner_vertex(number, vertex_count, face, corner);
                corners.push(vertex.map_err(|kind| Fault { at, kind })?);
            }

            found.has_empty |= corners.is_empty();
            found.is_open |= polygon.is_open;
            let pushed = found.records.push(&corners, self.limits);
            let pushed = pushed.and_then(|()| found.spans.push(polygon.span));
            pushed.map_err(|kind| Fault { at, kind })?;
        }
        Ok(found)
    }

    /// Binds what goes by face.
    fn per_face(
        &self,
        set: &FaceSet,
        role: Role,
        corners: &CoordIndex,
        slots: &mut Slots,
    ) -> Result<(), Stop> {
        let (field, index_field) = (role.field(), role.index_field());
        let child = &set.children[role as usize];
        let count = corners.records.len();
        let list = set.indices[role as usize].as_ref();
        let indices = list.filter(|list| list.count > 0);
        let (list, numbers_each, what) = match (indices, child) {
            (None, Child::None) => return Ok(()),
            (Some(indices), _) => (indices, 1, index_field),
            (None, Child::Own(_, values)) if !self.is_shared(child) => (values, 3, field),
            (None, _) => {
                return stays(format!(
                    "its {field} goes by face and is shared with another node"
                ));
            }
        };

        if list.count / numbers_each < count {
            return stays(format!(
                "its {what} goes by face and has fewer entries than there are faces"
            ));
        }
        if corners.has_empty {
            return stays(format!(
                "its {what} goes by face, and there are faces without corners"
            ));
        }

        let mut spans = Spans::new();
        for span in Groups::new(self.text, list, numbers_each).take(count) {
            if numbers_each == 1 && index(&self.text[span.clone()]).is_none_or(|n| n < 0) {
                return stays(format!("its {what} goes by face and has other entries"));
            }
            let at = span.start;
            spans.push(span).map_err(|kind| Fault { at, kind })?;
        }
        if let Child::Own(_, list) = child {
            let elements = match numbers_each {
                1 => PlacedElements::FaceIndices(slots.companions.len()),
                _ => PlacedElements::Faces,
            };
            slots.values.push(RoleValues::new(role, list, elements));
        }
        slots.companions.push(spans);
        Ok(())
    }

    /// Binds what goes by corner or by vertex; why the vertices must stay, if they must.
    fn per_vertex(
        &self,
        set: &FaceSet,
        role: Role,
        vertex_count: usize,
        corners: &mut CoordIndex,
        slots: &mut Slots,
    ) -> Result<Option<String>, Stop> {
        let child = &set.children[role as usize];
        let list = set.indices[role as usize].as_ref();
        if let Some(list) = list.filter(|list| list.count > 0) {
            let spans = self.alike(set, list, corners)?;
            let Some(spans) = spans else {
                let field = role.index_field();
                return stays(format!("its {field} has other faces than coordIndex"));
            };
            if let Child::Own(_, list) = child {
                let elements = PlacedElements::Corners(slots.polygons.len());
                slots.values.push(RoleValues::new(role, list, elements));
            }
            slots.polygons.push(spans);
            return Ok(None);
        }

        let numbers_each = role.components();
        let field = role.field();
        if let Child::Own(_, list) = child
            && list.count >= vertex_count * numbers_each
        {
            let values = RoleValues::new(role, list, PlacedElements::Vertices);
            slots.values.push(values);
        }
        match child {
            Child::None => Ok(None),
            Child::Own(_, values) if !self.is_shared(child) => {
                if values.count != vertex_count * numbers_each {
                    return Ok(Some(format!(
                        "its {field} goes by vertex and has another number of entries"
                    )));
                }
                let mut spans = Spans::new();
                for span in Groups::new(self.text, values, numbers_each) {
                    let at = span.start;
                    spans.push(span).map_err(|kind| Fault { at, kind })?;
                }
                slots.vertices.push(spans);
                Ok(None)
            }
            _ => Ok(Some(format!(
                "its {field} goes by vertex and is shared with another node"
            ))),
        }
    }

    /// The polygons of another list of indices, if they are like those of `coordIndex`.
    fn alike(
        &self,
        set: &FaceSet,
        list: &List,
        corners: &mut CoordIndex,
    ) -> Result<Option<Spans>, Fault> {
        let first = set.indices[Role::Coord as usize].as_ref();
        let mut first = Polygons::new(self.text, first.unwrap_or(&List::EMPTY));
        let mut other = Polygons::new(self.text, list);
        let mut spans = Spans::new();
        while first.next()?.is_some() {
            let Some(polygon) = other.next()? else {
                return Ok(None);
            };
            if other.numbers.len() != first.numbers.len() {
                return Ok(None);
            }
            corners.is_open |= polygon.is_open;
            let at = polygon.span.start;
            let pushed = spans.push(polygon.span);
            pushed.map_err(|kind| Fault { at, kind })?;
        }
        Ok(Some(spans))
    }

    fn find_shared(&mut self, number: usize) -> Result<(), Fault> {
        let slot = &mut self.shared[number];
        if slot.is_none() {
            *slot = Some(lists::points(self.text, &self.scene.coordinates[number])?);
        }
        Ok(())
    }
}

/// The mesh of the vertices that its faces name: several face sets may share many points and name
/// few each.
fn of_used(mut faces: Vec<[u32; 3]>) -> Result<Mesh, MeshError> {
    let used = used_vertices(faces.as_flattened().to_vec());
    for vertex in faces.as_flattened_mut() {
        *vertex = index32(used.partition_point(|&other| other < *vertex));
    }
    Mesh::connectivity_only(used.len(), faces)
}

/// What `coordIndex` holds.
struct CoordIndex {
    records: FaceRecords,
    spans: Spans,
    /// Whether the last polygon of some list has no -1 after it.
    is_open: bool,
    has_empty: bool,
}
