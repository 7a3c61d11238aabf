//! Identifiers of generated C.
//!
//! | what | pattern |
//! |---|---|
//! | functions | prefix + name as in Rust: `free_body_accel` |
//! | types | prefix + `_real`, `_parameters`, `_system`, `_status` |
//! | macros, constants | the same in capitals: `FREE_BODY_RESTRICT`, `FREE_BODY_X_R`, `FREE_BODY_STATUS_OK` |
//! | fields of parameters, temporaries | as in Rust |
//!
//! The prefix is the name of the system in snake case. A word that C, C++, their headers or Rust want for
//! themselves gets `_`, whether it would do harm in its place or not: so a name depends on nothing but itself.

use crate::emit::names::{Names, Unique, Words, snake};
use crate::program::{Cause, Program};

/// Keywords of C up to C23 and of C++ up to C++20 beyond those of Rust, names of the headers that generated text
/// includes, and what common systems define as macros; in lines of words.
const RESERVED: &[&str] = &[
    // Keywords.
    "alignas alignof and and_eq asm auto bitand bitor bool case catch char char16_t char32_t",
    "char8_t class co_await co_return co_yield compl concept const_cast consteval constexpr",
    "constinit decltype default delete double dynamic_cast explicit export extern float",
    "fortran friend goto inline int long mutable namespace new noexcept not not_eq nullptr",
    "operator or or_eq private protected public register reinterpret_cast requires restrict",
    "short signed sizeof static_assert static_cast switch template this thread_local throw",
    "typedef typeid typename typeof_unqual union unsigned using void volatile wchar_t xor",
    "xor_eq",
    // <math.h>, with what systems add to it.
    "acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh cospi double_t drem",
    "erf erfc exp exp10 exp2 expm1 fabs fdim finite float_t floor fma fmax fmin fmod",
    "fpclassify frexp gamma gamma_r hypot ilogb isfinite isgreater isgreaterequal isinf",
    "isless islessequal islessgreater isnan isnormal isunordered j0 j1 jn ldexp lgamma",
    "lgamma_r lgammaf_r lgammal_r llrint llround log log10 log1p log2 logb lrint lround",
    "math_errhandling modf nan nearbyint nextafter nexttoward pow pow10 remainder remquo rint",
    "round scalb scalbln scalbn signbit signgam significand sin sincos sinh sinpi sqrt tan",
    "tanh tgamma trunc y0 y1 yn",
    // Other headers, and macros of theirs and of systems.
    "errno far huge i386 interface linux memcpy near small stderr stdin stdout unix",
];

/// Local names that a function may use besides those of its values.
const LOCALS: &[&str] = &[
    "x",
    "xi",
    "u",
    "xi_dot",
    "momentum",
    "k",
    "slots",
    "out",
    "system",
    "parameters",
    "next",
    "status",
];

/// What the generated text calls its own types and functions, after the prefix.
const OWN: &[&str] = &[
    "real",
    "parameters",
    "system",
    "status",
    "set_parameters",
    "default_parameters",
    "sin_cos",
    "sin",
    "cos",
    "sign",
    "select",
    "inverse_of_length",
    "raised",
    "is_positive",
    "far",
    "zeros",
];

/// Another name in the place of a reserved one.
fn legal(name: String) -> String {
    let is_reserved = |wanted: &str| {
        let mut words = RESERVED.iter().flat_map(|line| line.split(' '));
        words.any(|word| word == wanted)
    };
    // `sinf` beside `sin`.
    let of_float = name.strip_suffix('f').is_some_and(is_reserved);
    match is_reserved(&name) || of_float {
        true => format!("{name}_"),
        false => name,
    }
}

/// The identifiers of a program.
pub struct Identifiers {
    /// In front of all others.
    pub prefix: String,
    /// The same in capitals.
    pub capitals: String,
    /// The functions with their prefix, in order.
    pub functions: Vec<String>,
    /// Fields of the parameter groups, in order.
    pub fields: Vec<String>,
}

impl Identifiers {
    /// Those of a program, and its names as in Rust.
    pub fn of(program: &Program) -> (Self, Names) {
        let names = Names::beside(program, OWN);
        let prefix = snake(&program.name).trim_end_matches('_').to_string();
        // In C++ a member cannot be called as a type that its struct mentions.
        let own: Vec<String> = OWN.iter().map(|name| format!("{prefix}_{name}")).collect();
        let mut members = Unique::new(&own.iter().map(String::as_str).collect::<Vec<_>>());
        let identifiers = Identifiers {
            capitals: prefix.to_ascii_uppercase(),
            functions: (names.functions.iter())
                .map(|name| legal(format!("{prefix}_{name}")))
                .collect(),
            fields: (names.fields.iter())
                .map(|name| members.claim(&legal(name.clone())))
                .collect(),
            prefix,
        };
        (identifiers, names)
    }

    /// One of the generated text's own types or functions.
    pub fn own(&self, name: &str) -> String {
        format!("{}_{name}", self.prefix)
    }

    /// The type of numbers.
    pub fn real(&self) -> String {
        self.own("real")
    }

    /// The words that values of a function cannot be called.
    pub fn words(&self) -> Words {
        let own: Vec<String> = OWN.iter().map(|name| self.own(name)).collect();
        let own = own.iter().map(String::as_str);
        let taken: Vec<&str> = LOCALS.iter().copied().chain(own).collect();
        Words {
            locals: Unique::new(&taken),
            legal,
        }
    }

    /// The name of a status.
    pub fn status(&self, cause: Cause) -> String {
        let capitals = &self.capitals;
        match cause {
            Cause::Velocity(place) => format!("{capitals}_STATUS_INERTIA_{place}"),
            Cause::Mass => format!("{capitals}_STATUS_INERTIA"),
            Cause::Constraint(row) => format!("{capitals}_STATUS_CONSTRAINT_{row}"),
            Cause::Kinematics(number) => format!("{capitals}_STATUS_KINEMATICS_{number}"),
        }
    }

    /// The status of a function that has a value.
    pub fn done(&self) -> String {
        format!("{}_STATUS_OK", self.capitals)
    }
}

#[cfg(test)]
mod tests {
    use super::legal;

    #[test]
    fn words_of_c_and_of_its_headers_are_left_to_them() {
        for word in ["int", "y0", "sin", "sinf", "linux", "xor", "gamma"] {
            assert_eq!(legal(word.into()), format!("{word}_"));
        }
        for word in ["of", "f", "sine", "m", "k", "infinity"] {
            assert_eq!(legal(word.into()), word);
        }
    }
}
