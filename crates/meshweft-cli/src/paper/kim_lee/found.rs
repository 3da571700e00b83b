//! The meshes that are counted, among the user's files and made here.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use anyhow::{Result, anyhow};
use meshweft::Mesh;
use meshweft::operations::{FacePlanes, ViewFrom};

use super::printed::{MESHES, Printed, SPHERE};
use crate::paper::figure::mean;
use crate::paper::meshes::open;

/// *N*, as in the paper.
pub(super) const RANGES: u32 = 512;
/// How far the eye is where the paper does not say otherwise, in radii.
pub(super) const DISTANCE: f64 = 4.0;

/// A mesh, and the paper's row of it or of another version.
pub(super) struct Found {
    pub(super) name: String,
    pub(super) mesh: Mesh,
    pub(super) planes: FacePlanes,
    pub(super) printed: &'static Printed,
}

impl Found {
    /// The paper's meshes, or the nearest ones, in its order; with the sphere, which is made here, unless no file is found.
    pub(super) fn open_all(data: &Path) -> Result<Vec<Self>> {
        let mut found = Vec::new();
        for printed in &MESHES {
            let mesh = match printed.mesh {
                SPHERE => sphere(128, 256),
                _ => match open(data, printed.files)? {
                    Some((file, mesh)) if FacePlanes::of(&mesh).is_none() => {
                        return Err(anyhow!(
                            "{}: the mesh has no faces with finite positions, so nothing says which of them are \
                             seen: take the file out of the folder, or give it positions",
                            file.display()
                        ));
                    }
                    Some((file, mesh)) if lies_on_its_side(&file) => upright(&mesh)?,
                    Some((_, mesh)) => mesh,
                    None => continue,
                },
            };
            found.extend(of_mesh(mesh, printed));
        }
        if found.iter().all(|it| it.printed.mesh == SPHERE) {
            found.clear();
        }
        Ok(found)
    }

    /// A number of faces as a share of all.
    pub(super) fn share(&self, faces: usize) -> f64 {
        faces as f64 / self.mesh.face_count() as f64
    }
}

/// Whether z is upward in a known file, and x forward: elsewhere these are y and z.
fn lies_on_its_side(file: &Path) -> bool {
    let name = file.file_name().map(|name| name.to_string_lossy());
    name.is_some_and(|name| name.starts_with("venus_bust."))
}

/// The same mesh with y upward and z forward.
fn upright(mesh: &Mesh) -> Result<Mesh> {
    let positions = mesh.positions().iter().map(|&[x, y, z]| [y, z, x]);
    Ok(Mesh::new(positions.collect::<Vec<_>>(), mesh.faces())?)
}

/// With a star where the paper's mesh has another number of faces; `None` without finite positions.
pub(super) fn of_mesh(mesh: Mesh, printed: &'static Printed) -> Option<Found> {
    let is_the_papers = mesh.face_count() == printed.faces;
    let star = if is_the_papers { "" } else { "*" };
    FacePlanes::of(&mesh).map(|planes| Found {
        name: format!("{}{star}", printed.mesh),
        mesh,
        planes,
        printed,
    })
}

/// The mean of a number over views.
pub(super) fn mean_over(views: &[ViewFrom], number: impl Fn(ViewFrom) -> f64) -> f64 {
    mean(views.iter().map(|&view| number(view)))
}

/// A sphere of radius 1 by rings, with `2 * (rings - 1) * around` faces, those of a ring one after the other.
pub(super) fn sphere(rings: u32, around: u32) -> Mesh {
    #[expect(clippy::cast_possible_truncation, reason = "positions are f32")]
    let point = |ring: u32, step: u32| {
        let latitude = PI * f64::from(ring) / f64::from(rings);
        let longitude = TAU * f64::from(step) / f64::from(around);
        let (sine, height) = (latitude.sin(), latitude.cos());
        [sine * longitude.sin(), height, sine * longitude.cos()].map(|x| x as f32)
    };
    let steps = (0..=rings).flat_map(|ring| (0..around).map(move |step| (ring, step)));
    let positions: Vec<_> = steps.map(|(ring, step)| point(ring, step)).collect();
    let mut faces = Vec::new();
    for ring in 0..rings {
        for step in 0..around {
            let at = |ring: u32, step: u32| ring * around + step % around;
            let [a, b] = [at(ring, step), at(ring + 1, step)];
            let [c, d] = [at(ring + 1, step + 1), at(ring, step + 1)];
            if ring + 1 < rings {
                faces.push([a, b, c]);
            }
            if ring > 0 {
                faces.push([a, c, d]);
            }
        }
    }
    Mesh::new(positions, faces).expect("all indices are of the grid")
}
