//! meshoptimizer's codecs of index and vertex buffers, and zstd on top.

use std::borrow::Cow;

use meshopt::ffi;
use meshweft::Mesh;
use meshweft::order::vertex_fetch;

use super::{Codec, Encoded, Input, Output, Positions, counts};
use crate::rivals::Meshopt;

/// Its codecs keep the order of faces, and code some orders in fewer bytes than others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceOrdering {
    /// By its main optimizer.
    Cache,
    /// By the one that favours strips.
    Strip,
}

/// Index codec, version 1, and vertex codec, version 1 at its highest level, on 8 bytes a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Meshoptimizer {
    ordering: FaceOrdering,
    zstd_level: Option<i32>,
}

impl Meshoptimizer {
    /// With both streams compressed by zstd, if a level of it is given.
    #[must_use]
    pub fn new(ordering: FaceOrdering, zstd_level: Option<i32>) -> Self {
        Self {
            ordering,
            zstd_level,
        }
    }

    /// A stream as it is stored.
    fn packed(&self, stream: Vec<u8>) -> Result<Vec<u8>, String> {
        match self.zstd_level {
            Some(level) => zstd::bulk::compress(&stream, level).map_err(|error| error.to_string()),
            None => Ok(stream),
        }
    }

    /// A stream of a known size as it was before.
    fn unpacked<'a>(&self, stored: &'a [u8], size: usize) -> Result<Cow<'a, [u8]>, String> {
        match self.zstd_level {
            Some(_) => zstd::bulk::decompress(stored, size)
                .map(Cow::Owned)
                .map_err(|error| error.to_string()),
            None => Ok(Cow::Borrowed(stored)),
        }
    }
}

impl Codec for Meshoptimizer {
    fn name(&self) -> String {
        let order = match self.ordering {
            FaceOrdering::Cache => "",
            FaceOrdering::Strip => ", strips",
        };
        let zstd = self.zstd_level.map(|level| format!(" + zstd {level}"));
        format!("meshoptimizer{order}{}", zstd.unwrap_or_default())
    }

    fn prepared<'a>(&self, input: &'a Input) -> Cow<'a, Input> {
        let count = input.positions.len();
        let mesh = |faces| Mesh::connectivity_only(count, faces).expect("the indices of a mesh");
        let ordering = match self.ordering {
            FaceOrdering::Cache => Meshopt::VertexCache,
            FaceOrdering::Strip => Meshopt::Strip,
        };
        let mesh = mesh(ordering.ordered(&mesh(input.faces.clone())));
        let by_use = vertex_fetch(&mesh);
        Cow::Owned(Input {
            positions: by_use.permutation().apply(&input.positions),
            faces: by_use.renumber(mesh.faces()),
        })
    }

    fn encode(&self, input: &Input) -> Result<Encoded, String> {
        let indices = encoded_indices(&input.faces, input.positions.len());
        let records: Vec<[u16; 4]> = input
            .positions
            .iter()
            .map(record)
            .collect::<Result<_, _>>()?;
        let records = encoded_records(&records);

        let sizes = [indices.len(), records.len()];
        let indices = self.packed(indices)?;
        let records = self.packed(records)?;
        let mut bytes = counts::written([
            input.positions.len(),
            input.faces.len(),
            sizes[0],
            sizes[1],
            indices.len(),
        ])?;
        bytes.extend(&indices);
        bytes.extend(&records);
        Ok(Encoded {
            bytes,
            connectivity_size: Some(indices.len()),
            new_to_old: None,
        })
    }

    fn decode(&self, bytes: &[u8]) -> Result<Output, String> {
        let (sizes, streams) = counts::read(bytes)?;
        let [
            vertex_count,
            face_count,
            index_size,
            record_size,
            stored_size,
        ] = sizes;
        let streams = streams.split_at_checked(stored_size);
        let (indices, records) = streams.ok_or("the bytes end early")?;
        let indices = self.unpacked(indices, index_size)?;
        let records = self.unpacked(records, record_size)?;
        Ok(Output {
            positions: Positions::Padded(decoded_records(&records, vertex_count)?),
            faces: decoded_indices(&indices, face_count)?,
        })
    }
}

/// A position as a record of a vertex buffer.
fn record(position: &[i32; 3]) -> Result<[u16; 4], String> {
    let mut record = [0; 4];
    for (place, &value) in record.iter_mut().zip(position) {
        *place = u16::try_from(value).map_err(|_| "a position over 16 bits")?;
    }
    Ok(record)
}

fn encoded_indices(faces: &[[u32; 3]], vertex_count: usize) -> Vec<u8> {
    let index_count = 3 * faces.len();
    // SAFETY: the buffer has the size that the library asks for; the pointer is to as many indices as it says.
    unsafe {
        let mut bytes = vec![0; ffi::meshopt_encodeIndexBufferBound(index_count, vertex_count)];
        let (to, from) = (bytes.as_mut_ptr(), faces.as_ptr().cast());
        let size = ffi::meshopt_encodeIndexBuffer(to, bytes.len(), from, index_count);
        bytes.truncate(size);
        bytes
    }
}

fn decoded_indices(bytes: &[u8], face_count: usize) -> Result<Vec<[u32; 3]>, String> {
    let mut faces = vec![[0_u32; 3]; face_count];
    // SAFETY: there is room for as many indices of 4 bytes as it says; the decoder is made for any bytes.
    let code = unsafe {
        ffi::meshopt_decodeIndexBuffer(
            faces.as_mut_ptr().cast(),
            3 * face_count,
            size_of::<u32>(),
            bytes.as_ptr(),
            bytes.len(),
        )
    };
    match code {
        0 => Ok(faces),
        _ => Err(format!("meshoptimizer: index buffer, error {code}")),
    }
}

fn encoded_records(records: &[[u16; 4]]) -> Vec<u8> {
    /// The slowest, with the fewest bytes.
    const LEVEL: i32 = 3;
    const VERSION: i32 = 1;
    let size = size_of::<[u16; 4]>();
    // SAFETY: the buffer has the size that the library asks for; the pointer is to as many records of 8 bytes as
    // it says.
    unsafe {
        let mut bytes = vec![0; ffi::meshopt_encodeVertexBufferBound(records.len(), size)];
        let (to, from) = (bytes.as_mut_ptr(), records.as_ptr().cast());
        let (room, count) = (bytes.len(), records.len());
        let size =
            ffi::meshopt_encodeVertexBufferLevel(to, room, from, count, size, LEVEL, VERSION);
        bytes.truncate(size);
        bytes
    }
}

fn decoded_records(bytes: &[u8], vertex_count: usize) -> Result<Vec<[u16; 4]>, String> {
    let mut records = vec![[0_u16; 4]; vertex_count];
    // SAFETY: there is room for as many records of 8 bytes as it says; the decoder is made for any bytes.
    let code = unsafe {
        ffi::meshopt_decodeVertexBuffer(
            records.as_mut_ptr().cast(),
            vertex_count,
            size_of::<[u16; 4]>(),
            bytes.as_ptr(),
            bytes.len(),
        )
    };
    match code {
        0 => Ok(records),
        _ => Err(format!("meshoptimizer: vertex buffer, error {code}")),
    }
}
