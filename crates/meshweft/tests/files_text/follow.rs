//! Values follow the vertices and faces that they belong to.

use meshweft::attribute::{Attribute, AttributeInfo, Domain};
use meshweft::files::{Document, MeshEntry};
use meshweft::{FaceOrder, VertexOrder};

/// What the attributes of a mesh are called: name, domain, components, type, `n` if normalized.
pub(crate) fn listed(document: &Document, mesh: usize) -> Vec<String> {
    let text = |info: AttributeInfo| {
        let normalized = if info.is_normalized { " n" } else { "" };
        let AttributeInfo {
            semantic,
            domain,
            components,
            component_type,
            ..
        } = info;
        format!("{semantic} {domain:?} {components} {component_type:?}{normalized}")
    };
    document.attributes(mesh).into_iter().map(text).collect()
}

/// The values of the attribute that is listed first under this name.
pub(crate) fn values(document: &Document, mesh: usize, name: &str) -> Vec<f32> {
    let mut infos = document.attributes(mesh).into_iter();
    let info = infos.find(|info| info.semantic.to_string() == name);
    document.attribute(mesh, &info.unwrap()).unwrap().to_f32()
}

/// All attributes, each with as many elements as there are vertices, corners or faces.
pub(crate) fn all(document: &Document, mesh: usize) -> Vec<Attribute> {
    let shape = &document.meshes()[mesh].mesh;
    let infos = document.attributes(mesh).into_iter();
    let attributes = infos.map(|info| {
        let attribute = document.attribute(mesh, &info).unwrap();
        let expected = match info.domain {
            Domain::Vertex => shape.vertex_count(),
            Domain::Corner => shape.face_count() * 3,
            _ => shape.face_count(),
        };
        assert_eq!(attribute.len(), expected, "{info:?}");
        assert_eq!(attribute.info, info);
        attribute
    });
    attributes.collect()
}

/// Asserts that the attributes of a mesh are those of before, which had `entry`, in these orders.
pub(crate) fn assert_follow(
    before: &[Attribute],
    entry: &MeshEntry,
    after: &[Attribute],
    faces: &FaceOrder,
    vertices: Option<&VertexOrder>,
) {
    let whole: Vec<u32> = (0..=entry.record_count() as u32).collect();
    let starts = entry.polygons.as_ref().unwrap_or(&whole);
    let mut old_faces = Vec::new();
    for (slot, &record) in faces.new_to_old().iter().enumerate() {
        let faces_of = starts[record as usize]..starts[record as usize + 1];
        let rotation = usize::from(faces.rotation(slot));
        old_faces.extend(faces_of.map(|face| (face as usize, rotation)));
    }
    assert_eq!(before.len(), after.len());
    for (before, after) in before.iter().zip(after) {
        assert_eq!(before.info, after.info);
        let elements: Vec<usize> = match before.info.domain {
            Domain::Vertex => match vertices {
                Some(order) => order.new_to_old().iter().map(|&v| v as usize).collect(),
                None => (0..before.len()).collect(),
            },
            Domain::Corner => {
                let corners = |&(face, rotation): &(usize, usize)| {
                    [0, 1, 2].map(|corner| face * 3 + (corner + rotation) % 3)
                };
                old_faces.iter().flat_map(corners).collect()
            }
            _ => old_faces.iter().map(|&(face, _)| face).collect(),
        };
        let width = before.info.components;
        let bits = |numbers: &[f32]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        let (old, new) = (before.to_f32(), after.to_f32());
        let expected = elements.iter().flat_map(|&e| &old[e * width..][..width]);
        let expected: Vec<f32> = expected.copied().collect();
        assert_eq!(bits(&new), bits(&expected), "{:?}", before.info);
    }
}

/// Whether two lists of attributes are the same to the bit.
pub(crate) fn assert_same(a: &[Attribute], b: &[Attribute]) {
    // NaN is not itself, but is written the same.
    assert_eq!(format!("{a:?}"), format!("{b:?}"));
}
