//! Walks over terrains, and how far these are off.

use std::io::Cursor;
use std::path::Path;

use super::build::terrain_build;
use super::error::TerrainError;
use super::heights::{TerrainHeights, TerrainReadOptions};
use super::paths::TerrainPath;
use super::source::{TerrainFacts, TerrainSource};
use super::verify::terrain_verify;
use super::verify_options::TerrainVerifyOptions;
use super::walk::{TerrainWalk, TerrainWalker, terrain_walk};
use super::walk_options::TerrainWalkOptions;
use crate::height_grid::HeightGrid;
use crate::limits::Limits;
use crate::lod::geometry_cache::EvictionPolicy;
use crate::lod::quad_tin::tests::hills;
use crate::lod::quad_tin::{QuadTin, TinLimit, TinSurface};
use crate::operations::data_folder;
use crate::operations::walks::{WalkFrame, WalkQuantity};
use crate::random::SplitMix64;

fn of_grid(grid: &HeightGrid) -> TerrainSource {
    TerrainSource::of_heights(TerrainHeights::of_grid("hills", grid.clone())).unwrap()
}

fn stored(grid: &HeightGrid) -> TerrainSource {
    let heights = TerrainHeights::of_grid("hills", grid.clone());
    let mut file = Cursor::new(Vec::new());
    terrain_build(heights, &|| 0.0)
        .unwrap()
        .write(&mut file)
        .unwrap();
    TerrainSource::stored(Path::new("hills.mwt"), file, Limits::default()).unwrap()
}

fn options(path: TerrainPath, frames: usize) -> TerrainWalkOptions {
    TerrainWalkOptions {
        path,
        frames: Some(frames),
        ..TerrainWalkOptions::default()
    }
}

fn of_policies(options: &TerrainWalkOptions) -> Vec<TerrainWalkOptions> {
    let of_policy = |policy| TerrainWalkOptions {
        policy,
        ..options.clone()
    };
    EvictionPolicy::ALL.map(of_policy).to_vec()
}

#[test]
fn a_frame_draws_the_surface_of_its_view() {
    let mut random = SplitMix64(11);
    for (size, voids) in [([129, 129], 0), ([150, 90], 4)] {
        let grid = hills(size, voids, &mut random);
        let tin = QuadTin::over_grid(&grid).unwrap();
        let facts = TerrainFacts::of(&tin);
        for (path, limit) in [
            (TerrainPath::Fly, None),
            (TerrainPath::Straight, Some(2000)),
        ] {
            let options = TerrainWalkOptions {
                limit,
                ..options(path, 30)
            };
            let mut walker = TerrainWalker::new(of_grid(&grid));
            let mut walk = TerrainWalk::new(&of_policies(&options)).unwrap();
            let mut expected = TinSurface::default();
            for number in 0..30 {
                let view = options.view(&facts, number, 30).unwrap();
                let frames = walker.frame(&mut walk, &view, number, &|| 0.0).unwrap();
                match limit {
                    None => tin.draw(&view, &mut expected),
                    Some(limit) => tin.draw_within(TinLimit::Vertices(limit), &view, &mut expected),
                }
                assert_eq!(walk.surface.surface.faces(), expected.faces());

                // What every index buffer draws is that, by the numbers of the walk.
                let mut numbered: Vec<[u32; 3]> = expected
                    .faces()
                    .iter()
                    .map(|it| it.1.map(|vertex| walk.surface.vertices.number(vertex).0))
                    .collect();
                numbered.sort_unstable();
                let mut vertices = numbered.concat();
                vertices.sort_unstable();
                vertices.dedup();
                assert_eq!(frames.len(), walk.buffers.len());
                for (frame, buffers) in frames.iter().zip(&walk.buffers) {
                    assert_eq!(frame.faces, expected.faces().len());
                    assert!(buffers.indices.is_true_to(&buffers.cache));
                    let mut drawn: Vec<[u32; 3]> = buffers.indices.corners().to_vec();
                    drawn.retain(|&corners| corners != [0; 3]);
                    drawn.sort_unstable();
                    assert_eq!(drawn, numbered);
                    assert_eq!(frame.vertices, vertices.len());
                    assert!(vertices.iter().all(|&it| buffers.cache.is_active(it)));
                    assert_eq!(buffers.cache.vertices(), walk.surface.vertices.len());
                }
            }
        }
    }
}

