//! What is known of a VRML97 file while its nodes are read.

use std::collections::HashMap;
use std::ops::Range;

use super::lexer::Lexer;
use super::scene::{FaceSet, List, Role, Scene};

/// What is open.
pub(super) struct Frame {
    pub(super) at: usize,
    pub(super) close: u8,
    /// The name of the nearest node with one.
    pub(super) name: Option<Range<usize>>,
    /// The name of the node itself.
    pub(super) own_name: Option<Range<usize>>,
    pub(super) kind: FrameKind,
}

/// What is open, as far as it matters here.
pub(super) enum FrameKind {
    Other,
    Script,
    /// The interface of a `PROTO`; its body follows.
    Interface,
    Body,
    FaceSet(Box<FaceSet>, Option<Role>),
    Material,
    Shape(ShapeNode),
    Points(Points),
}

/// A node with a list that is looked at; on a face set unless it is a `Coordinate` elsewhere.
pub(super) struct Points {
    pub(super) role: Role,
    pub(super) on_face_set: bool,
    pub(super) own_name: Option<Range<usize>>,
    pub(super) list: Option<List>,
    /// There is something else in it.
    pub(super) is_odd: bool,
}

/// A `Shape`: how faces look, and which.
#[derive(Default)]
pub(super) struct ShapeNode {
    /// How many face sets there were before it.
    pub(super) first_set: usize,
    /// The names after `USE` in it.
    pub(super) used: Vec<Range<usize>>,
    pub(super) is_transparent: bool,
}

/// A file while its nodes are read.
pub(super) struct VrmlReader<'a> {
    pub(super) text: &'a [u8],
    pub(super) lexer: Lexer<'a>,
    pub(super) scene: Scene<'a>,
    /// Most brackets inside each other.
    pub(super) nesting: usize,
    pub(super) frames: Vec<Frame>,
    /// The coordinates by name, and names of other nodes; a `PROTO` has names of its own.
    pub(super) scopes: Vec<HashMap<&'a [u8], Option<usize>>>,
    /// The name of the node that comes next.
    pub(super) name: Option<Range<usize>>,
    /// The word just read.
    pub(super) word: Option<Range<usize>>,
    pub(super) protos: usize,
}

impl<'a> VrmlReader<'a> {
    /// The face set whose fields are being read, and the field that waits for its node.
    pub(super) fn face_set(&mut self) -> Option<(&mut FaceSet, &mut Option<Role>)> {
        match &mut self.frames.last_mut()?.kind {
            FrameKind::FaceSet(set, role) => Some((set, role)),
            _ => None,
        }
    }

    /// The `Shape` that is open, if one is.
    pub(super) fn shape(&mut self) -> Option<&mut ShapeNode> {
        let mut frames = self.frames.iter_mut().rev();
        frames.find_map(|frame| match &mut frame.kind {
            FrameKind::Shape(shape) => Some(shape),
            _ => None,
        })
    }

    /// Notes that the material that is open is transparent: so is the `Shape` around it, and what is
    /// drawn with a `USE` of it, or with the `PROTO` that it stands in.
    pub(super) fn transparent(&mut self) {
        for frame in self.frames.iter_mut().rev() {
            if let Some(name) = frame.own_name.clone() {
                self.scene.transparent.insert(&self.text[name]);
            }
            if let FrameKind::Shape(shape) = &mut frame.kind {
                shape.is_transparent = true;
                break;
            }
        }
    }

    /// Notes a `USE` of this name in the `Shape` that is open.
    pub(super) fn used_in_shape(&mut self, name: Range<usize>) {
        if self.scene.transparent.contains(&self.text[name.clone()]) {
            self.transparent();
        }
        if let Some(shape) = self.shape() {
            shape.used.push(name);
        }
    }

    /// Says of the face sets of a `Shape` whether they are transparent.
    pub(super) fn close_shape(&mut self, shape: ShapeNode) {
        if !shape.is_transparent {
            return;
        }
        for set in &mut self.scene.face_sets[shape.first_set..] {
            set.is_transparent = true;
        }
        let used = shape.used.into_iter().map(|name| &self.text[name]);
        let used: Vec<&'a [u8]> = used.collect();
        self.scene.used_transparent.extend(used);
    }
}
