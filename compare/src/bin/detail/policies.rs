//! EvictionPolicy policies against the fewest inserts that are possible.

use meshweft::lod::geometry_cache::{EvictionPolicy, GeometryCache, RecordedPath};

use crate::scene::Scene;
use crate::{FRAMES, PATHS, mean, worst};

/// So that slots are scarce.
const TOLERANCE: f64 = 0.18;
const USUAL_SLOTS: usize = 65_536;
/// The policies whose inserts are shown, ours last.
const POLICIES: [(&str, EvictionPolicy); 4] = [
    ("FA", EvictionPolicy::FirstAvailable),
    ("LRU", EvictionPolicy::OldestFirst),
    ("LRU + queue", EvictionPolicy::queued_by_error(10, 30)),
    ("finest", EvictionPolicy::FinestFirst),
];
/// How many slots there are for the most active vertices of a path.
type CountSlots = fn(usize) -> usize;

/// What numbers of slots are called, and how they are found.
const SLOTS: [(&str, CountSlots); 3] = [
    ("1.25 x", |most| most + most / 4),
    ("2 x", |most| 2 * most),
    ("65,536", |_| USUAL_SLOTS),
];

/// Inserts of each policy, and the fewest.
struct Inserts {
    of: [u64; 4],
    fewest: u64,
}

impl Inserts {
    fn over_fewest(&self, policy: usize) -> f64 {
        self.of[policy] as f64 / self.fewest.max(1) as f64
    }

    fn ours_over_lru(&self) -> f64 {
        self.of[3] as f64 / self.of[1].max(1) as f64
    }
}

pub(crate) fn print(scenes: &[Scene]) -> Result<(), String> {
    println!(
        "Inserts over the fewest possible (Belady), {FRAMES} frames at {TOLERANCE} pixels; slots 1.25 and 2 times the most active \
         vertices of the path, and {USUAL_SLOTS}.\n"
    );
    print!("| mesh | path | most active | different | slots |");
    for (name, _) in POLICIES {
        print!(" {name} |");
    }
    println!(" finest / LRU |\n|---|---|--:|--:|---|{}", "--:|".repeat(5));
    let mut all = SLOTS.map(|_| Vec::new());
    for scene in scenes {
        let mut of_scene = SLOTS.map(|_| Vec::new());
        for (letter, camera_path) in &PATHS {
            let path = recorded(scene, camera_path)?;
            let [most, distinct] = [path.most_active(), path.distinct_vertices()];
            for ((name, slots), of_slots) in SLOTS.iter().zip(&mut of_scene) {
                print!(
                    "| {} | {letter} | {most} | {distinct} | {name} |",
                    scene.name
                );
                match inserts(scene, &path, slots(most).max(3))? {
                    Some(inserts) => {
                        for policy in 0..POLICIES.len() {
                            print!(" {:.3} |", inserts.over_fewest(policy));
                        }
                        println!(" {:.3} |", inserts.ours_over_lru());
                        of_slots.push(inserts);
                    }
                    None => println!(" more active than slots |{}", " – |".repeat(4)),
                }
            }
        }
        for (all, of_scene) in all.iter_mut().zip(of_scene) {
            all.push((scene.name.as_str(), of_scene));
        }
    }

    println!("\nMeans over the paths, and the worst of finest / LRU.\n");
    print!("| mesh | slots |");
    for (name, _) in POLICIES {
        print!(" {name} |");
    }
    println!(" finest / LRU, worst |\n|---|---|{}", "--:|".repeat(5));
    for ((name, _), of_slots) in SLOTS.iter().zip(&all) {
        for (mesh, rows) in of_slots {
            print!("| {mesh} | {name} |");
            for policy in 0..POLICIES.len() {
                print!(
                    " {:.3} |",
                    mean(rows.iter().map(|it| it.over_fewest(policy)))
                );
            }
            println!(" {:.3} |", worst(rows.iter().map(Inserts::ours_over_lru)));
        }
    }
    Ok(())
}

/// What the frames of a path change.
fn recorded(
    scene: &Scene,
    path: &meshweft::operations::CameraPath,
) -> Result<RecordedPath, String> {
    let mut front = scene.front();
    let roots: Vec<u32> = front.vertices().collect();
    let mut recorded = RecordedPath::new(scene.hierarchy.vertex_count());
    for (frame, camera) in scene.cameras(path, FRAMES).enumerate() {
        let view = camera.view(TOLERANCE).map_err(|it| it.to_string())?;
        let changes = front.update(&view, 1.0);
        let mut added = changes.added_vertices.clone();
        if frame == 0 {
            added.extend(&roots);
        }
        let pushed = recorded.push_change(&added, &changes.removed_vertices);
        pushed.map_err(|it| it.to_string())?;
    }
    Ok(recorded)
}

/// The inserts of each policy; `None` where a frame has more vertices than slots.
fn inserts(scene: &Scene, path: &RecordedPath, slots: usize) -> Result<Option<Inserts>, String> {
    let Some(fewest) = path.fewest_inserts(slots) else {
        return Ok(None);
    };
    let count = u32::try_from(scene.hierarchy.vertex_count()).map_err(|it| it.to_string())?;
    let errors: Vec<f32> = (0..count).map(|it| scene.hierarchy.error(it)).collect();
    let mut of = [0; 4];
    for (sum, (_, policy)) in of.iter_mut().zip(POLICIES) {
        let cache = GeometryCache::new(slots, errors.clone(), policy);
        let mut cache = cache.map_err(|it| it.to_string())?;
        for (added, removed) in path.frames() {
            let upload = cache.change(added, removed);
            *sum += upload.map_err(|it| it.to_string())?.statistics().inserts as u64;
        }
    }
    Ok(Some(Inserts { of, fewest }))
}