#[test]
fn policies_side_by_side_send_what_each_sends_alone() {
    let grid = hills([200, 150], 2, &mut SplitMix64(8));
    let mut walker = TerrainWalker::new(of_grid(&grid));
    for path in TerrainPath::SHAPES {
        // With slots for all frames, with too few for some, and these in passes.
        for (slots, passes) in [(65_536, false), (1200, false), (1200, true)] {
            let options = TerrainWalkOptions {
                optimum: true,
                slots,
                passes,
                ..options(path.clone(), 30)
            };
            let policies = match passes {
                false => &EvictionPolicy::ALL[..],
                true => &[EvictionPolicy::OldestFirst, EvictionPolicy::FinestFirst],
            };
            let reports = walker.walk(&options, policies, &|| 0.0, &()).unwrap();
            assert_eq!(reports.len(), policies.len());
            for (report, &policy) in reports.iter().zip(policies) {
                let options = TerrainWalkOptions {
                    policy,
                    ..options.clone()
                };
                let alone = terrain_walk(of_grid(&grid), &options, &|| 0.0, &()).unwrap();
                assert_eq!(report.to_json(), alone.to_json());
                let overfull: usize = report.overfull_frames().iter().sum();
                let is_all = policy == EvictionPolicy::Nothing;
                assert_eq!(overfull > 0, is_all || slots == 1200, "{}", path.name());
            }
        }
    }

    // What one policy cannot is refused for all.
    let options = TerrainWalkOptions {
        passes: true,
        ..options(TerrainPath::Fly, 3)
    };
    let refused = walker.walk(&options, &EvictionPolicy::ALL, &|| 0.0, &());
    assert!(matches!(refused, Err(TerrainError::Option(_))));
    let nothing = walker.walk(&options, &[], &|| 0.0, &()).unwrap();
    assert!(nothing.is_empty());
}

#[test]
fn a_file_is_walked_over_as_the_heights_are() {
    let grid = hills([300, 200], 3, &mut SplitMix64(4));
    let options = TerrainWalkOptions {
        optimum: true,
        slots: 5000,
        ..options(TerrainPath::Fly, 60)
    };
    let walk = |source| terrain_walk(source, &options, &|| 0.0, &()).unwrap();
    let (own, read) = (walk(of_grid(&grid)), walk(stored(&grid)));
    let without_bytes = |frame: &WalkFrame| WalkFrame {
        read_bytes: 0,
        ..*frame
    };
    assert_eq!(
        own.frames,
        read.frames.iter().map(without_bytes).collect::<Vec<_>>()
    );
    assert_eq!(own.distinct, read.distinct);
    let [bytes, length] = [
        read.summary(WalkQuantity::ReadBytes).total,
        read.file_bytes.unwrap() as f64,
    ];
    assert!(bytes > 0.0 && bytes <= length);

    // No policy sends less than the optimum, and none draws anything else.
    let optimum = own.optimum.unwrap();
    assert_eq!(optimum.distinct_vertices, own.distinct[0]);
    for policy in EvictionPolicy::ALL {
        let options = TerrainWalkOptions {
            policy,
            ..options.clone()
        };
        let other = terrain_walk(of_grid(&grid), &options, &|| 0.0, &()).unwrap();
        assert_eq!(other.optimum, own.optimum);
        let faces = |it: &WalkFrame| (it.vertices, it.faces);
        assert!(
            other
                .frames
                .iter()
                .map(faces)
                .eq(own.frames.iter().map(faces))
        );
        let inserts = other.summary(WalkQuantity::Inserts).total;
        assert!(
            optimum
                .fewest_inserts
                .is_none_or(|fewest| fewest as f64 <= inserts)
        );
    }
    let few = TerrainWalkOptions {
        slots: 200,
        passes: true,
        ..options.clone()
    };
    let few = terrain_walk(of_grid(&grid), &few, &|| 0.0, &()).unwrap();
    assert!(few.overfull_frames()[1] > 0);

    let text = own.to_json();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(
        (&json["command"], &json["path"]),
        (&"terrain walk".into(), &"fly".into())
    );
    assert_eq!(json["frames"].as_array().unwrap().len(), 60);
    let bad = TerrainWalkOptions {
        limit: Some(2),
        ..options
    };
    let error = bad.check().unwrap_err().to_string();
    assert!(error.starts_with("limit 2: give 3 vertices"), "{error}");
}

