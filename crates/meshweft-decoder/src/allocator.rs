//! An allocator of few instructions, instead of the standard library's, which would be a fifth of the module.
//!
//! Blocks have a power of two of bytes, and one that was freed waits in a list of its size. So memory that a decoder
//! gave back serves the next one, and at most half of a block is not used. Nothing goes back to the host before
//! the module itself does.

use core::alloc::{GlobalAlloc, Layout};
use core::arch::wasm32::{memory_grow, memory_size};
use core::cell::UnsafeCell;
use core::ptr::null_mut;

/// Bytes of a page of memory.
const PAGE: usize = 1 << 16;
/// Blocks are aligned to this, and at least as large.
const ALIGNMENT: usize = 16;

pub(crate) struct SizeLists(UnsafeCell<Memory>);

struct Memory {
    /// The first free block of each power of two; each has the address of the next one in its first word.
    free: [*mut u8; usize::BITS as usize],
    /// What was not given away yet.
    next: usize,
    end: usize,
}

// SAFETY: the module has one thread.
unsafe impl Sync for SizeLists {}

impl SizeLists {
    pub(crate) const fn new() -> Self {
        Self(UnsafeCell::new(Memory {
            free: [null_mut(); usize::BITS as usize],
            next: 0,
            end: 0,
        }))
    }
}

/// The power of two of the block for a layout; none if it is too large.
fn power(layout: Layout) -> Option<u32> {
    let size = layout.size().max(ALIGNMENT).checked_next_power_of_two()?;
    (layout.align() <= ALIGNMENT).then_some(size.trailing_zeros())
}

impl Memory {
    /// A block that nobody had before; null if there is no memory.
    fn new_block(&mut self, size: usize) -> *mut u8 {
        if self.end == 0 {
            self.end = memory_size(0) * PAGE;
            self.next = self.end;
        }
        if self.end - self.next < size {
            let pages = (size - (self.end - self.next)).div_ceil(PAGE);
            if memory_grow(0, pages) == usize::MAX {
                return null_mut();
            }
            // The last byte of all memory would be past the largest address.
            self.end = self.end.saturating_add(pages * PAGE);
            if self.end - self.next < size {
                return null_mut();
            }
        }
        let block = self.next;
        self.next += size;
        core::ptr::with_exposed_provenance_mut(block)
    }
}

// SAFETY: a block is in one list or with one owner, never both, and is as large and aligned as its layout asks.
unsafe impl GlobalAlloc for SizeLists {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let Some(power) = power(layout) else {
            return null_mut();
        };
        // SAFETY: one thread, and nothing below calls back.
        let memory = unsafe { &mut *self.0.get() };
        let first = &mut memory.free[power as usize];
        let block = *first;
        if block.is_null() {
            return memory.new_block(1 << power);
        }
        // SAFETY: a free block has the next one's address in its first word.
        *first = unsafe { block.cast::<*mut u8>().read() };
        block
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        let Some(power) = power(layout) else {
            return;
        };
        // SAFETY: as above.
        let first = unsafe { &mut (&mut *self.0.get()).free[power as usize] };
        // SAFETY: the block has at least 16 bytes, aligned to 16, and its owner is done with them.
        unsafe { block.cast::<*mut u8>().write(*first) };
        *first = block;
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, new_size: usize) -> *mut u8 {
        let Ok(new_layout) = Layout::from_size_align(new_size, layout.align()) else {
            return null_mut();
        };
        if power(new_layout) == power(layout) {
            return block;
        }
        // SAFETY: both layouts are of blocks, which do not overlap, and the smaller length fits either.
        unsafe {
            let new = self.alloc(new_layout);
            if !new.is_null() {
                new.copy_from_nonoverlapping(block, layout.size().min(new_size));
                self.dealloc(block, layout);
            }
            new
        }
    }
}
