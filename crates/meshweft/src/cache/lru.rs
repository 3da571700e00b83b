//! Least recently used: a doubly linked list from the newest to the oldest use.

const NONE: u32 = u32::MAX;

/// An LRU cache over numbered vertices; every use is O(1) for any size.
#[derive(Debug, Clone)]
pub(crate) struct Lru {
    size: u32,
    len: u32,
    newest: u32,
    oldest: u32,
    links: Vec<Link>,
}

#[derive(Debug, Clone, Copy)]
struct Link {
    newer: u32,
    older: u32,
    present: bool,
}

impl Lru {
    pub(crate) fn new(size: u32, vertex_count: usize) -> Self {
        let absent = Link {
            newer: NONE,
            older: NONE,
            present: false,
        };
        Self {
            size,
            len: 0,
            newest: NONE,
            oldest: NONE,
            links: vec![absent; vertex_count],
        }
    }

    pub(crate) fn contains(&self, vertex: u32) -> bool {
        self.links[vertex as usize].present
    }

    /// Uses `vertex` and makes it the newest; returns whether it missed.
    pub(crate) fn miss(&mut self, vertex: u32) -> bool {
        let present = self.links[vertex as usize].present;
        if present {
            self.unlink(vertex);
        } else if self.len == self.size {
            self.unlink(self.oldest);
        }

        let older = self.newest;
        self.links[vertex as usize] = Link {
            newer: NONE,
            older,
            present: true,
        };
        match older {
            NONE => self.oldest = vertex,
            _ => self.links[older as usize].newer = vertex,
        }
        self.newest = vertex;
        self.len += 1;
        !present
    }

    fn unlink(&mut self, vertex: u32) {
        let Link { newer, older, .. } = self.links[vertex as usize];
        match newer {
            NONE => self.newest = older,
            _ => self.links[newer as usize].older = older,
        }
        match older {
            NONE => self.oldest = newer,
            _ => self.links[older as usize].newer = newer,
        }
        self.links[vertex as usize].present = false;
        self.len -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::index::index32;
    use crate::random::SplitMix64;

    /// The definition, as a list whose front is the newest.
    fn plain_misses(size: usize, uses: &[u32]) -> Vec<bool> {
        let mut list: Vec<u32> = Vec::new();
        uses.iter()
            .map(|&vertex| {
                let at = list.iter().position(|&v| v == vertex);
                if let Some(at) = at {
                    list.remove(at);
                }
                list.insert(0, vertex);
                list.truncate(size);
                at.is_none()
            })
            .collect()
    }

    #[test]
    fn the_linked_list_is_the_plain_list() {
        let mut numbers = SplitMix64(1);
        let uses: Vec<u32> = (0..5000).map(|_| index32(numbers.below(23))).collect();
        for size in [3, 7, 22, 23, 40] {
            let mut lru = Lru::new(size, 23);
            let missed: Vec<bool> = uses.iter().map(|&v| lru.miss(v)).collect();
            assert_eq!(missed, plain_misses(size as usize, &uses), "size {size}");
        }
    }
}
