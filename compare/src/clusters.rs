//! A hierarchy of clusters, made as meshoptimizer's `clusterlod.h` makes it: clusters are joined to groups, each group is simplified
//! to half of its faces with its border locked, and cut into clusters again.
//!
//! As in its defaults: clusters of 128 faces, groups of 16. Positions count alone, and nothing is simplified beyond what
//! topology allows, as small parts would vanish.

use std::ffi::c_uint;

use meshopt::ffi;
use meshweft::Mesh;

use crate::rivals;

/// Most faces and vertices of a cluster, and how many clusters a group should have.
const CLUSTER: usize = 128;
const GROUP: usize = 16;
/// What a group is simplified to, and what is too little.
const RATIO: f64 = 0.5;
const THRESHOLD: f64 = 0.85;
/// `meshopt_SimplifySparse`, `meshopt_SimplifyErrorAbsolute`.
const OPTIONS: c_uint = 1 << 1 | 1 << 2;

/// Where a group is, and how far it is from the finest mesh when simplified.
#[derive(Debug, Clone, Copy)]
pub struct ErrorSphere {
    center: [f32; 3],
    radius: f32,
    error: f32,
}

impl ErrorSphere {
    /// How large the error is seen from an eye for which a length of 1 at distance 1 has this many pixels.
    #[must_use]
    pub fn pixels(&self, eye: [f64; 3], scale: f64) -> f64 {
        let distance = length(sub(self.center.map(f64::from), eye)) - f64::from(self.radius);
        f64::from(self.error) * scale / distance.max(f64::MIN_POSITIVE)
    }
}

/// Faces that are drawn or not as one.
#[derive(Debug, Clone)]
pub struct LodCluster {
    /// The faces.
    pub faces: Vec<[u32; 3]>,
    /// How many vertices they have.
    pub vertex_count: usize,
    /// Of the faces.
    bounds: ffi::meshopt_Bounds,
    /// Of the group that it was simplified from; none for the finest.
    finer: Option<ErrorSphere>,
    /// Of the group that it is in.
    coarser: ErrorSphere,
}

impl LodCluster {
    /// Whether it is drawn with a tolerance in pixels: it is exact enough, and what is coarser is not.
    #[must_use]
    pub fn is_in_cut(&self, eye: [f64; 3], scale: f64, tolerance: f64) -> bool {
        let is_off = |sphere: &ErrorSphere| sphere.pixels(eye, scale) > tolerance;
        is_off(&self.coarser) && !self.finer.as_ref().is_some_and(is_off)
    }

    /// Whether something of it may be seen: it is not outside of a side of the picture (planes through the eye, normals inward),
    /// and its cone is not turned away.
    #[must_use]
    pub fn may_be_seen(&self, eye: [f64; 3], sides: &[[f64; 3]]) -> bool {
        let bounds = &self.bounds;
        let way = sub(bounds.center.map(f64::from), eye);
        let is_outside = |side: &[f64; 3]| dot(*side, way) < -f64::from(bounds.radius);
        let to_apex = sub(bounds.cone_apex.map(f64::from), eye);
        let turn = dot(to_apex, bounds.cone_axis.map(f64::from));
        let is_turned_away = turn >= f64::from(bounds.cone_cutoff) * length(to_apex);
        !sides.iter().any(is_outside) && !is_turned_away
    }
}

/// A cluster while the hierarchy is made.
struct Pending {
    faces: Vec<[u32; 3]>,
    vertex_count: usize,
    finer: Option<ErrorSphere>,
    /// The cluster's own for the finest, then that of its group.
    sphere: ErrorSphere,
}

/// All clusters of a mesh.
///
/// # Panics
/// If the mesh has no positions.
#[must_use]
pub fn hierarchy(mesh: &Mesh) -> Vec<LodCluster> {
    let places = places(mesh);
    let mut clusters = clusters(mesh, mesh.faces(), None);
    let mut made = Vec::new();
    while clusters.len() > 1 {
        let groups = groups(mesh, &places, clusters);
        let locks = locks(&places, &groups);
        let mut next = Vec::new();
        for group in groups {
            // Errors and spheres only grow.
            let faces: Vec<[u32; 3]> = group.iter().flat_map(|it| it.faces.clone()).collect();
            let mut sphere = joined(&group);
            let (simplified, error) = simplified(mesh, &faces, &locks);
            let is_stuck = simplified.len() as f64 > faces.len() as f64 * THRESHOLD;
            sphere.error = if is_stuck {
                f32::MAX
            } else {
                sphere.error.max(error)
            };
            made.extend(group.into_iter().map(|it| finished(mesh, it, sphere)));
            if !is_stuck {
                next.extend(self::clusters(mesh, &simplified, Some(sphere)));
            }
        }
        clusters = next;
    }
    let last = clusters.into_iter().map(|it| {
        let sphere = ErrorSphere {
            error: f32::MAX,
            ..it.sphere
        };
        finished(mesh, it, sphere)
    });
    made.extend(last);
    made
}

fn finished(mesh: &Mesh, pending: Pending, coarser: ErrorSphere) -> LodCluster {
    LodCluster {
        bounds: bounds(mesh, &pending.faces),
        faces: pending.faces,
        vertex_count: pending.vertex_count,
        finer: pending.finer,
        coarser,
    }
}

