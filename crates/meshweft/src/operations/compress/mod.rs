//! A document as an archive of compressed meshes, and back.

mod decompress;
mod options;
mod report;

use std::borrow::Cow;

use crate::compression::{
    CodeOptions, DecodedMesh, MeshArchive, MeshCode, PolygonOrder, PositionCoding,
};
use crate::connectivity::MinimumTimeRendering;
use crate::files::Document;
use crate::geometry::Lattice;
use crate::limits::Limits;
use crate::mesh::Mesh;
use crate::operations::losses::{self, Losses};
use crate::operations::plain_meshes::{SeparateMesh, plain_meshes};
use crate::permutation::{FaceOrder, VertexOrder};

pub use crate::compression::{KeepOrder, PolygonCounts, Tier};
pub use decompress::{DecodedOrder, DecompressOptions, DecompressedMesh, decompress};
pub use options::{CompressError, CompressOptions, PositionPrecision};
pub use report::{CompressReport, CompressedMesh};

/// Compresses the positions, faces and polygons of a document's meshes, and decodes them again to see that nothing was lost.
///
/// Each mesh keeps its name, its faces and its vertices. Of meshes that share vertices, as two primitives of a glTF
/// may, each gets those that its faces have, and the first also those that none has. A document that holds anything else
/// is refused, unless the options say that it is left out: attributes, what is said of some faces only (groups, materials),
/// lines, nodes with a place, levels of detail, everything that is not known. Comments, header text and how numbers are written do not count.
///
/// # Errors
/// The document has no mesh, or one that is not all positions and triangles, or more than these, or positions that cannot
/// be stored as the options say.
///
/// # Complexity
/// Time O(vertices + faces log valence), 29 times over to choose a first vertex; space about 150 bytes a face of the largest mesh.
pub fn compress(
    document: &Document,
    options: &CompressOptions,
) -> Result<(Vec<u8>, CompressReport), CompressError> {
    let file = || document.path().to_owned();
    check(document, options)?;

    // One lattice for all, so that meshes that met still meet.
    let meshes = plain_meshes(document)?;
    let positions = || {
        meshes
            .iter()
            .flat_map(|plain| plain.mesh.positions().iter().copied())
    };
    let lattice = match options.positions {
        PositionPrecision::Lossless => None,
        PositionPrecision::Bits(bits) => Lattice::of_bits(positions(), bits),
        PositionPrecision::Step(step) => Lattice::new(step).filter(|_| is_power_of_two(step)),
    };
    let coding = match (lattice, options.positions) {
        (Some(lattice), _) => PositionCoding::OnLattice(lattice),
        (None, PositionPrecision::Lossless) => PositionCoding::Lossless,
        (None, precision) => return Err(CompressError::Precision(precision)),
    };

    // Mesh by mesh.
    let mut archive = MeshArchive::default();
    let mut compressed = Vec::new();
    for SeparateMesh { number, name, mesh } in &meshes {
        let entry = &document.meshes()[*number];
        let starts = entry.polygons.as_deref().filter(|_| !options.triangles);
        let first_vertex = options.first_vertex.choose(mesh);
        let options = CodeOptions {
            tier: options.tier,
            positions: coding,
            first_vertex: first_vertex.map_err(CompressError::FirstVertex)?,
            keep_order: options.keep_order,
        };
        let code = match starts {
            Some(starts) => MeshCode::of_polygons(mesh, starts, &options),
            None => MeshCode::new(mesh, &options),
        };
        let code = code.map_err(|error| CompressError::Mesh {
            file: file(),
            mesh: name.clone(),
            error,
        })?;
        let decoded = MeshCode::decode_stored(code.bytes(), Limits::default()).ok();
        let decoded = decoded.filter(|stored| {
            let DecodedMesh {
                mesh: mesh_as_stored,
                polygons,
                order,
            } = stored;
            let (faces, vertices) = (code.faces(), code.vertices());
            let is_back = || {
                let faces = order.faces().is_none().then_some(faces);
                let vertices = order.vertices().is_none().then_some(vertices);
                let restored = order.restore(mesh_as_stored.clone());
                is_same(mesh, &restored, faces, vertices, lattice)
            };
            is_same(mesh, mesh_as_stored, Some(faces), Some(vertices), lattice)
                && (options.keep_order == KeepOrder::Nothing || is_back())
                && are_polygons_back(mesh, starts, polygons.as_ref(), &code)
        });
        let decoded = decoded.ok_or_else(|| CompressError::NotVerified {
            file: file(),
            mesh: name.clone(),
        })?;
        archive.push(name, &code);
        compressed.push(CompressedMesh {
            name: name.clone(),
            vertices: mesh.vertex_count(),
            faces: mesh.face_count(),
            bytes: code.bytes().len(),
            sizes: code.sizes(),
            polygons: code.polygons(),
            buffer_size: MinimumTimeRendering::new(&decoded.mesh).buffer_size(),
        });
    }
    let bytes = archive.to_bytes();
    let report = CompressReport {
        file: file(),
        output: None,
        bytes_before: document.source_bytes(),
        bytes_after: bytes.len() as u64,
        seconds: None,
        options: *options,
        step: lattice.map(|lattice| lattice.step()),
        meshes: compressed,
        notes: document.notes().to_vec(),
    };
    Ok((bytes, report))
}

