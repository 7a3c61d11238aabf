//! Exact decimal numbers that keep the spelling of the file.

use hamel_language::expression::spelled;
use hamel_language::syntax::ast::Expr;

/// Largest size of an exponent: beyond it a number is no length, mass or angle, and later computations would
/// overflow.
const MAX_EXPONENT: i32 = 300;
/// Largest number of digits: no measurement has more.
const MAX_DIGITS: usize = 200;

/// A finite decimal number.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Decimal {
    /// The number as it is written in a description: a minus sign if it is negative, then a digit.
    pub(crate) text: String,
    /// The nearest double.
    pub(crate) value: f64,
}

impl Decimal {
    /// Returns 0.
    pub(crate) fn zero() -> Self {
        Decimal {
            text: "0".into(),
            value: 0.0,
        }
    }

    /// Returns 1.
    pub(crate) fn one() -> Self {
        Decimal {
            text: "1".into(),
            value: 1.0,
        }
    }

    /// Parses a number as URDF writes it: `1`, `-0.5`, `.5`, `+1.`, `1e-05`; returns `None` for everything else.
    pub(crate) fn parse(written: &str) -> Option<Self> {
        let (negative, unsigned) = match written.strip_prefix(['-', '+']) {
            Some(rest) => (written.starts_with('-'), rest),
            None => (false, written),
        };
        let (mantissa, exponent) = match unsigned.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, Some(exponent.parse::<i32>().ok()?)),
            None => (unsigned, None),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let digits = whole.chars().chain(fraction.chars());
        let count = whole.len() + fraction.len();
        if count == 0
            || count > MAX_DIGITS
            || !digits.into_iter().all(|c| c.is_ascii_digit())
            || exponent.is_some_and(|e| e.abs() > MAX_EXPONENT)
        {
            return None;
        }
        let whole = match whole.trim_start_matches('0') {
            "" => "0",
            digits => digits,
        };
        let mut text = whole.to_string();
        if !fraction.is_empty() {
            text = format!("{text}.{fraction}");
        }
        if let Some(exponent) = exponent.filter(|&exponent| exponent != 0) {
            text = format!("{text}e{exponent}");
        }
        let value: f64 = text.parse().ok()?;
        if !value.is_finite() {
            return None;
        }
        let zero = mantissa.chars().all(|c| matches!(c, '0' | '.'));
        if zero {
            return Some(Decimal::zero());
        }
        let number = Decimal { text, value };
        Some(if negative { number.negated() } else { number })
    }

    /// Whether the number is exactly 0.
    pub(crate) fn is_zero(&self) -> bool {
        self.text == "0"
    }

    /// Returns −a.
    pub(crate) fn negated(&self) -> Self {
        let text = match self.text.strip_prefix('-') {
            Some(positive) => positive.to_string(),
            None if self.is_zero() => return self.clone(),
            None => format!("-{}", self.text),
        };
        Decimal {
            text,
            value: -self.value,
        }
    }
}

/// Returns the number as an expression with the same digits.
impl From<&Decimal> for Expr {
    fn from(number: &Decimal) -> Expr {
        spelled(&number.text).unwrap_or_else(|| number.value.into())
    }
}

/// Returns the vector `[a, b, c]`.
pub(crate) fn vector(entries: &[Decimal; 3]) -> Expr {
    Expr::from(entries.each_ref())
}

#[cfg(test)]
mod tests {
    use super::Decimal;

    #[test]
    fn numbers_keep_their_digits() {
        for (written, text) in [
            ("1.50", "1.50"),
            ("-.5", "-0.5"),
            ("+1.", "1"),
            ("1E-05", "1e-5"),
            ("1e+16", "1e16"),
            ("007", "7"),
            ("-0.000", "0"),
            ("0e5", "0"),
        ] {
            let number = Decimal::parse(written);
            assert_eq!(number.map(|n| n.text).as_deref(), Some(text), "{written}");
        }
        for wrong in [
            "", ".", "nan", "inf", "1e", "0x10", "1,5", "--1", "1e999", "${a}", "1 2",
        ] {
            assert_eq!(Decimal::parse(wrong), None, "{wrong}");
        }
    }
}
