//! Reading the elements of a PLY file: vertices, faces, and where their rows stand.

use std::ops::Range;

use super::header::{COMPANION, Element, PlyHeader, PropertyKind};
use super::plan::Plan;
use super::rows::{PlyRows, Row, TriangleLayout};
use crate::files::error::{Fault, FileErrorKind};
use crate::files::face_records::{FaceRecords, corner_vertex, past_the_last_vertex};
use crate::files::slots::Spans;
use crate::limits::Limits;

/// What was found after the header.
pub(super) struct Body {
    pub(super) vertices: Spans,
    pub(super) faces: Spans,
    pub(super) records: FaceRecords,
    /// Whether every face has texture coordinates for every corner.
    pub(super) has_texture: bool,
    /// The rows of elements that go where the faces go.
    pub(super) companions: Vec<Spans>,
}

/// Reads the rows of all elements.
pub(super) fn read<R: PlyRows>(
    mut rows: R,
    header: &PlyHeader,
    plan: &Plan,
    limits: &Limits,
) -> Result<Body, Fault> {
    let mut body = Body {
        vertices: Spans::new(),
        has_texture: false,
        faces: Spans::new(),
        records: FaceRecords::default(),
        companions: Vec::new(),
    };

    let face_count = header.element("face").map_or(0, |face| face.count);
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => read_vertices(&mut rows, element, &mut body)?,
            "face" => read_faces(&mut rows, element, header, limits, &mut body)?,
            COMPANION if element.count == face_count && plan.face_obstacle.is_none() => {
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
pub(super) fn pass_over<R: PlyRows>(
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
                PropertyKind::Scalar(scalar) => rows.skip(1, scalar, &row)?,
                PropertyKind::List { count, item } => {
                    let count = rows.list_length(count, &row)?;
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

fn read_vertices<R: PlyRows>(
    rows: &mut R,
    element: &Element,
    body: &mut Body,
) -> Result<(), Fault> {
    if element.properties.is_empty() {
        return Ok(());
    }
    if let Some((start, length)) = rows.pass_even(element) {
        let pushed = body.vertices.push_even(start, length, element.count);
        return pushed.map_err(|kind| Fault { at: start, kind });
    }

    // The file may have its vertices in another form than three coordinates.
    let axes = ["x", "y", "z"].map(|name| element.scalar(name));
    let has_positions = axes.iter().all(Option::is_some);
    let is_axis = |number| has_positions && axes.contains(&Some(number));
    let is_axis: Vec<bool> = (0..element.properties.len()).map(is_axis).collect();
    for number in 0..element.count {
        let row = Row { element, number };
        let start = rows.start_row();
        for (property, &is_axis) in element.properties.iter().zip(&is_axis) {
            match property.kind {
                PropertyKind::Scalar(scalar) if is_axis => rows.coordinate(scalar, &row)?,
                PropertyKind::Scalar(scalar) => rows.skip(1, scalar, &row)?,
                PropertyKind::List { count, item } => {
                    let count = rows.list_length(count, &row)?;
                    rows.skip(count, item, &row)?;
                }
            }
        }

        let end = rows.end_row(&row)?;
        let pushed = body.vertices.push(start..end);
        pushed.map_err(|kind| Fault { at: start, kind })?;
    }
    Ok(())
}

fn read_faces<R: PlyRows>(
    rows: &mut R,
    element: &Element,
    header: &PlyHeader,
    limits: &Limits,
    body: &mut Body,
) -> Result<(), Fault> {
    let Some(list) = element.corner_list() else {
        // `header::read` has refused faces without corners, unless there are no faces.
        return Ok(());
    };
    let vertex_count = header.vertex_count();
    let texture = element.texture_list();
    body.has_texture = texture.is_some();
    let layout = TriangleLayout::of(element, list);
    let mut corners = Vec::new();
    body.records.reserve(rows.at_most(element), rows.left());

    let mut number = 0;
    while number < element.count {
        let row = Row { element, number };
        let start = rows.start_row();
        if let Some(layout) = &layout {
            let read = read_triangles(rows, layout, &row, vertex_count, limits, body)?;
            number += read;
            if read > 0 {
                continue;
            }
        }

        let lists = [Some(list), texture];
        let numbers = read_corners(rows, lists, &row, vertex_count, &mut corners)?;
        body.has_texture &= corners.len() < 3 || numbers == corners.len() * 2;
        let end = rows.end_row(&row)?;
        let pushed = body.records.push(&corners, limits);
        let pushed = pushed.and_then(|()| body.faces.push(start..end));
        pushed.map_err(|kind| Fault { at: start, kind })?;
        number += 1;
    }
    Ok(())
}

/// Reads triangles of one layout from `row` on, which has been started, as long as there are any; how
/// many.
fn read_triangles<R: PlyRows>(
    rows: &mut R,
    layout: &TriangleLayout,
    row: &Row<'_>,
    vertex_count: usize,
    limits: &Limits,
    body: &mut Body,
) -> Result<usize, Fault> {
    let Row { element, number } = *row;
    let start = rows.at();
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
    Ok(read)
}

/// Reads a row; `corners` gets what the first of these lists holds. How many numbers are in the
/// second.
#[inline]
fn read_corners<R: PlyRows>(
    rows: &mut R,
    [list, texture]: [Option<usize>; 2],
    row: &Row<'_>,
    vertex_count: usize,
    corners: &mut Vec<u32>,
) -> Result<usize, Fault> {
    corners.clear();
    let mut numbers = 0;
    for (number, property) in row.element.properties.iter().enumerate() {
        match property.kind {
            PropertyKind::Scalar(scalar) => rows.skip(1, scalar, row)?,
            PropertyKind::List { count, item } => {
                let count = rows.list_length(count, row)?;
                if Some(number) != list {
                    if Some(number) == texture {
                        numbers = count;
                    }
                    rows.skip(count, item, row)?;
                    continue;
                }
                for corner in 0..count {
                    let at = rows.at();
                    let index = rows.whole(item, row)?;
                    let vertex = corner_vertex(index, vertex_count, row.number, corner);
                    corners.push(vertex.map_err(|kind| Fault { at, kind })?);
                }
            }
        }
    }
    Ok(numbers)
}
