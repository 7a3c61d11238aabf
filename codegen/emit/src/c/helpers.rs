//! Definitions at the top of a generated source, each only if it is used: functions that `<math.h>` does not have,
//! with the same values as in the Rust runtime.

use super::language::Precision;
use super::names::CIdentifiers;

/// Macro for a b + c, fused if the machine has an instruction for it; undefined again by [`END`].
const FUSED: &str = "\
/* a b + c: rounded once where the machine has an instruction for it, twice elsewhere. */
#if @FAST
#define FUSED(a, b, c) fma@F((a), (b), (c))
#else
#define FUSED(a, b, c) ((a) * (b) + (c))
#endif
";

/// Name of an array of zeros, from which several results are copied at once: gcc assigns them one by one otherwise.
pub const ZEROS_NAME: &str = "zeros";
/// Length of the array of zeros, and largest number of zeros that one `memcpy` copies: for more, compilers emit a loop or
/// a call. Longer runs take several.
pub const MAX_ZEROS: usize = 4;

/// Macro with compiler attributes of the parts of long functions; undefined again by [`END`].
const PART: &str = "\
/* A part of a long function. It stays by itself: what is short is read in short time. Its arrays are given to it from where
   most of what it reads is near, before and behind, which makes instructions shorter. */
#if defined(__GNUC__)
#define PART static __attribute__((noinline))
#else
#define PART static
#endif
";

/// Substitutions for `double`. `@FAST` tells whether `fma` is one instruction; compilers report this in different ways.
const DOUBLE: &[(&str, &str)] = &[
    (
        "@FAST",
        "defined(FP_FAST_FMA) || defined(__FMA__) || defined(__aarch64__)",
    ),
    ("@SHORTEST", "1e-100"),
    ("@RAISED", "(1.0 + 1.0 / 67108864.0)"),
    ("@DIGITS", "DBL_MANT_DIG == 53"),
    ("@BITS", "uint64_t"),
    ("@INFINITY", "UINT64_C(0x7FF0000000000000)"),
    ("@LARGEST", "DBL_MAX"),
    ("@NORMAL", "UINT64_C(0x0010000000000000)"),
    ("@LEAST", "DBL_MIN"),
];
const FLOAT: &[(&str, &str)] = &[
    (
        "@FAST",
        "defined(FP_FAST_FMAF) || defined(__FMA__) || defined(__aarch64__) || defined(__ARM_FEATURE_FMA)",
    ),
    ("@SHORTEST", "1e-12f"),
    ("@RAISED", "(1.0f + 1.0f / 32768.0f)"),
    ("@DIGITS", "FLT_MANT_DIG == 24"),
    ("@BITS", "uint32_t"),
    ("@INFINITY", "UINT32_C(0x7F800000)"),
    ("@LARGEST", "FLT_MAX"),
    ("@NORMAL", "UINT32_C(0x00800000)"),
    ("@LEAST", "FLT_MIN"),
];

/// Macros with compiler attributes of sine and cosine; undefined again by [`END`].
const HINTS: &str = "\
/* What follows is worth its room in every place, or hardly ever runs. */
#if defined(__GNUC__) && !defined(__OPTIMIZE_SIZE__)
#define INLINE static inline __attribute__((always_inline))
#define RARE static __attribute__((cold, noinline))
#else
#define INLINE static inline
#define RARE static
#endif
";

/// Text after the functions that undefines the macros, as far as they are used.
const END: [&str; 3] = [
    "#undef FUSED\n",
    "#undef INLINE\n#undef RARE\n",
    "#undef PART\n",
];

