//! Polygons of any kind, and hostile bytes.

use super::diagonals;
use super::model::DiagonalModel;
use super::sides::{EdgeKind, FaceSides};
use crate::bits::{DecodeErrorKind, RansEncoder};
use crate::compression::{
    CodeError, CodeOptions, KeepOrder, MeshCode, MeshDecoder, PolygonCounts, PolygonOrder, Tier,
};
use crate::index::index32;
use crate::limits::Limits;
use crate::mesh::Mesh;
use crate::permutation::FaceOrder;
use crate::random::{SplitMix64, shuffled};

/// Polygons of any kind: of a grid, also closed; with corners that are anywhere, also twice; repeated and turned over; and
/// triangles.
fn soup(random: &mut SplitMix64) -> (Mesh, Vec<Vec<u32>>) {
    let (width, height) = (2 + index32(random.below(5)), 2 + index32(random.below(5)));
    let vertex = |x: u32, y: u32| (y % height) * width + x % width;
    let mut polygons: Vec<Vec<u32>> = Vec::new();
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let mut corners = vec![
            vertex(x, y),
            vertex(x + 1, y),
            vertex(x + 1, y + 1),
            vertex(x, y + 1),
        ];
        corners.rotate_left(random.below(4));
        match random.below(8) {
            0 => corners.truncate(3),
            1 => continue,
            _ => {}
        }
        polygons.push(corners);
    }
    for _ in 0..random.below(8) {
        let any = |random: &mut SplitMix64| index32(random.below((width * height) as usize));
        let polygon = match (random.below(4), polygons.last()) {
            (0, Some(last)) => last.clone(),
            (1, Some(last)) => last.iter().rev().copied().collect(),
            _ => (0..3 + random.below(6)).map(|_| any(random)).collect(),
        };
        polygons.push(polygon);
    }

    // In any order, with any numbers.
    let vertex_count = (width * height) as usize + random.below(3);
    let numbers = shuffled(vertex_count, random.next());
    let order = shuffled(polygons.len(), random.next());
    let renumbered = order.into_iter().map(|polygon| {
        let corners = polygons[polygon as usize].iter();
        corners.map(|&vertex| numbers[vertex as usize]).collect()
    });
    let polygons: Vec<Vec<u32>> = renumbered.collect();
    let positions: Vec<[f32; 3]> = (0..vertex_count)
        .map(|_| [(); 3].map(|()| index32(random.below(99)) as f32))
        .collect();
    let faces: Vec<[u32; 3]> = polygons.iter().flat_map(|it| fan(it)).collect();
    (Mesh::new(positions, faces).unwrap(), polygons)
}

fn fan(corners: &[u32]) -> Vec<[u32; 3]> {
    let ends = corners[1..].windows(2);
    ends.map(|ends| [corners[0], ends[0], ends[1]]).collect()
}

fn starts(polygons: &[Vec<u32>]) -> Vec<u32> {
    let mut starts = vec![0];
    for corners in polygons {
        starts.push(starts[starts.len() - 1] + index32(corners.len() - 2));
    }
    starts
}

/// Each polygon as it comes back: whole if each diagonal has one face on each side, and no triangle names a vertex twice.
fn kept(polygons: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let is_flat = |&[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
    let all = polygons.iter().flat_map(|it| fan(it));
    let all: Vec<[u32; 3]> = all.filter(|face| !is_flat(face)).collect();
    let count = |from: u32, to: u32| {
        let goes = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]].contains(&[from, to]);
        all.iter().filter(|face| goes(face)).count()
    };
    let mut kept = Vec::new();
    for corners in polygons {
        let fan = fan(corners);
        let is_plain = |&to: &u32| count(corners[0], to) == 1 && count(to, corners[0]) == 1;
        let is_kept =
            !fan.iter().any(is_flat) && corners[2..corners.len() - 1].iter().all(is_plain);
        match fan.len() == 1 || is_kept {
            true => kept.push(corners.clone()),
            false => kept.extend(fan.iter().map(|face| face.to_vec())),
        }
    }
    kept
}

