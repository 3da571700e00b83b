//! A document as a vertex hierarchy in a file.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::loading::{JoinedMesh, joined, no_faces};
use super::options::LodError;
use super::read_back;
use crate::attribute::{AttributeInfo, Domain, Semantic};
use crate::files::{Document, MeshEntry, Note};
use crate::lod::fast_mesh::FastMesh;
use crate::mesh::Mesh;
use crate::operations::json;
use crate::operations::losses::{self, Losses};

/// How a document becomes a `.mwl` file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct LodBuildOptions {
    /// Leave out whatever the file cannot hold; a document that has such is refused otherwise.
    pub drop_attributes: bool,
    /// Leave out the attributes of vertices too, and all else that is not a position or a face.
    pub positions_only: bool,
}

/// What [`lod_build`] did. The caller may add where it went and the time it took.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LodBuildReport {
    /// The file that was read.
    pub file: PathBuf,
    /// The file that was written: set by the caller.
    pub output: Option<PathBuf>,
    /// Size of the file and of the buffers beside it that were read.
    pub bytes_before: u64,
    /// Size of the hierarchy.
    pub bytes_after: u64,
    /// How long it took: set by the caller, who has a clock.
    pub seconds: Option<f64>,
    /// How many meshes were joined.
    pub meshes: usize,
    /// Vertices at full detail: those that no face uses are left out, and equal ones count once.
    pub vertices: usize,
    /// Faces at full detail.
    pub faces: usize,
    /// Vertices of the coarsest mesh.
    pub roots: usize,
    /// How many collapses are one after the other at most.
    pub depth: usize,
    /// Points that stay because the surface is not a manifold there.
    pub cut_points: usize,
    /// Faces that are left out because two of their corners are at one place: they draw nothing.
    pub flat_faces: usize,
    /// Vertices of the file that are left out because no face uses them.
    pub unused_vertices: usize,
    /// What else is stored with each vertex.
    pub attributes: Vec<AttributeInfo>,
    /// What the reader of the file says.
    pub notes: Vec<Note>,
}

impl LodBuildReport {
    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut report = json::file_head(
            "lod build",
            [Some(&self.file), self.output.as_deref()],
            (self.bytes_before, Some(self.bytes_after)),
            0,
            self.seconds,
        );
        let members = [
            ("meshes", json!(self.meshes)),
            ("vertices", json!(self.vertices)),
            ("faces", json!(self.faces)),
            ("roots", json!(self.roots)),
            ("depth", json!(self.depth)),
            ("cut_points", json!(self.cut_points)),
            ("flat_faces", json!(self.flat_faces)),
            ("unused_vertices", json!(self.unused_vertices)),
            ("attributes", names(&self.attributes)),
            ("notes", json::notes(&self.notes)),
        ];
        report.extend(members.map(|(name, value)| (name.to_owned(), value)));
        Value::Object(report).to_string()
    }
}

/// What attributes are called.
pub(super) fn names(attributes: &[AttributeInfo]) -> Value {
    let names = attributes.iter().map(|info| match info.morph_target {
        None => info.semantic.to_string(),
        Some(target) => format!("{} of morph target {target}", info.semantic),
    });
    Value::Array(names.map(Value::String).collect())
}

