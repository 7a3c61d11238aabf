//! The elementary functions, with everything that is known of each in one table.
//!
//! To add a function, add a row to the table. The language, derivatives, proofs, operation counts, tables, Rust, C,
//! machine code and the interpreter read it. A function with a law also has its values modulo p in
//! `FieldPoint::function`, which must obey this law and no other; without them, it is treated like a function
//! without laws.

use Cost::{Comparison, Other, Product, Quotient, Root, SineOrCosine};
use Law::{Angle, Free, Hyperbola, Linear, Power, Radical, Side};
use Parity::{Even, Neither, Odd};
use Slope::{
    FunctionOfArgument, HalfFunctionOfValue, HalfInverseOfValue, InversePolynomial,
    MinusFunctionOfArgument, MinusSquareOfValue, OneMinusSquareOfValue, OwnValue, SeveralArguments,
    ValueAtOne, Zero,
};

use super::double::Double;
use super::interval::Interval;
use super::node::NodeId;
use super::reals::Real;
use num_rational::BigRational;

/// Symmetry of a function: the value of f(−a).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// f(a).
    Even,
    /// −f(a).
    Odd,
    /// Neither.
    Neither,
}

/// Law by which f(a + b) or f(a b) follows from values at simpler arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// Addition theorem of angles: points on the unit circle are composed.
    Angle,
    /// exp(a + b) = exp a exp b: powers are multiplied.
    Power,
    /// Powers and their inverses are multiplied, as for the hyperbolic functions.
    Hyperbola,
    /// √(a b) = √a √b for positive a, b.
    Radical,
    /// f(a) is a multiple of f(1) that depends on the side of 0 on which a is (`FieldPoint::positive`), as for
    /// sign and abs.
    Side,
    /// No law: any value will do.
    Free,
    /// f is linear: values are multiples of f(1).
    Linear,
}

impl Law {
    /// Whether the value at a sum follows from the values at its terms.
    pub fn is_additive(self) -> bool {
        matches!(self, Angle | Power | Hyperbola)
    }
}

/// Derivative f′(a) of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slope {
    /// g(a).
    FunctionOfArgument(Function),
    /// −g(a).
    MinusFunctionOfArgument(Function),
    /// f(a).
    OwnValue,
    /// 1/(c₀ + c₁ a + c₂ a² + …), with these coefficients.
    InversePolynomial(&'static [i32]),
    /// 1/(2 f(a)).
    HalfInverseOfValue,
    /// ½ g(f(a)).
    HalfFunctionOfValue(Function),
    /// −f(a)².
    MinusSquareOfValue,
    /// 1 − f(a)².
    OneMinusSquareOfValue,
    /// f(1), because f is linear.
    ValueAtOne,
    /// 0.
    Zero,
    /// No entry: the node has several arguments, and rules of its own.
    SeveralArguments,
}

/// Kind of operation that a function counts as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// A square root.
    Root,
    /// Half of a pair of sine and cosine.
    SineOrCosine,
    /// A division.
    Quotient,
    /// A product.
    Product,
    /// A comparison, as expensive as a sum.
    Comparison,
    /// Any other function.
    Other,
}

/// Row of the table: everything that is known of one function.
#[derive(Debug)]
pub struct Row {
    /// Name in descriptions and in texts.
    pub name: &'static str,
    /// Call as a method of `hamel::Scalar` in Rust; without parentheses for nodes of their own.
    pub rust: &'static str,
    /// Name in `<math.h>`, from which emitted languages derive theirs; `@_name` if it has none and each language
    /// defines a helper `name`; empty for nodes of their own.
    pub c: &'static str,
    /// Name in LaTeX.
    pub latex: &'static str,
    /// Kind of operation that it counts as.
    pub cost: Cost,
    /// Symmetry: the value of f(−a).
    pub parity: Parity,
    /// An exact value: the nodes of some a and of f(a), each of them the number 0 or 1.
    pub at: Option<[NodeId; 2]>,
    /// Law for the values at sums or products.
    pub law: Law,
    /// Derivative f′(a).
    pub slope: Slope,
    /// f(a) in `f64`.
    pub value: fn(f64) -> f64,
    /// f(a) in double-double precision.
    pub double: fn(Double) -> Double,
    /// f(a) with a bound of its error.
    pub real: fn(Real) -> Real,
    /// Certified bounds of f(a); `None` if there is no value, or none is known.
    pub interval: fn(&Interval) -> Option<Interval>,
}

