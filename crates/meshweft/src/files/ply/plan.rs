//! What of a PLY file may move, decided from its header alone.

use super::header::{COMPANION, Element, PlyHeader, PropertyKind};
use crate::files::error::{Place, Problem};
use crate::files::note::Note;
use crate::files::options::ReadOptions;

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

/// What may move, decided from the header alone.
pub(super) struct Plan {
    /// Why the vertices stay.
    pub(super) vertex_obstacle: Option<Note>,
    /// Why the faces stay.
    pub(super) face_obstacle: Option<Note>,
    pub(super) corners_turnable: bool,
}

impl Plan {
    pub(super) fn new(header: &PlyHeader, options: &ReadOptions) -> Result<Self, Problem> {
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
                COMPANION if face.is_some_and(|face| face.count == element.count) => {
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
            if matches!(property.kind, PropertyKind::List { item, .. } if !item.is_float()) {
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
                PropertyKind::Scalar(_) => self.corners_turnable &= OF_A_WHOLE_FACE.contains(&name),
                PropertyKind::List { item, .. } => {
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
        if let Some(PropertyKind::List { item, .. }) = list
            && vertex_count as u64 > item.largest().saturating_add(1)
        {
            let why = format!(
                "their indices are stored in {} bytes, which cannot name all {vertex_count}",
                item.size()
            );
            let note = || Note::vertices_stay(Place::Line(element.line), why);
            self.vertex_obstacle.get_or_insert_with(note);
        }
    }

    fn keep_vertices(&mut self, element: &Element, what: &str) {
        self.vertex_obstacle.get_or_insert_with(|| {
            let why = format!("{what} may name them by number");
            Note::vertices_stay(Place::Line(element.line), why)
        });
    }

    fn keep_faces(&mut self, element: &Element, what: &str) {
        self.face_obstacle.get_or_insert_with(|| {
            let text = format!("the faces stay where they are: {what} may go by their order");
            Note::new(Place::Line(element.line), text)
        });
    }
}
