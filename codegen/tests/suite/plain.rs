//! The parser of short lines: it reads nothing but Rust.

use crate::format::plain::{is_attribute, is_statement, is_sum, is_value};

#[test]
fn what_is_read_is_rust() {
    for text in [
        "let a = x[0] * 2.0;",
        "let mut out = S::default();",
        "let (sin_q, _) = (-x[1]).sin_cos();",
        "let pi = S::from_f64(::core::f64::consts::PI);",
        "let c1 = S::from_f64(-1.5e-300);",
        "let c2 = S::from_f64(1e300);",
        "let k = &self.k;",
        "let t1 = k[1].mul_add(-t2, self.theta[0][1]);",
        "let t2 = t1.sin_cos().0;",
        "out[1][2] = -t1;",
        "*out = t1;",
        "slots[3] = x[0] / a;",
        "*self = next;",
        "self.theta[1] = value;",
        "next.update()?;",
        "if !(-a).is_positive() { return ::core::result::Result::Err(::hamel::Singular::inertia(\"w[2]\")); }",
        "if !(-a).is_positive() { return ::core::result::Result::Err(::hamel::Singular::inertia(\"ω\")); }",
        "if !a.is_positive() { return ::core::result::Result::Err(::hamel::Singular::mass()); }",
        "if !k[3].is_positive() { return ::core::result::Result::Err(::hamel::Singular::kinematics(1)); }",
    ] {
        assert!(is_statement(text), "{text}");
        syn::parse_str::<syn::Block>(&format!("{{{text}}}")).expect(text);
    }
    for text in [
        "[]",
        "[t1, -t2,]",
        "[[t1, k[15]], [a, b]]",
        "::core::result::Result::Ok([[x[0]], [k[1],\n]])",
    ] {
        assert!(is_value(text), "{text}");
        syn::parse_str::<syn::Expr>(text).expect(text);
    }
    for text in [
        "a",
        "-self.theta[1]",
        "self.rate(x, xi)",
        "::core::result::Result::Ok(())",
        "a * b?",
    ] {
        assert!(is_sum(text), "{text}");
        syn::parse_str::<syn::Expr>(text).expect(text);
    }
    for text in [
        "#[must_use]",
        "#[rustfmt::skip]",
        "#[allow(dead_code, clippy::type_complexity, reason = \"a [b], (c\")]",
    ] {
        assert!(is_attribute(text), "{text}");
        syn::parse_str::<syn::ItemStruct>(&format!("{text} struct A;")).expect(text);
    }
}

#[test]
fn what_is_no_rust_is_not_read() {
    for text in [
        "let a = x[0;",
        "let a = x 0];",
        "let a = k[115, 2.0;",
        "let type = 2.0;",
        "let a = type;",
        "let _ = _;",
        "let a = b c;",
        "let a = b + ;",
        "let a = 1.;5;",
        "let a = 2x;",
        "let a = no value for node 3;",
        "let a = b",
        "let = b;",
        "let a = (b;",
        "let a = b);",
        "let a = b.mul_add(c d);",
        "a[b] = c;",
        "a = ;",
        "a b;",
        "a??b;",
        "if !a.is_positive() { return ::core::result::Result::Err(::hamel::Singular::inertia(1); }",
        "if !a.is_positive() { return ::core::result::Result::Err(::hamel::Singular::inertia(\"w)); }",
        "if !a.is_positive() { return ::core::result::Result::Err(::hamel::Singular::inertia(w)); }",
        "",
    ] {
        assert!(!is_statement(text), "{text}");
    }
    for text in [
        "[",
        "]",
        "[a",
        "[a]]",
        "[a b]",
        "[,]",
        "[[a], k[1]",
        "[[a, k[1,], b]",
        "::core::result::Result::Ok([a]",
        "[[[a]]]",
    ] {
        assert!(!is_value(text), "{text}");
    }
    for text in ["", "a b", "()()b", "a +", "?", "(", "a: b", "a,"] {
        assert!(!is_sum(text), "{text}");
    }
    for text in [
        "#[]",
        "#[a",
        "#[a]]",
        "#[a b]",
        "#[a(b]",
        "#[a(b c)]",
        "#[a(b = c)]",
        "#[a(b = \"c)]",
    ] {
        assert!(!is_attribute(text), "{text}");
    }
}
