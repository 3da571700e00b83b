//! Counting misses of meshes, one by one and together.

use crate::cache::nvidia::{self, DrawCounts};
use crate::cache::{self, CacheModel, ratio};
use crate::faces::Faces;
use crate::first_use::Compact;
#[cfg(feature = "files")]
use crate::order::Target;

/// Bytes of a vertex record that overfetch is counted for: position, normal, texture coordinates.
pub(super) const VERTEX_SIZE: usize = 32;

/// The caches that are counted for where none is named: three FIFO caches and three GPUs.
pub const USUAL_CACHES: [CacheModel; 6] = [
    CacheModel::fifo(12),
    CacheModel::fifo(16),
    CacheModel::fifo(32),
    CacheModel::Nvidia,
    CacheModel::AMD,
    CacheModel::INTEL,
];

/// What is counted on a mesh, or summed over meshes.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Counts {
    /// Vertices, used or not.
    pub vertices: usize,
    /// Vertices that some face names.
    pub used_vertices: usize,
    /// Faces.
    pub faces: usize,
    /// Misses under each model, in the order that was asked for.
    pub misses: Vec<(CacheModel, u64)>,
    /// What an NVIDIA card counts, if [`CacheModel::Nvidia`] was asked for.
    pub card: Option<DrawCounts>,
    /// Bytes fetched over bytes of the used vertices, with records of 32 bytes.
    pub overfetch: f64,
}

impl Counts {
    /// Counts one mesh.
    ///
    /// # Complexity
    /// As [`cache::misses_of`], and at most O(faces) for the vertices.
    #[must_use]
    pub fn of<'a>(faces: impl Into<Faces<'a>>, models: &[CacheModel]) -> Self {
        let faces = faces.into();
        // What a few faces on a large vertex buffer take is not what the buffer takes.
        let compact = Compact::where_sparse(faces);
        let mut counts = Self {
            vertices: faces.vertex_count(),
            used_vertices: cache::used_vertices(compact.faces()),
            faces: faces.len(),
            ..Self::default()
        };
        counts.count_misses(faces, compact.faces(), models);
        counts.count_fetched(faces);
        counts
    }

    /// The same mesh with its faces in another order, what is fetched as it was.
    #[cfg(feature = "files")]
    pub(super) fn reordered(&self, faces: Faces<'_>, models: &[CacheModel]) -> Self {
        let mut counts = Self {
            misses: Vec::new(),
            ..*self
        };
        counts.count_misses(faces, Compact::where_sparse(faces).faces(), models);
        counts
    }

    /// Counts the misses; `compact` are the same faces with other numbers of their vertices, which only
    /// the card looks at.
    fn count_misses(&mut self, faces: Faces<'_>, compact: Faces<'_>, models: &[CacheModel]) {
        let is_card = |model: &&CacheModel| **model == CacheModel::Nvidia;
        self.card = models.iter().find(is_card).map(|_| nvidia::counts(faces));

        let others: Vec<_> = models
            .iter()
            .filter(|model| !is_card(model))
            .copied()
            .collect();
        let mut misses = cache::misses_of(compact, &others).into_iter();
        let of_model = |&model: &CacheModel| match (model, self.card) {
            (CacheModel::Nvidia, Some(card)) => (model, card.invocations),
            _ => (model, misses.next().unwrap_or(0)),
        };
        self.misses = models.iter().map(of_model).collect();
    }

    /// Counts what is fetched for these faces, the rest as it was.
    pub(super) fn count_fetched(&mut self, faces: Faces<'_>) {
        let stored = self.used_vertices * VERTEX_SIZE;
        self.overfetch = ratio(cache::fetched(faces, VERTEX_SIZE), stored);
    }

    /// What the order costs for `target`, whose models were counted: see [`Target::cost`].
    #[cfg(feature = "files")]
    pub(super) fn cost_for(&self, target: Target) -> u64 {
        let of_model = |model: &CacheModel| match (model, self.card) {
            (CacheModel::Nvidia, Some(card)) => card.cost(),
            _ => {
                let counted = self.misses.iter().find(|(counted, _)| counted == model);
                counted.map_or(0, |(_, misses)| *misses)
            }
        };
        target.models().iter().map(of_model).sum()
    }

    /// Misses per face under each model.
    pub fn acmr(&self) -> impl Iterator<Item = (CacheModel, f64)> {
        let per_face = |&(model, misses): &(CacheModel, u64)| (model, ratio(misses, self.faces));
        self.misses.iter().map(per_face)
    }

    /// Misses per used vertex under each model.
    pub fn atvr(&self) -> impl Iterator<Item = (CacheModel, f64)> {
        let used = self.used_vertices;
        let per_vertex = move |&(model, misses): &(CacheModel, u64)| (model, ratio(misses, used));
        self.misses.iter().map(per_vertex)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_faces_on_a_large_vertex_buffer_count_the_same() {
        let faces = [[900, 7, 41], [41, 7, 3], [3, 900, 3]];
        let counts = |vertex_count| {
            let faces = Faces::new(&faces, vertex_count).unwrap();
            Counts::of(faces, &USUAL_CACHES)
        };
        let expected = Counts {
            vertices: 901,
            used_vertices: 4,
            faces: 3,
            misses: USUAL_CACHES.map(|model| (model, 4)).to_vec(),
            card: Some(nvidia::counts(&faces)),
            // Records of 32 bytes: 3 and 7, 41 and 900 each have a line of 64 bytes of their own.
            overfetch: 2.0,
        };
        assert_eq!(counts(901), expected);
        let vertices = 5_000_000;
        assert_eq!(
            counts(vertices),
            Counts {
                vertices,
                ..expected
            }
        );
    }
}

