//! Figures with a row for each mesh: 3, 6 and 9.

use std::time::Instant;

use meshweft::operations::{Greedy, Method};
use meshweft::order::Mode;
use meshweft::{CacheModel, Mesh, Permutation, cache};
use serde_json::{Value, json};

use super::found::{Found, SIZE, algorithm, control, fifo};
use super::printed::{FIG_6, FIG_6_SIZES, FIG_9};
use crate::paper::figure::{Figure, cells, head, mean};

/// First focus vertices tried for Fig. 9.
const FIRST_FOCI: usize = 20;

/// Misses per face of a cache of 12, with those of other methods.
pub(super) fn fig_3(found: &[Found]) -> Figure {
    let mut rows = vec![head(&[
        "",
        "faces",
        "random",
        "ours",
        "original",
        "ours",
        "BoG",
        "Hoppe",
        "LY-FIFO",
        "faithful",
        "fast",
        "LY-control",
        "faithful",
        "fast",
        "fast, Belady",
    ])];

    let mut json = Vec::new();
    for it in found {
        let (printed, mesh) = (it.printed, &it.mesh);
        let shuffled = Permutation::random(mesh.face_count(), 1).apply(mesh.faces());
        let shuffled = cache::acmr(&shuffled, CacheModel::fifo(SIZE));
        let fifos = [Mode::Faithful, Mode::Fast].map(|mode| fifo(mesh, SIZE, mode));
        let controls = [Mode::Faithful, Mode::Fast].map(|mode| control(mesh, SIZE, mode));

        let numbers = [
            printed.random,
            shuffled,
            printed.original,
            it.original(),
            printed.bog,
            printed.hoppe,
            printed.fifo,
            fifos[0],
            fifos[1],
            printed.control,
            controls[0][0],
            controls[1][0],
            controls[1][1],
        ];
        let mut row = cells(it.name(), numbers);
        row.insert(1, mesh.face_count().to_string());
        rows.push(row);

        json.push(json!({
            "mesh": printed.mesh,
            "file": it.file.file_name().map(|name| name.to_string_lossy()),
            "is_the_papers": it.is_the_papers(),
            "faces": mesh.face_count(),
            "paper": {
                "vertices": printed.vertices, "faces": printed.faces, "random": printed.random,
                "original": printed.original, "bog": printed.bog, "hoppe": printed.hoppe,
                "fifo": printed.fifo, "control": printed.control,
            },
            "ours": {
                "random": shuffled, "original": it.original(),
                "faithful_fifo": fifos[0], "fast_fifo": fifos[1],
                "faithful_control": {"scheduled": controls[0][0], "belady": controls[0][1]},
                "fast_control": {"scheduled": controls[1][0], "belady": controls[1][1]},
            },
        }));
    }

    let title =
        "Misses per face at a cache of 12: the paper's columns, ours to the right of them.\n\
        * the file is another version of the mesh than the paper's."
            .to_owned();
    Figure {
        title,
        rows,
        json: Value::Array(json),
    }
}

/// Times.
pub(super) fn fig_6(found: &[Found]) -> Figure {
    let sizes: Vec<String> = FIG_6_SIZES.iter().map(|k| format!("K={k}")).collect();
    let mut rows = vec![
        [String::new(), String::new()]
            .into_iter()
            .chain(sizes)
            .collect(),
    ];
    let mut json = Vec::new();

    for (name, seconds) in &FIG_6 {
        let Some(it) = found.iter().find(|it| it.printed.mesh == *name) else {
            continue;
        };
        let ours = FIG_6_SIZES.map(|size| {
            let start = Instant::now();
            let order = algorithm(CacheModel::fifo(size), Mode::Fast).order(&it.mesh);
            std::hint::black_box(order);
            start.elapsed().as_secs_f64()
        });

        let line = |name: String, who: &str, numbers: &[f64; 8], digits: usize| {
            let numbers = numbers.iter().map(|x| format!("{x:.digits$}"));
            [name, who.to_owned()]
                .into_iter()
                .chain(numbers)
                .collect::<Vec<_>>()
        };
        rows.push(line(it.name(), "paper", seconds, 2));
        rows.push(line(String::new(), "ours", &ours, 5));
        json.push(json!({"mesh": name, "paper": seconds, "ours": ours}));
    }

    let title = "Seconds for a FIFO cache: the paper's (2005), ours in fast mode.".to_owned();
    Figure {
        title,
        rows,
        json: json!({"sizes": FIG_6_SIZES, "meshes": json}),
    }
}

/// What the choice of the first focus vertex changes.
pub(super) fn fig_9(found: &[Found]) -> Figure {
    let mut rows = vec![head(&["", "", "mean", "least", "most", "deviation"])];
    let mut json = Vec::new();

    for (name, printed) in &FIG_9 {
        let Some(it) = found.iter().find(|it| it.printed.mesh == *name) else {
            continue;
        };
        let line = |name: String, who: &str, numbers: &[f64; 4]| {
            let numbers = numbers.iter().map(|x| format!("{x:.5}"));
            [name, who.to_owned()]
                .into_iter()
                .chain(numbers)
                .collect::<Vec<_>>()
        };

        rows.push(line(it.name(), "paper", printed));
        let mut object = json!({"mesh": name, "paper": printed});
        let modes = [("faithful", Mode::Faithful), ("fast", Mode::Fast)];
        for (who, mode) in modes.into_iter().skip(usize::from(it.is_large())) {
            let ours = from_many_foci(&it.mesh, mode);
            rows.push(line(String::new(), who, &ours));
            object[who] = json!(ours);
        }
        json.push(object);
    }

    let title = format!("{FIRST_FOCI} random first focus vertices, FIFO cache of {SIZE}.");
    Figure {
        title,
        rows,
        json: Value::Array(json),
    }
}

/// Mean, least, most and standard deviation of misses per face.
fn from_many_foci(mesh: &Mesh, mode: Mode) -> [f64; 4] {
    let model = CacheModel::fifo(SIZE);
    let foci = Permutation::random(mesh.vertex_count(), 9);
    let acmr = |&focus: &u32| {
        let algorithm = Method::KCacheReorder {
            cache: model,
            greedy: Greedy::of_mode(mode),
            first_focus: Some(focus),
        };
        cache::acmr(&algorithm.order(mesh).apply(mesh.faces()), model)
    };

    let runs: Vec<f64> = foci
        .new_to_old()
        .iter()
        .take(FIRST_FOCI)
        .map(acmr)
        .collect();

    let middle = mean(runs.iter().copied());
    let variance = mean(runs.iter().map(|x| (x - middle).powi(2)));
    let least = runs.iter().copied().fold(f64::MAX, f64::min);
    let most = runs.iter().copied().fold(f64::MIN, f64::max);
    [middle, least, most, variance.sqrt()]
}
