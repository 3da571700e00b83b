//! Our Tipsify draws the faces exactly as meshoptimizer's does.

use compare::rivals::Meshopt;
use meshweft::order::baselines;

#[test]
fn faces_come_in_the_same_order() {
    compare::for_each_mesh("tipsify", |name, mesh| {
        for size in [12, 16, 32] {
            let ours = baselines::tipsify(mesh, size).apply(mesh.faces());
            let theirs = Meshopt::Fifo(size).ordered(mesh);
            let differing = ours.iter().zip(&theirs).position(|(a, b)| a != b);
            assert_eq!(differing, None, "{name}, K={size}");
        }
    });
}
