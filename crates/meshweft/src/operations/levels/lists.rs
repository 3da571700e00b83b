//! The index lists of all levels, and the vertices in bands.

use std::collections::BTreeMap;

use super::bands::GroupBands;
use super::coarser::put_list_in_order;
use super::made::MadeLevels;
use super::options::LevelsOptions;
use crate::faces::Faces;
use crate::files::{
    Document, Edit, FileError, MeshEntry, NewLevel, NewLevels, Note, Place, VerticesOfLevels,
};
use crate::mesh::Mesh;
use crate::operations::shared_progress::SharedProgress;
use crate::operations::stage::Stage;
use crate::parallel;

/// What is to be added to a document.
pub(super) struct LevelLists {
    /// Those of each mesh that gets coarser.
    pub(super) meshes: Vec<NewLevels>,
    /// The order of each group of vertices that moves.
    bands: BTreeMap<usize, GroupBands>,
    /// The order of the vertices that the levels of a mesh have copies of, the others after them.
    copied: BTreeMap<usize, GroupBands>,
    /// Meshes with levels whose vertices stay, and are not copied.
    staying: Vec<usize>,
}

impl LevelLists {
    /// The lists, each in its order.
    pub(super) fn new(
        entries: &[MeshEntry],
        made: &MadeLevels,
        options: &LevelsOptions,
        stage: &Stage<'_>,
    ) -> Self {
        let mut lists = Self {
            meshes: in_order_of_file(entries, made),
            bands: BTreeMap::new(),
            copied: BTreeMap::new(),
            staying: Vec::new(),
        };
        // Orders may look at the numbers that vertices will have, and bands at orders.
        lists.find_bands(entries, options);
        lists.find_bands_of_copies(entries, &made.vertices_of);

        // Each list on its own.
        let Self {
            meshes,
            bands,
            copied,
            ..
        } = &mut lists;
        let jobs = meshes.iter_mut().flat_map(|levels| {
            let entry = &entries[levels.mesh];
            let own = copied.get(&levels.mesh);
            let bands = own.or_else(|| bands.get(&entry.vertex_group));
            let stored = levels.levels.iter_mut().filter_map(|it| it.faces.as_mut());
            stored.map(move |faces| (entry, bands, faces))
        });
        let jobs: Vec<_> = jobs.collect();
        let total = jobs.iter().map(|(_, _, faces)| faces.len()).sum();
        let shared = SharedProgress::new(stage, total);
        let job = |(entry, bands, faces): (&MeshEntry, Option<&GroupBands>, &mut Vec<_>)| {
            let part = shared.part(faces.len());
            put_list_in_order(entry, faces, bands, options, &part);
            part.finish();
        };
        match shared.is_timed() {
            // One after the other: each has its share of the time.
            true => jobs.into_iter().for_each(job),
            false => drop(parallel::map(jobs, job)),
        }
        shared.finish();
        lists.find_bands(entries, options);
        lists.find_bands_of_copies(entries, &made.vertices_of);
        lists.count_needed_vertices(entries);
        lists
    }

    /// Finds the order of each group of vertices.
    fn find_bands(&mut self, entries: &[MeshEntry], options: &LevelsOptions) {
        if options.keep_vertex_order {
            return;
        }
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (mesh, entry) in entries.iter().enumerate() {
            groups.entry(entry.vertex_group).or_default().push(mesh);
        }
        let levels_of = self.levels_of();
        groups.retain(|_, meshes| meshes.iter().any(|mesh| levels_of.contains_key(mesh)));
        let (movable, staying): (Vec<_>, Vec<_>) = groups
            .into_iter()
            .partition(|(_, meshes)| meshes.iter().all(|&mesh| entries[mesh].vertices_movable));

        // Vertices that a coarse level uses come before all others.
        let bands = parallel::map(movable, |(group, meshes)| {
            let counts = meshes.iter().filter_map(|mesh| levels_of.get(mesh));
            let count = counts.map(|it| it.levels.len()).max().unwrap_or(0);
            let level = |number: usize| -> Vec<[u32; 3]> {
                let faces = meshes.iter().flat_map(|mesh| {
                    let levels = levels_of.get(mesh).map_or(&[][..], |it| &it.levels);
                    faces_at(&entries[*mesh], levels, number)
                });
                faces.copied().collect()
            };
            let levels: Vec<Vec<[u32; 3]>> = (0..=count).map(level).collect();
            let vertex_count = entries[meshes[0]].mesh.vertex_count();
            let levels = levels.iter();
            let levels: Vec<Faces<'_>> = levels
                .map(|faces| Faces::of_checked(faces, vertex_count))
                .collect();
            (group, GroupBands::new(&levels))
        });
        let bands = bands.into_iter().collect();
        let stays = |mesh: &usize| levels_of.contains_key(mesh);
        let staying = staying.into_iter().flat_map(|(_, meshes)| meshes);
        let staying = staying.filter(stays).collect();
        (self.bands, self.staying) = (bands, staying);
    }

