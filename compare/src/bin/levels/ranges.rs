//! What of an index buffer is to be uploaded.

use compare::counting::with_peak;
use meshweft::Mesh;
use meshweft::progressive::{Checkpoints, IndexBuffer};

use crate::STORED;
use crate::quality::level_of;

/// The cache size of the orders.
const SIZE: u32 = 16;
/// Steps that are averaged over.
const STEPS: usize = 1000;

pub(crate) fn print(meshes: &[(String, Mesh)]) -> Result<(), String> {
    println!(
        "\nWhat of an index buffer changes, K = {SIZE}, in the mean of steps of this many records, from 50 % of the faces.\n"
    );
    println!(
        "| mesh | records a step | faces | ranges | ranges, 16 faces between | allocated, bytes |"
    );
    println!("|---|--:|--:|--:|--:|--:|");
    for (name, mesh) in meshes {
        let progressive = STORED.progressive(mesh, SIZE)?;
        let optimizer = STORED.optimizer(SIZE);
        let checkpoints = Checkpoints::optimized(&progressive, STORED.ratio, &optimizer);
        let half = level_of(&progressive, 0.5);
        for records in [1, 10, 100] {
            let steps = STEPS.min((progressive.last_level() - half) / records);
            let [exact, joined] = [0, 16].map(|gap| {
                let mut buffer = IndexBuffer::new(&checkpoints).with_gap(gap);
                buffer.go_to(half);
                with_peak(|| changes(&mut buffer, records, steps))
            });
            let ((faces, ranges), peak) = exact;
            let ((_, ranges_joined), peak_joined) = joined;
            println!(
                "| {name} | {records} | {faces:.1} | {ranges:.1} | {ranges_joined:.1} | {} |",
                peak.max(peak_joined)
            );
        }
    }
    Ok(())
}

/// Faces and ranges that change, in the mean of the steps in which the checkpoint stays.
fn changes(buffer: &mut IndexBuffer<'_>, records: usize, steps: usize) -> (f64, f64) {
    let (mut faces, mut ranges, mut counted) = (0, 0, 0);
    for _ in 0..steps {
        let before = buffer.checkpoint();
        let level = buffer.level() + records;
        let changed = buffer.go_to(level);
        let (count, length) = (
            changed.len(),
            changed.iter().map(ExactSizeIterator::len).sum::<usize>(),
        );
        if buffer.checkpoint() == before {
            faces += length;
            ranges += count;
            counted += 1;
        }
    }
    let mean = |sum: usize| sum as f64 / f64::from(counted.max(1));
    (mean(faces), mean(ranges))
}
