//! A draw as a program asks for it.

use ash::vk;

/// The index that starts a new strip or fan, where that is asked for.
pub const RESTART: u32 = u32::MAX;

/// One indexed draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Draw<'a> {
    /// How indices become primitives.
    pub topology: Topology,
    /// The indices.
    pub indices: &'a [u32],
    /// Whether [`RESTART`] starts a new strip or fan.
    pub restart: bool,
    /// Whether indices are stored in 16 bits.
    pub short: bool,
    /// Added to each index.
    pub vertex_offset: i32,
    /// How often all of it is drawn.
    pub instances: u32,
    /// Whether the shader reads the number of the instance; none of those here does.
    pub reads_instance: bool,
    /// Where the vertices are, for shaders that ask.
    pub positions: Option<&'a [[f32; 3]]>,
}

/// How indices become primitives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Topology {
    /// Three a face.
    TriangleList,
    /// A face for each after the second.
    TriangleStrip,
    /// A face for each after the second, all with the first.
    TriangleFan,
}

impl<'a> Draw<'a> {
    /// A list of faces, three indices each.
    #[must_use]
    pub fn list(indices: &'a [u32]) -> Self {
        Self {
            topology: Topology::TriangleList,
            indices,
            restart: false,
            short: false,
            vertex_offset: 0,
            instances: 1,
            reads_instance: false,
            positions: None,
        }
    }

    /// Strips that [`RESTART`] separates.
    #[must_use]
    pub fn strips(indices: &'a [u32]) -> Self {
        Self {
            topology: Topology::TriangleStrip,
            restart: true,
            ..Self::list(indices)
        }
    }
}

impl Topology {
    pub(crate) fn raw(self) -> vk::PrimitiveTopology {
        match self {
            Self::TriangleList => vk::PrimitiveTopology::TRIANGLE_LIST,
            Self::TriangleStrip => vk::PrimitiveTopology::TRIANGLE_STRIP,
            Self::TriangleFan => vk::PrimitiveTopology::TRIANGLE_FAN,
        }
    }
}
