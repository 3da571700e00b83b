//! Several compressed meshes with their names: what a `.mwz` file holds.

use super::decoded_mesh::DecodedMesh;
use super::mesh_code::MeshCode;
use crate::bits::{DecodeError, DecodeErrorKind, crc32, varint};
use crate::limits::Limits;
use crate::mesh::Mesh;

/// What an archive begins with.
const MAGIC: [u8; 4] = *b"MWZ\x1a";
/// The format that is written; the only one that is read.
const VERSION: u8 = 1;

/// Compressed meshes with their names.
///
/// ```
/// use meshweft::compression::{CodeOptions, MeshArchive, MeshCode};
/// use meshweft::{Limits, Mesh};
///
/// let mesh = Mesh::new(vec![[0.0; 3], [1.0; 3], [2.0; 3]], vec![[0, 1, 2]])?;
/// let mut archive = MeshArchive::default();
/// archive.push("triangle", &MeshCode::new(&mesh, &CodeOptions::default())?);
/// let read = MeshArchive::from_bytes(&archive.to_bytes())?;
/// assert_eq!(read.name(0), "triangle");
/// assert_eq!(read.decode(0, Limits::default())?, mesh);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MeshArchive {
    meshes: Vec<NamedCode>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct NamedCode {
    name: String,
    code: Vec<u8>,
    /// Where the code begins in what was read.
    byte: usize,
}

impl MeshArchive {
    /// Adds a mesh. Names may be empty and need not differ.
    pub fn push(&mut self, name: &str, code: &MeshCode) {
        self.meshes.push(NamedCode {
            name: name.to_owned(),
            code: code.bytes().to_vec(),
            byte: 0,
        });
    }

