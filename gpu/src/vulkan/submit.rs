//! Commands recorded, run once, and waited for.

use ash::vk;

use super::commands::Commands;
use super::gpu::Gpu;
use crate::error::GpuError;

/// How long a submission may take, in nanoseconds: longer than any draw, shorter than forever.
const LONGEST: u64 = 100_000_000_000;

impl Gpu {
    /// Records commands, runs them, and waits until they are done.
    ///
    /// # Errors
    /// If the card runs out of memory, stops, or does not finish.
    pub fn run<'c>(&'c self, record: impl FnOnce(&mut Commands<'c>)) -> Result<(), GpuError> {
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(self.pool)
            .command_buffer_count(1);
        // SAFETY: the pool is this device's, and nobody else uses it: `Gpu` is not `Sync`.
        let buffers = unsafe { self.device.allocate_command_buffers(&info) }
            .map_err(GpuError::when("recording commands"))?;
        let result = self.run_in(buffers[0], record);
        // SAFETY: the commands are done, or were never started: `run_in` waits.
        unsafe { self.device.free_command_buffers(self.pool, &buffers) };
        result
    }

    fn run_in<'c>(
        &'c self,
        raw: vk::CommandBuffer,
        record: impl FnOnce(&mut Commands<'c>),
    ) -> Result<(), GpuError> {
        // Record.
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the command buffer is fresh from its pool.
        unsafe { self.device.begin_command_buffer(raw, &begin) }
            .map_err(GpuError::when("recording commands"))?;
        record(&mut Commands::new(self, raw));
        // SAFETY: it is being recorded; `Commands` leaves no pass or query open.
        unsafe { self.device.end_command_buffer(raw) }
            .map_err(GpuError::when("recording commands"))?;

        // Submit.
        // SAFETY: the device is alive.
        let fence = unsafe {
            self.device
                .create_fence(&vk::FenceCreateInfo::default(), None)
        }
        .map_err(GpuError::when("submitting commands"))?;
        let buffers = [raw];
        let submits = [vk::SubmitInfo::default().command_buffers(&buffers)];
        // SAFETY: the commands are recorded, all that they name is borrowed for `'c`, which outlasts
        // this call, and the fence is fresh.
        let submitted = unsafe { self.device.queue_submit(self.queue, &submits, fence) }
            .map_err(GpuError::when("submitting commands"));

        // Wait.
        let waited = submitted.and_then(|()| {
            // SAFETY: the fence was submitted.
            unsafe { self.device.wait_for_fences(&[fence], true, LONGEST) }
                .map_err(GpuError::when("waiting for the card"))
        });
        if waited.is_err() {
            // SAFETY: the device is alive. What it says does not matter: the error is reported.
            let _ = unsafe { self.device.device_wait_idle() };
        }
        // SAFETY: the card is done with it.
        unsafe { self.device.destroy_fence(fence, None) };
        waited
    }
}
