//! A file in memory: its meshes as values, its bytes ready to be patched.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Mutex;

use super::content::Content;
use super::disk::{holds_gzip, is_gzip, read_as, read_start_as};
use super::edit::{Edit, check_order};
use super::entry::MeshEntry;
use super::error::{FileError, FileErrorKind, Place, Problem};
use super::format::Format;
use super::level_bytes::LevelBytes;
use super::links::Stamp;
use super::new_levels::VerticesOfLevels;
use super::new_mesh::NewMesh;
use super::note::Note;
use super::options::ReadOptions;
use super::select::SelectPlan;
use super::stored_culling::{PlacedTable, SeenSides, StoredCulling};
use super::surroundings::{Surroundings, check_size};
use super::unlisted::Unlisted;
use super::{gltf, obj, off, ply, signature, stl, vrml};
use crate::attribute::{Attribute, AttributeInfo};

/// A mesh file whose faces and vertices can be permuted in place.
///
/// ```no_run
/// use std::path::Path;
/// use meshweft::files::{Document, Edit};
/// use meshweft::{CacheModel, Limits, order::KCacheReorder};
///
/// let mut document = Document::open(Path::new("scene.glb"), Limits::default())?;
/// let algorithm = KCacheReorder { cache: CacheModel::fifo(12), ..Default::default() };
/// for mesh in 0..document.meshes().len() {
///     let order = document.meshes()[mesh].record_order(|mesh, polygons| match polygons {
///         Some(starts) => algorithm.polygon_order(mesh, starts),
///         None => algorithm.face_order(mesh),
///     });
///     document.edit(Edit::order(mesh, &order, None))?;
/// }
/// document.write(Path::new("ordered.glb"))?;
/// # Ok::<(), meshweft::files::FileError>(())
/// ```
#[derive(Debug)]
pub struct Document {
    pub(super) path: PathBuf,
    pub(super) format: Format,
    pub(super) content: Box<dyn Content>,
    notes: Vec<Note>,
    /// The folder of the disk that the files beside it came from.
    pub(super) folder: Option<PathBuf>,
    /// The size of the main file, as it was read.
    main_size: u64,
    /// Whether anything in it has changed.
    pub(super) is_edited: bool,
    /// Which file the main one was.
    pub(super) stamp: Option<Stamp>,
    /// The files that it has written itself.
    pub(super) own: Mutex<Vec<Stamp>>,
    /// Whether the main file was compressed where it was read.
    is_gzip: bool,
}

/// One entry a vertex, for all meshes that share them.
pub(crate) type SharedPositions = Rc<[[f32; 3]]>;

impl Document {
    /// Reads the file and everything it refers to that holds vertices or faces.
    ///
    /// Gzip data is decompressed first, whatever the name is. Where the bytes are surely of another format
    /// than the name says, or the name says none, they decide.
    ///
    /// # Errors
    /// [`FileError`]: the file cannot be read, is a pipe or a device, is of no known format, is not sound, or
    /// is over a limit.
    pub fn open(path: &Path, options: impl Into<ReadOptions>) -> Result<Self, FileError> {
        let options = options.into();
        let named = Format::of_path(path);
        let in_file = |kind: FileErrorKind| kind.at(Place::File).in_file(path, named);
        let no_access = |error| in_file(FileErrorKind::Io(error));
        let holds_gzip = holds_gzip(path).map_err(no_access)?;

        if is_gzip(path) && !holds_gzip {
            return Err(in_file(not_compressed()));
        }

        // Nothing large is read to find that it is not known.
        if named.is_none() {
            let start = read_start_as(path, holds_gzip, &options.limits, |_| signature::START);
            let length = match holds_gzip {
                true => u64::MAX,
                false => fs::metadata(path).map_err(no_access)?.len(),
            };
            let checked = start.and_then(|start| signature::check_start(&start, length));
            checked.map_err(in_file)?;
        }

        let stored = read_as(path, holds_gzip, &options.limits).map_err(in_file)?;
        let format = signature::format_of(named, &stored.bytes).map_err(in_file)?;

        let surroundings = Surroundings::Folder(folder_of(path));
        let mut document = Self::from_bytes_in(stored.bytes, format, path, surroundings, options)?;
        document.main_size = stored.size;
        document.stamp = stored.stamp;
        document.is_gzip = holds_gzip;
        Ok(document)
    }

