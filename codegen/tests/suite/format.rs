//! Layout of files: what is laid out without the printer is as the printer would have it.

// What the included files have it for, by this name.
use hamel_codegen::emit::names;
use included::formatted;

// What is laid out in public are programs, and none has all of these texts.
#[path = "../../src/emit/format.rs"]
mod included;
#[path = "../../src/emit/lines.rs"]
mod lines;
#[path = "../../src/emit/plain.rs"]
pub mod plain;

/// The printer alone, which the short way must not differ from.
fn printed(text: &str) -> String {
    prettyplease::unparse(&syn::parse_file(text).expect("Rust"))
}

#[test]
fn short_statements_come_back_as_the_printer_leaves_them() {
    let text = "impl A {\nfn f(&self, x: &[f64; 2]) -> f64 {\nlet a = x[0] * 2.0;\nlet b = a.mul_add(a, -a);\nlet (s, c) = b.sin_cos();\nlet very_long_name_of_a_value = (a + b) * (s - c) * (a - b) * (s + c) * (a + s) * (b + c);\n// a remark\nvery_long_name_of_a_value\n}\n}\n";
    assert_eq!(formatted(text), Ok(printed(text)));
}

#[test]
fn guards_and_lists_are_broken_where_the_printer_breaks_them() {
    for count in 1..40 {
        let names: Vec<String> = (0..count).map(|i| format!("-t{}", i * i)).collect();
        let row = format!("[{}]", names.join(", "));
        let short = format!("[{}]", names[..1 + count / 2].join(", "));
        for list in [
            row.clone(),
            format!("[{row}]"),
            format!("[{short}, {row}, {row}]"),
        ] {
            let text = format!(
                "impl A {{\nfn f(&self) -> B {{\nslots[3] = x[0][1] / a;\n\
                 if !a.is_positive() {{ return ::core::result::Result::Err(::hamel::Singular::inertia(\"v{count}\")); }}\n::core::result::Result::Ok({list})\n}}\n\
                 fn g(&self) -> C {{\nlet a = k[1];\n{list}\n}}\n}}\n"
            );
            assert_eq!(formatted(&text), Ok(printed(&text)));
        }
    }
}

#[test]
fn statements_of_any_length_come_back_as_the_printer_leaves_them() {
    for count in 1..40 {
        let name = "n".repeat(count);
        let text = format!(
            "impl A {{\nfn f(&self) {{\nlet {name} = {name}[0].mul_add(-{name}, x[{count}]);\nlet b = {name} * x[0];\n}}\n}}\n"
        );
        assert_eq!(formatted(&text), Ok(printed(&text)));
    }
}

#[test]
fn rows_that_end_in_an_index_keep_their_bracket() {
    for last in ["k[15]", "x[0][1]", "-k[3]", "self.a[2]"] {
        for count in 0..40 {
            let row = format!("[{}{last}]", "some_value, ".repeat(count));
            for list in [format!("[{row}]"), format!("[{row}, {row}, [{last}]]"), row] {
                let text =
                    format!("impl A {{\nfn f(&self) -> B {{\nlet a = 2.0;\n{list}\n}}\n}}\n");
                assert_eq!(formatted(&text), Ok(printed(&text)));
            }
        }
    }
}

#[test]
fn attributes_and_documentation_come_back_as_the_printer_leaves_them() {
    for count in 1..12 {
        let lints = "clippy::some_lint, ".repeat(count);
        let text = format!(
            "/// A structure, `x` and \"y\".\n///\n///   - set in, with a tail   \n#[rustfmt::skip]\n\
             #[allow({lints}dead_code, reason = \"of use\")]\n#[allow({lints}dead_code, reason = \"a, b (c)\")]\n\
             #[derive(Clone, Debug)]\n#[cfg(feature = \"a\")]\npub struct A {{\n/// A field: 'ω' \\ a.\npub a: f64,\n}}\n\
             #[rustfmt::skip]\nimpl A {{\n//// A remark.\n/// A method.\n#[allow({lints}dead_code)]\n#[must_use]\nfn f(&self) {{\nlet a = 2.0;\n}}\n}}\n"
        );
        assert_eq!(formatted(&text), Ok(printed(&text)));
    }
}

#[test]
fn what_is_no_rust_is_refused() {
    for text in [
        "/// Nothing is documented.\n",
        "#[must_use]\n",
        "#[allow(dead_code]\nfn f() {}\n",
        "#[allow(a, reason = \"b)]\nfn f() {}\n",
        "fn (",
        "fn f() {\nlet a = no value for node 3;\n}\n",
        "fn f() {\nlet a = k[3;\n}\n",
        "fn f() -> A {\n[a, k[3]\n}\n",
        "fn f() -> A {\n[a, b]\nlet a = b;\n}\n",
        "fn f() -> A {\nlet a = b;\n[[a, b], [c, type]]\n}\n",
    ] {
        assert!(formatted(text).is_err(), "{text}");
    }
}
