//! A card that is ready to draw.

use std::cell::Cell;
use std::fmt;
use std::marker::PhantomData;

use ash::vk;

use super::instance::{Card, Instance, Kind};
use crate::error::GpuError;

/// A card, its queue, and where commands come from.
pub struct Gpu {
    card: Card,
    pub(super) device: ash::Device,
    pub(super) queue: vk::Queue,
    /// The queue family.
    family: u32,
    pub(super) pool: vk::CommandPool,
    pub(super) memory: vk::PhysicalDeviceMemoryProperties,
    has_statistics: bool,
    draws_frames: bool,
    /// The bits of a timestamp that count; 0 if there are none.
    timestamp_bits: u32,
    /// One thread at a time: the pool and the queue have no lock.
    _not_sync: PhantomData<Cell<()>>,
    // Dropped last: the device is one of its cards.
    _instance: Instance,
}

impl Gpu {
    /// Opens the card of this number among [`Instance::cards`]; the first if none is given.
    ///
    /// # Errors
    /// If there is no such card, or it cannot draw or count.
    pub fn open(number: Option<usize>) -> Result<Self, GpuError> {
        let instance = Instance::new()?;
        let mut cards = instance.cards()?;
        let number = number.unwrap_or(0);
        if number >= cards.len() {
            return Err(GpuError::input(format!(
                "there is no card {number}: `--card list` lists the {} that there are",
                cards.len()
            )));
        }
        Self::of(instance, cards.swap_remove(number))
    }

    fn of(instance: Instance, card: Card) -> Result<Self, GpuError> {
        let raw = &instance.raw;

        // A queue that draws.
        // SAFETY: the card is one of the instance's, which is alive; also below.
        let families = unsafe { raw.get_physical_device_queue_family_properties(card.physical) };
        let draws = |family: &vk::QueueFamilyProperties| {
            family.queue_flags.contains(vk::QueueFlags::GRAPHICS)
        };
        let missing = |what| GpuError::Missing {
            card: card.to_string(),
            what,
        };
        let Some(at) = families.iter().position(draws) else {
            return Err(missing("queue that draws"));
        };
        let family = u32::try_from(at).expect("a handful of queue families");

        // What the shaders and draws need, and what they use if it is there.
        // SAFETY: as above.
        let has = unsafe { raw.get_physical_device_features(card.physical) };
        if has.vertex_pipeline_stores_and_atomics == vk::FALSE {
            return Err(missing(
                "stores from vertex shaders (vertexPipelineStoresAndAtomics)",
            ));
        }
        let draws_frames =
            card.draw_parameters && [has.multi_draw_indirect, has.geometry_shader] == [vk::TRUE; 2];
        let if_frames = vk::Bool32::from(draws_frames);
        let used = vk::PhysicalDeviceFeatures {
            multi_draw_indirect: if_frames,
            geometry_shader: if_frames,
            vertex_pipeline_stores_and_atomics: vk::TRUE,
            pipeline_statistics_query: has.pipeline_statistics_query,
            full_draw_index_uint32: has.full_draw_index_uint32,
            ..vk::PhysicalDeviceFeatures::default()
        };

        // The device.
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(family)
            .queue_priorities(&[1.0])];
        let mut parameters =
            vk::PhysicalDeviceShaderDrawParametersFeatures::default().shader_draw_parameters(true);
        let mut info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_features(&used);
        if draws_frames {
            info = info.push_next(&mut parameters);
        }
        // SAFETY: `info` and what it points to live until the call returns; the queue family exists
        // and the features are among the card's.
        let device = unsafe { raw.create_device(card.physical, &info, None) }
            .map_err(GpuError::when("opening the card"))?;
        // SAFETY: the device was made with one queue of this family.
        let queue = unsafe { device.get_device_queue(family, 0) };
        // SAFETY: as above.
        let memory = unsafe { raw.get_physical_device_memory_properties(card.physical) };
        let mut gpu = Self {
            card,
            device,
            queue,
            family,
            pool: vk::CommandPool::null(),
            memory,
            has_statistics: has.pipeline_statistics_query == vk::TRUE,
            draws_frames,
            timestamp_bits: families[at].timestamp_valid_bits,
            _not_sync: PhantomData,
            _instance: instance,
        };

        // Last, so that the device is freed if it fails.
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(gpu.family);
        // SAFETY: the family is the one that the device was made with.
        gpu.pool = unsafe { gpu.device.create_command_pool(&info, None) }
            .map_err(GpuError::when("preparing commands"))?;
        Ok(gpu)
    }

    /// What the card is.
    #[must_use]
    pub fn card(&self) -> &Card {
        &self.card
    }

    /// Whether its statistics count invocations of vertex shaders.
    #[must_use]
    pub fn has_statistics(&self) -> bool {
        self.has_statistics
    }

    /// Whether it draws several ranges of faces by one call, and shaders can tell which range and which face is
    /// seen.
    #[must_use]
    pub fn draws_frames(&self) -> bool {
        self.draws_frames
    }

    /// The most draws of one call whose arguments are on the card.
    #[must_use]
    pub fn most_draws(&self) -> u32 {
        self.card.limits.indirect_draws
    }

    /// Whether a vertex shader can tell which invocations run in one group.
    #[must_use]
    pub fn has_warps(&self) -> bool {
        self.card.subgroups_in_vertex_shaders
    }

    /// Whether draws can be timed.
    #[must_use]
    pub fn has_timestamps(&self) -> bool {
        self.timestamp_bits > 0 && self.card.limits.nanoseconds_per_tick > 0.0
    }

    /// Whether times are those of a card, not of a program.
    #[must_use]
    pub fn times_mean_something(&self) -> bool {
        self.has_timestamps() && self.card.kind != Kind::Software
    }

    /// The largest index that can be drawn.
    #[must_use]
    pub fn largest_index(&self) -> u32 {
        self.card.limits.index
    }

    /// The most words that a shader can reach in one buffer.
    #[must_use]
    pub fn most_words(&self) -> usize {
        self.card.limits.storage_bytes as usize / 4
    }

    /// Nanoseconds from one timestamp to another.
    pub(super) fn nanoseconds(&self, from: u64, to: u64) -> f64 {
        // Bits that do not count may be anything, and the counter may have come round.
        let mask = u64::MAX >> (64 - self.timestamp_bits.clamp(1, 64));
        let ticks = to.wrapping_sub(from) & mask;
        ticks as f64 * f64::from(self.card.limits.nanoseconds_per_tick)
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        // SAFETY: everything made from the device borrows `self`, so nothing is left of it; the pool
        // is this device's, or null.
        unsafe {
            let _ = self.device.device_wait_idle();
            self.device.destroy_command_pool(self.pool, None);
            self.device.destroy_device(None);
        }
    }
}

impl fmt::Debug for Gpu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Gpu")
            .field("card", &self.card)
            .finish_non_exhaustive()
    }
}
