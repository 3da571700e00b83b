//! `paper`: a paper's tables beside ours.

mod figures;
pub(crate) mod lin_yu;
