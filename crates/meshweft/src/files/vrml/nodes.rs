//! Finds the face sets of a VRML97 file.
//!
//! The file is read as nested nodes without knowing what most of them mean: a word in front of a
//! `{` is the type of a node. Only the fields of a face set, and the lists in the nodes that hang
//! on it, are looked at.

use std::collections::HashMap;
use std::ops::Range;

use super::lexer::{Lexer, Token};
use super::reader::{Frame, FrameKind, Points, ShapeNode, VrmlReader};
use super::scene::{Child, FaceSet, List, Role, Scene};
use crate::files::error::{Fault, FileErrorKind};
use crate::files::text::{coordinate, shown};
use crate::limits::Limits;

/// Reads the nodes of `text` from `at` on.
///
/// Time O(bytes).
pub(super) fn read<'a>(text: &'a [u8], at: usize, limits: &Limits) -> Result<Scene<'a>, Fault> {
    let mut reader = VrmlReader {
        text,
        nesting: limits.nesting,
        lexer: Lexer::new(text, at),
        scene: Scene::default(),
        frames: Vec::new(),
        scopes: vec![HashMap::new()],
        name: None,
        word: None,
        protos: 0,
    };
    while let Some(token) = reader.lexer.token()? {
        reader.token(token)?;
    }
    if let Some(frame) = reader.frames.last() {
        let what = match frame.close {
            b'}' => "a node: there is no }",
            _ => "a list: there is no ]",
        };
        let kind = FileErrorKind::truncated(format!("{what} for what is opened here"));
        return Err(Fault { at: frame.at, kind });
    }
    Ok(reader.scene)
}

impl<'a> VrmlReader<'a> {
    fn token(&mut self, token: Token) -> Result<(), Fault> {
        let word = self.word.take();
        match token {
            Token::Word(span) => {
                // What a PROTO is given may be transparent.
                let field = word.map(|word| &self.text[word]);
                let is_look = matches!(field, Some(b"appearance" | b"material"));
                if is_look && &self.text[span.clone()] == b"IS" {
                    self.transparent();
                }
                self.keyword(span)
            }
            Token::Text(_) => {
                self.odd("a string");
                Ok(())
            }
            Token::Mark(b'{', at) => {
                let node = word.ok_or_else(|| {
                    Fault::malformed(at, "a { without the type of a node in front of it")
                })?;
                self.open_node(node)
            }
            Token::Mark(b'[', at) => {
                self.odd("a list");
                self.open(at, b']', None, FrameKind::Other)
            }
            Token::Mark(mark, at) => self.close(mark, at),
        }
    }

    fn keyword(&mut self, span: Range<usize>) -> Result<(), Fault> {
        match &self.text[span.clone()] {
            b"DEF" => {
                let name = self.name_after("DEF")?;
                if let Some(scope) = self.scopes.last_mut()
                    && let Some(coordinates) = scope.get_mut(&self.text[name.clone()])
                {
                    *coordinates = None;
                }
                self.name = Some(name);
            }
            b"USE" => {
                let name = self.name_after("USE")?;
                self.used_in_shape(name.clone());
                let name = &self.text[name];
                self.scene.used.insert(name);
                let scope = self.scopes.last();
                let coordinates = scope.and_then(|scope| scope.get(name).copied().flatten());
                self.child(Child::Used(coordinates));
            }
            b"NULL" => self.child(Child::None),
            b"IS" => {
                self.name_after("IS")?;
                self.odd("IS");
            }
            b"ROUTE" => self.route(span.start)?,
            b"PROTO" => {
                self.odd("PROTO");
                let name = self.name_after("PROTO")?;
                match self.lexer.token()? {
                    Some(Token::Mark(b'[', at)) => {
                        self.open(at, b']', None, FrameKind::Interface)?;
                        self.own(Some(name));
                    }
                    _ => {
                        let text = "a PROTO without the [ of its interface";
                        return Err(Fault::malformed(span.start, text));
                    }
                }
            }
            _ => return self.word(span),
        }
        Ok(())
    }

    /// A word that means the same only in some nodes.
    fn word(&mut self, span: Range<usize>) -> Result<(), Fault> {
        let word = &self.text[span.clone()];
        let Some(frame) = self.frames.last_mut() else {
            self.word = Some(span);
            return Ok(());
        };

        match &mut frame.kind {
            FrameKind::Script if matches!(word, b"SFNode" | b"MFNode") => {
                self.scene.script_reads_nodes = true;
            }
            FrameKind::Points(points) => {
                let role = points.role;
                if word == role.names()[2].as_bytes() {
                    let found = self.list(span)?;
                    if let Some(Frame {
                        kind: FrameKind::Points(points),
                        ..
                    }) = self.frames.last_mut()
                    {
                        points.is_odd |= found.is_none() || points.list.is_some();
                        points.list = found;
                    }
                    return Ok(());
                }
                self.odd("another field");
            }
            FrameKind::FaceSet(..) => return self.face_set_word(span),
            FrameKind::Material if word == b"transparency" => {
                // One of a PROTO may be anything.
                let list = self.list(span)?;
                let value = list.and_then(|list| coordinate(&self.text[list.content]));
                if value.is_none_or(|value| value > 0.0) {
                    self.transparent();
                }
                return Ok(());
            }
            _ => {}
        }
        self.word = Some(span);
        Ok(())
    }

    /// Gives the face set its node, if it waits for one.
    fn child(&mut self, child: Child) {
        self.name = None;
        if let Some((set, role)) = self.face_set() {
            match role.take() {
                Some(role) => set.hang(role, child),
                None => set.obstacle("it holds a node in no field that is known"),
            }
        } else {
            self.odd("a node");
        }
    }

