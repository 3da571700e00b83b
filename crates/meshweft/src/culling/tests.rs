//! No front face is left out, by exact signs.

use super::exact::{
    UNIT, any_eye, any_mesh, any_numbers, assert_all_front, ball, cases, on_lattice,
};
use super::{CullingTable, Eye, EyeBox, NormalStripes, Ranges, StripedFaces, ViewClusters};
use crate::cache::{self, CacheModel};
use crate::geometry::Ball;
use crate::index::index32;
use crate::mesh::Mesh;
use crate::order::Optimizer;
use crate::permutation::FaceOrder;
use crate::random::SplitMix64;

#[test]
fn stripes_leave_out_no_front_face() {
    let mut random = any_numbers(1);
    let mut culled = 0;
    let mut all = 0;
    for case in 0..cases(120) {
        let mesh = any_mesh(case, &mut random);
        let stripes = NormalStripes {
            stripe_count: Some([1, 2, 4, 16, 64][random.below(5)]),
            range_count: [1, 2, 7, 64, 512][random.below(5)],
            optimizer: (case % 3 == 0).then(|| Optimizer::for_cache(CacheModel::fifo(16))),
        };
        let striped = stripes.order(&mesh);
        let around = striped.ball().unwrap();
        let mut ranges = Ranges::default();
        for _ in 0..60 {
            let eye = any_eye(&mesh, around, &mut random);
            striped.visible_ranges(eye, &mut ranges);
            assert_all_front(&mesh, striped.order().new_to_old(), eye, &ranges);
            culled += mesh.face_count() - ranges.face_count();
            all += mesh.face_count();
        }
    }
    assert!(culled > all / 10, "{culled} of {all} faces were culled");
}

#[test]
fn an_optimizer_orders_faces_inside_their_ranges() {
    let mesh = ball(40, 60, 0.0, false, &mut any_numbers(8));
    let plain = NormalStripes {
        stripe_count: Some(2),
        range_count: 4,
        optimizer: None,
    };
    let cache = CacheModel::fifo(16);
    let before = plain.order(&mesh);
    let misses = |order: &FaceOrder| cache::misses(mesh.with_face_order(order).as_faces(), cache);
    for keep_corners in [false, true] {
        let optimizer = Optimizer {
            keep_corners,
            ..Optimizer::for_cache(cache)
        };
        let ordered = NormalStripes {
            optimizer: Some(optimizer.clone()),
            ..plain.clone()
        };
        let after = ordered.order(&mesh);
        assert!(misses(after.order()) < misses(before.order()));
        assert_eq!(
            after.order().rotations().iter().all(|&r| r == 0),
            keep_corners
        );

        // The same faces are in each range, and so are found from the same eyes.
        for ends in before.starts().windows(2) {
            let members = |striped: &StripedFaces| {
                let range = ends[0] as usize..ends[1] as usize;
                let mut faces = striped.order().new_to_old()[range].to_vec();
                faces.sort_unstable();
                faces
            };
            assert_eq!(members(&before), members(&after));
        }
        assert_eq!(before.starts(), after.starts());

        // Clusters are ordered likewise.
        let clusters = ViewClusters {
            optimizer,
            ..ViewClusters::default()
        };
        let clustered = clusters.order(&mesh);
        assert_eq!(clustered.order().len(), mesh.face_count());
    }
}

/// Where clusters of any size begin.
fn any_starts(face_count: usize, random: &mut SplitMix64) -> Vec<u32> {
    let largest = [1, 4, 30, 1000][random.below(4)];
    let mut starts = vec![0];
    while let left @ 1.. = face_count - *starts.last().unwrap() as usize {
        starts.push(starts.last().unwrap() + index32(1 + random.below(largest.min(left))));
    }
    starts
}

#[test]
fn clusters_leave_out_no_front_face() {
    let mut random = any_numbers(3);
    let mut culled = 0;
    let mut all = 0;
    for case in 0..cases(120) {
        let mesh = any_mesh(case, &mut random);
        let starts = any_starts(mesh.face_count(), &mut random);
        let table = CullingTable::new(&mesh, &starts);
        let order: Vec<u32> = (0..index32(mesh.face_count())).collect();
        let around = Ball::around(mesh.corner_positions()).unwrap();
        let mut ranges = Ranges::default();
        for _ in 0..60 {
            let eye = any_eye(&mesh, around, &mut random);
            table.visible_ranges(eye, &mut ranges);
            assert_all_front(&mesh, &order, eye, &ranges);
            culled += mesh.face_count() - ranges.face_count();
            all += mesh.face_count();
        }
    }
    assert!(culled > all / 5, "{culled} of {all} faces were culled");
}

#[test]
fn clusters_by_view_leave_out_no_front_face() {
    let mut random = any_numbers(6);
    let mut culled = 0;
    let mut all = 0;
    for case in 0..cases(40) {
        let mesh = any_mesh(case, &mut random);
        let clusters = ViewClusters {
            optimizer: Optimizer::for_cache(match case % 2 {
                0 => CacheModel::fifo(16),
                _ => CacheModel::Nvidia,
            }),
            ..ViewClusters::default()
        };
        let clustered = clusters.order(&mesh);
        let order = clustered.order().new_to_old();
        let striped = NormalStripes::default().order(&mesh);
        let mut ranges = Ranges::default();
        for _ in 0..60 {
            let eye = any_eye(&mesh, striped.ball().unwrap(), &mut random);
            clustered.table().visible_ranges(eye, &mut ranges);
            assert_all_front(&mesh, order, eye, &ranges);
            culled += mesh.face_count() - ranges.face_count();
            all += mesh.face_count();
        }
    }
    assert!(culled > all / 6, "{culled} of {all} faces were culled");
}

