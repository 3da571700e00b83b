//! One mesh of those that a vertex hierarchy in a file has.

use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::build::names;
use super::options::LodError;
use crate::attribute::{Attribute, AttributeInfo, Semantic};
use crate::index::index32;
use crate::limits::Limits;
use crate::lod::HierarchyError;
use crate::lod::fast_mesh::{FrameBudget, Front, StreamedFront};
use crate::lod::{Camera, CameraView};
use crate::mesh::Mesh;
use crate::operations::json;
use crate::operations::walks::WalkOptionError;
use crate::order::{KCacheReorder, by_first_use};

/// Which mesh of a `.mwl` file is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum LodDetail {
    /// That with every vertex whose error is above this length, in units of the positions, and those that these need. With 0 it is the
    /// mesh that the file was built of.
    Error(f64),
    /// The best one of at most this many vertices: those of the largest errors.
    Vertices(usize),
    /// What a camera needs, if an error of this many pixels may be seen: coarse outside of the picture and on the far side.
    Camera {
        /// The camera.
        camera: Camera,
        /// How many pixels the surface may be off.
        tolerance: f64,
    },
}

/// How a mesh is taken from a `.mwl` file.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LodExtractOptions {
    /// Which mesh.
    pub detail: LodDetail,
    /// The largest file, and the most vertices.
    pub limits: Limits,
    /// Positions and faces alone, without what else is stored with vertices.
    pub positions_only: bool,
}

impl LodExtractOptions {
    /// A mesh of this detail.
    #[must_use]
    pub fn new(detail: LodDetail) -> Self {
        Self {
            detail,
            limits: Limits::default(),
            positions_only: false,
        }
    }

    /// Whether every number is in its range.
    ///
    /// # Errors
    /// The first one that is not.
    pub fn check(&self) -> Result<(), WalkOptionError> {
        let error = |option, found: String, allowed: &str| {
            Err(WalkOptionError {
                option,
                found,
                allowed: allowed.to_owned(),
            })
        };
        match self.detail {
            LodDetail::Error(length) if !(length >= 0.0 && length.is_finite()) => {
                let allowed = "a length in units of the positions, 0 for all detail";
                error("error", length.to_string(), allowed)
            }
            LodDetail::Camera { tolerance, .. } if !(tolerance > 0.0 && tolerance.is_finite()) => {
                error(
                    "tolerance",
                    tolerance.to_string(),
                    "a number of pixels above 0",
                )
            }
            _ => Ok(()),
        }
    }
}

/// A mesh of a `.mwl` file.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ExtractedMesh {
    /// What the mesh of the file is called; may be empty.
    pub name: String,
    /// Positions and faces, in an order to be drawn.
    pub mesh: Mesh,
    /// What is stored with the vertices: first their positions, and then what the file has.
    pub attributes: Vec<Attribute>,
    /// What was read.
    pub report: LodExtractReport,
}

/// What [`lod_extract`] read. The caller may add where it went and the time it took.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LodExtractReport {
    /// The file that was read.
    pub file: PathBuf,
    /// The file that was written: set by the caller.
    pub output: Option<PathBuf>,
    /// Size of the file.
    pub file_bytes: u64,
    /// How much of it was read.
    pub bytes_read: u64,
    /// Size of what was written: set by the caller.
    pub bytes_written: Option<u64>,
    /// How long it took: set by the caller, who has a clock.
    pub seconds: Option<f64>,
    /// Vertices of the mesh.
    pub vertices: usize,
    /// Faces of the mesh.
    pub faces: usize,
    /// Vertices of the file.
    pub vertices_of_file: usize,
    /// The largest error of what is left out, in units of the positions; 0 if nothing is.
    pub error: f32,
    /// Faces of the input with two corners at one place, which the file does not have.
    pub flat_faces: usize,
    /// What is stored with each vertex besides its position.
    pub attributes: Vec<AttributeInfo>,
}

impl LodExtractReport {
    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut report = json::file_head(
            "lod extract",
            [Some(&self.file), self.output.as_deref()],
            (self.file_bytes, self.bytes_written),
            0,
            self.seconds,
        );
        let members = [
            ("bytes_read", json!(self.bytes_read)),
            ("vertices", json!(self.vertices)),
            ("faces", json!(self.faces)),
            ("vertices_of_file", json!(self.vertices_of_file)),
            ("error", json!(self.error)),
            ("flat_faces", json!(self.flat_faces)),
            ("attributes", names(&self.attributes)),
        ];
        report.extend(members.map(|(name, value)| (name.to_owned(), value)));
        Value::Object(report).to_string()
    }
}

