//! Each vertex is sent once: minimum-time rendering.

use std::ops::Range;

use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::{FaceOrder, Permutation};
use crate::topology::rows::Rows;

/// The procedure MTR: faces by their first vertices, and the buffer in which each vertex is sent once.
///
/// Vertices are sent in the order of their numbers and leave in the same order, so the first-in first-out
/// buffer always holds a run of numbers, and nothing in it is searched. How long the run gets depends on the
/// numbers: take those of [`TrimmedLists`](super::TrimmedLists).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MinimumTimeRendering {
    order: FaceOrder,
    steps: Vec<RenderStep>,
    buffer_size: usize,
}

/// What is done while a vertex has the focus: some vertices are sent, some faces drawn, and the vertex leaves.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RenderStep {
    /// The vertices that are sent before the faces are drawn.
    pub sent: Range<u32>,
    /// The faces that are drawn, by their places in the order: those of which the focus is the first vertex.
    pub faces: Range<u32>,
}

impl MinimumTimeRendering {
    /// The order of faces whose vertices are numbered as they are to be sent. Each face is turned so that its
    /// first vertex is the least; faces of the same first vertex stay in the order in which they came.
    ///
    /// # Complexity
    /// Time and space O(vertices + faces).
    #[must_use]
    pub fn new<'a>(faces: impl Into<Faces<'a>>) -> Self {
        let faces = faces.into();
        let count = faces.vertex_count();
        let numbered = (0..).zip(faces.as_slice());
        let first = numbered.map(|(number, face)| (face[least(*face)], number));
        let of_focus: Rows<u32> = Rows::by_counting(count, first);
        let rotations = of_focus.entries().iter().map(|&face| {
            let place = least(faces.as_slice()[face as usize]);
            u8::try_from(place).expect("one of three corners")
        });

        let (mut sent, mut drawn, mut buffer_size) = (0, 0, 0);
        let mut steps = Vec::with_capacity(count);
        for focus in 0..index32(count) {
            let faces_of = of_focus.row(focus);
            let vertices = faces_of.iter().flat_map(|&f| faces.as_slice()[f as usize]);
            let end = vertices.fold(focus, u32::max) + 1;
            let next = sent.max(end);
            let drawn_before = drawn;
            drawn += index32(faces_of.len());
            steps.push(RenderStep {
                sent: sent..next,
                faces: drawn_before..drawn,
            });
            sent = next;
            buffer_size = buffer_size.max((sent - focus) as usize);
        }

        let rotations = rotations.collect();
        let order = Permutation::from_algorithm(of_focus.entries().to_vec());
        let order = FaceOrder::new(order, rotations).expect("a rotation for each face");
        Self {
            order,
            steps,
            buffer_size,
        }
    }

    /// The order in which the faces are drawn.
    #[must_use]
    pub fn order(&self) -> &FaceOrder {
        &self.order
    }

    /// A step for each vertex, in the order of the numbers.
    #[must_use]
    pub fn steps(&self) -> &[RenderStep] {
        &self.steps
    }

    /// The required buffer size *b*: the most vertices that are in the buffer at once.
    #[must_use]
    pub fn buffer_size(&self) -> usize {
        self.buffer_size
    }
}

/// How large a buffer must be in which each vertex is sent before its first face, and its slot is free after
/// the last one: the most vertices that are needed at once.
///
/// Any order of faces will do. In that of [`MinimumTimeRendering`] it is at most the required buffer size.
///
/// # Complexity
/// Time O(vertices + faces), space 4 bytes a vertex.
#[must_use]
pub fn released_buffer_size<'a>(faces: impl Into<Faces<'a>>) -> usize {
    let faces = faces.into();
    let mut last_face = vec![u32::MAX; faces.vertex_count()];
    for (number, face) in (0..).zip(faces.as_slice()) {
        face.iter()
            .for_each(|&vertex| last_face[vertex as usize] = number);
    }
    // A vertex is marked when it is sent, by the highest bit, which no number of a face has.
    const SENT: u32 = 1 << 31;
    let (mut held, mut most) = (0, 0);
    for (number, face) in (0..).zip(faces.as_slice()) {
        for &vertex in face {
            let last = &mut last_face[vertex as usize];
            held += usize::from(*last & SENT == 0);
            *last |= SENT;
        }
        most = most.max(held);
        for vertex in crate::topology::distinct(*face) {
            held -= usize::from(last_face[vertex as usize] == SENT | number);
        }
    }
    most
}

/// The place of the first of the least vertices of a face.
fn least([a, b, c]: [u32; 3]) -> usize {
    match () {
        () if a <= b && a <= c => 0,
        () if b <= c => 1,
        () => 2,
    }
}
