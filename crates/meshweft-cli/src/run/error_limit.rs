//! Errors as they are given on the command line.

use std::str::FromStr;

use meshweft::operations::ErrorLimit;

/// An error such as `0.01` or `1%`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Error(pub(crate) ErrorLimit);

impl FromStr for Error {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| {
            let number: Result<f64, _> = text.trim().parse();
            number.map_err(|_| {
                "a length such as 0.01, or a share of the diagonal such as 1%".to_owned()
            })
        };
        Ok(Self(match text.strip_suffix('%') {
            Some(percent) => ErrorLimit::Diagonal(number(percent)? / 100.0),
            None => ErrorLimit::Units(number(text)?),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_lengths_or_percents() {
        let error = |text: &str| text.parse::<Error>().map(|error| error.0);
        assert_eq!(error("0.25"), Ok(ErrorLimit::Units(0.25)));
        assert_eq!(error(".5%"), Ok(ErrorLimit::Diagonal(0.005)));
        for bad in ["", "%", "1 mm", "a%"] {
            assert!(error(bad).is_err(), "{bad}");
        }
    }
}
