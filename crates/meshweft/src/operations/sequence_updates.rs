//! Every sequence update by name, for comparison, and histories to compare them on.

use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::permutation::FaceOrder;
use crate::progressive::{AdaptiveUpdate, Collapses, History, SimpleUpdate, SmartUpdate};

/// A way to keep up the rendering sequence of a full mesh along a history.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SequenceUpdate {
    /// Bogomjakov, Gotsman 2002: free places are filled from the front.
    Simple,
    /// Bogomjakov, Gotsman 2002: a new face takes the place of one that it shares vertices with.
    Smart,
    /// Lin, Yu 2006: a new face is drawn where the first of its vertices turned black.
    Adaptive,
}

impl SequenceUpdate {
    /// All of them, in the order of the years.
    pub const SHOWN: [Self; 3] = [Self::Simple, Self::Smart, Self::Adaptive];

    /// What it is called.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Simple => "simple",
            Self::Smart => "smart",
            Self::Adaptive => "adaptive",
        }
    }

    /// Goes from level to level, from full resolution on, and calls `visit` with the faces of each in
    /// the order of drawing. `order` is of the full mesh.
    ///
    /// # Errors
    /// As [`AdaptiveUpdate::new`].
    ///
    /// # Panics
    /// If the history has no such level.
    ///
    /// ```
    /// use meshweft::FaceOrder;
    /// use meshweft::operations::SequenceUpdate;
    /// use meshweft::progressive::HistoryBuilder;
    /// let history = HistoryBuilder::new(&[[0, 1, 2], [2, 1, 3]]).finish();
    /// let order = FaceOrder::identity(2);
    /// let mut counts = Vec::new();
    /// SequenceUpdate::Smart.at_levels(&history, &order, [0], |faces| counts.push(faces.len()))?;
    /// assert_eq!(counts, [2]);
    /// # Ok::<(), meshweft::MeshError>(())
    /// ```
    pub fn at_levels(
        self,
        history: &History,
        order: &FaceOrder,
        levels: impl IntoIterator<Item = usize>,
        mut visit: impl FnMut(&[[u32; 3]]),
    ) -> Result<(), MeshError> {
        macro_rules! along {
            ($update:ident) => {{
                let mut sequence = $update::new(history, order)?;
                let mut faces = Vec::new();
                for level in levels {
                    sequence.go_to(level);
                    sequence.emit_faces(&mut faces);
                    visit(&faces);
                }
            }};
        }
        match self {
            Self::Simple => along!(SimpleUpdate),
            Self::Smart => along!(SmartUpdate),
            Self::Adaptive => along!(AdaptiveUpdate),
        }
        Ok(())
    }
}

/// The history of half-edge collapses at effort `fast`, down to at most `faces` faces or as few as can be:
/// [`Collapses`] with everything else at its default.
///
/// # Errors
/// As [`Collapses::build`] and [`ProgressiveMesh::history`](crate::progressive::ProgressiveMesh::history).
///
/// # Complexity
/// As [`Collapses::build`].
///
/// ```
/// use meshweft::{Mesh, operations};
/// // A pyramid over a square: its tip leaves.
/// let positions = [[1.0, 1.0, 0.1], [0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
/// let mesh = Mesh::new(positions, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])?;
/// let history = operations::collapse_history(&mesh, 2)?;
/// assert_eq!((history.removal_order(), history.face_count(1)), (&[0][..], 2));
/// # Ok::<(), meshweft::MeshError>(())
/// ```
pub fn collapse_history(mesh: &Mesh, faces: usize) -> Result<History, MeshError> {
    let settings = Collapses {
        faces,
        ..Collapses::default()
    };
    settings.build(mesh, &[])?.history()
}
