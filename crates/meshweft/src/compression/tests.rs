//! Laws for any mesh, and hostile bytes.

use super::{CodeError, CodeOptions, KeepOrder, MeshCode, MeshDecoder, PositionCoding, Tier};
use crate::bits::DecodeErrorKind;
use crate::connectivity::MinimumTimeRendering;
use crate::connectivity::soups::soup;
use crate::geometry::Lattice;
use crate::index::index32;
use crate::limits::Limits;
use crate::mesh::Mesh;
use crate::random::{SplitMix64, from_environment};

/// A mesh of any faces, with positions that any bits may be.
pub(super) fn any_mesh(random: &mut SplitMix64) -> Mesh {
    let (faces, vertex_count) = soup(random);
    let is_wild = random.below(4) == 0;
    let mut coordinate = || match is_wild {
        true => {
            let [a, b, c, d, ..] = random.next().to_le_bytes();
            f32::from_le_bytes([a, b, c, d])
        }
        false => index32(random.below(2000)) as f32 / 64.0 - 10.0,
    };
    let positions: Vec<_> = (0..vertex_count)
        .map(|_| [(); 3].map(|()| coordinate()))
        .collect();
    Mesh::new(positions, faces).unwrap()
}

pub(super) fn ways(mesh: &Mesh) -> [PositionCoding; 3] {
    let of_bits = Lattice::of_bits(mesh.positions().to_vec(), 14).unwrap();
    [
        PositionCoding::Lossless,
        PositionCoding::OnLattice(of_bits),
        PositionCoding::OnLattice(Lattice::new(0.25).unwrap()),
    ]
}

/// The bits of a mesh: as a number, a NaN would differ from itself.
fn bits(mesh: &Mesh) -> (Vec<[u32; 3]>, &[[u32; 3]]) {
    let positions = mesh.positions().iter();
    let positions = positions.map(|position| position.map(f32::to_bits));
    (positions.collect(), mesh.faces())
}

/// What a stream should be: the mesh in the order of the code, its positions on the lattice.
fn expected(mesh: &Mesh, code: &MeshCode, positions: PositionCoding) -> Mesh {
    let ordered = mesh
        .with_face_order(code.faces())
        .with_vertex_order(code.vertices());
    let PositionCoding::OnLattice(lattice) = positions else {
        return ordered;
    };
    let on_lattice = |coordinate| lattice.coordinate(lattice.multiple(coordinate).unwrap());
    let rounded = ordered.positions().iter();
    let rounded: Vec<_> = rounded.map(|position| position.map(on_lattice)).collect();
    Mesh::new(rounded, ordered.faces().to_vec()).unwrap()
}

#[test]
fn any_mesh_comes_back_and_has_the_same_code_then() {
    let cases = from_environment("MESHWEFT_CASES", 2000);
    let seed = from_environment("MESHWEFT_SEED", 3);
    let mut random = SplitMix64(seed);
    let mut streams = 0_u64;
    for _ in 0..cases {
        let mesh = any_mesh(&mut random);
        let first_vertex = index32(random.below(mesh.vertex_count()));
        for &tier in Tier::ALL {
            for positions in ways(&mesh) {
                let options = CodeOptions {
                    tier,
                    positions,
                    first_vertex,
                    ..Default::default()
                };
                streams += u64::from(comes_back(&mesh, &options));
            }
        }
    }
    println!("{streams} streams of {cases} meshes from seed {seed} came back");
    // Few have positions that cannot be on a lattice.
    assert!(2 * streams > 3 * cases);
}

/// Compresses and decodes a mesh, and its decoded one once more. Returns whether it can be compressed so.
fn comes_back(mesh: &Mesh, options: &CodeOptions) -> bool {
    let code = match MeshCode::new(mesh, options) {
        Ok(code) => code,
        Err(CodeError::NotOnLattice { vertex, .. }) => {
            let is_small = |it: &f32| it.is_finite() && it.abs() < 1e9;
            assert!(!mesh.positions()[vertex].iter().all(is_small));
            return false;
        }
        Err(CodeError::StepTooSmall { .. }) => {
            let far = mesh.positions().as_flattened().iter();
            assert!(far.copied().any(|coordinate| coordinate.abs() > 1e8));
            return false;
        }
        Err(error) => panic!("{error}"),
    };
    let decoded = MeshCode::decode(code.bytes(), Limits::default()).unwrap();
    let expected = expected(mesh, &code, options.positions);
    assert_eq!(bits(&decoded), bits(&expected));
    let sizes = code.sizes();
    assert!(sizes.connectivity >= 0.0 && sizes.positions >= 0.0 && sizes.rest > 0.0);

    // From its first vertex it is the same again.
    let again = CodeOptions {
        first_vertex: 0,
        ..*options
    };
    let again = MeshCode::new(&decoded, &again).unwrap();
    assert_eq!(again.bytes(), code.bytes());
    true
}

