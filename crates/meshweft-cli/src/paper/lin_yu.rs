//! Figures 3, 6, 7, 8, 9 and 10 of Lin and Yu 2006, beside ours.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Result, bail};
use meshweft::order::baselines::{random, tipsify};
use meshweft::order::{KCacheReorder, Mode};
use meshweft::{CacheModel, Mesh, cache};
use serde_json::{Value, json};

use super::figures::{FIG_3, FIG_6, FIG_6_SIZES, FIG_7, FIG_9, Printed, SIZES};
use super::{Figure, cells, head, mean, open, print};
use crate::args::OfPaper;

/// Meshes above this many faces are left out of the figures that take many runs.
const LARGE: usize = 200_000;
/// Cache size of Figs. 3, 8, 9 and 10.
const SIZE: u32 = 12;
/// Grid of Fig. 8; the paper drew a surface over k2 and k3 and printed no numbers.
const K2: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
const K3: [f64; 5] = [0.0, 0.65, 1.3, 1.95, 2.6];
/// First focus vertices tried for Fig. 9.
const FIRST_FOCI: usize = 20;

/// Prints the figures for the meshes found in the data folder.
pub(crate) fn run(arguments: &OfPaper) -> Result<()> {
    let mut found = Vec::new();
    for printed in &FIG_3 {
        if let Some(mesh) = Found::open(printed, &arguments.data)? {
            found.push(mesh);
        }
    }
    if arguments.skip_large {
        found.retain(|mesh| mesh.mesh.face_count() <= LARGE);
    }
    if found.is_empty() {
        bail!(
            "{}: none of the paper's meshes is here. Files are looked for by name, such as \
             fandisk.off, bunny.ply or horse.obj, also with .gz, and in a folder `meshes`",
            arguments.data.display()
        );
    }
    print(
        &arguments.report,
        "10.1109/TVCG.2006.59",
        &[
            ("Fig. 3", "figure_3", &|| fig_3(&found)),
            ("Fig. 6", "figure_6", &|| fig_6(&found)),
            ("Fig. 7", "figure_7", &|| fig_7(&found)),
            ("Fig. 8", "figure_8", &|| fig_8(&found)),
            ("Fig. 9", "figure_9", &|| fig_9(&found)),
            ("Fig. 10", "figure_10", &|| fig_10(&found)),
        ],
    )
}

/// A mesh of the paper that a file was found for.
struct Found {
    printed: &'static Printed,
    file: PathBuf,
    mesh: Mesh,
}

impl Found {
    fn open(printed: &'static Printed, folder: &Path) -> Result<Option<Self>> {
        let found = open(folder, printed.files)?;
        Ok(found.map(|(file, mesh)| Self {
            printed,
            file,
            mesh,
        }))
    }

    fn original(&self) -> f64 {
        cache::acmr(self.mesh.faces(), CacheModel::fifo(SIZE))
    }

    /// Whether the file has the paper's faces in the paper's order, as far as the table can tell.
    fn is_the_papers(&self) -> bool {
        let same_count = self.mesh.face_count() == self.printed.faces;
        same_count && (self.original() - self.printed.original).abs() < 0.0006
    }

    /// The paper's name of the mesh, starred if the file is another version of it.
    fn name(&self) -> String {
        let star = if self.is_the_papers() { "" } else { "*" };
        format!("{}{star}", self.printed.mesh)
    }

    fn is_large(&self) -> bool {
        self.mesh.face_count() > LARGE
    }
}

fn algorithm(cache: CacheModel, mode: Mode) -> KCacheReorder {
    KCacheReorder {
        cache,
        mode,
        ..Default::default()
    }
}

fn fifo(mesh: &Mesh, size: u32, mode: Mode) -> f64 {
    let model = CacheModel::fifo(size);
    let order = algorithm(model, mode).face_order(mesh);
    cache::acmr(&order.apply(mesh.faces()), model)
}

/// Pushes per face as scheduled, and by the best schedule for the same order.
fn control(mesh: &Mesh, size: u32, mode: Mode) -> [f64; 2] {
    let model = CacheModel::controllable(size);
    let (order, schedule) = algorithm(model, mode).schedule(mesh);
    let scheduled = crate::count::ratio(schedule.pushes() as f64, mesh.face_count());
    [scheduled, cache::acmr(&order.apply(mesh.faces()), model)]
}

