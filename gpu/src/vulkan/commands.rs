//! What a submission does.

use std::fmt;
use std::ops::Range;

use ash::vk;

use super::buffer::Buffer;
use super::draws::Draws;
use super::geometry::Geometry;
use super::gpu::Gpu;
use super::pipeline::Pipeline;
use super::queries::{Statistics, Timestamps};
use super::target::Target;
use crate::draw::Topology;

/// Commands that are being recorded. What they name is borrowed for `'c`, until they have run.
pub struct Commands<'c> {
    gpu: &'c Gpu,
    pub(super) raw: vk::CommandBuffer,
}

/// Inside a render pass, with one pipeline and one geometry.
pub struct Pass<'p> {
    device: &'p ash::Device,
    raw: vk::CommandBuffer,
    layout: vk::PipelineLayout,
    gpu: &'p Gpu,
    geometry: &'p Geometry<'p>,
}

/// Timestamps that are ready to be written, in turn.
#[derive(Debug)]
pub struct Stamps {
    pool: vk::QueryPool,
    count: u32,
    written: u32,
}

impl<'c> Commands<'c> {
    pub(super) fn new(gpu: &'c Gpu, raw: vk::CommandBuffer) -> Self {
        Self { gpu, raw }
    }

    /// Sets a buffer to zeros.
    ///
    /// # Panics
    /// Like all of these methods: if something is of another [`Gpu`].
    pub fn fill_with_zeros(&mut self, buffer: &'c Buffer<'c>) {
        self.check(buffer.gpu);
        let device = &self.gpu.device;
        // SAFETY: commands are being recorded outside a pass, here and below: a pass keeps `self`
        // borrowed. The buffer is this device's and lives until they have run.
        unsafe { device.cmd_fill_buffer(self.raw, buffer.raw, 0, vk::WHOLE_SIZE, 0) }
        self.wait();
    }

    /// Copies the first words of a buffer.
    ///
    /// # Panics
    /// If one of them has fewer words.
    pub fn copy(&mut self, from: &'c Buffer<'c>, to: &'c Buffer<'c>, words: usize) {
        self.check(from.gpu);
        self.check(to.gpu);
        assert!(words <= from.words() && words <= to.words());
        if words == 0 {
            return;
        }
        let regions = [vk::BufferCopy::default().size(words as u64 * 4)];
        let device = &self.gpu.device;
        // SAFETY: as above; the region is inside both.
        unsafe { device.cmd_copy_buffer(self.raw, from.raw, to.raw, &regions) }
        self.wait();
    }

    /// Copies the words of a frame to a buffer, and how deep each pixel is to another.
    ///
    /// # Panics
    /// If the target is not a frame, or a buffer has too few words.
    pub(crate) fn copy_frame(
        &mut self,
        target: &'c Target<'c>,
        words: &'c Buffer<'c>,
        depths: &'c Buffer<'c>,
    ) {
        self.check(target.gpu);
        let depth = target.depth.as_ref().expect("a frame");
        let pixels = target.side() as usize * target.side() as usize;
        assert!(2 * pixels <= words.words() && pixels <= depths.words());
        let copies = [
            (&target.colour, words, vk::ImageAspectFlags::COLOR),
            (depth, depths, vk::ImageAspectFlags::DEPTH),
        ];
        for (image, buffer, aspect) in copies {
            self.check(buffer.gpu);
            let layers = vk::ImageSubresourceLayers::default()
                .aspect_mask(aspect)
                .layer_count(1);
            let extent = vk::Extent3D {
                width: target.side(),
                height: target.side(),
                depth: 1,
            };
            let regions = [vk::BufferImageCopy::default()
                .image_subresource(layers)
                .image_extent(extent)];
            let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
            // SAFETY: as above; a pass has left the image in this layout, as `Frames` only reads what it has
            // drawn, and the buffer has room for all pixels.
            unsafe {
                self.gpu
                    .device
                    .cmd_copy_image_to_buffer(self.raw, image.raw, layout, buffer.raw, &regions);
            }
        }
        self.wait();
    }