/// The corners of polygons of a mesh, which must be fans.
fn corners(mesh: &Mesh, starts: &[u32]) -> Vec<Vec<u32>> {
    let polygon = |ends: &[u32]| {
        let faces = &mesh.faces()[ends[0] as usize..ends[1] as usize];
        let mut corners = vec![faces[0][0], faces[0][1]];
        corners.extend(faces.iter().map(|face| face[2]));
        assert_eq!(faces, fan(&corners));
        corners
    };
    starts.windows(2).map(polygon).collect()
}

/// Each turned so that its corners are least, sorted.
fn sorted(polygons: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let turned = |corners: &Vec<u32>| {
        let turns = 0..corners.len();
        let turned = turns.map(|turn| [&corners[turn..], &corners[..turn]].concat());
        turned.min().unwrap()
    };
    let mut sorted: Vec<Vec<u32>> = polygons.iter().map(turned).collect();
    sorted.sort_unstable();
    sorted
}

fn larger(polygons: &[Vec<u32>]) -> usize {
    polygons.iter().filter(|corners| corners.len() > 3).count()
}

const KEPT: [KeepOrder; 4] = [
    KeepOrder::Nothing,
    KeepOrder::Faces,
    KeepOrder::Vertices,
    KeepOrder::Both,
];

#[test]
fn any_polygons_come_back_or_are_counted() {
    let mut random = SplitMix64(1);
    let mut counts = [0; 2];
    for case in 0..3000 {
        let (mesh, polygons) = soup(&mut random);
        let options = CodeOptions {
            tier: Tier::ALL[random.below(Tier::ALL.len())],
            first_vertex: index32(random.below(mesh.vertex_count())),
            keep_order: KEPT[case % 4],
            ..Default::default()
        };
        let code = MeshCode::of_polygons(&mesh, &starts(&polygons), &options).unwrap();
        let expected = kept(&polygons);
        let PolygonCounts { kept, cut } = code.polygons();
        assert_eq!([kept, kept + cut], [larger(&expected), larger(&polygons)]);
        counts[0] += kept;
        counts[1] += cut;

        // In the order of the stream, as cyclic lists with the source's vertices.
        let stored = MeshCode::decode_stored(code.bytes(), Limits::default()).unwrap();
        assert_eq!(stored.polygons.is_some(), kept > 0);
        let each: Vec<u32> = (0..=index32(mesh.face_count())).collect();
        let (order, starts) = match &stored.polygons {
            Some(order) => (order.faces().clone(), order.starts()),
            None => (FaceOrder::identity(mesh.face_count()), &each[..]),
        };
        let in_fans = stored.mesh.with_face_order(&order);
        let of_source = in_fans.with_vertex_order(&code.vertices().permutation().inverse().into());
        assert_eq!(sorted(&corners(&of_source, starts)), sorted(&expected));

        // In that of the source.
        let (mesh_again, starts) = stored.restore();
        let starts = starts.as_deref().unwrap_or(&each);
        let found = corners(&mesh_again, starts);
        match options.keep_order {
            KeepOrder::Both => assert_eq!(found, expected),
            KeepOrder::Vertices => assert_eq!(sorted(&found), sorted(&expected)),
            KeepOrder::Faces => {
                let old = code.vertices().new_to_old();
                let found = found.iter().map(|it| it.iter().map(|&v| old[v as usize]));
                let found: Vec<Vec<u32>> = found.map(Iterator::collect).collect();
                assert_eq!(found, expected);
            }
            KeepOrder::Nothing => {}
        }
    }
    assert!(counts.into_iter().all(|count| count > 3000), "{counts:?}");
}

