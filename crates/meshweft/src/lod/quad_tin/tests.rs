//! Surfaces of grids against plain readings of what they are.

use std::collections::{BTreeMap, BTreeSet};

use super::grid::GridTin;
use super::grid_square::{GridSquare, place, vertex};
use super::triangle::{NONE, TinTriangle};
use super::{QuadTin, QuadTinError, TinLimit, TinSurface};
use crate::height_grid::HeightGrid;
use crate::index::index32;
use crate::lod::{Camera, CameraView};
use crate::random::{SplitMix64, from_environment};

/// Hills, in steps of a quarter of a metre, with holes in some.
pub(crate) fn hills(size: [u32; 2], voids: u64, random: &mut SplitMix64) -> HeightGrid {
    let waves: Vec<[f64; 4]> = (0..6)
        .map(|i| {
            let mut part = |most: f64| most * random.below(1000) as f64 / 1000.0;
            let scale = f64::from(1 << i) / 30.0;
            [
                part(scale),
                part(scale),
                part(6.3),
                40.0 / f64::from(1 << i),
            ]
        })
        .collect();
    let mut heights: Vec<f32> = (0..size[0] * size[1])
        .map(|number| {
            let [x, y] = [number % size[0], number / size[0]].map(f64::from);
            let wave = |[a, b, start, height]: &[f64; 4]| height * (a * x + b * y + start).sin();
            let height: f64 = waves.iter().map(wave).sum();
            #[expect(clippy::cast_possible_truncation, reason = "few bits")]
            let height = ((4.0 * height).round() / 4.0) as f32;
            height
        })
        .collect();
    // Small ones would have nothing left.
    let voids = if heights.len() > 200 { voids } else { 0 };
    for _ in 0..voids {
        let [x, y] = size.map(|it| index32(random.below(it as usize)));
        let [wide, high] = [1 + random.below(4), 1 + random.below(4)].map(index32);
        for row in y..(y + high).min(size[1]) {
            for column in x..(x + wide).min(size[0]) {
                heights[(row * size[0] + column) as usize] = f32::NAN;
            }
        }
    }
    HeightGrid::new(size, [30.0, 20.0], heights).unwrap()
}

fn sizes() -> [[u32; 2]; 8] {
    [
        [2, 2],
        [3, 2],
        [5, 5],
        [17, 17],
        [9, 30],
        [33, 20],
        [40, 41],
        [65, 65],
    ]
}

fn at_error(length: f64) -> CameraView {
    CameraView::of_errors_above(length).unwrap()
}

fn drawn(tin: &QuadTin, view: &CameraView) -> TinSurface {
    let mut surface = TinSurface::default();
    tin.draw(view, &mut surface);
    surface
}

/// A camera above hills.
fn camera(random: &mut SplitMix64, grid: &HeightGrid, tolerance: f64) -> CameraView {
    let [low, high] = grid.height_range().unwrap_or([0.0; 2]).map(f64::from);
    let extent = [0, 1].map(|i| grid.spacing()[i] * f64::from(grid.size()[i]));
    let mut around = |length: f64| (random.below(2001) as f64 / 1000.0 - 1.0) * length;
    let eye = [
        around(extent[0]),
        high + around(high - low + 10.0),
        around(extent[1]),
    ];
    let target = [around(extent[0]), low, around(extent[1])];
    let camera = Camera {
        eye,
        target,
        up: [0.0, 1.0, 0.0],
        field_of_view: 45.0,
        size: [400, 300],
    };
    match camera.view(tolerance) {
        Ok(view) => view,
        Err(_) => at_error(tolerance),
    }
}

/// All cells with four heights, as two faces each, or with three, as far as the finest triangles have them: area 1/2 each.
fn finest_area(grid: &HeightGrid) -> usize {
    let square = GridSquare::new(grid.size());
    let mut triangles = square.roots().to_vec();
    let mut count = 0;
    while let Some(triangle) = triangles.pop() {
        if square.is_outside(&triangle) {
            continue;
        }
        match triangle.split {
            NONE => count += usize::from(is_solid(grid, &triangle)),
            _ => triangles.extend(square.halves(&triangle)),
        }
    }
    count
}

/// Whether all corners have heights.
fn is_solid(grid: &HeightGrid, triangle: &TinTriangle) -> bool {
    let corners = [triangle.apex, triangle.left, triangle.right].map(place);
    corners.into_iter().all(|[column, row]| {
        column < grid.size()[0] && row < grid.size()[1] && grid.height(column, row).is_some()
    })
}

