//! Documents with levels of detail, and what each job does with them.
#![cfg(feature = "files")]

#[path = "../files_gltf/builder.rs"]
#[expect(dead_code, reason = "shared with other tests")]
mod builder;
mod compare;
mod cull;
mod inspect;
mod left_out;
mod made;
mod order;
mod simplify;
mod without_indices;
mod written;

use meshweft::CacheModel;

/// What is counted.
const MODELS: [CacheModel; 2] = [CacheModel::fifo(12), CacheModel::Nvidia];
