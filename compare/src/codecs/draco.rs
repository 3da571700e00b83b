//! Google's Draco, by the library installed on the machine.

use std::ffi::{CStr, c_char, c_int};
use std::ptr::NonNull;

use super::{Codec, Encoded, Input, Output, Positions};

/// Draco at a level of compression, by Edgebreaker.
///
/// Positions are integers, so that it rounds nothing. Below level 6, and below 1,000 faces, it codes faces
/// without their valences.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Draco {
    level: u8,
    has_positions: bool,
}

impl Draco {
    /// From level 1 to 10; its speed is 10 − level.
    ///
    /// # Panics
    /// If there is no such level, or if it is 0, which is not Edgebreaker.
    #[must_use]
    pub fn new(level: u8) -> Self {
        assert!((1..=10).contains(&level), "level {level} of Draco");
        Self {
            level,
            has_positions: true,
        }
    }

    /// The same with all positions 0, for the time that the faces take.
    ///
    /// # Panics
    /// As [`Self::new`].
    #[must_use]
    pub fn connectivity_only(level: u8) -> Self {
        Self {
            has_positions: false,
            ..Self::new(level)
        }
    }
}

/// The version of the library whose headers were compiled.
#[must_use]
pub fn version() -> String {
    // SAFETY: the function returns a string that lives as long as the program.
    unsafe { CStr::from_ptr(compare_draco_version()) }
        .to_string_lossy()
        .into_owned()
}

impl Codec for Draco {
    fn name(&self) -> String {
        let what = if self.has_positions {
            ""
        } else {
            ", faces only"
        };
        format!("Draco {}{what}", self.level)
    }

    fn encode(&self, input: &Input) -> Result<Encoded, String> {
        let zeros;
        let positions = match self.has_positions {
            true => &input.positions,
            false => {
                zeros = vec![[0; 3]; input.positions.len()];
                &zeros
            }
        };
        let count = positions.len();
        let is_past = |&vertex: &u32| vertex as usize >= count;
        if input.faces.as_flattened().iter().any(is_past) {
            return Err("a face names a vertex that there is not".to_owned());
        }
        let code = Code::new(positions, &input.faces, 10 - c_int::from(self.level))?;
        Ok(Encoded {
            bytes: code.bytes().to_vec(),
            connectivity_size: Some(code.connectivity_size()),
            new_to_old: None,
        })
    }

    fn decode(&self, bytes: &[u8]) -> Result<Output, String> {
        let (positions, faces) = DecodedMesh::new(bytes)?.copied();
        let positions = match self.has_positions {
            true => Positions::Triples(positions),
            false => Positions::None(positions.len()),
        };
        Ok(Output { positions, faces })
    }

    /// Faces with a repeated vertex are dropped, and what else its corner table does not take.
    fn is_exact(&self) -> bool {
        false
    }
}

/// What Draco's encoder made.
struct Code(NonNull<CompareDracoEncoded>);

impl Code {
    /// Every index of `faces` must be below the number of positions.
    fn new(positions: &[[i32; 3]], faces: &[[u32; 3]], speed: c_int) -> Result<Self, String> {
        // SAFETY: the pointers are to as many triples as the counts say, and the caller vouches for the indices.
        let code = unsafe {
            compare_draco_encode(
                positions.as_ptr().cast(),
                positions.len(),
                faces.as_ptr().cast(),
                faces.len(),
                speed,
            )
        };
        let code = Self(NonNull::new(code).ok_or("no memory for Draco's encoder")?);
        // SAFETY: the object is alive, and its text lives as long.
        unsafe { checked(compare_draco_encoded_error(code.0.as_ptr()))? };
        Ok(code)
    }

    fn bytes(&self) -> &[u8] {
        // SAFETY: the object is alive and does not change.
        let size = unsafe { compare_draco_encoded_size(self.0.as_ptr()) };
        if size == 0 {
            return &[];
        }
        // SAFETY: the data are as many bytes, which live as long as the object.
        unsafe {
            let data = compare_draco_encoded_data(self.0.as_ptr());
            std::slice::from_raw_parts(data.cast(), size)
        }
    }

