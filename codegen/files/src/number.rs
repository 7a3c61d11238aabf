//! Numbers formatted for people.

/// Formats about six significant digits, without trailing zeros.
pub fn short(value: f64) -> String {
    digits(value, 6)
}

/// Formats the given number of significant digits, without trailing zeros; with powers of ten outside 1e-4 … 1e6.
pub fn digits(value: f64, significant: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{:.*e}", significant.max(1) - 1, value);
    let Some((mantissa, exponent)) = scientific.split_once('e') else {
        return scientific;
    };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if !(-4..6).contains(&exponent) {
        return format!("{}e{exponent}", trim_zeros(mantissa));
    }
    let decimals = usize::try_from(significant as i32 - 1 - exponent).unwrap_or(0);
    trim_zeros(&format!("{value:.decimals$}")).to_string()
}

/// Formats two significant digits of an error: `3.1e-15`.
pub fn error(value: f64) -> String {
    if value == 0.0 {
        "0".into()
    } else {
        format!("{value:.1e}")
    }
}

/// Formats a whole number with grouped thousands: `100 000`.
pub fn group_thousands(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// Formats the shortest text that parses to the same number, without long rows of zeros.
pub fn exact(value: f64) -> String {
    if value == 0.0 {
        "0.0".into()
    } else {
        format!("{value:?}")
    }
}

fn trim_zeros(text: &str) -> &str {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::{digits, group_thousands, short};

    #[test]
    fn numbers_are_short() {
        let cases = [
            (0.0, "0"),
            (1.0, "1"),
            (-0.001, "-0.001"),
            (1e-5, "1e-5"),
            (123456.7, "123457"),
            (1e6, "1e6"),
            (2.0 / 3.0, "0.666667"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text);
        }
        assert_eq!(digits(-1234.5, 2), "-1234");
        assert_eq!(group_thousands(1234567), "1 234 567");
    }
}