/// Names and texts of the helper functions. `@_` is replaced by the prefix, `@REAL` by the type of numbers, and `@F` by
/// the suffix of literals and `<math.h>` functions. A helper may call those before it.
const HELPERS: &[(&str, &str)] = &[
    (
        "sign",
        "\
/* 1 with the sign of a, 0 of 0, NaN of NaN. */
static inline @REAL @_sign(@REAL a)
{
    return a > 0.0@F ? 1.0@F : a < 0.0@F ? -1.0@F : a;
}
",
    ),
    (
        "select",
        "\
/* a where c > 0, else b; NaN where c is. */
static inline @REAL @_select(@REAL c, @REAL a, @REAL b)
{
    return c > 0.0@F ? a : c <= 0.0@F ? b : c;
}
",
    ),
    (
        "is_positive",
        "\
/* Whether a pivot can be divided by, positive, finite and not subnormal: by one comparison of bits where numbers are those of IEEE 754. */
static inline int @_is_positive(@REAL a)
{
#if FLT_RADIX == 2 && @DIGITS
    @BITS bits;
    memcpy(&bits, &a, sizeof bits);
    return bits - @NORMAL < @INFINITY - @NORMAL;
#else
    return a >= @LEAST && a <= @LARGEST;
#endif
}
",
    ),
    (
        "inverse_of_length",
        "\
/* 1/a, but a large number where a is nearly 0: times a sum of products that are 0 there it is 0. */
static inline @REAL @_inverse_of_length(@REAL a)
{
    return 1.0@F / (fabs@F(a) < @SHORTEST ? @SHORTEST : a);
}
",
    ),
    (
        "raised",
        "\
/* a, larger by a part that rounding does not hide: a pivot that may be nothing but rounding becomes one that can be divided by. */
static inline @REAL @_raised(@REAL a)
{
    return a * @RAISED;
}
",
    ),
];

/// Sine and cosine for `float`.
const TURN_FLOAT: &str = "\
/* Sine and cosine of an angle, rad. */
static inline void @_sin_cos(float angle, float *sine, float *cosine)
{
    *sine = sinf(angle);
    *cosine = cosf(angle);
}
";

/// Sine and cosine for `double`, with the same algorithm as `runtime/src/trig.rs`.
const TURN_DOUBLE: &str = "\
/*
 * Sine and cosine of an angle, rad, from one reduction and without a call, which nothing else would overlap.
 * Polynomials and the parts of pi/2 are those of fdlibm (k_sin.c, k_cos.c, e_rem_pio2.c; (c) 1993 Sun
 * Microsystems, Inc., permission to use, copy, modify and distribute is freely granted).
 */
RARE void @_far(double angle, double *sine, double *cosine)
{
    *sine = sin(angle);
    *cosine = cos(angle);
}

INLINE void @_sin_cos(double angle, double *sine, double *cosine)
{
    double far_sine, far_cosine;
#if FLT_EVAL_METHOD == 0 && !defined(__FAST_MATH__)
    /* sin = a sin r + b cos r, cos = c cos r + d sin r after 0 to 3 quarter turns. */
    static const double turned[4][4] = {
        {1.0, -0.0, 1.0, 0.0}, {0.0, 1.0, 0.0, -1.0}, {-1.0, 0.0, -1.0, 0.0}, {0.0, -1.0, 0.0, 1.0}
    };
    if (fabs(angle) <= 1e6) {
        /* A sum with 3/2 2^52 is rounded to a whole number. */
        const double turns = FUSED(angle, 0.6366197723675814, 6755399441055744.0) - 6755399441055744.0;
        const double *const turn = turned[(uint32_t)(int32_t)turns & 3u];
#if @FAST
        const double close = FUSED(-turns, 1.5707963267948966, angle);
        const double r = FUSED(-turns, 6.123233995736766e-17, close);
        const double lost = FUSED(turns, 6.123233995736766e-17, r - close);
#else
        const double part = turns * 6.077100506303966e-11;
        const double first = angle - turns * 1.5707963267341256;
        const double close = first - part;
        const double less = turns * 2.0222662487959506e-21 - ((first - close) - part);
        const double r = close - less;
        const double lost = less - (close - r);
#endif
        const double z = r * r;
        const double w = z * z;
        const double s1 = FUSED(z, 0.00833333333332249, -0.16666666666666632);
        const double s2 = FUSED(z, 2.7557313707070068e-6, -0.0001984126982985795);
        const double s3 = FUSED(z, 1.58969099521155e-10, -2.5050760253406863e-8);
        const double s = r - FUSED(-(z * r), FUSED(FUSED(s3, w, s2), w, s1), lost);
        const double c1 = FUSED(z, -0.001388888888887411, 0.0416666666666666);
        const double c2 = FUSED(z, -2.7557314351390663e-7, 2.480158728947673e-5);
        const double c3 = FUSED(z, -1.1359647557788195e-11, 2.087572321298175e-9);
        const double most = FUSED(z, -0.5, 1.0);
        const double rest = FUSED(z, -0.5, 1.0 - most);
        const double c = FUSED(w, FUSED(FUSED(c3, w, c2), w, c1), FUSED(r, lost, rest)) + most;
        *sine = FUSED(turn[1], c, turn[0] * s);
        *cosine = FUSED(turn[3], s, turn[2] * c);
        return;
    }
#endif
    /* Numbers of their own, so that those above need no places in memory. */
    @_far(angle, &far_sine, &far_cosine);
    *sine = far_sine;
    *cosine = far_cosine;
}
";