/// Positions moved by less than an error: what was a table of the mesh before still leaves out nothing.
#[test]
fn positions_may_be_off_by_an_error_that_is_known() {
    let mut random = any_numbers(7);
    let mut culled = 0;
    for case in 0..cases(60) {
        let mesh = any_mesh(case, &mut random);
        let steps = [1, 16, 256][random.below(3)];
        let clusters = ViewClusters {
            position_error: steps as f32 * UNIT * 1.75,
            ..ViewClusters::default()
        };
        let clustered = clusters.order(&mesh);
        let moved = mesh.positions().iter();
        let moved = moved.map(|position| {
            position.map(|x| x + (random.below(2 * steps + 1) as f32 - steps as f32) * UNIT)
        });
        let moved = Mesh::new(moved.collect::<Vec<_>>(), mesh.faces().to_vec()).unwrap();
        let striped = NormalStripes::default().order(&moved);
        let mut ranges = Ranges::default();
        for _ in 0..60 {
            let eye = any_eye(&moved, striped.ball().unwrap(), &mut random);
            clustered.table().visible_ranges(eye, &mut ranges);
            assert_all_front(&moved, clustered.order().new_to_old(), eye, &ranges);
            culled += mesh.face_count() - ranges.face_count();
        }
    }
    assert!(culled > 50_000, "{culled} faces were culled");
}

#[test]
fn what_any_eye_of_a_box_sees_is_drawn() {
    let mut random = any_numbers(4);
    let mut culled = [0, 0];
    for case in 0..cases(60) {
        let mesh = any_mesh(case, &mut random);
        let starts = any_starts(mesh.face_count(), &mut random);
        let table = CullingTable::new(&mesh, &starts);
        let striped = NormalStripes::default().order(&mesh);
        let whole: Vec<u32> = (0..index32(mesh.face_count())).collect();
        let around = striped.ball().unwrap();
        let mut ranges = [Ranges::default(), Ranges::default()];
        for _ in 0..20 {
            let [x, y, z, w] = any_eye(&mesh, around, &mut random).point;
            let size = [0.0, 0.01, 0.1, 1.0][random.below(4)];
            let half = [(); 3]
                .map(|()| on_lattice(size * around.radius * random.below(1000) as f64 / 1000.0));
            let low = [x - half[0], y - half[1], z - half[2]];
            let high = [x + half[0], y + half[1], z + half[2]];
            let eyes = EyeBox { low, high, w };
            table.ranges_visible_within(eyes, &mut ranges[0]);
            striped.ranges_visible_within(eyes, &mut ranges[1]);
            for _ in 0..10 {
                let [x, y, z] =
                    [0, 1, 2].map(|i| [low[i], high[i], low[i] + half[i]][random.below(3)]);
                let eye = Eye {
                    point: [x, y, z, w],
                };
                assert_all_front(&mesh, &whole, eye, &ranges[0]);
                assert_all_front(&mesh, striped.order().new_to_old(), eye, &ranges[1]);
            }
            for (culled, ranges) in culled.iter_mut().zip(&ranges) {
                *culled += mesh.face_count() - ranges.face_count();
            }
        }
    }
    assert!(
        culled.iter().all(|&count| count > 10_000),
        "{culled:?} faces were culled"
    );
}

/// The edges of a small face are lost when its corners are moved to the middle of a large mesh; its normal must not be.
#[test]
fn small_faces_keep_their_normals() {
    for size in [1e-6_f32, 1e-12, 1e-17, 1e-20] {
        let small = [[0.0, 0.0, 0.0], [size, 0.0, 0.0], [0.0, size, 0.0]];
        let large = [[5.1, 0.3, -0.7], [9.3, 0.3, -0.7], [5.1, 7.7, -0.7]];
        let mesh = Mesh::new([small, large].concat(), [[0, 1, 2], [3, 5, 4]]).unwrap();
        let clustered = ViewClusters::default().order(&mesh);
        let table = CullingTable::new(&mesh, &[0, 1, 2]);
        let mut ranges = Ranges::default();
        for (order, table) in [
            (clustered.order().new_to_old(), clustered.table()),
            (&[0, 1][..], &table),
        ] {
            for eye in [Eye::towards([0.1, -0.2, 1.0]), Eye::at([3.0, 3.0, 50.0])] {
                table.visible_ranges(eye, &mut ranges);
                let drawn = ranges.as_slice().iter().flat_map(Clone::clone);
                let drawn: Vec<u32> = drawn.map(|place| order[place as usize]).collect();
                assert!(drawn.contains(&0), "{size}: {drawn:?}");
            }
            table.visible_ranges(Eye::towards([0.1, -0.2, -1.0]), &mut ranges);
            assert!(ranges.face_count() < 2, "{size}");
        }
    }
}

#[test]
fn an_eye_inside_or_no_eye_sees_everything() {
    let mesh = ball(8, 12, 0.0, false, &mut SplitMix64(2));
    let striped = NormalStripes::default().order(&mesh);
    let mut ranges = Ranges::default();
    for point in [
        [0.0, 0.0, 0.0, 1.0],
        [9.0, 0.0, 0.0, 1.0],
        [0.0; 4],
        [f32::NAN, 0.0, 0.0, 1.0],
        [99.0, 0.0, 0.0, -1.0],
        [f32::INFINITY, 0.0, 0.0, 1.0],
    ] {
        striped.visible_ranges(Eye { point }, &mut ranges);
        assert_eq!(ranges.face_count(), mesh.face_count(), "{point:?}");
    }
    // Half of a ball is hidden; the ranges at the border are drawn too.
    striped.visible_ranges(Eye::towards([1.0, 0.0, 0.0]), &mut ranges);
    assert!(ranges.face_count() < mesh.face_count() * 2 / 3);
}
