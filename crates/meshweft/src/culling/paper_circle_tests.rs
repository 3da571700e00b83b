//! Why one circle of a stripe's bounding cylinder is not enough: the paper's rule, read plainly, leaves out front faces.

use std::f64::consts::{PI, TAU};

use super::exact::{assert_all_front, ball, is_front, on_lattice};
use super::{Eye, NormalStripes, Ranges};
use crate::geometry::Ball;
use crate::geometry::double::{cross, dot, scaled, sub, widened};
use crate::mesh::Mesh;
use crate::random::SplitMix64;

type Vector = [f64; 3];

const STRIPES: u32 = 16;

/// Which circles of a stripe are cut by the plane.
#[derive(Clone, Copy)]
enum Rule {
    /// The paper's: of the bounding cylinder's circles the one whose intersections are closer to the viewpoint.
    OneCircle,
    /// Both parallels, each with its own radius, and the wider one is taken.
    BothParallels,
}

/// Stripes and ranges as the paper has them: all of the same size.
struct PlainStripes {
    stripes: u32,
    ranges: u32,
    rule: Rule,
}

/// The circle of a cylinder around the axis, in units of the bounding sphere's radius.
#[derive(Clone, Copy)]
struct Circle {
    height: f64,
    radius: f64,
}

/// What of a circle is in front of the plane.
#[derive(Clone, Copy)]
enum InFront {
    Nothing,
    All,
    /// Longitudes at most so far from that of the eye.
    Within(f64),
}

impl Circle {
    /// The points with `p · d >= −s`: those in front of the plane at the distance |OV| + r² / |OV| from the eye.
    fn in_front(self, direction: Vector, sine: f64) -> InFront {
        let across = (direction[0].powi(2) + direction[2].powi(2)).sqrt();
        let least = -sine - self.height * direction[1];
        let reach = self.radius * across;
        match least.abs() < reach {
            true => InFront::Within((least / reach).acos()),
            false if least < 0.0 => InFront::All,
            false => InFront::Nothing,
        }
    }
}

impl PlainStripes {
    /// The stripe and the range of a normal.
    fn place(&self, [x, y, z]: Vector) -> (u32, u32) {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a share of few parts"
        )]
        let part = |share: f64, parts: u32| ((share * f64::from(parts)) as u32).min(parts - 1);
        (
            part(y.acos() / PI, self.stripes),
            part(longitude(x, z) / TAU, self.ranges),
        )
    }

    /// Whether a face with this normal is drawn.
    fn draws(&self, normal: Vector, direction: Vector, sine: f64) -> bool {
        let (stripe, range) = self.place(normal);
        let latitude = |stripe: u32| PI * f64::from(stripe) / f64::from(self.stripes);
        let latitudes = [latitude(stripe), latitude(stripe + 1)];
        let sines = latitudes.map(f64::sin);

        // The cylinder is as wide as the stripe is anywhere; none here has the equator inside.
        let radii = match self.rule {
            Rule::OneCircle => [sines[0].max(sines[1]); 2],
            Rule::BothParallels => sines,
        };
        let circles = [0, 1].map(|i| Circle {
            height: latitudes[i].cos(),
            radius: radii[i],
        });

        // The plane is at one distance from the eye: what of it is nearer to the line of sight is closer to the viewpoint.
        let half_width = match circles.map(|circle| circle.in_front(direction, sine)) {
            [InFront::Nothing, InFront::Nothing] => return false,
            [InFront::All, _] | [_, InFront::All] => return true,
            [InFront::Within(width), InFront::Nothing]
            | [InFront::Nothing, InFront::Within(width)] => width,
            [InFront::Within(top), InFront::Within(bottom)] => match self.rule {
                Rule::OneCircle if circles[0].height.abs() <= circles[1].height.abs() => top,
                Rule::OneCircle => bottom,
                Rule::BothParallels => top.max(bottom),
            },
        };

        // All ranges from the one with one end to the one with the other.
        let middle = longitude(direction[0], direction[2]);
        let range_of = |longitude: f64| self.place([longitude.sin(), 0.0, longitude.cos()]).1;
        let first = range_of(middle - half_width);
        let last = range_of(middle + half_width);
        match (middle - half_width < 0.0) != (middle + half_width >= TAU) {
            true => range >= first || range <= last,
            false => (first..=last).contains(&range),
        }
    }
}