/// Functions for the cases where only the sine or only the cosine is used.
const HALVES: &[(&str, &str)] = &[
    (
        "sin",
        "\
/* Sine of an angle, rad. */
static inline @REAL @_sin(@REAL angle)
{
    @REAL sine, cosine;
    @_sin_cos(angle, &sine, &cosine);
    return sine;
}
",
    ),
    (
        "cos",
        "\
/* Cosine of an angle, rad. */
static inline @REAL @_cos(@REAL angle)
{
    @REAL sine, cosine;
    @_sin_cos(angle, &sine, &cosine);
    return cosine;
}
",
    ),
];

/// Returns the C text that goes before and after these functions: the helpers that they call.
pub fn helpers_around(functions: &str, names: &CIdentifiers, precision: Precision) -> [String; 2] {
    let called = |text: &str, name: &str| text.contains(&format!("{}(", names.identifier(name)));
    let spelled = |text: &str| {
        let words = match precision {
            Precision::Double => DOUBLE,
            Precision::Float => FLOAT,
        };
        let mut text = text.to_string();
        for (word, spelling) in words {
            text = text.replace(word, spelling);
        }
        let suffix = precision.suffix();
        text.replace("@F", suffix)
            .replace("@REAL", &names.real())
            .replace("@_", &format!("{}_", names.prefix))
    };
    let mut before = String::new();
    let push = |before: &mut String, text: &str| {
        before.push_str(&spelled(text));
        before.push('\n');
    };
    for (name, text) in HELPERS {
        if called(functions, name) {
            push(&mut before, text);
        }
    }
    let halves = || HALVES.iter().filter(|(name, _)| called(functions, name));
    if called(functions, "sin_cos") || halves().next().is_some() {
        push(
            &mut before,
            match precision {
                Precision::Double => TURN_DOUBLE,
                Precision::Float => TURN_FLOAT,
            },
        );
    }
    for (_, text) in halves() {
        push(&mut before, text);
    }
    let mut after = String::new();
    let zeros = names.identifier(ZEROS_NAME);
    if functions.contains(&format!("{zeros},")) {
        let (real, zero) = (names.real(), precision.literal(0.0));
        let list = [zero.as_str(); MAX_ZEROS].join(", ");
        before.push_str(&format!(
            "static const {real} {zeros}[{MAX_ZEROS}] = {{{list}}};\n\n"
        ));
    }
    let uses = |before: &str, word: &str| functions.contains(word) || before.contains(word);
    if functions.contains("\nPART ") {
        before = format!("{PART}\n{before}");
        after = END[2].into();
    }
    if uses(&before, "INLINE ") {
        before = format!("{}\n{before}", spelled(HINTS));
        after = format!("{}{after}", END[1]);
    }
    if uses(&before, "FUSED(") {
        before = format!("{}\n{before}", spelled(FUSED));
        after = format!("{}{after}", END[0]);
    }
    if !after.is_empty() {
        after = format!("\n{after}");
    }
    [before, after]
}

#[cfg(test)]
mod tests {
    use super::HELPERS;
    use hamel_algebra::function::{Function, Slope};

    /// A function of one argument is in `<math.h>`, or has a helper.
    #[test]
    fn every_function_has_a_name_in_c() {
        for function in Function::ALL {
            let row = function.row();
            match row.c.strip_prefix("@_") {
                Some(helper) => assert!(HELPERS.iter().any(|(name, _)| *name == helper)),
                None => assert_eq!(
                    row.c.is_empty(),
                    row.slope == Slope::SeveralArguments,
                    "{function:?}"
                ),
            }
        }
    }
}
