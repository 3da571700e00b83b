//! Other people's readers find the same faces in a file before and after it is re-ordered.
//!
//! A face is its corners with all that the reader knows of them, bit by bit; the order of faces and
//! the corner that a face starts with do not count.

use std::collections::HashMap;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::{Document, Edit, Format};
use meshweft::order::{KCacheReorder, vertex_fetch};
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// Numbers for records: equal records have equal numbers.
#[derive(Default)]
struct Numbers(HashMap<Vec<u64>, u32>);

impl Numbers {
    fn of(&mut self, record: Vec<u64>) -> u32 {
        let next = u32::try_from(self.0.len()).expect("fewer records than that");
        *self.0.entry(record).or_insert(next)
    }
}

/// What the face carries, and its corners with the least rotation.
type Face = (u32, Vec<u32>);

/// The faces in a file, sorted.
type Reader = fn(&[u8], &mut Numbers) -> Result<Vec<Face>, String>;

fn sorted(mut faces: Vec<Face>) -> Vec<Face> {
    for (_, corners) in &mut faces {
        let turned = |turn: &usize| [&corners[*turn..], &corners[..*turn]].concat();
        let least = (0..corners.len()).min_by_key(turned).unwrap_or(0);
        corners.rotate_left(least);
    }
    faces.sort_unstable();
    faces
}

fn bits(values: &[f32]) -> impl Iterator<Item = u64> {
    values.iter().map(|value| u64::from(value.to_bits()))
}

/// By `tobj`: corners with position, colour, texture coordinates and normal; faces with the number
/// of their model.
fn obj(bytes: &[u8], numbers: &mut Numbers) -> Result<Vec<Face>, String> {
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..Default::default()
    };
    let no_materials = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(bytes), &options, no_materials)
        .map_err(|error| error.to_string())?;
    let mut faces = Vec::new();
    for (model, number) in models.iter().zip(0..) {
        let mesh = &model.mesh;
        let mut corner = |at: usize| {
            let layers = [
                (&mesh.positions, &mesh.indices, 3),
                (&mesh.vertex_color, &mesh.indices, 3),
                (&mesh.texcoords, &mesh.texcoord_indices, 2),
                (&mesh.normals, &mesh.normal_indices, 3),
            ];
            let mut record = Vec::new();
            for (values, indices, width) in layers {
                // A layer that the model does not have is empty.
                let index = indices.get(at).filter(|_| !values.is_empty());
                let start = index.map(|&index| index as usize * width);
                record.extend(start.map_or(&[][..], |start| &values[start..start + width]));
                record.push(f32::NAN);
            }
            numbers.of(bits(&record).collect())
        };
        for at in (0..mesh.indices.len()).step_by(3) {
            faces.push((number, vec![corner(at), corner(at + 1), corner(at + 2)]));
        }
    }
    Ok(sorted(faces))
}

/// A row of a PLY file: the vertices it names, and the bits of all else.
struct Row {
    corners: Vec<usize>,
    record: Vec<u64>,
}

impl PropertyAccess for Row {
    fn new() -> Self {
        let (corners, record) = (Vec::new(), Vec::new());
        Self { corners, record }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if matches!(name, "vertex_indices" | "vertex_index") {
            self.corners = indices(&property);
            return PropertyAccessResult::Set;
        }
        match property {
            Property::Float(value) => self.record.push(value.to_bits().into()),
            Property::Double(value) => self.record.push(value.to_bits()),
            Property::ListFloat(values) => self.record.extend(bits(&values)),
            Property::ListDouble(values) => self.record.extend(values.iter().map(|v| v.to_bits())),
            other => self
                .record
                .extend(whole_numbers(&other).map(i64::cast_unsigned)),
        }
        PropertyAccessResult::Set
    }
}

/// The values of a property of whole numbers.
fn whole_numbers(property: &Property) -> impl Iterator<Item = i64> {
    fn all<T: Copy + Into<i64>>(values: &[T]) -> Vec<i64> {
        values.iter().map(|&value| value.into()).collect()
    }
    match property {
        Property::Char(value) => all(&[*value]),
        Property::UChar(value) => all(&[*value]),
        Property::Short(value) => all(&[*value]),
        Property::UShort(value) => all(&[*value]),
        Property::Int(value) => all(&[*value]),
        Property::UInt(value) => all(&[*value]),
        Property::ListChar(values) => all(values),
        Property::ListUChar(values) => all(values),
        Property::ListShort(values) => all(values),
        Property::ListUShort(values) => all(values),
        Property::ListInt(values) => all(values),
        Property::ListUInt(values) => all(values),
        _ => unreachable!("fractions are taken before"),
    }
    .into_iter()
}

fn indices(property: &Property) -> Vec<usize> {
    whole_numbers(property)
        .map(|index| usize::try_from(index).expect("no index is negative"))
        .collect()
}

