//! The library's own code of faces.

use meshweft::Faces;
use meshweft::connectivity::FanCode;

use super::{Codec, Encoded, Input, Output, Positions, counts};

/// [`FanCode`] from vertex 0 on, and no positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fans;

impl Codec for Fans {
    fn name(&self) -> String {
        "**fans, faces only**".to_owned()
    }

    fn encode(&self, input: &Input) -> Result<Encoded, String> {
        let vertex_count = input.positions.len();
        let faces = Faces::new(&input.faces, vertex_count).map_err(|error| error.to_string())?;
        let code = FanCode::new(faces, 0);
        let mut bytes = counts::written([vertex_count, faces.len()])?;
        bytes.extend(code.bytes());
        Ok(Encoded {
            bytes,
            connectivity_size: Some(code.bytes().len()),
            new_to_old: Some(code.vertices().new_to_old().to_vec()),
        })
    }

    fn decode(&self, bytes: &[u8]) -> Result<Output, String> {
        let ([vertex_count, face_count], code) = counts::read(bytes)?;
        let faces = FanCode::decode(code, face_count, vertex_count);
        Ok(Output {
            positions: Positions::None(vertex_count),
            faces: faces.map_err(|error| error.to_string())?,
        })
    }

    fn is_ours(&self) -> bool {
        true
    }
}
