//! All heights of a grid, and what a surface is beside them: measured on the grid, without anything that a hierarchy knows.

use super::surface_faults::{Coverage, CoveredAs, SurfaceFaults, SurfaceSides};
use crate::height_grid::HeightGrid;
use crate::lod::quad_tin::QuadTin;

/// What there is at full detail.
#[derive(Debug)]
pub(super) struct FullGrid<'a> {
    pub(super) grid: &'a HeightGrid,
    columns: i64,
    rows: i64,
    /// Of each place whether a face of full detail has a corner there.
    has_face: Vec<bool>,
    pub(super) face_count: u64,
}

/// Column and row.
type GridPlace = [i64; 2];

impl<'a> FullGrid<'a> {
    pub(super) fn new(grid: &'a HeightGrid) -> Self {
        let [columns, rows] = grid.size().map(i64::from);
        let mut full = Self {
            grid,
            columns,
            rows,
            has_face: vec![false; grid.heights().len()],
            face_count: 0,
        };
        for row in 0..rows - 1 {
            for column in 0..columns - 1 {
                for face in full.halves_of_cell([column, row]) {
                    if face.iter().all(|&place| full.has_height(place)) {
                        full.face_count += 1;
                        for place in face {
                            let number = full.number(place);
                            full.has_face[number] = true;
                        }
                    }
                }
            }
        }
        full
    }

    /// The finest triangles of a cell: its diagonal joins the places of an even sum.
    fn halves_of_cell(&self, [column, row]: GridPlace) -> [[GridPlace; 3]; 2] {
        let [a, b, c, d] = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| [column + x, row + y]);
        match (column + row) % 2 == 0 {
            true => [[a, d, b], [a, d, c]],
            false => [[b, c, a], [b, c, d]],
        }
    }

    fn number(&self, [column, row]: GridPlace) -> usize {
        usize::try_from(row * self.columns + column).expect("places are inside")
    }

    fn place(&self, vertex: u32) -> GridPlace {
        [
            i64::from(vertex) % self.columns,
            i64::from(vertex) / self.columns,
        ]
    }

    /// Whether there is such a place, and it has a height.
    fn has_height(&self, place: GridPlace) -> bool {
        let [column, row] = place;
        let is_inside = (0..self.columns).contains(&column) && (0..self.rows).contains(&row);
        is_inside && !self.grid.heights()[self.number(place)].is_nan()
    }

    /// Looks at all places that the faces of a surface cover. Each that has a height is given to `measured` once, by its number, with how far it is
    /// from the surface there, vertically; on a common side, to the first of the faces.
    pub(super) fn look_at(
        &self,
        tin: &QuadTin,
        faces: &[(u32, [u32; 3])],
        mut measured: impl FnMut(usize, f64),
    ) -> SurfaceFaults {
        let mut coverage = Coverage::new(self.has_face.len());
        let mut faults = SurfaceFaults::default();
        let mut doubled_area = 0;
        for &(_, face) in faces {
            let corners = face.map(|vertex| self.place(vertex));
            let heights = face.map(|vertex| f64::from(tin.position(vertex)[1]));
            let area = doubled(corners[0], corners[1], corners[2]);
            doubled_area += area;
            faults.turned += usize::from(area <= 0);
            let [first, last] = [0, 1].map(|axis| {
                let along = corners.map(|it| it[axis]);
                (along.iter().min().copied(), along.iter().max().copied())
            });
            let (Some(left), Some(right)) = first else {
                continue;
            };
            let (Some(top), Some(bottom)) = last else {
                continue;
            };
            for row in top..=bottom {
                for column in left..=right {
                    // How much of each corner is there.
                    let place = [column, row];
                    let [a, b, c] = corners;
                    let parts = [
                        doubled(place, b, c),
                        doubled(a, place, c),
                        doubled(a, b, place),
                    ];
                    if parts.iter().any(|&part| part < 0) {
                        continue;
                    }
                    let number = self.number(place);
                    match coverage.add(number, parts.iter().all(|&part| part > 0)) {
                        CoveredAs::First => {}
                        CoveredAs::Again => continue,
                        CoveredAs::Overlapping => {
                            faults.overlaps += 1;
                            continue;
                        }
                    }
                    let height = f64::from(self.grid.heights()[number]);
                    if height.is_nan() {
                        faults.covered_voids += 1;
                        continue;
                    }
                    let all = parts.iter().zip(heights);
                    let drawn: f64 = all.map(|(&part, height)| part as f64 * height).sum();
                    measured(number, (drawn / area as f64 - height).abs());
                }
            }
        }

        let with_face = self.has_face.iter().enumerate().filter(|it| *it.1);
        faults.uncovered = with_face.filter(|it| !coverage.has(it.0)).count();
        faults.cracks = SurfaceSides::of(faces)
            .cracks(|[from, to]| self.goes_on_beside(self.place(from), self.place(to)));
        faults.has_other_area = u64::try_from(doubled_area) != Ok(self.face_count);
        faults
    }

    /// Whether full detail has a face on the other side of a side, at any part of it.
    fn goes_on_beside(&self, from: GridPlace, to: GridPlace) -> bool {
        let way = [to[0] - from[0], to[1] - from[1]];
        let steps = way[0].abs().max(way[1].abs());
        let [x, y] = way.map(i64::signum);
        (0..steps).any(|step| {
            let start = [from[0] + step * x, from[1] + step * y];
            let end = [start[0] + x, start[1] + y];
            let third = match (x, y) {
                // A diagonal: the corner of the cell that lies on the other side.
                _ if x != 0 && y != 0 => match x * y > 0 {
                    true => [start[0], end[1]],
                    false => [end[0], start[1]],
                },
                // Of the cell on the other side the half that has this side goes to the other end of its diagonal.
                _ => {
                    let across = [-y, x];
                    let is_even = (start[0] + start[1]) % 2 == 0;
                    let far = if is_even { end } else { start };
                    [far[0] + across[0], far[1] + across[1]]
                }
            };
            [start, end, third]
                .iter()
                .all(|&place| self.has_height(place))
        })
    }
}

