//! What one frame of a walk costs.

use serde_json::{Value, json};

use crate::lod::geometry_cache::{FrameMode, FrameStatistics, IndexStatistics};

/// The counts and times of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct WalkFrame {
    /// Active vertices.
    pub vertices: usize,
    /// Faces.
    pub faces: usize,
    /// Vertices that became active; in the first frame, beyond the roots.
    pub added: usize,
    /// Vertices that became inactive.
    pub removed: usize,
    /// Vertices that are uploaded.
    pub inserts: usize,
    /// Ranges of the vertex buffer that these are in.
    pub vertex_ranges: usize,
    /// Bytes of vertices that are uploaded.
    pub vertex_bytes: u64,
    /// Faces whose indices are uploaded.
    pub patched_faces: usize,
    /// Ranges of the index buffer that these are in.
    pub index_ranges: usize,
    /// Bytes of indices that are uploaded.
    pub index_bytes: u64,
    /// In how many passes it is drawn; 1 unless there are more vertices than slots.
    pub passes: usize,
    /// Whether all vertices are sent as a stream.
    pub is_streamed: bool,
    /// Bytes of a `.mwl` or `.mwt` file that are read; in the first frame, with its head and its roots. 0 of any other file.
    pub read_bytes: u64,
    /// Milliseconds to find what the view needs and to change the front.
    pub update_milliseconds: f64,
    /// Milliseconds to find slots for vertices; passes count here.
    pub cache_milliseconds: f64,
    /// Milliseconds to write indices.
    pub index_milliseconds: f64,
}

impl WalkFrame {
    /// The same frame with what it sends to the vertex buffer and to the index buffer. Vertices have this many bytes.
    pub(in crate::operations) fn with_sent(
        self,
        mode: FrameMode,
        upload: FrameStatistics,
        patch: IndexStatistics,
        vertex_size: usize,
    ) -> Self {
        Self {
            inserts: upload.inserts,
            vertex_ranges: upload.ranges,
            vertex_bytes: upload.bytes(vertex_size),
            patched_faces: patch.patched,
            index_ranges: patch.ranges,
            index_bytes: patch.bytes as u64,
            passes: 1,
            is_streamed: mode == FrameMode::Streamed,
            ..self
        }
    }
}

/// A figure of each frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum WalkQuantity {
    /// Active vertices.
    Vertices,
    /// Faces.
    Faces,
    /// Vertices that became active.
    Added,
    /// Vertices that became inactive.
    Removed,
    /// Vertices that are uploaded.
    Inserts,
    /// Ranges of the vertex buffer.
    VertexRanges,
    /// Bytes of vertices.
    VertexBytes,
    /// Faces whose indices are uploaded.
    PatchedFaces,
    /// Ranges of the index buffer.
    IndexRanges,
    /// Bytes of indices.
    IndexBytes,
    /// Passes.
    Passes,
    /// Bytes of a `.mwl` or `.mwt` file that are read.
    ReadBytes,
    /// Milliseconds to change the front.
    UpdateMilliseconds,
    /// Milliseconds to find slots.
    CacheMilliseconds,
    /// Milliseconds to write indices.
    IndexMilliseconds,
}

impl WalkQuantity {
    /// All of them.
    pub const ALL: [Self; 15] = [
        Self::Vertices,
        Self::Faces,
        Self::Added,
        Self::Removed,
        Self::Inserts,
        Self::VertexRanges,
        Self::VertexBytes,
        Self::PatchedFaces,
        Self::IndexRanges,
        Self::IndexBytes,
        Self::Passes,
        Self::ReadBytes,
        Self::UpdateMilliseconds,
        Self::CacheMilliseconds,
        Self::IndexMilliseconds,
    ];

    /// What it is called in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Vertices => "vertices",
            Self::Faces => "faces",
            Self::Added => "added",
            Self::Removed => "removed",
            Self::Inserts => "inserts",
            Self::VertexRanges => "vertex_ranges",
            Self::VertexBytes => "vertex_bytes",
            Self::PatchedFaces => "patched_faces",
            Self::IndexRanges => "index_ranges",
            Self::IndexBytes => "index_bytes",
            Self::Passes => "passes",
            Self::ReadBytes => "read_bytes",
            Self::UpdateMilliseconds => "update_milliseconds",
            Self::CacheMilliseconds => "cache_milliseconds",
            Self::IndexMilliseconds => "index_milliseconds",
        }
    }

    /// Whether it is a time, which no two runs have alike.
    #[must_use]
    pub fn is_time(self) -> bool {
        self.name().ends_with("milliseconds")
    }

    /// Its value in a frame.
    #[must_use]
    pub fn of(self, frame: &WalkFrame) -> f64 {
        match self {
            Self::Vertices => frame.vertices as f64,
            Self::Faces => frame.faces as f64,
            Self::Added => frame.added as f64,
            Self::Removed => frame.removed as f64,
            Self::Inserts => frame.inserts as f64,
            Self::VertexRanges => frame.vertex_ranges as f64,
            Self::VertexBytes => frame.vertex_bytes as f64,
            Self::PatchedFaces => frame.patched_faces as f64,
            Self::IndexRanges => frame.index_ranges as f64,
            Self::IndexBytes => frame.index_bytes as f64,
            Self::Passes => frame.passes as f64,
            Self::ReadBytes => frame.read_bytes as f64,
            Self::UpdateMilliseconds => frame.update_milliseconds,
            Self::CacheMilliseconds => frame.cache_milliseconds,
            Self::IndexMilliseconds => frame.index_milliseconds,
        }
    }

    /// A value of it as JSON: counts without a fraction.
    pub(in crate::operations) fn json(self, value: f64) -> Value {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count or a sum of counts"
        )]
        match self.is_time() {
            true => json!(value),
            false => json!(value as u64),
        }
    }
}

impl WalkFrame {
    pub(in crate::operations) fn json(&self) -> Value {
        let figures = WalkQuantity::ALL.iter();
        let figures = figures.map(|it| (it.name().to_owned(), it.json(it.of(self))));
        let mut object: serde_json::Map<String, Value> = figures.collect();
        object.insert("streamed".into(), json!(self.is_streamed));
        Value::Object(object)
    }
}
