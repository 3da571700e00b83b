//! What is left out is not missed: pictures of what a culler draws are those of the whole mesh, pixel by pixel, in
//! colour and depth.
//!
//! Cards move vertices to a grid before they say which side of a face is seen. A face that is a back face by all
//! that is exact, but only just, may so be turned over and drawn, as far as it still has pixels. No culler knows that
//! grid. So each view is drawn twice:
//! - What a front face is, is decided exactly, in the space of the mesh; its pixels come from the grid. These
//!   pictures have to be the same.
//! - It is decided on the grid, as a card does. Where these pictures differ, the whole mesh shows a face that the
//!   grid turned over. Those pixels are counted, and any other is an error.

#[path = "pictures/camera.rs"]
mod camera;
#[cfg(feature = "files")]
#[path = "data/folder.rs"]
mod data;
#[cfg(feature = "files")]
#[path = "data/placed.rs"]
mod placed;
#[path = "pictures/raster.rs"]
mod raster;
#[path = "pictures/scene.rs"]
mod scene;

use std::io::Write;

use camera::{Camera, Placed, SIDE, STEPS};
use meshweft::culling::{Eye, NormalStripes, Ranges, ViewClusters};
use meshweft::{FaceOrder, Mesh};
use raster::{Picture, area};
use scene::{Random, ball, inside_out, is_front, needles, round, soup};

/// Finds what may be seen from an eye.
type Visible = dyn Fn(Eye, &mut Ranges);

/// What finds the faces to draw: ranges of them in an order of its own.
struct Culler {
    name: &'static str,
    order: FaceOrder,
    visible: Box<Visible>,
}

/// All cullers, for a mesh.
fn cullers(mesh: &Mesh) -> Vec<Culler> {
    let stripes = |name, stripe_count| {
        let stripes = NormalStripes {
            stripe_count: Some(stripe_count),
            ..Default::default()
        };
        let striped = stripes.order(mesh);
        Culler {
            name,
            order: striped.order().clone(),
            visible: Box::new(move |eye, ranges| {
                striped.visible_ranges(eye, ranges);
            }),
        }
    };
    let clustered = ViewClusters::default().order(mesh);
    let clusters = Culler {
        name: "clusters",
        order: clustered.order().clone(),
        visible: Box::new(move |eye, ranges| {
            clustered.table().visible_ranges(eye, ranges);
        }),
    };
    vec![stripes("4 stripes", 4), stripes("64 stripes", 64), clusters]
}

/// What was seen.
#[derive(Debug, Default, Clone, Copy)]
struct Outcome {
    views: usize,
    /// Of all views, faces and pixels that show one.
    faces: usize,
    culled: usize,
    pixels: usize,
    /// Pixels where the pictures differ by which side is seen exactly.
    wrong: usize,
    /// Faces left out that the grid turned over; pixels that they have in the picture of the whole.
    turned: usize,
    turned_pixels: usize,
}

/// How a view's pixels and sides come about.
struct View<'m> {
    mesh: &'m Mesh,
    placed: Vec<Placed>,
    /// Of each face, whether it is a front face, exactly.
    is_front: Vec<bool>,
}

impl<'m> View<'m> {
    fn new(mesh: &'m Mesh, eye: Eye, magnified: f64) -> Self {
        let camera = Camera::new(eye, ball(mesh), magnified);
        let corners = |face: &[u32; 3]| face.map(|vertex| mesh.positions()[vertex as usize]);
        let faces = mesh.faces().iter();
        Self {
            mesh,
            placed: mesh.positions().iter().map(|&p| camera.place(p)).collect(),
            is_front: faces.map(|face| is_front(corners(face), eye)).collect(),
        }
    }

    fn corners(&self, face: [u32; 3]) -> [Placed; 3] {
        face.map(|vertex| self.placed[vertex as usize])
    }

    /// Whether the grid shows the front of a face that is a back face.
    fn is_turned(&self, number: u32) -> bool {
        let face = self.mesh.faces()[number as usize];
        !self.is_front[number as usize] && area(self.corners(face)) > 0
    }

    /// The pictures of faces with their numbers in the mesh: sides by what is exact, and by the grid.
    fn pictures(&self, faces: impl Iterator<Item = (u32, [u32; 3])>) -> [Picture; 2] {
        let [mut exact, mut snapped] = [Picture::new(), Picture::new()];
        for (number, face) in faces {
            let corners = self.corners(face);
            if self.is_front[number as usize] {
                exact.draw(number, corners);
            }
            if area(corners) > 0 {
                snapped.draw(number, corners);
            }
        }
        [exact, snapped]
    }
}