    /// Reads a file that is in memory already and needs no other beside it.
    ///
    /// The name is for errors, and for the files that [`to_bytes`](Self::to_bytes) gives; nothing is
    /// looked for on a disk. The bytes are not compressed, whatever the name ends with.
    ///
    /// # Errors
    /// As [`open`](Self::open); one of kind [`FileErrorKind::Io`] if a mesh has its data in another
    /// file.
    pub fn from_bytes(
        bytes: Vec<u8>,
        format: Format,
        name: &Path,
        options: impl Into<ReadOptions>,
    ) -> Result<Self, FileError> {
        Self::from_bytes_in(bytes, format, name, Surroundings::Nothing, options)
    }

    /// Reads a file that is in memory already, and the files beside it from these [`Surroundings`]; an
    /// example is there.
    ///
    /// The name is as in [`from_bytes`](Self::from_bytes). With [`Surroundings::Memory`] no disk is
    /// needed or touched, up to and with [`to_bytes`](Self::to_bytes): this is the way in a browser.
    ///
    /// # Errors
    /// As [`open`](Self::open); one of kind [`FileErrorKind::Io`] if a file is missing in which a mesh
    /// has its data.
    pub fn from_bytes_in(
        bytes: Vec<u8>,
        format: Format,
        name: &Path,
        surroundings: Surroundings<'_>,
        options: impl Into<ReadOptions>,
    ) -> Result<Self, FileError> {
        let options = &options.into();
        let in_file = |problem: Problem| problem.in_file(name, Some(format));
        let main_size = check_size(&bytes, &options.limits);
        let main_size = main_size.map_err(|kind| in_file(kind.at(Place::File)))?;

        signature::check(format, &bytes).map_err(|kind| in_file(kind.at(Place::File)))?;
        let read = match format {
            Format::Gltf | Format::Glb => gltf::read(bytes, format, name, surroundings, options),
            Format::Obj => obj::read(bytes, surroundings, options),
            Format::Ply => ply::read(bytes, options),
            Format::Off => off::read(bytes, options),
            Format::Stl => stl::read(bytes, options),
            Format::Vrml => vrml::read(bytes, options),
        };
        let (content, notes) = read.map_err(in_file)?;
        Ok(Self {
            path: name.to_owned(),
            format,
            content,
            notes,
            folder: surroundings.folder().map(Path::to_owned),
            main_size,
            // Strips that were made lists are not as they were read.
            is_edited: options.strips_to_lists,
            stamp: None,
            own: Mutex::default(),
            is_gzip: false,
        })
    }