    /// Makes all that follows wait for all that came before.
    fn wait(&mut self) {
        let memory = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
            .dst_access_mask(
                vk::AccessFlags::MEMORY_READ
                    | vk::AccessFlags::MEMORY_WRITE
                    | vk::AccessFlags::HOST_READ,
            )];
        let all = vk::PipelineStageFlags::ALL_COMMANDS;
        // SAFETY: as above.
        unsafe {
            self.gpu.device.cmd_pipeline_barrier(
                self.raw,
                all,
                all | vk::PipelineStageFlags::HOST,
                vk::DependencyFlags::empty(),
                &memory,
                &[],
                &[],
            );
        }
    }

    /// Draws a geometry inside a pass of its own; nothing overlaps with it.
    ///
    /// # Panics
    /// If the pipeline is for other primitives, or takes positions and there are none.
    pub fn pass(
        &mut self,
        target: &'c Target<'c>,
        pipeline: &'c Pipeline<'c>,
        geometry: &'c Geometry<'c>,
        draw: impl FnOnce(&mut Pass<'c>),
    ) {
        // Whether they fit each other.
        self.check(target.gpu);
        self.check(pipeline.gpu);
        self.check(geometry.indices.gpu);
        let settings = &pipeline.settings;
        assert_eq!(settings.solid, target.depth.is_some());
        assert_eq!(pipeline.side, target.side());
        assert_eq!(settings.topology, geometry.topology);
        assert_eq!(settings.restart, geometry.restart);
        assert!(!settings.positions || geometry.positions.is_some());

        // All that a draw needs.
        let device = &self.gpu.device;
        let side = target.side();
        let area = vk::Rect2D::default().extent(vk::Extent2D {
            width: side,
            height: side,
        });
        let nothing = vk::ClearColorValue {
            uint32: [Target::NOTHING; 4],
        };
        let farthest = vk::ClearDepthStencilValue {
            depth: 1.0,
            stencil: 0,
        };
        let clear = [
            vk::ClearValue { color: nothing },
            vk::ClearValue {
                depth_stencil: farthest,
            },
        ];
        let begin = vk::RenderPassBeginInfo::default()
            .clear_values(&clear)
            .render_pass(target.pass)
            .framebuffer(target.framebuffer)
            .render_area(area);
        let (set, layout) = (pipeline.layout.set, pipeline.layout.raw);
        let width = match geometry.short {
            true => vk::IndexType::UINT16,
            false => vk::IndexType::UINT32,
        };
        let graphics = vk::PipelineBindPoint::GRAPHICS;
        // SAFETY: commands are being recorded outside a pass; all that is named is this device's and
        // lives until they have run.
        unsafe {
            device.cmd_begin_render_pass(self.raw, &begin, vk::SubpassContents::INLINE);
            device.cmd_bind_pipeline(self.raw, graphics, pipeline.raw);
            device.cmd_bind_descriptor_sets(self.raw, graphics, layout, 0, &[set], &[]);
            device.cmd_bind_index_buffer(self.raw, geometry.indices.raw, 0, width);
            if let Some(positions) = &geometry.positions {
                device.cmd_bind_vertex_buffers(self.raw, 0, &[positions.raw], &[0]);
            }
        }

        draw(&mut Pass {
            device,
            raw: self.raw,
            layout,
            gpu: self.gpu,
            geometry,
        });
        // SAFETY: the pass was begun above.
        unsafe { device.cmd_end_render_pass(self.raw) }
    }

    /// Counts what the commands do that `record` records.
    pub fn counted(
        &mut self,
        statistics: Option<&'c Statistics<'c>>,
        record: impl FnOnce(&mut Self),
    ) {
        let Some(statistics) = statistics else {
            return record(self);
        };
        self.check(statistics.gpu());
        let (raw, pool) = (self.raw, statistics.raw());
        let device = &self.gpu.device;
        let flags = vk::QueryControlFlags::empty();
        // SAFETY: outside a pass; the query is this device's and not in use.
        unsafe {
            device.cmd_reset_query_pool(raw, pool, 0, 1);
            device.cmd_begin_query(raw, pool, 0, flags);
        }
        record(self);
        // SAFETY: it was begun above, outside a pass too.
        unsafe { self.gpu.device.cmd_end_query(raw, pool, 0) }
    }

    /// Makes timestamps ready to be written.
    pub fn stamps(&mut self, timestamps: &'c Timestamps<'c>) -> Stamps {
        self.check(timestamps.gpu());
        let (pool, count) = (timestamps.raw(), timestamps.count());
        // SAFETY: outside a pass; the pool is this device's and not in use.
        unsafe {
            self.gpu
                .device
                .cmd_reset_query_pool(self.raw, pool, 0, count)
        }
        Stamps {
            pool,
            count,
            written: 0,
        }
    }

    /// Writes the next timestamp once all that came before is done.
    ///
    /// # Panics
    /// If all are written.
    pub fn stamp(&mut self, stamps: &mut Stamps) {
        assert!(stamps.written < stamps.count);
        let stage = vk::PipelineStageFlags::BOTTOM_OF_PIPE;
        let device = &self.gpu.device;
        // SAFETY: the query exists, was reset when `stamps` were made, and is written once.
        unsafe { device.cmd_write_timestamp(self.raw, stage, stamps.pool, stamps.written) }
        stamps.written += 1;
    }

    /// Whether this is the card that the commands are for.
    fn check(&self, gpu: &Gpu) {
        assert!(std::ptr::eq(self.gpu, gpu), "made on another card");
    }
}

