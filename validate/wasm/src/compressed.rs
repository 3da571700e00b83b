//! Meshes compressed and decoded again.
//!
//! A case comes as bytes, all numbers of 32 bits with the low byte first: the number of vertices, the number of faces,
//! the tier, the bits of positions (0: lossless), the first vertex; then the positions and the faces, three numbers each.

use meshweft::compression::{CodeOptions, MeshCode, PositionCoding, Tier};
use meshweft::geometry::Lattice;
use meshweft::{Limits, Mesh};

/// Numbers before the positions.
const HEAD: usize = 5;

/// How a case ended: what an answer begins with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum End {
    /// Parts follow, each with its length before it: the code, the orders of vertices and faces, the turns of faces, and
    /// the positions and faces of the mesh that was decoded from the code.
    Decoded = 0,
    /// The text of an error follows.
    Refused = 1,
}

/// How many bytes a case has that begins with these, or `None` if that cannot be said yet.
#[must_use]
pub fn case_length(bytes: &[u8]) -> Option<usize> {
    let (numbers, _) = bytes.as_chunks();
    let &[vertices, faces] = numbers.first_chunk()?;
    let [vertices, faces] = [vertices, faces].map(|bytes| u32::from_le_bytes(bytes) as usize);
    Some(4 * (HEAD + 3 * (vertices + faces)))
}

/// The answer to a case: its end as a number of 32 bits, and what belongs to it.
#[must_use]
pub fn answer(case: &[u8]) -> Vec<u8> {
    let (end, rest) = match decoded(case) {
        Ok(parts) => {
            let with_length = |part: Vec<u8>| {
                let length = u32::try_from(part.len()).expect("parts of a small mesh");
                [&length.to_le_bytes()[..], &part].concat()
            };
            (End::Decoded, parts.map(with_length).concat())
        }
        Err(error) => (End::Refused, error.into_bytes()),
    };
    [&(end as u32).to_le_bytes()[..], &rest].concat()
}

fn decoded(case: &[u8]) -> Result<[Vec<u8>; 6], String> {
    // What is asked for.
    let (numbers, _) = case.as_chunks();
    let numbers: Vec<u32> = numbers
        .iter()
        .map(|&bytes| u32::from_le_bytes(bytes))
        .collect();
    let Some(&[vertex_count, _, tier, bits, first_vertex]) = numbers.first_chunk::<HEAD>() else {
        return Err("the case is cut".to_owned());
    };
    let (triples, _) = numbers[HEAD..].as_chunks();
    let (positions, faces) = triples.split_at(vertex_count as usize);
    let positions: Vec<_> = positions
        .iter()
        .map(|position| position.map(f32::from_bits))
        .collect();
    let positions_coding = match bits {
        0 => PositionCoding::Lossless,
        bits => PositionCoding::OnLattice(
            Lattice::of_bits(positions.iter().copied(), bits).ok_or("no such lattice")?,
        ),
    };
    let options = CodeOptions {
        tier: *Tier::ALL.get(tier as usize).ok_or("no such tier")?,
        positions: positions_coding,
        first_vertex,
        ..CodeOptions::default()
    };

    // The code, and what it is decoded as.
    let mesh = Mesh::new(positions, faces.to_vec()).map_err(|error| error.to_string())?;
    let code = MeshCode::new(&mesh, &options).map_err(|error| error.to_string())?;
    let decoded = MeshCode::decode(code.bytes(), Limits::default());
    let decoded = decoded.map_err(|error| error.to_string())?;
    let bytes = |numbers: &[u32]| numbers.iter().flat_map(|it| it.to_le_bytes()).collect();
    let positions = decoded.positions().as_flattened().iter();
    let positions: Vec<_> = positions.map(|coordinate| coordinate.to_bits()).collect();
    Ok([
        code.bytes().to_vec(),
        bytes(code.vertices().new_to_old()),
        bytes(code.faces().new_to_old()),
        code.faces().rotations().to_vec(),
        bytes(&positions),
        bytes(decoded.faces().as_flattened()),
    ])
}
