//! Faces at equal true error, against the right-triangulated networks of martini and the Delaunay triangulations of delatin.

use meshweft::HeightGrid;
use meshweft::lod::CameraView;
use meshweft::lod::quad_tin::{QuadTin, TinSurface};

use crate::SIDE;
use crate::raster::{Corners, largest_error};

/// Bounds on the error, in metres.
const BOUNDS: [f64; 3] = [10.0, 20.0, 50.0];

pub(crate) fn print(grids: &[(&str, HeightGrid)]) -> Result<(), String> {
    println!(
        "Faces whose largest true error is at most a bound, in metres. martini's own bound is that of the middles of sides: its faces are the \
         fewest of any bound whose true error is not above ours; beside them the true error at a bound that is ours. delatin puts in the \
         worst sample until the bound holds: no hierarchy of halved triangles can have as few.\n"
    );
    println!(
        "| grid | bound | faces | true error | martini | true error | ours / martini | martini's at our bound | delatin | true error | ours / delatin |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    let mut ratios = vec![Vec::new(); BOUNDS.len()];
    for (name, grid) in grids {
        let tin = QuadTin::over_grid(grid).map_err(|it| it.to_string())?;
        let martini = Martini::new(grid);
        for (bound, ratios) in BOUNDS.into_iter().zip(&mut ratios) {
            let mut surface = TinSurface::default();
            let view = CameraView::of_errors_above(bound).map_err(|it| it.to_string())?;
            tin.draw(&view, &mut surface);
            let place = |vertex: u32| [vertex as usize % SIDE, vertex as usize / SIDE];
            let faces = surface.faces().iter().map(|it| it.1.map(place));
            let error = largest_error(grid.heights(), SIDE, faces);

            let theirs = martini.coarsest(grid, error);
            let theirs_error = largest_error(grid.heights(), SIDE, theirs.iter().copied());
            let at_bound = martini.faces(bound);
            let at_bound = largest_error(grid.heights(), SIDE, at_bound.into_iter());

            let heights: Vec<f64> = grid.heights().iter().map(|&it| it.into()).collect();
            let delatin = delatin::triangulate(&heights, (SIDE, SIDE), delatin::Error(bound));
            let (points, triangles) = delatin.map_err(|it| format!("delatin: {it:?}"))?;
            let point = |i: usize| [points[i].0, points[i].1];
            let delaunay = triangles.iter().map(|&(a, b, c)| [a, b, c].map(point));
            let delaunay_error = largest_error(grid.heights(), SIDE, delaunay);

            let ours = surface.faces().len();
            let ratio = |other: usize| ours as f64 / other as f64;
            println!(
                "| {name} | {bound} | {ours} | {error:.3} | {} | {theirs_error:.3} | {:.3} | {at_bound:.3} | {} | {delaunay_error:.3} | {:.3} |",
                theirs.len(),
                ratio(theirs.len()),
                triangles.len(),
                ratio(triangles.len()),
            );
            ratios.push([ratio(theirs.len()), ratio(triangles.len())]);
        }
    }
    println!(
        "\n| bound | ours / martini, mean | worst | ours / delatin, mean | worst |\n|--:|--:|--:|--:|--:|"
    );
    for (bound, ratios) in BOUNDS.into_iter().zip(ratios) {
        let of = |i: usize| ratios.iter().map(move |it: &[f64; 2]| it[i]);
        let mean = |i: usize| of(i).sum::<f64>() / ratios.len() as f64;
        let worst = |i: usize| of(i).fold(0.0, f64::max);
        println!(
            "| {bound} | {:.3} | {:.3} | {:.3} | {:.3} |",
            mean(0),
            worst(0),
            mean(1),
            worst(1)
        );
    }
    Ok(())
}

/// martini's network over a grid.
struct Martini {
    martini: std::cell::RefCell<martini::Martini>,
    tile: martini::Tile,
}

impl Martini {
    fn new(grid: &HeightGrid) -> Self {
        let martini = martini::Martini::new(grid.size()[0]);
        let tile = martini.create_terrain(|x, y| grid.heights()[y * SIDE + x].into());
        Self {
            martini: martini.into(),
            tile,
        }
    }

    /// Its faces at a bound of its own.
    fn faces(&self, bound: f64) -> Vec<Corners> {
        let mut martini = self.martini.borrow_mut();
        let (_, indices, places) = self
            .tile
            .construct_mesh(&mut martini, bound, &mut |(u, v)| (u, v, 0.0));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "places of the grid"
        )]
        let at = |i: usize| (f64::from(places[i]) * (SIDE - 1) as f64).round() as usize;
        // The second one goes up from the last row.
        let place = |&index: &u32| {
            let index = 2 * index as usize;
            [at(index), SIDE - 1 - at(index + 1)]
        };
        let faces = indices.chunks_exact(3);
        faces
            .map(|it| [place(&it[0]), place(&it[1]), place(&it[2])])
            .collect()
    }

    /// The fewest faces of any bound whose true error is at most this.
    fn coarsest(&self, grid: &HeightGrid, error: f64) -> Vec<Corners> {
        let (mut low, mut high) = (0.0, error);
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            let faces = self.faces(middle).into_iter();
            match largest_error(grid.heights(), SIDE, faces) <= error {
                true => low = middle,
                false => high = middle,
            }
        }
        self.faces(low)
    }
}
