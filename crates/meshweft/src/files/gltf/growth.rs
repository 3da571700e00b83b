//! The buffer that new bytes go to, and the text that says so.

use super::additions::{Additions, Splice, spliced};
use super::base64;
use super::buffers::{Buffers, OUTSIDE_OF_GLB, Source};
use super::container::{BinaryLength, Container};
use super::json::Value;
use super::object::Object;
use crate::files::error::Problem;

/// Where new bytes go.
pub(super) struct Growth {
    pub(super) buffer: usize,
    storage: GrowingStorage,
    /// How many bytes are there, and where the new ones start.
    old_length: usize,
    pub(super) start: usize,
    is_binary: bool,
    /// Why a new buffer may not change.
    fixed: Option<&'static str>,
}

enum GrowingStorage {
    /// One that is there, of a buffer that is there.
    Named(usize),
    /// One that is there, but no buffer stands for it.
    Unnamed(usize),
    New(Source),
}

impl Growth {
    /// The binary chunk of a GLB, made if there are no buffers yet; of a text, the last buffer that may
    /// change; else a new buffer in the text.
    pub(super) fn new(root: &Object, container: &Container, buffers: &Buffers) -> Self {
        let declared: Vec<Value<'_>> = root.elements("buffers").collect();
        let length = |storage: usize| buffers.storages[storage].bytes.len();
        let is_whole = |buffer: usize, storage: usize| {
            let promised = declared.get(buffer).and_then(|b| b.get("byteLength"));
            promised
                .and_then(Value::whole)
                .is_some_and(|promised| promised <= length(storage))
        };
        let at = |buffer: usize, storage: GrowingStorage, is_binary: bool| {
            let old_length = match storage {
                GrowingStorage::Named(storage) | GrowingStorage::Unnamed(storage) => {
                    length(storage)
                }
                GrowingStorage::New(_) => 0,
            };
            Self {
                buffer,
                storage,
                old_length,
                // Everything starts at a whole word.
                start: old_length.next_multiple_of(4),
                is_binary,
                fixed: (container.is_glb() && !is_binary).then_some(OUTSIDE_OF_GLB),
            }
        };

        // The binary chunk.
        let mut storages = buffers.storages.iter();
        let chunk = storages.position(|storage| storage.source == Source::Binary);
        let of_chunk = chunk.and_then(|chunk| buffers.buffers_over(chunk).next());
        match (chunk, of_chunk) {
            (Some(chunk), Some(buffer)) if is_whole(buffer, chunk) => {
                return at(buffer, GrowingStorage::Named(chunk), true);
            }
            (Some(chunk), None) if declared.is_empty() => {
                return at(0, GrowingStorage::Unnamed(chunk), true);
            }
            (None, _) if container.is_glb() && declared.is_empty() => {
                return at(0, GrowingStorage::New(Source::Binary), true);
            }
            _ => {}
        }

        // Another buffer.
        let may_grow = |&buffer: &usize| {
            buffers.find(buffer).is_some_and(|storage| {
                let is_free = buffers.storages[storage].fixed.is_none();
                is_free && Some(storage) != chunk && is_whole(buffer, storage)
            })
        };
        let grown = (0..declared.len()).rev().find(may_grow);
        if let Some((buffer, storage)) = grown.and_then(|b| Some((b, buffers.find(b)?))) {
            return at(buffer, GrowingStorage::Named(storage), false);
        }
        let source = Source::Data {
            buffer: declared.len(),
            prefix: "data:application/octet-stream;base64,".into(),
        };
        at(declared.len(), GrowingStorage::New(source), false)
    }

    /// The new length in the JSON: the number replaced, or a buffer added.
    fn declare(&self, root: &Object, new: &[u8], additions: &mut Additions) -> Option<Splice> {
        let length = self.start + new.len();
        match &self.storage {
            GrowingStorage::Named(_) => {
                let buffer = root.elements("buffers").nth(self.buffer)?;
                Some((buffer.get("byteLength")?.span(), length.to_string()))
            }
            GrowingStorage::New(Source::Data { prefix, .. }) => {
                let data = base64::encode(new);
                let json = format!(r#"{{"uri":"{prefix}{data}","byteLength":{length}}}"#);
                additions.element("buffers", json);
                None
            }
            GrowingStorage::Unnamed(_) | GrowingStorage::New(_) => {
                additions.element("buffers", format!(r#"{{"byteLength":{length}}}"#));
                None
            }
        }
    }

    /// The lengths of a binary chunk that grows.
    fn binary_length(&self, new: usize) -> Option<BinaryLength> {
        let old = match self.storage {
            GrowingStorage::New(_) => None,
            _ => Some(self.old_length),
        };
        self.is_binary.then_some(BinaryLength { old, new })
    }

    /// The file with these values and new bytes, and with other parts of its text replaced; the bytes
    /// themselves go to the buffers by [`add`](Self::add).
    ///
    /// # Errors
    /// There is no place for a value, or a GLB would be longer than its header can say.
    pub(super) fn container(
        &self,
        old: &Container,
        root: &Object,
        bytes: &[u8],
        mut additions: Additions,
        mut splices: Vec<Splice>,
    ) -> Result<Container, Problem> {
        let grows = !bytes.is_empty();
        if grows {
            splices.extend(self.declare(root, bytes, &mut additions));
        }
        splices.extend(additions.splices(root)?);
        splices.sort_by_key(|(span, _)| span.start);

        let text = spliced(&old.head[old.json.clone()], &splices);
        let length = self.start + bytes.len();
        let binary = self.binary_length(length).filter(|_| grows);
        old.with_json(&text, binary)
    }

    pub(super) fn is_changed(&self, buffers: &Buffers) -> bool {
        match self.storage {
            GrowingStorage::Named(storage) | GrowingStorage::Unnamed(storage) => {
                buffers.storages[storage].is_changed
            }
            GrowingStorage::New(_) => false,
        }
    }

    pub(super) fn add(&self, buffers: &mut Buffers, new: &[u8]) {
        let storage = match &self.storage {
            GrowingStorage::Named(storage) => *storage,
            GrowingStorage::Unnamed(storage) => {
                buffers.name(self.buffer, *storage);
                *storage
            }
            GrowingStorage::New(source) => {
                let storage = buffers.store(source.clone(), Vec::new());
                buffers.name(self.buffer, storage);
                buffers.storages[storage].fixed = self.fixed;
                storage
            }
        };
        let storage = &mut buffers.storages[storage];
        // A new buffer in the text has its data there already.
        let is_declared = matches!(self.storage, GrowingStorage::New(Source::Data { .. }));
        storage.is_changed |= !is_declared;
        storage.bytes.resize(self.start, 0);
        storage.bytes.extend_from_slice(new);
    }

    /// Undoes [`add`](Self::add).
    pub(super) fn take_back(&self, buffers: &mut Buffers, was_changed: bool) {
        if !matches!(self.storage, GrowingStorage::Named(_)) {
            buffers.forget_name(self.buffer);
        }
        match self.storage {
            GrowingStorage::Named(storage) | GrowingStorage::Unnamed(storage) => {
                let storage = &mut buffers.storages[storage];
                storage.is_changed = was_changed;
                storage.bytes.truncate(self.old_length);
            }
            GrowingStorage::New(_) => drop(buffers.storages.pop()),
        }
    }
}
