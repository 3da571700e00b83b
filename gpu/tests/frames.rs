//! Culled frames on the card of this machine; skipped as those of `counts.rs` are.

#[path = "on_a_card/mod.rs"]
mod on_a_card;

use gpu::cull::{self, Culler, Tally, cullers};
use gpu::draw::Draw;
use gpu::frames::{Frames, Scene};
use gpu::meshes::NamedMesh;
use gpu::vulkan::{Card, Draws};
use meshweft::Mesh;
use meshweft::culling::NormalStripes;
use on_a_card::on_a_card;

/// A torus around the y axis whose faces turn left on its outside.
fn torus(rings: u32, around: u32) -> NamedMesh {
    let steps = (0..rings).flat_map(|ring| (0..around).map(move |step| (ring, step)));
    let turn = |step: u32, of: u32| std::f32::consts::TAU * step as f32 / of as f32;
    let position = |(ring, step)| {
        let (out, along) = (turn(ring, rings), turn(step, around));
        let radius = 0.6 + 0.4 * out.sin();
        [radius * along.sin(), 0.4 * out.cos(), radius * along.cos()]
    };
    let positions: Vec<[f32; 3]> = steps.clone().map(position).collect();
    let faces = steps.flat_map(|(ring, step)| {
        let at = |ring: u32, step: u32| ring % rings * around + step % around;
        let [a, b] = [at(ring, step), at(ring + 1, step)];
        let [c, d] = [at(ring + 1, step + 1), at(ring, step + 1)];
        [[a, b, c], [a, c, d]]
    });
    NamedMesh {
        name: "torus".to_owned(),
        mesh: Mesh::new(positions, faces.collect::<Vec<_>>()).unwrap(),
    }
}

fn tally(frames: &Frames<'_, '_>, cullers: &dyn Fn(&Mesh, &Card) -> Vec<Culler>) -> Tally {
    let meshes = [torus(40, 90)];
    cull::pictures(frames, &meshes, 32, cullers).unwrap().0
}

#[test]
fn culled_frames_look_like_whole_ones_and_are_counted_as_the_model_says() {
    on_a_card("frames", |renderer| {
        let frames = Frames::new(renderer, 200).unwrap();
        let tally = tally(&frames, &cullers);
        assert!(tally.is_right(renderer.gpu().card()), "{tally:?}");
        assert!(
            tally.pixels > 200_000 && tally.drawn < tally.faces,
            "{tally:?}"
        );
    });
}

/// A culler that leaves out what is in front.
fn wrong_side(mesh: &Mesh, _: &Card) -> Vec<Culler> {
    let turned = mesh.faces().iter().map(|&[a, b, c]| [a, c, b]);
    let turned = Mesh::new(mesh.positions(), turned.collect::<Vec<_>>()).unwrap();
    let stripes = NormalStripes {
        stripe_count: Some(64),
        ..NormalStripes::default()
    };
    let striped = stripes.order(&turned);
    vec![Culler {
        name: "wrong side".to_owned(),
        order: striped.order().clone(),
        visible: Some(Box::new(move |eye, ranges| {
            striped.visible_ranges(eye, ranges);
        })),
    }]
}

#[test]
fn faces_that_are_left_out_are_missed() {
    on_a_card("missed faces", |renderer| {
        let frames = Frames::new(renderer, 200).unwrap();
        let tally = tally(&frames, &wrong_side);
        assert!(tally.wrong > 10_000, "{tally:?}");
        assert!(!tally.is_right(renderer.gpu().card()));
    });
}

#[test]
fn a_frame_shows_which_face_of_which_draw_is_nearest() {
    on_a_card("nearest", |renderer| {
        // The second and the third face lie before the first, on half of the picture; the last is seen from behind.
        let mesh = [
            [[-1.0, -1.0, 0.5], [3.0, -1.0, 0.5], [-1.0, 3.0, 0.5]],
            [[-1.0, -1.0, 0.25], [0.0, -1.0, 0.25], [0.0, 1.0, 0.25]],
            [[-1.0, -1.0, 0.25], [0.0, 1.0, 0.25], [-1.0, 1.0, 0.25]],
            [[-1.0, -1.0, 0.1], [-1.0, 3.0, 0.1], [3.0, -1.0, 0.1]],
        ];
        let indices: Vec<u32> = (0..12).collect();
        let geometry = renderer
            .upload(&Draw {
                positions: Some(mesh.as_flattened()),
                ..Draw::list(&indices)
            })
            .unwrap();
        let draws = [[3, 1, 0, 0, 0], [9, 1, 3, 0, 0]];
        let draws = Draws::new(renderer.gpu(), &draws).unwrap();
        let mut upright = [0.0; 16];
        for (place, one) in [(0, 1.0), (5, -1.0), (10, 1.0), (15, 1.0)] {
            upright[place] = one;
        }
        let frames = Frames::new(renderer, 8).unwrap();
        let scene = Scene {
            geometry: &geometry,
            draws: &draws,
            objects: vec![(upright, 0..2)],
        };
        let (picture, counts) = frames.picture(&scene).unwrap();
        assert_eq!(counts.invocations, 12);
        let count = |face| picture.seen.iter().filter(|&&seen| seen == face).count();
        assert_eq!(count(Some([0, 0])), 32);
        assert_eq!(count(Some([1, 0])) + count(Some([1, 1])), 32);
        let depths = [0.25_f32, 0.5].map(|depth| {
            let bits = picture.depths.iter();
            bits.filter(|&&bits| f32::from_bits(bits) == depth).count()
        });
        assert_eq!(depths, [32, 32]);
        // Left of the middle, and the first row of a picture is the top one: the second face is on the left there.
        assert_eq!(picture.seen[0], Some([1, 1]));
        assert_eq!(picture.seen[7], Some([0, 0]));

        // Alone, the second draw leaves the rest empty.
        let scene = Scene {
            objects: vec![(upright, 1..2)],
            ..scene
        };
        let (picture, _) = frames.picture(&scene).unwrap();
        assert_eq!(picture.seen[7], None);
        assert_eq!(picture.seen[0], Some([0, 1]));
    });
}

#[test]
fn draws_that_are_no_ranges_are_refused() {
    on_a_card("ranges", |renderer| {
        for draw in [
            [3, 2, 0, 0, 0],
            [3, 1, 0, 1, 0],
            [3, 1, 0, 0, 1],
            [3, 1, u32::MAX, 0, 0],
        ] {
            let error = Draws::new(renderer.gpu(), &[[3, 1, 0, 0, 0], draw]).unwrap_err();
            assert!(
                error.to_string().contains("draw 1 is not a range"),
                "{error}"
            );
        }
    });
}
