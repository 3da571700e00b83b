//! What can go wrong, and what to do about it.

use std::fmt;

use ash::vk;

/// Why something could not be drawn or counted.
#[derive(Debug)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no Vulkan loader, no driver or no card.
    NoDriver(String),
    /// The card or its driver cannot do what is needed.
    Missing {
        /// The card.
        card: String,
        /// What it does not have.
        what: &'static str,
    },
    /// A call of Vulkan failed.
    Vulkan {
        /// What was being done.
        doing: &'static str,
        /// What Vulkan said.
        result: vk::Result,
    },
    /// The caller's draw, arguments or files.
    Input(String),
}

impl GpuError {
    /// For `map_err`: a call of Vulkan that failed.
    pub(crate) fn when(doing: &'static str) -> impl FnOnce(vk::Result) -> Self {
        move |result| Self::Vulkan { doing, result }
    }

    /// Something wrong with what the caller gave.
    pub(crate) fn input(text: impl Into<String>) -> Self {
        Self::Input(text.into())
    }
}

impl fmt::Display for GpuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDriver(why) => write!(
                f,
                "no Vulkan: {why}. Install the loader and a driver; a driver that needs no card is in \
                 Debian's packages libvulkan1 and mesa-vulkan-drivers"
            ),
            Self::Missing { card, what } => write!(
                f,
                "{card} has no {what}. Choose another card with --card; `--card list` lists them"
            ),
            Self::Vulkan { doing, result } => {
                write!(f, "{doing}: {result}")?;
                match *result {
                    vk::Result::ERROR_OUT_OF_DEVICE_MEMORY
                    | vk::Result::ERROR_OUT_OF_HOST_MEMORY => {
                        f.write_str(". Draw a smaller mesh, or free memory of the card")
                    }
                    vk::Result::ERROR_DEVICE_LOST | vk::Result::TIMEOUT => {
                        f.write_str(". The card did not finish: run it again, with less at a time")
                    }
                    _ => Ok(()),
                }
            }
            Self::Input(text) => f.write_str(text),
        }
    }
}

impl std::error::Error for GpuError {}
