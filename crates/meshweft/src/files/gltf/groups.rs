//! Which primitives share what, and so which faces and vertices can be moved.
//!
//! Records can be moved only together with all that reads them. So a primitive stays if its corners
//! are taken (see [`byte_users`](super::byte_users)), and primitives that share data are one group
//! with one vertex order.

use std::collections::BTreeMap;

use super::byte_users::{ByteUsers, UsedAs};
use super::movable::{Draws, Movable, Staying};
use super::obstacles::VertexObstacle;
use super::primitives::Primitives;
use super::strided_records::StridedRecords;

/// A number for each different set of vertex records, so that sets are compared once.
type SetNumber = usize;

/// Which primitives read some records as their vertices.
#[derive(Clone, Copy, PartialEq, Eq)]
enum VertexReaders {
    None,
    /// Only primitives without indices, all with this set of vertex records: they have the same
    /// faces.
    Triples(SetNumber),
    /// Any others.
    Mixed,
}

/// Makes those movable primitives stay whose faces cannot be re-ordered, or what else they draw cannot be
/// renumbered, for what they share.
///
/// # Complexity
/// Time O(n log n) in the accessors that primitives name: records are taken once at most.
pub(super) fn keep_entangled(primitives: &mut Primitives, byte_users: &mut ByteUsers) {
    let reasons = entangled(&primitives.movable, byte_users);
    if reasons.iter().all(Option::is_none) {
        return;
    }

    // Those that can still move get new numbers.
    let mut kept = 0..;
    let new_number = reasons.iter().map(|reason| match reason {
        None => kept.next(),
        Some(_) => None,
    });
    let new_number: Vec<Option<usize>> = new_number.collect();

    // The others stay.
    let mut numbers = new_number.iter();
    let stays = |_: &mut Movable| numbers.next().is_some_and(Option::is_none);
    let staying = primitives.movable.extract_if(.., stays);
    for (primitive, why) in staying.zip(reasons.into_iter().flatten()) {
        primitives.staying.push(Staying {
            number: primitive.number,
            why: match primitive.draws {
                Draws::Faces | Draws::FacesInOrder => why.into(),
                Draws::Other(why) => why.into(),
            },
            accessors: primitive.accessors,
        });
    }

    // Users are numbers of movable primitives, which have changed.
    for used in &mut byte_users.used {
        used.renumber_users(&new_number);
    }
}

/// For each primitive, why it cannot be changed, if so.
///
/// One that stays reads its data in the old order, so those who share it must stay as well: the
/// reasons spread until nothing changes.
fn entangled(movable: &[Movable], byte_users: &mut ByteUsers) -> Vec<Option<String>> {
    let readers = vertex_readers(movable, byte_users);
    let mut reasons: Vec<Option<String>> = vec![None; movable.len()];
    let mut to_check: Vec<usize> = (0..movable.len()).rev().collect();
    while let Some(user) = to_check.pop() {
        if reasons[user].is_some() {
            continue;
        }

        let primitive = &movable[user];
        reasons[user] = match &primitive.indices {
            Some(_) => entangled_indices(primitive, byte_users),
            None => entangled_triples(primitive, byte_users, &readers),
        };
        if reasons[user].is_none() {
            continue;
        }

        // It stays and takes all that it reads, so the other users are to be checked again.
        let lists = primitive.lists().map(|list| &list.records);
        let records = lists.chain(&primitive.vertices);
        for records in records.chain(sparse_records(primitive)) {
            let Some(found) = byte_users.find(records) else {
                continue;
            };
            let used = &mut byte_users.used[found];
            if used.taken_by.is_none() {
                used.taken_by = Some(primitive.number.pointer());
                to_check.extend(used.users());
            }
        }
    }
    reasons
}

/// For all used records, which primitives read them as their vertices.
fn vertex_readers(movable: &[Movable], byte_users: &ByteUsers) -> Vec<VertexReaders> {
    let sets = set_numbers(movable);
    let readers = byte_users.used.iter().map(|used| {
        let mut readers = VertexReaders::None;
        for &user in used.users_as(UsedAs::Vertices) {
            let one = match movable[user].indices {
                None => VertexReaders::Triples(sets[user]),
                Some(_) => VertexReaders::Mixed,
            };
            readers = match readers {
                VertexReaders::None => one,
                same if same == one => one,
                _ => VertexReaders::Mixed,
            };
        }
        readers
    });
    readers.collect()
}

/// The lists of numbers and of values of its sparse elements.
fn sparse_records(primitive: &Movable) -> impl Iterator<Item = &StridedRecords> {
    let sparse = primitive.sparse().iter();
    sparse.flat_map(|sparse| [&sparse.indices, &sparse.values])
}

/// Why the faces of a primitive with indices cannot be re-ordered: others read its indices.
fn entangled_indices(primitive: &Movable, byte_users: &ByteUsers) -> Option<String> {
    let found = byte_users.find(&primitive.indices.as_ref()?.records)?;
    let used = &byte_users.used[found];
    if let Some(by) = &used.taken_by {
        return Some(format!("its indices share bytes with {by}"));
    }
    (!used.has_one_use()).then(|| "its indices are also read as something else".to_owned())
}

