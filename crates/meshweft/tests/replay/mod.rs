//! Caches replayed as a queue that is searched from end to end: slow, and plainly right.

use std::collections::VecDeque;

/// Pushes `vertex` into a FIFO cache of `size` entries.
fn push(queue: &mut VecDeque<u32>, vertex: u32, size: u32) {
    if queue.len() == size as usize {
        queue.pop_front();
    }
    queue.push_back(vertex);
}

/// Misses of a FIFO cache that looks at one index after the other, as hardware does.
pub(crate) fn fifo_by_index(faces: &[[u32; 3]], size: u32) -> u64 {
    let (mut queue, mut misses) = (VecDeque::<u32>::new(), 0);
    for &vertex in faces.as_flattened() {
        if !queue.contains(&vertex) {
            push(&mut queue, vertex, size);
            misses += 1;
        }
    }
    misses
}

/// Misses of a FIFO cache that looks once, when a face starts, which of its vertices are missing.
pub(crate) fn fifo_by_face(faces: &[[u32; 3]], size: u32) -> u64 {
    let (mut queue, mut misses) = (VecDeque::<u32>::new(), 0);
    for face in faces {
        let mut missing = Vec::new();
        for vertex in face {
            if !queue.contains(vertex) && !missing.contains(vertex) {
                missing.push(*vertex);
            }
        }
        misses += missing.len() as u64;
        for vertex in missing {
            push(&mut queue, vertex, size);
        }
    }
    misses
}

/// Misses of a FIFO cache that pushes until all three vertices of the face are there.
pub(crate) fn fifo_with_whole_faces(faces: &[[u32; 3]], size: u32) -> u64 {
    let (mut queue, mut misses) = (VecDeque::<u32>::new(), 0);
    for face in faces {
        while let Some(&vertex) = face.iter().find(|vertex| !queue.contains(vertex)) {
            push(&mut queue, vertex, size);
            misses += 1;
        }
    }
    misses
}

/// Misses of a cache that drops the vertex whose last use is longest ago.
pub(crate) fn lru_by_index(faces: &[[u32; 3]], size: u32) -> u64 {
    let (mut queue, mut misses) = (VecDeque::<u32>::new(), 0);
    for &vertex in faces.as_flattened() {
        match queue.iter().position(|&held| held == vertex) {
            Some(position) => {
                queue.remove(position);
                queue.push_back(vertex);
            }
            None => {
                push(&mut queue, vertex, size);
                misses += 1;
            }
        }
    }
    misses
}
