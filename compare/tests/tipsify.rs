//! Our Tipsify draws the faces exactly as meshoptimizer's does.

use std::io::Write;

use compare::rivals::Meshopt;
use meshweft::order::baselines;

#[test]
fn faces_come_in_the_same_order() {
    let Some(data) = compare::data_folder() else {
        let _ = writeln!(
            std::io::stderr(),
            "tipsify: no test data, skipped all meshes"
        );
        return;
    };
    let (mut ran, mut skipped) = (0, Vec::new());
    for file in compare::mesh_files(&data) {
        let name = compare::mesh_name(&file);
        if file.to_string_lossy().contains(".wrl") {
            skipped.push(name);
            continue;
        }
        let mesh = compare::oracle::read(&file).unwrap();
        for size in [12, 16, 32] {
            let ours = baselines::tipsify(&mesh, size).apply(mesh.faces());
            let theirs = Meshopt::Fifo(size).ordered(&mesh);
            let differing = ours.iter().zip(&theirs).position(|(a, b)| a != b);
            assert_eq!(differing, None, "{name}, K={size}");
        }
        ran += 1;
    }
    let _ = writeln!(
        std::io::stderr(),
        "tipsify: {ran} meshes, skipped {} (VRML is not read here): {skipped:?}",
        skipped.len()
    );
}
