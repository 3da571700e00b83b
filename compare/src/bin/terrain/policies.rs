//! Eviction policies on paths over a terrain.

use std::f64::consts::TAU;

use compare::eviction::{self, PolicyTable, USUAL_SLOTS};
use meshweft::HeightGrid;
use meshweft::lod::Camera;
use meshweft::lod::geometry_cache::RecordedPath;
use meshweft::lod::quad_tin::{QuadTin, TinSurface};

use crate::{SIDE, SPACING};

/// So that slots are scarce.
const TOLERANCE: f64 = 2.0;
const FRAMES: usize = 3000;
/// Of the picture, in pixels.
const SIZE: [u32; 2] = [1024, 768];
const PATHS: [&str; 4] = ["A", "B", "C", "D"];

pub(crate) fn print(grids: &[(&str, HeightGrid)]) -> Result<(), String> {
    println!(
        "Inserts over the fewest possible (Belady), {FRAMES} frames at {TOLERANCE} pixels; slots 1.25 and 2 times the most active \
         vertices of the path, and {USUAL_SLOTS}. Paths: A circle, B turning, C straight on, D flight.\n"
    );
    eviction::print_head();
    let mut tables = Vec::new();
    for (name, grid) in grids {
        let tin = QuadTin::over_grid(grid).map_err(|it| it.to_string())?;
        let count = u32::try_from(tin.vertex_count()).map_err(|it| it.to_string())?;
        let errors: Vec<f32> = (0..count).map(|it| tin.error(it)).collect();
        let mut table = PolicyTable::new(name);
        for path in PATHS {
            table.print_path(path, &recorded(&tin, path)?, &errors)?;
        }
        tables.push(table);
    }
    PolicyTable::print_means(&tables);
    Ok(())
}

fn recorded(tin: &QuadTin, path: &str) -> Result<RecordedPath, String> {
    let mut recorded = RecordedPath::new(tin.vertex_count());
    let mut surface = TinSurface::default();
    for frame in 0..FRAMES {
        let view = camera(path, frame as f64 / FRAMES as f64).view(TOLERANCE);
        tin.draw(&view.map_err(|it| it.to_string())?, &mut surface);
        let active: Vec<u32> = surface.faces().iter().flat_map(|it| it.1).collect();
        recorded.push_active(&active).map_err(|it| it.to_string())?;
    }
    Ok(recorded)
}

/// A camera of a path, by the part of it that lies behind: eyes in metres above 0.
fn camera(path: &str, done: f64) -> Camera {
    let a = TAU * done;
    let width = (SIDE - 1) as f64 * SPACING;
    let (eye, ahead) = match path {
        "A" => (
            [0.25 * width * a.cos(), 3000.0, 0.25 * width * a.sin()],
            [-a.sin(), -0.12, a.cos()],
        ),
        "B" => ([0.0, 3000.0, 0.0], [a.cos(), -0.12, a.sin()]),
        "C" => (
            [(0.9 * done - 0.45) * width, 3000.0, 0.0],
            [1.0, -0.12, 0.0],
        ),
        _ => {
            let b = 1.7 * a + 1.2 * (4.0 * a).sin();
            let across = [
                0.3 * width * (1.3 * a).sin(),
                0.3 * width * (2.1 * a + 0.7).sin(),
            ];
            (
                [across[0], 2800.0 + 900.0 * (3.0 * a).sin(), across[1]],
                [b.cos(), -0.15, b.sin()],
            )
        }
    };
    Camera {
        eye,
        target: [0, 1, 2].map(|i| eye[i] + ahead[i]),
        up: [0.0, 1.0, 0.0],
        field_of_view: 45.0,
        size: SIZE,
    }
}
