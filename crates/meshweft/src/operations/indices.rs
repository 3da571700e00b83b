//! The main job on raw indices.

use super::algorithm::Algorithm;
use super::better::{better_vertex_order, is_gain};
use super::counts::VERTEX_SIZE;
use super::options::Options;
use super::shared_progress::SharedProgress;
use crate::cache;
use crate::error::MeshError;
use crate::faces::Faces;
use crate::index::BLOCK;
use crate::order::{Effort, Target, first_use_in_blocks, vertex_fetch};
use crate::permutation::{FaceOrder, VertexOrder};
use crate::progress::{Budget, Progress};

/// How [`optimize_indices`] orders.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct IndexOptions {
    /// What the order is to be good for.
    pub target: Target,
    /// How much time it is worth.
    pub effort: Effort,
    /// Seed of the search; the same seed gives the same indices.
    pub seed: u64,
    /// How much a search may do. What it finds with a budget is not checked.
    pub budget: Budget,
    /// Forbids turning corners (provoking vertex, data on edges).
    pub keep_corners: bool,
    /// Renumbers the vertices by first use, more than 65,536 in blocks of that many, which the order of the
    /// faces then keeps to. The caller then has to move every vertex buffer by
    /// [`Orders::vertices`].
    pub renumber_vertices: bool,
    /// Takes an order even if it misses more, unchecked.
    pub allow_worse: bool,
}

/// What was done to raw indices.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Orders {
    /// Which face went where, and how far its corners were turned. The indices are in that order
    /// already; what else is stored face by face has to follow.
    pub faces: FaceOrder,
    /// Which vertex got which number, if that was asked for: each vertex buffer has to follow, by
    /// `vertices.permutation().apply(&buffer)`.
    pub vertices: Option<VertexOrder>,
}

/// An index type: `u16` or `u32`.
pub trait VertexIndex: Copy + sealed::Sealed {}

impl VertexIndex for u16 {}
impl VertexIndex for u32 {}

mod sealed {
    /// The ways between an index and 32 bits.
    pub trait Sealed {
        fn widened(self) -> u32;
        fn narrowed(index: u32) -> Self;
    }

    impl Sealed for u16 {
        fn widened(self) -> u32 {
            self.into()
        }

        fn narrowed(index: u32) -> Self {
            // At most 65,536 vertices are used, so numbering them by first use fits.
            Self::try_from(index).expect("a renumbered index fits where the old ones did")
        }
    }

    impl Sealed for u32 {
        fn widened(self) -> u32 {
            self
        }

        fn narrowed(index: u32) -> Self {
            index
        }
    }
}

/// Puts flat indices, three a face, in an order that misses less, in place.
///
/// Positions are not needed. An order that does not miss less by .5 % is not taken, unless that is
/// allowed: the indices then stay as they are, and the orders returned change nothing. Run on its own
/// output it changes nothing, except with a budget or if worse orders are allowed: an order of up to
/// 131,072 faces is checked by ordering its result once more.
///
/// # Errors
/// [`MeshError`] if an index is not below `vertex_count`, or the last face is not whole. The
/// indices are unchanged then.
///
/// # Complexity
/// That of [`Optimizer::face_order`](crate::order::Optimizer::face_order), twice where the order is
/// checked.
///
/// ```
/// use meshweft::operations::{IndexOptions, optimize_indices};
/// // A strip of quads that jumps between its ends, as 16-bit indices.
/// let quad = |i: u16| [2 * i, 2 * i + 1, 2 * i + 3, 2 * i, 2 * i + 3, 2 * i + 2];
/// let mut indices: Vec<u16> = (0..50).flat_map(|i| [quad(i), quad(99 - i)]).flatten().collect();
/// let mut positions: Vec<[f32; 3]> = (0..202).map(|i| [i as f32, 0.0, 0.0]).collect();
///
/// let options = IndexOptions { renumber_vertices: true, ..Default::default() };
/// let orders = optimize_indices(&mut indices, positions.len(), &options)?;
/// if let Some(vertices) = orders.vertices {
///     positions = vertices.permutation().apply(&positions);
/// }
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[doc(alias = "optimize_vertex_cache")]
#[doc(alias = "optimize_vertex_cache_in_place")]
pub fn optimize_indices<I: VertexIndex>(
    indices: &mut [I],
    vertex_count: usize,
    options: &IndexOptions,
) -> Result<Orders, MeshError> {
    optimize_indices_with(indices, vertex_count, options, &())
}

