use super::*;
use crate::cache::nvidia::meshlet_setup_cycles;
use crate::culling::exact::{self, any_eye, assert_all_front, ball, is_front, on_lattice, soup};
use crate::geometry::Ball;
use crate::geometry::double::widened;
use crate::random::SplitMix64;

/// A soup, or a closed ball that may be rough and inside out.
fn any_mesh(random: &mut SplitMix64) -> Mesh {
    match random.below(3) {
        0 => soup(random),
        _ => {
            let (rings, around) = (2 + random.below(14), 3 + random.below(30));
            let rough = [0.0, 1.0, 8.0][random.below(3)];
            let is_inside_out = random.below(2) == 0;
            ball(
                index32(rings),
                index32(around),
                rough,
                is_inside_out,
                random,
            )
        }
    }
}

fn any_settings(random: &mut SplitMix64) -> Meshlets {
    Meshlets {
        vertex_limit: [3, 4, 12, 64, 128, 256][random.below(6)],
        face_limit: [1, 5, 16, 96, 512][random.below(5)],
        cone_weight: [0.0, 0.25, 1.0][random.below(3)],
    }
}

/// The order is checked to have every face once when it is made.
fn assert_is_sound(mesh: &Mesh, settings: Meshlets, made: &MeshletMesh) {
    let order = Permutation::new(made.order().new_to_old().to_vec()).unwrap();
    assert_eq!(order.len(), mesh.face_count());
    assert_eq!(made.starts().len(), made.len() + 1);
    assert_eq!(made.starts()[made.len()] as usize, mesh.face_count());
    let faces = made.order().apply(mesh.faces());
    for meshlet in 0..made.len() {
        let vertices = made.vertices(meshlet);
        let local = made.local_faces(meshlet);
        assert!((1..=settings.face_limit as usize).contains(&local.len()));
        assert!(vertices.len() <= settings.vertex_limit as usize);

        // The same corners, numbered by first use.
        let start = made.starts()[meshlet] as usize;
        let mut first_uses = Vec::new();
        for (face, local) in faces[start..].iter().zip(local) {
            assert_eq!(local.map(|vertex| vertices[usize::from(vertex)]), *face);
            for &vertex in face {
                if !first_uses.contains(&vertex) {
                    first_uses.push(vertex);
                }
            }
        }
        assert_eq!(first_uses, vertices);
    }
}

#[test]
fn every_face_is_in_one_meshlet_within_the_limits() {
    let mut random = SplitMix64(1);
    for _ in 0..600 {
        let mesh = any_mesh(&mut random);
        let settings = any_settings(&mut random);
        let made = settings.build(&mesh);
        assert_is_sound(&mesh, settings, &made);
        assert_eq!(made, settings.build(&mesh));
    }
}

#[test]
fn meshlets_are_filled() {
    let mesh = ball(120, 160, 0.5, false, &mut SplitMix64(1));
    for (settings, most) in [(Meshlets::default(), 1.07), (Meshlets::LARGE, 1.4)] {
        let made = settings.build(&mesh);
        let least = mesh.face_count() as f64 / f64::from(settings.face_limit);
        let share = made.len() as f64 / least;
        assert!(share < most, "{share}");
        let cycles = |meshlet| meshlet_setup_cycles(made.local_faces(meshlet));
        let cycles: u64 = (0..made.len()).map(cycles).sum();
        let share = cycles as f64 / (mesh.face_count() + 3 * made.len()) as f64;
        assert!(share < 1.01, "{share}");
    }
}

/// Eyes at the border of a cone: of the last that see nothing, and the first that see something.
fn eye_at_border(cone: &NormalCone, random: &mut SplitMix64) -> Eye {
    let axis = widened(cone.axis);
    let any = [(); 3].map(|()| random.below(2001) as f64 - 1000.0);
    let across = crate::geometry::double::cross(axis, any);
    let length = crate::geometry::double::dot(across, across).sqrt().max(1.0);
    let cosine = f64::from(cone.cutoff) * [0.99, 0.9999, 1.0, 1.0001][random.below(4)];
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let far = [0.05, 1.0, 40.0][random.below(3)];
    let way = [0, 1, 2].map(|i| far * (cosine * axis[i] + sine * across[i] / length));
    match random.below(3) {
        0 => Eye::towards(way.map(|x| on_lattice(-100.0 * x))),
        _ => Eye::at([0, 1, 2].map(|i| on_lattice(f64::from(cone.apex[i]) - way[i]))),
    }
}

/// The test as a shader does it.
fn is_hidden_in_a_shader(cone: &NormalCone, eye: Eye) -> bool {
    let [x, y, z, w] = eye.point;
    let way = match w == 0.0 {
        true => [-x, -y, -z],
        false => [cone.apex[0] - x, cone.apex[1] - y, cone.apex[2] - z],
    };
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let length = dot(way, way).sqrt();
    dot(way.map(|x| x / length), cone.axis) >= cone.cutoff
}