/// Twice the area, counter-clockwise from above, in cells.
fn doubled_area(grid: &HeightGrid, face: [u32; 3]) -> i64 {
    let columns = grid.size()[0];
    let [a, b, c] = face.map(|it| [i64::from(it % columns), i64::from(it / columns)]);
    (b[1] - a[1]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[1] - a[1])
}

/// The surface has no crack, covers what has heights, and nothing else.
fn check_surface(grid: &HeightGrid, surface: &TinSurface) {
    let mut edges = BTreeMap::new();
    let mut area = 0;
    for &(_, face) in surface.faces() {
        let doubled = doubled_area(grid, face);
        assert!(doubled > 0, "{face:?}");
        area += usize::try_from(doubled).unwrap();
        for (i, &from) in face.iter().enumerate() {
            assert!(!grid.heights()[from as usize].is_nan());
            assert_eq!(edges.insert([from, face[(i + 1) % 3]], face), None);
        }
    }
    assert_eq!(area, finest_area(grid));
    // A side without a face on the other side is as fine as the grid: along its border, or along a hole.
    let columns = grid.size()[0];
    for &[from, to] in edges.keys() {
        if !edges.contains_key(&[to, from]) {
            let [a, b] = [from, to].map(|it| [it % columns, it / columns]);
            let is_border = [0, 1].iter().any(|&axis| {
                a[axis] == b[axis] && (a[axis] == 0 || a[axis] == grid.size()[axis] - 1)
            });
            let is_fine = a[0].abs_diff(b[0]) <= 1 && a[1].abs_diff(b[1]) <= 1;
            assert!(
                is_border || is_fine || is_along_hole(grid, &edges, a, b),
                "{a:?} {b:?}"
            );
        }
    }
    // Numbers stay apart.
    let numbers: BTreeSet<u32> = surface.faces().iter().map(|it| it.0).collect();
    assert_eq!(numbers.len(), surface.faces().len());
}

/// Whether no vertex of the surface is inside of a side that has a face on one side only.
fn is_along_hole(
    grid: &HeightGrid,
    edges: &BTreeMap<[u32; 2], [u32; 3]>,
    a: [u32; 2],
    b: [u32; 2],
) -> bool {
    let used: BTreeSet<u32> = edges.keys().flatten().copied().collect();
    let steps = a[0].abs_diff(b[0]).max(a[1].abs_diff(b[1]));
    (1..steps).all(|step| {
        let at = |axis: usize| {
            let way = i64::from(b[axis]) - i64::from(a[axis]);
            i64::from(a[axis]) + way * i64::from(step) / i64::from(steps)
        };
        !used.contains(&u32::try_from(at(1) * i64::from(grid.size()[0]) + at(0)).unwrap())
    })
}

/// The largest vertical distance of a height to the surface, by brute force.
fn true_error(grid: &HeightGrid, surface: &TinSurface) -> f64 {
    let columns = grid.size()[0];
    let mut largest = 0.0_f64;
    for &(_, face) in surface.faces() {
        let corners = face.map(|it| [it % columns, it / columns]);
        let doubled = doubled_area(grid, face) as f64;
        let range = |axis: usize| {
            let all = corners.map(|it| it[axis]);
            *all.iter().min().unwrap()..=*all.iter().max().unwrap()
        };
        for row in range(1) {
            for column in range(0) {
                let number = row * columns + column;
                let parts = [
                    [number, face[1], face[2]],
                    [face[0], number, face[2]],
                    [face[0], face[1], number],
                ]
                .map(|it| doubled_area(grid, it) as f64);
                if parts.iter().all(|&it| it >= 0.0) {
                    let weighed = parts
                        .iter()
                        .zip(face)
                        .map(|(part, corner)| part * f64::from(grid.heights()[corner as usize]));
                    let on_surface = weighed.sum::<f64>() / doubled;
                    let height = grid.heights()[number as usize];
                    assert!(!height.is_nan(), "a void inside of a face");
                    largest = largest.max((f64::from(height) - on_surface).abs());
                }
            }
        }
    }
    largest
}

