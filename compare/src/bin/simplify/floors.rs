//! The fewest faces that are reached, and whether anything tears on the way there.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use compare::rivals;
use meshweft::attribute::Attribute;
use meshweft::files::Document;
use meshweft::order::Effort;
use meshweft::progressive::{Collapses, ProgressiveMesh, Walk};
use meshweft::{Limits, Mesh};

/// Scenes with seams, skins and morph targets.
pub(crate) const SCENES: [&str; 5] = [
    "DamagedHelmet.glb",
    "Duck.glb",
    "2CylinderEngine.glb",
    "Fox.glb",
    "AnimatedMorphSphere/AnimatedMorphSphere.gltf",
];

/// How many levels of each mesh are looked at for cracks.
const LOOKS: usize = 16;

type Position = [u32; 3];

/// Prints a table a file: a row a mesh, with all its attributes and by positions alone; then the sums.
pub(crate) fn print(files: &[PathBuf]) -> Result<(), String> {
    let mut cracks = 0;
    for file in files {
        println!("\n### {}\n", compare::mesh_name(file));
        println!(
            "| mesh | attributes | faces | meshoptimizer | fast | best | fast / meshoptimizer | parts dropped | cracks |"
        );
        println!("|--:|--:|{}", "--:|".repeat(7));
        let document = Document::open(file, Limits::default()).map_err(|it| it.to_string())?;
        let mut sums = [[0; 5]; 2];
        for number in 0..document.meshes().len() {
            let (mesh, attributes) = read(&document, number)?;
            for (sum, attributes) in sums.iter_mut().zip([&attributes[..], &[]]) {
                let (row, torn) = row(&mesh, attributes)?;
                line(&number.to_string(), attributes.len(), row, torn);
                cracks += torn;
                for (sum, figure) in sum.iter_mut().zip(row) {
                    *sum += figure;
                }
            }
        }
        if document.meshes().len() > 1 {
            let [all, none] = sums;
            line("all", "all", all, "");
            line("all", 0, none, "");
        }
    }
    println!("\nCracks: {cracks}.");
    Ok(())
}

fn line(
    name: &str,
    attributes: impl std::fmt::Display,
    row: [usize; 5],
    cracks: impl std::fmt::Display,
) {
    let [faces, theirs, fast, best, dropped] = row;
    let ratio = fast as f64 / theirs as f64;
    println!(
        "| {name} | {attributes} | {faces} | {theirs} | {fast} | {best} | {ratio:.3} | {dropped} | {cracks} |"
    );
}

fn read(document: &Document, number: usize) -> Result<(Mesh, Vec<Attribute>), String> {
    let positions = document.positions(number).map_err(|it| it.to_string())?;
    let positions = positions.ok_or(format!("mesh {number} has no positions"))?;
    let faces = document.meshes()[number].mesh.faces();
    let mesh = Mesh::new(positions, faces).map_err(|it| it.to_string())?;
    let listed = document.attributes(number);
    let attributes = listed.iter().map(|info| document.attribute(number, info));
    let attributes = attributes.collect::<Result<_, _>>();
    Ok((mesh, attributes.map_err(|it| it.to_string())?))
}

/// Faces of a mesh, and the fewest of meshoptimizer, of either effort, and where parts may leave; then the
/// number of cracks in all of these.
fn row(mesh: &Mesh, attributes: &[Attribute]) -> Result<([usize; 5], usize), String> {
    let built = |effort, drop_parts| {
        let settings = Collapses {
            effort,
            drop_parts,
            cross_seams: true,
            ..Collapses::default()
        };
        let built = settings.build(mesh, attributes);
        built.map_err(|it| it.to_string())
    };
    let ours = [
        built(Effort::Fast, false)?,
        built(Effort::Best, false)?,
        built(Effort::Fast, true)?,
    ];
    let [fast, best, dropped] = ours.each_ref().map(|it| it.face_count(it.last_level()));

    // The same vertices for both: those that are equal count as one, and those of no face are left out.
    let same = Mesh::new(mesh.positions(), ours[0].faces()).map_err(|it| it.to_string())?;
    let used = first_use(&same);
    let theirs = rivals::simplified(&used, 0).len();
    let cracks = ours.iter().map(|it| cracks(mesh.positions(), it)).sum();
    Ok(([mesh.face_count(), theirs, fast, best, dropped], cracks))
}

/// The mesh with the vertices that faces use, in the order of their first use.
fn first_use(mesh: &Mesh) -> Mesh {
    let mut numbers = vec![None; mesh.vertex_count()];
    let mut positions = Vec::new();
    let mut number = |vertex: u32| {
        *numbers[vertex as usize].get_or_insert_with(|| {
            positions.push(mesh.positions()[vertex as usize]);
            u32::try_from(positions.len() - 1).expect("as many as there were, at most")
        })
    };
    let faces: Vec<_> = mesh
        .faces()
        .iter()
        .map(|face| face.map(&mut number))
        .collect();
    Mesh::new(positions, faces).expect("numbers of positions")
}

/// At some levels: positions whose vertices came apart, and border edges of the surface, welded by position,
/// that are new: more than there were, or with an end that was not on a border.
fn cracks(positions: &[[f32; 3]], mesh: &ProgressiveMesh) -> usize {
    let place = |vertex: u32| positions[vertex as usize].map(|x| (x + 0.0).to_bits());
    let before = border(mesh.faces(), place);
    let on_border: BTreeSet<Position> = before.iter().flatten().copied().collect();
    let mut is_used = vec![false; positions.len()];
    for &vertex in mesh.faces().as_flattened() {
        is_used[vertex as usize] = true;
    }
    let mut walk = Walk::new(mesh);
    let mut faces = Vec::new();
    let mut cracks = 0;
    for look in 1..=LOOKS {
        let level = mesh.last_level() * look / LOOKS;
        walk.go_to(level);
        walk.emit(&mut faces);
        let border = border(&faces, place);
        let is_new = |edge: &&[Position; 2]| edge.iter().any(|end| !on_border.contains(end));
        cracks += border.iter().filter(is_new).count();
        cracks += border.len().saturating_sub(before.len());

        let mut at: BTreeMap<Position, Option<Position>> = BTreeMap::new();
        for (vertex, to) in (0..).zip(mesh.fine_to_coarse(level)) {
            if !is_used[vertex as usize] {
                continue;
            }
            let to = to.map(place);
            cracks += usize::from(*at.entry(place(vertex)).or_insert(to) != to);
        }
    }
    cracks
}

/// The edges that have no opposite one, or not as often, by position; each as often as that.
fn border(faces: &[[u32; 3]], place: impl Fn(u32) -> Position) -> Vec<[Position; 2]> {
    let mut edges: BTreeMap<[Position; 2], i32> = BTreeMap::new();
    for face in faces {
        let [a, b, c] = face.map(&place);
        if a == b || b == c || c == a {
            continue;
        }
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *edges.entry([from.min(to), from.max(to)]).or_default() +=
                if from < to { 1 } else { -1 };
        }
    }
    let odd = edges.into_iter();
    odd.flat_map(|(edge, count)| std::iter::repeat_n(edge, count.unsigned_abs() as usize))
        .collect()
}