impl Pass<'_> {
    /// Draws once, with these four floats for the shader: what is added to positions, and what they are
    /// multiplied by.
    pub fn draw(&mut self, place: [f32; 4]) {
        let mut bytes = [0; 16];
        for (to, from) in bytes.chunks_exact_mut(4).zip(place) {
            to.copy_from_slice(&from.to_ne_bytes());
        }
        let stage = vk::ShaderStageFlags::VERTEX;
        let geometry = self.geometry;
        // SAFETY: a pipeline with this layout and the geometry's buffers are bound; a `Geometry` holds
        // all its indices and every vertex that these name.
        unsafe {
            let (device, raw) = (self.device, self.raw);
            device.cmd_push_constants(raw, self.layout, stage, 0, &bytes);
            let (count, instances) = (geometry.count, geometry.instances);
            device.cmd_draw_indexed(raw, count, instances, 0, geometry.vertex_offset, 0);
        }
    }
}

impl<'p> Pass<'p> {
    /// Draws some of the draws whose arguments are on the card, by one call, with a matrix for the shader, its
    /// columns one after the other.
    ///
    /// # Panics
    /// If there are fewer draws, the geometry has fewer indices than they need or is not a plain list, or the card does
    /// not take as many at once.
    pub fn draw_ranges(&mut self, view: &[f32; 16], draws: &'p Draws<'p>, which: Range<u32>) {
        // Whether they fit.
        let geometry = self.geometry;
        assert!(std::ptr::eq(self.gpu, draws.buffer.gpu));
        assert!(which.start <= which.end && which.end <= draws.count);
        assert!(draws.needs <= geometry.count);
        assert_eq!(geometry.topology, Topology::TriangleList);
        assert!(geometry.vertex_offset == 0 && geometry.instances == 1);
        let count = which.end - which.start;
        assert!(count <= self.gpu.most_draws());
        if count == 0 {
            return;
        }

        let mut bytes = [0; 64];
        for (to, from) in bytes.chunks_exact_mut(4).zip(view) {
            to.copy_from_slice(&from.to_ne_bytes());
        }
        let stage = vk::ShaderStageFlags::VERTEX;
        let stride = 4 * Draws::WORDS;
        let offset = u64::from(which.start) * u64::from(stride);
        // SAFETY: as in `draw`; the arguments are those that were checked, and lie inside the buffer, which lives
        // until the commands have run.
        unsafe {
            let (device, raw) = (self.device, self.raw);
            device.cmd_push_constants(raw, self.layout, stage, 0, &bytes);
            device.cmd_draw_indexed_indirect(raw, draws.buffer.raw, offset, count, stride);
        }
    }
}

impl fmt::Debug for Commands<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Commands").finish_non_exhaustive()
    }
}

impl fmt::Debug for Pass<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Pass").finish_non_exhaustive()
    }
}
