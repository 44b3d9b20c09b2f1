//! How many frames a second, as people write it.

/// A number of frames a second.
pub(crate) fn parse(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|rate: &f64| *rate > 0.0 && rate.is_finite())
        .ok_or_else(|| "write a number above 0: 30, 59.94".to_owned())
}
