//! Every codec gives back the mesh that it was given, and an error for what it did not write.

use compare::codecs::{self, Codec, Input};
use compare::irregular_grid;
use meshweft::Mesh;

/// A grid of so many quads a side, over which the third coordinate waves.
fn waves(side: u32) -> Mesh {
    let grid = irregular_grid(side);
    let position = |vertex: usize| {
        let (x, y) = (vertex % 37, vertex / 37);
        [
            x as f32,
            y as f32,
            (x as f32 * 0.2).sin() + (y as f32 * 0.1).cos(),
        ]
    };
    let positions: Vec<[f32; 3]> = (0..grid.vertex_count()).map(position).collect();
    Mesh::new(positions, grid.faces().to_vec()).expect("positions of a grid")
}

fn each_codec(check: impl Fn(&str, &dyn Codec)) {
    for codec in codecs::all() {
        check(&codec.name(), codec.as_ref());
    }
}

#[test]
fn what_is_decoded_is_what_was_encoded() {
    let input = Input::new(&waves(40)).expect("a grid is a mesh");
    each_codec(|name, codec| {
        let input = codec.prepared(&input);
        let encoded = codec
            .encode(&input)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let output = codec.decode(&encoded.bytes);
        let output = output.unwrap_or_else(|error| panic!("{name}: {error}"));
        let difference = output.difference(&input, encoded.new_to_old.as_deref());
        let difference = difference.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(
            matches!(difference, None | Some([0, 0])),
            "{name}: {difference:?}"
        );
        assert_eq!(output.faces.len(), input.faces.len(), "{name}");
        let connectivity = encoded.connectivity_size.expect("all count it");
        assert!((1..encoded.bytes.len()).contains(&connectivity), "{name}");
    });
}

#[test]
fn a_difference_is_counted() {
    let input = Input::new(&waves(8)).expect("a grid is a mesh");
    let draco = codecs::draco::Draco::new(7);
    let encoded = draco.encode(&input).expect("a grid is coded");
    let mut output = draco.decode(&encoded.bytes).expect("a grid is decoded");
    let [a, b, c] = output.faces[5];
    output.faces[5] = [b, c, a];
    assert_eq!(output.difference(&input, None), Ok(Some([0, 0])));
    output.faces[5] = [b, a, c];
    assert_eq!(output.difference(&input, None), Ok(Some([1, 1])));
    output.faces.pop();
    assert_eq!(output.difference(&input, None), Ok(Some([2, 1])));
    output.faces[0][0] = 81;
    assert!(output.difference(&input, None).is_err());
}

#[test]
fn bytes_of_nobody_are_an_error() {
    each_codec(|name, codec| {
        for bytes in [&b""[..], b"neither of these is a mesh, whatever reads it"] {
            assert!(codec.decode(bytes).is_err(), "{name}");
        }
    });
}

#[test]
fn unused_vertices_are_dropped_and_positions_fill_the_cube() {
    let positions = vec![
        [-1.0, 0.0, 5.0],
        [9.0, 9.0, 9.0],
        [1.0, 0.5, 5.0],
        [0.0, 1.0, 5.0],
    ];
    let mesh = Mesh::new(positions, vec![[0, 2, 3]]).expect("a face");
    let input = Input::new(&mesh).expect("a face is a mesh");
    assert_eq!(input.faces, [[0, 1, 2]]);
    assert_eq!(
        input.positions,
        [[0, 0, 0], [16383, 4096, 0], [8192, 8192, 0]]
    );
}
