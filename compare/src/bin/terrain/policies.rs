//! Eviction policies on paths over a terrain.

use compare::eviction::{self, PolicyTable, USUAL_SLOTS};
use meshweft::HeightGrid;
use meshweft::lod::geometry_cache::RecordedPath;
use meshweft::lod::quad_tin::TinSurface;
use meshweft::operations::{BuiltTerrain, TerrainHeights, TerrainPath, terrain_build};

/// So that slots are scarce.
const TOLERANCE: f64 = 2.0;
const FRAMES: usize = 3000;
/// Of the picture, in pixels.
const SIZE: [u32; 2] = [1024, 768];
/// The paths with the letters that they have in tables.
const PATHS: [(&str, TerrainPath); 4] = [
    ("A", TerrainPath::Circle),
    ("B", TerrainPath::Rotate),
    ("C", TerrainPath::Straight),
    ("D", TerrainPath::Fly),
];

pub(crate) fn print(grids: &[(&str, HeightGrid)]) -> Result<(), String> {
    println!(
        "Inserts over the fewest possible (Belady), {FRAMES} frames at {TOLERANCE} pixels; slots 1.25 and 2 times the most active \
         vertices of the path, and {USUAL_SLOTS}. Paths: A circle, B turning, C straight on, D flight.\n"
    );
    eviction::print_head();
    let mut tables = Vec::new();
    for (name, grid) in grids {
        let heights = TerrainHeights::of_grid(name, grid.clone());
        let terrain = terrain_build(heights, &|| 0.0).map_err(|it| it.to_string())?;
        let tin = &terrain.tin;
        let count = u32::try_from(tin.vertex_count()).map_err(|it| it.to_string())?;
        let errors: Vec<f32> = (0..count).map(|it| tin.error(it)).collect();
        let mut table = PolicyTable::new(name);
        for (letter, path) in &PATHS {
            table.print_path(letter, &recorded(&terrain, path)?, &errors)?;
        }
        tables.push(table);
    }
    PolicyTable::print_means(&tables);
    Ok(())
}

fn recorded(terrain: &BuiltTerrain, path: &TerrainPath) -> Result<RecordedPath, String> {
    let tin = &terrain.tin;
    let mut recorded = RecordedPath::new(tin.vertex_count());
    let mut surface = TinSurface::default();
    for frame in 0..FRAMES {
        let camera = path.camera(&terrain.report.terrain, frame, FRAMES, SIZE);
        let view = camera.view(TOLERANCE);
        tin.draw(&view.map_err(|it| it.to_string())?, &mut surface);
        let active: Vec<u32> = surface.faces().iter().flat_map(|it| it.1).collect();
        recorded.push_active(&active).map_err(|it| it.to_string())?;
    }
    Ok(recorded)
}