    /// How many meshes there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.meshes.len()
    }

    /// Whether there is no mesh.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.meshes.is_empty()
    }

    /// The name of a mesh.
    ///
    /// # Panics
    /// If there is no such mesh.
    #[must_use]
    pub fn name(&self, mesh: usize) -> &str {
        &self.meshes[mesh].name
    }

    /// The mesh, in the order of the source as far as that is stored.
    ///
    /// # Errors
    /// As [`MeshCode::decode`].
    ///
    /// # Panics
    /// If there is no such mesh.
    pub fn decode(&self, mesh: usize, limits: Limits) -> Result<Mesh, DecodeError> {
        self.decoded(mesh, limits, MeshCode::decode)
    }

    /// The mesh in the order of the stream, and what of its polygons and of the order of the source is stored.
    ///
    /// # Errors
    /// As [`MeshCode::decode`].
    ///
    /// # Panics
    /// If there is no such mesh.
    pub fn decode_stored(&self, mesh: usize, limits: Limits) -> Result<DecodedMesh, DecodeError> {
        self.decoded(mesh, limits, MeshCode::decode_stored)
    }

    fn decoded<T>(
        &self,
        mesh: usize,
        limits: Limits,
        decode: impl Fn(&[u8], Limits) -> Result<T, DecodeError>,
    ) -> Result<T, DecodeError> {
        let entry = &self.meshes[mesh];
        decode(&entry.code, limits).map_err(|error| DecodeError {
            byte: error.byte + entry.byte,
            ..error
        })
    }

    /// Whether bytes begin as an archive does.
    #[must_use]
    pub fn is_archive(bytes: &[u8]) -> bool {
        bytes.starts_with(&MAGIC)
    }

    /// The archive as bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.push(VERSION);
        varint::write(&mut bytes, self.meshes.len() as u64);
        for NamedCode { name, code, .. } in &self.meshes {
            let begin = bytes.len();
            varint::write(&mut bytes, name.len() as u64);
            varint::write(&mut bytes, code.len() as u64);
            bytes.extend(name.as_bytes());
            bytes.extend(code);
            let sum = crc32(&bytes[begin..]);
            bytes.extend(sum.to_le_bytes());
        }
        bytes
    }

    /// The archive from bytes; meshes are [decoded](Self::decode) when they are asked for.
    ///
    /// # Errors
    /// The bytes are no archive, are cut, or have changed: every mesh has a checksum.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, DecodeError> {
        let mut rest = bytes;
        let error = |rest: &[u8], kind| DecodeError {
            byte: bytes.len() - rest.len(),
            kind,
        };

        // What it is.
        let magic = rest.split_off(..MAGIC.len());
        if magic != Some(&MAGIC) {
            return Err(error(bytes, DecodeErrorKind::NoArchive));
        }
        match rest.split_off_first() {
            Some(&VERSION) => {}
            Some(&found) => {
                let (what, found) = ("version", found.into());
                return Err(error(rest, DecodeErrorKind::Unknown { what, found }));
            }
            None => return Err(error(rest, DecodeErrorKind::EndsEarly)),
        }

        // The meshes: each takes more than six bytes.
        let number = |rest: &mut &[u8]| {
            let number = varint::read(rest);
            let number = number.ok_or_else(|| error(rest, DecodeErrorKind::EndsEarly))?;
            Ok(usize::try_from(number).unwrap_or(usize::MAX))
        };
        let count = number(&mut rest)?;
        let mut meshes = Vec::new();
        for _ in 0..count {
            let begin = rest;
            let (name, code) = (number(&mut rest)?, number(&mut rest)?);
            let cut = error(rest, DecodeErrorKind::EndsEarly);
            let name = rest.split_off(..name).ok_or(cut.clone())?;
            let byte = bytes.len() - rest.len();
            let code = rest.split_off(..code).ok_or(cut.clone())?;
            let sum = crc32(&begin[..begin.len() - rest.len()]);
            let said = rest.split_off(..4).ok_or(cut)?;
            let name = std::str::from_utf8(name).ok();
            let name = name.filter(|_| said == sum.to_le_bytes());
            meshes.push(NamedCode {
                name: name.ok_or(DecodeError::damaged(byte))?.to_owned(),
                code: code.to_vec(),
                byte,
            });
        }
        match rest.is_empty() {
            true => Ok(Self { meshes }),
            false => Err(error(rest, DecodeErrorKind::Damaged)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::CodeOptions;
    use super::*;

    fn archive() -> MeshArchive {
        let mut archive = MeshArchive::default();
        for (count, name) in [(3, "one"), (0, ""), (7, "Größe")] {
            let positions: Vec<_> = (0..count).map(|i| [i as f32, 1.0, 0.5]).collect();
            let faces: Vec<_> = (2..count).map(|i| [0, i - 1, i]).collect();
            let mesh = Mesh::new(positions, faces).unwrap();
            archive.push(
                name,
                &MeshCode::new(&mesh, &CodeOptions::default()).unwrap(),
            );
        }
        archive
    }

    #[test]
    fn meshes_come_back_with_their_names() {
        let archive = archive();
        let bytes = archive.to_bytes();
        assert!(MeshArchive::is_archive(&bytes));
        let read = MeshArchive::from_bytes(&bytes).unwrap();
        assert_eq!(read.len(), 3);
        for mesh in 0..3 {
            assert_eq!(read.name(mesh), archive.name(mesh));
            let limits = Limits::default();
            assert_eq!(read.decode(mesh, limits), archive.decode(mesh, limits));
        }
        assert_eq!(read.to_bytes(), bytes);
    }

    #[test]
    fn every_change_and_every_cut_is_noticed() {
        let bytes = archive().to_bytes();
        for length in 0..bytes.len() {
            assert!(MeshArchive::from_bytes(&bytes[..length]).is_err());
        }
        for place in 0..bytes.len() {
            for bit in 0..8 {
                let mut changed = bytes.clone();
                changed[place] ^= 1 << bit;
                assert!(MeshArchive::from_bytes(&changed).is_err());
            }
        }
        let error = MeshArchive::from_bytes(b"ply\n").unwrap_err();
        assert_eq!(error.kind, DecodeErrorKind::NoArchive);
        let error = MeshArchive::from_bytes(b"MWZ\x1a\x09").unwrap_err();
        assert!(error.to_string().contains("version 9"), "{error}");
    }
}
