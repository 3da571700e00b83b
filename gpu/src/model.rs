//! What is known of how a card counts.

use std::fmt;

use ash::vk;

use crate::batch_rule::BatchRule;
use crate::draw::{Draw, Topology};
use crate::lavapipe;
use crate::setup;
use crate::vulkan::Card;

/// A model of vertex reuse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Model {
    /// Batches as NVIDIA cards make them.
    Nvidia,
    /// Mesa's software renderer.
    Lavapipe,
}

/// What a model says of one draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Prediction {
    /// Invocations of the vertex shader.
    pub invocations: u64,
    /// Batches, each of which is a warp, if there are any.
    pub warps: Option<u64>,
    /// Cycles of primitive setup, if it is known.
    pub cycles: Option<u64>,
}

impl Model {
    /// The model of a card, or the NVIDIA model to compare with, and whether it is that card's.
    #[must_use]
    pub fn of(card: &Card) -> (Self, bool) {
        match card.driver_id {
            vk::DriverId::NVIDIA_PROPRIETARY => (Self::Nvidia, true),
            vk::DriverId::MESA_LLVMPIPE => (Self::Lavapipe, true),
            _ => (Self::Nvidia, false),
        }
    }

    /// What it says of a draw; nothing of what it does not know.
    #[must_use]
    pub fn predict(self, draw: &Draw<'_>) -> Option<Prediction> {
        match self {
            Self::Nvidia => {
                let batches = BatchRule::NVIDIA.batches(draw);
                let lanes: usize = batches.iter().map(|batch| batch.vertices.len()).sum();
                let cycles = batches.iter().map(|batch| setup::cycles(&batch.faces));
                Some(Prediction {
                    invocations: lanes as u64,
                    warps: Some(batches.len() as u64),
                    cycles: Some(cycles.sum()),
                })
            }
            Self::Lavapipe => {
                let is_list = draw.topology == Topology::TriangleList && !draw.restart;
                is_list.then(|| Prediction {
                    invocations: u64::from(draw.instances)
                        * lavapipe::invocations(draw.indices, draw.vertex_offset),
                    warps: None,
                    cycles: None,
                })
            }
        }
    }
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Nvidia => "NVIDIA batches",
            Self::Lavapipe => "lavapipe's segments",
        })
    }
}
