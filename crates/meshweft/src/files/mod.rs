//! Mesh files, changed in place: faces and vertices are permuted, every other byte stays.
//!
//! Re-ordering permutes records of a file, so the file is patched rather than written again from
//! nothing: whatever a reader does not know (materials, extras, extensions, comments) cannot be
//! lost. What is added goes to the ends, and nothing moves; what is left out leaves, and counts follow. Read [`Document`] first, then
//! [`MeshEntry`]; each format has a module of its own.
//!
//! | to learn | read |
//! |---|---|
//! | how a format plugs in | `content` |
//! | what can be done to a document | [`Edit`] |
//! | how a file is made that has no source | [`create()`], [`Document::create`], `plain_mesh` |
//! | how records change places in text and in binary files | `slots`, `orders`, `rewrite`, `splice`, `definitions`, `record_file` |
//! | how records leave, and what then stands with a corner | `select`, `bonds`, `selected`, `corner_sources` |
//! | how the same is done in the buffers of a glTF | `gltf` |
//! | what a file holds that is in no mesh and no attribute | `unlisted`, and one of each format |
//! | what a file is, by its name and by its bytes | [`Format`], `signature` |
//! | where bytes come from | `disk`, `surroundings` |
//! | grids of heights, which are read and not changed | `height_map` (feature `height-maps`) |
//! | where they go, and why nothing is lost on the way | `write`, `placing`, `companions`, `links`, `locks`, `disk` |

mod bonds;
mod companions;
mod content;
mod corner_sources;
mod create;
mod decoded;
mod definitions;
mod disk;
mod document;
mod edit;
mod entry;
mod error;
mod face_records;
mod format;
mod gltf;
#[cfg(feature = "height-maps")]
pub mod height_map;
mod level_bytes;
mod links;
mod locks;
mod new_levels;
mod new_mesh;
mod not_finite;
mod note;
mod obj;
mod off;
mod options;
mod orders;
mod outputs;
mod placing;
mod plain_mesh;
mod ply;
mod record_file;
mod rewrite;
mod select;
mod selected;
mod signature;
mod slots;
mod splice;
mod stl;
mod stored_culling;
mod surroundings;
mod text;
mod unlisted;
mod vrml;
mod write;

pub use create::{check_new, create};
pub use disk::{is_gzip, remove_abandoned};
pub use document::Document;
pub use edit::{Edit, NewValue};
pub use entry::{MeshEntry, MeshLevel};
pub use error::{FileError, FileErrorKind, Place};
pub use format::Format;
pub use gltf::{external_buffers, shared_buffers};
pub(crate) use level_bytes::{FileBytes, LevelBytes};
pub(crate) use new_levels::VerticesOfLevels;
pub use new_levels::{NewLevel, NewLevels, screen_coverage};
pub use new_mesh::{NewMesh, NewVertices};
pub use note::Note;
pub use options::ReadOptions;
pub use outputs::Outputs;
pub use select::{SelectedFace, SelectedFaces, SelectedVertices};
pub use stored_culling::StoredCulling;
pub(crate) use stored_culling::{PlacedTable, SeenSides};
pub use surroundings::Surroundings;
pub use write::{WriteOptions, Written};
