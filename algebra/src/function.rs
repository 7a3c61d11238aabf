//! The elementary functions: all that is known of each in one table.
//!
//! A new function is a row here, with its values in numbers of every kind, and its values modulo p
//! (`Lane::function`): those have to obey the laws by which expressions with it are found equal.

use super::double::Double;
use super::interval::Interval;
use super::node::NodeId;
use super::reals::Real;

/// f(−a).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// f(a).
    Even,
    /// −f(a).
    Odd,
    /// Neither.
    None,
}

/// What f(a + b) or f(a b) is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// Circles of angles, added.
    Angle,
    /// Powers, multiplied.
    Power,
    /// √(a b) = √a √b of what is positive.
    Root,
    /// Of nothing: any value will do.
    None,
}

/// f′(a).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slope {
    /// g(a).
    Is(Function),
    /// −g(a).
    IsMinus(Function),
    /// f(a).
    Itself,
    /// 1/a.
    Inverse,
    /// 1/(2 f(a)).
    HalfInverse,
    /// It has two arguments, and rules of its own.
    Two,
}

/// What it is counted as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// A square root.
    Root,
    /// Half of a pair of sine and cosine.
    Turn,
    /// Any other function.
    Other,
}

/// One row of the table.
#[derive(Debug)]
pub struct Row {
    /// Its name in descriptions and in texts.
    pub name: &'static str,
    /// Its call as a method in Rust.
    pub rust: &'static str,
    /// Its name in LaTeX.
    pub latex: &'static str,
    /// What it is counted as.
    pub cost: Cost,
    /// f(−a).
    pub parity: Parity,
    /// An a and f(a), both of them 0 or 1.
    pub at: Option<[NodeId; 2]>,
    /// Its law.
    pub law: Law,
    /// f′(a).
    pub slope: Slope,
    /// f(a) in `f64`.
    pub value: fn(f64) -> f64,
    /// In twice the length.
    pub double: fn(Double) -> Double,
    /// With a bound of its error.
    pub real: fn(Real) -> Real,
    /// Between certain bounds; `None` where there is no value, or none is known.
    pub interval: fn(&Interval) -> Option<Interval>,
}

macro_rules! table {
    ($($(#[$doc:meta])* $id:ident { $($row:tt)* })*) => {
        /// Functions beyond the four operations.
        #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, PartialOrd, Ord)]
        pub enum Function {
            $($(#[$doc])* $id,)*
        }

        impl Function {
            /// All of them, in the order of the table.
            pub const ALL: &'static [Function] = &[$(Function::$id),*];

            /// What is known of it.
            pub fn row(self) -> &'static Row {
                match self {
                    $(Function::$id => {
                        static ROW: Row = Row { $($row)* };
                        &ROW
                    })*
                }
            }
        }
    };
}

// The place in the table chooses values modulo p: new functions come last.
table! {
    /// sine
    Sin {
        name: "sin",
        rust: "sin_cos().0",
        latex: r"\sin",
        cost: Cost::Turn,
        parity: Parity::Odd,
        at: Some([0, 0]),
        law: Law::Angle,
        slope: Slope::Is(Function::Cos),
        value: f64::sin,
        double: Double::sin,
        real: Real::sin,
        interval: Interval::sin,
    }
    /// cosine
    Cos {
        name: "cos",
        rust: "sin_cos().1",
        latex: r"\cos",
        cost: Cost::Turn,
        parity: Parity::Even,
        at: Some([0, 1]),
        law: Law::Angle,
        slope: Slope::IsMinus(Function::Sin),
        value: f64::cos,
        double: Double::cos,
        real: Real::cos,
        interval: Interval::cos,
    }
    /// exponential
    Exp {
        name: "exp",
        rust: "exp()",
        latex: r"\exp",
        cost: Cost::Other,
        parity: Parity::None,
        at: Some([0, 1]),
        law: Law::Power,
        slope: Slope::Itself,
        value: f64::exp,
        double: Double::exp,
        real: Real::exp,
        interval: Interval::exp,
    }
    /// natural logarithm
    Log {
        name: "log",
        rust: "ln()",
        latex: r"\ln",
        cost: Cost::Other,
        parity: Parity::None,
        at: Some([1, 0]),
        law: Law::None,
        slope: Slope::Inverse,
        value: f64::ln,
        double: Double::log,
        real: Real::log,
        interval: |_| None,
    }
    /// square root
    Sqrt {
        name: "sqrt",
        rust: "sqrt()",
        latex: r"\sqrt",
        cost: Cost::Root,
        parity: Parity::None,
        at: None,
        law: Law::Root,
        slope: Slope::HalfInverse,
        value: f64::sqrt,
        double: Double::sqrt,
        real: Real::sqrt,
        interval: Interval::sqrt,
    }
    /// angle of (x, y), arguments (y, x): a node of its own, without values of one argument
    Atan2 {
        name: "atan2",
        rust: "atan2",
        latex: r"\operatorname{atan2}",
        cost: Cost::Other,
        parity: Parity::None,
        at: None,
        law: Law::None,
        slope: Slope::Two,
        value: |_| f64::NAN,
        double: |_| Double::new(f64::NAN),
        real: |_| Real::UNKNOWN,
        interval: |_| None,
    }
}

impl Function {
    /// Its name in descriptions.
    pub fn name(self) -> &'static str {
        self.row().name
    }
}