    /// Finds the order of the vertices that levels have copies of.
    fn find_bands_of_copies(&mut self, entries: &[MeshEntry], vertices_of: &[VerticesOfLevels]) {
        let is_copied = |mesh: &usize| vertices_of[*mesh] == VerticesOfLevels::Copies;
        self.staying.retain(|mesh| !is_copied(mesh));
        let meshes = self.meshes.iter();
        let copied = meshes.filter(|levels| is_copied(&levels.mesh));
        let copied = parallel::map(copied.collect(), |levels: &NewLevels| {
            let vertex_count = entries[levels.mesh].mesh.vertex_count();
            let stored = levels.levels.iter();
            let stored = stored.filter_map(|level| level.faces.as_deref());
            let stored = stored.map(|faces| Faces::of_checked(faces, vertex_count));
            let bands = GroupBands::new(&stored.collect::<Vec<_>>());
            (levels.mesh, bands)
        });
        self.copied = copied.into_iter().collect();
    }

    /// Finds how far into the vertex views each level reaches, and so which vertices are copied.
    fn count_needed_vertices(&mut self, entries: &[MeshEntry]) {
        let ends = self.ends_of_bands(entries);
        for levels in &mut self.meshes {
            let entry = &entries[levels.mesh];
            let copied = self.copied.get(&levels.mesh);
            let mut copy_count = 0;
            for number in 1..=levels.levels.len() {
                let stored = stored_faces_at(&levels.levels, number);
                let end = ends.get(&(entry.vertex_group, number)).copied();
                let vertices = match (stored, end) {
                    (Some(faces), None) => needed_vertices(faces, copied),
                    (None, None) => needed_vertices(entry.mesh.faces(), None),
                    (_, Some(end)) => end,
                };
                if stored.is_some() {
                    copy_count = copy_count.max(vertices);
                }
                levels.levels[number - 1].vertices = vertices;
            }
            if let Some(copied) = copied {
                levels.copies = copied.order().new_to_old()[..copy_count].to_vec();
            }
        }
    }

    /// Where in each group the vertices of each level end. What moves vertices inside bands later leaves these as they are, which
    /// is not true of how far a single mesh reaches.
    fn ends_of_bands(&self, entries: &[MeshEntry]) -> BTreeMap<(usize, usize), usize> {
        let levels_of = self.levels_of();
        let counts = self.meshes.iter().map(|levels| levels.levels.len());
        let coarsest = counts.max().unwrap_or(0);
        let mut ends = BTreeMap::new();
        for (mesh, entry) in entries.iter().enumerate() {
            let Some(bands) = self.bands.get(&entry.vertex_group) else {
                continue;
            };
            let levels = levels_of.get(&mesh).map_or(&[][..], |it| &it.levels);
            for number in 1..=coarsest {
                let vertices = needed_vertices(faces_at(entry, levels, number), Some(bands));
                let end = ends.entry((entry.vertex_group, number)).or_insert(0);
                *end = vertices.max(*end);
            }
        }
        ends
    }

    /// Adds the levels, and puts the vertices in bands; or changes nothing.
    pub(super) fn apply(&self, document: &mut Document) -> Result<(), FileError> {
        let mut member_of: BTreeMap<usize, usize> = BTreeMap::new();
        for levels in &self.meshes {
            let group = document.meshes()[levels.mesh].vertex_group;
            member_of.insert(group, levels.mesh);
        }

        // What can be refused comes first.
        let meshes = &self.meshes;
        document.edit(Edit::Levels { meshes })?;
        for (group, bands) in &self.bands {
            document.edit(Edit::order(member_of[group], None, bands.order()))?;
        }
        Ok(())
    }

