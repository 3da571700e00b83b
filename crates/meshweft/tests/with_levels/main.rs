//! Documents with levels of detail, and what each job does with them.
#![cfg(feature = "files")]

#[path = "../files_gltf/builder.rs"]
#[expect(dead_code, reason = "shared with other tests")]
mod builder;
mod made;
mod order;
mod simplify;