#[cfg(feature = "files")]
mod of_files {
    use std::collections::BTreeMap;

    use super::{CacheModel, Counts};
    use crate::files::MeshEntry;

    impl Counts {
        /// Counts each mesh of a file.
        ///
        /// # Complexity
        /// As [`of`](Self::of) of each.
        #[must_use]
        pub fn of_each(entries: &[MeshEntry], models: &[CacheModel]) -> Vec<Self> {
            let meshes = entries.iter();
            meshes.map(|entry| Self::of(&entry.mesh, models)).collect()
        }

        /// The sum over the meshes of a file that are at full resolution, vertices that several share counted once.
        /// Levels of detail ([`MeshEntry::level`]) are drawn in the place of others, and so not added.
        ///
        /// `counts` are those of the meshes, under these models.
        ///
        /// # Complexity
        /// Time O(faces), space one byte a vertex.
        #[must_use]
        pub fn total(entries: &[MeshEntry], counts: &[Self], models: &[CacheModel]) -> Self {
            let mut total = Self {
                misses: models.iter().map(|&model| (model, 0)).collect(),
                ..Self::default()
            };
            let mut fetched = 0.0;
            let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
            let all = entries.iter().zip(counts).enumerate();
            let full = all.filter(|(_, (entry, _))| entry.level.is_none());
            for (i, (entry, count)) in full {
                groups.entry(entry.vertex_group).or_default().push(i);
                total.faces += count.faces;
                if let Some(card) = count.card {
                    total.card.get_or_insert_default().add(&card);
                }
                for (sum, (_, misses)) in total.misses.iter_mut().zip(&count.misses) {
                    sum.1 += misses;
                }
                fetched += count.overfetch * count.used_vertices as f64;
            }

            for members in groups.values() {
                let vertices = counts[members[0]].vertices;
                total.vertices += vertices;
                total.used_vertices += match members[..] {
                    [only] => counts[only].used_vertices,
                    _ => used_by(members.iter().map(|&i| &entries[i]), vertices),
                };
            }

            if total.used_vertices > 0 {
                total.overfetch = fetched / total.used_vertices as f64;
            }
            total
        }
    }

    /// How many of `vertices` vertices some face of these meshes names.
    fn used_by<'a>(meshes: impl Iterator<Item = &'a MeshEntry>, vertices: usize) -> usize {
        let mut is_used = vec![false; vertices];
        for &vertex in meshes.flat_map(|entry| entry.mesh.faces()).flatten() {
            is_used[vertex as usize] = true;
        }
        is_used.into_iter().filter(|&used| used).count()
    }
}