#[test]
fn triangles_are_the_same_with_polygons_and_have_the_bytes_of_triangles_alone() {
    let mut random = SplitMix64(2);
    for case in 0..500 {
        let (mesh, polygons) = soup(&mut random);
        let options = CodeOptions {
            keep_order: KEPT[case % 4],
            ..Default::default()
        };
        let plain = MeshCode::new(&mesh, &options).unwrap();
        let code = MeshCode::of_polygons(&mesh, &starts(&polygons), &options).unwrap();
        let [alone, beside] =
            [&plain, &code].map(|code| MeshCode::decode(code.bytes(), Limits::default()).unwrap());
        assert_eq!(alone, beside);
        let sizes = code.sizes();
        let more = code.bytes().len() - plain.bytes().len();
        assert_eq!(sizes.polygons.to_bits(), (more as f64).to_bits());
        assert_eq!(code.polygons().kept == 0, more == 0);
        if more == 0 {
            assert_eq!(code.bytes(), plain.bytes());
        }
    }
}

#[test]
fn polygons_arrive_in_pieces_and_are_passed_over_by_whoever_does_not_ask() {
    let mut random = SplitMix64(3);
    for case in 0..300 {
        let (mesh, polygons) = soup(&mut random);
        let options = CodeOptions {
            keep_order: KEPT[case % 4],
            ..Default::default()
        };
        let code = MeshCode::of_polygons(&mesh, &starts(&polygons), &options).unwrap();
        let whole = MeshCode::decode_stored(code.bytes(), Limits::default()).unwrap();
        for (mut decoder, asks) in [
            (MeshDecoder::new(Limits::default()), false),
            (MeshDecoder::with_polygons(Limits::default()), true),
        ] {
            let mut at = 0;
            let mut faces = Vec::new();
            while !decoder.is_complete() {
                assert!(decoder.finish().is_err() && decoder.take_polygons().is_none());
                let end = code.bytes().len().min(at + 1 + random.below(5));
                at += decoder.push(&code.bytes()[at..end]).unwrap();
                faces.extend(decoder.take_faces());
            }
            assert_eq!(at, code.bytes().len());
            assert_eq!(faces, whole.mesh.faces());
            let expected = whole.polygons.clone().filter(|_| asks);
            assert_eq!(decoder.take_polygons(), expected);
            assert_eq!(decoder.take_polygons(), None);
            assert_eq!(decoder.take_source_order().unwrap(), whole.order);
        }
    }
}

#[test]
fn damaged_polygons_give_an_error_or_fans_of_the_same_faces() {
    let mut random = SplitMix64(4);
    let mut read = [0; 2];
    for _ in 0..300 {
        let (mesh, polygons) = soup(&mut random);
        let options = CodeOptions::default();
        let plain = MeshCode::new(&mesh, &options).unwrap();
        let code = MeshCode::of_polygons(&mesh, &starts(&polygons), &options).unwrap();
        if code.polygons().kept == 0 {
            continue;
        }
        for _ in 0..100 {
            let mut damaged = code.bytes().to_vec();
            for _ in 0..=random.below(4) {
                let begin = plain.bytes().len();
                let place = begin + random.below(damaged.len() - begin);
                damaged[place] = damaged[place].wrapping_add(1 << random.below(8));
            }
            let stored = MeshCode::decode_stored(&damaged, Limits::default());
            read[usize::from(stored.is_ok())] += 1;
            if let Ok(stored) = stored {
                check(
                    &stored.mesh,
                    &stored.polygons.expect("they are in the stream"),
                );
            }
        }
    }
    assert!(read[0] > 100, "{read:?}");
}

/// Polygons are fans that have all faces.
fn check(mesh: &Mesh, polygons: &PolygonOrder) {
    assert_eq!(polygons.faces().len(), mesh.face_count());
    corners(&mesh.with_face_order(polygons.faces()), polygons.starts());
}

/// What is written if these sides are said to be diagonals.
fn written(faces: &[[u32; 3]], vertex_count: usize, is_diagonal: impl Fn(u32) -> bool) -> Vec<u8> {
    let mut port = RansEncoder::new(1);
    FaceSides::new(faces, vertex_count).code(&mut port, is_diagonal);
    port.finish()
}

