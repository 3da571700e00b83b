//! How a height map is read.

use super::super::error::FileErrorKind;
use crate::limits::Limits;

/// How a height map is read.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct HeightMapOptions {
    /// How much is accepted; `vertices` limits samples.
    pub limits: Limits,
    /// How far columns and rows are apart, in metres, whatever the file says. Without it, the samples of a file
    /// that does not say it are one metre apart.
    pub spacing: Option<[f64; 2]>,
    /// What heights are multiplied with, after the units of the file have become metres.
    pub height_scale: Option<f64>,
    /// A value of samples, as stored, that stands for no height; beside the one that the file names.
    pub no_data: Option<f64>,
}

impl HeightMapOptions {
    /// Refuses numbers that no grid can have.
    pub(super) fn check(&self) -> Result<(), FileErrorKind> {
        let is_distance = |it: &f64| *it > 0.0 && it.is_finite();
        if let Some(spacing) = self.spacing
            && !spacing.iter().all(is_distance)
        {
            let [x, z] = spacing;
            return Err(FileErrorKind::unsupported(format!(
                "columns {x} and rows {z} metres apart were asked for: give finite distances above 0"
            )));
        }
        match self.height_scale {
            Some(scale) if scale == 0.0 || !scale.is_finite() => Err(FileErrorKind::unsupported(
                format!("heights times {scale} were asked for: give a finite factor that is not 0"),
            )),
            _ => Ok(()),
        }
    }
}