fn fig_3(found: &[Found]) -> Figure {
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
        let shuffled = random(mesh.face_count(), 1).apply(mesh.faces());
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

fn fig_6(found: &[Found]) -> Figure {
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
            let order = algorithm(CacheModel::fifo(size), Mode::Fast).face_order(&it.mesh);
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

fn fig_7(found: &[Found]) -> Figure {
    let meshes: Vec<&Mesh> = found
        .iter()
        .filter(|it| !it.is_large())
        .map(|it| &it.mesh)
        .collect();
    let mut ours = [[0.0; 6]; 5];
    for (i, &size) in SIZES.iter().enumerate() {
        for (which, mode) in [Mode::Faithful, Mode::Fast].into_iter().enumerate() {
            ours[which][i] = mean(meshes.iter().map(|mesh| fifo(mesh, size, mode)));
        }
        let faithful = meshes
            .iter()
            .map(|mesh| control(mesh, size, Mode::Faithful)[0]);
        ours[2][i] = mean(faithful);
        let fast: Vec<_> = meshes
            .iter()
            .map(|mesh| control(mesh, size, Mode::Fast))
            .collect();
        ours[3][i] = mean(fast.iter().map(|c| c[0]));
        ours[4][i] = mean(fast.iter().map(|c| c[1]));
    }
    let names = [
        "FIFO, faithful",
        "FIFO, fast",
        "controllable, faithful",
        "controllable, fast",
        "controllable, fast, Belady",
    ];
    let mut rows = vec![head(&["", "K=10", "12", "16", "24", "32", "64"])];
    rows.push(cells("FIFO, paper (30 meshes)", FIG_7[0]));
    rows.extend(
        names
            .iter()
            .zip(ours)
            .take(2)
            .map(|(name, row)| cells(*name, row)),
    );
    rows.push(cells("controllable, paper (30 meshes)", FIG_7[1]));
    rows.extend(
        names
            .iter()
            .zip(ours)
            .skip(2)
            .map(|(name, row)| cells(*name, row)),
    );
    let title = format!(
        "Mean misses per face, ours over the {} meshes up to {LARGE} faces.",
        meshes.len()
    );
    let json = json!({
        "sizes": SIZES, "paper": {"fifo": FIG_7[0], "control": FIG_7[1]}, "meshes": meshes.len(),
        "ours": {"faithful_fifo": ours[0], "fast_fifo": ours[1],
                 "faithful_control": ours[2], "fast_control": {"scheduled": ours[3], "belady": ours[4]}},
    });
    Figure { title, rows, json }
}

fn fig_8(found: &[Found]) -> Figure {
    let meshes: Vec<&Mesh> = found
        .iter()
        .filter(|it| !it.is_large())
        .map(|it| &it.mesh)
        .collect();
    let model = CacheModel::fifo(SIZE);
    let grid = K2.map(|k2| {
        K3.map(|k3| {
            let algorithm = KCacheReorder {
                k2,
                k3,
                ..algorithm(model, Mode::Fast)
            };
            let acmr =
                |mesh: &&Mesh| cache::acmr(&algorithm.face_order(*mesh).apply(mesh.faces()), model);
            mean(meshes.iter().map(acmr))
        })
    });
    let least = grid.iter().flatten().copied().fold(f64::MAX, f64::min);
    let mut rows = vec![cells("k2 \\ k3", K3)];
    for (k2, line) in K2.iter().zip(&grid) {
        let mark = |&x: &f64| format!("{x:.3}{}", if x == least { "<" } else { "" });
        let name = [format!("{k2:.2}")].into_iter();
        rows.push(name.chain(line.iter().map(mark)).collect());
    }
    let title = format!(
        "Mean misses per face of the fast mode by weights (k1 = 1, K = {SIZE}) over {} meshes; < least.\n\
         The paper drew a surface and chose k2 = 0.5, k3 = 1.3.",
        meshes.len()
    );
    Figure {
        title,
        rows,
        json: json!({"k2": K2, "k3": K3, "fast": grid}),
    }
}

fn fig_9(found: &[Found]) -> Figure {
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
    let foci = random(mesh.vertex_count(), 9);
    let acmr = |&focus: &u32| {
        let algorithm = KCacheReorder {
            first_focus: Some(focus),
            ..algorithm(model, mode)
        };
        cache::acmr(&algorithm.face_order(mesh).apply(mesh.faces()), model)
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

fn fig_10(found: &[Found]) -> Figure {
    let meshes: Vec<&Mesh> = found
        .iter()
        .filter(|it| !it.is_large())
        .map(|it| &it.mesh)
        .collect();
    let kcr = |mesh: &Mesh, mode| algorithm(CacheModel::fifo(SIZE), mode).face_order(mesh);
    let methods = ["faithful", "fast", "Tipsify"];
    let mut ours = [[0.0; 6]; 3];
    for mesh in &meshes {
        let orders = [
            kcr(mesh, Mode::Faithful),
            kcr(mesh, Mode::Fast),
            tipsify(*mesh, SIZE),
        ];
        for (row, order) in ours.iter_mut().zip(orders) {
            let faces = order.apply(mesh.faces());
            for (sum, &size) in row.iter_mut().zip(&SIZES) {
                *sum += cache::acmr(&faces, CacheModel::fifo(size)) / meshes.len() as f64;
            }
        }
    }
    let mut rows = vec![head(&[
        "made for 12, used at",
        "K=10",
        "12",
        "16",
        "24",
        "32",
        "64",
    ])];
    rows.extend(
        methods
            .iter()
            .zip(ours)
            .map(|(name, row)| cells(*name, row)),
    );
    let title = format!(
        "Universality: mean misses per face of orders made for K = {SIZE}, over {} meshes.\n\
         The paper drew curves and printed no numbers.",
        meshes.len()
    );
    let json = json!({"sizes": SIZES, "faithful": ours[0], "fast": ours[1], "tipsify": ours[2]});
    Figure { title, rows, json }
}
