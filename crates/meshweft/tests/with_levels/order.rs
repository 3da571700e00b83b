//! Documents with levels are ordered: each level misses less, and its vertices are a prefix.

use meshweft::files::{Document, MeshEntry};
use meshweft::operations::{Options, compare, inspect, optimize};
use meshweft::order::{Effort, Target};
use meshweft::{Budget, CacheModel, Permutation, VertexOrder};
use proptest::prelude::*;

use crate::made::{Sheet, open};

/// The number of an entry's level, 0 at full resolution.
fn level(entry: &MeshEntry) -> usize {
    entry.level.map_or(0, |level| level.number)
}

/// Whether the vertices that each level and all coarser ones use come first.
fn has_prefixes(document: &Document) -> bool {
    let entries = document.meshes();
    let coarsest = entries.iter().map(level).max().unwrap();
    let mut is_used = vec![false; entries[0].mesh.vertex_count()];
    (0..=coarsest).rev().all(|number| {
        let own = entries.iter().filter(|entry| level(entry) == number);
        for &vertex in own.flat_map(|entry| entry.mesh.faces()).flatten() {
            is_used[vertex as usize] = true;
        }
        is_used.is_sorted_by(|a, b| a >= b)
    })
}

/// The document ordered and written, checked in all that must hold whatever it is.
fn ordered(source: &Document, options: &Options) -> Document {
    let mut document = open(&source.to_main_bytes().unwrap());
    let report = optimize(&mut document, options, &()).unwrap();
    let after = open(&document.to_main_bytes().unwrap());

    // The same triangles in each level.
    let models = options.target.models();
    let compared = compare(source, &after, models).unwrap();
    assert!(compared.is_same() && compared.only_in == [0, 0]);
    assert_eq!(source.meshes().len(), after.meshes().len());
    for (a, b) in source.meshes().iter().zip(after.meshes()) {
        assert_eq!(
            (a.level, a.mesh.face_count()),
            (b.level, b.mesh.face_count())
        );
    }

    // What is reported is what the file has.
    for (mesh, entry) in report.meshes.iter().zip(after.meshes()) {
        let counts = meshweft::operations::Counts::of(&entry.mesh, models);
        let reported = &mesh.change.after;
        assert!(reported.misses.starts_with(&counts.misses), "{}", mesh.name);
        assert_eq!(reported.overfetch, counts.overfetch);
    }
    assert_eq!(
        inspect(&after, models).total.misses,
        report.total.after.misses[..models.len()]
    );

    let full = report.meshes.iter().filter(|mesh| mesh.level.is_none());
    let scheduled: Option<u64> = full.map(|mesh| mesh.scheduled).sum();
    assert_eq!(report.scheduled(), scheduled);

    // Run on its own output it changes nothing.
    let mut again = open(&after.to_main_bytes().unwrap());
    let second = optimize(&mut again, options, &()).unwrap();
    assert!(!second.is_changed());
    after
}

fn for_target(target: &str, effort: Effort) -> Options {
    Options {
        target: target.parse().unwrap(),
        effort,
        ..Options::default()
    }
}

#[test]
fn vertices_stand_in_bands_for_every_target_and_effort() {
    for effort in [Effort::Fast, Effort::Best, Effort::Max] {
        for target in ["universal", "fifo:12", "nvidia", "controllable:9"] {
            for primitive_count in [1, 2] {
                let sheet = Sheet {
                    primitive_count,
                    unused: 3,
                    ..Sheet::default()
                };
                let source = sheet.document();
                assert!(!has_prefixes(&source));
                let after = ordered(&source, &for_target(target, effort));
                assert!(has_prefixes(&after), "{target}, {effort:?}");

                // Each level misses less.
                let misses = |entry: &MeshEntry| {
                    let target: Target = target.parse().unwrap();
                    target.misses(&entry.mesh)
                };
                for (a, b) in source.meshes().iter().zip(after.meshes()) {
                    let is_small = a.mesh.face_count() < 50;
                    let is_less = misses(b) < misses(a) || is_small && misses(b) == misses(a);
                    assert!(is_less, "{target}, {effort:?}: {}", a.name);
                }
            }
        }
    }
}

