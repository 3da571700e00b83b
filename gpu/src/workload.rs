//! What is drawn to take a time: shaders that one limit of a card holds up each.

use std::fmt;

use crate::draw::Topology;
use crate::vulkan::Settings;

/// The shaders, as SPIR-V; `shaders/make` makes it of the GLSL beside it.
pub(crate) mod shader {
    pub(crate) const WHITE: &[u8] = include_bytes!("shaders/white.frag.spv");
    pub(super) const VARYINGS_FRAGMENT: &[u8] = include_bytes!("shaders/varyings.frag.spv");
    pub(super) const CHEAP: &[u8] = include_bytes!("shaders/cheap.vert.spv");
    pub(super) const VARYINGS: &[u8] = include_bytes!("shaders/varyings.vert.spv");
    pub(super) const COMPUTE: &[u8] = include_bytes!("shaders/compute.vert.spv");
    pub(super) const MEMORY: &[u8] = include_bytes!("shaders/memory.vert.spv");

    pub(crate) const FRAME_FRAGMENT: &[u8] = include_bytes!("shaders/frame.frag.spv");
    pub(crate) const RANGE_FRAGMENT: &[u8] = include_bytes!("shaders/range.frag.spv");
    pub(crate) const FRAME: &[u8] = include_bytes!("shaders/frame.vert.spv");
    pub(crate) const FRAME_COMPUTE: &[u8] = include_bytes!("shaders/frame_compute.vert.spv");

    /// The shader of frames that counts.
    pub(crate) fn frame_count(warps: bool) -> &'static [u8] {
        match warps {
            true => include_bytes!("shaders/frame_count_warps.vert.spv"),
            false => include_bytes!("shaders/frame_count.vert.spv"),
        }
    }

    /// The shader that counts.
    pub(crate) fn count(warps: bool) -> &'static [u8] {
        match warps {
            true => include_bytes!("shaders/count_warps.vert.spv"),
            false => include_bytes!("shaders/count.vert.spv"),
        }
    }

    /// The shader that writes down every invocation.
    pub(crate) fn log(warps: bool) -> &'static [u8] {
        match warps {
            true => include_bytes!("shaders/log_warps.vert.spv"),
            false => include_bytes!("shaders/log.vert.spv"),
        }
    }
}

/// The size at which a mesh that fills the unit cube is drawn. At a corner of four pixels it covers the
/// middle of none, so no work is left for fragments.
pub(crate) const SIZE: f32 = 1e-3;

/// A kind of draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Workload {
    /// A cheap shader and faces too small to cover a pixel: primitive setup.
    Setup,
    /// The same with twelve values of four floats for each vertex.
    Varyings,
    /// A cheap shader, and everything discarded before it becomes pixels.
    Discard,
    /// 3,200 floating-point operations a vertex.
    Compute,
    /// 16 scattered loads a vertex.
    Memory,
}

impl Workload {
    /// All of them, as they are listed.
    pub const ALL: [Self; 5] = [
        Self::Setup,
        Self::Varyings,
        Self::Discard,
        Self::Compute,
        Self::Memory,
    ];

    pub(crate) fn settings(self, topology: Topology, restart: bool) -> Settings {
        let (vertex, fragment) = match self {
            Self::Setup => (shader::CHEAP, Some(shader::WHITE)),
            Self::Varyings => (shader::VARYINGS, Some(shader::VARYINGS_FRAGMENT)),
            Self::Discard => (shader::CHEAP, None),
            Self::Compute => (shader::COMPUTE, Some(shader::WHITE)),
            Self::Memory => (shader::MEMORY, Some(shader::WHITE)),
        };
        Settings {
            vertex,
            fragment,
            positions: true,
            topology,
            restart,
            solid: false,
        }
    }
}

impl fmt::Display for Workload {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Setup => "setup",
            Self::Varyings => "varyings",
            Self::Discard => "discard",
            Self::Compute => "compute",
            Self::Memory => "memory",
        })
    }
}
