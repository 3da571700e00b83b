//! The updates as the papers write them, over maps and lists, to compare with.

use std::collections::{BTreeMap, BTreeSet};

use crate::permutation::FaceOrder;
use crate::progressive::history::{History, Record};

/// The sequence of each level, full resolution first.
pub(super) type Levels = Vec<Vec<u32>>;

/// The place of each face, by its number.
type Places = BTreeMap<u32, u32>;

fn vertices(face: [u32; 3]) -> BTreeSet<u32> {
    face.into_iter().collect()
}

fn common(history: &History, a: u32, b: u32) -> usize {
    let [a, b] = [a, b].map(|face| vertices(history.face(face)));
    a.intersection(&b).count()
}

/// The levels of an update that gives places: `give` has the places of the removed faces taken out of
/// `S'` and gives those of `S` to the inserted ones.
fn by_places(
    history: &History,
    order: &FaceOrder,
    give: impl Fn(&Record<'_>, Places, &mut Places),
) -> Levels {
    let mut places: Places = (order.new_to_old().iter().copied()).zip(0..).collect();
    let mut place_count = u32::try_from(order.len()).unwrap();
    let mut levels = vec![order.new_to_old().to_vec()];
    for record in history.records() {
        let removed = record.removed_faces.iter();
        let free = removed.map(|face| (*face, places.remove(face).unwrap()));
        let free: Places = free.collect();
        give(&record, free, &mut places);
        for face in record.inserted_faces {
            places.entry(face).or_insert_with(|| {
                place_count += 1;
                place_count - 1
            });
        }
        let faces: BTreeMap<u32, u32> =
            places.iter().map(|(&face, &place)| (place, face)).collect();
        assert_eq!(faces.len(), places.len(), "no place twice");
        levels.push(faces.into_values().collect());
    }
    levels
}

pub(super) fn simple(history: &History, order: &FaceOrder) -> Levels {
    by_places(history, order, |record, free, places| {
        let free: BTreeSet<u32> = free.into_values().collect();
        places.extend(record.inserted_faces.clone().zip(free));
    })
}

/// Fig. 5. `S` is what is free, `S'` what is placed, `t` and `T` are removed and inserted faces.
pub(super) fn smart(history: &History, order: &FaceOrder) -> Levels {
    by_places(history, order, |record, mut s, s_new| {
        let new = record.inserted_faces.clone();
        let mut t: Vec<u32> = record.removed_faces.to_vec();
        t.sort_by_key(|old| s[old]);
        let t = &t;

        // Assignment due to two common vertices.
        for new in new.clone() {
            for old in t {
                if common(history, new, *old) == 2 && s.contains_key(old) {
                    s_new.insert(new, s.remove(old).unwrap());
                    break;
                }
            }
        }

        // Initialization of adjacency lists.
        let mut lists: Vec<(u32, Vec<u32>)> = Vec::new();
        for new in new.clone().filter(|new| !s_new.contains_key(new)) {
            let old = t.iter().copied().filter(|old| s.contains_key(old));
            let old = old.filter(|&old| common(history, new, old) >= 1);
            lists.push((new, old.collect()));
        }

        // Assignment due to one common vertex.
        loop {
            lists.retain(|(_, list)| !list.is_empty());
            let Some((new, list)) = lists.iter().min_by_key(|(_, list)| list.len()) else {
                break;
            };
            let (new, head) = (*new, list[0]);
            s_new.insert(new, s.remove(&head).unwrap());
            for (face, list) in &mut lists {
                list.retain(|&old| old != head && *face != new);
            }
        }

        // Assign the remaining faces to whatever places are left.
        for new in new
            .filter(|new| !s_new.contains_key(new))
            .collect::<Vec<_>>()
        {
            if let Some(old) = t.iter().find(|old| s.contains_key(old)) {
                s_new.insert(new, s.remove(old).unwrap());
            }
        }
    })
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Item {
    Face(u32),
    Black(u32),
}

/// Vertices turn black behind the last of their faces; new faces go in front of the first of three.
pub(super) fn adaptive(history: &History, order: &FaceOrder) -> Levels {
    let full = order.new_to_old();
    let corners = |&face: &u32| history.face(face);
    let mut items = Vec::new();
    let mut black = BTreeSet::new();
    for (place, face) in full.iter().enumerate() {
        items.push(Item::Face(*face));
        for vertex in corners(face) {
            let mut later = full[place + 1..].iter().map(corners);
            if !later.any(|face| face.contains(&vertex)) && black.insert(vertex) {
                items.push(Item::Black(vertex));
            }
        }
    }

    let mut levels = vec![full.to_vec()];
    for record in history.records() {
        items.retain(|item| match item {
            Item::Face(face) => !record.removed_faces.contains(face),
            Item::Black(vertex) => !record.removed_vertices.contains(vertex),
        });
        for face in record.inserted_faces {
            let black = history.face(face).map(Item::Black);
            let first = items.iter().position(|item| black.contains(item));
            items.insert(first.unwrap_or(items.len()), Item::Face(face));
        }
        let faces = items.iter().filter_map(|item| match item {
            Item::Face(face) => Some(*face),
            Item::Black(_) => None,
        });
        levels.push(faces.collect());
    }
    levels
}