    /// Notes that the face set, or a node that hangs on it, holds what is not understood.
    fn odd(&mut self, what: &str) {
        match self.frames.last_mut().map(|frame| &mut frame.kind) {
            Some(FrameKind::FaceSet(set, _)) => set.obstacle(format!("it contains {what}")),
            Some(FrameKind::Points(points)) => points.is_odd = true,
            _ => {}
        }
    }

    fn open_node(&mut self, node: Range<usize>) -> Result<(), Fault> {
        let own_name = self.name.take();
        let around = self.frames.last().and_then(|frame| frame.name.clone());
        let name = own_name.clone().or(around);
        let at = node.start;
        let kind = &self.text[node.clone()];

        let waiting = self.face_set().map(|(_, role)| role.take());
        let points = |role, on_face_set, own_name| {
            FrameKind::Points(Points {
                role,
                on_face_set,
                own_name,
                list: None,
                is_odd: false,
            })
        };

        if waiting.is_none() {
            self.odd("a node");
        }

        let kind = match (waiting, kind) {
            (Some(Some(role)), kind) if kind == role.names()[1].as_bytes() => {
                points(role, true, own_name.clone())
            }
            (Some(_), other) => {
                self.odd(&format!("a node of type {}", shown(other)));
                FrameKind::Other
            }
            (None, b"IndexedFaceSet") => {
                let set = FaceSet {
                    span: at..at,
                    own_name: own_name.clone(),
                    name: name.clone(),
                    in_proto: self.protos > 0,
                    ..FaceSet::default()
                };
                FrameKind::FaceSet(Box::new(set), None)
            }
            (None, b"Coordinate") => points(Role::Coord, false, own_name.clone()),
            (None, b"Script") => FrameKind::Script,
            (None, b"Material") => FrameKind::Material,
            (None, b"Shape") => FrameKind::Shape(ShapeNode {
                first_set: self.scene.face_sets.len(),
                ..ShapeNode::default()
            }),
            (None, _) => FrameKind::Other,
        };
        self.open(at, b'}', name, kind)?;
        self.own(own_name);
        // A PROTO with a transparent material in it.
        if self.scene.transparent.contains(&self.text[node]) {
            self.transparent();
        }
        Ok(())
    }

    /// Gives the node that was just opened its name.
    fn own(&mut self, name: Option<Range<usize>>) {
        if let Some(frame) = self.frames.last_mut() {
            frame.own_name = name;
        }
    }

    fn open(
        &mut self,
        at: usize,
        close: u8,
        name: Option<Range<usize>>,
        kind: FrameKind,
    ) -> Result<(), Fault> {
        if self.frames.len() >= self.nesting {
            let kind = FileErrorKind::OverLimit {
                what: "nodes and lists inside each other",
                found: self.frames.len() as u64 + 1,
                limit: self.nesting as u64,
            };
            return Err(Fault { at, kind });
        }
        // A list within a node does not hide the name of the node.
        let name = name.or_else(|| self.frames.last().and_then(|frame| frame.name.clone()));
        self.frames.push(Frame {
            at,
            close,
            name,
            own_name: None,
            kind,
        });
        Ok(())
    }

    fn close(&mut self, mark: u8, at: usize) -> Result<(), Fault> {
        let frame = self.frames.pop().filter(|frame| frame.close == mark);
        let Some(frame) = frame else {
            let text = format!("a {} that closes nothing", char::from(mark));
            return Err(Fault::malformed(at, text));
        };

        match frame.kind {
            FrameKind::Interface => match self.lexer.token()? {
                Some(Token::Mark(b'{', at)) => {
                    self.protos += 1;
                    self.scopes.push(HashMap::new());
                    self.open(at, b'}', None, FrameKind::Body)?;
                    self.own(frame.own_name);
                }
                _ => return Err(Fault::malformed(at, "a PROTO without the { of its body")),
            },
            FrameKind::Body => {
                self.protos -= 1;
                self.scopes.pop();
            }
            FrameKind::FaceSet(mut set, _) => {
                set.span.end = at + 1;
                self.close_face_set(set);
            }
            FrameKind::Points(points) => self.close_points(points),
            FrameKind::Shape(shape) => self.close_shape(shape),
            FrameKind::Other | FrameKind::Script | FrameKind::Material => {}
        }
        Ok(())
    }

    /// Keeps a face set that has faces, or the reason why it cannot be ordered.
    fn close_face_set(&mut self, mut set: Box<FaceSet>) {
        let corners = &set.indices[Role::Coord as usize];
        let has_faces = corners.as_ref().is_some_and(|list| list.count > 0);
        match set.obstacle.take() {
            Some(why) => self.scene.refused.push((set.span.start, why)),
            None if has_faces => self.scene.face_sets.push(*set),
            None => {}
        }
    }

    /// Hangs a list on its face set, and keeps it by name if a `USE` may ask for it.
    fn close_points(&mut self, points: Points) {
        let list = points.list.unwrap_or(List::EMPTY);
        if points.role == Role::Coord
            && let Some(name) = &points.own_name
            && let Some(scope) = self.scopes.last_mut()
            && !points.is_odd
        {
            scope.insert(&self.text[name.clone()], Some(self.scene.coordinates.len()));
            self.scene.coordinates.push(list.clone());
        }
        if let Some((set, _)) = self.face_set().filter(|_| points.on_face_set) {
            if points.is_odd {
                let field = points.role.field();
                set.obstacle(format!("its {field} holds more than a list of numbers"));
            }
            set.hang(points.role, Child::Own(points.own_name, list));
        }
    }
}
