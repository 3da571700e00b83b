//! Eyes by name, and as a file lists them.

use std::fmt;

use crate::culling::{Eye, SampledEyes};

/// The eyes of this name: `near`, `far` or `orthographic`.
#[must_use]
pub fn eyes_by_name(name: &str) -> Option<SampledEyes> {
    match name {
        "near" => Some(SampledEyes::near()),
        "far" => Some(SampledEyes::far()),
        "orthographic" => Some(SampledEyes::orthographic()),
        _ => None,
    }
}

/// The eyes that a text lists, for [`ViewClusters::eyes`](crate::culling::ViewClusters::eyes): a JSON array of positions
/// `[x, y, z]` in the space of the meshes. A fourth number is that of [`Eye::point`]: `[x, y, z, 0]` is a direction.
///
/// # Errors
/// [`CullEyesError`] if it is anything else, lists none, or more than [`SampledEyes::MOST_GIVEN`].
///
/// ```
/// use meshweft::culling::{Eye, SampledEyes};
/// use meshweft::operations::eyes_of_json;
/// let eyes = eyes_of_json("[[0, 1.5, 4], [0, 1, 0, 0]]")?;
/// assert_eq!(eyes, SampledEyes::These(vec![Eye::at([0.0, 1.5, 4.0]), Eye::towards([0.0, 1.0, 0.0])]));
/// # Ok::<(), meshweft::operations::CullEyesError>(())
/// ```
pub fn eyes_of_json(text: &str) -> Result<SampledEyes, CullEyesError> {
    let rows: Vec<Vec<f32>> =
        serde_json::from_str(text).map_err(|error| CullEyesError::Json(error.to_string()))?;
    if rows.is_empty() || rows.len() > SampledEyes::MOST_GIVEN {
        let count = rows.len();
        return Err(CullEyesError::Count { count });
    }
    let eyes = (1..).zip(&rows).map(|(number, row)| {
        let eye = match row[..] {
            [x, y, z] => Some(Eye::at([x, y, z])),
            [x, y, z, w] => Some(Eye {
                point: [x, y, z, w],
            }),
            _ => None,
        };
        let eye = eye.filter(|eye| eye.says_something());
        eye.ok_or(CullEyesError::NoEye { number })
    });
    Ok(SampledEyes::These(eyes.collect::<Result<_, _>>()?))
}

/// Why a text is not a list of eyes.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum CullEyesError {
    /// It is not a JSON array of arrays of numbers: what is not, and where.
    Json(String),
    /// It lists none, or too many.
    Count {
        /// How many it lists.
        count: usize,
    },
    /// An entry is not an eye.
    NoEye {
        /// The number of the entry, from 1.
        number: usize,
    },
}

impl fmt::Display for CullEyesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SUCH_AS: &str =
            "give camera positions in the space of the meshes, such as [[0, 1.5, 4], [2, 1.5, 0]]";
        match self {
            Self::Json(what) => write!(f, "{what}: {SUCH_AS}"),
            Self::Count { count } => write!(
                f,
                "it lists {count} eyes: give 1 to {}",
                SampledEyes::MOST_GIVEN
            ),
            Self::NoEye { number } => write!(
                f,
                "entry {number} is not three numbers in the range of 32-bit floats: {SUCH_AS}; \
                 [x, y, z, 0] is a direction towards the viewer"
            ),
        }
    }
}

impl std::error::Error for CullEyesError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_that_is_none_is_refused_with_its_place() {
        let refused = |text: &str| eyes_of_json(text).unwrap_err();
        for text in ["", "{}", "[1, 2, 3]", "[[1, 2, \"3\"]]", "[[1, 2, 3]] more"] {
            let error = refused(text);
            assert!(matches!(error, CullEyesError::Json(_)), "{text}: {error}");
            assert!(error.to_string().contains("line 1 column "), "{error}");
        }
        for row in [
            "[]",
            "[1, 2]",
            "[1, 2, 3, -1]",
            "[0, 0, 0, 0]",
            "[1e39, 0, 0]",
            "[0, 0, 0, 0, 1]",
        ] {
            let error = refused(&format!("[[0, 0, 0], {row}]"));
            assert_eq!(error, CullEyesError::NoEye { number: 2 }, "{row}");
        }
        assert_eq!(refused("[]"), CullEyesError::Count { count: 0 });
        let many = |count: usize| format!("[{}]", vec!["[0,0,0]"; count].join(","));
        let most = SampledEyes::MOST_GIVEN;
        let error = CullEyesError::Count { count: most + 1 };
        assert_eq!(refused(&many(most + 1)), error);
        assert!(eyes_of_json(&many(most)).is_ok());
    }
}