/// From z towards x, in 0 to 2π.
fn longitude(x: f64, z: f64) -> f64 {
    x.atan2(z).rem_euclid(TAU)
}

fn unit(a: Vector) -> Vector {
    scaled(a, 1.0 / dot(a, a).sqrt())
}

/// How many front faces a rule leaves out from an eye, of 16 stripes.
fn left_out(mesh: &Mesh, around: Ball, rule: Rule, eye: Eye) -> usize {
    let [x, y, z, w] = eye.point.map(f64::from);
    let way = match w == 0.0 {
        true => [x, y, z],
        false => sub([x, y, z], around.center),
    };
    let sine = w * around.radius / dot(way, way).sqrt();
    let plain = PlainStripes {
        stripes: STRIPES,
        ranges: 512,
        rule,
    };
    let is_left_out = |face: &&[u32; 3]| {
        let corners = face.map(|vertex| mesh.positions()[vertex as usize]);
        let [a, b, c] = corners.map(widened);
        let normal = cross(sub(b, a), sub(c, a));
        is_front(corners, eye) && !plain.draws(unit(normal), unit(way), sine)
    };
    mesh.faces().iter().filter(is_left_out).count()
}

/// Of 200 views of a ball: in how many each rule leaves out front faces, and how many at most; the library leaves out none.
fn views_with_holes(mesh: &Mesh, radii: Option<f64>) -> [(usize, usize); 2] {
    let order = NormalStripes {
        stripe_count: Some(STRIPES),
        ..NormalStripes::default()
    };
    let striped = order.order(mesh);
    let around = striped.ball().unwrap();
    let mut random = SplitMix64(5);
    let mut ranges = Ranges::default();
    let mut counts = [(0, 0); 2];
    for _ in 0..200 {
        let direction = unit([(); 3].map(|()| random.below(2001) as f64 / 1000.0 - 1.0));
        let eye = match radii {
            None => Eye::towards(direction.map(|x| on_lattice(1000.0 * x))),
            Some(radii) => {
                let far = radii * around.radius;
                Eye::at([0, 1, 2].map(|i| on_lattice(around.center[i] + far * direction[i])))
            }
        };
        striped.visible_ranges(eye, &mut ranges);
        assert_all_front(mesh, striped.order().new_to_old(), eye, &ranges);
        for (rule, (views, most)) in [Rule::OneCircle, Rule::BothParallels]
            .into_iter()
            .zip(&mut counts)
        {
            let holes = left_out(mesh, around, rule, eye);
            *views += usize::from(holes > 0);
            *most = holes.max(*most);
        }
    }
    counts
}

/// A smooth ball of 6,240 faces with an area, turned inside out or not.
fn smooth_ball(is_inside_out: bool) -> Mesh {
    ball(40, 80, 0.0, is_inside_out, &mut SplitMix64(1))
}

#[test]
fn one_circle_of_a_cylinder_leaves_out_front_faces_of_a_ball_that_is_inside_out() {
    let [(views, most), of_both] = views_with_holes(&smooth_ball(true), Some(4.0));
    println!("inside out, 4r: {views} of 200 views, at most {most} faces");
    assert!(views > 100 && most > 60, "{views} views, {most} faces");
    assert_eq!(of_both, (0, 0));
}

#[test]
fn one_circle_of_a_cylinder_leaves_out_front_faces_of_any_ball_in_orthographic_views() {
    for is_inside_out in [false, true] {
        let [(views, most), of_both] = views_with_holes(&smooth_ball(is_inside_out), None);
        println!(
            "inside out: {is_inside_out}, orthographic: {views} of 200 views, at most {most} faces"
        );
        assert!(views > 100 && most > 60, "{views} views, {most} faces");
        assert_eq!(of_both, (0, 0));
    }
}
