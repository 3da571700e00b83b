//! Terrains as files, and surfaces taken from them.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use super::build::terrain_build;
use super::error::TerrainError;
use super::extract::{TerrainDetail, TerrainExtractOptions, terrain_extract};
use super::heights::{TerrainHeights, TerrainReadOptions, TerrainSamples};
use super::source::TerrainSource;
use crate::height_grid::HeightGrid;
use crate::limits::Limits;
use crate::lod::Camera;
use crate::lod::quad_tin::tests::hills;
use crate::operations::data_folder;
use crate::random::SplitMix64;

fn bytes_of(grid: &HeightGrid) -> Vec<u8> {
    let heights = TerrainHeights::of_grid("hills", grid.clone());
    let mut built = terrain_build(heights, &|| 0.0).unwrap();
    let mut file = Cursor::new(Vec::new());
    built.write(&mut file).unwrap();
    let bytes = file.into_inner();
    assert_eq!(built.report.bytes_after, Some(bytes.len() as u64));
    bytes
}

fn stored(bytes: &[u8]) -> TerrainSource {
    let bytes = Cursor::new(bytes.to_vec());
    TerrainSource::stored(Path::new("hills.mwt"), bytes, Limits::default()).unwrap()
}

fn of_grid(grid: &HeightGrid) -> TerrainSource {
    TerrainSource::of_heights(TerrainHeights::of_grid("hills", grid.clone())).unwrap()
}

