//! How far levels of glTF scenes are from the scenes, compared with what gltfpack leaves.

mod contest;
mod gltfpack;
mod object;
mod our_levels;
mod summary;

use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::Document;

pub(crate) use contest::Variants;

use contest::Contest;
use summary::ScenesSummary;

/// Scenes with fewer have no use for levels.
const LEAST_FACES: usize = 500;

/// The scenes of the test data, sorted by name.
pub(crate) fn files(data: &Path) -> Vec<PathBuf> {
    let mut folders = vec![data.join("gltf")];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).expect("the folder of scenes can be listed");
        for entry in entries {
            let path = entry.expect("an entry of the folder of scenes").path();
            let ending = path.extension().unwrap_or_default();
            match path.is_dir() {
                true => folders.push(path),
                false if ending == "glb" || ending == "gltf" => files.push(path),
                false => {}
            }
        }
    }
    files.sort();
    files
}

/// Whether numbers of faces that are so far apart are as good as the same.
fn are_near(apart: usize, face_count: usize) -> bool {
    apart <= 2 + face_count / 100
}

/// Prints a table of all scenes, then the means; `samples` points of either surface are measured, of all
/// objects of a scene together.
pub(crate) fn print(files: &[PathBuf], samples: usize, variants: &Variants) -> Result<(), String> {
    let ratios = variants.percents.iter();
    let ratios = ratios.map(|&percent| (percent as f64 / 100.0).to_string());
    let ratios = ratios.collect::<Vec<_>>().join(",");
    println!(
        "Two-sided distances in ten thousandths of the diagonal of the scene's largest object, objects as large as they are \
         drawn; means are weighed by the objects' areas.\n\n\
         Ours are the levels that `levels --ratios {ratios}` puts into the scene, as they are read from there: one \
         error for all objects, so that each has its own share of the faces. Where that stops above what was asked for, the \
         row is of what it leaves. gltfpack is asked, primitive by primitive, for as many faces as ours has there, and \
         prunes parts or does not, as is better. Where it cannot get near that, ours is made again with as many faces as \
         gltfpack has in all, if they are nearer each other then. Where ours still has more faces in some primitives, by \
         more than one in a hundred of all and two, the row is shown, and is in no mean but that of all rows; where \
         gltfpack has more, that is for gltfpack.\n\n\
         Of each effort: the faces of both, gltfpack's distance and ours over it. Last, whether ours stops above, how many \
         faces gltfpack has more in some primitives and fewer in others, and how many objects of it are better without \
         pruning.\n"
    );
    summary::print_head();
    let mut summary = ScenesSummary::default();
    let mut left_out = Vec::new();
    for file in files {
        let name = compare::mesh_name(file);
        let document = Document::open(file, Limits::default());
        let document = document.map_err(|it| it.to_string())?;
        let faces = document.meshes().iter().map(|it| it.mesh.face_count());
        let faces: usize = faces.sum();
        if faces < LEAST_FACES {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            left_out.push(format!("{name} ({faces})"));
            continue;
        }
        let contest = Contest::new(file, samples, variants)?;
        for &percent in &variants.percents {
            let rows = contest.rows(&name, percent)?;
            for row in rows.iter().skip(1).chain(&rows[..1]) {
                row.print();
            }
            summary.add(rows.into_iter().next().expect("that of the scene"));
        }
    }
    summary.print(&variants.percents);
    println!(
        "\nLeft out, with fewer than {LEAST_FACES} faces that are not compressed: {}.",
        left_out.join(", ")
    );
    Ok(())
}
