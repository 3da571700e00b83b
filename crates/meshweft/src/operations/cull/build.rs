//! Faces in clusters, and the tables that say from where these are seen.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::rc::Rc;

use super::options::{CullError, CullOptions};
use super::report::{CullOutcome, CullReport, CulledMesh};
use crate::culling::{CullingTable, NormalStripes};
use crate::error::MeshError;
use crate::files::{Document, Edit, FileError, Format, MeshEntry, SeenSides, StoredCulling};
use crate::first_use::{FirstUse, keeps_blocks};
use crate::index::index32;
use crate::mesh::Mesh;
use crate::operations::converted::converted;
use crate::operations::file_report::FileReport;
use crate::permutation::FaceOrder;
use crate::progress::Progress;

/// Puts the faces of a document in clusters, and adds tables that say from where these are seen (the extension
/// `MESHWEFT_culling` of a glTF).
///
/// A glTF keeps every byte that is not a face record; what is new goes to the ends. Of a document of another format a
/// GLB is made first, with the names, positions and faces of its meshes: the document then is that.
///
/// Faces that are seen from both sides, or that are transparent, keep their order, and one cluster of all of them is
/// always drawn. A mesh that joints or morph targets move is left as it is, and so is what the reader leaves; the report
/// says why. A mesh that several nodes draw has one table.
///
/// The result is the same on any number of threads.
///
/// # Errors
/// [`CullError`]: the options are not sound, a mesh has a table already, or a GLB would lose something that the options do not let go.
///
/// # Complexity
/// That of [`ViewClusters`](crate::culling::ViewClusters), or of [`NormalStripes`], on each mesh.
///
/// ```no_run
/// use std::path::Path;
/// use meshweft::files::{Document, ReadOptions};
/// use meshweft::operations::{CullOptions, cull_build};
///
/// let mut document = Document::open(Path::new("scene.glb"), ReadOptions::default())?;
/// let report = cull_build(&mut document, &CullOptions::default(), &())?;
/// document.write(Path::new("culled.glb"))?;
/// println!("{}", report.to_json());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn cull_build(
    document: &mut Document,
    options: &CullOptions,
    progress: &dyn Progress,
) -> Result<CullReport, CullError> {
    options.check().map_err(CullError::Options)?;
    let mut of_file = FileReport::of(document);
    let mut lost = Vec::new();
    let is_created = !matches!(document.format(), Format::Gltf | Format::Glb);
    if is_created {
        let glb = converted(document, options.drop_attributes)?;
        (*document, lost) = (glb.document, glb.lost);
    }
    let with_table = (0..document.meshes().len()).find(|&mesh| document.culling(mesh).is_some());
    if let Some(mesh) = with_table {
        let mesh = document.meshes()[mesh].name.clone();
        let file = of_file.file;
        return Err(CullError::HasTable { file, mesh });
    }

    // Orders and tables; nothing is changed yet.
    let mut is_stopped = false;
    let mut tables = Vec::new();
    let mut meshes = Vec::new();
    let sides = document.seen_sides();
    let shared = document.all_positions()?;
    let total: usize = document
        .meshes()
        .iter()
        .map(|it| it.mesh.face_count())
        .sum();
    let mut done = 0;
    for (number, (entry, sides)) in document.meshes().iter().zip(sides).enumerate() {
        let mut mesh = CulledMesh::left(entry, String::new());
        let positions = positions_of(document, shared.as_deref(), number)?;
        let options = (!is_stopped).then_some(options);
        match clustered(entry, positions.as_deref(), sides, options) {
            Err(why) => mesh.outcome = CullOutcome::Left(why),
            Ok(clustered) => {
                mesh.outcome = clustered.outcome;
                mesh.faces = clustered.order;
                mesh.clusters = clustered.table.planes.len();
                tables.push((number, clustered.table));
            }
        }
        meshes.push(mesh);
        done += entry.mesh.face_count();
        let go_on = progress.report(done as f64 / total.max(1) as f64);
        is_stopped |= go_on == ControlFlow::Break(()) && done < total;
    }

    // All of it.
    apply(document, &meshes, &tables)?;
    match is_created {
        true => of_file.notes.extend_from_slice(document.notes()),
        false => of_file.notes = document.notes().to_vec(),
    }
    Ok(CullReport {
        of_file,
        options: options.clone(),
        lost,
        meshes,
        is_stopped,
    })
}

/// Does it to the document.
fn apply(
    document: &mut Document,
    meshes: &[CulledMesh],
    tables: &[(usize, StoredCulling)],
) -> Result<(), FileError> {
    for (number, mesh) in meshes.iter().enumerate() {
        if !mesh.faces.is_identity() {
            document.edit(Edit::order(number, &mesh.faces, None))?;
        }
    }
    let tables: Vec<(usize, &StoredCulling)> =
        tables.iter().map(|(mesh, table)| (*mesh, table)).collect();
    document.edit(Edit::Cull { tables: &tables })
}

