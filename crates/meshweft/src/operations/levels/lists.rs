//! The index lists of all levels, and the vertices in bands.

use std::collections::BTreeMap;

use super::bands::GroupBands;
use super::coarser::put_list_in_order;
use super::made::MadeLevels;
use super::options::LevelsOptions;
use crate::faces::Faces;
use crate::files::{Document, Edit, FileError, MeshEntry, NewLevel, NewLevels, Note, Place};
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
    /// Meshes with levels whose vertices stay.
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
            staying: Vec::new(),
        };
        // Orders may look at the numbers that vertices will have, and bands at orders.
        if !options.keep_vertex_order {
            lists.find_bands(entries);
        }

        // Each list on its own.
        let (bands, meshes) = (&lists.bands, &mut lists.meshes);
        let jobs = meshes.iter_mut().flat_map(|levels| {
            let entry = &entries[levels.mesh];
            let stored = levels.levels.iter_mut().filter_map(|it| it.faces.as_mut());
            stored.map(move |faces| (entry, faces))
        });
        let jobs: Vec<(&MeshEntry, &mut Vec<[u32; 3]>)> = jobs.collect();
        let total = jobs.iter().map(|(_, faces)| faces.len()).sum();
        let shared = SharedProgress::new(stage, total);
        let job = |(entry, faces): (&MeshEntry, &mut Vec<[u32; 3]>)| {
            let part = shared.part(faces.len());
            let bands = bands.get(&entry.vertex_group);
            put_list_in_order(entry, faces, bands, options, &part);
            part.finish();
        };
        match shared.is_timed() {
            // One after the other: each has its share of the time.
            true => jobs.into_iter().for_each(job),
            false => drop(parallel::map(jobs, job)),
        }
        shared.finish();
        if !options.keep_vertex_order {
            lists.find_bands(entries);
        }
        lists.count_needed_vertices(entries);
        lists
    }

    /// Finds the order of each group of vertices.
    fn find_bands(&mut self, entries: &[MeshEntry]) {
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

    /// Finds how far into the vertex views each level reaches.
    fn count_needed_vertices(&mut self, entries: &[MeshEntry]) {
        for levels in &mut self.meshes {
            let entry = &entries[levels.mesh];
            let bands = self.bands.get(&entry.vertex_group);
            let number = |vertex: u32| match bands {
                Some(bands) => bands.number(vertex),
                None => vertex,
            };
            let needed = |faces: &[[u32; 3]]| {
                let corners = faces.as_flattened().iter();
                corners
                    .map(|&it| number(it) as usize + 1)
                    .max()
                    .unwrap_or(0)
            };
            let mut before = None;
            for level in &mut levels.levels {
                level.vertices = match (&level.faces, before) {
                    (Some(faces), _) => needed(faces),
                    (None, Some(vertices)) => vertices,
                    (None, None) => needed(entry.mesh.faces()),
                };
                before = Some(level.vertices);
            }
        }
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
            let levels = levels_of.get(&mesh).map_or(&[][..], |it| &it.levels);
            let mut faces = faces_at(entry, levels, number).to_vec();
            if let Some(bands) = self.bands.get(&entry.vertex_group) {
                bands.renumber(&mut faces);
            }
            let drawn = Mesh::connectivity_only(entry.mesh.vertex_count(), faces);
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

    /// What there is to say of vertices that stay.
    pub(super) fn notes(&self, document: &Document) -> impl Iterator<Item = Note> {
        let names = self
            .staying
            .iter()
            .map(|&mesh| document.meshes()[mesh].name.clone());
        names.map(|name| {
            let text = format!(
                "{name}: its vertices stay where they are, so those of a coarse level are not the first ones"
            );
            Note::new(Place::File, text)
        })
    }
}

/// The faces of a mesh at a level, 0 for the full mesh.
pub(super) fn faces_at<'a>(
    entry: &'a MeshEntry,
    levels: &'a [NewLevel],
    number: usize,
) -> &'a [[u32; 3]] {
    let coarser = levels[..number.min(levels.len())].iter().rev();
    let stored = coarser.filter_map(|level| level.faces.as_deref()).next();
    stored.unwrap_or(entry.mesh.faces())
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
                    levels,
                });
            }
        }
    }
    all.sort_by_key(|levels| levels.mesh);
    all
}
