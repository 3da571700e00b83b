//! Nodes that stand in for a node where its mesh is a level of detail, and the animations that move them.
//!
//! A node with levels is replaced as a whole, with what is below it. So each of its levels has copies of the nodes below
//! it that draw something, at the same level.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::json;

use super::json::Value;
use super::levels::NAME;
use super::new_meshes::NewMeshes;
use super::object::Object;
use crate::files::error::{Place, Problem};
use crate::files::note::Note;

/// What extras of a node say with the extension.
const COVERAGE: &str = "MSFT_screencoverage";

/// The meshes that are the levels of one, and how much of a picture each covers at least, the full one first.
pub(super) struct LeveledMesh {
    pub(super) meshes: Vec<usize>,
    pub(super) coverages: Vec<f64>,
}

/// The nodes of a file, and which of their meshes have levels.
pub(super) struct LevelNodes<'a> {
    root: &'a Object<'a>,
    nodes: Vec<Value<'a>>,
    leveled: &'a BTreeMap<usize, LeveledMesh>,
    /// The copies of each node.
    copies: BTreeMap<usize, Vec<usize>>,
    /// How many copies of nodes below others there may be yet: nested ones would be copied for each node above.
    left: usize,
}

impl<'a> LevelNodes<'a> {
    pub(super) fn new(
        root: &'a Object<'a>,
        leveled: &'a BTreeMap<usize, LeveledMesh>,
    ) -> Result<Self, Problem> {
        let nodes = root.array("nodes")?;
        Ok(Self {
            left: 1024 + 8 * nodes.len(),
            root,
            nodes,
            leveled,
            copies: BTreeMap::new(),
        })
    }

    /// Adds all nodes, and what animations say of them.
    pub(super) fn add_to(mut self, new: &mut NewMeshes<'_>) -> Vec<Note> {
        let mut notes = Vec::new();
        for number in 0..self.nodes.len() {
            let Some(leveled) = self.levels_of(number) else {
                continue;
            };
            let below = self.drawn_below(number);
            let count = leveled.meshes.len();
            let needed = below.len().saturating_mul(count);
            if needed > self.left {
                let place = Place::Json(format!("/nodes/{number}"));
                let text =
                    "it gets no levels: too many nodes below it and others would be needed again";
                notes.push(Note::new(place, text));
                continue;
            }
            self.left -= needed;

            // The nodes that stand in for it.
            let ids = (1..=count).map(|level| self.copy(number, level, &below, new));
            let ids: Vec<usize> = ids.collect();
            let name = number.to_string();
            let path = ["nodes", &name, "extensions", NAME];
            new.value(path, json!({ "ids": ids }).to_string());

            // Extras of other kinds stay as they are, and so does what is stated there.
            let extras = self.nodes[number].get("extras");
            let takes = |extras: Value<'_>| extras.is_object() && extras.get(COVERAGE).is_none();
            if extras.is_none_or(takes) {
                let path = ["nodes", &name, "extras", COVERAGE];
                new.value(path, json!(leveled.coverages).to_string());
            }
        }
        self.animate(new);
        notes
    }