/// As [`optimize_indices`], with progress reports, for callers who want to stop it or limit its time.
///
/// # Errors
/// As [`optimize_indices`].
///
/// # Complexity
/// As [`optimize_indices`].
pub fn optimize_indices_with<I: VertexIndex>(
    indices: &mut [I],
    vertex_count: usize,
    options: &IndexOptions,
    progress: &dyn Progress,
) -> Result<Orders, MeshError> {
    let (corners, []) = indices.as_chunks_mut::<3>() else {
        return Err(MeshError::PartialFace { len: indices.len() });
    };
    let mut faces: Vec<[u32; 3]> = corners.iter().map(|face| face.map(I::widened)).collect();
    Faces::new(&faces, vertex_count)?;

    let orders = options.orders(&mut faces, vertex_count, progress);
    for (corners, face) in corners.iter_mut().zip(faces) {
        *corners = face.map(I::narrowed);
    }
    Ok(orders)
}

impl IndexOptions {
    fn options(&self) -> Options {
        Options {
            target: self.target,
            effort: self.effort,
            greedy: None,
            seed: self.seed,
            budget: self.budget,
            keep_corners: self.keep_corners,
            keep_vertex_order: !self.renumber_vertices,
            allow_worse: self.allow_worse,
        }
    }

    /// Orders the faces where they are.
    fn orders(
        &self,
        faces: &mut Vec<[u32; 3]>,
        vertex_count: usize,
        progress: &dyn Progress,
    ) -> Orders {
        let algorithm = Algorithm::new(&self.options());
        let shared = SharedProgress::new(progress, faces.len());

        if self.renumber_vertices && vertex_count > BLOCK {
            let orders = in_blocks(&algorithm, faces, vertex_count, &shared);
            shared.finish();
            return orders;
        }

        // Faces.
        let now = Faces::of_checked(faces, vertex_count);
        let order = algorithm.run_order(now, None, None, &shared).order;
        if !order.is_identity() {
            *faces = order.apply(faces);
        }

        // Vertices.
        let vertices = self.renumber_vertices.then(|| {
            let now = Faces::of_checked(faces, vertex_count);
            let better = better_vertex_order(&[now], !order.is_identity());
            if let Some(order) = &better {
                order.renumber_in_place(faces);
            }
            better.unwrap_or_else(|| VertexOrder::identity(vertex_count))
        });
        shared.finish();
        Orders {
            faces: order,
            vertices,
        }
    }
}

