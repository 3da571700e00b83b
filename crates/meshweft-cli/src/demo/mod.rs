//! `demo`: every method on meshes made here.

mod meshes;
mod picture;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Args;
use meshweft::attribute::{Attribute, Semantic};
use meshweft::files::{self, NewMesh, NewVertices};
use meshweft::geometry::vertex_normals;
use meshweft::operations::Method;
use meshweft::order::{Effort, Mode};
use meshweft::{CacheModel, Mesh, cache};
use serde_json::{Value, json};

use crate::columns::columns;
use crate::run::output::Report;
use crate::usage::Usage;

#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// The folder to write to
    #[arg(short, long, value_name = "DIR", default_value = "meshweft-demo")]
    output: PathBuf,
    /// About how many faces each mesh has
    #[arg(long, value_name = "N", default_value_t = 100_000,
          value_parser = clap::value_parser!(u32).range(500..=4_000_000))]
    faces: u32,
    #[command(flatten)]
    report: Report,
}

/// The name of the picture.
const PICTURE: &str = "before-after.png";

/// Cache sizes of the columns.
const SIZES: [u32; 3] = [12, 16, 32];
/// GPU models of the columns, counted on the order made for the first size.
const GPUS: [CacheModel; 3] = [CacheModel::Nvidia, CacheModel::AMD, CacheModel::INTEL];

/// The orders of the rows, made for a FIFO cache of a size where that matters.
const METHODS: [fn(u32) -> Method; 6] = [
    |_| Method::AsItIs,
    |_| Method::Random { seed: 7 },
    |size| Method::Tipsify { size },
    |size| Method::k_cache_reorder(size, Mode::Faithful),
    |size| Method::k_cache_reorder(size, Mode::Fast),
    |_| Method::Universal {
        effort: Effort::Fast,
    },
];

/// Refuses a folder in which a file has one of the demo's names, and no demo made it.
fn check_free(folder: &Path) -> Result<()> {
    let is_own = |name: &str| {
        let start = fs::read(folder.join(name)).unwrap_or_default();
        let start = &start[..start.len().min(1 << 10)];
        start.windows(8).any(|word| word == b"meshweft")
    };
    let names = ["knot.glb", "isosurface.glb"];
    let made_here = names.iter().all(|name| is_own(name));
    let mut others = names.into_iter().chain([PICTURE]);
    match others.find(|name| !made_here && folder.join(name).exists()) {
        Some(name) => Err(Usage(format!(
            "{}: this file is not one that the demo made: choose another folder",
            folder.join(name).display()
        ))
        .into()),
        None => Ok(()),
    }
}

/// Makes the meshes, orders them, prints what came out, writes a GLB and a picture.
pub(crate) fn run(arguments: &Demo) -> Result<()> {
    let folder = &arguments.output;
    check_free(folder)?;
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;

    // The meshes.
    let knot = meshes::knot(arguments.faces);
    let surface = meshes::isosurface(arguments.faces);
    let inputs = [
        ("knot", "knotted tube, ring by ring", knot.clone()),
        (
            "knot-shuffled",
            "knotted tube, shuffled",
            meshes::shuffled(&knot),
        ),
        ("isosurface", "isosurface, cell by cell", surface.clone()),
        (
            "isosurface-shuffled",
            "isosurface, shuffled",
            meshes::shuffled(&surface),
        ),
    ];

    // The orders.
    let mut results = Vec::new();
    for (name, title, mesh) in &inputs {
        let rows: Vec<Row> = METHODS.iter().map(|&method| row(mesh, method)).collect();
        arguments.report.text(&text(title, mesh, &rows))?;
        results.push(json!({
            "name": name,
            "faces": mesh.face_count(),
            "vertices": mesh.vertex_count(),
            "methods": rows.iter().map(Row::json).collect::<Vec<_>>(),
        }));
    }

    // The files.
    let method = Method::k_cache_reorder(SIZES[0], Mode::Fast);
    let (knot, ordered_surface) = (method.applied(&knot), method.applied(&surface));
    let mut files = Vec::new();
    for (name, mesh) in [("knot", &knot), ("isosurface", &ordered_surface)] {
        let path = folder.join(name).with_extension("glb");
        write_glb(mesh, name, &path)?;
        files.push(path.display().to_string());
    }
    let picture = picture::before_and_after(&surface, &ordered_surface, CacheModel::fifo(12));
    let path = folder.join(PICTURE);
    fs::write(&path, picture).with_context(|| path.display().to_string())?;
    files.push(path.display().to_string());

    let members = json!({"meshes": results, "files": files});
    arguments.report.json("demo", &members)?;
    let text = format!(
        "written: {}\nIn the picture, left before, right after: grey faces hit the cache of 12 with \
         all corners,\nblue ones miss one, yellow ones two, red ones three.",
        files.join(", ")
    );
    Ok(arguments.report.text(&text)?)
}

