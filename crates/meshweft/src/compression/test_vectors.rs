//! The streams that the book prints.

use super::{CodeOptions, MeshArchive, MeshCode, PositionCoding, Tier};
use crate::geometry::Lattice;
use crate::limits::Limits;
use crate::mesh::Mesh;

/// By tier, lossless and on a lattice.
const PRINTED: [[&str; 2]; 2] = [
    [
        "00 01 04 02 00 2f 00 3b 00 18 06 df 05 91 ff 02 00 df fb 88 02 bc 79 2c 87 14 db ff 7f ff ff ff ff ff ff ff 7f b0 fd 00 80 aa 80 00 80 08 82 e0 e3 00 7a 00 00",
        "00 00 04 02 00 00 00 00 00 00 d0 3f 00 00 00 00 15 00 3b 00 18 06 25 00 7e 85 bb 42 fe 84 55 0e b5 00 c0 09 e0 e3",
    ],
    [
        "01 01 04 02 00 2d 00 59 29 01 80 df 05 91 ff 02 00 df fb 88 02 bc 79 2c 87 14 db ff 7f ff ff ff ff ff ff ff 7f b0 fd 00 80 aa 80 00 80 08 82 00 7a 00 00",
        "01 00 04 02 00 00 00 00 00 00 d0 3f 00 00 00 00 13 00 59 29 01 80 25 00 7e 85 bb 42 fe 84 55 0e b5 00 c0 09",
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
    let printed = format!("4d 57 5a 1a 01 01 01 26 61 {code} 8c f2 37 c6");
    assert_eq!(hex(&archive.to_bytes()), printed);
}

fn hex(bytes: &[u8]) -> String {
    let hex: Vec<_> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    hex.join(" ")
}
