//! At which levels of detail each mesh of a file is drawn.
//!
//! At level 0 everything is drawn in full. At level 1 each node with `MSFT_lod` is replaced by the first that it names, with
//! all below it; and so on. A node that names fewer is replaced by its last at all coarser levels.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use super::json::Value;
use super::levels::{ids, replacing};
use super::object::Object;

/// For each mesh of a file at which levels it is drawn.
#[derive(Debug)]
pub(super) struct DrawnLevels {
    /// The coarsest level of any mesh; 0 if there are none.
    pub(super) coarsest: usize,
    /// Those that are not drawn at all levels.
    of_mesh: BTreeMap<usize, RangeInclusive<usize>>,
}

impl DrawnLevels {
    /// What the nodes of a file say. Those that are not sound say nothing.
    ///
    /// # Complexity
    /// Time O(n log n) and space O(n) in the nodes and what they name.
    pub(super) fn new(root: &Object) -> Self {
        let nodes: Vec<Value<'_>> = root.elements("nodes").collect();

        // The nodes with levels, and those that replace them, each with its levels. A level has none itself.
        let replaces = replacing(&nodes);
        let heads = nodes.iter().zip(&replaces).enumerate();
        let heads = heads.filter(|(_, (_, replaces))| !**replaces);
        let mut replacements: Vec<(usize, usize, Option<usize>)> = Vec::new();
        let mut coarsest = 0;
        for (head, (&node, _)) in heads {
            let named = (1..=nodes.len()).zip(ids(node));
            let named = named.filter_map(|(level, id)| Some((level, id?)));
            let mut last = None;
            let mut named: Vec<(usize, usize)> =
                named.filter(|(_, id)| *id < nodes.len()).collect();
            coarsest = named
                .last()
                .map_or(coarsest, |&(level, _)| coarsest.max(level));
            named.insert(0, (0, head));
            if named.len() > 1 {
                for (level, id) in named.into_iter().rev() {
                    replacements.push((id, level, last));
                    last = level.checked_sub(1);
                }
            }
        }
        let replacements = replacements.into_iter();
        let mut starts: Vec<(usize, usize, usize)> = replacements
            .map(|(node, first, last)| (node, first, last.unwrap_or(coarsest)))
            .collect();

        // All below them are drawn with them: the finest and the coarsest level that reaches each node.
        starts.sort_unstable_by_key(|&(_, first, _)| first);
        let firsts = flooded(&nodes, starts.iter().map(|&(node, first, _)| (node, first)));
        starts.sort_unstable_by_key(|&(_, _, last)| std::cmp::Reverse(last));
        let lasts = flooded(&nodes, starts.iter().map(|&(node, _, last)| (node, last)));

        // The meshes.
        let mut of_mesh: BTreeMap<usize, RangeInclusive<usize>> = BTreeMap::new();
        for ((node, first), last) in nodes.iter().zip(firsts).zip(lasts) {
            let Some(mesh) = node.get("mesh").and_then(Value::whole) else {
                continue;
            };
            let (first, last) = (first.unwrap_or(0), last.unwrap_or(coarsest));
            let levels = of_mesh.entry(mesh).or_insert(first..=last);
            *levels = first.min(*levels.start())..=last.max(*levels.end());
        }
        of_mesh.retain(|_, levels| *levels != (0..=coarsest));
        Self { coarsest, of_mesh }
    }

    /// The levels at which a mesh is drawn; `None` if it is drawn at all of them, or by no node.
    pub(super) fn of(&self, mesh: usize) -> Option<RangeInclusive<usize>> {
        self.of_mesh.get(&mesh).cloned()
    }
}

/// For each node the level of the first of `starts` that is the node itself or above it.
fn flooded(
    nodes: &[Value<'_>],
    starts: impl Iterator<Item = (usize, usize)>,
) -> Vec<Option<usize>> {
    let mut found = vec![None; nodes.len()];
    for (start, level) in starts {
        let mut open = vec![start];
        while let Some(node) = open.pop() {
            // A file that is not sound may have a node below itself.
            if let Some(found @ None) = found.get_mut(node) {
                *found = Some(level);
                let children = nodes[node].get("children").into_iter();
                open.extend(children.flat_map(Value::elements).filter_map(Value::whole));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::json::Json;
    use super::*;
    use crate::limits::Limits;

    /// The levels of meshes 0 to 5, of nodes in a file.
    fn levels(nodes: &str) -> (usize, Vec<Option<RangeInclusive<usize>>>) {
        let text = format!(r#"{{"nodes": {nodes}}}"#);
        let json = Json::read(text.as_bytes(), &Limits::default());
        let json = json.unwrap_or_else(|_| panic!("{text} is sound"));
        let root = Object::new(json.root(), String::new()).unwrap();
        let drawn = DrawnLevels::new(&root);
        let of = (0..6).map(|mesh| drawn.of(mesh)).collect();
        (drawn.coarsest, of)
    }

    #[test]
    fn a_mesh_is_drawn_up_to_the_next_coarser_one() {
        let nodes = r#"[
            {"mesh": 0, "extensions": {"MSFT_lod": {"ids": [1, 2, 3]}}},
            {"mesh": 1}, {"mesh": 2}, {"mesh": 3},
            {"mesh": 4, "extensions": {"MSFT_lod": {"ids": [99, 5, 99]}}}, {"mesh": 5}
        ]"#;
        let of = [0..=0, 1..=1, 2..=2, 3..=3, 0..=1, 2..=3].map(Some);
        assert_eq!(levels(nodes), (3, of.to_vec()));
        let plain = r#"[{"mesh": 0}, {"mesh": 1, "extensions": {"MSFT_lod": {"ids": [77]}}}]"#;
        assert_eq!(levels(plain), (0, vec![None; 6]));
    }

    #[test]
    fn what_is_below_a_node_is_drawn_with_it() {
        // Mesh 1 is below the full one, mesh 2 below both, mesh 3 below a level, mesh 4 elsewhere.
        let nodes = r#"[
            {"mesh": 0, "children": [2, 3], "extensions": {"MSFT_lod": {"ids": [1]}}},
            {"mesh": 5, "children": [4, 5]},
            {"mesh": 1}, {"mesh": 2}, {"mesh": 2}, {"mesh": 3, "children": [1]},
            {"mesh": 4}
        ]"#;
        let of = vec![
            Some(0..=0),
            Some(0..=0),
            None,
            Some(1..=1),
            None,
            Some(1..=1),
        ];
        assert_eq!(levels(nodes), (1, of));
    }

    #[test]
    fn a_mesh_that_is_also_drawn_alone_is_drawn_at_all_levels() {
        let nodes = r#"[
            {"mesh": 0, "extensions": {"MSFT_lod": {"ids": [1]}}}, {"mesh": 1}, {"mesh": 0}
        ]"#;
        let (coarsest, of) = levels(nodes);
        assert_eq!((coarsest, &of[..2]), (1, &[None, Some(1..=1)][..]));
    }
}