/// Some faces cut into clusters.
fn clusters(mesh: &Mesh, faces: &[[u32; 3]], finer: Option<ErrorSphere>) -> Vec<Pending> {
    let part = Mesh::new(mesh.positions(), faces).expect("faces of the mesh");
    let meshlets = rivals::meshlets(&part, CLUSTER, CLUSTER, 0.0).into_iter();
    let pending = |meshlet: rivals::RivalMeshlet| {
        let vertex = |at: u8| meshlet.vertices[usize::from(at)];
        let faces: Vec<_> = meshlet.faces.iter().map(|face| face.map(vertex)).collect();
        let own = || {
            let bounds = bounds(mesh, &faces);
            ErrorSphere {
                center: bounds.center,
                radius: bounds.radius,
                error: 0.0,
            }
        };
        Pending {
            vertex_count: meshlet.vertices.len(),
            sphere: finer.unwrap_or_else(own),
            faces,
            finer,
        }
    };
    meshlets.map(pending).collect()
}

/// Clusters that share vertices, or are near, together.
fn groups(mesh: &Mesh, places: &[u32], clusters: Vec<Pending>) -> Vec<Vec<Pending>> {
    let faces = clusters.iter().flat_map(|it| &it.faces);
    let faces = faces.map(|face| face.map(|vertex| places[vertex as usize]));
    let faces: Vec<[u32; 3]> = faces.collect();
    let counts = clusters.iter().map(|it| 3 * it.faces.len());
    let counts: Vec<u32> = counts
        .map(|count| u32::try_from(count).expect("a cluster is small"))
        .collect();
    let mut group_of = vec![0_u32; clusters.len()];
    // SAFETY: the arrays have the lengths that are given with them: a group for each cluster, all indices, whose counts
    // add up to their number and which are below the number of positions, 12 bytes each.
    let count = unsafe {
        ffi::meshopt_partitionClusters(
            group_of.as_mut_ptr(),
            faces.as_ptr().cast(),
            3 * faces.len(),
            counts.as_ptr(),
            clusters.len(),
            mesh.positions().as_ptr().cast(),
            mesh.vertex_count(),
            size_of::<[f32; 3]>(),
            GROUP,
        )
    };
    let mut groups: Vec<Vec<Pending>> = (0..count).map(|_| Vec::new()).collect();
    for (cluster, group) in clusters.into_iter().zip(group_of) {
        groups[group as usize].push(cluster);
    }
    groups.retain(|group| !group.is_empty());
    groups
}

/// Of each vertex the first one at its position.
fn places(mesh: &Mesh) -> Vec<u32> {
    let mut places = vec![0; mesh.vertex_count()];
    // SAFETY: there is room for a number for each of the positions, 12 bytes each.
    unsafe {
        ffi::meshopt_generatePositionRemap(
            places.as_mut_ptr(),
            mesh.positions().as_ptr().cast(),
            mesh.vertex_count(),
            size_of::<[f32; 3]>(),
        );
    }
    places
}

/// Of each vertex 1 if several groups have its place, or else 0.
fn locks(places: &[u32], groups: &[Vec<Pending>]) -> Vec<u8> {
    let mut owner = vec![usize::MAX; places.len()];
    let mut locks = vec![0; places.len()];
    for (number, group) in groups.iter().enumerate() {
        let faces = group.iter().flat_map(|it| &it.faces);
        for &vertex in faces.flatten() {
            let place = places[vertex as usize] as usize;
            if owner[place] == usize::MAX {
                owner[place] = number;
            }
            locks[place] |= u8::from(owner[place] != number);
        }
    }
    places.iter().map(|&place| locks[place as usize]).collect()
}

/// Half of the faces as far as that can be, and how far they are off.
fn simplified(mesh: &Mesh, faces: &[[u32; 3]], locks: &[u8]) -> (Vec<[u32; 3]>, f32) {
    let mut simplified = vec![[0_u32; 3]; faces.len()];
    let mut error = 0.0;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most the number of faces"
    )]
    let asked = (faces.len() as f64 * RATIO) as usize;
    // SAFETY: the first pointer is to room for as many indices as the second has, which are below the number of positions and of
    // locks; there are no attributes.
    let index_count = unsafe {
        ffi::meshopt_simplifyWithAttributes(
            simplified.as_mut_ptr().cast(),
            faces.as_ptr().cast(),
            3 * faces.len(),
            mesh.positions().as_ptr().cast(),
            mesh.vertex_count(),
            size_of::<[f32; 3]>(),
            std::ptr::null(),
            0,
            std::ptr::null(),
            0,
            locks.as_ptr(),
            3 * asked,
            f32::MAX,
            OPTIONS,
            &raw mut error,
        )
    };
    simplified.truncate(index_count / 3);
    (simplified, error)
}

fn bounds(mesh: &Mesh, faces: &[[u32; 3]]) -> ffi::meshopt_Bounds {
    // SAFETY: the indices are of at most 128 faces and below the number of positions, 12 bytes each.
    unsafe {
        ffi::meshopt_computeClusterBounds(
            faces.as_ptr().cast(),
            3 * faces.len(),
            mesh.positions().as_ptr().cast(),
            mesh.vertex_count(),
            size_of::<[f32; 3]>(),
        )
    }
}

/// A sphere around those of a group, with the largest error.
fn joined(group: &[Pending]) -> ErrorSphere {
    let spheres: Vec<[f32; 4]> = group
        .iter()
        .map(|it| {
            let [x, y, z] = it.sphere.center;
            [x, y, z, it.sphere.radius]
        })
        .collect();
    let first = spheres.as_ptr().cast::<f32>();
    // SAFETY: each sphere has its center first and its radius after it, 16 bytes each.
    let bounds =
        unsafe { ffi::meshopt_computeSphereBounds(first, spheres.len(), 16, first.add(3), 16) };
    let errors = group.iter().map(|it| it.sphere.error);
    ErrorSphere {
        center: bounds.center,
        radius: bounds.radius,
        error: errors.fold(0.0, f32::max),
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}