    /// The meshes as they are drawn at a level, 0 for the full one, with the vertices in their order.
    pub(super) fn drawn_at(&self, entries: &[MeshEntry], number: usize) -> Vec<MeshEntry> {
        let levels_of = self.levels_of();
        let drawn = entries.iter().enumerate().map(|(mesh, entry)| {
            let levels = levels_of.get(&mesh);
            let stored = levels.and_then(|it| stored_faces_at(&it.levels, number));
            let copied = stored.and(self.copied.get(&mesh));
            let mut faces = stored.unwrap_or(entry.mesh.faces()).to_vec();
            let bands = copied.or_else(|| self.bands.get(&entry.vertex_group));
            if let Some(bands) = bands {
                bands.renumber(&mut faces);
            }
            let vertex_count = match (copied, levels) {
                (Some(_), Some(levels)) => levels.copies.len(),
                _ => entry.mesh.vertex_count(),
            };
            let drawn = Mesh::connectivity_only(vertex_count, faces);
            MeshEntry {
                mesh: drawn.expect("the corners are vertices of the mesh"),
                ..entry.clone()
            }
        });
        drawn.collect()
    }

    /// The levels of each mesh that has some.
    fn levels_of(&self) -> BTreeMap<usize, &NewLevels> {
        self.meshes.iter().map(|it| (it.mesh, it)).collect()
    }

    /// What there is to say of vertices that stay, and of copies.
    pub(super) fn notes(&self, entries: &[MeshEntry]) -> Vec<Note> {
        let note = |mesh: usize, text: String| {
            let text = format!("{}: {text}", entries[mesh].name);
            Note::new(Place::File, text)
        };
        let staying = self.staying.iter().map(|&mesh| {
            let text = "its vertices stay where they are, so those of a coarse level are not the first ones";
            note(mesh, text.into())
        });
        let copied = self.meshes.iter().filter(|it| !it.copies.is_empty());
        let copied = copied.map(|levels| {
            let all = entries[levels.mesh].mesh.vertex_count();
            let text = format!(
                "it has no index list, so its levels have copies of {} of its {all} vertices",
                levels.copies.len()
            );
            note(levels.mesh, text)
        });
        staying.chain(copied).collect()
    }
}

/// The faces of a mesh at a level, 0 for the full mesh.
fn faces_at<'a>(entry: &'a MeshEntry, levels: &'a [NewLevel], number: usize) -> &'a [[u32; 3]] {
    stored_faces_at(levels, number).unwrap_or(entry.mesh.faces())
}

/// The faces at a level; `None` if they are those of the full mesh.
fn stored_faces_at(levels: &[NewLevel], number: usize) -> Option<&[[u32; 3]]> {
    let mut finer = levels[..number.min(levels.len())].iter().rev();
    finer.find_map(|level| level.faces.as_deref())
}

/// How many vertices from the first on faces need, in these bands or as they are.
fn needed_vertices(faces: &[[u32; 3]], bands: Option<&GroupBands>) -> usize {
    let numbers = faces.as_flattened().iter().map(|&vertex| match bands {
        Some(bands) => bands.number(vertex),
        None => vertex,
    });
    numbers.max().map_or(0, |largest| largest as usize + 1)
}

/// The levels of all meshes that get coarser, as they were made.
fn in_order_of_file(entries: &[MeshEntry], made: &MadeLevels) -> Vec<NewLevels> {
    let mut all = Vec::new();
    for object in &made.objects {
        for (place, &mesh) in object.meshes.iter().enumerate() {
            let entry = &entries[mesh];
            let mut before = entry.mesh.faces().to_vec();
            let mut levels = Vec::with_capacity(object.levels.len());
            for level in &object.levels {
                let faces = level.meshes[place].faces.iter();
                let mut faces: Vec<[u32; 3]> = faces.map(|face| face.corners).collect();
                // Of a mesh that has lost all, a face that was there is less odd to readers than one without an area.
                if let [[a, b, c]] = faces[..]
                    && a == b
                    && b == c
                {
                    faces.clone_from_slice(&before[..1]);
                }
                let is_other = faces != before;
                levels.push(NewLevel {
                    faces: is_other.then(|| faces.clone()),
                    vertices: 0,
                    error: level.error,
                });
                before = faces;
            }
            if levels.iter().any(|level| level.faces.is_some()) {
                all.push(NewLevels {
                    radius: object.radii[place],
                    mesh,
                    copies: Vec::new(),
                    levels,
                });
            }
        }
    }
    all.sort_by_key(|levels| levels.mesh);
    all
}
