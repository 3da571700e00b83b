//! The library's compressed meshes.

use meshweft::compression::{CodeOptions, MeshCode, PositionCoding, Tier};
use meshweft::geometry::Lattice;
use meshweft::{Limits, Mesh};

use super::{Codec, Encoded, Input, Output, Positions};

/// [`MeshCode`] from vertex 0 on, its positions on the lattice of the input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Compressed(pub Tier);

impl Codec for Compressed {
    fn name(&self) -> String {
        format!("**meshweft {:?}**", self.0).to_lowercase()
    }

    fn encode(&self, input: &Input) -> Result<Encoded, String> {
        let positions = input.positions.iter();
        let positions: Vec<_> = positions
            .map(|position| position.map(|number| number as f32))
            .collect();
        let text = |error: &dyn std::fmt::Display| error.to_string();
        let mesh = Mesh::new(positions, &input.faces[..]).map_err(|error| text(&error))?;
        let lattice = Lattice::new(1.0).ok_or("no lattice")?;
        let options = CodeOptions {
            tier: self.0,
            positions: PositionCoding::OnLattice(lattice),
            ..CodeOptions::default()
        };
        let code = MeshCode::new(&mesh, &options).map_err(|error| text(&error))?;
        #[expect(clippy::cast_possible_truncation, reason = "a number of bytes")]
        let connectivity = code.sizes().connectivity.ceil() as usize;
        Ok(Encoded {
            connectivity_size: Some(connectivity),
            new_to_old: None,
            bytes: code.bytes().to_vec(),
        })
    }

    fn decode(&self, bytes: &[u8]) -> Result<Output, String> {
        let mesh = MeshCode::decode(bytes, Limits::default()).map_err(|error| error.to_string())?;
        let positions = mesh.positions().iter();
        #[expect(clippy::cast_possible_truncation, reason = "integers of 14 bits")]
        let positions = positions.map(|position| position.map(|number| number as i32));
        Ok(Output {
            positions: Positions::Triples(positions.collect()),
            faces: mesh.faces().to_vec(),
        })
    }

    fn is_ours(&self) -> bool {
        true
    }
}
