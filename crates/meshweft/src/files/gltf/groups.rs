//! Which primitives share what, and so which faces and vertices can be moved.

use std::collections::BTreeMap;

use super::claims::Claims;
use super::primitives::{Draft, Left, Pin, Primitives};

/// A number for each set of streams, so that sets are compared once.
type SetNumber = usize;

/// Which primitives read a stream as their vertices.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Readers {
    None,
    /// Only primitives without indices, all with this same set of vertices.
    Triples(SetNumber),
    Mixed,
}

/// Moves the drafts whose faces cannot be re-ordered on their own to `left`.
///
/// One that stays reads its data in the old order, so those who share it must stay as well: the
/// reasons spread until nothing changes.
///
/// # Complexity
/// Time O(n log n) in the accessors that primitives name: each stream is taken once at most.
pub(super) fn leave_entangled(primitives: &mut Primitives, claims: &mut Claims) {
    let drafts = &primitives.drafts;
    let sets = set_numbers(drafts);
    let mut readers = vec![Readers::None; claims.streams.len()];
    for (stream, readers) in claims.streams.iter().zip(&mut readers) {
        for &user in &stream.vertex_users {
            let one = match drafts[user].indices {
                None => Readers::Triples(sets[user]),
                Some(_) => Readers::Mixed,
            };
            *readers = match *readers {
                Readers::None => one,
                same if same == one => one,
                _ => Readers::Mixed,
            };
        }
    }
    let mut reasons: Vec<Option<String>> = vec![None; drafts.len()];
    let mut to_check: Vec<usize> = (0..drafts.len()).rev().collect();
    while let Some(user) = to_check.pop() {
        if reasons[user].is_some() {
            continue;
        }
        let draft = &drafts[user];
        reasons[user] = match &draft.indices {
            Some(_) => entangled_indices(draft, claims),
            None => entangled_triples(draft, claims, &readers),
        };
        if reasons[user].is_none() {
            continue;
        }
        let sparse = draft.sparse().iter().flat_map(|s| [&s.indices, &s.values]);
        let lists = draft.lists().map(|list| &list.records);
        let records = lists.chain(&draft.vertices);
        let records = records.chain(sparse);
        for records in records {
            let Some(position) = claims.position(records) else {
                continue;
            };
            let stream = &mut claims.streams[position];
            if stream.taken_by.is_none() {
                stream.taken_by = Some(draft.position.pointer());
                to_check.extend(stream.users());
            }
        }
    }
    if reasons.iter().all(Option::is_none) {
        return;
    }
    // The numbers of the drafts that stay drafts change, so those of the users do too.
    let mut new_number = vec![None; reasons.len()];
    let mut kept = 0;
    let mut reasons = reasons.into_iter();
    let left = &mut primitives.left;
    let mut old = 0;
    primitives.drafts.retain_mut(|draft| {
        let reason = reasons.next().flatten();
        match reason {
            Some(why) => left.push(Left {
                position: draft.position,
                why: why.into(),
                accessors: std::mem::take(&mut draft.accessors),
            }),
            None => {
                new_number[old] = Some(kept);
                kept += 1;
            }
        }
        old += 1;
        new_number[old - 1].is_some()
    });
    for stream in &mut claims.streams {
        stream.renumber_users(&new_number);
    }
}

fn entangled_indices(draft: &Draft, claims: &Claims) -> Option<String> {
    let position = claims.position(&draft.indices.as_ref()?.records)?;
    let stream = &claims.streams[position];
    if let Some(by) = &stream.taken_by {
        return Some(format!("its indices share bytes with {by}"));
    }
    (!stream.is_of_one_kind()).then(|| "its indices are also read as something else".to_owned())
}

fn entangled_triples(draft: &Draft, claims: &Claims, readers: &[Readers]) -> Option<String> {
    for position in draft.vertices.iter().filter_map(|r| claims.position(r)) {
        let stream = &claims.streams[position];
        if let Some(by) = &stream.taken_by {
            return Some(format!("its vertices share bytes with {by}"));
        }
        if !stream.is_of_one_kind() || readers[position] == Readers::Mixed {
            return Some("its vertices are also read by other primitives".to_owned());
        }
    }
    None
}

fn set_numbers(drafts: &[Draft]) -> Vec<SetNumber> {
    let mut numbers = BTreeMap::new();
    let mut set_numbers = Vec::with_capacity(drafts.len());
    for draft in drafts {
        let next = numbers.len();
        set_numbers.push(*numbers.entry(&draft.vertices).or_insert(next));
    }
    set_numbers
}

/// For each draft the number of its group: drafts that share any data, by first draft.
pub(super) fn group_numbers(drafts: &[Draft], claims: &Claims) -> Vec<usize> {
    let mut parents: Vec<usize> = (0..drafts.len()).collect();
    for stream in &claims.streams {
        let mut users = stream.users();
        let Some(first) = users.next() else {
            continue;
        };
        for user in users {
            let (a, b) = (root_of(&mut parents, first), root_of(&mut parents, user));
            // The smaller number leads, so that groups come in the order of the file.
            parents[a.max(b)] = a.min(b);
        }
    }
    let mut numbers = BTreeMap::new();
    (0..drafts.len())
        .map(|draft| {
            let next = numbers.len();
            *numbers.entry(root_of(&mut parents, draft)).or_insert(next)
        })
        .collect()
}

fn root_of(parents: &mut [usize], mut node: usize) -> usize {
    while parents[node] != node {
        parents[node] = parents[parents[node]];
        node = parents[node];
    }
    node
}

/// Why the vertices of an indexed draft must stay, as far as shared data tells.
pub(super) fn vertex_pin(draft: &Draft, group_count: usize, claims: &Claims) -> Option<Pin> {
    if let Some(pin) = draft.pin() {
        return Some(pin.clone());
    }
    let pin = |why: String| {
        Some(Pin {
            pointer: draft.position.pointer(),
            why,
        })
    };
    for position in draft.vertices.iter().filter_map(|r| claims.position(r)) {
        let stream = &claims.streams[position];
        if let Some(by) = &stream.taken_by {
            return pin(format!("they share bytes with {by}"));
        }
        if !stream.is_of_one_kind() {
            return pin("they are also read as something else".into());
        }
    }
    let sparse = draft.sparse().iter().flat_map(|s| [&s.indices, &s.values]);
    for position in sparse.filter_map(|records| claims.position(records)) {
        let stream = &claims.streams[position];
        if let Some(by) = &stream.taken_by {
            return pin(format!("their sparse data shares bytes with {by}"));
        }
        if !stream.is_of_one_kind() {
            return pin("their sparse data is also read as something else".into());
        }
    }
    let outline = draft.outline().map(|list| &list.records);
    if let Some(stream) = outline.and_then(|r| claims.position(r)) {
        let stream = &claims.streams[stream];
        if let Some(by) = &stream.taken_by {
            return pin(format!("the outline shares bytes with {by}"));
        }
        if !stream.is_of_one_kind() {
            return pin("the outline is also read as something else".into());
        }
    }
    if draft.vertex_count != group_count {
        return pin("primitives that share data have different numbers of vertices".into());
    }
    let width = draft.indices.as_ref().map_or(4, |list| list.records.size);
    // The largest value of each type restarts a strip, so it is no vertex.
    let most = match width {
        1 => usize::from(u8::MAX),
        2 => usize::from(u16::MAX),
        _ => usize::MAX,
    };
    match draft.vertex_count > most {
        true => pin(format!(
            "{}-bit indices do not reach all {} of them",
            8 * width,
            draft.vertex_count
        )),
        false => None,
    }
}
