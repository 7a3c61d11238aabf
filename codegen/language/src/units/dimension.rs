//! Dimensions: products of rational powers of kg, m, s, A and K.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use std::fmt;

/// Symbols of the base units.
pub const BASE: [&str; 5] = ["kg", "m", "s", "A", "K"];

/// A dimension: the exponents of kg, m, s, A and K. An angle in rad has the dimension of a number.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Dimension(pub Box<[BigRational; 5]>);

/// Dimensions with their names in messages: exponents of kg, m, s, A and K, the name, and the unit.
const NAMED: &[([i32; 5], &str, &str)] = &[
    ([0, 0, 0, 0, 0], "a number or an angle", "1"),
    ([1, 0, 0, 0, 0], "a mass", "kg"),
    ([0, 1, 0, 0, 0], "a length", "m"),
    ([0, 0, 1, 0, 0], "a time", "s"),
    ([0, 0, 0, 1, 0], "an electric current", "A"),
    ([0, 0, 0, 0, 1], "a temperature", "K"),
    ([0, 2, 0, 0, 0], "an area", "m^2"),
    ([0, 3, 0, 0, 0], "a volume", "m^3"),
    ([0, 1, -1, 0, 0], "a velocity", "m/s"),
    ([0, 1, -2, 0, 0], "an acceleration", "m/s^2"),
    (
        [0, 0, -1, 0, 0],
        "a frequency or an angular velocity",
        "rad/s",
    ),
    ([0, 0, -2, 0, 0], "an angular acceleration", "rad/s^2"),
    ([1, 1, -1, 0, 0], "a momentum", "kg*m/s"),
    ([1, 2, -1, 0, 0], "an angular momentum", "kg*m^2/s"),
    ([1, 2, 0, 0, 0], "a moment of inertia", "kg*m^2"),
    ([1, 1, -2, 0, 0], "a force", "N"),
    ([1, 2, -2, 0, 0], "a torque or an energy", "N*m"),
    ([1, 2, -3, 0, 0], "a power", "W"),
    ([1, 0, -2, 0, 0], "a stiffness", "N/m"),
    ([1, 0, -1, 0, 0], "a damping coefficient", "N*s/m"),
    ([1, -1, -2, 0, 0], "a pressure", "Pa"),
    ([1, -3, 0, 0, 0], "a density", "kg/m^3"),
    ([0, 0, 1, 1, 0], "an electric charge", "C"),
    ([1, 2, -3, -1, 0], "a voltage", "V"),
    ([1, 2, -3, -2, 0], "a resistance", "ohm"),
    ([1, 2, -2, -1, 0], "a magnetic flux", "Wb"),
    ([1, 2, -2, -2, 0], "an inductance", "H"),
    ([-1, -2, 4, 2, 0], "a capacitance", "F"),
    ([1, 0, -2, -1, 0], "a magnetic flux density", "T"),
];

impl Dimension {
    /// Creates a dimension from whole exponents of kg, m, s, A and K.
    pub fn of(exponents: [i32; 5]) -> Self {
        let exponents = exponents.map(|exponent| BigRational::from_integer(exponent.into()));
        Dimension(Box::new(exponents))
    }

    /// Returns the dimension of a number.
    pub fn one() -> Self {
        Dimension::of([0; 5])
    }

    /// Returns whether this is the dimension of a number.
    pub fn is_one(&self) -> bool {
        self.0.iter().all(Zero::is_zero)
    }

    /// Returns the dimension of a product of this with a power of another.
    pub fn times(&self, other: &Dimension, exponent: &BigRational) -> Self {
        let mut product = self.clone();
        for (own, other) in product.0.iter_mut().zip(other.0.iter()) {
            *own += other * exponent;
        }
        product
    }

    /// Describes a quantity of this dimension: `a length [m]`.
    pub fn describe(&self) -> String {
        match self.named() {
            Some((name, _)) if self.is_one() => name.into(),
            Some((name, unit)) => format!("{name} [{unit}]"),
            None => format!("a quantity in [{self}]"),
        }
    }

    fn named(&self) -> Option<(&'static str, &'static str)> {
        let known = NAMED
            .iter()
            .find(|(exponents, ..)| *self == Dimension::of(*exponents))?;
        Some((known.1, known.2))
    }
}

/// Writes the SI unit of the dimension, which reads back: `m/s^2`, `N*m`, `kg*m^3/s`.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((_, unit)) = self.named() {
            return f.write_str(unit);
        }
        let one = BigRational::one();
        let list = |positive: bool| {
            let pairs = BASE.iter().zip(self.0.iter());
            let some = pairs.filter(move |(_, exponent)| {
                !exponent.is_zero() && exponent.is_positive() == positive
            });
            some.map(|(unit, exponent)| (*unit, exponent.abs()))
                .collect::<Vec<_>>()
        };
        let power = |(unit, exponent): &(&str, BigRational)| match exponent {
            exponent if *exponent == one => (*unit).to_owned(),
            exponent if exponent.is_integer() => format!("{unit}^{exponent}"),
            exponent => format!("{unit}^({exponent})"),
        };
        let (over, under) = (list(true), list(false));
        let over: Vec<String> = over.iter().map(power).collect();
        f.write_str(
            if over.is_empty() {
                "1".into()
            } else {
                over.join("*")
            }
            .as_str(),
        )?;
        under
            .iter()
            .try_for_each(|unit| write!(f, "/{}", power(unit)))
    }
}
