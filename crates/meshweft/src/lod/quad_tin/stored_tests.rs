//! Terrains as bytes.

use std::io::Cursor;

use super::stored_tree::SIGNATURE;
use super::tests::hills;
use super::tree::TinTree;
use super::{PointHierarchy, QuadTin, StreamedTin, TinLimit, TinSurface};
use crate::bits::crc32;
use crate::height_grid::HeightGrid;
use crate::limits::Limits;
use crate::lod::{Camera, CameraView, HierarchyError};
use crate::random::{SplitMix64, from_environment};

fn bytes(tin: &QuadTin) -> Vec<u8> {
    let mut bytes = Vec::new();
    tin.write("hills", &mut bytes).unwrap();
    bytes
}

fn open(bytes: &[u8]) -> Result<StreamedTin<Cursor<Vec<u8>>>, HierarchyError> {
    StreamedTin::open(Cursor::new(bytes.to_vec()), Limits::default())
}

fn camera() -> CameraView {
    let camera = Camera {
        eye: [-100.0, 90.0, 50.0],
        target: [0.0, 0.0, 40.0],
        up: [0.0, 1.0, 0.0],
        field_of_view: 45.0,
        size: [800, 600],
    };
    camera.view(2.0).unwrap()
}

#[test]
fn what_is_read_is_what_was_written_and_a_view_reads_a_part() {
    let mut random = SplitMix64(13);
    for (size, voids) in [([2, 2], 0), ([17, 17], 0), ([40, 31], 6), ([300, 500], 2)] {
        let grid = hills(size, voids, &mut random);
        let tin = QuadTin::over_grid(&grid).unwrap();
        let stored = bytes(&tin);
        assert!(QuadTin::begins_bytes(&stored));
        let all = open(&stored).unwrap().into_tin().unwrap();
        assert_eq!(bytes(&all), stored);

        // The same surfaces, from as much of the file as is needed.
        let mut streamed = open(&stored).unwrap();
        assert_eq!(streamed.name(), "hills");
        assert_eq!(streamed.tin().grid_size(), Some(size));
        assert_eq!(streamed.tin().face_count(), tin.face_count());
        let mut surfaces = [TinSurface::default(), TinSurface::default()];
        let views = [1e6, 20.0, 3.0, 0.1, -1.0].map(|it| CameraView::of_errors_above(it).unwrap());
        for view in views.into_iter().chain([camera()]) {
            tin.draw(&view, &mut surfaces[0]);
            streamed.draw(&view, &mut surfaces[1]).unwrap();
            assert_eq!(surfaces[0].faces(), surfaces[1].faces());
            for vertex in surfaces[0].faces().iter().flat_map(|it| it.1) {
                assert_eq!(tin.position(vertex), streamed.tin().position(vertex));
                assert_eq!(tin.error(vertex), streamed.tin().error(vertex));
            }
            let mut fresh = open(&stored).unwrap();
            let limit = TinLimit::Faces(surfaces[0].faces().len() / 2);
            tin.draw_within(limit, &view, &mut surfaces[0]);
            fresh.draw_within(limit, &view, &mut surfaces[1]).unwrap();
            assert_eq!(surfaces[0].faces(), surfaces[1].faces());
        }
        assert_eq!(streamed.bytes(), [stored.len() as u64; 2]);
        let mut coarse = open(&stored).unwrap();
        coarse
            .draw(
                &CameraView::of_errors_above(20.0).unwrap(),
                &mut surfaces[0],
            )
            .unwrap();
        let [length, read] = coarse.bytes();
        assert!(read < length || length < 100_000);
    }
}

/// Points at random places, in steps of 1/16.
fn scattered(count: usize, random: &mut SplitMix64) -> QuadTin {
    let points: Vec<[f32; 3]> = (0..count)
        .map(|_| [640, 80, 480].map(|most| random.below(most) as f32 / 16.0))
        .collect();
    PointHierarchy::over(&points).unwrap().into()
}

#[test]
fn points_are_read_as_they_were_written() {
    let mut random = SplitMix64(14);
    for count in [3, 40, 700, 9000] {
        let tin = scattered(count, &mut random);
        let stored = bytes(&tin);
        assert_eq!(bytes(&open(&stored).unwrap().into_tin().unwrap()), stored);
        let mut streamed = open(&stored).unwrap();
        assert_eq!(streamed.tin().grid_size(), None);
        let mut surfaces = [TinSurface::default(), TinSurface::default()];
        for length in [1e6, 4.0, 1.0, 0.1, -1.0] {
            let view = CameraView::of_errors_above(length).unwrap();
            tin.draw(&view, &mut surfaces[0]);
            streamed.draw(&view, &mut surfaces[1]).unwrap();
            assert_eq!(surfaces[0].faces(), surfaces[1].faces());
            assert_eq!(surfaces[0].largest_error(), surfaces[1].largest_error());
            for vertex in surfaces[0].faces().iter().flat_map(|it| it.1) {
                assert_eq!(tin.position(vertex), streamed.tin().position(vertex));
                assert_eq!(tin.is_input(vertex), streamed.tin().is_input(vertex));
            }
        }
        assert_eq!(tin.face_count(), surfaces[0].faces().len() as u64);
        assert_eq!(streamed.bytes(), [stored.len() as u64; 2]);
        let mut coarse = open(&stored).unwrap();
        let view = CameraView::of_errors_above(4.9).unwrap();
        coarse.draw(&view, &mut surfaces[0]).unwrap();
        assert!(count < 1000 || coarse.bytes()[1] < stored.len() as u64);
    }
}

