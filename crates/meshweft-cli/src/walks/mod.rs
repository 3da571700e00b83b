//! What verbs share that move an eye.

pub(crate) mod cameras;
