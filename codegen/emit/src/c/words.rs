//! Words reserved by C, C++ and their headers.

#[cfg(test)]
mod tests;

use std::collections::HashSet;
use std::sync::LazyLock;

/// Keywords of C up to C23 and of C++ up to C++20 that are not keywords of Rust, names from the headers that generated
/// text includes, and macros of common systems; each line has several words.
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
    // Other headers, and macros that they or the systems define.
    "errno far huge i386 interface linux memcpy near small stderr stdin stdout unix",
];

/// The words of [`RESERVED`] as a set.
static WORDS: LazyLock<HashSet<&str>> =
    LazyLock::new(|| RESERVED.iter().flat_map(|line| line.split(' ')).collect());

/// Returns a name as a legal C identifier: `_` is appended to a reserved word.
pub fn legal_identifier(name: String) -> String {
    // The `float` variants are reserved as well: `sinf` along with `sin`.
    let of_float = |name: &str| name.strip_suffix('f').is_some_and(|f| WORDS.contains(f));
    match WORDS.contains(name.as_str()) || of_float(&name) {
        true => format!("{name}_"),
        false => name,
    }
}
