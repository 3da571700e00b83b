//! What verbs share that move an eye.

pub(crate) mod cameras;
pub(crate) mod frames;
pub(crate) mod plot;
pub(crate) mod policy;
