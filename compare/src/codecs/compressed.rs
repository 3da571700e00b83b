//! The library's compressed meshes.

use meshweft::compression::{CodeOptions, MeshCode, MeshDecoder, PositionCoding, Tier};
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
        let mut decoder = MeshDecoder::new(Limits::default());
        let read = decoder.push(bytes).and_then(|_| decoder.finish());
        read.map_err(|error| error.to_string())?;
        Ok(Output {
            positions: Positions::Floats(decoder.take_positions()),
            faces: decoder.take_faces(),
        })
    }

    fn is_ours(&self) -> bool {
        true
    }
}