#[test]
fn any_bits_are_fans_but_for_those_all_around_a_vertex() {
    let mut random = SplitMix64(5);
    let mut damaged = 0;
    for _ in 0..3000 {
        let (mesh, _) = soup(&mut random);
        let likely = 1 + random.below(10);
        let bits: Vec<bool> = (0..3 * mesh.face_count())
            .map(|_| random.below(10) < likely)
            .collect();
        let bytes = written(mesh.faces(), mesh.vertex_count(), |side| {
            bits[side as usize]
        });
        match diagonals::read(&bytes, mesh.faces(), mesh.vertex_count()) {
            Ok(polygons) => check(&mesh, &polygons),
            Err(error) => {
                assert_eq!(error.kind, DecodeErrorKind::Damaged);
                damaged += 1;
            }
        }
    }
    assert!((1..1500).contains(&damaged), "{damaged}");

    let umbrella = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
    let spokes = written(&umbrella, 5, |_| true);
    diagonals::read(&spokes, &umbrella, 5).unwrap_err();
    let all_but_one = written(&umbrella, 5, |side| side != 0);
    let polygons = diagonals::read(&all_but_one, &umbrella, 5).unwrap();
    assert_eq!(polygons.len(), 1);
    check(
        &Mesh::connectivity_only(5, umbrella.to_vec()).unwrap(),
        &polygons,
    );
}

#[test]
fn quads_cost_little() {
    // A grid whose diagonals all go the same way, each quad begun at one of two corners.
    let width = 60;
    let mut random = SplitMix64(6);
    let mut polygons = Vec::new();
    for (x, y) in (0..width - 1).flat_map(|y| (0..width - 1).map(move |x| (x, y))) {
        let a = y * width + x;
        let mut corners = vec![a, a + 1, a + width + 1, a + width];
        corners.rotate_left(2 * random.below(2));
        polygons.push(corners);
    }
    let faces: Vec<[u32; 3]> = polygons.iter().flat_map(|it| fan(it)).collect();
    let positions = (0..width * width).map(|i| [(i % width) as f32, (i / width) as f32, 0.0]);
    let mesh = Mesh::new(positions.collect::<Vec<_>>(), faces).unwrap();
    let code = MeshCode::of_polygons(&mesh, &starts(&polygons), &CodeOptions::default()).unwrap();
    assert_eq!(code.polygons().kept, polygons.len());
    assert!(code.sizes().polygons < 30.0, "{}", code.sizes().polygons);
}

#[test]
fn what_is_implied_takes_no_bits() {
    // A strip of two quads: the second diagonal may be nowhere else once the first quad is known.
    let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    let mut sides = FaceSides::new(&faces, 6);
    let (mut port, mut model) = (RansEncoder::new(1), DiagonalModel::new());
    let first = 2; // From 2 to 0, and so from 0 to 2 of the next face.
    assert!(sides.said(first) == EdgeKind::Open && sides.may_be_diagonal(first));
    let is_diagonal = model.code(&mut port, &sides, first, true);
    sides.say(first, is_diagonal);
    assert_eq!(sides.said(3), EdgeKind::Diagonal);
    assert!(!sides.has_centre(0));
    // A third face says where they meet, for all three.
    sides.say(5, true);
    assert!([0, 3, 6].into_iter().all(|side| sides.has_centre(side)));
    assert_eq!(sides.said(1), EdgeKind::Closed);
}

#[test]
fn polygons_that_are_not_all_faces_are_refused() {
    let mesh = Mesh::new(vec![[0.0; 3]; 4], vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    for starts in [&[][..], &[0], &[0, 1], &[1, 2], &[0, 2, 1, 2], &[0, 3]] {
        let error = MeshCode::of_polygons(&mesh, starts, &CodeOptions::default()).unwrap_err();
        assert_eq!(error, CodeError::PolygonStarts);
    }
    // Without faces, and faces that are not a fan.
    let code = |mesh: &Mesh, starts: &[u32]| {
        MeshCode::of_polygons(mesh, starts, &CodeOptions::default()).unwrap()
    };
    assert_eq!(code(&mesh, &[0, 0, 2, 2]).polygons().kept, 1);
    let turned = Mesh::new(vec![[0.0; 3]; 4], vec![[0, 1, 2], [2, 3, 0]]).unwrap();
    let PolygonCounts { kept, cut } = code(&turned, &[0, 2]).polygons();
    assert_eq!([kept, cut], [0, 1]);
}