    /// The levels of the mesh that a node draws.
    fn levels_of(&self, node: usize) -> Option<&'a LeveledMesh> {
        let mesh = self.nodes[node].get("mesh")?.whole()?;
        self.leveled.get(&mesh)
    }

    fn children(&self, node: usize) -> impl Iterator<Item = usize> + use<'a> {
        let count = self.nodes.len();
        let children = self.nodes[node].get("children").into_iter();
        let children = children.flat_map(Value::elements).filter_map(Value::whole);
        children.filter(move |&child| child < count)
    }

    /// The nodes below one that draw something, or have such below them.
    fn drawn_below(&self, node: usize) -> BTreeSet<usize> {
        // Top down; a file that is not sound may have a node below itself.
        let mut parents: BTreeMap<usize, usize> = BTreeMap::new();
        let mut met = Vec::new();
        let mut open = vec![node];
        while let Some(parent) = open.pop() {
            for child in self.children(parent) {
                if child != node && !parents.contains_key(&child) {
                    parents.insert(child, parent);
                    met.push(child);
                    open.push(child);
                }
            }
        }

        // Bottom up.
        let mut drawn = BTreeSet::new();
        for &below in met.iter().rev() {
            let draws = self.nodes[below].get("mesh").is_some() || drawn.contains(&below);
            if draws {
                drawn.insert(below);
                drawn.insert(parents[&below]);
            }
        }
        drawn.remove(&node);
        drawn
    }

    /// Adds a node as one is with its mesh at a level, and those `below` it; its number.
    fn copy(
        &mut self,
        node: usize,
        level: usize,
        below: &BTreeSet<usize>,
        new: &mut NewMeshes<'_>,
    ) -> usize {
        // All numbers first: a node names those below it.
        let sources = [node].into_iter().chain(below.iter().copied());
        let numbered: Vec<(usize, usize)> = sources.map(|it| (it, new.new_node())).collect();
        let number_of: BTreeMap<usize, usize> = numbered.iter().copied().collect();
        let mut has_parent = BTreeSet::from([node]);
        for &(source, number) in &numbered {
            let children = self.children(source);
            let children = children.filter(|child| has_parent.insert(*child));
            let children = children.filter_map(|child| number_of.get(&child).copied());
            let children: Vec<usize> = children.collect();
            new.node(self.text(source, level, &children));
            self.copies.entry(source).or_default().push(number);
        }
        numbered[0].1
    }

    /// The text of a node at a level.
    fn text(&self, node: usize, level: usize, children: &[usize]) -> String {
        let source = self.nodes[node];
        let mesh = self.levels_of(node).map(|leveled| {
            let last = leveled.meshes.len();
            leveled.meshes[level.min(last) - 1]
        });
        let mut members = Vec::new();
        members.extend(level_name(source, level));
        for (name, value) in source.members() {
            match (&*name, mesh) {
                ("name" | "children" | "extras", _) => {}
                ("mesh", Some(mesh)) => members.push(format!(r#""mesh":{mesh}"#)),
                ("extensions", _) => members.extend(extensions_without(value, &[NAME])),
                _ => members.push(member(&name, value.raw())),
            }
        }
        if !children.is_empty() {
            members.push(format!(r#""children":{}"#, json!(children)));
        }
        format!("{{{}}}", members.join(","))
    }

    /// What moves a node moves its copies.
    fn animate(&self, new: &mut NewMeshes<'_>) {
        for (number, animation) in self.root.elements("animations").enumerate() {
            let number = number.to_string();
            let channels = animation.get("channels");
            for channel in channels.into_iter().flat_map(Value::elements) {
                let Some(moved) = MovedNode::of(channel) else {
                    continue;
                };
                let copies = self.copies.get(&moved.node);
                for &copy in copies.into_iter().flatten() {
                    let path = ["animations", &number, "channels", "-"];
                    new.value(path, moved.channel_of(channel, copy));
                }
            }
        }
    }
}

/// A member of an object.
pub(super) fn member(name: &str, raw: &str) -> String {
    format!("{}:{raw}", serde_json::Value::from(name))
}

/// The members of an object but those of these names, each with its text.
pub(super) fn members_without(object: Value<'_>, left_out: &[&str]) -> Vec<String> {
    let kept = object.members();
    let kept = kept.filter(|(name, _)| !left_out.contains(&&**name));
    kept.map(|(name, value)| member(&name, value.raw()))
        .collect()
}

/// The member with all extensions but those of these names, if others are left.
pub(super) fn extensions_without(extensions: Value<'_>, left_out: &[&str]) -> Option<String> {
    let kept = members_without(extensions, left_out);
    (!kept.is_empty()).then(|| format!(r#""extensions":{{{}}}"#, kept.join(",")))
}

/// The member that says what a level of this mesh or node is called, if that has a name.
pub(super) fn level_name(source: Value<'_>, level: usize) -> Option<String> {
    let name = source.get("name")?.text()?;
    let name = serde_json::Value::from(format!("{name}_LOD{level}"));
    Some(format!(r#""name":{name}"#))
}

/// The extension of a channel's target that names what it moves by a pointer.
const POINTER: &str = "KHR_animation_pointer";

/// The node that a channel of an animation moves.
struct MovedNode<'a> {
    node: usize,
    target: Value<'a>,
    /// What follows the number of the node in the pointer, if it is named by one.
    rest: Option<String>,
}

impl<'a> MovedNode<'a> {
    fn of(channel: Value<'a>) -> Option<Self> {
        let target = channel.get("target")?;
        let pointer = target.get("extensions").and_then(|all| all.get(POINTER));
        let pointer = pointer.and_then(|it| it.get("pointer")?.text());
        let Some(pointer) = pointer else {
            let node = target.get("node")?.whole()?;
            let rest = None;
            return Some(Self { node, target, rest });
        };
        let (node, rest) = pointer.strip_prefix("/nodes/")?.split_once('/')?;
        let (node, rest) = (node.parse().ok()?, Some(rest.to_owned()));
        Some(Self { node, target, rest })
    }

    /// The text of a channel that moves another node alike.
    fn channel_of(&self, channel: Value<'a>, node: usize) -> String {
        let with = |holder: Value<'a>, name: &str, text: String| -> String {
            let members = holder.members().map(|(member_name, value)| {
                let is_it = member_name == name;
                member(&member_name, if is_it { &text } else { value.raw() })
            });
            let members: Vec<String> = members.collect();
            format!("{{{}}}", members.join(","))
        };
        let target = match (&self.rest, self.target.get("extensions")) {
            (Some(rest), Some(extensions)) => {
                let pointer = json!({ "pointer": format!("/nodes/{node}/{rest}") });
                let extensions = with(extensions, POINTER, pointer.to_string());
                with(self.target, "extensions", extensions)
            }
            _ => with(self.target, "node", node.to_string()),
        };
        with(channel, "target", target)
    }
}