    fn connectivity_size(&self) -> usize {
        // SAFETY: the object is alive.
        unsafe { compare_draco_encoded_connectivity_size(self.0.as_ptr()) }
    }
}

impl Drop for Code {
    fn drop(&mut self) {
        // SAFETY: nobody else owns the object, and it is not used again.
        unsafe { compare_draco_encoded_free(self.0.as_ptr()) };
    }
}

/// What Draco's decoder made.
struct DecodedMesh(NonNull<CompareDracoDecoded>);

impl DecodedMesh {
    fn new(bytes: &[u8]) -> Result<Self, String> {
        // SAFETY: the pointer is to as many bytes as it says; the decoder only reads them.
        let decoded = unsafe { compare_draco_decode(bytes.as_ptr().cast(), bytes.len()) };
        let decoded = Self(NonNull::new(decoded).ok_or("no memory for Draco's decoder")?);
        // SAFETY: the object is alive, and its text lives as long.
        unsafe { checked(compare_draco_decoded_error(decoded.0.as_ptr()))? };
        Ok(decoded)
    }

    /// Positions and faces.
    fn copied(&self) -> (Vec<[i32; 3]>, Vec<[u32; 3]>) {
        // SAFETY: the object is alive, and as it has no error it has a mesh.
        let [vertex_count, face_count] = unsafe {
            [
                compare_draco_decoded_vertex_count(self.0.as_ptr()),
                compare_draco_decoded_face_count(self.0.as_ptr()),
            ]
        };
        let (mut positions, mut faces) = (vec![[0; 3]; vertex_count], vec![[0; 3]; face_count]);
        // SAFETY: there is room for as many triples as the function writes.
        unsafe {
            compare_draco_decoded_copy(
                self.0.as_ptr(),
                positions.as_mut_ptr().cast(),
                faces.as_mut_ptr().cast(),
            );
        }
        (positions, faces)
    }
}

impl Drop for DecodedMesh {
    fn drop(&mut self) {
        // SAFETY: nobody else owns the object, and it is not used again.
        unsafe { compare_draco_decoded_free(self.0.as_ptr()) };
    }
}

/// An error if there is a text of one.
///
/// # Safety
/// The pointer is null or to a text that ends with a zero.
unsafe fn checked(error: *const c_char) -> Result<(), String> {
    if error.is_null() {
        return Ok(());
    }
    // SAFETY: as the caller says.
    let error = unsafe { CStr::from_ptr(error) };
    Err(format!("Draco: {}", error.to_string_lossy()))
}

/// An object of `draco.cpp`.
#[repr(C)]
struct CompareDracoEncoded {
    _opaque: [u8; 0],
}

/// An object of `draco.cpp`.
#[repr(C)]
struct CompareDracoDecoded {
    _opaque: [u8; 0],
}

// What `draco.cpp` defines.
unsafe extern "C" {
    fn compare_draco_version() -> *const c_char;
    fn compare_draco_encode(
        positions: *const i32,
        vertex_count: usize,
        faces: *const u32,
        face_count: usize,
        speed: c_int,
    ) -> *mut CompareDracoEncoded;
    fn compare_draco_encoded_error(encoded: *const CompareDracoEncoded) -> *const c_char;
    fn compare_draco_encoded_data(encoded: *const CompareDracoEncoded) -> *const c_char;
    fn compare_draco_encoded_size(encoded: *const CompareDracoEncoded) -> usize;
    fn compare_draco_encoded_connectivity_size(encoded: *const CompareDracoEncoded) -> usize;
    fn compare_draco_encoded_free(encoded: *mut CompareDracoEncoded);
    fn compare_draco_decode(bytes: *const c_char, size: usize) -> *mut CompareDracoDecoded;
    fn compare_draco_decoded_error(decoded: *const CompareDracoDecoded) -> *const c_char;
    fn compare_draco_decoded_vertex_count(decoded: *const CompareDracoDecoded) -> usize;
    fn compare_draco_decoded_face_count(decoded: *const CompareDracoDecoded) -> usize;
    fn compare_draco_decoded_copy(
        decoded: *const CompareDracoDecoded,
        positions: *mut i32,
        faces: *mut u32,
    );
    fn compare_draco_decoded_free(decoded: *mut CompareDracoDecoded);
}