#[test]
fn triangles_that_would_be_cut_without_end_are_damage() {
    // All four triangles around each vertex are cut at the next one.
    let mut tin = scattered(600, &mut SplitMix64(2));
    if let TinTree::Points(points) = &mut tin.tree {
        let count = u32::try_from(points.nodes.len()).unwrap();
        for (node, child) in points.nodes.iter_mut().zip(1..count).skip(4) {
            node.children = [2 * child, 2 * child, 2 * child + 1, 2 * child + 1];
        }
    }
    assert!(open(&bytes(&tin)).is_err());
}

/// Uses a file as a walk does.
fn use_all(bytes: &[u8]) -> Result<(), HierarchyError> {
    let mut streamed = open(bytes)?;
    let mut surface = TinSurface::default();
    streamed.draw(&camera(), &mut surface)?;
    streamed.draw_within(TinLimit::Vertices(40), &camera(), &mut surface)?;
    assert_eq!(surface.strip().is_empty(), surface.faces().is_empty());
    let tin = streamed.into_tin()?;
    tin.draw(&CameraView::of_errors_above(1.0).unwrap(), &mut surface);
    Ok(())
}

#[test]
fn a_file_of_another_terrain_is_told_from_its_own() {
    let mut random = SplitMix64(32);
    let grid = hills([30, 21], 3, &mut random);
    let own = QuadTin::over_grid(&grid).unwrap();
    let file = bytes(&own);
    assert!(own.is_stored_in(Cursor::new(&file)).unwrap());
    for place in [0, 17, 629] {
        let mut heights = grid.heights().to_vec();
        heights[place] += 0.25;
        let other = HeightGrid::new(grid.size(), grid.spacing(), heights).unwrap();
        let other = QuadTin::over_grid(&other).unwrap();
        // A void stays one.
        let is_void = grid.heights()[place].is_nan();
        assert_eq!(other.is_stored_in(Cursor::new(&file)).unwrap(), is_void);
    }
    let wider = HeightGrid::new(grid.size(), [30.5, 20.0], grid.heights().to_vec()).unwrap();
    let wider = QuadTin::over_grid(&wider).unwrap();
    assert!(!wider.is_stored_in(Cursor::new(&file)).unwrap());
    assert!(
        own.is_stored_in(Cursor::new(&file[..file.len() - 1]))
            .is_err()
    );
}

/// `MESHWEFT_CASES=1000000 cargo test --release -p meshweft --lib -- --nocapture damage_is_an_error_or_some_terrain` takes a
/// million files.
#[test]
fn damage_is_an_error_or_some_terrain() {
    let mut random = SplitMix64(from_environment("MESHWEFT_SEED", 31));
    let files = [([5, 5], 0), ([30, 21], 3), ([65, 65], 0)]
        .map(|(size, voids)| bytes(&QuadTin::over_grid(&hills(size, voids, &mut random)).unwrap()));
    let points = [9, 700].map(|count| bytes(&scattered(count, &mut random)));
    let files = [&files[..], &points].concat();
    for file in &files {
        use_all(file).unwrap();
        for end in 0..file.len().min(400) {
            assert!(use_all(&file[..end]).is_err());
        }
    }
    let cases = from_environment("MESHWEFT_CASES", 2000);
    let mut read = 0;
    for _ in 0..cases {
        let mut damaged = files[random.below(files.len())].clone();
        for _ in 0..=random.below(3) {
            let at = random.below(damaged.len());
            damaged[at] = u8::try_from(random.below(256)).unwrap();
        }
        // Some with the checksum of the head put right.
        if random.below(2) == 0 {
            reseal(&mut damaged);
        }
        match use_all(&damaged) {
            Err(HierarchyError::Read(error)) => panic!("all was in memory: {error}"),
            Err(HierarchyError::Decode(error)) => assert!(!error.to_string().is_empty()),
            Ok(()) => read += 1,
        }
    }
    println!("{cases} damaged terrains: {read} are some terrain, the others refused");
    assert!(read < cases);
}

/// Gives the head and the blocks the checksums that they should have, as far as the head can be read.
fn reseal(bytes: &mut [u8]) {
    let Some((front, rest)) = bytes.split_first_chunk_mut() else {
        return;
    };
    let Ok((length, _)) = SIGNATURE.head_length(front) else {
        return;
    };
    let Some((head, blocks)) = rest.split_at_mut_checked(length) else {
        return;
    };
    if let Some(places) = super::stored::block_places(head) {
        let mut blocks = blocks;
        for (at, length) in places {
            let Some((block, rest)) = std::mem::take(&mut blocks).split_at_mut_checked(length)
            else {
                break;
            };
            head[at..at + 4].copy_from_slice(&crc32(block).to_le_bytes());
            blocks = rest;
        }
    }
    front[9..].copy_from_slice(&crc32(head).to_le_bytes());
}
