//! Sequence updates: the rendering sequence of the full mesh, kept up as the mesh gets coarser and
//! finer along a [`History`](super::History).
//!
//! Alexander Bogomjakov, Craig Gotsman 2002, doi:10.1111/1467-8659.00573, section 3 and Fig. 5:
//! [`SimpleUpdate`], [`SmartUpdate`]. Gang Lin, Thomas P.-Y. Yu 2006, doi:10.1109/TVCG.2006.59,
//! section 3: [`AdaptiveUpdate`].
//!
//! A record takes faces out of the sequence, which leaves their places free, and brings fewer new
//! faces. *Simple* gives the new faces the free places one after the other. *Smart* gives each the
//! place of a removed face that it has two vertices in common with, or else one. *Adaptive* puts
//! each where one of its vertices turned black in the full sequence, whether a place is free there
//! or not.
//!
//! Every update starts from any order of the full mesh, goes both ways, and gives each level the
//! same sequence whatever the way there; back at full resolution, the order that it started from.
//!
//! # Where the papers leave room
//! - *Simple* fills the free places of one record from the front, with the new faces in the order of
//!   the record. "The first n − 2 indices" (2002) and "the empty positions sequentially" (2006) say
//!   this, and not that a record takes places which others left.
//! - *In which order has a record its new faces?* The papers do not say, and *simple* depends on it.
//!   [`ProgressiveMesh::history`](super::ProgressiveMesh::history) lists them around the removed vertex, as
//!   a simplifier that retriangulates a hole would.
//! - *A place is given once.* Fig. 5 empties `S(t)` when `t`'s place is given, but its loops
//!   do not ask for that before they give it again, and go on after a face has its place. Here a face
//!   takes the first free place that fits, and stops looking.
//! - *Who is first*: removed faces are gone through by their places, from the first ("positions
//!   k1, …, kn"), new faces in the order of the record. Of equally short lists the one of the first
//!   new face is taken; the head of a list is the removed face of the first place. In the order of
//!   the record instead, *smart* is .1 worse at 10 % of the faces.
//! - *Common vertices* are distinct ones, so that faces which name a vertex twice can be compared. A
//!   new face with all three vertices of a removed one has no place by the first rule of Fig. 5, which
//!   says exactly two, but by the second.
//! - *More faces come than places are free*: Fig. 5 has n faces for n − 2, other records need not.
//!   What is left over then goes behind the last place, in the order of the record.
//! - *Long records*, such as a hole of thousands of faces: beyond [`LONGEST`] pairs of a new and a
//!   removed face *smart* does what *simple* does, since its time is their product.
//! - *A vertex turns black* where the last of its faces stands in the full sequence, in any order,
//!   not only one by K-Cache-Reorder. It stays there, also when that face has left.
//! - *Which of the three vertices* (2006 says "one of"): the one that turned black first. Any other
//!   choice is far worse: the face would be drawn when its neighbours have left the cache.
//! - *Several new faces at one vertex* are drawn in the order in which they came. One whose vertices
//!   no face of the full mesh uses goes to the end.
//!
//! Read `places` for the first two, `adaptive` for the list of the third.

mod adaptive;
#[cfg(test)]
mod oracle;
mod places;
mod simple;
mod smart;
#[cfg(test)]
mod tests;
mod updated;

pub use adaptive::AdaptiveUpdate;
pub use simple::SimpleUpdate;
pub use smart::{LONGEST, SmartUpdate};