/// A mesh with its faces in clusters.
struct Clustered {
    order: FaceOrder,
    table: StoredCulling,
    outcome: CullOutcome,
}

/// The clusters of a mesh, or why it has none; without a way to make them, always drawn ones are made only.
fn clustered(
    entry: &MeshEntry,
    positions: Option<&[[f32; 3]]>,
    sides: Result<SeenSides, &'static str>,
    options: Option<&CullOptions>,
) -> Result<Clustered, String> {
    let sides = sides?;
    let face_count = entry.mesh.face_count();
    if face_count == 0 {
        return Err("it has no faces".to_owned());
    }
    let positions = positions.ok_or("it has no positions of three numbers")?;

    // What keeps its order is always drawn.
    let why = match sides {
        SeenSides::Both => {
            Some("both sides of its faces are seen (doubleSided, or an outline of VRM)")
        }
        SeenSides::Front if !entry.faces_movable => {
            Some("its faces are transparent (alphaMode BLEND), so their order stays")
        }
        SeenSides::Front => None,
    };
    if let Some(why) = why {
        let mesh = compact(entry, positions).map_err(|error| error.to_string())?;
        let mut table = stored(&CullingTable::new(&mesh, &[0, index32(face_count)]));
        check(&table)?;
        table.planes = vec![CullingTable::ALWAYS_DRAWN];
        return Ok(Clustered {
            order: FaceOrder::identity(face_count),
            table,
            outcome: CullOutcome::AlwaysDrawn(why),
        });
    }

    // The others.
    let options = options.ok_or("the work was stopped")?;
    let mesh = compact(entry, positions).map_err(|error| error.to_string())?;
    let (order, table) = ordered(&mesh, options);
    check(&table)?;
    Ok(Clustered {
        order,
        table,
        outcome: CullOutcome::Clusters,
    })
}

/// The faces in clusters, or in stripes of which each range is one.
fn ordered(mesh: &Mesh, options: &CullOptions) -> (FaceOrder, StoredCulling) {
    let Some(count) = options.stripes else {
        let clustered = options.clusters.order(mesh);
        return (clustered.order().clone(), stored(clustered.table()));
    };
    let stripes = NormalStripes {
        stripe_count: Some(count),
        optimizer: Some(options.clusters.optimizer.clone()),
        ..NormalStripes::default()
    };
    let striped = stripes.order(mesh);
    let in_order = mesh.with_face_order(striped.order());
    let table = CullingTable::new(&in_order, striped.starts());
    (striped.order().clone(), stored(&table))
}

/// Whether a file may have such a table.
fn check(table: &StoredCulling) -> Result<(), String> {
    let starts = table.starts.clone();
    let checked = CullingTable::from_parts(table.center, table.reach, starts, &table.planes);
    let told = |_| "a position is not a finite number, or is too large".to_owned();
    checked.map(|_| ()).map_err(told)
}

/// The positions of a mesh; `shared` are those of all meshes, if all have some.
fn positions_of<'a>(
    document: &Document,
    shared: Option<&'a [Rc<[[f32; 3]]>]>,
    mesh: usize,
) -> Result<Option<Cow<'a, [[f32; 3]]>>, FileError> {
    match shared {
        Some(shared) => Ok(Some(Cow::Borrowed(&*shared[mesh]))),
        None => Ok(document.positions(mesh)?.map(Cow::Owned)),
    }
}

/// A mesh over the vertices that its faces use, if a large buffer has many others.
pub(super) fn compact(entry: &MeshEntry, positions: &[[f32; 3]]) -> Result<Mesh, MeshError> {
    let faces = entry.mesh.faces();
    let mut numbers = FirstUse::new(positions.len(), 3 * faces.len());
    let renumbered: Vec<[u32; 3]> = faces
        .iter()
        .map(|face| face.map(|vertex| numbers.number(vertex)))
        .collect();
    let used = numbers.finish();
    match keeps_blocks(positions.len(), used.len()) || positions.len() == used.len() {
        true => Mesh::new(positions, faces),
        false => {
            let positions = used.iter().map(|&vertex| positions[vertex as usize]);
            Mesh::new(positions.collect::<Vec<_>>(), renumbered)
        }
    }
}

/// The parts of a table, without clusters that have no faces.
fn stored(table: &CullingTable) -> StoredCulling {
    let mut starts = vec![0];
    let mut planes = Vec::with_capacity(table.cluster_count());
    for (cluster, ends) in table.starts().windows(2).enumerate() {
        if ends[0] < ends[1] {
            planes.push(table.planes(cluster));
            starts.push(ends[1]);
        }
    }
    StoredCulling {
        center: table.center(),
        reach: table.reach(),
        starts,
        planes,
    }
}