impl Outcome {
    /// Draws a mesh whole and culled from some eyes: an outcome for each culler, then one for a culler that leaves
    /// out all back faces.
    fn add(outcomes: &mut [Self], mesh: &Mesh, cullers: &[Culler], views: usize, seed: u64) {
        let mut random = Random(seed);
        let around = ball(mesh);
        let faces = (0..).zip(mesh.faces().iter().copied());
        let ordered: Vec<_> = cullers
            .iter()
            .map(|culler| culler.order.apply(mesh.faces()))
            .collect();
        let mut ranges = Ranges::default();
        for view in 0..views {
            // The whole, once.
            let eye = scene::eye(mesh, around, view, &mut random);
            let magnified = [1.0, 1.0, 5.0][random.below(3)];
            let view = View::new(mesh, eye, magnified);
            let whole = view.pictures(faces.clone());

            for ((culler, ordered), outcome) in cullers.iter().zip(&ordered).zip(&mut *outcomes) {
                (culler.visible)(eye, &mut ranges);
                let places = ranges.as_slice().iter().flat_map(|range| range.clone());
                let old = culler.order.new_to_old();
                let face = |place: u32| (old[place as usize], ordered[place as usize]);
                outcome.compare(&view, places.map(face), &whole);
            }
            let front = faces.clone();
            let front = front.filter(|&(number, _)| view.is_front[number as usize]);
            if let Some(outcome) = outcomes.get_mut(cullers.len()) {
                outcome.compare(&view, front, &whole);
            }
        }
    }

    /// Compares the pictures of some faces with those of the whole.
    fn compare(
        &mut self,
        view: &View<'_>,
        drawn: impl Iterator<Item = (u32, [u32; 3])> + Clone,
        [exact, snapped]: &[Picture; 2],
    ) {
        // The pictures.
        let [culled_exact, culled_snapped] = view.pictures(drawn.clone());
        let mut is_drawn = vec![false; view.is_front.len()];
        drawn.for_each(|(number, _)| is_drawn[number as usize] = true);
        let culled: Vec<u32> = (0..)
            .zip(&is_drawn)
            .filter_map(|(number, is_drawn)| (!is_drawn).then_some(number))
            .collect();
        self.views += 1;
        self.faces += is_drawn.len();
        self.culled += culled.len();
        self.pixels += exact.covered();

        // What differs.
        self.wrong += exact.differences(&culled_exact).count();
        for (whole, culled) in snapped.differences(&culled_snapped) {
            let (_, number) = whole.expect("less is never seen of more");
            let is_explained = !is_drawn[number as usize] && view.is_turned(number);
            self.wrong += usize::from(!is_explained);
            self.turned_pixels += usize::from(is_explained);
            assert!(culled.is_none_or(|culled| whole < Some(culled)));
        }
        let turned = culled.iter().filter(|&&number| view.is_turned(number));
        self.turned += turned.count();
    }

    /// Past the test harness, which would capture it.
    fn print(&self, of: &str, name: &str) {
        let Self { views, pixels, .. } = self;
        let _ = writeln!(
            std::io::stderr(),
            "pictures: {of} by {name}: {views} views, {pixels} pixels, {} differ; {:.1} % of the faces culled, of \
             which the grid turns {} over, with {} pixels",
            self.wrong,
            100.0 * self.culled as f64 / self.faces as f64,
            self.turned,
            self.turned_pixels,
        );
    }
}

/// Asserts that all pictures of some meshes are the same.
fn assert_same_pictures(of: &str, meshes: &[Mesh], views: usize) {
    let cullers: Vec<Vec<Culler>> = meshes.iter().map(cullers).collect();
    let names = cullers[0].iter().map(|culler| culler.name);
    let names = names.chain(["all back faces"]);
    let mut outcomes = vec![Outcome::default(); names.clone().count()];
    for ((mesh, cullers), seed) in meshes.iter().zip(&cullers).zip(1..) {
        Outcome::add(&mut outcomes, mesh, cullers, views, seed);
    }
    for (name, outcome) in names.zip(&outcomes) {
        outcome.print(of, name);
        assert_eq!(outcome.wrong, 0, "{name}");
        assert!(outcome.culled * 20 > outcome.faces, "{outcome:?}");
        // Less than a pixel a view, however many are left out.
        assert!(outcome.turned_pixels < outcome.views, "{outcome:?}");
    }
}

fn made() -> Vec<Mesh> {
    let mut random = Random(1);
    let smooth = round(24, 32, 0.0, 0.0, &mut random);
    let rough = round(16, 40, 0.0, 0.6, &mut random);
    let torus = round(20, 48, 1.5, 0.0, &mut random);
    let coarse = round(2, 4, 0.0, 0.0, &mut random);
    vec![
        inside_out(&smooth),
        inside_out(&rough),
        inside_out(&torus),
        smooth,
        rough,
        torus,
        coarse,
        soup(&mut random),
    ]
}

#[test]
fn pictures_of_made_meshes_are_the_same() {
    assert_same_pictures("made meshes", &made(), 40);
}

