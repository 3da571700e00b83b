//! Stanford PLY, ascii and binary: rows of the `vertex` and `face` elements move.
//!
//! A row moves with everything in it, so properties that nobody here knows stay with their vertex
//! or face. Three things may hang on an order without saying so, and keep what they hang on where
//! it is:
//!
//! - another element may name vertices by number (edges, strips), so the vertices stay;
//! - another element may name faces or stand beside them row by row, so the faces stay, except for
//!   `multi_texture_face`, whose rows are known to go with the faces;
//! - a face property may be about one corner or one edge, so corners are turned only where every
//!   property is known to be about the face as a whole.
//!
//! [`header`] says what is in the file, [`rows`] reads it, [`notation`] writes corners.

mod header;
mod notation;
mod rows;

use std::ops::Range;

use crate::Mesh;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::records::{
    FaceRecords, Spans, check_face_count, check_vertex_count, past_the_last_vertex,
};
use crate::files::splice::{Orders, RecordFile};
use crate::files::text::line_of;
use crate::files::{MeshEntry, Note, ReadOptions, ReadResult};
use crate::limits::{Limits, index32};
use header::{Element, Encoding, Header, Kind, Scalar};
use notation::PlyNotation;
use rows::{Ascii, Binary, Fault, Row, Rows, TriangleLayout};

/// Face properties that are about the whole face, so that its corners may be turned.
const OF_A_WHOLE_FACE: [&str; 17] = [
    "alpha",
    "blue",
    "confidence",
    "green",
    "group",
    "id",
    "intensity",
    "label",
    "material",
    "material_index",
    "nx",
    "ny",
    "nz",
    "quality",
    "red",
    "texnumber",
    "value",
];

/// Elements that name neither vertices nor faces.
const NAME_NOTHING: [&str; 3] = ["camera", "material", "multi_texture_vertex"];

/// Reads a PLY file.
pub(super) fn read(bytes: Vec<u8>, options: &ReadOptions) -> ReadResult {
    let limits = &options.limits;
    let header = header::read(&bytes)?;
    let plan = Plan::new(&header, options)?;
    let at_header = |element: &Element, kind: FileErrorKind| kind.at(Place::Line(element.line));
    if let Some(element) = header.element("vertex") {
        check_vertex_count(element.count, limits).map_err(|kind| at_header(element, kind))?;
    }
    if let Some(element) = header.element("face") {
        check_face_count(element.count, limits).map_err(|kind| at_header(element, kind))?;
    }
    let read = match header.encoding {
        Encoding::Ascii => body(Ascii::new(&bytes, header.body), &header, &plan, limits),
        Encoding::LittleEndian => body(
            Binary::<false>::new(&bytes, header.body),
            &header,
            &plan,
            limits,
        ),
        Encoding::BigEndian => body(
            Binary::<true>::new(&bytes, header.body),
            &header,
            &plan,
            limits,
        ),
    };
    let body = read.map_err(|fault| {
        fault.kind.at(match header.encoding {
            Encoding::Ascii => Place::Line(line_of(&bytes, fault.at)),
            _ => Place::Byte(fault.at),
        })
    })?;
    finish(bytes, &header, plan, body)
}

fn finish(bytes: Vec<u8>, header: &Header, plan: Plan, body: Body) -> ReadResult {
    let mut notes = Vec::new();
    let mut entries = Vec::new();
    let record_count = body.records.len();
    if record_count == 0 {
        let strips = header.element("tristrips");
        notes.push(Note::new(
            strips.map_or(Place::File, |strips| Place::Line(strips.line)),
            match strips {
                Some(_) => "triangle strips stay as they are: convert them to faces first",
                None => "no faces: there is nothing to order",
            },
        ));
    } else {
        let mesh = match body.positions.is_empty() {
            true => Mesh::connectivity_only(body.vertices.len(), body.records.faces),
            false => Mesh::new(body.positions, body.records.faces),
        };
        let mesh = mesh.map_err(|e| FileErrorKind::malformed(e.to_string()).at(Place::File))?;
        let faces_move = plan.face_obstacle.is_none();
        entries.push(MeshEntry {
            name: "mesh".into(),
            mesh,
            corners_turnable: plan.corners_turnable
                && faces_move
                && body.records.polygons.is_none(),
            polygons: body.records.polygons,
            // Where faces must stay, each is a run of its own.
            runs: match faces_move {
                true => vec![0],
                false => (0..index32(record_count)).collect(),
            },
            vertex_group: 0,
            vertices_movable: plan.vertex_obstacle.is_none(),
        });
        notes.extend(
            [plan.vertex_obstacle, plan.face_obstacle]
                .into_iter()
                .flatten(),
        );
    }
    let file = RecordFile {
        source: bytes,
        vertices: body.vertices,
        faces: body.faces,
        companions: body.companions,
        lines: Spans::new(),
        notation: PlyNotation::new(header),
        entries,
        orders: Orders::default(),
    };
    Ok((Box::new(file), notes))
}

/// What may move, decided from the header alone.
struct Plan {
    vertex_obstacle: Option<Note>,
    face_obstacle: Option<Note>,
    corners_turnable: bool,
}

