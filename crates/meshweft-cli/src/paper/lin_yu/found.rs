//! The paper's meshes that a file was found for, and how the algorithm does on one.

use std::path::{Path, PathBuf};

use anyhow::Result;
use meshweft::operations::{Greedy, Method};
use meshweft::order::Mode;
use meshweft::{CacheModel, Mesh, cache};

use super::printed::Printed;
use crate::paper::meshes::{self, LARGE};

/// Cache size of Figs. 3, 8, 9 and 10.
pub(super) const SIZE: u32 = 12;

/// A mesh of the paper that a file was found for.
pub(super) struct Found {
    pub(super) printed: &'static Printed,
    pub(super) file: PathBuf,
    pub(super) mesh: Mesh,
}

impl Found {
    /// The mesh of this row, if a file has its name.
    pub(super) fn open(printed: &'static Printed, folder: &Path) -> Result<Option<Self>> {
        let found = meshes::open(folder, printed.files)?;
        Ok(found.map(|(file, mesh)| Self {
            printed,
            file,
            mesh,
        }))
    }

    /// Misses per face in the file's order.
    pub(super) fn original(&self) -> f64 {
        cache::acmr(self.mesh.faces(), CacheModel::fifo(SIZE))
    }

    /// Whether the file has the paper's faces in the paper's order, as far as the table can tell.
    pub(super) fn is_the_papers(&self) -> bool {
        let same_count = self.mesh.face_count() == self.printed.faces;
        same_count && (self.original() - self.printed.original).abs() < 0.0006
    }

    /// The paper's name of the mesh, starred if the file is another version of it.
    pub(super) fn name(&self) -> String {
        let star = if self.is_the_papers() { "" } else { "*" };
        format!("{}{star}", self.printed.mesh)
    }

    /// Whether the figures that take many runs leave it out.
    pub(super) fn is_large(&self) -> bool {
        self.mesh.face_count() > LARGE
    }
}

/// The algorithm with the weights of the paper.
pub(super) fn algorithm(cache: CacheModel, mode: Mode) -> Method {
    Method::KCacheReorder {
        cache,
        greedy: Greedy::of_mode(mode),
        first_focus: None,
    }
}

/// Misses per face of the order made for a FIFO cache.
pub(super) fn fifo(mesh: &Mesh, size: u32, mode: Mode) -> f64 {
    let model = CacheModel::fifo(size);
    let order = algorithm(model, mode).order(mesh);
    cache::acmr(&order.apply(mesh.faces()), model)
}

/// Pushes per face as scheduled, and by the best schedule for the same order.
pub(super) fn control(mesh: &Mesh, size: u32, mode: Mode) -> [f64; 2] {
    let model = CacheModel::controllable(size);
    let (order, pushes) = algorithm(model, mode).scheduled_order(mesh);
    let scheduled = pushes as f64 / mesh.face_count().max(1) as f64;
    [scheduled, cache::acmr(&order.apply(mesh.faces()), model)]
}
