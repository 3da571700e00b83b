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

impl VrmlReader<'_> {
    /// The face set whose fields are being read, and the field that waits for its node.
    pub(super) fn face_set(&mut self) -> Option<(&mut FaceSet, &mut Option<Role>)> {
        match &mut self.frames.last_mut()?.kind {
            FrameKind::FaceSet(set, role) => Some((set, role)),
            _ => None,
        }
    }
}