#[cfg(feature = "files")]
#[test]
fn pictures_of_real_meshes_are_the_same() {
    let Some(folder) = data::folder() else { return };
    let names = [
        "spot.obj.gz",
        "cow_poly.obj.gz",
        "fandisk.off.gz",
        "suzanne.obj.gz",
        "teapot.off.gz",
        "thingi_88566.stl.gz",
    ];
    let meshes = names.map(|name| {
        let mesh = placed::open(&folder, name);
        scene::fitted(mesh.positions(), mesh.faces().to_vec())
    });
    assert_same_pictures("real meshes", &meshes, 36);
}

#[test]
fn pixels_of_faces_that_the_grid_turns_over_are_told_from_others() {
    let needles = needles(&mut Random(1));
    let mut outcomes = [Outcome::default()];
    Outcome::add(&mut outcomes, &needles, &[], 16, 1);
    outcomes[0].print("needles", "all back faces");
    assert_eq!(outcomes[0].wrong, 0);
    assert!(outcomes[0].turned_pixels > 10, "{:?}", outcomes[0]);
}

/// A culler that forgets how near the eye is: the pictures have to show it.
#[test]
fn a_front_face_that_is_left_out_is_seen() {
    let mesh = inside_out(&round(24, 32, 0.0, 0.0, &mut Random(1)));
    let striped = NormalStripes::default().order(&mesh);
    let center = striped.ball().unwrap().center;
    let forgetful = Culler {
        name: "forgetful",
        order: striped.order().clone(),
        visible: Box::new(move |eye, ranges| {
            let [x, y, z, w] = eye.point;
            let way =
                [0, 1, 2].map(|axis| f64::from([x, y, z][axis]) - f64::from(w) * center[axis]);
            #[expect(clippy::cast_possible_truncation, reason = "positions are f32")]
            let way = way.map(|x| x as f32);
            striped.visible_ranges(Eye::towards(way), ranges);
        }),
    };
    let mut outcomes = [Outcome::default()];
    Outcome::add(&mut outcomes, &mesh, &[forgetful], 16, 1);
    assert!(outcomes[0].wrong > 1000, "{:?}", outcomes[0]);
}

#[test]
fn faces_that_meet_share_no_pixel_and_leave_none_out() {
    // A fan around a vertex off the middle of pixels and one on it, in a square whose edges go through middles.
    let corner = |x: i64, y: i64| Placed { x, y, depth: 7 };
    let half = STEPS / 2;
    for middle in [
        corner(20 * STEPS + half, 30 * STEPS + half),
        corner(9999, 8001),
    ] {
        let (low, high) = (10 * STEPS + half, 50 * STEPS + half);
        let rim = [
            corner(low, low),
            corner(31 * STEPS, low),
            corner(high, low),
            corner(high, high),
            corner(low, high),
        ];
        let mut all = Picture::new();
        let mut covered = 0;
        for i in 0..5 {
            let face = [middle, rim[i], rim[(i + 1) % 5]];
            for (turned, number) in [[0, 1, 2], [1, 2, 0], [2, 0, 1]].into_iter().zip(1..) {
                let mut alone = Picture::new();
                alone.draw(7, turned.map(|corner: usize| face[corner]));
                covered += if number == 1 { alone.covered() } else { 0 };
                all.draw(7, turned.map(|corner: usize| face[corner]));
            }
        }
        // Of the square's edges, the left and the top one count.
        assert_eq!((all.covered(), covered), (40 * 40, 40 * 40));
    }
    assert_eq!(SIDE * STEPS, 32768);
}

#[test]
fn what_is_nearer_is_seen_in_any_order() {
    let face = |depth: [i64; 3]| {
        let at = |x: i64, y: i64, depth| Placed {
            x: x * STEPS,
            y: y * STEPS,
            depth,
        };
        [at(0, 0, depth[0]), at(60, 0, depth[1]), at(0, 60, depth[2])]
    };
    let faces = [face([10, 90, 10]), face([90, 10, 10]), face([90, 10, 10])];
    let drawn = |order: [u32; 3]| {
        let mut picture = Picture::new();
        for number in order {
            picture.draw(number, faces[number as usize]);
        }
        picture
    };
    let first = drawn([0, 1, 2]);
    for order in [[2, 1, 0], [1, 0, 2], [2, 0, 1]] {
        assert_eq!(drawn(order), first);
    }
    let mut without = Picture::new();
    without.draw(0, faces[0]);
    // Beyond the line where both are as deep the second is seen, and the third nowhere.
    let differing: Vec<_> = first.differences(&without).collect();
    assert!(
        (700..1100).contains(&differing.len()),
        "{}",
        differing.len()
    );
    assert!(differing.iter().all(|(seen, _)| seen.unwrap().1 == 1));
}
