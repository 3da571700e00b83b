//! Made files with levels of detail, as they are written: each level's vertices are the first ones of each view.

use serde_json::{Value, json};

use crate::Random;
use crate::builder::{Builder, F32, U8, U16};

/// How many of the vertices of each primitive the levels need, fine to coarse.
pub(crate) const PREFIXES: [[usize; 3]; 2] = [[900, 300, 60], [400, 120, 33]];

/// How a made file is stored.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Levelled {
    /// The component type of indices.
    pub(crate) indices: usize,
    /// Whether the attributes of a primitive stand in one view, vertex by vertex.
    pub(crate) is_interleaved: bool,
    pub(crate) has_skin: bool,
}

/// All ways.
pub(crate) fn all() -> Vec<Levelled> {
    let mut all = Vec::new();
    for indices in [U16, crate::builder::U32] {
        for is_interleaved in [false, true] {
            for has_skin in [false, true] {
                all.push(Levelled {
                    indices,
                    is_interleaved,
                    has_skin,
                });
            }
        }
    }
    all
}

/// A file, and the numbers of its views in the order in which a stream wants them.
pub(crate) struct Made {
    pub(crate) builder: Builder,
    pub(crate) meshes: Value,
    pub(crate) others: Value,
    pub(crate) wanted: Vec<usize>,
}

impl Made {
    pub(crate) fn glb(&self) -> Vec<u8> {
        self.builder.glb(&self.meshes, &self.others)
    }
}

/// Faces over the first `vertices` vertices, the last of which one has.
fn list(random: &mut Random, face_count: usize, vertices: usize) -> Vec<usize> {
    let numbers = (0..3 * face_count).map(|_| random.below(vertices));
    let mut numbers: Vec<usize> = numbers.collect();
    let last = numbers.len() - 1;
    numbers[last] = vertices - 1;
    numbers
}

/// Bytes of which none is 0.
fn bytes(random: &mut Random, count: usize) -> Vec<u8> {
    let byte = |_| u8::try_from(1 + random.below(120)).unwrap();
    (0..count).map(byte).collect()
}

/// A mesh of two primitives with levels 1 and 2, a mesh without levels, an image, an animation, a view that nothing
/// reads; all of it in an order that suits no stream.
pub(crate) fn made(kind: Levelled) -> Made {
    let random = &mut Random(11);
    let mut builder = Builder::default();

    // What a picture does not need.
    let image = builder.view(&bytes(random, 1501), None);
    let unread = builder.view(&bytes(random, 40), None);
    let animation = builder.view(&bytes(random, 5 * 16), None);
    let times = builder.accessor(animation, 0, F32, 4, "SCALAR");
    let turns = builder.accessor(animation, 16, F32, 4, "VEC4");

    // The primitives of the levels, fine to coarse, each with its vertices at the finest.
    let mut lists = [[0; 2]; 3];
    let mut vertex_views = Vec::new();
    let mut attributes = Vec::new();
    for level in 0..3 {
        for (primitive, prefixes) in PREFIXES.iter().enumerate() {
            let face_count = [1200, 400, 77][level];
            let numbers = list(random, face_count, prefixes[level]);
            let accessor = builder.indices(kind.indices, &numbers);
            lists[level][primitive] = accessor;
            if level == 0 {
                let views = &mut vertex_views;
                attributes.push(vertices(&mut builder, random, kind, prefixes[0], views));
            }
        }
    }

    // A mesh without levels, and the matrices of joints.
    let plain = builder.indices(U8, &list(random, 30, 20));
    let plain_positions = builder.data(F32, "VEC3", 20);
    let matrices = builder.view(&bytes(random, 2 * 64), None);
    let matrices_accessor = builder.accessor(matrices, 0, F32, 2, "MAT4");

    let primitives = |level: usize| -> Value {
        let primitive = |(list, attributes): (&usize, &(Value, Value))| {
            json!({
                "attributes": attributes.0, "targets": [attributes.1], "indices": list,
            })
        };
        lists[level]
            .iter()
            .zip(&attributes)
            .map(primitive)
            .collect()
    };
    let mut meshes: Vec<Value> = vec![json!({
        "name": "plain", "primitives": [{"attributes": {"POSITION": plain_positions}, "indices": plain}],
    })];
    meshes.extend((0..3).map(|level| json!({"primitives": primitives(level)})));
    let mut nodes = vec![
        json!({"mesh": 1, "extensions": {"MSFT_lod": {"ids": [1, 2]}}}),
        json!({"mesh": 2}),
        json!({"mesh": 3}),
        json!({"mesh": 0}),
    ];
    let mut others = json!({
        "extensionsUsed": ["MSFT_lod"],
        "scenes": [{"nodes": [0, 3]}],
        "images": [{"bufferView": image, "mimeType": "image/png"}],
        "animations": [{
            "channels": [{"sampler": 0, "target": {"node": 3, "path": "rotation"}}],
            "samplers": [{"input": times, "output": turns}],
        }],
    });
    if kind.has_skin {
        for node in &mut nodes[..3] {
            node["skin"] = json!(0);
        }
        others["skins"] = json!([{"joints": [3, 3], "inverseBindMatrices": matrices_accessor}]);
    }
    others["nodes"] = nodes.into();

    // In a stream: the coarsest picture, what it needs whole before that of which it needs a part.
    let view = |accessor: usize| {
        let view = builder.accessors[accessor]["bufferView"].as_u64();
        usize::try_from(view.unwrap()).unwrap()
    };
    let mut wanted = lists[2].map(view).to_vec();
    wanted.extend([plain, plain_positions].map(view));
    wanted.extend(kind.has_skin.then_some(matrices));
    wanted.extend(vertex_views);
    wanted.extend([lists[1], lists[0]].concat().into_iter().map(view));
    wanted.push(animation);
    // An accessor that nothing names may be read by something that is not known.
    wanted.extend((!kind.has_skin).then_some(matrices));
    wanted.extend([unread, image]);
    Made {
        builder,
        meshes: meshes.into(),
        others,
        wanted,
    }
}

/// Attributes and a morph target of `count` vertices.
fn vertices(
    builder: &mut Builder,
    random: &mut Random,
    kind: Levelled,
    count: usize,
    views: &mut Vec<usize>,
) -> (Value, Value) {
    let mut add = |builder: &mut Builder, size: usize, stride| {
        views.push(builder.view(&bytes(random, size), stride));
        views[views.len() - 1]
    };
    let [position, normal, coordinates] = match kind.is_interleaved {
        true => {
            let view = add(builder, count * 36, Some(36));
            let parts = [(0, "VEC3"), (12, "VEC3"), (24, "VEC2")];
            parts.map(|(offset, name)| builder.accessor(view, offset, F32, count, name))
        }
        false => [(12, "VEC3"), (12, "VEC3"), (8, "VEC2")].map(|(size, name)| {
            let view = add(builder, count * size, None);
            builder.accessor(view, 0, F32, count, name)
        }),
    };
    let moved = add(builder, count * 12, None);
    let moved = builder.accessor(moved, 0, F32, count, "VEC3");
    let attributes = json!({"POSITION": position, "NORMAL": normal, "TEXCOORD_0": coordinates});
    (attributes, json!({"POSITION": moved}))
}
