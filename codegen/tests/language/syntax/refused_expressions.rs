//! Refused expressions.

use super::refused::line;

#[test]
fn expressions() {
    let cases = [
        r#"let x = ;"#,
        r#"let x = 2 y;"#,
        r#"let x = 2(a);"#,
        r#"let x = a ** b;"#,
        r#"let x = a +;"#,
        r#"let x = + a;"#,
        r#"let x = a % b;"#,
        r#"let x = (a, b);"#,
        r#"let x = ();"#,
        r#"let x = {a};"#,
        r#"let x = [];"#,
        r#"let x = [1 2];"#,
        r#"let x = a.1;"#,
        r#"let x = 0.5.T;"#,
        r#"let x = 2[1];"#,
        r#"let x = v[];"#,
        r#"let x = v[1, 2, 3];"#,
        r#"let x = a.;"#,
        r#"let x = f(a;b);"#,
        r#"let x = in;"#,
        r#"let x = fn;"#,
        r#"let x = a::b;"#,
        r#"let x = 1e;"#,
        r#"let x = 1u8;"#,
        r#"let x = 1_f64;"#,
        r#"let x = .5;"#,
        r#"let x = 0x1;"#,
        r#"let x = "a";"#,
        r#"let x = 1e999;"#,
        r#"let x = #a;"#,
        r#"let x = if a < b { c };"#,
        r#"let x = if a < b < c { 1 } else { 2 };"#,
        r#"let x = if a = b { 1 } else { 2 };"#,
        r#"let x = if { 1 } else { 2 };"#,
        r#"let x = if a < { 1 } else { 2 };"#,
        r#"let x = if a < b { 1 } else if { 2 };"#,
        r#"let x = if"#,
        r#"let x = yyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyy zzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzz;"#,
    ];
    insta::assert_snapshot!(cases.map(line).join("\n"), @r#"
    2:9 expected an expression, found `;` <;>
      a named expression is written `let e = m * s;`
    2:11 expected `;` after `2`, found `y` <y>
      a product is written with `*`; a statement ends with `;`
    2:10 expected `;` after `2`, found `(` <(>
      a product is written with `*`; a statement ends with `;`
    2:11 `**` is not an operator <**>
      a power is written with `^`
    2:12 expected an expression, found `;` <;>
      a named expression is written `let e = m * s;`
    2:9 expected an expression, found `+` <+>
      write a term on both sides of `+`
    2:11 expected `;` after `a`, found `%` <%>
      the operators are `+`, `-`, `*`, `/` and `^`
    2:11 expected `)`, found `,` <,>
      a vector is written `[a, b, c]`
    2:10 expected an expression, found `)` <)>
      a named expression is written `let e = m * s;`
    2:9 expected an expression, found `{` <{>
      parts of an expression are grouped with `(` and `)`
    2:9 this array has no entries <[]>
      a vector is written `[a, b, c]`, a matrix by rows `[[a, b], [c, d]]`
    2:12 expected `,` or `]`, found `2` <2>
      a product is written with `*`; a statement ends with `;`
    2:11 expected the name of a part, found `1` <1>
      components are numbered from 1, in brackets: `v[1]`
    2:9 a number has no parts <0.5.T>
      a product is written with `*`
    2:10 a number has no parts <[>
      a product is written with `*`
    2:10 expected one index or two <[]>
      components are written `v[i]` and `M[i, j]`, numbered from 1
    2:10 expected one index or two <[1, 2, 3]>
      components are written `v[i]` and `M[i, j]`, numbered from 1
    2:11 expected the name of a part, found `;` <;>
      a named expression is written `let e = m * s;`
    2:12 expected `,` or `)`, found `;` <;>
      a named expression is written `let e = m * s;`
    2:9 expected an expression, found `in` <in>
      a named expression is written `let e = m * s;`
    2:9 `fn` is a word of Rust and cannot be a name <fn>
      choose another name, such as `fn_`
    2:10 expected `;` after `a`, found `:` <:>
      a named expression is written `let e = m * s;`
    2:9 the exponent of `1e` is missing <1e>
      exponents are written `1e-3`
    2:9 the number `1u8` has a suffix <1u8>
      numbers are exact and have no type: write `1`
    2:9 the number `1_f64` has a suffix <1_f64>
      numbers are exact and have no type: write `1`
    2:9 expected an expression, found `.` <.>
      numbers have a digit before their point: `0.5`
    2:9 `0x1` is not a decimal number <0x1>
      write it with decimal digits
    2:9 a string is not a value: `"a"` <"a">
      values are made of numbers, names and arrays
    2:9 the exponent of `1e999` is beyond 400 <1e999>
      choose other units, or check the exponent
    2:9 expected an expression, found `#` <#>
      a named expression is written `let e = m * s;`
    2:9 this `if` has no `else` <if a < b { c }>
      an expression needs a value everywhere: `if a < b { c } else { d }`
    2:18 more than one comparison <<>
      write one choice within another: `if a < b { if b < c { d } else { e } } else { e }`
    2:14 numbers cannot be compared for equality <=>
      rounding would decide the result: compare with `<`, `<=`, `>` or `>=`, such as `abs(a - b) < 1e-6`
    2:12 expected an expression, found `{` <{>
      parts of an expression are grouped with `(` and `)`
    2:16 expected an expression, found `{` <{>
      parts of an expression are grouped with `(` and `)`
    2:32 expected an expression, found `{` <{>
      parts of an expression are grouped with `(` and `)`
    3:1 expected an expression, found `}` <}>
      a named expression is written `let e = m * s;`
    2:70 expected `;` after `yyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyyy…`, found `zzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzz…` <zzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzz>
      a product is written with `*`; a statement ends with `;`
    "#);
}
