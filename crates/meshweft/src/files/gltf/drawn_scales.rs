//! How large meshes are drawn: the scales of the nodes above them, and of the joints that move them.

use std::collections::{BTreeMap, BTreeSet};

use super::accessors::Accessors;
use super::elements::Elements;
use super::json::Value;
use super::object::Object;
use super::{GltfFile, read_json};
use crate::attribute::Values;
use crate::geometry::double::{add, dot, scaled};

/// Three columns: where a node takes the axes of what is below it.
type Axes = [[f64; 3]; 3];

const IDENTITY: Axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl GltfFile {
    /// See [`Content::drawn_scales`](crate::files::content::Content::drawn_scales). Time O(JSON log JSON).
    pub(super) fn found_scales(&self) -> Vec<f64> {
        let entries = &self.view.entries;
        let mut scales = vec![0.0_f64; entries.meshes.len()];
        // It was read before, and is an object.
        let json = read_json(&self.container, &self.options.limits);
        let root = json.as_ref().ok();
        let root = root.and_then(|json| Object::new(json.root(), String::new()).ok());
        if let Some(root) = root {
            let of_meshes = self.scales_of_meshes(&root);
            let firsts = entries.first_primitives.iter();
            let firsts = firsts
                .zip(&mut scales)
                .map(|(first, scale)| (first.mesh, scale));
            for (mesh, scale) in firsts {
                *scale = of_meshes.get(&(mesh as usize)).copied().unwrap_or(0.0);
            }
            for (other, first) in &entries.repeated {
                if let Some(mesh) = entries.mesh_of(*first) {
                    let other = of_meshes.get(&(other.mesh as usize)).copied();
                    scales[mesh] = scales[mesh].max(other.unwrap_or(0.0));
                }
            }
        }

        // What is not drawn, or has no size, is as large as it says.
        let is_size = |scale: f64| scale > 0.0 && scale.is_finite();
        let sizes = scales.into_iter();
        sizes.map(|it| if is_size(it) { it } else { 1.0 }).collect()
    }

    /// The largest scale that each glTF mesh is drawn with.
    fn scales_of_meshes(&self, root: &Object<'_>) -> BTreeMap<usize, f64> {
        let accessors = Accessors::new(root, &self.buffers, &[]).ok();
        let nodes: Vec<Value<'_>> = root.elements("nodes").collect();
        let skins: Vec<Value<'_>> = root.elements("skins").collect();
        let all_axes = &axes_of_nodes(&nodes);
        let mut of_skins: BTreeMap<usize, f64> = BTreeMap::new();
        let mut of_meshes: BTreeMap<usize, f64> = BTreeMap::new();
        for (node, axes) in nodes.iter().zip(all_axes) {
            let number = |name: &str| node.get(name).and_then(Value::whole);
            let Some(mesh) = number("mesh") else {
                continue;
            };
            // Joints move a mesh wherever its node is.
            let skin = number("skin").filter(|&skin| skin < skins.len());
            let scale = match skin {
                None => scale_of(axes),
                Some(skin) => *of_skins.entry(skin).or_insert_with(|| {
                    self.scale_of_skin(skins[skin], all_axes, accessors.as_ref())
                }),
            };
            let all = of_meshes.entry(mesh).or_insert(0.0);
            *all = all.max(scale);
        }
        of_meshes
    }

    /// The largest scale that a joint of a skin gives to what it moves.
    fn scale_of_skin(
        &self,
        skin: Value<'_>,
        axes: &[Axes],
        accessors: Option<&Accessors<'_>>,
    ) -> f64 {
        let joints = skin.get("joints").into_iter().flat_map(Value::elements);
        let joints: Vec<usize> = joints.filter_map(Value::whole).collect();
        let matrices = skin.get("inverseBindMatrices").and_then(Value::whole);
        let elements = matrices.and_then(|number| Elements::of(accessors?, number));
        let elements = elements.filter(|it| it.components() == 16);
        let values = elements.and_then(|it| it.values(&self.buffers, joints.len()).ok());
        let numbers = match values {
            Some(Values::F32(numbers)) => numbers,
            _ => Vec::new(),
        };
        let mut matrices = numbers
            .as_chunks::<16>()
            .0
            .iter()
            .map(|it| it.map(f64::from));
        let scales = joints.iter().map(|&joint| {
            let inverse = matrices.next().map_or(IDENTITY, |it| axes_of_matrix(&it));
            let above = axes.get(joint).copied().unwrap_or(IDENTITY);
            scale_of(&product(&above, &inverse))
        });
        scales.fold(0.0, f64::max)
    }
}

/// The axes of each node, those of all nodes above it with them.
fn axes_of_nodes(nodes: &[Value<'_>]) -> Vec<Axes> {
    let children = |node: Value<'_>| -> Vec<usize> {
        let children = node.get("children").into_iter().flat_map(Value::elements);
        let children = children.filter_map(Value::whole);
        children.filter(|&child| child < nodes.len()).collect()
    };
    let mut axes: Vec<Axes> = nodes.iter().map(|&node| own_axes(node)).collect();
    let with_parent: BTreeSet<usize> = nodes.iter().flat_map(|&node| children(node)).collect();

    // Top down; what is below itself, in a file that is not sound, is left as it is.
    let mut is_met = vec![false; nodes.len()];
    let mut open: Vec<usize> = (0..nodes.len())
        .filter(|node| !with_parent.contains(node))
        .collect();
    while let Some(node) = open.pop() {
        for child in children(nodes[node]) {
            if !std::mem::replace(&mut is_met[child], true) {
                axes[child] = product(&axes[node], &axes[child]);
                open.push(child);
            }
        }
    }
    axes
}

/// The axes of a node alone.
fn own_axes(node: Value<'_>) -> Axes {
    let numbers = |name: &str| -> Vec<f64> {
        let numbers = node.get(name).into_iter().flat_map(Value::elements);
        numbers.map(|it| it.raw().parse().unwrap_or(0.0)).collect()
    };
    if let Ok(matrix) = <[f64; 16]>::try_from(numbers("matrix")) {
        return axes_of_matrix(&matrix);
    }
    let [x, y, z, w] = numbers("rotation")
        .try_into()
        .unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let scale: [f64; 3] = numbers("scale").try_into().unwrap_or([1.0; 3]);
    let rotation = [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y + w * z),
            2.0 * (x * z - w * y),
        ],
        [
            2.0 * (x * y - w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z + w * x),
        ],
        [
            2.0 * (x * z + w * y),
            2.0 * (y * z - w * x),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ];
    [0, 1, 2].map(|axis| scaled(rotation[axis], scale[axis]))
}

/// The first three numbers of the first three columns.
fn axes_of_matrix(matrix: &[f64; 16]) -> Axes {
    [0, 4, 8].map(|start| [0, 1, 2].map(|row| matrix[start + row]))
}

/// What `inner` makes of the axes, and `outer` of these.
fn product(outer: &Axes, inner: &Axes) -> Axes {
    inner.map(|column| {
        let parts = [0, 1, 2].map(|axis| scaled(outer[axis], column[axis]));
        add(add(parts[0], parts[1]), parts[2])
    })
}

/// The length of the longest axis.
fn scale_of(axes: &Axes) -> f64 {
    let lengths = axes.iter().map(|&axis| dot(axis, axis).sqrt());
    lengths.fold(0.0, f64::max)
}
