//! Draws whose arguments are in the card's memory.

use super::buffer::Buffer;
use super::gpu::Gpu;
use crate::error::GpuError;

/// Draws of ranges of faces, one instance each; one call draws as many of them as follow each other.
#[derive(Debug)]
pub struct Draws<'g> {
    pub(super) buffer: Buffer<'g>,
    pub(super) count: u32,
    /// The most indices that a geometry must have for them.
    pub(super) needs: u32,
}

impl<'g> Draws<'g> {
    /// Words of a draw.
    pub(super) const WORDS: u32 = 5;

    /// Copies draws to the card: the number of indices, of instances, the first index, what is added to each
    /// index, the first instance.
    ///
    /// # Errors
    /// If one of them is of several instances or adds to indices, or if the card has too little memory or cannot
    /// draw so.
    pub fn new(gpu: &'g Gpu, draws: &[[u32; 5]]) -> Result<Self, GpuError> {
        if !gpu.draws_frames() {
            return Err(GpuError::Missing {
                card: gpu.card().to_string(),
                what: "way to draw several ranges by one call and say which is seen (multiDrawIndirect, \
                       shaderDrawParameters, geometryShader)",
            });
        }
        let mut needs = 0;
        for (at, &[count, instances, first, offset, instance]) in draws.iter().enumerate() {
            let end = first.checked_add(count);
            let Some(end) = end.filter(|_| [instances, offset, instance] == [1, 0, 0]) else {
                return Err(GpuError::input(format!(
                    "draw {at} is not a range of faces of one instance"
                )));
            };
            needs = needs.max(end);
        }
        let count = u32::try_from(draws.len()).map_err(|_| GpuError::input("too many draws"))?;
        Ok(Self {
            buffer: Buffer::of(gpu, draws.as_flattened())?,
            count,
            needs,
        })
    }
}
