//! How long a cycle of primitive setup takes, by a draw whose cycles are known.

use crate::draw::Draw;
use crate::error::GpuError;
use crate::renderer::{Renderer, Sampling};
use crate::vulkan::Geometry;
use crate::workload::Workload;

/// Faces of a batch.
pub(crate) const FACES: u32 = 32;
/// Batches of a draw: 131,072 faces.
pub(crate) const BATCHES: u32 = 4096;
/// Vertices of a draw: one block, so that nothing is forgotten where numbers come round.
const VERTICES: u32 = 1 << 16;
/// Cycles of a batch of one face drawn 32 times.
const CYCLES: f64 = 35.0;

const SAMPLING: Sampling = Sampling {
    samples: 30,
    draws: 6,
};

/// The draw that other draws are compared with: one face, drawn 32 times a batch.
#[derive(Debug)]
pub(crate) struct Clock<'r, 'g> {
    renderer: &'r Renderer<'g>,
    unit: Geometry<'g>,
}

impl<'r, 'g> Clock<'r, 'g> {
    /// A clock on a card that is warm.
    pub(crate) fn new(renderer: &'r Renderer<'g>) -> Result<Self, GpuError> {
        let unit = upload(renderer, &[0, 1, 2].repeat(FACES as usize))?;
        renderer.warm_up(&unit, SAMPLING)?;
        Ok(Self { renderer, unit })
    }

    /// Nanoseconds of a cycle, if the card sets up faces as NVIDIA cards do.
    pub(crate) fn cycle(&self) -> Result<f64, GpuError> {
        let ns = self.renderer.time(&self.unit, Workload::Setup, SAMPLING)?;
        Ok(ns / f64::from(BATCHES) / CYCLES)
    }

    /// Cycles of a batch of 32 faces, which is drawn again and again with vertices of its own.
    pub(crate) fn cycles(&self, batch: &[u32]) -> Result<f64, GpuError> {
        let geometry = upload(self.renderer, batch)?;
        // The unit before and after, so that a change of clocks cancels out.
        let before = self.cycle()?;
        let ns = self.renderer.time(&geometry, Workload::Setup, SAMPLING)?;
        let cycle = (before + self.cycle()?) / 2.0;
        Ok(ns / f64::from(BATCHES) / cycle)
    }
}

/// The draw that repeats a batch.
fn upload<'g>(renderer: &Renderer<'g>, batch: &[u32]) -> Result<Geometry<'g>, GpuError> {
    let positions = vec![[0.0; 3]; VERTICES as usize];
    renderer.upload(&Draw {
        positions: Some(&positions),
        ..Draw::list(&repeated(batch))
    })
}

/// The indices of a batch, again and again with other vertices.
pub(crate) fn repeated(batch: &[u32]) -> Vec<u32> {
    let step = batch.iter().max().map_or(1, |most| most + 1);
    let starts = (0..BATCHES).map(|number| number * step % (VERTICES - step));
    let indices = starts.flat_map(|start| batch.iter().map(move |index| start + index));
    indices.collect()
}
