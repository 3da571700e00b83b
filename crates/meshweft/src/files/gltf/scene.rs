//! Scenes and nodes: where a mesh is drawn, and new nodes.

use super::additions::Additions;
use super::json::Value;
use super::object::Object;
use crate::files::error::Problem;

/// A node that draws a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Drawn<'a> {
    pub(super) node: usize,
    pub(super) skin: Option<usize>,
    pub(super) scene: usize,
    /// What a node says of its mesh alone, and so not to its children: the JSON of the weights of morph
    /// targets, and of the extension that draws it many times.
    pub(super) weights: Option<&'a str>,
    pub(super) instances: Option<&'a str>,
}

/// The extension of a node that draws its mesh many times.
pub(super) const INSTANCES: &str = "EXT_mesh_gpu_instancing";

/// The scenes of a file, and the nodes that are to be added to them.
pub(super) struct Scenes<'a> {
    nodes: Vec<Value<'a>>,
    /// The scene that shows a node: the default one, or the first.
    scene_of: Vec<Option<usize>>,
    default: usize,
    scene_count: usize,
    names_default: bool,
    new_nodes: usize,
    /// New nodes at the root of a scene, and which.
    roots: Vec<(usize, usize)>,
}

impl<'a> Scenes<'a> {
    pub(super) fn new(root: &Object<'a>) -> Result<Self, Problem> {
        let (nodes, scenes) = (root.array("nodes")?, root.array("scenes")?);
        let default = root.number("scene")?;
        let mut all = Self {
            scene_of: vec![None; nodes.len()],
            nodes,
            default: default.filter(|&scene| scene < scenes.len()).unwrap_or(0),
            scene_count: scenes.len(),
            names_default: default.is_some(),
            new_nodes: 0,
            roots: Vec::new(),
        };

        // What the default scene shows counts as shown there.
        let numbered = scenes.iter().enumerate();
        let (first, others) = numbered.partition::<Vec<_>, _>(|&(i, _)| i == all.default);
        for (number, scene) in first.into_iter().chain(others) {
            all.visit(number, *scene);
        }
        Ok(all)
    }

    /// Marks the nodes that a scene shows and that no scene before has shown.
    fn visit(&mut self, number: usize, scene: Value<'_>) {
        let numbers = |holder: Value<'_>, name: &str| -> Vec<usize> {
            let list = holder.get(name).map(Value::elements);
            list.into_iter()
                .flatten()
                .filter_map(Value::whole)
                .collect()
        };
        let mut open = numbers(scene, "nodes");
        while let Some(node) = open.pop() {
            // A file that is not sound may have a node below itself.
            if let Some(scene @ None) = self.scene_of.get_mut(node) {
                *scene = Some(number);
                open.extend(numbers(self.nodes[node], "children"));
            }
        }
    }

    /// The first node that draws a mesh: of those in the default scene, else of those in any.
    pub(super) fn first_drawn(&self, mesh: u32) -> Option<Drawn<'a>> {
        let field = |node: Value<'_>, name: &str| node.get(name).and_then(Value::whole);
        let nodes = self.nodes.iter().zip(&self.scene_of).enumerate();
        let drawn = nodes.filter_map(|(number, (&node, &scene))| {
            let is_it = field(node, "mesh") == Some(mesh as usize);
            is_it.then_some(Drawn {
                node: number,
                skin: field(node, "skin"),
                scene: scene?,
                weights: node.get("weights").map(Value::raw),
                instances: node
                    .get("extensions")
                    .and_then(|extensions| extensions.get(INSTANCES))
                    .map(Value::raw),
            })
        });
        drawn.min_by_key(|drawn| (drawn.scene != self.default, drawn.node))
    }

    /// The number of one more node.
    pub(super) fn new_node(&mut self) -> usize {
        self.new_nodes += 1;
        self.nodes.len() + self.new_nodes - 1
    }

    /// Puts a new node at the root of a scene, or of the default one.
    pub(super) fn add_root(&mut self, node: usize, scene: Option<usize>) {
        self.roots.push((scene.unwrap_or(self.default), node));
    }

    /// Adds the roots, with a scene for them if there is none.
    pub(super) fn finish(self, additions: &mut Additions) {
        if self.scene_count > 0 {
            for (scene, node) in self.roots {
                let path = ["scenes", &scene.to_string(), "nodes", "-"];
                additions.value(path, node.to_string());
            }
            return;
        }
        if self.roots.is_empty() {
            return;
        }
        let nodes: Vec<String> = self
            .roots
            .iter()
            .map(|(_, node)| node.to_string())
            .collect();
        additions.element("scenes", format!(r#"{{"nodes":[{}]}}"#, nodes.join(",")));
        if !self.names_default {
            additions.value(["scene"], "0".to_owned());
        }
    }
}
