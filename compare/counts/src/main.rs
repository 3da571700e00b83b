//! Prepares meshes for counting, and runs one job once.
//!
//! ```text
//! counts flatten DATA FOLDER   writes the five meshes of the test data as plain numbers
//! counts list                  prints every mesh and job, a pair a line
//! counts run MESH JOB          prints the seconds and the most bytes in use at once
//! ```

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use counts::counting::{Counting, with_peak};
use counts::{JOBS, MESHES, SMALL_MESHES};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let result = match arguments[..] {
        ["flatten", data, folder] => counts::flatten(Path::new(data), Path::new(folder)),
        ["list"] => {
            list();
            Ok(())
        }
        ["run", mesh, job] => run(mesh, job),
        _ => Err("flatten DATA FOLDER, list, or run MESH JOB".to_owned()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn list() {
    for job in JOBS {
        for (mesh, _) in MESHES {
            if job.is_quick || SMALL_MESHES.contains(&mesh) {
                println!("{mesh} {}", job.name);
            }
        }
    }
}

fn run(mesh: &str, job: &str) -> Result<(), String> {
    let found = JOBS.iter().find(|known| known.name == job);
    let job = found.ok_or_else(|| format!("no job {job}"))?;
    let mesh = counts::mesh(mesh);
    let start = Instant::now();
    let ((), peak) = with_peak(|| (job.run)(mesh));
    println!("{} {peak}", start.elapsed().as_secs_f64());
    Ok(())
}