macro_rules! table {
    ($($id:ident $doc:literal $name:literal [$($rust:tt)*] $c:literal $latex:literal $cost:ident $parity:ident $law:ident
        [$at:expr] [$slope:expr] $value:expr, $double:expr, $real:expr, $interval:expr;)*) => {
        /// Elementary functions beyond the four arithmetic operations.
        #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, PartialOrd, Ord)]
        pub enum Function {
            $(#[doc = $doc] $id,)*
        }

        impl Function {
            /// All functions, in the order of the table.
            pub const ALL: &'static [Function] = &[$(Function::$id),*];

            /// Returns the row of the table for this function.
            pub fn row(self) -> &'static Row {
                match self {
                    $(Function::$id => {
                        static ROW: Row = Row {
                            name: $name,
                            rust: stringify!($($rust)*),
                            c: $c,
                            latex: $latex,
                            cost: $cost,
                            parity: $parity,
                            law: $law,
                            at: $at,
                            slope: $slope,
                            value: $value,
                            double: $double,
                            real: $real,
                            interval: $interval,
                        };
                        &ROW
                    })*
                }
            }

            /// Finds the function of one argument that has this name in descriptions.
            pub fn from_name(name: &str) -> Option<Function> {
                let named = |function: &&Function| function.name() == name && function.row().slope != SeveralArguments;
                let word = name.starts_with(|first: char| first.is_ascii_alphabetic());
                Function::ALL.iter().find(named).copied().filter(|_| word)
            }

            /// Name of the function in descriptions.
            pub fn name(self) -> &'static str {
                self.row().name
            }
        }

        /// Passes each function of the table with its call in Rust, as `Exp [exp()]`, to a macro. Crates that know
        /// `hamel::Scalar`, of which this crate does not, implement all functions by it.
        #[macro_export]
        macro_rules! for_each_function {
            ($macro:ident) => {
                $macro! { $($id [$($rust)*])* }
            };
        }
    };
}