pub(super) const KEPT: [KeepOrder; 4] = [
    KeepOrder::Nothing,
    KeepOrder::Faces,
    KeepOrder::Vertices,
    KeepOrder::Both,
];

#[test]
fn the_order_of_the_source_comes_back_as_far_as_it_is_kept() {
    let mut random = SplitMix64(6);
    for case in 0..1500 {
        // Once more than a block.
        let mesh = if case == 0 {
            hills(80)
        } else {
            any_mesh(&mut random)
        };
        let plain = MeshCode::new(&mesh, &CodeOptions::default()).unwrap();
        for keep_order in KEPT {
            let options = CodeOptions {
                keep_order,
                ..Default::default()
            };
            let code = MeshCode::new(&mesh, &options).unwrap();
            let [keeps_faces, keeps_vertices] = keep_order.parts();
            let mut expected = mesh.clone();
            if !keeps_faces {
                expected = expected.with_face_order(code.faces());
            }
            if !keeps_vertices {
                expected = expected.with_vertex_order(code.vertices());
            }
            let decoded = MeshCode::decode(code.bytes(), Limits::default()).unwrap();
            assert_eq!(bits(&decoded), bits(&expected), "{keep_order:?}");

            // The order follows what is there without it.
            let begin = plain.bytes().len();
            assert_eq!(code.bytes()[2..begin], plain.bytes()[2..]);
            let order = (code.bytes().len() - begin) as f64;
            assert_eq!(code.sizes().order.to_bits(), order.to_bits());
            let stored = MeshCode::decode_stored(code.bytes(), Limits::default()).unwrap();
            let without = MeshCode::decode(plain.bytes(), Limits::default()).unwrap();
            assert_eq!(bits(&stored.mesh), bits(&without));
        }
    }
}

#[test]
fn an_order_that_names_a_place_twice_is_an_error() {
    let mesh = hills(4);
    let code = |keep_order, mesh: &Mesh| {
        let options = CodeOptions {
            keep_order,
            ..Default::default()
        };
        MeshCode::new(mesh, &options).unwrap().bytes().to_vec()
    };
    let whole = code(KeepOrder::Both, &mesh);
    let begin = code(KeepOrder::Nothing, &mesh).len();
    let mut random = SplitMix64(7);
    for _ in 0..20_000 {
        let mut damaged = whole.clone();
        let place = begin + random.below(whole.len() - begin);
        damaged[place] ^= 1 << random.below(8);
        // What is read to the end by luck is an order.
        if let Ok(decoded) = MeshCode::decode(&damaged, Limits::default()) {
            assert_eq!(decoded.face_count(), mesh.face_count());
            let [mut found, mut expected] = [decoded, mesh.clone()].map(|it| bits(&it).0);
            found.sort_unstable();
            expected.sort_unstable();
            assert_eq!(found, expected);
        }
    }
}

#[test]
fn an_order_that_is_near_the_stored_one_takes_few_bytes() {
    let mesh = hills(60);
    let stored = |code: &MeshCode| MeshCode::decode(code.bytes(), Limits::default()).unwrap();
    let mesh = stored(&MeshCode::new(&mesh, &CodeOptions::default()).unwrap());
    let options = CodeOptions {
        keep_order: KeepOrder::Both,
        ..Default::default()
    };
    let size = MeshCode::new(&mesh, &options).unwrap().sizes().order;
    assert!(size < 100.0, "{size}");
}