#[test]
fn a_surface_of_a_file_is_that_of_its_heights() {
    let mut random = SplitMix64(5);
    let camera = Camera {
        eye: [0.0, 200.0, 0.0],
        target: [100.0, 0.0, 300.0],
        up: [0.0, 1.0, 0.0],
        field_of_view: 45.0,
        size: [640, 480],
    };
    for (size, voids) in [([17, 17], 0), ([100, 60], 5), ([129, 129], 0)] {
        let grid = hills(size, voids, &mut random);
        let bytes = bytes_of(&grid);
        for detail in [
            TerrainDetail::Error(0.0),
            TerrainDetail::Error(3.0),
            TerrainDetail::Faces(1500),
            TerrainDetail::Camera {
                camera,
                tolerance: 2.0,
            },
        ] {
            let options = TerrainExtractOptions::new(detail);
            let [own, read] = [of_grid(&grid), stored(&bytes)]
                .map(|source| terrain_extract(source, &options).unwrap());
            assert_eq!(own.mesh.faces(), read.mesh.faces());
            let bits = |mesh: &crate::mesh::Mesh| {
                let positions = mesh.positions().iter();
                positions.map(|it| it.map(f32::to_bits)).collect::<Vec<_>>()
            };
            assert_eq!(bits(&own.mesh), bits(&read.mesh));
            assert_eq!(own.report.error, read.report.error);
            assert_eq!((own.report.bytes, read.name.as_str()), (None, "hills"));
            let [length, bytes_read] = read.report.bytes.unwrap();
            assert!(bytes_read <= length && length == bytes.len() as u64);

            // By their first use, and each face counter-clockwise seen from above.
            let mut next = 0;
            for &corner in own.mesh.faces().as_flattened() {
                assert!(corner <= next);
                next += u32::from(corner == next);
            }
            assert_eq!(next as usize, own.mesh.vertex_count());
            for face in own.mesh.faces() {
                let [a, b, c] = face.map(|it| own.mesh.positions()[it as usize]);
                let up = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
                assert!(up > 0.0);
            }
            match detail {
                TerrainDetail::Error(length) => assert!(f64::from(own.report.error) <= length),
                TerrainDetail::Faces(most) => assert!(own.mesh.face_count() <= most),
                TerrainDetail::Camera { .. } => {}
            }
            if detail == TerrainDetail::Error(0.0) {
                assert_eq!(own.mesh.face_count() as u64, own.report.terrain.faces);
            }
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let grid = hills([40, 30], 4, &mut SplitMix64(9));
    let extract =
        |detail| terrain_extract(of_grid(&grid), &TerrainExtractOptions::new(detail)).unwrap_err();
    let text = extract(TerrainDetail::Error(-1.0)).to_string();
    assert_eq!(text, "error -1: give a number of metres, 0 for all heights");
    assert!(matches!(
        extract(TerrainDetail::Error(f64::NAN)),
        TerrainError::Option(_)
    ));
    let error = extract(TerrainDetail::Faces(3));
    let TerrainError::TooFewFaces { least, .. } = error else {
        panic!("{error}");
    };
    assert!(least > 3 && error.to_string().contains("give "), "{error}");
    let options = TerrainExtractOptions::new(TerrainDetail::Faces(least));
    let coarsest = terrain_extract(of_grid(&grid), &options).unwrap();
    assert_eq!(coarsest.mesh.face_count(), least);

    let void = HeightGrid::new([3, 3], [1.0; 2], vec![f32::NAN; 9]).unwrap();
    let error = terrain_build(TerrainHeights::of_grid("void", void), &|| 0.0).unwrap_err();
    assert!(error.to_string().starts_with("void: the grid has no three"));

    // A file that was cut is refused when a block is missed.
    let bytes = bytes_of(&grid);
    let cut = Cursor::new(bytes[..bytes.len() - 1].to_vec());
    let cut = TerrainSource::stored(Path::new("cut.mwt"), cut, Limits::default());
    assert!(cut.unwrap_err().to_string().starts_with("cut.mwt: byte "));
}

/// A file that loses a bit on its way to the disk.
struct Forgetful(Cursor<Vec<u8>>);

impl std::io::Write for Forgetful {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let mut bytes = bytes.to_vec();
        if let Some(last) = bytes.last_mut() {
            *last ^= 1;
        }
        std::io::Write::write(&mut self.0, &bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl std::io::Read for Forgetful {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.0.read(buffer)
    }
}

impl std::io::Seek for Forgetful {
    fn seek(&mut self, to: std::io::SeekFrom) -> std::io::Result<u64> {
        self.0.seek(to)
    }
}

#[test]
fn what_is_written_is_read_back() {
    let grid = hills([20, 20], 0, &mut SplitMix64(2));
    let mut built = terrain_build(TerrainHeights::of_grid("hills", grid), &|| 0.0).unwrap();
    let error = built.write(&mut Forgetful(Cursor::new(Vec::new())));
    assert!(matches!(error, Err(TerrainError::Stored { .. })));
    assert_eq!(built.report.bytes_after, None);
}

/// The tiles of the Puget Sound, of which one has voids, and a quarter is missing.
#[test]
fn real_tiles_become_one_terrain() {
    let Some(folder) = data_folder::folder() else {
        return;
    };
    let tile = |name: &str| folder.join("terrain").join(name);
    let paths: Vec<PathBuf> = ["N47W123.hgt.gz", "N48W123.hgt.gz", "N47W122.hgt.gz"]
        .map(tile)
        .to_vec();
    let mut options = TerrainReadOptions::default();
    let heights = TerrainHeights::open(&paths, &options).unwrap();
    assert_eq!(
        (heights.grid().unwrap().size(), heights.name.as_str()),
        ([2401, 2401], "N47W123")
    );
    assert_eq!(
        (heights.disagreeing, heights.largest_disagreement),
        (1243, 31.0)
    );
    assert!(heights.voids >= 1200 * 1200 && heights.filled == 0);

    let mut built = terrain_build(heights, &|| 0.0).unwrap();
    let mut file = Cursor::new(Vec::new());
    built.write(&mut file).unwrap();
    let bytes = file.into_inner();
    let options_10 = TerrainExtractOptions::new(TerrainDetail::Error(10.0));
    let extracted = terrain_extract(stored(&bytes), &options_10).unwrap();
    assert!(extracted.report.error <= 10.0);
    assert!(extracted.mesh.face_count() as u64 * 4 < built.report.terrain.faces);

    options.fill_voids = true;
    let filled = TerrainHeights::open(&paths, &options).unwrap();
    let left = filled.grid().unwrap().void_count();
    assert_eq!((filled.filled, left), (filled.voids, 0));
    let error = TerrainHeights::open(&[folder.join("index.tsv")], &options);
    assert!(matches!(error, Err(TerrainError::NoTerrain { .. })));
    let mixed = [tile("N47W123.hgt.gz"), folder.join("meshes/spot.obj.gz")];
    let error = TerrainHeights::open(&mixed, &options);
    assert!(matches!(error, Err(TerrainError::Mixed { .. })));
}

#[test]
fn vertices_of_a_mesh_are_points_of_a_terrain() {
    let Some(folder) = data_folder::folder() else {
        return;
    };
    let paths = [folder.join("meshes/mountain.obj.gz")];
    for is_z_up in [false, true] {
        let options = TerrainReadOptions {
            is_z_up,
            ..TerrainReadOptions::default()
        };
        let heights = TerrainHeights::open(&paths, &options).unwrap();
        let TerrainSamples::Points(points) = heights.samples.clone() else {
            panic!("a mesh is points");
        };
        let mut built = terrain_build(heights, &|| 0.0).unwrap();
        let counts = built.report.points.unwrap();
        assert_eq!(counts.points as usize, points.len());
        let kept = counts.points - counts.duplicates - counts.not_finite - counts.left_out;
        let vertices = (kept + counts.steiner) as usize;
        assert_eq!(built.report.terrain.vertices, vertices);

        // All that were kept come back.
        let mut file = Cursor::new(Vec::new());
        built.write(&mut file).unwrap();
        let all = TerrainExtractOptions::new(TerrainDetail::Error(0.0));
        let extracted = terrain_extract(stored(&file.into_inner()), &all).unwrap();
        assert_eq!(extracted.mesh.vertex_count(), vertices);
        let bits = |it: &[f32; 3]| it.map(f32::to_bits);
        let found: std::collections::BTreeSet<[u32; 3]> =
            extracted.mesh.positions().iter().map(bits).collect();
        let missing = points.iter().filter(|&it| !found.contains(&bits(it)));
        let left_out = counts.duplicates + counts.not_finite + counts.left_out;
        assert!(missing.count() <= left_out as usize);
    }
    let line = vec![[0.0; 3], [1.0, 5.0, 1.0], [2.0, 7.0, 2.0]];
    let error = terrain_build(TerrainHeights::of_points("line", line), &|| 0.0).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("line: seen from above, all points are on one line")
    );
}