/// Why the faces of a primitive without indices cannot be re-ordered: others read its vertices.
fn entangled_triples(
    primitive: &Movable,
    byte_users: &ByteUsers,
    readers: &[VertexReaders],
) -> Option<String> {
    let vertices = primitive.vertices.iter();
    for found in vertices.filter_map(|records| byte_users.find(records)) {
        let used = &byte_users.used[found];
        if let Some(by) = &used.taken_by {
            return Some(format!("its vertices share bytes with {by}"));
        }
        if !used.has_one_use() || readers[found] == VertexReaders::Mixed {
            return Some("its vertices are also read by other primitives".to_owned());
        }
    }
    None
}

/// For each primitive, the number of its set of vertex records.
fn set_numbers(movable: &[Movable]) -> Vec<SetNumber> {
    let mut numbers = BTreeMap::new();
    let mut set_numbers = Vec::with_capacity(movable.len());
    for primitive in movable {
        let next = numbers.len();
        set_numbers.push(*numbers.entry(&primitive.vertices).or_insert(next));
    }
    set_numbers
}

/// For each primitive, the number of its group: all that share data, directly or through others.
///
/// Groups are numbered by their first primitives, in the order of the file.
pub(super) fn group_numbers(movable: &[Movable], byte_users: &ByteUsers) -> Vec<usize> {
    // Join the users of each record (union-find).
    let mut parents: Vec<usize> = (0..movable.len()).collect();
    for used in &byte_users.used {
        let mut users = used.users();
        let Some(first) = users.next() else {
            continue;
        };
        for user in users {
            let (a, b) = (root_of(&mut parents, first), root_of(&mut parents, user));
            // The smaller number leads, so that the root is the first of its group.
            parents[a.max(b)] = a.min(b);
        }
    }

    // Number the groups by their roots.
    let mut numbers = BTreeMap::new();
    let number = |primitive| {
        let next = numbers.len();
        let root = root_of(&mut parents, primitive);
        *numbers.entry(root).or_insert(next)
    };
    (0..movable.len()).map(number).collect()
}

/// The root of a node's set; paths are halved on the way.
fn root_of(parents: &mut [usize], mut node: usize) -> usize {
    while parents[node] != node {
        parents[node] = parents[parents[node]];
        node = parents[node];
    }
    node
}

/// Why the vertices of an indexed primitive must stay, as far as itself and shared data tell.
///
/// `group_count` is the number of vertices that its group has.
pub(super) fn vertex_obstacle(
    primitive: &Movable,
    group_count: usize,
    byte_users: &ByteUsers,
) -> Option<VertexObstacle> {
    if let Some(obstacle) = primitive.vertex_obstacle() {
        return Some(obstacle.clone());
    }
    let why = shared_bytes(primitive, byte_users);
    let why = why.or_else(|| another_count(primitive, group_count));
    why.map(|why| VertexObstacle {
        pointer: primitive.number.pointer(),
        why,
    })
}

/// Why the vertices must stay: others read what a vertex order moves or renumbers.
fn shared_bytes(primitive: &Movable, byte_users: &ByteUsers) -> Option<String> {
    // What it moves or renumbers, and how the reason starts.
    let vertices = primitive.vertices.iter();
    let vertices = vertices.map(|records| (records, ["they share", "they are"]));
    let sparse = sparse_records(primitive);
    let sparse = sparse.map(|records| {
        let subject = ["their sparse data shares", "their sparse data is"];
        (records, subject)
    });
    let lists = primitive.other_lists();
    let lists = lists.map(|list| (&list.records, ["the outline shares", "the outline is"]));

    for (records, [shares, is]) in vertices.chain(sparse).chain(lists) {
        let Some(found) = byte_users.find(records) else {
            continue;
        };
        let used = &byte_users.used[found];
        if let Some(by) = &used.taken_by {
            return Some(format!("{shares} bytes with {by}"));
        }
        if !used.has_one_use() {
            return Some(format!("{is} also read as something else"));
        }
    }
    None
}

/// Why the vertices must stay: the group has another count of them, or the indices cannot name all.
fn another_count(primitive: &Movable, group_count: usize) -> Option<String> {
    if primitive.vertex_count != group_count {
        return Some("primitives that share data have different numbers of vertices".into());
    }

    let width = primitive
        .indices
        .as_ref()
        .map_or(4, |list| list.records.size);
    // The largest value of each type restarts a strip, so it is not a vertex.
    let most = match width {
        1 => usize::from(u8::MAX),
        2 => usize::from(u16::MAX),
        _ => usize::MAX,
    };
    (primitive.vertex_count > most).then(|| {
        let (bits, count) = (8 * width, primitive.vertex_count);
        format!("{bits}-bit indices do not reach all {count} of them")
    })
}
