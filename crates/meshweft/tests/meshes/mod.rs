//! Meshes that proptest makes: soups, fans, grids, and several of them side by side.

use meshweft::Mesh;
use proptest::collection::vec;
use proptest::prelude::*;

type Parts = (u32, Vec<[u32; 3]>);

/// Any mesh: up to three parts, unused vertices, faces that come twice, in file order or shuffled.
pub(crate) fn any_mesh() -> impl Strategy<Value = Mesh> {
    let parts = vec(any_part(), 0..4).prop_map(|parts| parts.into_iter().fold((0, vec![]), join));
    let unused = prop_oneof![3 => Just(0), 1 => 1_u32..20];
    (parts, unused, any::<bool>(), 0..4_usize).prop_flat_map(|(parts, unused, shuffle, twice)| {
        let (vertex_count, mut faces) = parts;
        faces.extend_from_within(..twice.min(faces.len()));
        let faces = match shuffle {
            true => Just(faces).prop_shuffle().boxed(),
            false => Just(faces).boxed(),
        };
        faces.prop_map(move |faces| {
            let vertex_count = (vertex_count + unused) as usize;
            Mesh::connectivity_only(vertex_count, faces).expect("indices are in range")
        })
    })
}

fn join((vertices, mut faces): Parts, (more_vertices, more_faces): Parts) -> Parts {
    faces.extend(more_faces.iter().map(|face| face.map(|v| v + vertices)));
    (vertices + more_vertices, faces)
}

fn any_part() -> impl Strategy<Value = Parts> {
    prop_oneof![3 => soup(), 1 => fan(), 3 => grid(), 1 => same_faces()]
}

/// Faces over few vertices: degenerate, repeated, non-manifold.
fn soup() -> impl Strategy<Value = Parts> {
    (1_u32..40).prop_flat_map(|vertex_count| {
        let face = prop::array::uniform3(0..vertex_count);
        (Just(vertex_count), vec(face, 0..70))
    })
}

/// Faces around one vertex, more than the orders look at one by one; closed or open.
fn fan() -> impl Strategy<Value = Parts> {
    (1_u32..200, any::<bool>()).prop_map(|(valence, closed)| {
        let rim = |i: u32| 1 + if closed { i % valence } else { i };
        let faces = (0..valence).map(|i| [0, rim(i), rim(i + 1)]).collect();
        (valence + 2, faces)
    })
}

/// A rectangle of quads, each cut along either diagonal: a manifold with a boundary.
fn grid() -> impl Strategy<Value = Parts> {
    (1_u32..14, 1_u32..14).prop_flat_map(|(width, height)| {
        let quads = (width * height) as usize;
        vec(any::<bool>(), quads).prop_map(move |flipped| {
            let quad = |(at, flipped): (u32, &bool)| {
                let a = at / width * (width + 1) + at % width;
                let (b, c, d) = (a + 1, a + width + 1, a + width + 2);
                match flipped {
                    true => [[a, b, d], [a, d, c]],
                    false => [[a, b, c], [c, b, d]],
                }
            };
            let faces = (0..).zip(&flipped).flat_map(quad).collect();
            ((width + 1) * (height + 1), faces)
        })
    })
}

/// One face again and again.
fn same_faces() -> impl Strategy<Value = Parts> {
    (prop::array::uniform3(0_u32..3), 1_usize..80).prop_map(|(face, count)| (3, vec![face; count]))
}
