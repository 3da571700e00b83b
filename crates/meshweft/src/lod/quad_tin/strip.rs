//! Faces as one triangle strip.

use super::descent::TinSurface;

impl TinSurface {
    /// The faces as one strip of vertices, in their order: of three vertices in a row each is a face, every second one turned,
    /// and those that name a vertex twice are none. Where the curve turns, a vertex is repeated; where the surface has a hole, up to four.
    ///
    /// # Complexity
    /// Time and space O(faces).
    #[must_use]
    pub fn strip(&self) -> Vec<u32> {
        let mut strip = Vec::new();
        // The last side of the strip, if the next face has it.
        let mut side: Option<[u32; 2]> = None;
        for (i, &(_, face)) in self.faces.iter().enumerate() {
            let next = self.faces.get(i + 1).map(|it| it.1);
            let shared = next.and_then(|next| shared_side(face, next));

            // The face from the side by which it is entered, and its third vertex.
            let [from, to, last] = match side.and_then(|side| entered_by(face, side)) {
                Some(entered) => entered,
                None => {
                    let face = first_face(face, shared);
                    start(&mut strip, face);
                    [face[0], face[1], face[2]]
                }
            };

            // The next face has the new vertex in common, and one of the two before: the older one has to be repeated.
            side = shared.map(|_| [to, last]);
            if let Some(shared) = shared
                && !shared.contains(&to)
            {
                strip.push(from);
                side = Some([from, last]);
            }
            strip.push(last);
        }
        strip
    }
}

/// The side that two faces have in common.
fn shared_side(face: [u32; 3], next: [u32; 3]) -> Option<[u32; 2]> {
    let mut common = face.iter().copied().filter(|it| next.contains(it));
    match [common.next(), common.next(), common.next()] {
        [Some(a), Some(b), None] => Some([a, b]),
        _ => None,
    }
}

/// A side, older vertex first, and the third vertex of a face that has it.
fn entered_by(face: [u32; 3], side: [u32; 2]) -> Option<[u32; 3]> {
    let [from, to] = side;
    let has_side = face.contains(&from) && face.contains(&to);
    let last = face.into_iter().find(|it| !side.contains(it));
    last.filter(|_| has_side).map(|last| [from, to, last])
}

/// A face turned so that its last two vertices are those that the next one has.
fn first_face(face: [u32; 3], shared: Option<[u32; 2]>) -> [u32; 3] {
    let [a, b, c] = face;
    let turns = [[a, b, c], [b, c, a], [c, a, b]];
    let is_first = |turned: &&[u32; 3]| shared.is_none_or(|side| !side.contains(&turned[0]));
    turns.iter().find(is_first).copied().unwrap_or(face)
}

/// Begins a face that has nothing to do with the strip so far, but for its last vertex.
fn start(strip: &mut Vec<u32>, [a, b, _]: [u32; 3]) {
    if let Some(&end) = strip.last() {
        strip.extend([end, a]);
        // A face begins at an even place, or it would be turned.
        if strip.len() % 2 == 1 {
            strip.push(a);
        }
    }
    strip.extend([a, b]);
}
