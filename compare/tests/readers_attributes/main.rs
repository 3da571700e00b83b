//! Other people's readers find the attributes that the library reads, bit by bit, in every file of the
//! test data and in some that are made here.
//!
//! glTF, OFF and VRML have their readers in `validate/`.

mod made;
mod obj;
mod ply;
mod stl;
mod tally;