/// By `ply-rs-bw`: corners and faces with all their properties, polygons as they are.
fn ply(bytes: &[u8], numbers: &mut Numbers) -> Result<Vec<Face>, String> {
    let parser = Parser::<Row>::new();
    let mut read = parser
        .read_ply(&mut Cursor::new(bytes))
        .map_err(|error| error.to_string())?;
    let mut rows = |element: &str| read.payload.shift_remove(element).unwrap_or_default();
    let (vertices, faces) = (rows("vertex"), rows("face"));
    let vertices = vertices.into_iter().map(|row| numbers.of(row.record));
    let vertices: Vec<u32> = vertices.collect();
    let face = |row: Row| {
        let corners = row.corners.iter().map(|&corner| vertices[corner]);
        (numbers.of(row.record), corners.collect())
    };
    Ok(sorted(faces.into_iter().map(face).collect()))
}

/// By `stl_io`: positions, and faces with their normal.
fn stl(bytes: &[u8], numbers: &mut Numbers) -> Result<Vec<Face>, String> {
    let mut bytes = Cursor::new(bytes);
    let triangles = stl_io::create_stl_reader(&mut bytes).map_err(|error| error.to_string())?;
    let mut faces = Vec::new();
    for triangle in triangles {
        let triangle = triangle.map_err(|error| error.to_string())?;
        let mut number = |vector: stl_io::Vector<f32>| numbers.of(bits(&vector.0).collect());
        let corners = triangle.vertices.map(&mut number);
        faces.push((number(triangle.normal), corners.to_vec()));
    }
    Ok(sorted(faces))
}

fn unzipped(file: &Path) -> Vec<u8> {
    let bytes = std::fs::read(file).expect("the file can be read");
    if file.extension().is_none_or(|ending| ending != "gz") {
        return bytes;
    }
    let mut plain = Vec::new();
    flate2::read::MultiGzDecoder::new(&bytes[..])
        .read_to_end(&mut plain)
        .expect("the file is whole");
    plain
}

/// The file's bytes with all faces and vertices in another order.
fn reordered(file: &Path) -> Vec<u8> {
    let mut document = Document::open(file, Limits::default()).unwrap();
    for mesh in 0..document.meshes().len() {
        let mut entry = document.meshes()[mesh].clone();
        let algorithm = KCacheReorder {
            keep_corners: !entry.corners_turnable || entry.polygons.is_some(),
            ..Default::default()
        };
        let faces = entry.record_order(|mesh, polygons| match polygons {
            Some(starts) => algorithm.polygon_order(mesh, starts),
            None => algorithm.face_order(mesh),
        });
        entry.apply_faces(&faces);
        let group = entry.vertex_group;
        let members = document.meshes().iter().filter(|m| m.vertex_group == group);
        // Vertices that several meshes share would need an order for all of them.
        let movable = entry.vertices_movable && members.count() == 1;
        let vertices = movable.then(|| vertex_fetch(&entry.mesh));
        document
            .edit(Edit::order(mesh, &faces, vertices.as_ref()))
            .unwrap();
    }
    document.to_main_bytes().unwrap()
}

fn for_all_files(reader_name: &str, ending: &str, read: Reader) {
    let Some(data) = compare::data_folder() else {
        compare::say(&format!("{reader_name}: no test data, skipped all files"));
        return;
    };
    if Format::of_path(&PathBuf::from(format!("a.{ending}"))).is_none() {
        compare::say(&format!(
            "{reader_name}: SKIPPED, .{ending} is not read yet"
        ));
        return;
    }
    let (mut ran, mut moved, mut face_count, mut refused) = (0, 0, 0, Vec::new());
    for file in compare::mesh_files(&data) {
        let name = file
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if name.trim_end_matches(".gz").rsplit('.').next() != Some(ending) {
            continue;
        }
        let (source, result) = (unzipped(&file), reordered(&file));
        let mut numbers = Numbers::default();
        match read(&source, &mut numbers) {
            Err(error) => refused.push(format!("{name}: {error}")),
            Ok(before) => {
                let after = read(&result, &mut numbers).unwrap_or_else(|e| panic!("{name}: {e}"));
                // Not `assert_eq`, which would print millions of faces.
                assert!(before == after, "{name}: {reader_name} reads other faces");
                assert!(!before.is_empty(), "{name}: {reader_name} reads no faces");
                face_count += before.len();
                moved += usize::from(source != result);
                ran += 1;
            }
        }
    }
    compare::say(&format!(
        "{reader_name}: {ran} files, {moved} re-ordered, {face_count} faces, skipped {} that it \
         cannot read: {refused:?}",
        refused.len()
    ));
    assert!(moved > 0, "{reader_name}: no file was re-ordered");
}

#[test]
fn tobj_reads_the_same_triangles() {
    for_all_files("tobj", "obj", obj);
}

#[test]
fn ply_rs_reads_the_same_faces() {
    for_all_files("ply-rs-bw", "ply", ply);
}

#[test]
fn stl_io_reads_the_same_triangles() {
    for_all_files("stl_io", "stl", stl);
}
