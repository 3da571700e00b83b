//! Where shaders find what they are given.

use std::fmt;

use ash::vk;

use super::buffer::Buffer;
use super::gpu::Gpu;
use crate::error::GpuError;

/// Three buffers in set 0 (counters, log, table) and sixteen floats that change between draws.
pub struct Layout<'g> {
    gpu: &'g Gpu,
    descriptors: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
    pub(super) set: vk::DescriptorSet,
    pub(super) raw: vk::PipelineLayout,
    /// Borrowed by the set.
    buffers: [Buffer<'g>; 3],
}

impl<'g> Layout<'g> {
    /// A set of these buffers.
    ///
    /// # Errors
    /// If the card has too little memory, or a buffer is larger than shaders can reach.
    pub fn new(gpu: &'g Gpu, buffers: [Buffer<'g>; 3]) -> Result<Self, GpuError> {
        let failed = || GpuError::when("preparing shaders");
        if let Some(buffer) = buffers.iter().find(|b| b.words() > gpu.most_words()) {
            return Err(GpuError::input(format!(
                "a buffer of {} words: shaders of this card reach {}",
                buffer.words(),
                gpu.most_words()
            )));
        }
        // What fails is freed by `drop`, which takes null.
        let mut layout = Self {
            gpu,
            descriptors: vk::DescriptorSetLayout::null(),
            pool: vk::DescriptorPool::null(),
            set: vk::DescriptorSet::null(),
            raw: vk::PipelineLayout::null(),
            buffers,
        };
        layout.add_layouts().map_err(failed())?;
        layout.add_set().map_err(failed())?;
        Ok(layout)
    }

    /// Where invocations are counted.
    #[must_use]
    pub fn counters(&self) -> &Buffer<'g> {
        &self.buffers[0]
    }

    /// Where invocations are written down.
    #[must_use]
    pub fn log(&self) -> &Buffer<'g> {
        &self.buffers[1]
    }

    fn add_layouts(&mut self) -> Result<(), vk::Result> {
        let device = &self.gpu.device;
        let stage = vk::ShaderStageFlags::VERTEX;
        let bindings = [0, 1, 2].map(|binding| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(binding)
                .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                .descriptor_count(1)
                .stage_flags(stage)
        });
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: the device is alive, also below; infos and what they point to live until the call
        // returns.
        self.descriptors = unsafe { device.create_descriptor_set_layout(&info, None) }?;

        let sets = [self.descriptors];
        let constants = [vk::PushConstantRange::default().stage_flags(stage).size(64)];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&sets)
            .push_constant_ranges(&constants);
        // SAFETY: the set layout is alive.
        self.raw = unsafe { device.create_pipeline_layout(&info, None) }?;
        Ok(())
    }

    fn add_set(&mut self) -> Result<(), vk::Result> {
        let device = &self.gpu.device;

        // A set.
        let sizes = [vk::DescriptorPoolSize::default()
            .ty(vk::DescriptorType::STORAGE_BUFFER)
            .descriptor_count(3)];
        let info = vk::DescriptorPoolCreateInfo::default()
            .max_sets(1)
            .pool_sizes(&sizes);
        // SAFETY: the device is alive, also below.
        self.pool = unsafe { device.create_descriptor_pool(&info, None) }?;
        let layouts = [self.descriptors];
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(self.pool)
            .set_layouts(&layouts);
        // SAFETY: the pool has room for one set of this layout.
        self.set = unsafe { device.allocate_descriptor_sets(&info) }?[0];

        // Each buffer in its place.
        let whole = self.buffers.each_ref().map(|buffer| {
            [vk::DescriptorBufferInfo::default()
                .buffer(buffer.raw)
                .range(vk::WHOLE_SIZE)]
        });
        let writes: Vec<_> = (0..)
            .zip(&whole)
            .map(|(binding, buffer)| {
                vk::WriteDescriptorSet::default()
                    .dst_set(self.set)
                    .dst_binding(binding)
                    .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                    .buffer_info(buffer)
            })
            .collect();
        // SAFETY: the set is not in use, and the buffers live as long as it does.
        unsafe { device.update_descriptor_sets(&writes, &[]) };
        Ok(())
    }
}

impl Drop for Layout<'_> {
    fn drop(&mut self) {
        let device = &self.gpu.device;
        // SAFETY: no submission is under way (`run` waits), pipelines borrow the layout and are gone,
        // and the handles are this layout's, or null. The set goes with its pool.
        unsafe {
            device.destroy_pipeline_layout(self.raw, None);
            device.destroy_descriptor_pool(self.pool, None);
            device.destroy_descriptor_set_layout(self.descriptors, None);
        }
    }
}

impl fmt::Debug for Layout<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Layout")
            .field("buffers", &self.buffers)
            .finish_non_exhaustive()
    }
}
