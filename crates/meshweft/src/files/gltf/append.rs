//! Meshes and values added to a file that was read: bytes at the end of a buffer, text at the ends of
//! arrays and objects. Then the whole is looked at again.

use super::additions::Additions;
use super::container::Container;
use super::growth::Growth;
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
        for (number, mesh) in meshes.iter().enumerate() {
            let shared = |number: usize| SharedVertices {
                primitive: self.view.entries.first_primitives[number],
                count: self.view.entries.meshes[number].mesh.vertex_count(),
            };
            let added = new.add(mesh, shared);
            added.map_err(|kind| kind.at(mesh.place(number)))?;
        }
        let (bytes, mut additions) = new.finish();
        for value in values {
            additions.written(value.pointer, value.json)?;
        }
        self.grow(growth, bytes, additions)
    }

    /// Adds bytes and values, and looks at the whole again; on an error nothing is changed.
    pub(super) fn grow(
        &mut self,
        growth: Growth,
        bytes: Vec<u8>,
        additions: Additions,
    ) -> Result<Vec<Note>, Problem> {
        // The text, and the file around it.
        let json = super::read_json(&self.container, &self.options.limits)?;
        let root = Object::new(json.root(), String::new())?;
        let grows = !bytes.is_empty();
        let container = growth.container(&self.container, &root, &bytes, additions, Vec::new())?;

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

    /// What is seen of the file with another text.
    pub(super) fn look_at(&self, container: &Container) -> Result<(View, Vec<Note>), Problem> {
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
