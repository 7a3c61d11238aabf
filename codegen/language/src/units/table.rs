//! The table of named units, and the prefixes of SI.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::pow;

/// A named unit.
struct Named {
    /// Its symbol.
    symbol: &'static str,
    /// Whether prefixes of SI may stand before it.
    prefixed: bool,
    /// One of it in SI, without the power of π: numerator and denominator.
    factor: (i64, i64),
    /// Exponent of π.
    pi: i32,
    /// Exponents of kg, m, s, A and K.
    dimension: [i32; 5],
}

const fn si(symbol: &'static str, dimension: [i32; 5]) -> Named {
    Named {
        symbol,
        prefixed: true,
        factor: (1, 1),
        pi: 0,
        dimension,
    }
}

const fn other(symbol: &'static str, factor: (i64, i64), dimension: [i32; 5]) -> Named {
    Named {
        symbol,
        prefixed: false,
        factor,
        pi: 0,
        dimension,
    }
}

const fn turn(symbol: &'static str, factor: (i64, i64), dimension: [i32; 5]) -> Named {
    Named {
        pi: 1,
        ..other(symbol, factor, dimension)
    }
}

/// The named units: those of SI, then others with their exact factors.
const UNITS: &[Named] = &[
    si("m", [0, 1, 0, 0, 0]),
    Named {
        factor: (1, 1000),
        ..si("g", [1, 0, 0, 0, 0])
    },
    si("s", [0, 0, 1, 0, 0]),
    si("A", [0, 0, 0, 1, 0]),
    si("K", [0, 0, 0, 0, 1]),
    si("rad", [0, 0, 0, 0, 0]),
    si("N", [1, 1, -2, 0, 0]),
    si("J", [1, 2, -2, 0, 0]),
    si("W", [1, 2, -3, 0, 0]),
    si("Pa", [1, -1, -2, 0, 0]),
    si("Hz", [0, 0, -1, 0, 0]),
    si("C", [0, 0, 1, 1, 0]),
    si("V", [1, 2, -3, -1, 0]),
    si("ohm", [1, 2, -3, -2, 0]),
    si("F", [-1, -2, 4, 2, 0]),
    si("H", [1, 2, -2, -2, 0]),
    si("Wb", [1, 2, -2, -1, 0]),
    si("T", [1, 0, -2, -1, 0]),
    Named {
        factor: (1, 1000),
        ..si("L", [0, 3, 0, 0, 0])
    },
    Named {
        factor: (100_000, 1),
        ..si("bar", [1, -1, -2, 0, 0])
    },
    other("t", (1000, 1), [1, 0, 0, 0, 0]),
    other("min", (60, 1), [0, 0, 1, 0, 0]),
    other("h", (3600, 1), [0, 0, 1, 0, 0]),
    other("day", (86_400, 1), [0, 0, 1, 0, 0]),
    other("in", (254, 10_000), [0, 1, 0, 0, 0]),
    other("ft", (3048, 10_000), [0, 1, 0, 0, 0]),
    other("lb", (45_359_237, 100_000_000), [1, 0, 0, 0, 0]),
    other(
        "lbf",
        (44_482_216_152_605, 10_000_000_000_000),
        [1, 1, -2, 0, 0],
    ),
    turn("deg", (1, 180), [0, 0, 0, 0, 0]),
    turn("rev", (2, 1), [0, 0, 0, 0, 0]),
    turn("rpm", (1, 30), [0, 0, -1, 0, 0]),
];

/// Prefixes of SI with their powers of ten.
const PREFIXES: &[(&str, i32)] = &[
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// Returns the factor to SI, the exponent of π, and the exponents of kg, m, s, A and K of a unit. A unit without a
/// prefix has precedence: `min` is the minute, `cd` is none.
pub(super) fn find(name: &str) -> Option<(BigRational, i32, [i32; 5])> {
    let ratio = |(n, d): (i64, i64)| BigRational::new(n.into(), d.into());
    let (unit, power) = UNITS
        .iter()
        .find(|unit| unit.symbol == name)
        .map(|unit| (unit, 0))
        .or_else(|| {
            PREFIXES.iter().find_map(|(prefix, power)| {
                let symbol = name.strip_prefix(prefix)?;
                let unit = UNITS
                    .iter()
                    .find(|unit| unit.prefixed && unit.symbol == symbol)?;
                Some((unit, *power))
            })
        })?;
    let scale = BigRational::from(pow(BigInt::from(10), power.unsigned_abs() as usize));
    let scale = if power < 0 { scale.recip() } else { scale };
    Some((ratio(unit.factor) * scale, unit.pi, unit.dimension))
}

/// Returns the symbols of all named units, without prefixes.
pub fn names() -> impl Iterator<Item = &'static str> {
    UNITS.iter().map(|unit| unit.symbol)
}

/// Returns the names that a misspelt unit can mean: the named units, and those that are often written with prefixes.
pub fn suggestions() -> impl Iterator<Item = &'static str> {
    ["kg", "mm", "cm", "km", "ms", "kN", "mA", "kHz"]
        .into_iter()
        .chain(names())
}
