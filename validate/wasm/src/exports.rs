//! What a wasm32 host calls, with numbers and addresses in the memory that both share.
//!
//! The module imports nothing: no clock, no random numbers, no output. So the text of a panic is kept
//! where the host can read it after the trap.

use std::ptr::slice_from_raw_parts_mut;
use std::slice;
use std::sync::{Mutex, PoisonError};

use crate::{Request, optimize};

/// The text of the last panic.
static PANIC: Mutex<String> = Mutex::new(String::new());

/// Keeps the text of any later panic, instead of printing it where nobody reads it.
#[unsafe(no_mangle)]
pub extern "C" fn keep_panics() {
    std::panic::set_hook(Box::new(|panic| {
        *PANIC.lock().unwrap_or_else(PoisonError::into_inner) = panic.to_string();
    }));
}

/// Where the text of the last panic is.
#[unsafe(no_mangle)]
pub extern "C" fn panic_text() -> *const u8 {
    PANIC
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .as_ptr()
}

/// Its length in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn panic_text_bytes() -> usize {
    PANIC.lock().unwrap_or_else(PoisonError::into_inner).len()
}

/// At least this many bytes of zeroed memory, aligned for any index; [`release`] frees them.
// Not `malloc` and `free`: natively these names are taken.
#[unsafe(no_mangle)]
pub extern "C" fn allocate(bytes: usize) -> *mut u64 {
    let memory: Box<[u64]> = vec![0; words(bytes)].into();
    Box::into_raw(memory).cast()
}

/// Frees memory.
///
/// # Safety
/// `memory` comes from [`allocate`] with the same number of bytes, and is not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn release(memory: *mut u64, bytes: usize) {
    let slice = slice_from_raw_parts_mut(memory, words(bytes));
    // SAFETY: it was a box of that many words, which `allocate` gave away.
    drop(unsafe { Box::from_raw(slice) });
}

fn words(bytes: usize) -> usize {
    bytes.div_ceil(size_of::<u64>())
}

/// An export for one width of indices.
macro_rules! optimize_export {
    ($name:ident, $index:ty) => {
        /// [`optimize`](crate::optimize) where the indices are; the status as a number.
        ///
        /// # Safety
        /// `indices` points to `index_count` indices and `target` to `target_bytes` bytes, which
        /// nothing else uses during the call.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(
            indices: *mut $index,
            index_count: usize,
            vertex_count: usize,
            target: *const u8,
            target_bytes: usize,
            effort: u32,
            steps: u64,
            seed: u64,
            flags: u32,
        ) -> u32 {
            // SAFETY: the caller promises both.
            let (indices, target) = unsafe {
                (
                    slice::from_raw_parts_mut(indices, index_count),
                    text(target, target_bytes),
                )
            };
            let request = Request {
                target,
                effort,
                steps,
                seed,
                flags,
            };
            optimize(indices, vertex_count, &request) as u32
        }
    };
}

optimize_export!(optimize_u16, u16);
optimize_export!(optimize_u32, u32);

/// [`misses`](crate::misses) of indices of 32 bits.
///
/// # Safety
/// `indices` points to `index_count` indices and `cache` to `cache_bytes` bytes, which do not change
/// during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn misses(
    indices: *const u32,
    index_count: usize,
    vertex_count: usize,
    cache: *const u8,
    cache_bytes: usize,
) -> u64 {
    // SAFETY: the caller promises both.
    let (indices, cache) = unsafe {
        (
            slice::from_raw_parts(indices, index_count),
            text(cache, cache_bytes),
        )
    };
    crate::misses(indices, vertex_count, cache)
}

/// What [`compressed`] answered last.
static ANSWER: Mutex<Vec<u8>> = Mutex::new(Vec::new());

/// [`compressed::answer`](crate::compressed::answer) to a case; its length in bytes. It lies where [`answer`] says.
///
/// # Safety
/// `case` points to that many bytes, which do not change during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn compressed(case: *const u8, case_bytes: usize) -> usize {
    // SAFETY: the caller promises it.
    let case = unsafe { slice::from_raw_parts(case, case_bytes) };
    let mut kept = ANSWER.lock().unwrap_or_else(PoisonError::into_inner);
    *kept = crate::compressed::answer(case);
    kept.len()
}

/// Where the last answer of [`compressed`] lies, until its next call.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    let kept = ANSWER.lock().unwrap_or_else(PoisonError::into_inner);
    kept.as_ptr()
}

/// The text there; empty if it is not UTF-8.
///
/// # Safety
/// `text` points to this many bytes, which do not change as long as the result is used.
unsafe fn text<'a>(text: *const u8, bytes: usize) -> &'a str {
    // SAFETY: the caller promises it.
    let text = unsafe { slice::from_raw_parts(text, bytes) };
    str::from_utf8(text).unwrap_or_default()
}
