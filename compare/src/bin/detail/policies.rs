//! Eviction policies against the fewest inserts that are possible.

use compare::eviction::{self, PolicyTable, USUAL_SLOTS};
use meshweft::lod::geometry_cache::RecordedPath;

use crate::scene::Scene;
use crate::{FRAMES, PATHS};

/// So that slots are scarce.
const TOLERANCE: f64 = 0.18;

pub(crate) fn print(scenes: &[Scene]) -> Result<(), String> {
    println!(
        "Inserts over the fewest possible (Belady), {FRAMES} frames at {TOLERANCE} pixels; slots 1.25 and 2 times the most active \
         vertices of the path, and {USUAL_SLOTS}.\n"
    );
    eviction::print_head();
    let mut tables = Vec::new();
    for scene in scenes {
        let count = u32::try_from(scene.hierarchy.vertex_count()).map_err(|it| it.to_string())?;
        let errors: Vec<f32> = (0..count).map(|it| scene.hierarchy.error(it)).collect();
        let mut table = PolicyTable::new(&scene.name);
        for (letter, camera_path) in &PATHS {
            table.print_path(letter, &recorded(scene, camera_path)?, &errors)?;
        }
        tables.push(table);
    }
    PolicyTable::print_means(&tables);
    Ok(())
}

/// What the frames of a path change.
fn recorded(
    scene: &Scene,
    path: &meshweft::operations::CameraPath,
) -> Result<RecordedPath, String> {
    let mut front = scene.front();
    let roots: Vec<u32> = front.vertices().collect();
    let mut recorded = RecordedPath::new(scene.hierarchy.vertex_count());
    for (frame, camera) in scene.cameras(path, FRAMES).enumerate() {
        let view = camera.view(TOLERANCE).map_err(|it| it.to_string())?;
        let changes = front.update(&view, 1.0);
        let mut added = changes.added_vertices.clone();
        if frame == 0 {
            added.extend(&roots);
        }
        let pushed = recorded.push_change(&added, &changes.removed_vertices);
        pushed.map_err(|it| it.to_string())?;
    }
    Ok(recorded)
}