/// Writes a mesh with normals.
fn write_glb(mesh: &Mesh, name: &str, path: &Path) -> Result<()> {
    let normals = vertex_normals(mesh.positions(), mesh.faces());
    let attributes = [
        Attribute::of_vertices(Semantic::Position, mesh.positions()),
        Attribute::of_vertices(Semantic::Normal, &normals),
    ];
    let new = NewMesh::new(name, NewVertices::Stored(&attributes), mesh.faces());
    files::create(path, &[new], true)?;
    Ok(())
}

/// What one method did to one mesh.
struct Row {
    method: &'static str,
    acmr: [f64; SIZES.len()],
    atvr: [f64; GPUS.len()],
    milliseconds: f64,
}

impl Row {
    fn json(&self) -> Value {
        let acmr = SIZES.iter().zip(self.acmr);
        let acmr = acmr.map(|(size, x)| (format!("fifo:{size}"), json!(x)));
        let atvr = GPUS.iter().zip(self.atvr);
        let atvr = atvr.map(|(model, x)| (model.to_string(), json!(x)));
        json!({
            "method": self.method,
            "acmr": Value::Object(acmr.collect()),
            "atvr": Value::Object(atvr.collect()),
            "milliseconds": self.milliseconds,
        })
    }
}

/// Orders for each size, counts each order at its size and the first on the GPUs.
fn row(mesh: &Mesh, method: fn(u32) -> Method) -> Row {
    let mut times = Vec::new();
    let orders = SIZES.map(|size| {
        let start = Instant::now();
        let order = method(size).order(mesh);
        times.push(start.elapsed().as_secs_f64() * 1000.0);
        order.apply(mesh.faces())
    });
    times.sort_by(f64::total_cmp);
    let acmr = [0, 1, 2].map(|i| cache::acmr(&orders[i], CacheModel::fifo(SIZES[i])));
    Row {
        method: method(SIZES[0]).name(),
        acmr,
        atvr: GPUS.map(|gpu| cache::atvr(&orders[0], gpu)),
        milliseconds: times[times.len() / 2],
    }
}

fn text(title: &str, mesh: &Mesh, rows: &[Row]) -> String {
    let head = [
        "",
        "ACMR 12",
        "16",
        "32",
        "ATVR nvidia",
        "amd",
        "intel",
        "ms",
    ];
    let mut lines = vec![head.map(str::to_owned).to_vec()];

    for row in rows {
        let ratios = row.acmr.iter().chain(&row.atvr).map(|x| format!("{x:.3}"));
        let time = match row.method {
            "as it comes" => String::new(),
            _ => format!("{:.1}", row.milliseconds),
        };
        let name = std::iter::once(row.method.to_owned());
        lines.push(name.chain(ratios).chain([time]).collect());
    }

    format!(
        "{title}: {} faces, {} vertices\n{}\n",
        mesh.face_count(),
        mesh.vertex_count(),
        columns(&lines)
    )
}
