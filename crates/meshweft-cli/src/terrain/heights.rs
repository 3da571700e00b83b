//! How height maps are read, as flags.

use std::path::PathBuf;

use clap::Args;
use meshweft::files::Note;
use meshweft::operations::{TerrainFacts, TerrainReadOptions};

use crate::run::arguments::Size;
use crate::run::output;

// No doc comment: clap would take it for the text about a verb.
#[derive(Debug, Args)]
#[command(next_display_order = 60)]
pub(super) struct Heights {
    /// Fill voids of height maps from their surroundings; they are holes otherwise
    #[arg(long)]
    fill: bool,
    /// How far columns and rows of height maps are apart, in metres: one number for both, or two. Needed of images, which do not say it
    #[arg(long, value_name = "DX,DY", value_parser = spacing)]
    spacing: Option<[f64; 2]>,
    /// What to multiply the heights of height maps with to have metres
    #[arg(long, allow_negative_numbers = true, value_name = "S")]
    height_scale: Option<f64>,
    /// A value in height maps that stands for no height
    #[arg(long, allow_negative_numbers = true, value_name = "V")]
    no_data: Option<f64>,
    /// Which coordinate of points and meshes is the height. With z, x is east and y north; with y, as in outputs, x is east and z south
    #[arg(long, value_name = "AXIS", value_parser = ["y", "z"], default_value = "y")]
    up: String,
}

impl Heights {
    pub(super) fn options(&self, size: &Size) -> TerrainReadOptions {
        let mut options = TerrainReadOptions::default();
        options.fill_voids = self.fill;
        options.maps.limits = size.limits();
        options.maps.spacing = self.spacing;
        options.maps.height_scale = self.height_scale;
        options.maps.no_data = self.no_data;
        options.is_z_up = self.up == "z";
        options
    }
}

/// A distance for columns and one for rows, such as `30,30` or `30`.
fn spacing(text: &str) -> Result<[f64; 2], String> {
    let (x, z) = text.split_once(',').unwrap_or((text, text));
    let distance = |text: &str| {
        text.trim()
            .parse()
            .ok()
            .filter(|it| *it > 0.0 && f64::is_finite(*it))
    };
    let both = distance(x).zip(distance(z));
    let both = both.map(|(x, z)| [x, z]);
    both.ok_or_else(|| {
        "give one or two distances in metres above 0, such as 30 or 30,20".to_owned()
    })
}

/// What the readers say, a line each.
pub(super) fn note_lines(notes: &[(PathBuf, Note)]) -> Vec<String> {
    let lines = notes
        .iter()
        .flat_map(|(file, note)| output::note_lines(file, std::slice::from_ref(note)));
    lines.collect()
}

/// What there is, for people.
pub(super) fn told(terrain: &TerrainFacts) -> String {
    let [low, high] = terrain.heights;
    let grid = terrain.grid_size.zip(terrain.grid_spacing);
    let places = match grid {
        Some(([columns, rows], [x, z])) => {
            format!("{columns} columns, {rows} rows, {x:.3} by {z:.3} m apart")
        }
        None => format!("vertices {}", terrain.vertices),
    };
    format!(
        "{places}; heights {low} to {high} m; faces {}",
        terrain.faces
    )
}

#[cfg(test)]
mod tests {
    use super::spacing;

    #[test]
    fn one_distance_is_for_both() {
        assert_eq!(spacing("30"), Ok([30.0, 30.0]));
        assert_eq!(spacing("30, 20.5"), Ok([30.0, 20.5]));
        for text in ["", "0", "30,", ",", "-1,3", "nan", "inf,1", "1,2,3"] {
            assert!(spacing(text).is_err(), "{text}");
        }
    }
}
