//! Frame rates on the command line.

/// Parses a frame rate in frames a second: above 0 and finite.
pub(crate) fn parse(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|rate: &f64| *rate > 0.0 && rate.is_finite())
        .ok_or_else(|| "write a number above 0: 30, 59.94".to_owned())
}
