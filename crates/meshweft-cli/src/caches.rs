//! The caches that misses are counted for.

use clap::Args;
use meshweft::CacheModel;
use meshweft::operations::USUAL_CACHES;

#[derive(Debug, Args)]
pub(crate) struct Caches {
    /// A cache to count for, may be repeated: fifo:K, lru:K, controllable:K, nvidia, amd,
    /// intel, meshopt-nvidia, batch:K/V/F (cache size, most vertices and most faces of a batch; 0 for no limit)
    /// [default: fifo:12 fifo:16 fifo:32 nvidia amd intel]
    #[arg(long = "cache", value_name = "MODEL")]
    models: Vec<CacheModel>,
}

impl Caches {
    /// The models asked for, each once, or the usual six.
    pub(crate) fn models(&self) -> Vec<CacheModel> {
        let asked = match self.models.is_empty() {
            true => &USUAL_CACHES[..],
            false => &self.models[..],
        };
        let mut models = Vec::new();
        for &model in asked {
            if !models.contains(&model) {
                models.push(model);
            }
        }
        models
    }
}