/// Whether a number is two to the power of a whole number.
fn is_power_of_two(step: f64) -> bool {
    step.is_normal() && step.to_bits() & ((1 << (f64::MANTISSA_DIGITS - 1)) - 1) == 0
}

/// Whether everything of a document can be compressed, but for what the options leave out.
fn check(document: &Document, options: &CompressOptions) -> Result<(), CompressError> {
    let file = || document.path().to_owned();
    if let Some(mesh) = losses::unread_outside(document) {
        return Err(CompressError::UnreadFaces { file: file(), mesh });
    }
    let entries = document.meshes();
    if entries.is_empty() {
        return Err(CompressError::NoMesh { file: file() });
    }
    let all = entries.iter().enumerate();
    for (number, entry) in all.filter(|(_, entry)| entry.level.is_none()) {
        let (file, mesh) = (file(), entry.name.clone());
        if entry.has_other_faces {
            return Err(CompressError::UnreadFaces { file, mesh });
        }
        if !options.triangles && losses::has_lines(entry) {
            return Err(CompressError::Lines { file, mesh });
        }
        let is_lossless = options.positions == PositionPrecision::Lossless;
        if is_lossless && losses::has_wide_positions(document, number) {
            return Err(CompressError::WidePositions { file, mesh });
        }
    }
    if options.drop_attributes {
        return Ok(());
    }
    let losses = Losses::of(document, |_, _| false)?;
    match losses.is_empty() {
        true => Ok(()),
        false => Err(CompressError::Attributes {
            file: file(),
            attributes: losses.attributes,
            others: losses.others,
        }),
    }
}

/// Whether a decoded mesh is the mesh in these orders, its positions rounded to the lattice, bit for bit.
fn is_same(
    mesh: &Mesh,
    decoded: &Mesh,
    faces: Option<&FaceOrder>,
    vertices: Option<&VertexOrder>,
    lattice: Option<Lattice>,
) -> bool {
    let mut expected = Cow::Borrowed(mesh);
    if let Some(faces) = faces {
        expected = Cow::Owned(expected.with_face_order(faces));
    }
    if let Some(vertices) = vertices {
        expected = Cow::Owned(expected.with_vertex_order(vertices));
    }
    let rounded = |coordinate: f32| match lattice {
        Some(lattice) => lattice
            .multiple(coordinate)
            .map(|it| lattice.coordinate(it)),
        None => Some(coordinate),
    };
    let expected_bits = expected.positions().as_flattened().iter();
    let expected_bits = expected_bits.map(|&it| rounded(it).map(f32::to_bits));
    let bits = decoded.positions().as_flattened().iter();
    let bits = bits.map(|it| Some(it.to_bits()));
    decoded.faces() == expected.faces() && bits.eq(expected_bits)
}

/// Whether the decoded polygons are those of the mesh, but for those that were cut: each has the same faces, and the same
/// corners around it.
fn are_polygons_back(
    mesh: &Mesh,
    starts: Option<&[u32]>,
    polygons: Option<&PolygonOrder>,
    code: &MeshCode,
) -> bool {
    let PolygonCounts { kept, cut } = code.polygons();
    let Some((starts, polygons)) = starts.zip(polygons) else {
        return polygons.is_none() && kept == 0;
    };

    // The decoded polygons with the faces and the vertices of the source.
    let order = code.faces().then(polygons.faces());
    let faces = order.apply(mesh.faces());
    let mut found = [0; 2];
    for ends in polygons.starts().windows(2) {
        let decoded = ends[0] as usize..ends[1] as usize;
        let face = order.new_to_old()[decoded.start];
        let record = starts.partition_point(|&start| start <= face) - 1;
        let source = starts[record] as usize..starts[record + 1] as usize;
        let is_same = match decoded.len() {
            1 => true,
            _ => around(&faces[decoded.clone()]) == around(&mesh.faces()[source.clone()]),
        };
        let mut numbers = order.new_to_old()[decoded.clone()].to_vec();
        numbers.sort_unstable();
        let is_whole = numbers.iter().map(|&face| face as usize).eq(source.clone());
        if !is_same || !(is_whole || decoded.len() == 1) {
            return false;
        }
        found[0] += usize::from(decoded.len() > 1);
        found[1] += usize::from(!is_whole && source.start == face as usize);
    }
    found == [kept, cut]
}

/// The corners of a fan, the least ones first that are possible.
fn around(fan: &[[u32; 3]]) -> Vec<u32> {
    let mut corners = vec![fan[0][0]];
    corners.extend(fan.iter().map(|face| face[1]));
    corners.push(fan[fan.len() - 1][2]);
    let turns = 0..corners.len();
    let turned = turns.map(|turn| [&corners[turn..], &corners[..turn]].concat());
    turned.min().unwrap_or_default()
}
