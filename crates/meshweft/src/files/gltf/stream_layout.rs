//! Buffers laid out for a client that reads a file from its start: buffer views change places, and in the text only
//! the numbers that say where they stand follow. Then the whole is looked at again.

use std::collections::BTreeMap;

use super::GltfFile;
use super::accessors::Accessors;
use super::additions::{Additions, Splice, spliced};
use super::buffers::Source;
use super::container::BinaryLength;
use super::drawn_levels::DrawnLevels;
use super::object::Object;
use super::stream_order::stream_classes;
use super::stream_pieces::{LaidOut, Moved, pieces};
use super::unknown_names::check_names;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::note::Note;

/// What another layout changes.
struct NewLayout {
    text: Vec<u8>,
    storages: BTreeMap<usize, Vec<u8>>,
    /// The length of the binary chunk, if that is among them.
    binary: Option<BinaryLength>,
}

impl GltfFile {
    /// See [`Edit::StreamLayout`](crate::files::Edit::StreamLayout); on an error nothing is changed. `None` if every
    /// buffer is laid out like that.
    pub(super) fn stream_layout(&mut self) -> Result<Option<Vec<Note>>, Problem> {
        let Some(layout) = self.new_layout()? else {
            return Ok(None);
        };
        let container = self.container.with_json(&layout.text, layout.binary)?;
        let old = self.exchange(layout.storages);
        let looked = self.look_at(&container).and_then(|(view, notes)| {
            match view.entries.meshes == self.view.entries.meshes {
                true => Ok((view, notes)),
                false => {
                    let text = "it cannot be laid out for streaming: other meshes would be read";
                    Err(FileErrorKind::unsupported(text).at(Place::File))
                }
            }
        });
        match looked {
            Ok((view, notes)) => {
                (self.container, self.view) = (container, view);
                Ok(Some(notes))
            }
            Err(problem) => {
                self.take_back(old);
                Err(problem)
            }
        }
    }

    /// The new text and bytes; `None` if nothing moves.
    fn new_layout(&self) -> Result<Option<NewLayout>, Problem> {
        // The pieces of each storage in which some move.
        let json = super::read_json(&self.container, &self.options.limits)?;
        let root = Object::new(json.root(), String::new())?;
        let accessors = Accessors::new(&root, &self.buffers, &self.options.assume_order_safe)?;
        let classes = stream_classes(&root, &DrawnLevels::new(&root))?;
        let mut moving = pieces(&root, &accessors, &self.buffers, &classes)?;
        moving.retain(|_, pieces| !pieces.is_sorted_by_key(|piece| piece.class));
        if moving.is_empty() {
            return Ok(None);
        }

        // Whether they can.
        let moves = |buffer| {
            let storage = self.buffers.find(buffer);
            storage.is_some_and(|storage| moving.contains_key(&storage))
        };
        check_names(&root, &accessors, moves)?;

        // The bytes, and where each view then stands.
        let (mut additions, mut splices) = (Additions::default(), Vec::new());
        let mut storages = BTreeMap::new();
        let mut binary = None;
        for (storage, mut pieces) in moving {
            let buffer = self.buffer_of(&root, storage)?;
            let declared = buffer.required_number("byteLength")?;
            pieces.sort_by_key(|piece| piece.class);
            let old = &self.buffers.storages[storage];
            let LaidOut {
                bytes,
                declared: length,
                moved,
            } = LaidOut::new(&old.bytes, declared, &pieces);
            for moved in moved {
                place(moved, &mut additions, &mut splices);
            }
            if let Some(value) = buffer.value("byteLength").filter(|_| length != declared) {
                splices.push((value.span(), length.to_string()));
            }
            if old.source == Source::Binary {
                binary = Some(BinaryLength {
                    old: Some(old.bytes.len()),
                    new: bytes.len(),
                });
            }
            storages.insert(storage, bytes);
        }

        splices.extend(additions.splices(&root)?);
        splices.sort_by_key(|(span, _)| span.start);
        Ok(Some(NewLayout {
            text: spliced(self.json(), &splices),
            storages,
            binary,
        }))
    }

    /// The only buffer that stands for a storage.
    ///
    /// # Errors
    /// The bytes may not change, or there are several buffers.
    fn buffer_of<'a>(&self, root: &Object<'a>, storage: usize) -> Result<Object<'a>, Problem> {
        let mut over = self.buffers.buffers_over(storage);
        let (first, second) = (over.next().unwrap_or_default(), over.next());
        let why = match (self.buffers.storages[storage].fixed, second) {
            (None, Some(second)) => Some(format!(
                "buffer {second} has the same bytes. Name them once"
            )),
            (fixed, _) => fixed.map(str::to_owned),
        };
        let pointer = format!("/buffers/{first}");
        if let Some(why) = why {
            let text = format!("it cannot be laid out for streaming: {why}");
            return Err(FileErrorKind::unsupported(text).at(Place::Json(pointer)));
        }
        Object::new(root.array("buffers")?[first], pointer)
    }
}

/// Says in the text where a view stands now. One that stood at 0, and did not say so, gets a new member.
fn place(moved: Moved<'_>, additions: &mut Additions, splices: &mut Vec<Splice>) {
    let start = moved.start.to_string();
    if let Some(value) = moved.value.get("byteOffset") {
        splices.push((value.span(), start));
        return;
    }
    let number = moved.view.to_string();
    let source = moved.source.map(|name| ["extensions", name]);
    let path = ["bufferViews", &number].into_iter();
    let path = path.chain(source.into_iter().flatten());
    additions.value(path.chain(["byteOffset"]), start);
}
