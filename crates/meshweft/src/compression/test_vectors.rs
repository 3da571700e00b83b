//! The streams that the book prints.

use super::{CodeOptions, MeshArchive, MeshCode, PositionCoding, Tier};
use crate::geometry::Lattice;
use crate::limits::Limits;
use crate::mesh::Mesh;

/// By tier, lossless and on a lattice.
const PRINTED: [[&str; 2]; 2] = [
    [
        "00 01 04 02 00 31 00 3b 00 18 06 af 00 8e fb 02 00 df fb 88 02 bc 79 38 e4 ac 4c 2a 00 2c 87 00 00 00 00 00 00 00 00 00 00 00 01 00 00 3f 01 00 00 3f 01 00 00 3d 00",
        "00 00 04 02 00 00 00 00 00 00 d0 3f 00 00 00 00 15 00 3b 00 18 06 5d 42 3c 83 a3 42 2c 07 42 0e ef 00 38 e4 49 00",
    ],
    [
        "01 01 04 02 00 2f 00 59 29 01 80 af 00 8e fb 02 00 df fb 88 02 bc 79 ac 4c 2a 00 2c 87 00 00 00 00 00 00 00 00 00 00 00 01 00 00 3f 01 00 00 3f 01 00 00 3d 00",
        "01 00 04 02 00 00 00 00 00 00 d0 3f 00 00 00 00 13 00 59 29 01 80 5d 42 3c 83 a3 42 2c 07 42 0e ef 00 49 00",
    ],
];

#[test]
fn the_streams_of_the_book_are_what_is_written() {
    let positions = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 0.25],
    ];
    let mesh = Mesh::new(positions, vec![[0, 1, 2], [2, 1, 3]]).unwrap();
    let lattice = Lattice::new(0.25).unwrap();
    for (&tier, printed) in Tier::ALL.iter().zip(PRINTED) {
        for (positions, printed) in [PositionCoding::Lossless, PositionCoding::OnLattice(lattice)]
            .into_iter()
            .zip(printed)
        {
            let options = CodeOptions {
                tier,
                positions,
                ..Default::default()
            };
            let code = MeshCode::new(&mesh, &options).unwrap();
            assert_eq!(hex(code.bytes()), printed, "{tier:?}");
            let decoded = MeshCode::decode(code.bytes(), Limits::default()).unwrap();
            assert_eq!(decoded.positions(), mesh.positions());
            assert_eq!(decoded.faces(), [[0, 1, 2], [1, 3, 2]]);
        }
    }

    let lattice = PositionCoding::OnLattice(lattice);
    let options = CodeOptions {
        tier: Tier::Fast,
        positions: lattice,
        ..Default::default()
    };
    let mut archive = MeshArchive::default();
    archive.push("a", &MeshCode::new(&mesh, &options).unwrap());
    let code = PRINTED[0][1];
    let printed = format!("4d 57 5a 1a 01 01 01 26 61 {code} 31 da 60 79");
    assert_eq!(hex(&archive.to_bytes()), printed);
}

fn hex(bytes: &[u8]) -> String {
    let hex: Vec<_> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    hex.join(" ")
}
