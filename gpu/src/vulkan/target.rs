//! What is drawn into.

use std::fmt;

use ash::vk;

use super::gpu::Gpu;
use super::image::{Image, ImageKind};
use crate::error::GpuError;

/// A square picture with the render pass that draws into it: one colour that is never looked at, or a
/// [`frame`](Self::frame), which can be read back.
///
/// A pass waits for everything before it, and everything after it waits for the pass: what is timed
/// overlaps with nothing.
pub struct Target<'g> {
    pub(super) gpu: &'g Gpu,
    side: u32,
    pub(super) colour: Image<'g>,
    pub(super) depth: Option<Image<'g>>,
    pub(super) pass: vk::RenderPass,
    pub(super) framebuffer: vk::Framebuffer,
}

const COLOUR: ImageKind = ImageKind {
    format: vk::Format::R8G8B8A8_UNORM,
    usage: vk::ImageUsageFlags::COLOR_ATTACHMENT,
    aspect: vk::ImageAspectFlags::COLOR,
};
const FRAME: ImageKind = ImageKind {
    format: vk::Format::R32G32_UINT,
    usage: vk::ImageUsageFlags::from_raw(
        vk::ImageUsageFlags::COLOR_ATTACHMENT.as_raw() | vk::ImageUsageFlags::TRANSFER_SRC.as_raw(),
    ),
    aspect: vk::ImageAspectFlags::COLOR,
};
const DEPTH: ImageKind = ImageKind {
    format: vk::Format::D32_SFLOAT,
    usage: vk::ImageUsageFlags::from_raw(
        vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT.as_raw()
            | vk::ImageUsageFlags::TRANSFER_SRC.as_raw(),
    ),
    aspect: vk::ImageAspectFlags::DEPTH,
};

impl<'g> Target<'g> {
    /// Width and height in pixels of a picture that is never looked at.
    pub const SIDE: u32 = 64;
    /// Both words of a pixel of a frame where nothing was drawn.
    pub const NOTHING: u32 = u32::MAX;

    /// A picture of [`SIDE`](Self::SIDE) by `SIDE` pixels, without depth.
    ///
    /// # Errors
    /// If the card has too little memory.
    pub fn new(gpu: &'g Gpu) -> Result<Self, GpuError> {
        Self::with(gpu, Self::SIDE, COLOUR, None)
    }

    /// A picture of two words a pixel, and how deep each is; both are cleared when a pass begins.
    ///
    /// # Errors
    /// If the card has too little memory.
    pub fn frame(gpu: &'g Gpu, side: u32) -> Result<Self, GpuError> {
        Self::with(gpu, side, FRAME, Some(DEPTH))
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn side(&self) -> u32 {
        self.side
    }

    fn with(
        gpu: &'g Gpu,
        side: u32,
        colour: ImageKind,
        depth: Option<ImageKind>,
    ) -> Result<Self, GpuError> {
        let failed = || GpuError::when("preparing the picture");
        let image = |kind| Image::new(gpu, kind, side).map_err(failed());
        // What fails below is freed by `drop`, which takes null.
        let mut target = Self {
            gpu,
            side,
            colour: image(colour)?,
            depth: depth.map(image).transpose()?,
            pass: vk::RenderPass::null(),
            framebuffer: vk::Framebuffer::null(),
        };
        let formats = [Some(colour.format), depth.map(|depth| depth.format)];
        target.add_pass(&formats).map_err(failed())?;

        let images = std::iter::once(&target.colour).chain(&target.depth);
        let views: Vec<vk::ImageView> = images.map(|image| image.view).collect();
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(target.pass)
            .attachments(&views)
            .width(side)
            .height(side)
            .layers(1);
        // SAFETY: pass and views are alive and of the same formats.
        target.framebuffer =
            unsafe { gpu.device.create_framebuffer(&info, None) }.map_err(failed())?;
        Ok(target)
    }

    fn add_pass(&mut self, formats: &[Option<vk::Format>; 2]) -> Result<(), vk::Result> {
        // Pictures whose old pixels do not matter; of a frame each pass begins with empty ones.
        let (load, last) = match formats[1] {
            None => (vk::AttachmentLoadOp::DONT_CARE, None),
            Some(_) => (
                vk::AttachmentLoadOp::CLEAR,
                Some(vk::ImageLayout::TRANSFER_SRC_OPTIMAL),
            ),
        };
        let layouts = [
            vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
            vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        ];
        let attachment = |(format, layout)| {
            vk::AttachmentDescription::default()
                .format(format)
                .samples(vk::SampleCountFlags::TYPE_1)
                .load_op(load)
                .store_op(vk::AttachmentStoreOp::STORE)
                .stencil_load_op(vk::AttachmentLoadOp::DONT_CARE)
                .stencil_store_op(vk::AttachmentStoreOp::DONT_CARE)
                .initial_layout(vk::ImageLayout::UNDEFINED)
                .final_layout(last.unwrap_or(layout))
        };
        let attachments: Vec<_> = formats
            .iter()
            .flatten()
            .copied()
            .zip(layouts)
            .map(attachment)
            .collect();
        let colours = [vk::AttachmentReference::default()
            .attachment(0)
            .layout(layouts[0])];
        let depth = vk::AttachmentReference::default()
            .attachment(1)
            .layout(layouts[1]);
        let mut subpass = vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&colours);
        if formats[1].is_some() {
            subpass = subpass.depth_stencil_attachment(&depth);
        }
        let subpasses = [subpass];

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
        // once they are made, and the handles are this target's, or null. The images go after it.
        unsafe {
            device.destroy_framebuffer(self.framebuffer, None);
            device.destroy_render_pass(self.pass, None);
        }
    }
}

impl fmt::Debug for Target<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Target")
            .field("side", &self.side)
            .finish_non_exhaustive()
    }
}
