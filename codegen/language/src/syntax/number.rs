//! Parsing of decimal literals into exact numbers.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Zero, pow};

/// Largest number of digits of a literal, and largest magnitude of its exponent.
const MAX_DIGITS: usize = 400;

/// Reason why a literal is refused, with a suggestion.
pub(super) struct Refusal {
    /// The problem.
    pub message: String,
    /// Suggested fix.
    pub help: String,
}

fn refuse<T>(message: String, help: impl Into<String>) -> Result<T, Refusal> {
    Err(Refusal {
        message,
        help: help.into(),
    })
}

/// Returns the exact value of a literal. `shown` is the text that messages quote.
pub(super) fn value(text: &str, shown: &str) -> Result<BigRational, Refusal> {
    if !text.starts_with(|first: char| first.is_ascii_digit()) {
        return if text.starts_with('\'') || text.starts_with("b'") {
            refuse(
                format!("a character is not a value: `{shown}`"),
                "a transpose is written `transpose(M)` or `M.T`",
            )
        } else if text.contains('"') {
            refuse(
                format!("a string is not a value: `{shown}`"),
                "values are made of numbers, names and arrays",
            )
        } else {
            refuse(
                format!("not a number: `{shown}`"),
                "numbers are written `2`, `9.81` or `1e-3`",
            )
        };
    }
    if let [b'0', b'x' | b'o' | b'b', ..] = text.as_bytes() {
        return refuse(
            format!("`{shown}` is not a decimal number"),
            "write it with decimal digits",
        );
    }

    let (whole, rest) = digits(text);
    let (fraction, rest) = match rest.strip_prefix('.') {
        Some(rest) => digits(rest),
        None => (String::new(), rest),
    };
    let (exponent, suffix) = exponent(rest);
    if !suffix.is_empty() {
        let number = text.strip_suffix(suffix).unwrap_or(text);
        let number = number.trim_end_matches('_');
        return match suffix {
            "e" | "E" => refuse(
                format!("the exponent of `{shown}` is missing"),
                "exponents are written `1e-3`",
            ),
            "f32" | "f64" | "i8" | "i16" | "i32" | "i64" | "i128" | "isize" | "u8" | "u16"
            | "u32" | "u64" | "u128" | "usize" => refuse(
                format!("the number `{shown}` has a suffix"),
                format!("numbers are exact and have no type: write `{number}`"),
            ),
            _ => refuse(
                format!("the number `{shown}` has a suffix"),
                "a product is written with `*`, as in `2 * m`",
            ),
        };
    }
    if whole.len() + fraction.len() > MAX_DIGITS {
        return refuse(
            format!("a number of more than {MAX_DIGITS} digits"),
            "round it",
        );
    }
    let Some(exponent) = exponent else {
        return refuse(
            format!("the exponent of `{shown}` is beyond {MAX_DIGITS}"),
            "choose other units, or check the exponent",
        );
    };

    // `whole` starts with a digit, and `whole` and `fraction` contain only digits.
    let mantissa: BigInt = format!("{whole}{fraction}")
        .parse()
        .unwrap_or_else(|_| BigInt::zero());
    let scale = |digits: usize| pow(BigInt::from(10), digits);
    let denominator = if fraction.is_empty() {
        BigInt::one()
    } else {
        scale(fraction.len())
    };
    let value = BigRational::new(mantissa, denominator);
    let factor = BigRational::from(scale(exponent.unsigned_abs()));
    Ok(if exponent < 0 {
        value / factor
    } else {
        value * factor
    })
}

/// Splits off the leading digits. Returns them without underscores, and the rest.
fn digits(text: &str) -> (String, &str) {
    let end = text
        .find(|c: char| !c.is_ascii_digit() && c != '_')
        .unwrap_or(text.len());
    (text[..end].replace('_', ""), &text[end..])
}

/// Parses the exponent after the mantissa. Returns the exponent, or `None` if it is too large, and the suffix after it.
fn exponent(text: &str) -> (Option<isize>, &str) {
    let Some(signed) = text.strip_prefix(['e', 'E']) else {
        return (Some(0), text);
    };
    let unsigned = signed.strip_prefix(['+', '-']).unwrap_or(signed);
    let (digits, suffix) = digits(unsigned);
    if digits.is_empty() {
        return (Some(0), text);
    }
    let significant = digits.trim_start_matches('0');
    let magnitude = if significant.is_empty() {
        Ok(0)
    } else {
        significant.parse::<isize>()
    };
    let magnitude = magnitude
        .ok()
        .filter(|&size| size.unsigned_abs() <= MAX_DIGITS);
    (
        magnitude.map(|size| if signed.starts_with('-') { -size } else { size }),
        suffix,
    )
}
