//! Symbols in few bits: tables that follow what comes, and asymmetric numeral systems that code by them.
//!
//! Everything is in integers, so a stream is the same on every platform.

mod adaptive_bit;
mod adaptive_table;
mod checksum;
mod error;
#[cfg(feature = "default-tier")]
mod logistic;
#[cfg(feature = "default-tier")]
mod mixed_bit;
mod number;
mod rans;
pub(crate) mod varint;

pub(crate) use adaptive_bit::AdaptiveBit;
pub(crate) use adaptive_table::{AdaptiveTable, Mean, SYMBOLS};
pub(crate) use checksum::crc32;
pub use error::{DecodeError, DecodeErrorKind};
#[cfg(feature = "default-tier")]
pub(crate) use logistic::LogOdds;
#[cfg(feature = "default-tier")]
pub(crate) use mixed_bit::{BitChances, Weights, code_mixed, even_weights};
pub(crate) use number::{NumberCoder, code_more, low_half};
pub(crate) use rans::{Lane, MOST_BITS, Port, RansDecoder, RansEncoder};