/// Orders faces on more than 65,536 vertices, which are put in blocks first, and both where they are.
///
/// What an order costs is counted in the numbers that were given and in the new ones.
fn in_blocks(
    algorithm: &Algorithm,
    faces: &mut Vec<[u32; 3]>,
    vertex_count: usize,
    progress: &SharedProgress<'_>,
) -> Orders {
    let cost = |faces: &[[u32; 3]]| {
        let faces = Faces::of_checked(faces, vertex_count);
        algorithm.target().cost(faces)
    };

    // Blocks, faces, then vertices inside blocks.
    let blocks = vertex_fetch(Faces::of_checked(faces, vertex_count));
    let mut ordered = blocks.renumber(faces);
    let before = cost(faces);
    let now = Faces::of_checked(&ordered, vertex_count);
    let mut order = algorithm.run_order(now, None, Some(before), progress).order;
    if !order.is_identity() {
        let moved = order.apply(&ordered);
        match algorithm.refusal(before, cost(&moved)) {
            None => ordered = moved,
            Some(_) => order = FaceOrder::identity(faces.len()),
        }
    }
    let inside = first_use_in_blocks(Faces::of_checked(&ordered, vertex_count));
    inside.renumber_in_place(&mut ordered);
    let vertices = blocks.then(&inside);

    // Numbers alone are taken for what they are worth.
    let is_worth = || {
        let after = cost(&ordered);
        let fetched = |faces: &[[u32; 3]]| {
            let faces = Faces::of_checked(faces, vertex_count);
            cache::fetched(faces, VERTEX_SIZE)
        };
        is_gain(before, after) || after <= before && is_gain(fetched(faces), fetched(&ordered))
    };
    if order.is_identity() && !is_worth() {
        return Orders {
            faces: order,
            vertices: Some(VertexOrder::identity(vertex_count)),
        };
    }
    *faces = ordered;
    Orders {
        faces: order,
        vertices: Some(vertices),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cache::CacheModel;
    use crate::permutation::Permutation;

    /// A grid of squares, its faces and vertices shuffled.
    fn grid(side: u32) -> (Vec<[u32; 3]>, usize) {
        let square = |i: u32| {
            let corner = i / side * (side + 1) + i % side;
            let above = corner + side + 1;
            [[corner, corner + 1, above], [corner + 1, above + 1, above]]
        };
        let faces: Vec<_> = (0..side * side).flat_map(square).collect();
        let vertex_count = ((side + 1) * (side + 1)) as usize;
        let faces = Permutation::random(faces.len(), 1).apply(&faces);
        let vertices = VertexOrder::from(Permutation::random(vertex_count, 2));
        (vertices.renumber(&faces), vertex_count)
    }

    #[test]
    fn both_widths_are_ordered_alike_and_say_how() {
        let (faces, vertex_count) = grid(30);
        for renumber_vertices in [false, true] {
            for target in ["universal", "fifo:12", "nvidia", "controllable:9"] {
                let options = IndexOptions {
                    target: target.parse().unwrap(),
                    renumber_vertices,
                    ..IndexOptions::default()
                };
                let mut long = faces.as_flattened().to_vec();
                let mut short: Vec<u16> = long.iter().map(|&i| i.try_into().unwrap()).collect();
                let orders = optimize_indices(&mut long, vertex_count, &options).unwrap();
                let other = optimize_indices(&mut short, vertex_count, &options).unwrap();
                assert_eq!(orders, other);
                assert!(short.iter().zip(&long).all(|(&a, &b)| u32::from(a) == b));

                let mut expected = orders.faces.apply(&faces);
                assert_eq!(orders.vertices.is_some(), renumber_vertices);
                if let Some(vertices) = &orders.vertices {
                    expected = vertices.renumber(&expected);
                    assert!(!vertices.is_identity());
                }
                assert_eq!(long, expected.as_flattened());
                assert!(options.target.cost(&expected) < options.target.cost(&faces));

                let again = optimize_indices(&mut long, vertex_count, &options).unwrap();
                assert!(again.faces.is_identity(), "{target}");
                assert_eq!(again.vertices.is_some(), renumber_vertices);
                assert!(again.vertices.is_none_or(|order| order.is_identity()));
                assert_eq!(long, expected.as_flattened());
            }
        }
    }

    #[test]
    fn sixteen_bits_hold_what_they_held() {
        // More vertices than 16 bits count, but only those with 16-bit numbers are used.
        let shuffled = Permutation::random(65_535, 4);
        let indices = shuffled.new_to_old().iter();
        let mut indices: Vec<u16> = indices.map(|&i| i.try_into().unwrap()).collect();
        let options = IndexOptions {
            renumber_vertices: true,
            ..IndexOptions::default()
        };
        let orders = optimize_indices(&mut indices, 100_000, &options).unwrap();
        assert_eq!(orders.vertices.unwrap().len(), 100_000);
        assert_eq!(indices[..3], [0, 1, 2]);
    }

    #[test]
    fn bad_indices_stay_as_they_are() {
        let mut indices = [0_u32, 1, 2, 2, 1, 4];
        let options = IndexOptions::default();
        let error = optimize_indices(&mut indices, 4, &options).unwrap_err();
        assert_eq!(
            error.to_string(),
            "face 1, corner 2: index 4 is past the last vertex (3)"
        );
        assert_eq!(indices, [0, 1, 2, 2, 1, 4]);
        let error = optimize_indices(&mut [0_u16, 1], 4, &options).unwrap_err();
        assert_eq!(error, MeshError::PartialFace { len: 2 });
        let nothing = optimize_indices(&mut [0_u16; 0], 0, &options).unwrap();
        assert!(nothing.faces.is_empty() && nothing.vertices.is_none());
    }

    #[test]
    fn kept_corners_stay_and_worse_is_taken_only_if_allowed() {
        let (faces, vertex_count) = grid(12);
        let mut indices = faces.as_flattened().to_vec();
        let options = IndexOptions {
            keep_corners: true,
            ..IndexOptions::default()
        };
        let orders = optimize_indices(&mut indices, vertex_count, &options).unwrap();
        assert!(orders.faces.rotations().iter().all(|&r| r == 0));

        // Made for one cache, the order is worse for a much smaller one.
        let best = |size| IndexOptions {
            target: CacheModel::fifo(size).into(),
            effort: Effort::Best,
            ..IndexOptions::default()
        };
        let mut indices = faces.as_flattened().to_vec();
        optimize_indices(&mut indices, vertex_count, &best(8)).unwrap();
        let misses = |indices: &[u32]| {
            let faces = Faces::from_indices(indices, vertex_count).unwrap();
            cache::misses(faces, CacheModel::fifo(8))
        };
        let (kept, mut allowed) = (indices.clone(), indices.clone());
        let worse = IndexOptions {
            effort: Effort::Fast,
            allow_worse: true,
            ..best(8)
        };
        optimize_indices(&mut allowed, vertex_count, &worse).unwrap();
        assert!(misses(&allowed) > misses(&kept));
        let never = IndexOptions {
            allow_worse: false,
            ..worse
        };
        let orders = optimize_indices(&mut indices, vertex_count, &never).unwrap();
        assert!(orders.faces.is_identity() && indices == kept);
    }
}
