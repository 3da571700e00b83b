//! Eviction policies on a path that was recorded, against the fewest inserts that are possible.

use meshweft::lod::geometry_cache::{EvictionPolicy, GeometryCache, RecordedPath};

/// How many slots the paper has.
pub const USUAL_SLOTS: usize = 65_536;
/// The policies whose inserts are shown, ours last.
pub const POLICIES: [(&str, EvictionPolicy); 4] = [
    ("FA", EvictionPolicy::FirstAvailable),
    ("LRU", EvictionPolicy::OldestFirst),
    ("LRU + queue", EvictionPolicy::queued_by_error(10, 30)),
    ("finest", EvictionPolicy::FinestFirst),
];

/// How many slots there are for the most active vertices of a path.
type CountSlots = fn(usize) -> usize;

/// What numbers of slots are called, and how they are found.
pub const SLOTS: [(&str, CountSlots); 3] = [
    ("1.25 x", |most| most + most / 4),
    ("2 x", |most| 2 * most),
    ("65,536", |_| USUAL_SLOTS),
];

/// Inserts of each policy, and the fewest.
#[derive(Debug, Clone, Copy)]
pub struct Inserts {
    of: [u64; POLICIES.len()],
    fewest: u64,
}

impl Inserts {
    /// Those of a path whose vertices have these errors; `None` where a frame has more vertices than slots.
    ///
    /// # Errors
    /// A message if an error or a number of slots is not allowed.
    pub fn count(
        path: &RecordedPath,
        errors: &[f32],
        slots: usize,
    ) -> Result<Option<Self>, String> {
        let Some(fewest) = path.fewest_inserts(slots) else {
            return Ok(None);
        };
        let mut of = [0; POLICIES.len()];
        for (sum, (_, policy)) in of.iter_mut().zip(POLICIES) {
            let cache = GeometryCache::new(slots, errors.to_vec(), policy);
            let mut cache = cache.map_err(|it| it.to_string())?;
            for (added, removed) in path.frames() {
                let upload = cache.change(added, removed);
                *sum += upload.map_err(|it| it.to_string())?.statistics().inserts as u64;
            }
        }
        Ok(Some(Self { of, fewest }))
    }

    /// Those of a policy over the fewest.
    #[must_use]
    pub fn over_fewest(&self, policy: usize) -> f64 {
        self.of[policy] as f64 / self.fewest.max(1) as f64
    }

    /// Those of the last policy over those of LRU.
    #[must_use]
    pub fn ours_over_lru(&self) -> f64 {
        self.of[3] as f64 / self.of[1].max(1) as f64
    }
}

/// All paths of a scene with each number of slots.
#[derive(Debug)]
pub struct PolicyTable {
    name: String,
    rows: [Vec<Inserts>; SLOTS.len()],
}

/// Prints what stands above the rows of [`PolicyTable::print_path`].
pub fn print_head() {
    print!("| scene | path | most active | different | slots |");
    for (name, _) in POLICIES {
        print!(" {name} |");
    }
    println!(" finest / LRU |\n|---|---|--:|--:|---|{}", "--:|".repeat(5));
}

impl PolicyTable {
    /// Nothing of a scene yet.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            rows: SLOTS.map(|_| Vec::new()),
        }
    }

    /// Counts and prints a path.
    ///
    /// # Errors
    /// As [`Inserts::count`].
    pub fn print_path(
        &mut self,
        letter: &str,
        path: &RecordedPath,
        errors: &[f32],
    ) -> Result<(), String> {
        let [most, distinct] = [path.most_active(), path.distinct_vertices()];
        for ((name, slots), rows) in SLOTS.iter().zip(&mut self.rows) {
            print!(
                "| {} | {letter} | {most} | {distinct} | {name} |",
                self.name
            );
            match Inserts::count(path, errors, slots(most).max(3))? {
                Some(inserts) => {
                    for policy in 0..POLICIES.len() {
                        print!(" {:.3} |", inserts.over_fewest(policy));
                    }
                    println!(" {:.3} |", inserts.ours_over_lru());
                    rows.push(inserts);
                }
                None => println!(" more active than slots |{}", " – |".repeat(4)),
            }
        }
        Ok(())
    }

    /// Prints the means over the paths of some scenes.
    pub fn print_means(tables: &[Self]) {
        println!("\nMeans over the paths, and the worst of finest / LRU.\n");
        print!("| scene | slots |");
        for (name, _) in POLICIES {
            print!(" {name} |");
        }
        println!(" finest / LRU, worst |\n|---|---|{}", "--:|".repeat(5));
        for (i, (slots, _)) in SLOTS.iter().enumerate() {
            for table in tables {
                print!("| {} | {slots} |", table.name);
                let rows = &table.rows[i];
                for policy in 0..POLICIES.len() {
                    let sum: f64 = rows.iter().map(|it| it.over_fewest(policy)).sum();
                    print!(" {:.3} |", sum / rows.len().max(1) as f64);
                }
                let ratios = rows.iter().map(Inserts::ours_over_lru);
                println!(" {:.3} |", ratios.fold(0.0, f64::max));
            }
        }
    }
}
