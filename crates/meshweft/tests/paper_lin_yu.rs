//! The tables of Lin and Yu 2006, on the paper's own meshes where they are at hand.
#![cfg(feature = "files")]

mod data;

use data::{meshes, open};
use meshweft::files::Document;
use meshweft::operations::{Method, SequenceUpdate, collapse_history};
use meshweft::order::{KCacheReorder, Mode};
use meshweft::{CacheModel, Limits, Mesh, cache};

fn ordered(mesh: &Mesh, cache: CacheModel, mode: Mode) -> Vec<[u32; 3]> {
    let algorithm = KCacheReorder {
        cache,
        mode,
        ..Default::default()
    };
    algorithm.face_order(mesh).apply(mesh.faces())
}

#[test]
fn the_original_column_comes_out_to_the_last_digit() {
    let Some(folder) = meshes() else { return };
    let printed = [
        ("eight.off.gz", "0.878"),
        ("mannequin.off.gz", "0.935"),
        ("fandisk.off.gz", "1.023"),
        ("beethoven.ply.gz", "0.975"),
        ("bunny.ply.gz", "2.085"),
        ("feline.off.gz", "1.376"),
        ("horse.obj.gz", "2.777"),
    ];
    for (name, expected) in printed {
        let mesh = open(&folder, name);
        let acmr = cache::acmr(mesh.faces(), CacheModel::fifo(12));
        assert_eq!(format!("{acmr:.3}"), expected, "{name}");
    }
}

#[test]
fn the_faithful_mode_meets_both_columns() {
    let Some(folder) = meshes() else { return };
    // Printed FIFO and controllable. The dragon is held to them by the program's `paper`.
    let printed = [
        ("eight.off.gz", 0.633, 0.635),
        ("fandisk.off.gz", 0.625, 0.625),
        ("bunny.ply.gz", 0.628, 0.635),
        ("horse.obj.gz", 0.630, 0.631),
        ("feline.off.gz", 0.649, 0.621),
    ];
    for (name, fifo, control) in printed {
        let mesh = open(&folder, name);
        let model = CacheModel::fifo(12);
        let ours = cache::acmr(&ordered(&mesh, model, Mode::Faithful), model);
        assert!((ours - fifo).abs() <= 0.006, "{name} FIFO: {ours}");
        let algorithm = KCacheReorder {
            cache: CacheModel::controllable(12),
            mode: Mode::Faithful,
            ..Default::default()
        };
        let (order, schedule) = algorithm.schedule(&mesh);
        let pushes = schedule.play(&order.apply(mesh.faces()), 12).unwrap();
        let ours = pushes as f64 / mesh.face_count() as f64;
        assert!(
            (ours - control).abs() <= 0.006,
            "{name} controllable: {ours}"
        );
    }
}

#[test]
fn the_fast_mode_is_no_worse_than_the_paper() {
    let Some(folder) = meshes() else { return };
    // Measured: .620 .623 .626 .649 at 12 entries. A change that costs quality shows here first.
    let most = [
        ("fandisk.off.gz", 0.625),
        ("bunny.ply.gz", 0.628),
        ("horse.obj.gz", 0.630),
        ("nefertiti.obj.gz", 0.652),
    ];
    for (name, most) in most {
        let mesh = open(&folder, name);
        let model = CacheModel::fifo(12);
        let ours = cache::acmr(&ordered(&mesh, model, Mode::Fast), model);
        assert!(ours <= most, "{name}: {ours}");
    }
    let names = ["bunny.ply.gz", "horse.obj.gz", "fandisk.off.gz"];
    let (mut scheduled, mut belady) = (0.0, 0.0);
    for name in names {
        let mesh = open(&folder, name);
        let model = CacheModel::controllable(12);
        let algorithm = KCacheReorder {
            cache: model,
            ..Default::default()
        };
        let (order, schedule) = algorithm.schedule(&mesh);
        let faces = order.apply(mesh.faces());
        scheduled += schedule.play(&faces, 12).unwrap() as f64 / faces.len() as f64 / 3.0;
        belady += cache::acmr(&faces, model) / 3.0;
    }
    assert!(
        scheduled <= 0.600 && belady <= 0.597,
        "{scheduled} {belady}"
    );
}

#[test]
fn sequence_updates_rank_as_the_papers_say() {
    let Some(folder) = meshes() else { return };
    let model = CacheModel::fifo(12);
    for name in ["cow.off.gz", "mannequin.off.gz"] {
        let document = Document::open(&folder.join(name), Limits::default()).unwrap();
        let positions = document.positions(0).unwrap().unwrap();
        let mesh = Mesh::new(positions, document.meshes()[0].mesh.faces()).unwrap();
        let history = collapse_history(&mesh, mesh.face_count() / 10).unwrap();
        let levels = [80, 50, 20, 10].map(|percent| {
            let count = mesh.face_count() * percent / 100;
            history.level_of_faces(count).unwrap()
        });

        let order = Method::k_cache_reorder(12, Mode::Fast).order(history.full_faces());
        let [simple, smart, adaptive] = SequenceUpdate::SHOWN.map(|update| {
            let mut acmr = Vec::new();
            let visit = |faces: &[[u32; 3]]| acmr.push(cache::acmr(faces, model));
            update.at_levels(&history, &order, levels, visit).unwrap();
            acmr
        });
        for at in 0..levels.len() {
            let [simple, smart, adaptive] = [&simple, &smart, &adaptive].map(|acmr| acmr[at]);
            let text = format!("{name}: {simple} {smart} {adaptive}");
            assert!(simple > 1.1 * smart && simple > 1.1 * adaptive, "{text}");
            // Below half of the faces.
            assert!(at < 2 || adaptive < smart, "{text}");
        }
    }
}