/// Takes one mesh from a `.mwl` file, of which only the blocks that it needs are read. `file` is named in errors and in the report.
///
/// Vertices have the bytes that the input has. Faces of the input with two corners at one place are not in the file.
///
/// # Errors
/// [`LodError`]: an option is out of its range, the file cannot be read, is damaged, is not a `.mwl` file, is larger than allowed, or its coarsest mesh has more
/// vertices than are asked for.
///
/// # Complexity
/// Time O(n log n) for n vertices of the file, far less where few are needed; space about 100 bytes a vertex of the file.
///
/// ```no_run
/// use std::path::Path;
/// use meshweft::operations::{LodDetail, LodExtractOptions, lod_extract};
///
/// let path = Path::new("scan.mwl");
/// let options = LodExtractOptions::new(LodDetail::Vertices(10_000));
/// let extracted = lod_extract(std::fs::File::open(path)?, path, &options)?;
/// println!("{} faces, off by {}", extracted.mesh.face_count(), extracted.report.error);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn lod_extract<S: Read + Seek>(
    mut source: S,
    file: &Path,
    options: &LodExtractOptions,
) -> Result<ExtractedMesh, LodError> {
    options.check()?;
    let unread = |error: HierarchyError| LodError::Stored {
        file: file.to_owned(),
        frame: None,
        error,
    };
    let length = source.seek(SeekFrom::End(0));
    let length = length.map_err(|error| unread(error.into()))?;
    if length > options.limits.file_bytes {
        return Err(LodError::TooLong {
            file: file.to_owned(),
            bytes: length,
            limit: options.limits.file_bytes,
        });
    }

    // The front that is asked for.
    let mut streamed = StreamedFront::open(source, options.limits).map_err(unread)?;
    let view =
        |view: Result<CameraView, _>| view.map_err(|error| LodError::View { frame: 0, error });
    match options.detail {
        LodDetail::Error(0.0) => streamed.refine_fully().map(|_| ()),
        LodDetail::Error(length) => {
            let view = view(CameraView::of_errors_above(length))?;
            streamed.update(&view, 1.0).map(|_| ())
        }
        LodDetail::Camera { camera, tolerance } => {
            let view = view(camera.view(tolerance))?;
            streamed.update(&view, 1.0).map(|_| ())
        }
        LodDetail::Vertices(most) => {
            let least = streamed.front().vertex_count();
            if least > most {
                return Err(LodError::TooFewVertices {
                    file: file.to_owned(),
                    asked: most,
                    least,
                });
            }
            let view = view(CameraView::of_errors_above(-1.0))?;
            let budget = FrameBudget {
                vertices: most,
                ..FrameBudget::default()
            };
            streamed.update_within(&view, 1.0, budget).map(|_| ())
        }
    }
    .map_err(unread)?;

    // Its faces, and the vertices that they have.
    let front = streamed.front();
    let (faces, vertices) = numbered(front);
    let hierarchy = front.hierarchy();
    let positions: Vec<[f32; 3]> = vertices.iter().map(|&it| hierarchy.position(it)).collect();
    let mut attributes = vec![Attribute::of_vertices(Semantic::Position, &positions)];
    if !options.positions_only {
        let numbers = 0..hierarchy.attributes().len();
        attributes.extend(numbers.map(|number| hierarchy.attribute(number, &vertices)));
    }
    let mesh = Mesh::new(positions, faces).map_err(|error| LodError::Mesh {
        file: file.to_owned(),
        error,
    })?;
    let [file_bytes, bytes_read] = streamed.bytes();
    let infos = attributes[1..].iter().map(|it| it.info.clone());
    let report = LodExtractReport {
        file: file.to_owned(),
        output: None,
        file_bytes,
        bytes_read,
        bytes_written: None,
        seconds: None,
        vertices: mesh.vertex_count(),
        faces: mesh.face_count(),
        vertices_of_file: hierarchy.vertex_count(),
        error: front.largest_error_left(),
        flat_faces: hierarchy.flat_faces().len(),
        attributes: infos.collect(),
    };
    Ok(ExtractedMesh {
        name: hierarchy.name().to_owned(),
        mesh,
        attributes,
        report,
    })
}

/// The faces of a front in an order to be drawn, with vertices by their first use, and the vertex of the hierarchy for each.
fn numbered(front: &Front) -> (Vec<[u32; 3]>, Vec<u32>) {
    // As the input had them, so that the result does not depend on the way here.
    let hierarchy = front.hierarchy();
    let mut is_used = vec![false; hierarchy.vertex_count()];
    for vertex in front.faces().flat_map(|(_, face)| face) {
        is_used[vertex as usize] = true;
    }
    let mut vertices: Vec<u32> = (0..index32(is_used.len())).collect();
    vertices.retain(|&vertex| is_used[vertex as usize]);
    let sources = hierarchy.source_vertices();
    vertices.sort_by_key(|&vertex| (sources[vertex as usize], vertex));
    let mut numbers = vec![0; is_used.len()];
    for (number, &vertex) in (0..).zip(&vertices) {
        numbers[vertex as usize] = number;
    }
    let turned = |face: [u32; 3]| {
        let [a, b, c] = face.map(|vertex| numbers[vertex as usize]);
        [[a, b, c], [b, c, a], [c, a, b]]
            .into_iter()
            .min()
            .unwrap_or_default()
    };
    let mut faces: Vec<[u32; 3]> = front.faces().map(|(_, face)| turned(face)).collect();
    faces.sort_unstable();

    let Ok(mesh) = Mesh::connectivity_only(vertices.len(), faces) else {
        // Not of a front: all its vertices were counted.
        return (Vec::new(), Vec::new());
    };
    let drawn = mesh.with_face_order(&KCacheReorder::default().face_order(&mesh));
    let order = by_first_use((&drawn).into());
    let drawn = drawn.with_vertex_order(&order);
    let old = order.permutation().new_to_old().iter();
    let vertices = old.map(|&number| vertices[number as usize]);
    (drawn.faces().to_vec(), vertices.collect())
}