/// Makes the bytes of a `.mwl` file: all meshes of a document as one, with every level of detail, as a
/// [`StreamedFront`](crate::lod::fast_mesh::StreamedFront) reads them. They are read back, and full detail is compared with the
/// document.
///
/// The file has positions and faces, and the attributes of vertices if all meshes have the same ones, bit for bit. A document that holds
/// more is refused, unless the options say that the rest is left out: attributes of corners and faces, polygons, names and borders
/// of several meshes, what is said of some faces only (groups, materials), lines, nodes with a place, levels of detail, everything that is not known.
/// Positions are as the file stores them. What no face needs is left out: vertices that none uses, faces with two corners at one
/// place.
///
/// # Errors
/// [`LodError`]: there are no faces or no positions, some are not read, or there is more than these.
///
/// # Complexity
/// That of [`FastMesh::build`]; to compare, time O(faces log faces) and about 100 bytes a face.
///
/// ```no_run
/// use std::path::Path;
/// use meshweft::files::{Document, ReadOptions};
/// use meshweft::operations::{LodBuildOptions, lod_build};
///
/// let document = Document::open(Path::new("scan.ply"), ReadOptions::default())?;
/// let (bytes, report) = lod_build(&document, &LodBuildOptions::default())?;
/// std::fs::write("scan.mwl", bytes)?;
/// println!("{} faces, coarsest with {} vertices", report.faces, report.roots);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn lod_build(
    document: &Document,
    options: &LodBuildOptions,
) -> Result<(Vec<u8>, LodBuildReport), LodError> {
    let file = || document.path().to_owned();
    let kept = match options.positions_only {
        true => Vec::new(),
        false => attributes_of_all(document),
    };
    check(document, options, &kept)?;
    let JoinedMesh { mesh, attributes } = joined(document, &kept)?;
    let hierarchy = FastMesh::default().build(&mesh, &attributes);
    let hierarchy = hierarchy.and_then(|it| it.with_attributes(&attributes));
    let hierarchy = hierarchy.map_err(|error| LodError::Mesh {
        file: file(),
        error,
    })?;
    let flat_faces = hierarchy.flat_faces().len();
    if mesh.face_count() == flat_faces {
        return Err(no_faces(document));
    }

    let full: Vec<&MeshEntry> = full_meshes(document).collect();
    let hierarchy = match full[..] {
        [only] => hierarchy.with_name(&only.name),
        _ => hierarchy,
    };
    let bytes = hierarchy.to_bytes();
    let mut report = LodBuildReport {
        file: file(),
        output: None,
        bytes_before: document.source_bytes(),
        bytes_after: bytes.len() as u64,
        seconds: None,
        meshes: full.len(),
        vertices: hierarchy.vertex_count(),
        faces: mesh.face_count() - flat_faces,
        roots: 0,
        depth: hierarchy.depth(),
        cut_points: hierarchy.cut_points(),
        flat_faces,
        unused_vertices: mesh.vertex_count() - used_vertices(&mesh),
        attributes: hierarchy.attributes().to_vec(),
        notes: document.notes().to_vec(),
    };
    // Both would be large.
    drop(hierarchy);
    report.roots = read_back::roots_if_same(&mesh, &attributes, &bytes)
        .ok_or_else(|| LodError::NotVerified { file: file() })?;
    Ok((bytes, report))
}

fn used_vertices(mesh: &Mesh) -> usize {
    let mut is_used = vec![false; mesh.vertex_count()];
    for &vertex in mesh.faces().as_flattened() {
        is_used[vertex as usize] = true;
    }
    is_used.into_iter().filter(|&used| used).count()
}

/// The meshes that the file has, which are those at full resolution.
fn full_meshes(document: &Document) -> impl Iterator<Item = &MeshEntry> {
    let entries = document.meshes().iter();
    entries.filter(|entry| entry.level.is_none())
}

/// The attributes of vertices that all meshes with faces have.
fn attributes_of_all(document: &Document) -> Vec<AttributeInfo> {
    let entries = document.meshes().iter().enumerate();
    let full = entries.filter(|(_, entry)| entry.level.is_none());
    let with_faces = full.filter(|(_, entry)| entry.mesh.face_count() > 0);
    let mut each = with_faces.map(|(number, _)| {
        let is_place = |info: &AttributeInfo| {
            info.semantic == Semantic::Position && info.morph_target.is_none()
        };
        let mut attributes = document.attributes(number);
        attributes.retain(|info| info.domain == Domain::Vertex && !is_place(info));
        attributes.sort_by(|a, b| {
            let key = |info: &AttributeInfo| (info.morph_target, info.semantic.clone());
            key(a).cmp(&key(b))
        });
        attributes
    });
    let mut common = each.next().unwrap_or_default();
    for other in each {
        common.retain(|info| other.contains(info));
    }
    common
}

/// Whether everything of a document can be in the file, with the attributes that are kept, but for what the options leave out.
fn check(
    document: &Document,
    options: &LodBuildOptions,
    kept: &[AttributeInfo],
) -> Result<(), LodError> {
    let file = || document.path().to_owned();
    let unread = full_meshes(document).find(|entry| entry.has_other_faces);
    let unread = unread.map(|entry| entry.name.clone());
    if let Some(mesh) = losses::unread_outside(document).or(unread) {
        return Err(LodError::UnreadFaces { file: file(), mesh });
    }
    if options.drop_attributes || options.positions_only {
        return Ok(());
    }

    let mut lost = Losses::of(document, |_, info| kept.contains(info))?;
    let others = &mut lost.others;
    let count = full_meshes(document).count();
    if count > 1 {
        others.push(format!("{count} meshes, which become one"));
    }
    let has_polygons = |polygons: &Vec<u32>| polygons.windows(2).any(|ends| ends[1] - ends[0] > 1);
    if full_meshes(document)
        .filter_map(|it| it.polygons.as_ref())
        .any(has_polygons)
    {
        others.push("polygons, which become triangles".to_owned());
    }
    let mut numbers = 0..document.meshes().len();
    if numbers.any(|mesh| losses::has_wide_positions(document, mesh)) {
        others.push("positions of more bits than a 32-bit float".to_owned());
    }
    match lost.is_empty() {
        true => Ok(()),
        false => Err(LodError::Losses {
            file: file(),
            attributes: lost.attributes,
            others: lost.others,
        }),
    }
}
