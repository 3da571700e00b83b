//! What is stored with vertices: in memory, in a file, and in damaged files.

use std::io::Cursor;

use super::stored::reseal;
use super::tests::{camera, examples};
use super::{FastMesh, StreamedFront, VertexHierarchy};
use crate::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use crate::limits::Limits;
use crate::lod::HierarchyError;
use crate::mesh::Mesh;
use crate::random::{SplitMix64, from_environment};

/// Something for each vertex, in several types, besides what there is.
fn with_more(mut attributes: Vec<Attribute>, mesh: &Mesh) -> Vec<Attribute> {
    let vertices = || 0..u16::try_from(mesh.vertex_count()).unwrap();
    let normals: Vec<[f32; 3]> = vertices().map(|v| [f32::from(v), -0.0, f32::NAN]).collect();
    attributes.push(Attribute::of_vertices(Semantic::Normal, &normals));
    let mut info = AttributeInfo::new(Semantic::Color(1), Domain::Vertex, 4, ComponentType::U8);
    info.is_normalized = true;
    let colors = vertices().flat_map(|v| [v.to_le_bytes()[0], v.to_le_bytes()[1], 7, 255]);
    attributes.push(Attribute::new(info, Values::U8(colors.collect())));
    let name = Semantic::Other("height".into());
    let info = AttributeInfo::new(name, Domain::Vertex, 1, ComponentType::F64);
    let heights = vertices().map(|v| 0.1 * f64::from(v)).collect();
    attributes.push(Attribute::new(info, Values::F64(heights)));
    // Neither is of vertices alone.
    let positions = Attribute::of_vertices(Semantic::Position, mesh.positions());
    let info = AttributeInfo::new(Semantic::Normal, Domain::Face, 1, ComponentType::U8);
    attributes.extend([positions, Attribute::new(info, Values::U8(vec![]))]);
    attributes
}

#[test]
fn attributes_come_back_bit_for_bit() {
    for (name, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let all = with_more(attributes, &mesh);
        let plain = hierarchy.to_bytes().len();
        let hierarchy = hierarchy.with_attributes(&all).unwrap().with_name("näme");
        let kept = &all[..all.len() - 2];
        let bytes = hierarchy.to_bytes();
        let row: usize = kept
            .iter()
            .map(|it| it.info.components * it.info.component_type.size())
            .sum();
        assert!(
            bytes.len() >= plain + row * hierarchy.vertex_count(),
            "{name}"
        );

        // Each vertex has what its source has, from memory and from a file, as far as it was read.
        let whole = VertexHierarchy::from_bytes(&bytes, Limits::default()).unwrap();
        let mut streamed = StreamedFront::open(Cursor::new(&bytes), Limits::default()).unwrap();
        streamed
            .update(&camera(&mut SplitMix64(4), 25.0), 1.0)
            .unwrap();
        let drawn: Vec<u32> = streamed.front().vertices().collect();
        let every: Vec<u32> = (0..).take(hierarchy.vertex_count()).collect();
        for (found, vertices) in [
            (&hierarchy, &every),
            (&whole, &every),
            (streamed.front().hierarchy(), &drawn),
        ] {
            assert_eq!(
                (found.name(), found.attributes().len()),
                ("näme", kept.len())
            );
            for (number, attribute) in kept.iter().enumerate() {
                assert_eq!(found.attributes()[number], attribute.info, "{name}");
                let values = found.attribute(number, vertices).values.to_le_bytes();
                let size = values.len() / vertices.len();
                let source = attribute.values.to_le_bytes();
                for (value, &vertex) in values.chunks(size).zip(vertices) {
                    let from = found.source_vertices()[vertex as usize] as usize * size;
                    assert_eq!(value, &source[from..from + size], "{name} {vertex}");
                }
            }
        }
        assert!(whole.to_bytes() == bytes, "{name}");
    }
}

#[test]
fn attributes_are_of_all_vertices() {
    let (_, mesh, _) = examples().swap_remove(0);
    let hierarchy = FastMesh::default().build(&mesh, &[]).unwrap();
    let short = vec![[0.0_f32; 3]; mesh.vertex_count() - 1];
    let short = Attribute::of_vertices(Semantic::Normal, &short);
    let error = hierarchy.with_attributes(&[short]).unwrap_err();
    let expected = "attribute of vertices: expected 961 entries, found 960";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn damaged_attributes_are_an_error_or_some_values_and_never_a_panic() {
    let cases = from_environment("MESHWEFT_CASES", 1000);
    let mut random = SplitMix64(from_environment("MESHWEFT_SEED", 5));
    let mut files = Vec::new();
    for (_, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let hierarchy = hierarchy.with_attributes(&with_more(attributes, &mesh));
        files.push(hierarchy.unwrap().with_name("a name").to_bytes());
    }
    let (mut errors, mut meshes) = (0, 0);
    for _ in 0..cases {
        let mut bytes = files[random.below(files.len())].clone();
        // What rows are stands at the end of the head.
        let head = 13 + u32::from_le_bytes(bytes[5..9].try_into().unwrap()) as usize;
        for _ in 0..1 + random.below(3) {
            let at = match random.below(3) {
                0 => random.below(bytes.len()),
                _ => head - 1 - random.below(60.min(head)),
            };
            bytes[at] = match random.below(2) {
                0 => u8::try_from(random.below(256)).unwrap(),
                _ => bytes[at] ^ 1 << random.below(8),
            };
        }
        reseal(&mut bytes);
        let view = camera(&mut random, 25.0);
        let walked =
            StreamedFront::open(Cursor::new(&bytes), Limits::default()).and_then(|mut front| {
                front.update(&view, 1.0)?;
                let drawn: Vec<u32> = front.front().vertices().collect();
                let hierarchy = front.front().hierarchy();
                let mut size = 0;
                for number in 0..hierarchy.attributes().len() {
                    let attribute = hierarchy.attribute(number, &drawn);
                    assert_eq!(attribute.len(), drawn.len());
                    size += attribute.values.to_le_bytes().len();
                }
                assert!(size <= bytes.len(), "more than the file has");
                Ok(())
            });
        match walked {
            Ok(()) => meshes += 1,
            Err(HierarchyError::Read(error)) => panic!("all was in memory: {error}"),
            Err(HierarchyError::Decode(_)) => errors += 1,
        }
    }
    assert!(
        errors > cases / 8 && meshes > cases / 8,
        "{errors} errors, {meshes} meshes"
    );
}
