//! The decoder of compressed meshes behind plain exports, with numbers and addresses in the memory that the module
//! and its host share.
//!
//! A host writes bytes where [`decoder_input`] says, calls [`decoder_push`], and reads the vertices and faces that are
//! complete before it writes the next bytes. `decoder.mjs` does that for JavaScript. The module imports nothing.

#[cfg(target_arch = "wasm32")]
mod allocator;

use meshweft::Limits;
use meshweft::bits::{DecodeError, DecodeErrorKind};
use meshweft::compression::MeshDecoder;

#[cfg(target_arch = "wasm32")]
#[global_allocator]
static ALLOCATOR: allocator::SizeLists = allocator::SizeLists::new();

/// A mesh that arrives.
#[derive(Debug)]
pub struct Decoder {
    decoder: MeshDecoder,
    input: Vec<u8>,
    unused: usize,
    error_byte: usize,
    positions: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
}

/// What can be said of a mesh that arrives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Status {
    /// More bytes are needed.
    Incomplete = 0,
    /// The mesh is there.
    Complete = 1,
    /// The stream is damaged.
    Damaged = 2,
    /// It is no such stream, or one of a later version.
    Unknown = 3,
    /// It has more vertices or faces than are allowed.
    AboveLimit = 4,
}

impl Decoder {
    fn new(limits: Limits) -> Self {
        Self {
            decoder: MeshDecoder::new(limits),
            input: Vec::new(),
            unused: 0,
            error_byte: 0,
            positions: Vec::new(),
            faces: Vec::new(),
        }
    }

    fn push(&mut self) -> Status {
        let pushed = self.decoder.push(&self.input);
        self.positions = self.decoder.take_positions();
        self.faces = self.decoder.take_faces();
        match pushed {
            Ok(used) => {
                self.unused = self.input.len() - used;
                match self.decoder.is_complete() {
                    true => Status::Complete,
                    false => Status::Incomplete,
                }
            }
            Err(DecodeError { byte, kind }) => {
                self.error_byte = byte;
                match kind {
                    DecodeErrorKind::Unknown { .. } => Status::Unknown,
                    DecodeErrorKind::AboveLimit { .. } => Status::AboveLimit,
                    _ => Status::Damaged,
                }
            }
        }
    }
}

/// A decoder that refuses meshes with more vertices or faces.
#[unsafe(no_mangle)]
pub extern "C" fn decoder_new(most_vertices: usize, most_faces: usize) -> *mut Decoder {
    let mut limits = Limits::default();
    limits.vertices = limits.vertices.min(most_vertices);
    limits.faces = limits.faces.min(most_faces);
    Box::into_raw(Box::new(Decoder::new(limits)))
}

/// Ends a decoder.
///
/// # Safety
/// `decoder` comes from [`decoder_new`], and is not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decoder_free(decoder: *mut Decoder) {
    // SAFETY: the caller promises that it was a box, and nobody else's now.
    drop(unsafe { Box::from_raw(decoder) });
}

/// An export that uses a decoder.
macro_rules! export {
    ($(#[doc = $doc:literal])+ $name:ident($decoder:ident $(, $argument:ident: $of:ty)?) -> $result:ty { $do:expr }) => {
        $(#[doc = $doc])+
        ///
        /// # Safety
        /// `decoder` comes from [`decoder_new`] and was not freed, and nothing else uses it during the call.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(decoder: *mut Decoder $(, $argument: $of)?) -> $result {
            // SAFETY: the caller promises it.
            let $decoder = unsafe { &mut *decoder };
            $do
        }
    };
}

export!(
    /// Where the host writes this number of bytes that come next.
    decoder_input(decoder, bytes: usize) -> *mut u8 {
        {
            decoder.input.resize(bytes, 0);
            decoder.input.as_mut_ptr()
        }
    }
);
export!(
    /// Takes the bytes that were written: a [`Status`] as a number. What was complete before is gone.
    decoder_push(decoder) -> u32 { decoder.push() as u32 }
);
export!(
    /// How many of the bytes that were taken last do not belong to the mesh.
    decoder_unused(decoder) -> usize { decoder.unused }
);
export!(
    /// At which byte of the stream an error was found.
    decoder_error_byte(decoder) -> usize { decoder.error_byte }
);
export!(
    /// The vertices that the last bytes made complete, three coordinates each, until the next call of `decoder_push`.
    decoder_positions(decoder) -> *const [f32; 3] { decoder.positions.as_ptr() }
);
export!(
    /// How many these are.
    decoder_position_count(decoder) -> usize { decoder.positions.len() }
);
export!(
    /// The faces that the last bytes made complete, three vertices each, until the next call of `decoder_push`.
    decoder_faces(decoder) -> *const [u32; 3] { decoder.faces.as_ptr() }
);
export!(
    /// How many these are.
    decoder_face_count(decoder) -> usize { decoder.faces.len() }
);
export!(
    /// How many vertices the mesh has; 0 until that is known.
    decoder_all_vertices(decoder) -> usize { decoder.decoder.counts().unwrap_or_default()[0] }
);
export!(
    /// How many faces the mesh has; 0 until that is known.
    decoder_all_faces(decoder) -> usize { decoder.decoder.counts().unwrap_or_default()[1] }
);

#[cfg(test)]
mod tests;
