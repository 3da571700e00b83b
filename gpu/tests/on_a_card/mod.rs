//! Tests on the first card.
//!
//! Where there is no Vulkan driver these tests say so and do nothing; with `MESHWEFT_REQUIRE_VULKAN` set
//! that is a failure.

use std::io::Write;

use gpu::error::GpuError;
use gpu::renderer::Renderer;
use gpu::vulkan::Gpu;

/// Runs `test` on the first card.
pub(crate) fn on_a_card(name: &str, test: impl FnOnce(&Renderer<'_>)) {
    let gpu = match Gpu::open(None) {
        Ok(gpu) => gpu,
        Err(GpuError::NoDriver(why)) => {
            assert!(
                std::env::var_os("MESHWEFT_REQUIRE_VULKAN").is_none(),
                "no Vulkan: {why}"
            );
            // Past the test harness, which would capture it. If stderr is closed nobody reads it.
            let _ = writeln!(std::io::stderr(), "{name}: SKIPPED, no Vulkan: {why}");
            return;
        }
        Err(error) => panic!("{error}"),
    };
    test(&Renderer::new(&gpu).expect("a card that can draw"));
}