#[test]
fn bytes_may_arrive_in_any_pieces() {
    let mut random = SplitMix64(4);
    for case in 0..300 {
        let mesh = any_mesh(&mut random);
        let options = CodeOptions {
            keep_order: KEPT[case % 4],
            ..Default::default()
        };
        let code = MeshCode::new(&mesh, &options).unwrap();
        let whole = MeshCode::decode(code.bytes(), Limits::default()).unwrap();
        let mut bytes = code.bytes().to_vec();
        bytes.extend([9, 9, 9]);

        let mut decoder = MeshDecoder::new(Limits::default());
        let (mut positions, mut faces) = (Vec::new(), Vec::new());
        let mut at = 0;
        while !decoder.is_complete() {
            assert!(decoder.finish().is_err());
            let end = bytes.len().min(at + 1 + random.below(9));
            at += decoder.push(&bytes[at..end]).unwrap();
            positions.extend(decoder.take_positions());
            faces.extend(decoder.take_faces());
            let is_there = |&vertex: &u32| (vertex as usize) < positions.len();
            assert!(faces.as_flattened().iter().all(is_there));
        }
        assert_eq!(at, code.bytes().len());
        assert_eq!(
            decoder.counts(),
            Some([mesh.vertex_count(), mesh.face_count()])
        );
        let order = decoder.take_source_order().unwrap();
        let mesh = order.restore(Mesh::new(positions, faces).unwrap());
        assert_eq!(bits(&mesh), bits(&whole));
    }
}

/// A grid of hills, wide enough for several blocks.
fn hills(width: u32) -> Mesh {
    let height = |x: u32, y: u32| ((x * x + 3 * y) % 17) as f32 / 8.0;
    let positions = (0..width * width).map(|i| {
        let (x, y) = (i % width, i / width);
        [x as f32, y as f32, height(x, y)]
    });
    let mut faces = Vec::new();
    for y in 0..width - 1 {
        for x in 0..width - 1 {
            let a = y * width + x;
            faces.extend([[a, a + 1, a + width + 1], [a, a + width + 1, a + width]]);
        }
    }
    Mesh::new(positions.collect::<Vec<_>>(), faces).unwrap()
}

#[test]
fn a_decoder_keeps_little_beyond_what_was_not_taken() {
    let mesh = hills(300);
    let lattice = Lattice::new(0.125).unwrap();
    let options = CodeOptions {
        positions: PositionCoding::OnLattice(lattice),
        ..Default::default()
    };
    let code = MeshCode::new(&mesh, &options).unwrap();
    let decoded = MeshCode::decode(code.bytes(), Limits::default()).unwrap();
    assert_eq!(
        bits(&decoded),
        bits(&expected(&mesh, &code, options.positions))
    );

    // Parts of the faces are there long before the end.
    let mut decoder = MeshDecoder::new(Limits::default());
    let half = code.bytes().len() / 2;
    decoder.push(&code.bytes()[..half]).unwrap();
    let early = decoder.take_faces();
    assert!(early.len() > mesh.face_count() / 3, "{}", early.len());
    assert_eq!(early, decoded.faces()[..early.len()]);

    let buffer = MinimumTimeRendering::new(&decoded).buffer_size();
    assert!(buffer > 100, "{buffer}");
}

#[test]
fn what_cannot_be_compressed_is_said() {
    let faces = vec![[0, 1, 2]];
    let no_positions = Mesh::connectivity_only(3, faces.clone()).unwrap();
    let code = |mesh: &Mesh, options: CodeOptions| MeshCode::new(mesh, &options).unwrap_err();
    let lossless = CodeOptions::default();
    assert_eq!(code(&no_positions, lossless), CodeError::NoPositions);

    let mesh = Mesh::new(vec![[0.0; 3], [1e20; 3], [f32::NAN; 3]], faces).unwrap();
    let fine = CodeOptions {
        positions: PositionCoding::OnLattice(Lattice::new(1.0).unwrap()),
        ..lossless
    };
    let error = code(&mesh, fine).to_string();
    assert!(
        error.starts_with("vertex 1 has the coordinate 1"),
        "{error}"
    );
    let beyond = CodeOptions {
        first_vertex: 3,
        ..lossless
    };
    let error = code(&mesh, beyond).to_string();
    assert!(error.contains("first vertex is 3"), "{error}");
}

#[test]
fn limits_hold_before_anything_is_decoded() {
    let mesh = hills(20);
    let code = MeshCode::new(&mesh, &CodeOptions::default()).unwrap();
    let limits = Limits {
        faces: 100,
        ..Limits::default()
    };
    let error = MeshCode::decode(code.bytes(), limits).unwrap_err();
    let (what, said, limit) = ("faces", 722, 100);
    assert_eq!(
        error.kind,
        DecodeErrorKind::AboveLimit { what, said, limit }
    );
}