#[test]
fn cones_leave_out_no_front_face() {
    let mut random = SplitMix64(3);
    let (mut culled, mut in_shader) = (0, 0);
    for _ in 0..250 {
        let mesh = any_mesh(&mut random);
        let made = any_settings(&mut random).build(&mesh);
        let order = made.order().new_to_old();
        let positions = mesh.positions().iter().copied().map(widened);
        let around = Ball::around(positions).unwrap();
        let mut ranges = Ranges::default();
        for view in 0..40 {
            let eye = match view % 2 {
                0 => any_eye(&mesh, around, &mut random),
                _ => eye_at_border(&made.cones()[random.below(made.len())], &mut random),
            };
            made.visible_ranges(eye, &mut ranges);
            assert_all_front(&mesh, order, eye, &ranges);
            culled += mesh.face_count() - ranges.face_count();

            // A shader agrees.
            for (cone, ends) in made.cones().iter().zip(made.starts().windows(2)) {
                if is_hidden_in_a_shader(cone, eye) {
                    for &face in &order[ends[0] as usize..ends[1] as usize] {
                        let corners = mesh.faces()[face as usize];
                        let corners = corners.map(|vertex| mesh.positions()[vertex as usize]);
                        assert!(!is_front(corners, eye), "{corners:?} from {eye:?}");
                        in_shader += 1;
                    }
                }
            }
        }
    }
    assert!(
        culled > 200_000 && in_shader > 200_000,
        "{culled} and {in_shader}"
    );
}

#[test]
fn by_visibility_fewer_ranges_are_drawn_of_the_same_faces() {
    let mut random = SplitMix64(11);
    let mesh = ball(60, 80, 1.0, false, &mut random);
    let settings = Meshlets {
        face_limit: 24,
        ..Meshlets::default()
    };
    let made = settings.build(&mesh);
    let sorted = made.by_visibility();
    assert_is_sound(&mesh, settings, &sorted);
    let around = Ball::around(mesh.positions().iter().copied().map(widened)).unwrap();
    let mut draws = [0, 0];
    let [mut before, mut after] = [Ranges::default(), Ranges::default()];
    for _ in 0..100 {
        let eye = any_eye(&mesh, around, &mut random);
        made.visible_ranges(eye, &mut before);
        sorted.visible_ranges(eye, &mut after);
        assert_eq!(before.face_count(), after.face_count());
        assert_all_front(&mesh, sorted.order().new_to_old(), eye, &after);
        draws[0] += before.as_slice().len();
        draws[1] += after.as_slice().len();
    }
    assert!(draws[1] < draws[0], "{draws:?}");
}

/// A coordinate in units of 2⁻⁶⁴; `None` if it is none of these.
fn in_units(x: f32) -> Option<i128> {
    let units = f64::from(x) * 2_f64.powi(64);
    #[expect(clippy::cast_possible_truncation, reason = "of points that are near")]
    (units == units.round()).then_some(units as i128)
}

#[test]
fn apexes_are_behind_all_planes() {
    let mut random = SplitMix64(9);
    let mut checked = 0;
    for _ in 0..300 {
        // A mesh far from the origin: rounding moves an apex by much of its size.
        let is_inside_out = random.below(2) == 0;
        let near = ball(4, 9, 1.0, is_inside_out, &mut random);
        let away = on_lattice(random.below(1_900_000) as f64 / 1000.0);
        let moved = near.positions().iter().map(|point| point.map(|x| x + away));
        let mesh = Mesh::new(moved.collect::<Vec<_>>(), near.faces()).unwrap();
        let made = any_settings(&mut random).build(&mesh);
        let faces = made.order().apply(mesh.faces());
        for (cone, ends) in made.cones().iter().zip(made.starts().windows(2)) {
            let apex = cone.apex.map(in_units);
            let ([Some(x), Some(y), Some(z)], true) = (apex, cone.cutoff < 1.0) else {
                continue;
            };
            for face in &faces[ends[0] as usize..ends[1] as usize] {
                let [a, b, c] = face.map(|vertex| mesh.positions()[vertex as usize]);
                let edge = |p: [f32; 3]| [0, 1, 2].map(|i| exact::in_units(p[i] - a[i]));
                let (u, v) = (edge(b), edge(c));
                let way = [0, 1, 2].map(|i| [x, y, z][i] - in_units(a[i]).unwrap());
                let normal = [0, 1, 2].map(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    u[j] * v[k] - u[k] * v[j]
                });
                let height: i128 = (0..3).map(|i| normal[i] * way[i]).sum();
                assert!(height <= 0, "{cone:?} before {a:?} {b:?} {c:?}");
                checked += 1;
            }
        }
    }
    assert!(checked > 10_000, "{checked}");
}