#[test]
fn surfaces_have_no_cracks_and_their_errors_are_true() {
    let mut random = SplitMix64(11);
    for case in 0..from_environment("MESHWEFT_CASES", 3) {
        for size in sizes() {
            let grid = hills(size, 4 * (case % 2), &mut random);
            let tin = QuadTin::over_grid(&grid).unwrap();
            for error in [-1.0, 0.0, 0.01, 0.25, 1.0, 5.0, 20.0, 1e6] {
                let surface = drawn(&tin, &at_error(error));
                check_surface(&grid, &surface);
                assert!(f64::from(surface.largest_error()) <= error.max(0.0));
                let found = true_error(&grid, &surface);
                assert!(
                    found <= f64::from(surface.largest_error()),
                    "{found} {error}"
                );
                if error < 0.0 {
                    assert_eq!(surface.faces().len() as u64, tin.face_count());
                    assert_eq!(surface.faces().len(), finest_area(&grid));
                }
            }
            for _ in 0..10 {
                let view = camera(&mut random, &grid, 2.0);
                check_surface(&grid, &drawn(&tin, &view));
            }
        }
    }
}

#[test]
fn errors_and_balls_contain_those_below() {
    let mut random = SplitMix64(5);
    for size in sizes() {
        for voids in [0, 5] {
            let grid = hills(size, voids, &mut random);
            let tin = GridTin::over(&grid);
            let square = GridSquare::new(size);
            for number in 0..size[0] * size[1] {
                let below = square.vertex_of(number);
                if square.level(place(below)) == square.levels() {
                    continue;
                }
                let node = |it| *tin.node(place(it)).unwrap();
                for above in square.diamond(below).apexes.into_iter().flatten() {
                    let is_corner = square.level(place(above)) == square.levels();
                    if !square.has(above) || is_corner {
                        continue;
                    }
                    assert!(tin.error(place(above)) >= tin.error(place(below)));
                    let error = tin.error(place(above));
                    if error.is_finite() && !node(below).height.is_nan() {
                        let [a, b] =
                            [above, below].map(|it| tin.position(place(it)).map(f64::from));
                        let way = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
                        let [a, b] = [above, below].map(|it| {
                            f64::from(tin.radii.length(node(it).radius & !super::grid::VOID))
                        });
                        assert!(a >= way + b);
                    }
                }
            }
        }
    }
}

#[test]
fn errors_are_the_largest_of_all_heights_below() {
    // Without holes: of every triangle by brute force, then the larger one of what is below.
    let mut random = SplitMix64(3);
    for size in [[3, 3], [9, 9], [17, 17], [12, 7]] {
        let grid = hills(size, 0, &mut random);
        let tin = QuadTin::over_grid(&grid).unwrap();
        let square = GridSquare::new(size);
        let mut errors = vec![0.0_f64; grid.heights().len()];
        let levels = (0..square.levels()).flat_map(|level| [(level, false), (level, true)]);
        for (level, is_middle) in levels {
            for number in 0..index32(errors.len()) {
                let below = square.vertex_of(number);
                let [x, y] = place(below);
                let odd = [x, y].map(|it| it >> level & 1 == 1);
                if square.level([x, y]) != level || (odd == [true, true]) != is_middle {
                    continue;
                }
                let sides = square.sides(below);
                for triangle in sides.into_iter().flatten() {
                    if square.is_outside(&triangle) {
                        continue;
                    }
                    let corners = [triangle.apex, triangle.left, triangle.right];
                    let error = match square.is_inside(&triangle) {
                        false => f64::INFINITY,
                        true => true_error(
                            &grid,
                            &TinSurface {
                                faces: vec![(0, corners.map(|it| square.number(it)))],
                                ..TinSurface::default()
                            },
                        ),
                    };
                    errors[number as usize] = errors[number as usize].max(error);
                }
                for triangle in sides.into_iter().flatten().filter(|it| square.has(it.apex)) {
                    let above = square.number(triangle.apex) as usize;
                    errors[above] = errors[above].max(errors[number as usize]);
                }
            }
        }
        for (number, &error) in errors.iter().enumerate() {
            let number = index32(number);
            if square.level(place(square.vertex_of(number))) < square.levels() {
                let found = f64::from(tin.error(number));
                let is_close = found == error || found >= error && found <= error * 1.001;
                assert!(is_close, "{size:?} {number}: {found}, {error}");
            }
        }
    }
}

