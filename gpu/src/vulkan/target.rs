//! The picture that is drawn into, and never looked at.

use std::fmt;

use ash::vk;

use super::gpu::Gpu;
use crate::error::GpuError;

/// A colour picture with the render pass that draws into it.
///
/// A pass waits for everything before it, and everything after it waits for the pass: what is timed
/// overlaps with nothing.
pub struct Target<'g> {
    pub(super) gpu: &'g Gpu,
    image: vk::Image,
    memory: vk::DeviceMemory,
    view: vk::ImageView,
    pub(super) pass: vk::RenderPass,
    pub(super) framebuffer: vk::Framebuffer,
}

impl<'g> Target<'g> {
    /// Width and height in pixels.
    pub const SIDE: u32 = 64;
    const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;

    /// A picture of [`SIDE`](Self::SIDE) by `SIDE` pixels.
    ///
    /// # Errors
    /// If the card has too little memory.
    pub fn new(gpu: &'g Gpu) -> Result<Self, GpuError> {
        let failed = || GpuError::when("preparing the picture");
        // What fails is freed by `drop`, which takes null.
        let mut target = Self {
            gpu,
            image: vk::Image::null(),
            memory: vk::DeviceMemory::null(),
            view: vk::ImageView::null(),
            pass: vk::RenderPass::null(),
            framebuffer: vk::Framebuffer::null(),
        };
        target.add_image().map_err(failed())?;
        target.add_pass().map_err(failed())?;

        let views = [target.view];
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(target.pass)
            .attachments(&views)
            .width(Self::SIDE)
            .height(Self::SIDE)
            .layers(1);
        // SAFETY: pass and view are alive and of one format.
        target.framebuffer =
            unsafe { gpu.device.create_framebuffer(&info, None) }.map_err(failed())?;
        Ok(target)
    }

    fn add_image(&mut self) -> Result<(), vk::Result> {
        let device = &self.gpu.device;

        // The image.
        let extent = vk::Extent3D {
            width: Self::SIDE,
            height: Self::SIDE,
            depth: 1,
        };
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(Self::FORMAT)
            .extent(extent)
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT);
        // SAFETY: the device is alive, also below, and every device can draw into this format.
        self.image = unsafe { device.create_image(&info, None) }?;

        // Memory of the first type that fits, as device-local ones come first where they are.
        // SAFETY: the image is alive.
        let needs = unsafe { device.get_image_memory_requirements(self.image) };
        let local = vk::MemoryPropertyFlags::DEVICE_LOCAL;
        let kinds = &self.gpu.memory.memory_types_as_slice();
        let kind = (0_u32..)
            .zip(*kinds)
            .filter(|(i, _)| needs.memory_type_bits & (1 << i) != 0)
            .max_by_key(|(i, kind)| (kind.property_flags.contains(local), std::cmp::Reverse(*i)))
            .ok_or(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY)?
            .0;
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(needs.size)
            .memory_type_index(kind);
        // SAFETY: the memory type exists.
        self.memory = unsafe { device.allocate_memory(&info, None) }?;
        // SAFETY: both are fresh, and the memory has the type and the size that the image needs.
        unsafe { device.bind_image_memory(self.image, self.memory, 0) }?;

        // All of it.
        let whole = vk::ImageSubresourceRange::default()
            .aspect_mask(vk::ImageAspectFlags::COLOR)
            .level_count(1)
            .layer_count(1);
        let info = vk::ImageViewCreateInfo::default()
            .image(self.image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(Self::FORMAT)
            .subresource_range(whole);
        // SAFETY: the image is alive, has its memory and this format.
        self.view = unsafe { device.create_image_view(&info, None) }?;
        Ok(())
    }

    fn add_pass(&mut self) -> Result<(), vk::Result> {
        // One picture, whose old pixels do not matter.
        let attachments = [vk::AttachmentDescription::default()
            .format(Self::FORMAT)
            .samples(vk::SampleCountFlags::TYPE_1)
            .load_op(vk::AttachmentLoadOp::DONT_CARE)
            .store_op(vk::AttachmentStoreOp::STORE)
            .stencil_load_op(vk::AttachmentLoadOp::DONT_CARE)
            .stencil_store_op(vk::AttachmentStoreOp::DONT_CARE)
            .initial_layout(vk::ImageLayout::UNDEFINED)
            .final_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)];
        let colours = [vk::AttachmentReference::default()
            .attachment(0)
            .layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)];
        let subpasses = [vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&colours)];

        // After everything before it, before everything after it.
        let all = vk::PipelineStageFlags::ALL_COMMANDS;
        let inside = vk::PipelineStageFlags::ALL_GRAPHICS;
        let memory = vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE;
        let wait = |from, to, before, after| {
            vk::SubpassDependency::default()
                .src_subpass(from)
                .dst_subpass(to)
                .src_stage_mask(before)
                .dst_stage_mask(after)
                .src_access_mask(memory)
                .dst_access_mask(memory)
        };
        let waits = [
            wait(vk::SUBPASS_EXTERNAL, 0, all, inside),
            wait(0, vk::SUBPASS_EXTERNAL, inside, all),
        ];

        let info = vk::RenderPassCreateInfo::default()
            .attachments(&attachments)
            .subpasses(&subpasses)
            .dependencies(&waits);
        // SAFETY: the device is alive; `info` and what it points to live until the call returns.
        self.pass = unsafe { self.gpu.device.create_render_pass(&info, None) }?;
        Ok(())
    }
}

impl Drop for Target<'_> {
    fn drop(&mut self) {
        let device = &self.gpu.device;
        // SAFETY: no submission is under way (`run` waits), pipelines do not need the pass any more
        // once they are made, and the handles are this target's, or null.
        unsafe {
            device.destroy_framebuffer(self.framebuffer, None);
            device.destroy_render_pass(self.pass, None);
            device.destroy_image_view(self.view, None);
            device.destroy_image(self.image, None);
            device.free_memory(self.memory, None);
        }
    }
}

impl fmt::Debug for Target<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Target").finish_non_exhaustive()
    }
}
