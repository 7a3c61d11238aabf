//! Numbers on the command line.

/// Parses a number greater than zero.
pub fn positive(text: &str) -> Result<f64, &'static str> {
    let number = text.parse::<f64>().ok();
    let number = number.filter(|number| number.is_finite() && *number > 0.0);
    number.ok_or("expected a number greater than zero")
}

/// Parses a number that is not negative.
pub fn rate(text: &str) -> Result<f64, &'static str> {
    let number = text.parse::<f64>().ok();
    let number = number.filter(|number| number.is_finite() && *number >= 0.0);
    number.ok_or("expected a number, zero or greater")
}
