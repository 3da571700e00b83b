//! The program `meshweft`.
fn main() {}