#[test]
fn cones_know_when_to_be_sure() {
    let face = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let behind = Eye::at([0.3, 0.3, -1.0]);
    let hides =
        |faces: &[[[f32; 3]; 3]]| NormalCone::around(faces.iter().copied()).is_hidden_from(behind);
    assert!(hides(&[face]));
    assert!(!NormalCone::around([face]).is_hidden_from(Eye::at([0.3, 0.3, 1.0])));
    for point in [[0.0; 4], [f32::NAN; 4], [0.0, 0.0, -1.0, -1.0]] {
        assert!(!NormalCone::around([face]).is_hidden_from(Eye { point }));
    }

    // Faces without an area are never seen: in a corner, on a line whose points are no multiples of each other.
    let on_line = [
        [0.1, 0.3, -0.7],
        [0.1 + 0.25, 0.3 + 0.5, -0.7 + 0.75],
        [0.1, 0.3, -0.7],
    ];
    let third = [0.75, -1.5, 3.0];
    let also = [third, third.map(|x| 3.0 * x), third.map(|x| -8.0 * x)];
    assert!(hides(&[face, on_line, also]));
    assert!(!hides(&[]) && !hides(&[on_line]));

    // One that is nearly so may look anywhere; so may one that is not finite.
    let sliver = [[0.0; 3], [1.0; 3], [1e9, 1e9, 1e9_f32.next_up()]];
    let far = [[0.0; 3], [1e-20, 0.0, 0.0], [1e20, 1e-20, 1.0]];
    let nan = [[f32::NAN, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for unsure in [sliver, far, nan] {
        assert!(!hides(&[face, unsure]), "{unsure:?}");
    }

    // Two that look against each other.
    assert!(!hides(&[face, [face[0], face[2], face[1]]]));
}

#[test]
fn the_extremes_are_meshlets_too() {
    let mesh = |positions: &[[f32; 3]], faces: &[[u32; 3]]| Mesh::new(positions, faces).unwrap();
    let settings = Meshlets::default();
    let none = settings.build(&mesh(&[], &[]));
    assert!(none.is_empty() && none.order().is_empty() && none.starts() == [0]);
    let mut ranges = Ranges::default();
    assert_eq!(
        none.visible_ranges(Eye::at([0.0; 3]), &mut ranges)
            .face_count(),
        0
    );

    // One vertex, and coordinates that are no number or as large as they get.
    let wild = [
        [f32::NAN; 3],
        [f32::INFINITY, 0.0, 0.0],
        [f32::MAX; 3],
        [-f32::MAX, 1e-45, 0.0],
    ];
    let mut random = SplitMix64(5);
    for positions in [&[[1.0; 3]][..], &wild] {
        let count = positions.len();
        let face = |_| [(); 3].map(|()| index32(random.below(count)));
        let mesh = mesh(positions, &(0..300).map(face).collect::<Vec<_>>());
        let made = settings.build(&mesh);
        assert_is_sound(&mesh, settings, &made);
        assert_eq!(made.len(), 4);
        made.visible_ranges(Eye::at([9.0; 3]), &mut ranges);
        assert_eq!(ranges.face_count(), 300);
    }
}

#[test]
fn the_order_inside_takes_no_more_cycles() {
    let mut random = SplitMix64(7);
    let mut cycles = [0, 0];
    for _ in 0..3000 {
        // Strips, or faces anywhere, some of them degenerate.
        let count = 1 + random.below(256);
        let range = [2, 5, count][random.below(3)].min(count);
        let mut corner = |i: usize| u8::try_from((i + random.below(range)) % count).unwrap();
        let face_count = count + count / 3;
        let before: Vec<[u8; 3]> = (0..face_count)
            .map(|i| [0; 3].map(|_| corner(i / 2)))
            .collect();
        let vertices_before: Vec<u32> = (0..index32(count)).map(|i| 1000 - 3 * i).collect();
        let (mut vertices, mut faces) = (vertices_before.clone(), before.clone());
        let order = order_meshlet(&mut vertices, &mut faces).unwrap();

        // The same faces, with their corners as they were.
        let in_mesh = |vertices: &[u32], faces: &[[u8; 3]]| -> Vec<[u32; 3]> {
            let corners = faces.iter();
            corners
                .map(|face| face.map(|vertex| vertices[usize::from(vertex)]))
                .collect()
        };
        let was = in_mesh(&vertices_before, &before);
        assert_eq!(in_mesh(&vertices, &faces), order.apply(&was));
        let mut sorted = vertices.clone();
        sorted.sort_unstable_by(|a, b| b.cmp(a));
        assert_eq!(sorted, vertices_before);

        // By first use, and no slower.
        let mut next = 0;
        for &vertex in faces.as_flattened() {
            assert!(vertex <= next);
            next += u8::from(vertex == next && next < u8::MAX);
        }
        let [now, then] = [&faces, &before].map(|faces| meshlet_setup_cycles(faces));
        assert!(now <= then);
        cycles[0] += then;
        cycles[1] += now;
    }
    assert!(cycles[1] < cycles[0] * 9 / 10, "{cycles:?}");
}

#[test]
fn a_face_of_a_vertex_that_there_is_not_is_named() {
    let mut vertices = [7, 8, 9];
    let mut faces = [[0, 1, 2], [0, 3, 1]];
    let error = order_meshlet(&mut vertices, &mut faces).unwrap_err();
    assert_eq!(
        error.to_string(),
        "face 1, corner 1: index 3 is past the last vertex (2)"
    );
    assert_eq!((vertices, faces), ([7, 8, 9], [[0, 1, 2], [0, 3, 1]]));
}
