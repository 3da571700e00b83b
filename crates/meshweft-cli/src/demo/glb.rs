//! A mesh as a binary glTF: positions, normals, indices.

use meshweft::Mesh;
use meshweft::geometry::vertex_normals;
use serde_json::json;

/// The bytes of a GLB with this mesh alone.
pub(super) fn glb(mesh: &Mesh, name: &str) -> Vec<u8> {
    let positions = mesh.positions();
    let bound = |pick: fn(f32, f32) -> f32, start: f32| {
        let fold = |i: usize| positions.iter().map(|p| p[i]).fold(start, pick);
        [fold(0), fold(1), fold(2)]
    };
    let (min, max) = (bound(f32::min, f32::MAX), bound(f32::max, f32::MIN));

    // The buffer: positions, normals, indices.
    let mut binary: Vec<u8> = Vec::new();
    for value in positions
        .iter()
        .chain(&vertex_normals(positions, mesh.faces()))
        .flatten()
    {
        binary.extend(value.to_le_bytes());
    }
    for index in mesh.faces().iter().flatten() {
        binary.extend(index.to_le_bytes());
    }

    // The JSON that describes it.
    let (vertices, indices) = (positions.len(), mesh.face_count() * 3);
    let view = |start: usize, length: usize, target: u32| json!({"buffer": 0, "byteOffset": start, "byteLength": length, "target": target});
    let json = json!({
        "asset": {"version": "2.0", "generator": "meshweft demo"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": name}],
        "meshes": [{"name": name, "primitives": [
            {"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "mode": 4}
        ]}],
        "buffers": [{"byteLength": binary.len()}],
        "bufferViews": [
            view(0, vertices * 12, 34962),
            view(vertices * 12, vertices * 12, 34962),
            view(vertices * 24, indices * 4, 34963),
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3",
             "min": min, "max": max},
            {"bufferView": 1, "componentType": 5126, "count": vertices, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5125, "count": indices, "type": "SCALAR"},
        ],
    });

    // Both as chunks, filled up to whole words.
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let word = |n: usize| {
        u32::try_from(n)
            .expect("the demo's meshes are small")
            .to_le_bytes()
    };
    let mut glb = Vec::with_capacity(28 + json.len() + binary.len());
    glb.extend(b"glTF");
    glb.extend(2_u32.to_le_bytes());
    glb.extend(word(28 + json.len() + binary.len()));
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", binary)] {
        glb.extend(word(chunk.len()));
        glb.extend(kind);
        glb.extend(chunk);
    }
    glb
}