impl Plan {
    fn new(header: &Header, options: &ReadOptions) -> Result<Self, Problem> {
        let mut plan = Self {
            vertex_obstacle: None,
            face_obstacle: None,
            corners_turnable: true,
        };
        let face = header.element("face");
        for element in &header.elements {
            match element.name.as_str() {
                "vertex" => plan.look_at_vertex(element),
                "face" => plan.look_at_face(element, header.vertex_count()),
                name if NAME_NOTHING.contains(&name) || options.is_assumed_safe(name) => {}
                "multi_texture_face" if face.is_some_and(|face| face.count == element.count) => {
                    // Its lists are one entry a corner.
                    plan.corners_turnable = false;
                }
                name => {
                    let what = format!("the element {name:?}");
                    let beside_faces = face.is_some_and(|face| face.count == element.count);
                    let names_faces = element.properties.iter().any(|p| p.name.contains("face"));
                    let is_known = matches!(name, "edge" | "tristrips");
                    if !is_known && let Some(kind) = options.refusal("the element", name) {
                        return Err(kind.at(Place::Line(element.line)));
                    }
                    if name.contains("face") || names_faces || beside_faces && !is_known {
                        plan.keep_faces(element, &what);
                    }
                    plan.keep_vertices(element, &what);
                }
            }
        }
        Ok(plan)
    }

    fn look_at_vertex(&mut self, element: &Element) {
        for property in &element.properties {
            if matches!(property.kind, Kind::List { item, .. } if !item.is_float()) {
                let what = format!("the list {:?} of the vertices", property.name);
                match property.name.contains("face") {
                    true => self.keep_faces(element, &what),
                    false => self.keep_vertices(element, &what),
                }
            }
        }
    }

    fn look_at_face(&mut self, element: &Element, vertex_count: usize) {
        let list = element.corner_list();
        for (number, property) in element.properties.iter().enumerate() {
            if Some(number) == list {
                continue;
            }
            let name = property.name.as_str();
            let what = format!("the list {name:?} of the faces");
            match property.kind {
                Kind::Scalar(_) => self.corners_turnable &= OF_A_WHOLE_FACE.contains(&name),
                Kind::List { item, .. } => {
                    self.corners_turnable = false;
                    if !item.is_float() && name.contains("face") {
                        self.keep_faces(element, &what);
                    } else if !item.is_float() && !name.contains("tex") {
                        self.keep_vertices(element, &what);
                    }
                }
            }
        }
        let list = list.map(|list| element.properties[list].kind);
        if let Some(Kind::List { item, .. }) = list
            && vertex_count as u64 > item.largest().saturating_add(1)
        {
            let text = format!(
                "the vertices stay where they are: their indices are stored in {} bytes, which \
                 cannot name all {vertex_count}",
                item.size()
            );
            let note = || Note::new(Place::Line(element.line), text);
            self.vertex_obstacle.get_or_insert_with(note);
        }
    }

    fn keep_vertices(&mut self, element: &Element, what: &str) {
        self.vertex_obstacle.get_or_insert_with(|| {
            let text = format!("the vertices stay where they are: {what} may name them by number");
            Note::new(Place::Line(element.line), text)
        });
    }

    fn keep_faces(&mut self, element: &Element, what: &str) {
        self.face_obstacle.get_or_insert_with(|| {
            let text = format!("the faces stay where they are: {what} may go by their order");
            Note::new(Place::Line(element.line), text)
        });
    }
}

/// What was found behind the header.
struct Body {
    vertices: Spans,
    positions: Vec<[f32; 3]>,
    faces: Spans,
    records: FaceRecords,
    companions: Vec<Spans>,
}

fn body<R: Rows>(
    mut rows: R,
    header: &Header,
    plan: &Plan,
    limits: &Limits,
) -> Result<Body, Fault> {
    let mut body = Body {
        vertices: Spans::new(),
        positions: Vec::new(),
        faces: Spans::new(),
        records: FaceRecords::default(),
        companions: Vec::new(),
    };
    let face_count = header.element("face").map_or(0, |face| face.count);
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => read_vertices(&mut rows, element, &mut body)?,
            "face" => read_faces(&mut rows, element, header, limits, &mut body)?,
            "multi_texture_face" if element.count == face_count && plan.face_obstacle.is_none() => {
                let mut spans = Spans::new();
                pass_over(&mut rows, element, |_, span| spans.push(span))?;
                body.companions.push(spans);
            }
            _ => pass_over(&mut rows, element, |_, _| Ok(()))?,
        }
    }
    Ok(body)
}

/// Reads past the rows of an element, and hands over where each stands.
fn pass_over<R: Rows>(
    rows: &mut R,
    element: &Element,
    mut seen: impl FnMut(usize, Range<usize>) -> Result<(), FileErrorKind>,
) -> Result<(), Fault> {
    if element.properties.is_empty() {
        return Ok(());
    }
    for number in 0..element.count {
        let row = Row { element, number };
        let start = rows.start_row();
        for property in &element.properties {
            match property.kind {
                Kind::Scalar(scalar) => rows.skip(1, scalar, &row)?,
                Kind::List { count, item } => {
                    let count = list_length(rows, count, &row)?;
                    rows.skip(count, item, &row)?;
                }
            }
        }
        let span = start..rows.end_row(&row)?;
        let at = span.start;
        seen(number, span).map_err(|kind| Fault { at, kind })?;
    }
    Ok(())
}