#[test]
fn every_height_is_within_the_tolerance() {
    let mut random = SplitMix64(21);
    for (size, voids) in [([65, 65], 0), ([150, 90], 4)] {
        let grid = hills(size, voids, &mut random);
        for error in [0.0, 0.6, 3.0, 50.0] {
            let options = TerrainVerifyOptions {
                error: Some(error),
                ..TerrainVerifyOptions::default()
            };
            let report = terrain_verify(stored(&grid), None, &options, &()).unwrap();
            assert_eq!(report.failures(), Vec::<String>::new());
            assert!(report.worst_metres() <= error);
            assert_eq!(report.surfaces.len(), 1);
        }
        for path in TerrainPath::SHAPES {
            let options = TerrainVerifyOptions {
                path,
                frames: Some(6),
                tolerance: 3.0,
                ..TerrainVerifyOptions::default()
            };
            let heights = TerrainHeights::of_grid("hills", grid.clone());
            let report = terrain_verify(of_grid(&grid), Some(heights), &options, &()).unwrap();
            assert_eq!(report.failures(), Vec::<String>::new());
            assert_eq!((report.errors.share(), report.surfaces.len()), (100.0, 6));
            assert!(report.errors.seen > 0 && report.errors.worst > 0.0);
        }
    }
}

#[test]
fn other_heights_are_farther_off_or_refused() {
    let grid = hills([65, 65], 0, &mut SplitMix64(3));
    let other = |change: &dyn Fn(&mut [f32])| {
        let mut heights = grid.heights().to_vec();
        change(&mut heights);
        let grid = HeightGrid::new(grid.size(), grid.spacing(), heights).unwrap();
        TerrainHeights::of_grid("other", grid)
    };
    let options = TerrainVerifyOptions {
        error: Some(2.0),
        ..TerrainVerifyOptions::default()
    };
    let verify = |heights| terrain_verify(of_grid(&grid), Some(heights), &options, &()).unwrap();
    let report = verify(other(&|heights| heights[2000] += 10.0));
    assert_eq!(report.errors.seen - report.errors.within, 1);
    assert!(report.worst_metres() > 8.0);
    assert!(report.failures()[0].starts_with("heights farther off than the tolerance: 1, by "));
    let report = verify(other(&|heights| heights[2000] = f32::NAN));
    let failures = report.failures().join("; ");
    assert!(
        failures.contains("voids that a face covers: 1"),
        "{failures}"
    );
    assert!(
        failures.contains("surfaces of another area than full detail: 1"),
        "{failures}"
    );

    let wider = HeightGrid::new(grid.size(), [31.0, 20.0], grid.heights().to_vec()).unwrap();
    let wider = TerrainHeights::of_grid("wider", wider);
    let error = terrain_verify(of_grid(&grid), Some(wider), &options, &()).unwrap_err();
    assert!(matches!(error, TerrainError::OtherGrid { .. }), "{error}");
}

/// A quarter of a tile, at 10 and at 50 metres, and at one pixel on two paths.
#[test]
fn a_real_terrain_is_as_near_as_it_says() {
    let Some(folder) = data_folder::folder() else {
        return;
    };
    let paths = [folder.join("terrain/N47W122.hgt.gz")];
    let tile = TerrainHeights::open(&paths, &TerrainReadOptions::default()).unwrap();
    let tile = tile.grid().unwrap();
    let columns = tile.size()[0] as usize;
    let part: Vec<f32> = tile
        .heights()
        .chunks_exact(columns)
        .take(501)
        .flat_map(|row| &row[..501])
        .copied()
        .collect();
    let grid = HeightGrid::new([501, 501], tile.spacing(), part).unwrap();
    for error in [10.0, 50.0] {
        let options = TerrainVerifyOptions {
            error: Some(error),
            ..TerrainVerifyOptions::default()
        };
        let report = terrain_verify(of_grid(&grid), None, &options, &()).unwrap();
        assert_eq!(report.failures(), Vec::<String>::new());
        assert!(report.worst_metres() > 0.9 * error);
    }
    for path in [TerrainPath::Circle, TerrainPath::Fly] {
        let options = TerrainVerifyOptions {
            path,
            frames: Some(3),
            ..TerrainVerifyOptions::default()
        };
        let report = terrain_verify(of_grid(&grid), None, &options, &()).unwrap();
        assert_eq!(report.failures(), Vec::<String>::new());
        assert!(report.errors.seen > 0);
    }
}
