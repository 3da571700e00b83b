//! Real scenes, where they are present.

use std::path::Path;

use meshweft::files::{Document, ReadOptions};
use meshweft::operations::simplify;

use crate::data::folder;
use crate::{laws, ratio};

fn check(path: &Path, share: f64) -> f64 {
    let source = Document::open(path, ReadOptions::default()).unwrap();
    let mut document = Document::open(path, ReadOptions::default()).unwrap();
    let report = simplify(&mut document, &ratio(share), &()).unwrap();
    laws::check(&source, &document, &report);
    let [before, after] = [&report.total.before, &report.total.after].map(|counts| counts.faces);
    after as f64 / before as f64
}

#[test]
fn scenes_are_nowhere_torn() {
    let Some(data) = folder() else {
        return;
    };
    for (file, most) in [
        ("gltf/DamagedHelmet.glb", 0.25_f64),
        ("gltf/Duck.glb", 0.06),
        ("gltf/2CylinderEngine.glb", 0.25),
        ("gltf/Fox.glb", 0.06),
        ("gltf/AnimatedMorphSphere/AnimatedMorphSphere.gltf", 1.0),
        ("gltf/CesiumMilkTruck.glb", 1.0),
        ("gltf/MorphStressTest.gltf", 1.0),
        ("meshes/cow_poly.obj.gz", 0.06),
        ("meshes/spot.obj.gz", 0.06),
        ("meshes/thingi_88566.stl.gz", 0.09),
        ("meshes/dolphins.ply.gz", 0.2),
    ] {
        let path = data.join(file);
        assert!(path.exists(), "{file} is missing in {}", data.display());
        for share in [0.5, 0.05] {
            let reached = check(&path, share);
            assert!(reached <= most.max(share + 0.01), "{file}: {reached}");
            eprintln!("{file}: {:.1} % of the faces are left", 100.0 * reached);
        }
    }
}
