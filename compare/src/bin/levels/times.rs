//! How long orders, walks and steps take.

use std::hint::black_box;

use compare::timing::{median, medians, timed};
use meshweft::progressive::{CheckpointWalk, Checkpoints, IndexBuffer, ProgressiveMesh, Walk};
use meshweft::{Faces, Mesh};

use crate::STORED;
use crate::quality::level_of;

/// The cache size of the orders.
const SIZE: u32 = 16;
/// Records that are gone step by step, there and back.
const RECORDS: usize = 4000;
const REPETITIONS: usize = 9;

pub(crate) fn print(meshes: &[(String, Mesh)]) -> Result<(), String> {
    let mut made = Vec::new();
    println!("Times of one thread, K = {SIZE}.\n");
    println!("| mesh | one order of the full mesh, ms | all checkpoints, ms | ratio |");
    println!("|---|--:|--:|--:|");
    for (name, mesh) in meshes {
        let progressive = STORED.progressive(mesh, SIZE)?;
        let full = Faces::new(progressive.faces(), progressive.vertex_count());
        let full = full.map_err(|error| error.to_string())?;
        let optimizer = STORED.optimizer(SIZE);
        let (one, _) = timed(|| STORED.optimizer(SIZE - 1).face_order(full));
        let (all, _) = timed(|| Checkpoints::optimized(&progressive, STORED.ratio, &optimizer));
        println!(
            "| {name} | {:.1} | {:.1} | {:.1} |",
            one * 1e3,
            all * 1e3,
            all / one
        );
        made.push((name, progressive));
    }

    println!(
        "\nFrom the nearer end of the records to a level, its faces written; the ratio is that of a fresh order.\n"
    );
    println!(
        "| mesh | level, % | from | fresh order, ms | in place, ms | ratio | checkpoints, ms | ratio | index buffer, ms | ratio |"
    );
    println!("|---|--:|---|{}", "--:|".repeat(7));
    for (name, progressive) in &made {
        let checkpoints = stored(progressive);
        for (share, from) in [(0.8, 0), (0.2, progressive.last_level())] {
            let to = level_of(progressive, share);
            let [order, rest @ ..] = walks(&checkpoints, progressive, from, to);
            print!(
                "| {name} | {:.0} | {} | {:.2} |",
                100.0 * share,
                if from == 0 { "full" } else { "coarsest" },
                order * 1e3
            );
            for time in rest {
                print!(" {:.2} | {:.1} |", time * 1e3, order / time);
            }
            println!();
        }
    }

    println!("\nNanoseconds a record, from 50 % of the faces there and back.\n");
    println!("| mesh | records a step | in place | checkpoints | index buffer |");
    println!("|---|--:|--:|--:|--:|");
    for (name, progressive) in &made {
        let checkpoints = stored(progressive);
        for records in [1, 100] {
            let [walk, stored, buffer] = steps(&checkpoints, progressive, records);
            println!("| {name} | {records} | {walk:.0} | {stored:.0} | {buffer:.0} |");
        }
    }
    Ok(())
}

/// Times do not depend on how good an order is: greedy ones are made sooner.
fn stored(mesh: &ProgressiveMesh) -> Checkpoints<'_> {
    let order = compare::greedy(SIZE - 1);
    Checkpoints::new(mesh, STORED.ratio, |faces| order.face_order(faces))
        .expect("an order has the faces that it was asked for")
}

/// Seconds of a fresh order of the level, and of three ways to its faces.
fn walks(
    checkpoints: &Checkpoints<'_>,
    progressive: &ProgressiveMesh,
    from: usize,
    to: usize,
) -> [f64; 4] {
    let mut walk = Walk::new(progressive);
    walk.go_to(to);
    let mut level = Vec::new();
    walk.emit(&mut level);
    let order = compare::greedy(SIZE);
    let faces = Faces::new(&level, progressive.vertex_count()).expect("faces of a level");

    let mut walk = Walk::new(progressive);
    let mut stored = CheckpointWalk::new(checkpoints);
    let mut buffer = IndexBuffer::new(checkpoints);
    let (mut first, mut second) = (Vec::new(), Vec::new());
    let mut samples = [const { Vec::new() }; 4];
    for _ in 0..REPETITIONS {
        // Back to where they start, without the clock.
        walk.go_to(from);
        stored.go_to(from);
        buffer.go_to(from);

        let [ordered, walked, checked, edited] = medians(
            1,
            [
                &mut || order.face_order(faces).apply(&level).len(),
                &mut || {
                    walk.go_to(to);
                    walk.emit(&mut first);
                    first.len()
                },
                &mut || {
                    stored.go_to(to);
                    stored.emit(&mut second);
                    second.len()
                },
                &mut || buffer.go_to(to).len(),
            ],
        );
        for (sample, time) in samples.iter_mut().zip([ordered, walked, checked, edited]) {
            sample.push(time);
        }
    }
    samples.map(median)
}

/// Nanoseconds a record, in steps of a number of records.
fn steps(checkpoints: &Checkpoints<'_>, progressive: &ProgressiveMesh, records: usize) -> [f64; 3] {
    let half = level_of(progressive, 0.5);
    let count = RECORDS.min(progressive.last_level() - half) / records;
    let there = (1..=count).map(|step| half + step * records);
    let levels: Vec<usize> = there.clone().chain(there.rev()).collect();
    let total = levels.len() * records;

    let mut walk = Walk::new(progressive);
    let mut stored = CheckpointWalk::new(checkpoints);
    let mut buffer = IndexBuffer::new(checkpoints);
    walk.go_to(half);
    stored.go_to(half);
    buffer.go_to(half);
    let mut samples = [const { Vec::new() }; 3];
    for _ in 0..REPETITIONS {
        let [a, b, c] = medians(
            1,
            [
                &mut || levels.iter().for_each(|&level| walk.go_to(level)),
                &mut || {
                    for &level in &levels {
                        stored.go_to(level);
                    }
                },
                &mut || {
                    for &level in &levels {
                        black_box(buffer.go_to(level));
                    }
                },
            ],
        );
        for (sample, time) in samples.iter_mut().zip([a, b, c]) {
            sample.push(time * 1e9 / total as f64);
        }
    }
    samples.map(median)
}