// The position in the table determines values modulo p, so new functions must come last. Columns:
// identifier, documentation, names (in descriptions, Rust, C, LaTeX), cost, parity, law, exact value,
// derivative; then values in `f64`, in double-double precision, with bounds of errors, and as intervals.
table! {
    Sin "sine" "sin" [sin_cos().0] "sin" r"\sin" SineOrCosine Odd Angle [Some([0, 0])] [FunctionOfArgument(Function::Cos)]
        f64::sin, Double::sin, Real::sin, Interval::sin;
    Cos "cosine" "cos" [sin_cos().1] "cos" r"\cos" SineOrCosine Even Angle [Some([0, 1])] [MinusFunctionOfArgument(Function::Sin)]
        f64::cos, Double::cos, Real::cos, Interval::cos;
    Exp "exponential" "exp" [exp()] "exp" r"\exp" Other Neither Power [Some([0, 1])] [OwnValue]
        f64::exp, Double::exp, Real::exp, Interval::exp;
    Log "natural logarithm" "log" [ln()] "log" r"\ln" Other Neither Free [Some([1, 0])] [InversePolynomial(&[0, 1])]
        f64::ln, Double::log, Real::log, Interval::log;
    Sqrt "square root" "sqrt" [sqrt()] "sqrt" r"\sqrt" Root Neither Radical [None] [HalfInverseOfValue]
        f64::sqrt, Double::sqrt, Real::sqrt, Interval::sqrt;
    Atan2 "angle of (x, y), arguments (y, x): a node of its own, without values of one argument"
        "atan2" [atan2] "" r"\operatorname{atan2}" Other Neither Free [None] [SeveralArguments]
        |_| f64::NAN, |_| Double::new(f64::NAN), |_| Real::UNKNOWN, |_| None;
    Sinh "hyperbolic sine" "sinh" [sinh()] "sinh" r"\sinh" Other Odd Hyperbola [Some([0, 0])] [FunctionOfArgument(Function::Cosh)]
        f64::sinh, Double::sinh, Real::sinh, Interval::sinh;
    Cosh "hyperbolic cosine" "cosh" [cosh()] "cosh" r"\cosh" Other Even Hyperbola [Some([0, 1])] [FunctionOfArgument(Function::Sinh)]
        f64::cosh, Double::cosh, Real::cosh, Interval::cosh;
    Tanh "hyperbolic tangent" "tanh" [tanh()] "tanh" r"\tanh" Other Odd Hyperbola [Some([0, 0])] [OneMinusSquareOfValue]
        f64::tanh, Double::tanh, Real::tanh, Interval::tanh;
    Sign "1 with the sign of its argument, 0 of 0" "sign" [sign()] "@_sign" r"\operatorname{sign}" Comparison Odd Side
        [Some([0, 0])] [Zero]
        |a| if a == 0.0 { a } else { a.signum() }, Double::sign, Real::sign, Interval::sign;
    Abs "absolute value" "abs" [abs()] "fabs" r"\operatorname{abs}" Comparison Even Side [Some([0, 0])] [FunctionOfArgument(Function::Sign)]
        f64::abs, Double::abs, Real::abs, Interval::abs;
    Select "a where c > 0, else b, arguments (c, a, b): a node of its own, without values of one argument"
        "if" [select_positive] "" r"\operatorname{if}" Comparison Neither Free [None] [SeveralArguments]
        |_| f64::NAN, |_| Double::new(f64::NAN), |_| Real::UNKNOWN, |_| None;
    Norm "length, the root of a sum of squares: where that is 0, its derivative is 0"
        "sqrt" [sqrt()] "sqrt" r"\sqrt" Root Neither Radical [None] [HalfFunctionOfValue(Function::Inverse)]
        f64::sqrt, Double::sqrt, Real::sqrt, Interval::sqrt;
    Inverse "1/a, but a large number where a is nearly 0: times a sum of products that are 0 there it is 0"
        "1/" [inverse_of_length()] "@_inverse_of_length" r"1/" Quotient Odd Free [None] [MinusSquareOfValue]
        |a| if a.abs() < MIN_DIVISOR { MIN_DIVISOR.recip() } else { a.recip() }, Double::inverse_of_length,
        |a| Real::new(1.0, 0.0).over(a), Interval::inverse;
    Listed "a list of numbers, the rest and the last: a node of its own, which only what is called reads"
        "[]" [] "" "" Comparison Neither Free [None] [SeveralArguments]
        |_| f64::NAN, |_| Double::new(f64::NAN), |_| Real::UNKNOWN, |_| None;
    External "a component of a function that is given elsewhere: a node of its own over a list"
        "extern" [] "" "" Other Neither Free [None] [SeveralArguments]
        |_| f64::NAN, |_| Double::new(f64::NAN), |_| Real::UNKNOWN, |_| None;
    Raised "a larger by a small part that rounding does not hide, 2⁻²⁶ of it in `f64`: a pivot that may be nothing but rounding becomes one that can be divided by"
        "(1 + ε) " [inflated()] "@_raised" r"(1 + \varepsilon) " Product Odd Linear [Some([0, 0])] [ValueAtOne]
        |a| a * RAISE_FACTOR, |a| a * Double::new(RAISE_FACTOR), |a| a.times(Real::new(RAISE_FACTOR, 0.0)),
        |a| Some(a.times(&Interval::rational(&BigRational::from_float(RAISE_FACTOR)?)));
    // Neither has a law: if log1p(a) and log(1 + a) were one node, one of them would lose its digits near 0.
    Log1p "log(1 + a) without the rounding of 1 + a" "log1p" [ln_1p()] "log1p" r"\operatorname{log1p}" Other Neither Free
        [Some([0, 0])] [InversePolynomial(&[1, 1])]
        f64::ln_1p, Double::log1p, |a| Real::new(1.0, 0.0).plus(a).log(), |a| Interval::whole(1).plus(a).log();
    Expm1 "exp(a) − 1 without the rounding of exp(a)" "expm1" [exp_m1()] "expm1" r"\operatorname{expm1}" Other Neither Free
        [Some([0, 0])] [FunctionOfArgument(Function::Exp)]
        f64::exp_m1, Double::expm1, |a| a.exp().plus(Real::new(-1.0, 0.0)), |a| Some(a.exp()?.plus(&Interval::whole(-1)));
}

/// Factor by which `Raised` multiplies in `f64`.
const RAISE_FACTOR: f64 = 1.0 + 1.0 / (1u32 << 26) as f64;

/// Smallest length that is divided by: shorter ones are treated as if they were this long.
pub(super) const MIN_DIVISOR: f64 = 1e-100;

impl Function {
    /// Whether the function, or its derivative, has an addition theorem, so that its values modulo p depend on the
    /// argument as a sum.
    pub fn needs_linear_form(self) -> bool {
        let row = self.row();
        match row.slope {
            FunctionOfArgument(other) | MinusFunctionOfArgument(other) => {
                row.law.is_additive() || other.row().law.is_additive()
            }
            _ => row.law.is_additive(),
        }
    }
}

impl Interval {
    /// Applies a function of one argument; `None` if it has no value, or none is known.
    pub fn apply(&self, function: Function) -> Option<Self> {
        (function.row().interval)(self)
    }
}

impl Real {
    /// Applies a function of one argument.
    pub fn apply(self, function: Function) -> Self {
        if !self.is_known() {
            return self.without(self);
        }
        (function.row().real)(self)
    }
}
