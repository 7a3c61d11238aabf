//! Descriptions with names that C, its headers or the generated text may use.

const NAMES: &str = "
    int double long signed auto goto sizeof typedef restrict inline union register void bool_ float_ xor and not or class
    namespace template operator this_ new delete private virtual_ near far linux unix asm small interface
    y0 y1 j0 j1 jn gamma lgamma lgamma_r remainder sinf fabs fma fmax isnan isinf signbit round floor pow
    INFINITY NAN HUGE_VAL DBL_MAX FLT_MAX M_PI NULL EOF FP_FAST_FMA FUSED errno stdin double_t float_t
    real parameters system status set_parameters default_parameters sin_cos select inverse_of_length raised constants
    none next k x xi u out slots main printf size_t uint32_t int32_t memcpy zeros abort exit t1 c1
    sin1 cos1 _a a__b θ ω̇ é 名 SHOUT camelCase E I
";

/// Uses every name for a system, a parameter, an expression, a coordinate, a velocity, an input, a state and an output,
/// each in a description with seven other names.
pub fn descriptions() -> Vec<String> {
    let names: Vec<&str> = NAMES.split_whitespace().collect();
    let take = |index: usize, role: usize| names[(index + role * 13) % names.len()];
    let all = (0..names.len()).map(|index| {
        let [system, p, e, q, v, f, z, y] = std::array::from_fn(|role| take(index, role));
        format!(
            "pub system {system} {{ param {p} = 2; param {p}_m: sym2 = [[2, 1], [1, 3]]; let {e} = 1 + {q}^2;\n\
             coord {q}; velocity {v}; rate {q} = {v}; kinetic {e} * {p} * {v}^2; potential {p} * sin({e}) * {p}_m[1, 2];\n\
             state {z} = 1; rate {z} = {f} - {z}; input {f}; generalized force {v} = {z} - {p} * sign({v});\n\
             output {y} = if {q} < {v} {{ {e} * {p} }} else {{ abs({f}) }}; output {p}_{y} = [cos({e}), atan2({q}, {v})]; }}"
        )
    });
    all.collect()
}
