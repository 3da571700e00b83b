//! What both models of fans do.

use super::traversal::{FanTurn, Gap, Run};
use crate::bits::Port;

/// How the vertices around a gap lie, as far as positions are known: steps that begin with 0, which stands for what is not
/// known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Outlook {
    /// How far the other end of the gap is from where a new vertex would be expected, in halves of octaves of the
    /// length of the edge.
    pub(crate) reach: u8,
    /// The angle between both ends.
    pub(crate) angle: u8,
}

#[cfg_attr(
    not(feature = "default-tier"),
    expect(dead_code, reason = "for that tier")
)]
impl Outlook {
    /// More than any `reach`.
    pub(crate) const REACHES: usize = 16;
    /// More than any `angle`.
    pub(crate) const ANGLES: usize = 32;
}

/// Reads or writes how fans go on, by what is likely.
pub(crate) trait FanModel: std::fmt::Debug {
    /// More new vertices take another run. After so many, if it is 1, another run follows at once.
    const MOST_NEW: usize;
    /// Whether it asks how vertices lie.
    const LOOKS: bool;

    fn new() -> Self;

    fn run(&mut self, port: &mut impl Port, gap: &Gap, outlook: Outlook, run: Run) -> Run;

    /// A turn; one that is none is a [`FanTurn::Stop`].
    fn turn(&mut self, port: &mut impl Port, gap: &Gap, beyond: [u8; 2], turn: usize) -> FanTurn;

    /// A vertex after the root that was met.
    fn known(&mut self, port: &mut impl Port, root: u32, count: u32, vertex: u32) -> u32;

    /// A corner of a face that follows no other.
    fn corner(
        &mut self,
        port: &mut impl Port,
        root: u32,
        count: u32,
        vertex: Option<u32>,
    ) -> Option<u32>;
}
