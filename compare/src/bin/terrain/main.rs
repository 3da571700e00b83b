//! Terrain against its rivals: faces at equal true error, and eviction policies; as Markdown.
//!
//! ```text
//! cargo run --release --bin terrain -- [--table faces|policies]...
//! ```
//!
//! Grids are 1025 by 1025 samples of the SRTM tiles of the test data, their north-west corners: martini takes no other size. Errors are
//! true ones, vertical: of every sample, how far it is from the face above or below it.

mod faces;
mod policies;
mod raster;

use std::process::ExitCode;

use meshweft::HeightGrid;

/// The tiles; the last one is that of the paths.
const TILES: [&str; 3] = ["N47W123", "N48W123", "N47W122"];
/// Samples a side of a tile, and of what is taken of it.
const TILE_SIDE: usize = 1201;
const SIDE: usize = 1025;
/// Metres between samples, as if it were both ways: 3 seconds of arc to the north.
const SPACING: f64 = 90.0;

/// A table of some grids.
type PrintTable = fn(&[(&str, HeightGrid)]) -> Result<(), String>;

const TABLES: [(&str, PrintTable); 2] = [("faces", faces::print), ("policies", policies::print)];

fn main() -> ExitCode {
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let mut tables = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--table" => {
                let name = arguments.next().ok_or("--table needs a name")?;
                let table = TABLES.iter().find(|table| table.0 == name);
                let names = || TABLES.map(|(name, _)| name).join(", ");
                tables.push(table.ok_or_else(|| format!("--table {name}: give {}", names()))?);
            }
            other => return Err(format!("{other} is not a flag")),
        }
    }
    if tables.is_empty() {
        tables.extend(&TABLES);
    }

    let folder = compare::needed_data_folder()?.join("terrain");
    let grids: Result<Vec<_>, String> = TILES
        .iter()
        .map(|name| Ok((*name, crop(&folder.join(format!("{name}.hgt.gz")))?)))
        .collect();
    let grids = grids?;
    for (name, print) in tables {
        println!("\n## {name}\n");
        print(&grids)?;
    }
    Ok(())
}

/// The north-west corner of a tile, read without meshweft's own readers.
fn crop(file: &std::path::Path) -> Result<HeightGrid, String> {
    let packed = std::fs::read(file).map_err(|it| format!("{}: {it}", file.display()))?;
    let mut bytes = Vec::new();
    let mut decoder = flate2::read::GzDecoder::new(&packed[..]);
    std::io::Read::read_to_end(&mut decoder, &mut bytes).map_err(|it| it.to_string())?;
    let samples: Vec<f32> = bytes
        .chunks_exact(2)
        .map(|it| f32::from(i16::from_be_bytes([it[0], it[1]])))
        .collect();
    let rows = samples.chunks_exact(TILE_SIDE).take(SIDE);
    let heights = rows.flat_map(|row| &row[..SIDE]).copied().collect();
    let size = [u32::try_from(SIDE).map_err(|it| it.to_string())?; 2];
    HeightGrid::new(size, [SPACING; 2], heights).map_err(|it| it.to_string())
}
