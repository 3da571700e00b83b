//! Pixels in the card's memory.

use ash::vk;

use super::gpu::Gpu;

/// A square image with its memory and a view of all of it.
pub(super) struct Image<'g> {
    gpu: &'g Gpu,
    pub(super) raw: vk::Image,
    memory: vk::DeviceMemory,
    pub(super) view: vk::ImageView,
}

/// What an image is for.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImageKind {
    pub(super) format: vk::Format,
    pub(super) usage: vk::ImageUsageFlags,
    pub(super) aspect: vk::ImageAspectFlags,
}

impl<'g> Image<'g> {
    pub(super) fn new(gpu: &'g Gpu, kind: ImageKind, side: u32) -> Result<Self, vk::Result> {
        // What fails is freed by `drop`, which takes null.
        let mut image = Self {
            gpu,
            raw: vk::Image::null(),
            memory: vk::DeviceMemory::null(),
            view: vk::ImageView::null(),
        };
        image.make(kind, side)?;
        Ok(image)
    }

    fn make(&mut self, kind: ImageKind, side: u32) -> Result<(), vk::Result> {
        let device = &self.gpu.device;

        // The image.
        let extent = vk::Extent3D {
            width: side,
            height: side,
            depth: 1,
        };
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(kind.format)
            .extent(extent)
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(kind.usage);
        // SAFETY: the device is alive, also below, and every device can draw into the formats of `Target`.
        self.raw = unsafe { device.create_image(&info, None) }?;

        // Memory of the first type that fits, as device-local ones come first where they are.
        // SAFETY: the image is alive.
        let needs = unsafe { device.get_image_memory_requirements(self.raw) };
        let local = vk::MemoryPropertyFlags::DEVICE_LOCAL;
        let kinds = &self.gpu.memory.memory_types_as_slice();
        let memory_type = (0_u32..)
            .zip(*kinds)
            .filter(|(i, _)| needs.memory_type_bits & (1 << i) != 0)
            .max_by_key(|(i, kind)| (kind.property_flags.contains(local), std::cmp::Reverse(*i)))
            .ok_or(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY)?
            .0;
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(needs.size)
            .memory_type_index(memory_type);
        // SAFETY: the memory type exists.
        self.memory = unsafe { device.allocate_memory(&info, None) }?;
        // SAFETY: both are fresh, and the memory has the type and the size that the image needs.
        unsafe { device.bind_image_memory(self.raw, self.memory, 0) }?;

        // All of it.
        let whole = vk::ImageSubresourceRange::default()
            .aspect_mask(kind.aspect)
            .level_count(1)
            .layer_count(1);
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(kind.format)
            .subresource_range(whole);
        // SAFETY: the image is alive, has its memory and this format.
        self.view = unsafe { device.create_image_view(&info, None) }?;
        Ok(())
    }
}

impl Drop for Image<'_> {
    fn drop(&mut self) {
        let device = &self.gpu.device;
        // SAFETY: no submission is under way (`run` waits), the framebuffer of it is gone (`Target` drops it
        // first), and the handles are this image's, or null.
        unsafe {
            device.destroy_image_view(self.view, None);
            device.destroy_image(self.raw, None);
            device.free_memory(self.memory, None);
        }
    }
}
