//! Which bytes of the files of a glTF each level of detail needs.

use std::collections::{BTreeMap, BinaryHeap};
use std::ops::RangeInclusive;
use std::path::PathBuf;

use super::GltfFile;
use super::accessors::{Accessors, COMPRESSED_VIEW};
use super::buffers::Source;
use super::byte_users::index_size;
use super::drawn_levels::DrawnLevels;
use super::entries::Entries;
use super::json::Value;
use super::object::Object;
use super::primitive_reads::{PrimitiveReads, each_primitive, matrices};
use super::strided_records::StridedRecords;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::level_bytes::{FileBytes, LevelBytes, LevelNeeds};

/// Each level takes memory, however little a file says of it.
const MOST_LEVELS: usize = 1024;

impl GltfFile {
    /// See [`Content::level_bytes`](crate::files::content::Content::level_bytes).
    pub(super) fn level_bytes(&self) -> Result<LevelBytes, Problem> {
        let json = super::read_json(&self.container, &self.options.limits)?;
        let root = Object::new(json.root(), String::new())?;
        let accessors = Accessors::new(&root, &self.buffers, &self.options.assume_order_safe)?;
        let drawn = DrawnLevels::new(&root);
        if drawn.coarsest > MOST_LEVELS {
            let kind = FileErrorKind::OverLimit {
                what: "levels of detail",
                found: drawn.coarsest as u64,
                limit: MOST_LEVELS as u64,
            };
            return Err(kind.at(Place::Json("/nodes".into())));
        }
        let (files, beside) = self.files_of_storages();
        let files = Files {
            accessors: &accessors,
            of_storage: files,
        };
        let mut found = LevelBytes {
            head: self.container.head.len() as u64,
            beside,
            levels: vec![LevelNeeds::default(); drawn.coarsest + 1],
            images: Vec::new(),
        };

        // What each primitive needs, at the coarsest level that draws it.
        let entries = &self.view.entries;
        let used = used_vertices(entries);
        let mut counts = Counted::default();
        each_primitive(&root, |reads| {
            let levels = drawn.of(reads.number.mesh as usize);
            let levels = levels.unwrap_or(0..=drawn.coarsest);
            let geometry = &mut found.levels[drawn.coarsest - levels.end()].geometry;
            // That of lines and compressed faces is not known.
            let used = entries.mesh_of(reads.number).map(|mesh| used[mesh]);
            counts.add(&reads, used, levels, &accessors);
            for &list in &reads.lists {
                files.add_accessor(list, None, geometry);
            }
            for &attribute in &reads.vertices {
                files.add_accessor(attribute, used.map(|used| used.vertices), geometry);
            }
            files.add_view(reads.compressed, geometry);
        })?;
        for matrices in matrices(&root) {
            files.add_accessor(matrices, None, &mut found.levels[0].matrices);
        }
        for image in root.array("images")? {
            let view = image.get("bufferView").and_then(Value::whole);
            files.add_view(view, &mut found.images);
        }

        // What each level draws.
        let counts = counts.of_levels(drawn.coarsest);
        for (needs, (faces, vertices)) in found.levels.iter_mut().rev().zip(counts) {
            (needs.faces, needs.vertices) = (faces, vertices);
        }
        Ok(found)
    }

    /// For each storage the number of its file, and where in that it starts; `None` if it is in the text. And the files
    /// beside the main one.
    fn files_of_storages(&self) -> (Vec<Option<(usize, u64)>>, Vec<PathBuf>) {
        let mut beside = Vec::new();
        let storages = self.buffers.storages.iter();
        let places = storages.map(|storage| match &storage.source {
            Source::Binary => Some((0, self.container.head.len() as u64)),
            Source::Data { .. } => None,
            Source::External(relative) => {
                beside.push(relative.clone());
                Some((beside.len(), 0))
            }
        });
        (places.collect(), beside)
    }
}

/// What a primitive uses of its vertices.
#[derive(Clone, Copy)]
struct Used {
    faces: u64,
    /// Up to the last.
    vertices: usize,
}

/// What is used by each mesh.
fn used_vertices(entries: &Entries) -> Vec<Used> {
    let used = entries.meshes.iter().map(|entry| {
        let faces = entry.mesh.faces();
        let last = faces.as_flattened().iter().max();
        Used {
            faces: faces.len() as u64,
            vertices: last.map_or(0, |&last| last as usize + 1),
        }
    });
    used.collect()
}

/// Turns what accessors and views read into bytes of files.
struct Files<'a> {
    accessors: &'a Accessors<'a>,
    of_storage: Vec<Option<(usize, u64)>>,
}