    /// A document of new meshes, in memory, of any format but VRML: see [`NewMesh`] for what each holds. What
    /// would be written is read first, so it is what any document of that file is.
    ///
    /// The name is for errors, and for a `.gltf` the one it is written under.
    ///
    /// ```
    /// use meshweft::files::{Document, Format, NewMesh};
    ///
    /// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = NewMesh::plain("triangle", &corners, &[[0, 1, 2]]);
    /// let document = Document::create(Format::Glb, "triangle.glb".as_ref(), &[triangle])?;
    /// assert_eq!(document.positions(0)?.as_deref(), Some(&corners[..]));
    /// # Ok::<(), meshweft::files::FileError>(())
    /// ```
    ///
    /// # Errors
    /// [`FileErrorKind::Unsupported`] if files of this format are not made here, or cannot hold one of
    /// the meshes; [`FileErrorKind::Order`] if faces name vertices that are not there. Their
    /// [place](Place::NewMesh) is the mesh.
    ///
    /// # Complexity
    /// Time and space O(bytes of the file).
    pub fn create(format: Format, name: &Path, meshes: &[NewMesh<'_>]) -> Result<Self, FileError> {
        let created = match format {
            Format::Gltf | Format::Glb => gltf::create(format, name, meshes),
            Format::Obj => obj::create(meshes),
            Format::Ply => ply::create(meshes),
            Format::Off => off::create(meshes),
            Format::Stl => stl::create(meshes),
            Format::Vrml => {
                let text = "VRML files are not made from nothing: create a .glb or an .obj";
                Err(FileErrorKind::unsupported(text).at(Place::File))
            }
        };
        let (content, notes) = created.map_err(|problem| problem.in_file(name, Some(format)))?;
        Ok(Self {
            path: name.to_owned(),
            format,
            content,
            notes,
            folder: None,
            main_size: 0,
            is_edited: true,
            stamp: None,
            own: Mutex::default(),
            is_gzip: false,
        })
    }

    /// The path it was read from, or the name it was given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its format.
    #[must_use]
    pub fn format(&self) -> Format {
        self.format
    }

    /// Whether the file was compressed where it was read, whatever its name says.
    #[must_use]
    pub fn is_gzip(&self) -> bool {
        self.is_gzip
    }

    /// The size of the file and of the buffers beside it that were read, as they stand on the disk;
    /// of files that were in memory, the number of their bytes.
    #[must_use]
    pub fn source_bytes(&self) -> u64 {
        self.main_size + self.content.size_beside()
    }

    /// Files that it names and that do not change with an order, such as images: paths from its folder,
    /// without `..`, sorted. Whether they are there is not known.
    #[must_use]
    pub fn companions(&self) -> Vec<PathBuf> {
        let mut companions = self.content.companions();
        companions.sort();
        companions.dedup();
        companions
    }

    /// The meshes that can be re-ordered, as they now are.
    #[must_use]
    pub fn meshes(&self) -> &[MeshEntry] {
        self.content.meshes()
    }

    /// What is left as it is, and why.
    #[must_use]
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// What is stored with the vertices, corners and faces of a mesh, morph targets included. Nothing is
    /// decoded for it.
    ///
    /// # Panics
    /// If there is no such mesh.
    #[must_use]
    pub fn attributes(&self, mesh: usize) -> Vec<AttributeInfo> {
        assert!(mesh < self.meshes().len(), "there is no mesh {mesh}");
        self.content.attributes(mesh)
    }

    /// The values of an attribute, in the order in which vertices and faces now are.
    ///
    /// # Errors
    /// [`FileError`] if the mesh has no such attribute (take one of
    /// [`attributes`](Self::attributes)), or its values are not numbers.
    ///
    /// # Panics
    /// If there is no such mesh.
    ///
    /// # Complexity
    /// Time and space O(values); of text, time O(bytes of the records).
    pub fn attribute(&self, mesh: usize, info: &AttributeInfo) -> Result<Attribute, FileError> {
        assert!(mesh < self.meshes().len(), "there is no mesh {mesh}");
        let read = self.content.attribute(mesh, info);
        read.map_err(|problem| problem.in_file(&self.path, Some(self.format)))
    }

    /// The position of each vertex of a mesh; `None` if the file has none of three coordinates.
    ///
    /// # Errors
    /// As [`attribute`](Self::attribute).
    ///
    /// # Panics
    /// If there is no such mesh.
    pub fn positions(&self, mesh: usize) -> Result<Option<Vec<[f32; 3]>>, FileError> {
        let Some(info) = self.position_info(mesh) else {
            return Ok(None);
        };
        let numbers = self.attribute(mesh, &info)?.to_f32();
        Ok(Some(numbers.as_chunks().0.to_vec()))
    }

    /// The positions of every mesh, if all have such; what meshes share is there once.
    pub(crate) fn all_positions(&self) -> Result<Option<Vec<SharedPositions>>, FileError> {
        self.positions_of_each().collect()
    }

    /// The positions of one mesh after the other, `None` where it has none; what meshes share is read once.
    pub(crate) fn positions_of_each(
        &self,
    ) -> impl Iterator<Item = Result<Option<SharedPositions>, FileError>> {
        let mut known = BTreeMap::new();
        (0..self.meshes().len()).map(move |mesh| {
            let info = self.position_info(mesh);
            let store = info.and_then(|info| self.content.store(mesh, &info));
            if let Some(shared) = store.and_then(|store| known.get(&store)) {
                return Ok(Some(Rc::clone(shared)));
            }
            let positions = self.positions(mesh)?.map(Rc::from);
            if let (Some(store), Some(positions)) = (store, &positions) {
                known.insert(store, Rc::clone(positions));
            }
            Ok(positions)
        })
    }

    /// A number of where the values of an attribute are stored: meshes with the same number share them.
    pub(crate) fn store(&self, mesh: usize, info: &AttributeInfo) -> Option<usize> {
        self.content.store(mesh, info)
    }

    /// For each corner of a mesh, three a face, a number: corners of one vertex have the same if the same is
    /// stored with them and holds for their faces, such as a material. Empty if that is so for all.
    ///
    /// # Errors
    /// As [`attribute`](Self::attribute).
    pub(crate) fn corner_kinds(&self, mesh: usize) -> Result<Vec<u32>, FileError> {
        let kinds = self.content.corner_kinds(mesh);
        kinds.map_err(|problem| problem.in_file(&self.path, Some(self.format)))
    }

    /// The culling table that the file has of a mesh, in the order in which the faces now are. Its structure was checked, its
    /// numbers were not.
    ///
    /// # Panics
    /// If there is no such mesh.
    ///
    /// # Complexity
    /// Time and space O(clusters).
    #[must_use]
    pub fn culling(&self, mesh: usize) -> Option<StoredCulling> {
        assert!(mesh < self.meshes().len(), "there is no mesh {mesh}");
        self.content.culling(mesh)
    }

    /// Calls `visit` with each culling table, in the order of the file; those of equal primitives come once.
    pub(crate) fn each_table(
        &self,
        visit: &mut dyn FnMut(PlacedTable<'_>),
    ) -> Result<(), FileError> {
        let visited = self.content.each_table(visit);
        visited.map_err(|problem| problem.in_file(&self.path, Some(self.format)))
    }

    /// What is wrong with tables that keep their faces from being read as a mesh, if there are such.
    pub(crate) fn damaged_table(&self) -> Option<&Note> {
        self.content.damaged_table()
    }

    /// Which sides of the faces of each mesh are seen, or why none of them may be left out.
    ///
    /// Time O(bytes of text).
    pub(crate) fn seen_sides(&self) -> Vec<Result<SeenSides, &'static str>> {
        self.content.seen_sides()
    }

    /// For each mesh, the largest scale that it is drawn with by nodes and joints as they stand; 1 where none is known.
    ///
    /// Time O(bytes of text).
    pub(crate) fn drawn_scales(&self) -> Vec<f64> {
        self.content.drawn_scales()
    }

    /// For each mesh, whether all that draws its faces has the same vertices.
    ///
    /// Time O(bytes of text).
    pub(crate) fn draws_alike(&self) -> Vec<bool> {
        self.content.draws_alike()
    }

    /// For each mesh, which vertices its levels of detail can have.
    ///
    /// Time O(bytes of text).
    pub(crate) fn vertices_of_levels(&self) -> Vec<VerticesOfLevels> {
        self.content.vertices_of_levels()
    }

    /// Where in its files, as they are now, each level of detail has what it needs.
    ///
    /// Time O(n log n) in the JSON, O(faces).
    pub(crate) fn level_bytes(&self) -> Result<LevelBytes, FileError> {
        let found = match self.is_gzip {
            true => Err(FileErrorKind::unsupported(
                "the file is compressed as a whole, so a part of it is of no use: decompress it first",
            )
            .at(Place::File)),
            false => self.content.level_bytes(),
        };
        found.map_err(|problem| problem.in_file(&self.path, Some(self.format)))
    }

    /// What the file holds that is neither in its meshes nor in their attributes: materials, lines, what is said
    /// of some faces only.
    ///
    /// Time O(bytes of the file).
    pub(crate) fn unlisted(&self) -> Vec<Unlisted> {
        let mut unlisted = self.content.unlisted();
        if self.meshes().iter().any(MeshEntry::has_short_records) {
            unlisted.push(Unlisted::other("faces of fewer than three corners"));
        }
        unlisted
    }

    /// The positions of the vertices of a file without faces, such as a point cloud in a PLY file; empty if it has faces.
    #[cfg_attr(
        not(feature = "height-maps"),
        expect(dead_code, reason = "only terrain is made of points")
    )]
    pub(crate) fn loose_positions(&self) -> Result<Vec<[f32; 3]>, FileError> {
        let found = self.content.loose_positions();
        let found = found.map_err(|problem| problem.in_file(&self.path, Some(self.format)))?;
        let numbers = found.map(|it| it.to_f32()).unwrap_or_default();
        Ok(numbers.as_chunks().0.to_vec())
    }

    /// The attribute that is the positions of a mesh.
    fn position_info(&self, mesh: usize) -> Option<AttributeInfo> {
        let mut infos = self.attributes(mesh).into_iter();
        infos.find(AttributeInfo::is_vertex_position)
    }

    /// Changes the document in memory; [`write`](Self::write) writes it.
    ///
    /// # Errors
    /// Of an order, [`FileErrorKind::Order`] or [`FileErrorKind::Unsupported`] if it is of another
    /// length, moves a record out of its run, turns corners that must stay, or moves vertices that
    /// must stay. Of a selection, the same if it names a face or vertex that is not there or twice, leaves
    /// out a vertex that is used, or anything that something else in the file may be about; and if what is
    /// stored with a corner cannot follow it. Nothing is changed then.
    ///
    /// # Panics
    /// If the edit is of a mesh or vertex group that is not there.
    pub fn edit(&mut self, edit: Edit<'_>) -> Result<(), FileError> {
        match edit {
            Edit::Order {
                mesh,
                faces,
                vertices,
            } => {
                check_order(&self.meshes()[mesh], faces, vertices)
                    .map_err(|kind| kind.at(Place::File).in_file(&self.path, Some(self.format)))?;
                self.is_edited |= faces.is_some_and(|order| !order.is_identity())
                    || vertices.is_some_and(|order| !order.is_identity());
                self.content.order(mesh, faces, vertices);
            }
            Edit::Select { faces, vertices } => {
                let in_file = |problem: Problem| problem.in_file(&self.path, Some(self.format));
                let plan = SelectPlan::new(self.meshes(), faces, vertices);
                let plan = plan.map_err(|kind| in_file(kind.at(Place::File)))?;
                if !plan.is_identity(self.meshes()) {
                    let notes = self.content.select(plan);
                    self.notes = notes.map_err(in_file)?;
                    self.is_edited = true;
                }
            }
            Edit::Cull { tables } => {
                if tables.is_empty() {
                    return Ok(());
                }
                let notes = self.content.cull(tables);
                self.notes =
                    notes.map_err(|problem| problem.in_file(&self.path, Some(self.format)))?;
                self.is_edited = true;
            }
            Edit::Levels { meshes } => {
                if meshes.is_empty() {
                    return Ok(());
                }
                let notes = self.content.add_levels(meshes);
                self.notes =
                    notes.map_err(|problem| problem.in_file(&self.path, Some(self.format)))?;
                self.is_edited = true;
            }
            Edit::StreamLayout => {
                let notes = self.content.stream_layout();
                let notes =
                    notes.map_err(|problem| problem.in_file(&self.path, Some(self.format)))?;
                if let Some(notes) = notes {
                    self.notes = notes;
                    self.is_edited = true;
                }
            }
            Edit::Append { meshes, values } => {
                let notes = self.content.append(meshes, values);
                self.notes =
                    notes.map_err(|problem| problem.in_file(&self.path, Some(self.format)))?;
                self.is_edited = true;
            }
        }
        Ok(())
    }
}

/// The error for a plain file whose name ends in `.gz`.
pub(super) fn not_compressed() -> FileErrorKind {
    let problem =
        "its name ends in .gz, but what is in it is not compressed: remove .gz from the name";
    FileErrorKind::unsupported(problem)
}

/// The folder of a file, empty for this one.
pub(super) fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}
