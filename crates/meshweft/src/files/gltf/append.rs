//! Meshes and values added to a file that was read: bytes at the end of a buffer, text at the ends of
//! arrays and objects. Then the whole is looked at again.

use super::additions::{Additions, Splice, spliced};
use super::base64;
use super::buffers::{Buffers, OUTSIDE_OF_GLB, Source};
use super::container::{BinaryLength, Container};
use super::json::Value;
use super::new_meshes::{NewMeshes, SharedVertices};
use super::object::Object;
use super::{GltfFile, View};
use crate::files::edit::NewValue;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::new_mesh::{NewMesh, NewVertices};
use crate::files::note::Note;

impl GltfFile {
    /// See [`Edit::Append`](crate::files::Edit::Append); on an error nothing is changed.
    pub(super) fn append(
        &mut self,
        meshes: &[NewMesh<'_>],
        values: &[NewValue<'_>],
    ) -> Result<Vec<Note>, Problem> {
        // What is to be added.
        let json = super::read_json(&self.container, &self.options.limits)?;
        let root = Object::new(json.root(), String::new())?;
        let growth = Growth::new(&root, &self.container, &self.buffers);
        check_shared(meshes, self.view.entries.meshes.len())?;
        let mut new = NewMeshes::new(&root, growth.buffer, growth.start)?;
        for mesh in meshes {
            let shared = |number: usize| SharedVertices {
                primitive: self.view.entries.first_primitives[number],
                count: self.view.entries.meshes[number].mesh.vertex_count(),
            };
            let added = new.add(mesh, shared);
            added.map_err(|kind| kind.at(Place::File))?;
        }
        let (bytes, mut additions) = new.finish();
        for value in values {
            additions.written(value.pointer, value.json)?;
        }

        // The text, and the file around it.
        let new_length = growth.start + bytes.len();
        let grows = !bytes.is_empty();
        let mut splices = Vec::new();
        if grows {
            splices.extend(growth.declare(&root, &bytes, &mut additions));
        }
        splices.extend(additions.splices(&root)?);
        splices.sort_by_key(|(span, _)| span.start);
        let text = spliced(self.json(), &splices);
        let binary = growth.binary_length(new_length).filter(|_| grows);
        let container = self.container.with_json(&text, binary)?;

        // The bytes, and what a reader then sees.
        let was_changed = growth.is_changed(&self.buffers);
        if grows {
            growth.add(&mut self.buffers, &bytes);
        }
        match self.look_at(&container) {
            Ok((view, notes)) => {
                (self.container, self.view) = (container, view);
                Ok(notes)
            }
            Err(problem) => {
                if grows {
                    growth.take_back(&mut self.buffers, was_changed);
                }
                Err(problem)
            }
        }
    }

    fn look_at(&self, container: &Container) -> Result<(View, Vec<Note>), Problem> {
        let json = super::read_json(container, &self.options.limits)?;
        let root = Object::new(json.root(), String::new())?;
        super::check_version(&root)?;
        super::look(&root, &self.buffers, &self.options)
    }
}

/// Whether all meshes whose vertices are shared are there.
fn check_shared(meshes: &[NewMesh<'_>], count: usize) -> Result<(), Problem> {
    for mesh in meshes {
        if let NewVertices::Shared(number) = mesh.vertices
            && number >= count
        {
            let text = format!(
                "the vertices of mesh {number} cannot be shared: there are {count} meshes before the new \
                 ones"
            );
            return Err(FileErrorKind::unsupported(text).at(Place::File));
        }
    }
    Ok(())
}

/// Where new bytes go.
struct Growth {
    buffer: usize,
    storage: GrowingStorage,
    /// How many bytes are there, and where the new ones start.
    old_length: usize,
    start: usize,
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
    fn new(root: &Object, container: &Container, buffers: &Buffers) -> Self {
        let declared: Vec<Value<'_>> = elements(root).collect();
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
                let buffer = elements(root).nth(self.buffer)?;
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

    fn is_changed(&self, buffers: &Buffers) -> bool {
        match self.storage {
            GrowingStorage::Named(storage) | GrowingStorage::Unnamed(storage) => {
                buffers.storages[storage].is_changed
            }
            GrowingStorage::New(_) => false,
        }
    }

    fn add(&self, buffers: &mut Buffers, new: &[u8]) {
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
    fn take_back(&self, buffers: &mut Buffers, was_changed: bool) {
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

fn elements<'a>(root: &Object<'a>) -> impl Iterator<Item = Value<'a>> {
    root.value("buffers").into_iter().flat_map(Value::elements)
}