#[test]
fn totals_are_of_the_full_meshes() {
    let sheet = Sheet::default();
    let (with, plain) = (sheet.document(), sheet.plain());
    let models = [CacheModel::fifo(12), CacheModel::Nvidia];
    let [with, plain] = [&with, &plain].map(|document| inspect(document, &models).total);
    assert_eq!(with, plain);

    // Levels with vertices of their own do not count either.
    let own = Sheet {
        own_vertices: true,
        ..sheet
    };
    assert_eq!(inspect(&own.document(), &models).total, plain);
}

#[test]
fn levels_with_vertices_of_their_own_are_ordered_each_by_first_use() {
    let sheet = Sheet {
        own_vertices: true,
        ..Sheet::default()
    };
    let after = ordered(&sheet.document(), &Options::default());
    for entry in after.meshes() {
        let order = meshweft::order::vertex_fetch(&entry.mesh);
        assert!(order.is_identity(), "{}", entry.name);
    }
}

/// Without new orders of the faces, vertices move only if all levels together are fetched better.
#[test]
fn vertices_move_alone_where_levels_are_fetched_better() {
    let sheet = Sheet::default();
    let after = ordered(&sheet.document(), &Options::default());

    // Vertices somewhere else, faces as they are.
    let mut shuffled = open(&after.to_main_bytes().unwrap());
    let count = shuffled.meshes()[0].mesh.vertex_count();
    let order = VertexOrder::from(Permutation::random(count, 9));
    shuffled
        .edit(meshweft::files::Edit::order(0, None, &order))
        .unwrap();
    assert!(!has_prefixes(&shuffled));
    let settled = ordered(&shuffled, &Options::default());
    assert!(has_prefixes(&settled));
    assert_eq!(
        settled.to_main_bytes().unwrap(),
        after.to_main_bytes().unwrap()
    );
}

/// Of more vertices than a block has, too.
#[test]
fn many_vertices_stand_in_bands_and_not_in_blocks() {
    let sheet = Sheet {
        side: 288,
        level_count: 4,
        ..Sheet::default()
    };
    let source = sheet.document();
    for target in ["universal", "nvidia", "fifo:16"] {
        let after = ordered(&source, &for_target(target, Effort::Fast));
        assert!(has_prefixes(&after), "{target}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn bands_hold_for_any_levels(
        side in 2_u32..20,
        level_count in 1_u32..4,
        primitive_count in 1_usize..4,
        unused in 0_u32..5,
        holes in 0_usize..9,
        seed in 0_u64..1000,
        effort in prop_oneof![Just(Effort::Fast), Just(Effort::Best), Just(Effort::Max)],
        steps in prop_oneof![Just(None), (0_u64..50).prop_map(Some)],
    ) {
        prop_assume!(side >> level_count > 1 && holes != 1);
        let sheet = Sheet { side, level_count, primitive_count, unused, holes, seed, own_vertices: false };
        let source = sheet.document();
        let had_prefixes = has_prefixes(&source);
        let options = Options { effort, ..Options::default() };
        let Some(steps) = steps else {
            let after = ordered(&source, &options);
            let is_moved = after.to_main_bytes().unwrap() != source.to_main_bytes().unwrap();
            prop_assert!(has_prefixes(&after) || !is_moved && !had_prefixes);
            return Ok(());
        };

        // A budget may leave a second run something to do. Prefixes stay.
        let after = ordered(&source, &options);
        let had_prefixes = has_prefixes(&after);
        let mut document = after;
        let options = Options { budget: Budget::Steps(steps), effort: Effort::Max, ..options };
        optimize(&mut document, &options, &()).unwrap();
        prop_assert!(has_prefixes(&document) || !had_prefixes);
    }
}