#[test]
fn a_surface_of_limited_size_is_the_one_of_some_error() {
    let mut random = SplitMix64(9);
    for size in sizes() {
        for voids in [0, 3] {
            let grid = hills(size, voids, &mut random);
            let tin = QuadTin::over_grid(&grid).unwrap();
            let least = drawn(&tin, &at_error(1e9)).faces().len();
            let vertices = |surface: &TinSurface| {
                let all = surface.faces().iter().flat_map(|it| it.1);
                all.collect::<BTreeSet<u32>>().len()
            };
            for _ in 0..20 {
                let most = random.below(2 * (size[0] * size[1]) as usize);
                for view in [at_error(-1.0), camera(&mut random, &grid, 0.5)] {
                    let mut surface = TinSurface::default();
                    tin.draw_within(TinLimit::Faces(most), &view, &mut surface);
                    check_surface(&grid, &surface);
                    assert!(surface.faces().len() <= most.max(least));
                    // No room, or nothing left to do.
                    let all = drawn(&tin, &view).faces().len();
                    assert!(surface.faces().len() + 2 > most.min(all));
                    assert!(all > most || surface.faces().len() == all);

                    tin.draw_within(TinLimit::Vertices(most), &view, &mut surface);
                    check_surface(&grid, &surface);
                    let none = vertices(&drawn(&tin, &at_error(1e9)));
                    let all = vertices(&drawn(&tin, &view));
                    assert_eq!(vertices(&surface), most.min(all).max(none));
                }
                // By error alone nothing is cut that has less than what is left.
                let mut surface = TinSurface::default();
                tin.draw_within(TinLimit::Faces(most), &at_error(-1.0), &mut surface);
                let left = f64::from(surface.largest_error());
                assert!(drawn(&tin, &at_error(left)).faces().len() <= surface.faces().len());
            }
        }
    }
}

#[test]
fn a_strip_has_every_face_once_and_as_it_is_turned() {
    let mut random = SplitMix64(21);
    for size in sizes() {
        for voids in [0, 6] {
            let grid = hills(size, voids, &mut random);
            let tin = QuadTin::over_grid(&grid).unwrap();
            for error in [-1.0, 0.5, 3.0, 1e6] {
                let surface = drawn(&tin, &at_error(error));
                let strip = surface.strip();
                let faces = strip.windows(3).enumerate().filter_map(|(i, it)| {
                    let face = [it[i % 2], it[1 - i % 2], it[2]];
                    let is_face = it[0] != it[1] && it[1] != it[2] && it[0] != it[2];
                    is_face.then(|| turned(face))
                });
                let expected = surface.faces().iter().map(|it| turned(it.1));
                assert!(faces.eq(expected), "{size:?} {error}");
                let is_square = size[0] == size[1] && (size[0] - 1).is_power_of_two();
                if voids == 0 && is_square {
                    // One vertex a face, and one more where the curve turns.
                    assert!(strip.len() <= 2 * surface.faces().len() + 2);
                }
            }
        }
    }
}

/// A face with its smallest vertex first.
fn turned([a, b, c]: [u32; 3]) -> [u32; 3] {
    match a.min(b).min(c) {
        it if it == a => [a, b, c],
        it if it == b => [b, c, a],
        _ => [c, a, b],
    }
}

#[test]
fn what_is_flat_or_void_is_drawn_as_it_is() {
    // A border is drawn as it is, so the size decides how many faces there are at least.
    for (size, faces) in [([1201, 1201], 466), ([1025, 1025], 2), ([513, 1025], 3)] {
        let count = size[0] as usize * size[1] as usize;
        let flat = HeightGrid::new(size, [90.0, 90.0], vec![5.0; count]).unwrap();
        let surface = drawn(&QuadTin::over_grid(&flat).unwrap(), &at_error(0.0));
        assert_eq!(surface.largest_error(), 0.0);
        assert_eq!(surface.faces().len(), faces);
    }

    let void = HeightGrid::new([9, 9], [1.0, 1.0], vec![f32::NAN; 81]).unwrap();
    let error = QuadTin::over_grid(&void).unwrap_err();
    assert_eq!(error, QuadTinError::Empty);
    // One face left.
    let mut heights = vec![f32::NAN; 81];
    for at in [0, 1, 10] {
        heights[at] = 7.0;
    }
    let grid = HeightGrid::new([9, 9], [1.0, 1.0], heights).unwrap();
    let surface = drawn(&QuadTin::over_grid(&grid).unwrap(), &at_error(1e9));
    assert_eq!(surface.faces().len(), 1);
    assert_eq!(vertex(0, 0), 0);
}
