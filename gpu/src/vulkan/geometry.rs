//! A draw in the card's memory.

use std::fmt;

use super::buffer::Buffer;
use super::gpu::Gpu;
use crate::draw::{Draw, RESTART, Topology};
use crate::error::GpuError;

/// The most corners that one draw of it may have, over all instances: what a card does in seconds.
const MOST_CORNERS: u64 = 1 << 31;

/// The indices and positions of a [`Draw`], checked: every vertex that it names is there.
pub struct Geometry<'g> {
    pub(super) indices: Buffer<'g>,
    pub(super) positions: Option<Buffer<'g>>,
    pub(super) short: bool,
    pub(super) topology: Topology,
    pub(super) restart: bool,
    pub(super) count: u32,
    pub(super) vertex_offset: i32,
    pub(super) instances: u32,
}

impl<'g> Geometry<'g> {
    /// Copies a draw to the card.
    ///
    /// # Errors
    /// If an index is past what the card draws or past the last position, if it draws too much at
    /// once, or if the card has too little memory.
    pub fn new(gpu: &'g Gpu, draw: &Draw<'_>) -> Result<Self, GpuError> {
        // Whether it can be drawn.
        let corners = draw.indices.len() as u64 * u64::from(draw.instances);
        if corners > MOST_CORNERS {
            return Err(GpuError::input(format!(
                "a draw of {corners} corners; at most {MOST_CORNERS} are drawn at once"
            )));
        }
        let count = u32::try_from(draw.indices.len()).expect("checked just now");
        check(gpu, draw)?;

        // On the card.
        let indices = match draw.short {
            false => Buffer::of(gpu, draw.indices)?,
            true => Buffer::of(gpu, &pairs(draw.indices))?,
        };
        let positions = draw.positions.map(|positions| {
            let words: Vec<u32> = positions
                .as_flattened()
                .iter()
                .map(|x| x.to_bits())
                .collect();
            Buffer::of(gpu, &words)
        });
        Ok(Self {
            indices,
            positions: positions.transpose()?,
            short: draw.short,
            topology: draw.topology,
            restart: draw.restart,
            count,
            vertex_offset: draw.vertex_offset,
            instances: draw.instances,
        })
    }

    /// How its indices become primitives.
    #[must_use]
    pub fn topology(&self) -> Topology {
        self.topology
    }

    /// Whether the largest index starts a new strip or fan.
    #[must_use]
    pub fn restart(&self) -> bool {
        self.restart
    }

    /// How many indices it has, over all instances.
    #[must_use]
    pub fn corners(&self) -> u64 {
        u64::from(self.count) * u64::from(self.instances)
    }
}

/// Whether every index is in range.
fn check(gpu: &Gpu, draw: &Draw<'_>) -> Result<(), GpuError> {
    for (at, &index) in draw.indices.iter().enumerate() {
        if draw.restart && index == RESTART {
            continue;
        }
        let vertex = i64::from(index) + i64::from(draw.vertex_offset);
        let wrong = |what: String| {
            Err(GpuError::input(format!(
                "index {at} of a draw is {index}: {what}"
            )))
        };
        if index > gpu.largest_index() || vertex > i64::from(u32::MAX) {
            return wrong(format!("this card draws up to {}", gpu.largest_index()));
        }
        if vertex < 0 {
            return wrong(format!("with {} added it is negative", draw.vertex_offset));
        }
        if draw.short && index > u32::from(u16::MAX) {
            return wrong("it has more than 16 bits".to_owned());
        }
        if draw
            .positions
            .is_some_and(|positions| vertex >= positions.len() as i64)
        {
            return wrong("it is past the last position".to_owned());
        }
    }
    Ok(())
}

/// Indices of 16 bits, two a word; [`RESTART`] becomes the largest of 16 bits.
fn pairs(indices: &[u32]) -> Vec<u32> {
    let bytes = |&index: &u32| {
        let [a, b, ..] = index.to_le_bytes();
        u16::from_le_bytes([a, b]).to_ne_bytes()
    };
    indices
        .chunks(2)
        .map(|pair| {
            let [a, b] = bytes(&pair[0]);
            let [c, d] = pair.get(1).map_or([0; 2], bytes);
            u32::from_ne_bytes([a, b, c, d])
        })
        .collect()
}

impl fmt::Debug for Geometry<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Geometry")
            .field("count", &self.count)
            .field("topology", &self.topology)
            .finish_non_exhaustive()
    }
}
