//! What the card counts and times by itself.

use std::fmt;

use ash::vk;

use super::gpu::Gpu;
use crate::error::GpuError;

/// A pool of queries of one kind.
struct Pool<'g> {
    gpu: &'g Gpu,
    raw: vk::QueryPool,
    count: u32,
}

impl<'g> Pool<'g> {
    fn new(gpu: &'g Gpu, info: &vk::QueryPoolCreateInfo<'_>) -> Result<Self, GpuError> {
        // SAFETY: the device is alive, and the callers below ask only for what it has.
        let raw = unsafe { gpu.device.create_query_pool(info, None) }
            .map_err(GpuError::when("preparing queries"))?;
        Ok(Self {
            gpu,
            raw,
            count: info.query_count,
        })
    }

    fn results(&self) -> Result<Vec<u64>, GpuError> {
        let mut results = vec![0_u64; self.count as usize];
        // Without waiting: `run` has waited, and what was not written never will be.
        let flags = vk::QueryResultFlags::TYPE_64;
        // SAFETY: the pool is alive, and `results` has a word for each of its queries.
        unsafe {
            let device = &self.gpu.device;
            device.get_query_pool_results(self.raw, 0, &mut results, flags)
        }
        .map_err(GpuError::when("reading queries"))?;
        Ok(results)
    }
}

impl Drop for Pool<'_> {
    fn drop(&mut self) {
        // SAFETY: no submission is under way: `run` waits.
        unsafe { self.gpu.device.destroy_query_pool(self.raw, None) }
    }
}

/// Counts the invocations of the vertex shader.
pub struct Statistics<'g>(Pool<'g>);

impl<'g> Statistics<'g> {
    /// One query; `None` if the card has none.
    ///
    /// # Errors
    /// If the card has too little memory.
    pub fn new(gpu: &'g Gpu) -> Result<Option<Self>, GpuError> {
        if !gpu.has_statistics() {
            return Ok(None);
        }
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::PIPELINE_STATISTICS)
            .pipeline_statistics(vk::QueryPipelineStatisticFlags::VERTEX_SHADER_INVOCATIONS)
            .query_count(1);
        Ok(Some(Self(Pool::new(gpu, &info)?)))
    }

    /// What it counted in the commands that ran.
    ///
    /// # Errors
    /// If no commands with it ran, or the card was lost.
    pub fn invocations(&self) -> Result<u64, GpuError> {
        Ok(self.0.results()?[0])
    }

    pub(super) fn raw(&self) -> vk::QueryPool {
        self.0.raw
    }

    pub(super) fn gpu(&self) -> &'g Gpu {
        self.0.gpu
    }
}

/// Timestamps.
pub struct Timestamps<'g>(Pool<'g>);

impl<'g> Timestamps<'g> {
    /// So many timestamps.
    ///
    /// # Errors
    /// If the card has none, or too little memory.
    pub fn new(gpu: &'g Gpu, count: u32) -> Result<Self, GpuError> {
        if !gpu.has_timestamps() {
            return Err(GpuError::Missing {
                card: gpu.card().to_string(),
                what: "timestamps",
            });
        }
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::TIMESTAMP)
            .query_count(count.max(1));
        Ok(Self(Pool::new(gpu, &info)?))
    }

    /// The nanoseconds between each two timestamps of the commands that ran: first and second, third
    /// and fourth.
    ///
    /// # Errors
    /// If not all were written, or the card was lost.
    pub fn spans(&self) -> Result<Vec<f64>, GpuError> {
        let ticks = self.0.results()?;
        let span = |pair: &[u64]| self.0.gpu.nanoseconds(pair[0], pair[1]);
        Ok(ticks.chunks_exact(2).map(span).collect())
    }

    pub(super) fn raw(&self) -> vk::QueryPool {
        self.0.raw
    }

    pub(super) fn gpu(&self) -> &'g Gpu {
        self.0.gpu
    }

    /// How many there are.
    pub(super) fn count(&self) -> u32 {
        self.0.count
    }
}

impl fmt::Debug for Statistics<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Statistics").finish()
    }
}

impl fmt::Debug for Timestamps<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Timestamps").field(&self.0.count).finish()
    }
}
