//! Shaders and fixed state.

use std::fmt;
use std::io::Cursor;
use std::rc::Rc;

use ash::vk;

use super::gpu::Gpu;
use super::layout::Layout;
use super::target::Target;
use crate::draw::Topology;
use crate::error::GpuError;

/// What a pipeline is made of; shaders are SPIR-V.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// The vertex shader.
    pub vertex: &'static [u8],
    /// The fragment shader. Without one, everything is discarded before it becomes pixels.
    pub fragment: Option<&'static [u8]>,
    /// Whether the vertex shader is given positions, three floats each.
    pub positions: bool,
    /// How indices become primitives.
    pub topology: Topology,
    /// Whether the largest index starts a new strip or fan.
    pub restart: bool,
    /// Whether only front faces are drawn, corners turning left, and of them what is nearest: into a
    /// [`Target::frame`].
    pub solid: bool,
}

/// A pipeline that draws into a [`Target`].
pub struct Pipeline<'g> {
    pub(super) gpu: &'g Gpu,
    pub(super) layout: Rc<Layout<'g>>,
    pub(super) raw: vk::Pipeline,
    pub(super) settings: Settings,
    /// Of the target.
    pub(super) side: u32,
}

impl<'g> Pipeline<'g> {
    /// A pipeline of these settings.
    ///
    /// # Errors
    /// If the driver cannot compile a shader.
    ///
    /// # Panics
    /// If the target is a frame and the settings are not for one, or the other way round.
    pub fn new(
        gpu: &'g Gpu,
        layout: &Rc<Layout<'g>>,
        target: &Target<'g>,
        settings: &Settings,
    ) -> Result<Self, GpuError> {
        assert_eq!(settings.solid, target.depth.is_some());

        // Shaders.
        let vertex = Shader::new(gpu, settings.vertex)?;
        let fragment = settings
            .fragment
            .map(|code| Shader::new(gpu, code))
            .transpose()?;
        let mut stages = vec![vertex.stage(vk::ShaderStageFlags::VERTEX)];
        stages.extend(
            fragment
                .iter()
                .map(|f| f.stage(vk::ShaderStageFlags::FRAGMENT)),
        );

        // Vertices and primitives.
        let bindings = [vk::VertexInputBindingDescription::default().stride(12)];
        let attributes =
            [vk::VertexInputAttributeDescription::default().format(vk::Format::R32G32B32_SFLOAT)];
        let mut input = vk::PipelineVertexInputStateCreateInfo::default();
        if settings.positions {
            input = input
                .vertex_binding_descriptions(&bindings)
                .vertex_attribute_descriptions(&attributes);
        }
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(settings.topology.raw())
            .primitive_restart_enable(settings.restart);

        // Pixels.
        let side = target.side();
        let viewports = [vk::Viewport::default()
            .width(side as f32)
            .height(side as f32)
            .max_depth(1.0)];
        let scissors = [vk::Rect2D::default().extent(vk::Extent2D {
            width: side,
            height: side,
        })];
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewports(&viewports)
            .scissors(&scissors);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default()
            .rasterizer_discard_enable(settings.fragment.is_none())
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(match settings.solid {
                true => vk::CullModeFlags::BACK,
                false => vk::CullModeFlags::NONE,
            })
            .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
            .line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(settings.solid)
            .depth_write_enable(settings.solid)
            .depth_compare_op(vk::CompareOp::LESS);
        let colours = [vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA)];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&colours);

        // All together.
        let infos = [vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .layout(layout.raw)
            .render_pass(target.pass)];
        // SAFETY: the device, the layout, the pass and the shaders are alive; the shaders use what the
        // layout and the vertex input have.
        let made = unsafe {
            let cache = vk::PipelineCache::null();
            gpu.device.create_graphics_pipelines(cache, &infos, None)
        };
        let raw = made.map_err(|(_, result)| GpuError::when("compiling a shader")(result))?[0];
        Ok(Self {
            gpu,
            layout: Rc::clone(layout),
            raw,
            settings: *settings,
            side,
        })
    }
}

impl Drop for Pipeline<'_> {
    fn drop(&mut self) {
        // SAFETY: no submission is under way: `run` waits.
        unsafe { self.gpu.device.destroy_pipeline(self.raw, None) }
    }
}

impl fmt::Debug for Pipeline<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Pipeline")
            .field("settings", &self.settings)
            .finish_non_exhaustive()
    }
}

/// A shader, needed until its pipeline is made.
struct Shader<'g> {
    gpu: &'g Gpu,
    raw: vk::ShaderModule,
}

impl<'g> Shader<'g> {
    fn new(gpu: &'g Gpu, code: &[u8]) -> Result<Self, GpuError> {
        let words = ash::util::read_spv(&mut Cursor::new(code))
            .map_err(|error| GpuError::input(format!("a shader is damaged: {error}")))?;
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: the device is alive, and the code is SPIR-V that was validated when it was made.
        let raw = unsafe { gpu.device.create_shader_module(&info, None) }
            .map_err(GpuError::when("loading a shader"))?;
        Ok(Self { gpu, raw })
    }

    fn stage(&self, stage: vk::ShaderStageFlags) -> vk::PipelineShaderStageCreateInfo<'_> {
        vk::PipelineShaderStageCreateInfo::default()
            .stage(stage)
            .module(self.raw)
            .name(c"main")
    }
}

impl Drop for Shader<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines do not need it once they are made.
        unsafe { self.gpu.device.destroy_shader_module(self.raw, None) }
    }
}
