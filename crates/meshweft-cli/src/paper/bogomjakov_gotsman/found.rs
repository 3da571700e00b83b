//! The paper's meshes that a file was found for, and what it printed of them.

use std::path::{Path, PathBuf};

use anyhow::Result;
use meshweft::operations::Method;
use meshweft::{CacheModel, Mesh, cache};

use crate::paper::meshes::open;

/// A row of tables 1 and 2.
pub(super) struct Printed {
    pub(super) mesh: &'static str,
    /// Used vertices and faces.
    pub(super) size: [usize; 2],
    /// Table 1: seconds for the recursive cut, on a Pentium III of 550 MHz.
    pub(super) seconds: f64,
    /// Table 2: misses per face at a cache of 10 as in the file, by recursive cut and as triangle
    /// strips.
    pub(super) acmr: Option<[f64; 3]>,
    pub(super) files: &'static [&'static str],
}

/// Regular32 is made here.
#[rustfmt::skip]
pub(super) const MESHES: [Printed; 6] = [
    Printed { mesh: "Bunny (simplified)", size: [1092, 2084], seconds: 0.6, acmr: Some([2.76, 0.81, 1.06]), files: &["bunny_simplified"] },
    Printed { mesh: "Flipper", size: [6179, 12337], seconds: 5.4, acmr: Some([1.84, 0.83, 1.10]), files: &["flipper"] },
    Printed { mesh: "Face", size: [12530, 24118], seconds: 9.5, acmr: Some([1.34, 0.83, 1.10]), files: &["face"] },
    Printed { mesh: "Horse", size: [19851, 39698], seconds: 18.0, acmr: Some([2.83, 0.81, 1.09]), files: &["horse_20k", "horse"] },
    Printed { mesh: "Buddha", size: [32316, 67240], seconds: 27.0, acmr: Some([1.00, 0.81, 1.08]), files: &["buddha_res3"] },
    Printed { mesh: "Bunny", size: [34834, 69451], seconds: 32.0, acmr: Some([1.00, 0.83, 1.08]), files: &["bunny"] },
];
pub(super) const REGULAR_32: ([usize; 2], f64) = ([561, 1024], 0.3);

pub(super) struct Found {
    pub(super) printed: &'static Printed,
    pub(super) file: PathBuf,
    pub(super) mesh: Mesh,
}

impl Found {
    /// All whose files are in the folder.
    pub(super) fn open_all(folder: &Path) -> Result<Vec<Self>> {
        let mut found = Vec::new();
        for printed in &MESHES {
            if let Some((file, mesh)) = open(folder, printed.files)? {
                found.push(Self {
                    printed,
                    file,
                    mesh,
                });
            }
        }
        Ok(found)
    }

    /// The paper's name of the mesh, starred if the file is another version of it.
    pub(super) fn name(&self) -> String {
        let used = cache::report(self.mesh.faces(), CacheModel::fifo(10)).used_vertices;
        let is_the_papers = self.printed.size == [used, self.mesh.face_count()];
        format!(
            "{}{}",
            self.printed.mesh,
            if is_the_papers { "" } else { "*" }
        )
    }
}

/// Misses per face of a FIFO cache.
pub(super) fn fifo(faces: &[[u32; 3]], size: u32) -> f64 {
    cache::acmr(faces, CacheModel::fifo(size))
}

/// The faces in the order of a method.
pub(super) fn ordered(method: Method, mesh: &Mesh) -> Vec<[u32; 3]> {
    method.order(mesh).apply(mesh.faces())
}