impl Files<'_> {
    fn add(&self, storage: usize, start: usize, end: usize, to: &mut Vec<FileBytes>) {
        let Some((file, base)) = self.of_storage[storage].filter(|_| start < end) else {
            return;
        };
        to.push(FileBytes {
            file,
            start: base + start as u64,
            end: base + end as u64,
        });
    }

    /// Adds a whole view, if there is one of this number: what a compressed one is made from.
    fn add_view(&self, number: Option<usize>, to: &mut Vec<FileBytes>) {
        let view = number.and_then(|number| self.accessors.views().get(number).copied());
        let Some(view) = view else { return };
        let sources = COMPRESSED_VIEW.map(|name| view.get("extensions")?.get(name));
        let source = sources.into_iter().flatten().next();
        self.add_part(source.unwrap_or(view), 0, None, to);
    }

    /// Adds bytes of a view from `offset` on, `length` or all.
    fn add_part(
        &self,
        view: Value<'_>,
        offset: usize,
        length: Option<usize>,
        to: &mut Vec<FileBytes>,
    ) {
        if let Some(bytes) = self.accessors.bytes_of_view(view, offset, length) {
            self.add(bytes.storage, bytes.start, bytes.end(), to);
        }
    }

    /// Adds the first elements of an accessor, or all, and all of its sparse ones. One that is not sound needs its view.
    fn add_accessor(&self, number: usize, first: Option<usize>, to: &mut Vec<FileBytes>) {
        let Some(value) = self.accessors.value(number) else {
            return;
        };
        let resolved = self.accessors.resolve(number, "").ok();
        match resolved.as_ref().and_then(|it| it.records) {
            Some(records) => {
                let count = first.map_or(records.count, |first| first.min(records.count));
                let records = StridedRecords { count, ..records };
                self.add(records.storage, records.start, records.end(), to);
            }
            None => self.add_view(value.get("bufferView").and_then(Value::whole), to),
        }

        let Some(sparse) = value.get("sparse") else {
            return;
        };
        let count = sparse
            .get("count")
            .and_then(Value::whole)
            .unwrap_or(usize::MAX);
        let value_size = resolved.map(|accessor| accessor.tight_stride);
        for name in ["indices", "values"] {
            let part = sparse.get(name);
            let field = |name: &str| part?.get(name)?.whole();
            let view = field("bufferView").and_then(|view| self.accessors.views().get(view));
            let size = match name {
                "indices" => part.map(index_size),
                _ => value_size,
            };
            let length = size.map(|size| count.saturating_mul(size));
            if let Some(&view) = view {
                self.add_part(view, field("byteOffset").unwrap_or(0), length, to);
            }
        }
    }
}

/// What primitives draw, and at which levels.
#[derive(Default)]
struct Counted {
    faces: Vec<(RangeInclusive<usize>, u64)>,
    /// By the accessor of the positions.
    vertices: BTreeMap<usize, Vec<(RangeInclusive<usize>, u64)>>,
}

impl Counted {
    fn add(
        &mut self,
        reads: &PrimitiveReads<'_>,
        used: Option<Used>,
        levels: RangeInclusive<usize>,
        accessors: &Accessors,
    ) {
        let field = |name: &str| reads.primitive.get(name);
        let position = field("attributes").and_then(|all| all.get("POSITION")?.whole());
        let count_of = |number: Option<usize>| {
            let count = accessors.value(number?)?.get("count")?.whole()?;
            Some(count as u64)
        };
        let vertex_count = count_of(position).unwrap_or(0);
        let (faces, vertices) = match used {
            Some(used) => (used.faces, used.vertices as u64),
            None => {
                let indices = field("indices").and_then(Value::whole);
                let corners = count_of(indices).unwrap_or(vertex_count);
                let mode = field("mode").and_then(Value::whole).unwrap_or(4);
                (if mode == 4 { corners / 3 } else { 0 }, vertex_count)
            }
        };
        self.faces.push((levels.clone(), faces));
        if let Some(position) = position {
            let of_position = self.vertices.entry(position).or_default();
            of_position.push((levels, vertices));
        }
    }

    /// The faces and vertices of each level, from 0 on.
    ///
    /// Time O(levels + n log n) in the primitives.
    fn of_levels(self, coarsest: usize) -> Vec<(u64, u64)> {
        // What each level has more than the one before, below 0 as wrapped numbers.
        let mut more = vec![(0_u64, 0_u64); coarsest + 2];
        for (levels, faces) in self.faces {
            let (start, end) = (*levels.start(), levels.end() + 1);
            more[start].0 = more[start].0.wrapping_add(faces);
            more[end].0 = more[end].0.wrapping_sub(faces);
        }
        for shared in self.vertices.into_values() {
            for (levels, vertices) in most(shared) {
                let (start, end) = (*levels.start(), levels.end() + 1);
                more[start].1 = more[start].1.wrapping_add(vertices);
                more[end].1 = more[end].1.wrapping_sub(vertices);
            }
        }

        let mut sum = (0_u64, 0_u64);
        let levels = more
            .into_iter()
            .take(coarsest + 1)
            .map(|(faces, vertices)| {
                sum = (sum.0.wrapping_add(faces), sum.1.wrapping_add(vertices));
                sum
            });
        levels.collect()
    }
}

/// The largest number at each level, of numbers that each hold for some levels.
fn most(mut all: Vec<(RangeInclusive<usize>, u64)>) -> Vec<(RangeInclusive<usize>, u64)> {
    all.sort_unstable_by_key(|(levels, _)| *levels.start());
    let bounds = all
        .iter()
        .flat_map(|(levels, _)| [*levels.start(), levels.end() + 1]);
    let mut bounds: Vec<usize> = bounds.collect();
    bounds.sort_unstable();
    bounds.dedup();

    let mut open: BinaryHeap<(u64, usize)> = BinaryHeap::new();
    let mut next = all.into_iter().peekable();
    let mut most = Vec::new();
    for bound in bounds.windows(2) {
        while let Some((levels, number)) = next.next_if(|(levels, _)| *levels.start() <= bound[0]) {
            open.push((number, *levels.end()));
        }
        while open.peek().is_some_and(|&(_, end)| end < bound[0]) {
            open.pop();
        }
        if let Some(&(number, _)) = open.peek() {
            most.push((bound[0]..=bound[1] - 1, number));
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_of_overlapping_numbers_counts() {
        let all = vec![(0..=9, 3), (2..=4, 7), (4..=5, 9), (12..=12, 1)];
        let expected = [
            (0..=1, 3),
            (2..=3, 7),
            (4..=4, 9),
            (5..=5, 9),
            (6..=9, 3),
            (12..=12, 1),
        ];
        assert_eq!(most(all), expected);
    }
}
