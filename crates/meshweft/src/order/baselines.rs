//! Orders to compare with.