fn list_length<R: Rows>(rows: &mut R, scalar: Scalar, row: &Row<'_>) -> Result<usize, Fault> {
    let at = rows.at();
    let length = rows.whole(scalar, row)?;
    usize::try_from(length).map_err(|_| row.malformed(at, format!("a list of {length} entries")))
}

fn read_vertices<R: Rows>(rows: &mut R, element: &Element, body: &mut Body) -> Result<(), Fault> {
    let [Some(x), Some(y), Some(z)] = ["x", "y", "z"].map(|name| element.scalar(name)) else {
        // Positions are not needed for anything: the file may have its vertices in another form.
        let spans = &mut body.vertices;
        return pass_over(rows, element, |_, span| spans.push(span));
    };
    if let Some((start, positions)) = rows.positions(element, [x, y, z]) {
        let length = (rows.at() - start) / element.count.max(1);
        let pushed = body.vertices.push_even(start, length, element.count);
        pushed.map_err(|kind| Fault { at: start, kind })?;
        body.positions = positions;
        return Ok(());
    }
    let axis_of = |number: usize| [x, y, z].iter().position(|&axis| axis == number);
    let axes: Vec<Option<usize>> = (0..element.properties.len()).map(axis_of).collect();
    body.positions.reserve(rows.at_most(element));
    for number in 0..element.count {
        let row = Row { element, number };
        let mut position = [0.0; 3];
        let start = rows.start_row();
        for (property, axis) in element.properties.iter().zip(&axes) {
            match (property.kind, axis) {
                (Kind::Scalar(scalar), &Some(axis)) => position[axis] = rows.float(scalar, &row)?,
                (Kind::Scalar(scalar), None) => rows.skip(1, scalar, &row)?,
                (Kind::List { count, item }, _) => {
                    let count = list_length(rows, count, &row)?;
                    rows.skip(count, item, &row)?;
                }
            }
        }
        let end = rows.end_row(&row)?;
        body.positions.push(position);
        let pushed = body.vertices.push(start..end);
        pushed.map_err(|kind| Fault { at: start, kind })?;
    }
    Ok(())
}

fn read_faces<R: Rows>(
    rows: &mut R,
    element: &Element,
    header: &Header,
    limits: &Limits,
    body: &mut Body,
) -> Result<(), Fault> {
    let Some(list) = element.corner_list() else {
        // `header::read` has refused faces without corners, unless there are no faces.
        return Ok(());
    };
    let vertex_count = header.vertex_count();
    let layout = TriangleLayout::of(element, list);
    let mut corners = Vec::new();
    body.records.reserve(rows.at_most(element), rows.left());
    let mut number = 0;
    while number < element.count {
        let start = rows.start_row();
        if let Some(layout) = &layout {
            let faces = &mut body.records.faces;
            let first = faces.len();
            let (read, length) = rows.triangles(layout, element.count - number, faces);
            let bad = |face: &[u32; 3]| face.iter().position(|&v| v as usize >= vertex_count);
            let bad = faces[first..]
                .iter()
                .enumerate()
                .find_map(|(i, f)| Some((i, bad(f)?)));
            if let Some((face, corner)) = bad {
                let index = i64::from(faces[first + face][corner]);
                let last = vertex_count.checked_sub(1);
                let kind = past_the_last_vertex("face", number + face, corner, index, last);
                let at = start + face * length;
                return Err(Fault { at, kind });
            }
            let pushed = body.records.count_triangles(limits);
            let pushed = pushed.and_then(|()| body.faces.push_even(start, length, read));
            pushed.map_err(|kind| Fault { at: start, kind })?;
            number += read;
            if read > 0 {
                continue;
            }
        }
        let row = Row { element, number };
        corners.clear();
        for (property_number, property) in element.properties.iter().enumerate() {
            match property.kind {
                Kind::Scalar(scalar) => rows.skip(1, scalar, &row)?,
                Kind::List { count, item } => {
                    let count = list_length(rows, count, &row)?;
                    if property_number != list {
                        rows.skip(count, item, &row)?;
                        continue;
                    }
                    for corner in 0..count {
                        let at = rows.at();
                        let index = rows.whole(item, &row)?;
                        let vertex = u32::try_from(index).ok();
                        let vertex = vertex.filter(|&vertex| (vertex as usize) < vertex_count);
                        corners.push(vertex.ok_or_else(|| {
                            let last = vertex_count.checked_sub(1);
                            let kind = past_the_last_vertex("face", number, corner, index, last);
                            Fault { at, kind }
                        })?);
                    }
                }
            }
        }
        let end = rows.end_row(&row)?;
        let pushed = body.records.push(&corners, limits);
        let pushed = pushed.and_then(|()| body.faces.push(start..end));
        pushed.map_err(|kind| Fault { at: start, kind })?;
        number += 1;
    }
    Ok(())
}
