//! What holds for every simplified document, checked without knowing how it was made.

use std::collections::BTreeMap;

use meshweft::attribute::{Domain, Semantic, Values};
use meshweft::files::Document;
use meshweft::operations::SimplifyReport;
use meshweft::progressive::StopReason;

/// What a corner has: the number of its mesh, and the bits of all that its vertex and itself store.
type Side = Vec<u64>;

/// A face as the positions of its corners, and as their sides.
struct Face {
    points: [[u32; 3]; 3],
    sides: [Side; 3],
}

/// Whether the result is made of what the source has, and is nowhere torn.
pub(crate) fn check(source: &Document, result: &Document, report: &SimplifyReport) {
    let [before, after] = [source, result].map(|document| {
        let meshes = 0..document.meshes().len();
        meshes.map(|mesh| faces(document, mesh)).collect::<Vec<_>>()
    });
    assert_eq!(before.len(), after.len(), "meshes keep their numbers");
    let name = source.path().display();

    // Counts are as reported, and as asked for unless something was in the way.
    for object in &report.objects {
        let count = |all: &[Vec<Face>]| object.meshes.iter().map(|&mesh| all[mesh].len()).sum();
        let faces: [usize; 2] = [count(&before), count(&after)];
        assert_eq!(faces[0], object.faces[0], "{name}");
        // A mesh that cannot be empty has one face without an area.
        let spare = faces[1] - object.faces[1];
        assert!(spare < object.meshes.len().max(1), "{name}");
        assert!(faces[1] > 0, "{name}: nothing is left");
        let is_met = object.faces[1] <= object.goal.max(1);
        assert!(
            is_met || object.stop != StopReason::Faces || object.refused.is_some(),
            "{name}: {object:?}"
        );
    }

    // Every corner is one of the source, and the corners of a face are of one part of the surface, cut at
    // its seams.
    let mut parts = Parts::default();
    for face in before.iter().flatten() {
        parts.join(&face.sides);
    }
    for (mesh, face) in after
        .iter()
        .enumerate()
        .flat_map(|(m, all)| all.iter().map(move |f| (m, f)))
    {
        let found = [0, 1, 2].map(|corner| parts.of(&face.sides[corner]));
        let first = found[0];
        assert!(
            first.is_some() && found.iter().all(|part| *part == first),
            "{name}: mesh {mesh}: {found:?}"
        );
    }

    // Vertices are those of the source that the report says, and what stands for the others is there.
    for (mesh, simplified) in report.meshes.iter().enumerate() {
        let Some(new_to_old) = &simplified.vertices else {
            continue;
        };
        let [old, new] = [source, result].map(|document| records(document, mesh));
        assert_eq!(new_to_old.len(), new.len(), "{name}");
        for (record, &number) in new.iter().zip(new_to_old) {
            assert_eq!(*record, old[number as usize], "{name}: mesh {mesh}");
        }
        let mut is_there = vec![false; old.len()];
        new_to_old
            .iter()
            .for_each(|&number| is_there[number as usize] = true);
        for coarse in simplified.fine_to_coarse.iter().flatten() {
            assert!(is_there[*coarse as usize], "{name}: mesh {mesh}: {coarse}");
        }
    }

    // Open edges of the welded surface are between points that had some.
    for object in &report.objects {
        let members = |all: &[Vec<Face>]| {
            let faces = object.meshes.iter().flat_map(|&mesh| &all[mesh]);
            open_points(&faces.map(|face| face.points).collect::<Vec<_>>())
        };
        let (old, new) = (members(&before), members(&after));
        for point in new {
            assert!(
                old.binary_search(&point).is_ok(),
                "{name}: a crack at {point:?}"
            );
        }
    }
}

/// The points at edges of one face, sorted.
fn open_points(faces: &[[[u32; 3]; 3]]) -> Vec<[u32; 3]> {
    let mut edges = Vec::with_capacity(3 * faces.len());
    for &[a, b, c] in faces {
        if a != b && b != c && c != a {
            edges.extend([(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b))));
        }
    }
    edges.sort_unstable();
    let single = edges.chunk_by(|a, b| a == b).filter(|run| run.len() == 1);
    let mut points: Vec<[u32; 3]> = single.flat_map(|run| [run[0].0, run[0].1]).collect();
    points.sort_unstable();
    points.dedup();
    points
}

/// The faces of a mesh.
fn faces(document: &Document, mesh: usize) -> Vec<Face> {
    let positions = document.positions(mesh).ok().flatten().unwrap_or_default();
    let records = records(document, mesh);
    let corners = columns(document, mesh, Domain::Corner);
    let all = document.meshes()[mesh].mesh.faces();
    let face = |(number, face): (usize, &[u32; 3])| Face {
        points: face.map(|vertex| {
            let position = positions.get(vertex as usize).copied().unwrap_or_default();
            position.map(|x| (x + 0.0).to_bits())
        }),
        sides: [0, 1, 2].map(|slot| {
            let mut side = vec![mesh as u64];
            side.extend(&records[face[slot] as usize]);
            for (components, values) in &corners {
                let corner = 3 * number + slot;
                side.extend(&values[corner * components..][..*components]);
            }
            side
        }),
    };
    all.iter().enumerate().map(face).collect()
}

/// The bits of all that each vertex stores.
fn records(document: &Document, mesh: usize) -> Vec<Vec<u64>> {
    let columns = columns(document, mesh, Domain::Vertex);
    let vertices = 0..document.meshes()[mesh].mesh.vertex_count();
    let record = |vertex| {
        let columns = columns.iter();
        let values = columns.flat_map(|(n, values)| values[vertex * n..][..*n].iter().copied());
        values.collect()
    };
    vertices.map(record).collect()
}

fn columns(document: &Document, mesh: usize, domain: Domain) -> Vec<(usize, Vec<u64>)> {
    let infos = document.attributes(mesh).into_iter();
    let mut infos: Vec<_> = infos.filter(|info| info.domain == domain).collect();
    infos.sort_by_key(|info| info.semantic != Semantic::Position);
    let column = |info| {
        let attribute = document.attribute(mesh, &info).ok()?;
        Some((info.components, bits(&attribute.values)))
    };
    infos.into_iter().filter_map(column).collect()
}

fn bits(values: &Values) -> Vec<u64> {
    let size = values.component_type().size();
    let bytes = values.to_le_bytes();
    let number = |bytes: &[u8]| {
        let mut all = [0; 8];
        all[..size].copy_from_slice(bytes);
        u64::from_le_bytes(all)
    };
    bytes.chunks(size).map(number).collect()
}

/// Sides that faces connect.
#[derive(Default)]
struct Parts {
    numbers: BTreeMap<Side, usize>,
    parents: Vec<usize>,
}

impl Parts {
    fn join(&mut self, sides: &[Side; 3]) {
        let numbers = [0, 1, 2].map(|corner| {
            let next = self.numbers.len();
            let number = *self.numbers.entry(sides[corner].clone()).or_insert(next);
            if number == next {
                self.parents.push(next);
            }
            number
        });
        for other in &numbers[1..] {
            let [a, b] = [numbers[0], *other].map(|side| self.root(side));
            self.parents[a.max(b)] = a.min(b);
        }
    }

    fn root(&mut self, mut side: usize) -> usize {
        while self.parents[side] != side {
            self.parents[side] = self.parents[self.parents[side]];
            side = self.parents[side];
        }
        side
    }

    fn of(&mut self, side: &Side) -> Option<usize> {
        let number = *self.numbers.get(side)?;
        Some(self.root(number))
    }
}
