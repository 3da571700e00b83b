//! Real height maps, and what the tests of each format share.

use std::path::{Path, PathBuf};

use super::{HeightMap, HeightMapOptions, MapPlacement};

mod damage;
mod images;
mod joins;
mod models;
mod tiff;

fn options() -> HeightMapOptions {
    HeightMapOptions::default()
}

fn read(name: &str, bytes: &[u8]) -> Result<HeightMap, String> {
    let read = HeightMap::from_bytes(name.as_ref(), bytes, &options());
    read.map_err(|error| error.to_string())
}

fn error(name: &str, bytes: &[u8]) -> String {
    read(name, bytes).unwrap_err()
}

/// The heights of a grid of that many places.
fn heights<const N: usize>(map: &HeightMap) -> [f32; N] {
    map.grid.heights().try_into().expect("as many places")
}

/// A small file of each kind, and its name.
fn samples_of_all_kinds() -> Vec<(&'static str, Vec<u8>)> {
    let tile = (0..18).collect();
    let mut all = vec![
        ("N00E000.hgt", tile),
        ("text.pgm", b"P2 3 2 999\n1 2 3\n40 50 600\n".to_vec()),
        (
            "a.pgm",
            b"P5 3 2 999\n\0\x01\0\x02\0\x03\x01\0\x02\0\x03\0".to_vec(),
        ),
    ];
    all.extend(images::samples().into_iter().map(|bytes| ("a.png", bytes)));
    all.push(("a.dem", models::sample()));
    all.extend(tiff::samples().into_iter().map(|bytes| ("a.tif", bytes)));
    all
}

/// A real height map; the run fails without it where that was asked for.
fn real(name: &str) -> Option<PathBuf> {
    let data = std::env::var_os("MESHWEFT_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
        PathBuf::from,
    );
    let path = data.join("terrain").join(name);
    let is_required = std::env::var_os("MESHWEFT_REQUIRE_DATA").is_some();
    match path.is_file() {
        true => Some(path),
        false if is_required => panic!("{} is missing", path.display()),
        false => {
            eprintln!("skipped: {} is missing", path.display());
            None
        }
    }
}

fn open(path: &Path) -> HeightMap {
    HeightMap::open(path, &HeightMapOptions::default()).unwrap()
}

#[test]
fn a_model_in_profiles_has_the_samples_of_its_image() {
    let (Some(dem), Some(image)) = (real("sainte_helens.dem.gz"), real("sainte_helens.pgm.gz"))
    else {
        return;
    };
    assert!(HeightMap::is_height_map(&dem) && HeightMap::is_height_map(&image));
    let dem = open(&dem);
    // What lies outside is 0 in the image, and an image has no void of its own.
    let mut options = HeightMapOptions::default();
    assert_eq!(
        HeightMap::open(&image, &options).unwrap().grid.void_count(),
        0
    );
    options.no_data = Some(0.0);
    let image = HeightMap::open(&image, &options).unwrap();

    assert_eq!(dem.grid.size(), image.grid.size());
    assert_eq!(dem.grid.spacing(), [30.0, 30.0]);
    let bits = |map: &HeightMap| map.grid.heights().iter().map(|it| it.to_bits()).collect();
    let (found, expected): (Vec<u32>, Vec<u32>) = (bits(&dem), bits(&image));
    assert!(
        found == expected,
        "{} and {} voids",
        dem.grid.void_count(),
        image.grid.void_count()
    );
    assert_eq!(
        dem.placement,
        MapPlacement::Projected {
            easting: 557_820.0,
            northing: 5_121_960.0,
            step: [30.0, 30.0],
            system: "UTM zone 10".to_owned(),
        }
    );
}

#[test]
fn a_tile_lies_where_its_name_says() {
    let Some(path) = real("N47W123.hgt.gz") else {
        return;
    };
    let map = open(&path);
    assert_eq!(map.grid.size(), [1201, 1201]);
    assert_eq!(
        map.placement,
        MapPlacement::Degrees {
            west: -123.0,
            north: 48.0,
            step: [1.0 / 1200.0; 2],
        }
    );
    // At 47.5 degrees north, by the series of tables: 75,343.5 and 111,180.6 metres a degree.
    let [x, z] = map.grid.spacing();
    assert!(
        (x - 62.786).abs() < 0.001 && (z - 92.650).abs() < 0.001,
        "{x} {z}"
    );
}

#[test]
fn an_image_has_the_spacing_that_is_given() {
    let Some(path) = real("gcanyon_elev_crop.bw.png") else {
        return;
    };
    let map = open(&path);
    assert_eq!(
        (map.grid.size(), map.grid.spacing()),
        ([1200, 1200], [1.0, 1.0])
    );
    assert!(map.notes[0].text.contains("one metre is assumed"));
    let options = HeightMapOptions {
        spacing: Some([60.0, 61.0]),
        height_scale: Some(10.0),
        ..Default::default()
    };
    let scaled = HeightMap::open(&path, &options).unwrap();
    assert_eq!(
        (scaled.grid.spacing(), scaled.notes.len()),
        ([60.0, 61.0], 0)
    );
    let pairs = map.grid.heights().iter().zip(scaled.grid.heights());
    assert!(pairs.clone().all(|(one, ten)| one * 10.0 == *ten));
    let extremes = map
        .grid
        .heights()
        .iter()
        .fold([f32::MAX, f32::MIN], |[low, high], &it| {
            [low.min(it), high.max(it)]
        });
    assert_eq!(extremes, [35.0, 187.0]);
}