/// Twice the area of a triangle, above 0 if it is counter-clockwise seen from above: rows go to the south.
fn doubled(a: GridPlace, b: GridPlace, c: GridPlace) -> i64 {
    (c[0] - a[0]) * (b[1] - a[1]) - (b[0] - a[0]) * (c[1] - a[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::CameraView;
    use crate::lod::quad_tin::TinSurface;
    use crate::lod::quad_tin::tests::hills;
    use crate::random::SplitMix64;

    fn surface(tin: &QuadTin, error: f64) -> TinSurface {
        let mut surface = TinSurface::default();
        tin.draw(&CameraView::of_errors_above(error).unwrap(), &mut surface);
        surface
    }

    #[test]
    fn surfaces_are_sound_and_damaged_ones_are_not() {
        let mut random = SplitMix64(7);
        for (size, voids) in [([17, 17], 0), ([40, 31], 5), ([65, 33], 3)] {
            let grid = hills(size, voids, &mut random);
            let tin = QuadTin::over_grid(&grid).unwrap();
            let full = FullGrid::new(&grid);
            assert_eq!(full.face_count, tin.face_count());
            for error in [-1.0, 0.5, 4.0, 1000.0] {
                let surface = surface(&tin, error);
                let (mut seen, mut worst) = (0, 0.0_f64);
                let faults = full.look_at(&tin, surface.faces(), |_, error| {
                    seen += 1;
                    worst = worst.max(error);
                });
                assert!(faults.is_sound(), "{faults:?}");
                assert_eq!(seen, full.has_face.iter().filter(|&&it| it).count());
                assert!(worst <= f64::from(surface.largest_error()));

                // A face that is lost, is there twice, or stands in for two of its own.
                let faces = surface.faces();
                let lost = full.look_at(&tin, &faces[1..], |_, _| {});
                assert!(lost.has_other_area && !lost.is_sound());
                let twice = [faces, &faces[..1]].concat();
                assert!(full.look_at(&tin, &twice, |_, _| {}).cracks > 0);
                let mut turned = faces.to_vec();
                turned[0].1.swap(0, 1);
                assert_eq!(full.look_at(&tin, &turned, |_, _| {}).turned, 1);
            }

            // A coarse face among fine ones: what is beside it has a vertex in the middle of a side, but at a border.
            let fine = surface(&tin, -1.0);
            let coarse = surface(&tin, 15.0);
            let mut found = [0; 2];
            for &(id, face) in coarse.faces() {
                let is_inside = |&&(_, other): &&(u32, [u32; 3])| {
                    other.iter().all(|&vertex| full.is_in(face, vertex))
                };
                if fine.faces().iter().filter(is_inside).count() > 1 {
                    let outside = fine.faces().iter().filter(|it| !is_inside(it));
                    let mixed: Vec<_> = outside.copied().chain([(id, face)]).collect();
                    let faults = full.look_at(&tin, &mixed, |_, _| {});
                    assert!(faults.uncovered == 0 && !faults.has_other_area);
                    found[usize::from(faults.cracks > 0)] += 1;
                }
            }
            assert!(found[1] > 0, "{found:?}");
        }
    }

    impl FullGrid<'_> {
        fn is_in(&self, face: [u32; 3], vertex: u32) -> bool {
            let [a, b, c] = face.map(|it| self.place(it));
            let place = self.place(vertex);
            [
                doubled(place, b, c),
                doubled(a, place, c),
                doubled(a, b, place),
            ]
            .iter()
            .all(|&part| part >= 0)
        }
    }

    #[test]
    fn a_void_under_a_face_is_found() {
        let mut heights = vec![1.0; 25];
        let whole = HeightGrid::new([5, 5], [1.0; 2], heights.clone()).unwrap();
        let tin = QuadTin::over_grid(&whole).unwrap();
        heights[12] = f32::NAN;
        let holed = HeightGrid::new([5, 5], [1.0; 2], heights).unwrap();
        let full = FullGrid::new(&holed);
        let faults = full.look_at(&tin, surface(&tin, 0.0).faces(), |_, _| {});
        assert_eq!((faults.covered_voids, faults.uncovered), (1, 0));
        assert!(faults.has_other_area);
    }
}
