//! What is known of how a card counts.

use std::fmt;

use ash::vk;
use meshweft::cache::nvidia;

use crate::draw::{Draw, RESTART, Topology};
use crate::lavapipe;
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
    /// Vertices that each batch uses, added up, if there are batches.
    pub distinct_vertices: Option<u64>,
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
                let counts = nvidia::Draw {
                    topology: match draw.topology {
                        Topology::TriangleList => nvidia::PrimitiveTopology::TriangleList,
                        Topology::TriangleStrip => nvidia::PrimitiveTopology::TriangleStrip,
                        Topology::TriangleFan => nvidia::PrimitiveTopology::TriangleFan,
                    },
                    indices: draw.indices,
                    restart: draw.restart.then_some(RESTART),
                    vertex_offset: draw.vertex_offset,
                    instances: draw.instances,
                    reads_instance: draw.reads_instance,
                }
                .counts();
                Some(Prediction {
                    invocations: counts.invocations,
                    warps: Some(counts.warps),
                    distinct_vertices: Some(counts.distinct_vertices),
                    cycles: Some(counts.setup_cycles),
                })
            }
            Self::Lavapipe => {
                let is_list = draw.topology == Topology::TriangleList && !draw.restart;
                is_list.then(|| Prediction {
                    invocations: u64::from(draw.instances)
                        * lavapipe::invocations(draw.indices, draw.vertex_offset),
                    warps: None,
                    distinct_vertices: None,
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
