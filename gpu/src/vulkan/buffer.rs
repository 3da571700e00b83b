//! Words in the card's memory.

use std::fmt;

use ash::vk;

use super::gpu::Gpu;
use crate::error::GpuError;

/// A buffer of 32-bit words: indices, positions, counters.
///
/// Its words are in the card's own memory, where it is fastest; they are copied in and out through
/// memory that both sides see.
pub struct Buffer<'g> {
    pub(super) gpu: &'g Gpu,
    pub(super) raw: vk::Buffer,
    memory: vk::DeviceMemory,
    words: usize,
}

impl<'g> Buffer<'g> {
    /// A buffer of so many words, all zero.
    ///
    /// # Errors
    /// If the card has too little memory.
    pub fn zeros(gpu: &'g Gpu, words: usize) -> Result<Self, GpuError> {
        let buffer = Self::new(gpu, words, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
        gpu.run(|commands| commands.fill_with_zeros(&buffer))?;
        Ok(buffer)
    }

    /// A buffer of these words.
    ///
    /// # Errors
    /// If the card has too little memory.
    pub fn of(gpu: &'g Gpu, words: &[u32]) -> Result<Self, GpuError> {
        let buffer = Self::new(gpu, words.len(), vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
        let mut shared = Self::shared(gpu, words.len())?;
        shared.mapped(|bytes| {
            for (to, word) in bytes.chunks_exact_mut(4).zip(words) {
                to.copy_from_slice(&word.to_ne_bytes());
            }
        })?;
        gpu.run(|commands| commands.copy(&shared, &buffer, words.len()))?;
        Ok(buffer)
    }

    /// The first words of it, as many as asked for, at most all.
    ///
    /// # Errors
    /// If the card has too little memory.
    pub fn read(&self, words: usize) -> Result<Vec<u32>, GpuError> {
        let words = words.min(self.words);
        let mut shared = Self::shared(self.gpu, words)?;
        self.gpu
            .run(|commands| commands.copy(self, &shared, words))?;
        let mut read = Vec::with_capacity(words);
        shared.mapped(|bytes| {
            let word = |b: &[u8]| u32::from_ne_bytes([b[0], b[1], b[2], b[3]]);
            read.extend(bytes.chunks_exact(4).take(words).map(word));
        })?;
        Ok(read)
    }

    /// How many words it has.
    #[must_use]
    pub fn words(&self) -> usize {
        self.words
    }

    /// A buffer that the processor sees too.
    fn shared(gpu: &'g Gpu, words: usize) -> Result<Self, GpuError> {
        let seen = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        Self::new(gpu, words, seen)
    }

    fn new(
        gpu: &'g Gpu,
        words: usize,
        properties: vk::MemoryPropertyFlags,
    ) -> Result<Self, GpuError> {
        let failed = || GpuError::when("taking memory of the card");
        // Vulkan knows no empty buffer.
        let words = words.max(1);
        let info = vk::BufferCreateInfo::default()
            .size(words as u64 * 4)
            .usage(
                vk::BufferUsageFlags::TRANSFER_SRC
                    | vk::BufferUsageFlags::TRANSFER_DST
                    | vk::BufferUsageFlags::INDEX_BUFFER
                    | vk::BufferUsageFlags::VERTEX_BUFFER
                    | vk::BufferUsageFlags::INDIRECT_BUFFER
                    | vk::BufferUsageFlags::STORAGE_BUFFER,
            )
            .sharing_mode(vk::SharingMode::EXCLUSIVE);
        // SAFETY: the device is alive as long as `gpu`, also below; the size is not zero.
        let raw = unsafe { gpu.device.create_buffer(&info, None) }.map_err(failed())?;
        let mut buffer = Self {
            gpu,
            raw,
            memory: vk::DeviceMemory::null(),
            words,
        };

        // Its memory. From here on what fails is freed by `drop`.
        // SAFETY: the buffer is alive.
        let needs = unsafe { gpu.device.get_buffer_memory_requirements(raw) };
        let is_right = |&kind: &u32| {
            let memory = gpu.memory.memory_types[kind as usize];
            needs.memory_type_bits & (1 << kind) != 0 && memory.property_flags.contains(properties)
        };
        // Of memory that the processor sees, what it caches is read in a fraction of the time.
        let is_cached = |&kind: &u32| {
            let flags = gpu.memory.memory_types[kind as usize].property_flags;
            flags.contains(vk::MemoryPropertyFlags::HOST_CACHED)
        };
        let kinds = (0..gpu.memory.memory_type_count).filter(is_right);
        let is_shared = properties.contains(vk::MemoryPropertyFlags::HOST_VISIBLE);
        let kind = match is_shared {
            true => kinds
                .clone()
                .find(is_cached)
                .or_else(|| kinds.clone().next()),
            false => kinds.clone().next(),
        };
        let kind = kind.ok_or_else(|| failed()(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY))?;
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(needs.size)
            .memory_type_index(kind);
        // SAFETY: the memory type exists.
        buffer.memory = unsafe { gpu.device.allocate_memory(&info, None) }.map_err(failed())?;
        // SAFETY: both are fresh, and the memory has the type and the size that the buffer needs.
        unsafe { gpu.device.bind_buffer_memory(raw, buffer.memory, 0) }.map_err(failed())?;
        Ok(buffer)
    }

    /// Lets `access` see the bytes, which must be in shared memory.
    fn mapped(&mut self, access: impl FnOnce(&mut [u8])) -> Result<(), GpuError> {
        let device = &self.gpu.device;
        let size = self.words * 4;
        // SAFETY: callers are in this file and map shared buffers only; the memory has this size at
        // least and is not mapped: it is unmapped below.
        let at =
            unsafe { device.map_memory(self.memory, 0, size as u64, vk::MemoryMapFlags::empty()) }
                .map_err(GpuError::when("reaching memory of the card"))?;
        // SAFETY: `size` bytes are mapped at `at`, the card does not use them now (`run` waits), and
        // `self` is borrowed, so nobody else does. They are bytes of a fresh or copied buffer; any
        // value is a byte.
        access(unsafe { std::slice::from_raw_parts_mut(at.cast::<u8>(), size) });
        // SAFETY: it was mapped above.
        unsafe { device.unmap_memory(self.memory) };
        Ok(())
    }
}

impl Drop for Buffer<'_> {
    fn drop(&mut self) {
        // SAFETY: no submission is under way (`run` waits), and the handles are this buffer's, or null.
        unsafe {
            self.gpu.device.destroy_buffer(self.raw, None);
            self.gpu.device.free_memory(self.memory, None);
        }
    }
}

impl fmt::Debug for Buffer<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Buffer")
            .field("words", &self.words)
            .finish_non_exhaustive()
    }
}
