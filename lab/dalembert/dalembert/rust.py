"""Emitted Rust as an interface: several mechanisms in one crate, whose program reads a function and numbers from each
line."""

import os
import re
import subprocess

from .doors import Refused

ARGUMENTS = {"x", "xi", "u", "xi_dot", "momentum", "p"}

MANIFEST = """[package]
name = "witness"
edition = "2024"

[dependencies]
hamel = {{ path = "{root}/runtime", default-features = false, features = ["std"] }}

[profile.dev]
debug = false
incremental = false

[workspace]
"""

PROGRAM = """//! Functions of generated systems, by name.
use std::io::{BufRead, Write};
use std::str::SplitWhitespace;

/// Functions in Rust that descriptions name.
#[derive(Clone, Copy, Debug, Default)]
pub struct Polar;

trait Numbers {
    fn take(from: &mut SplitWhitespace) -> Self;
    fn put(&self, into: &mut Vec<String>);
}
impl Numbers for f64 {
    fn take(from: &mut SplitWhitespace) -> Self {
        from.next().unwrap().parse().unwrap()
    }
    fn put(&self, into: &mut Vec<String>) {
        into.push(format!("{self:e}"));
    }
}
impl<T: Numbers, const N: usize> Numbers for [T; N] {
    fn take(from: &mut SplitWhitespace) -> Self {
        std::array::from_fn(|_| T::take(from))
    }
    fn put(&self, into: &mut Vec<String>) {
        self.iter().for_each(|entry| entry.put(into));
    }
}
impl<T: Numbers> Numbers for Result<T, hamel::Singular> {
    fn take(from: &mut SplitWhitespace) -> Self {
        Ok(T::take(from))
    }
    fn put(&self, into: &mut Vec<String>) {
        match self {
            Ok(value) => value.put(into),
            Err(why) => into.push(format!("refused: {why:?}")),
        }
    }
}
fn take<T: Numbers>(from: &mut SplitWhitespace) -> T {
    T::take(from)
}
"""


class Crate:
    """Texts accepted by hamel, each with its interfaces, and the additional Rust code."""

    def __init__(self, hamel, folder, root):
        self.hamel, self.folder, self.root = hamel, folder, os.path.abspath(root)
        self.made, self.program = [], None
        os.makedirs(os.path.join(folder, "src"), exist_ok=True)

    def add(self, doors, externals):
        """Adds a text, and returns its index in the crate; results are available once all are built."""
        place = len(self.made)
        file = os.path.join(self.folder, "src", f"m{place}.rs")
        doors.run("emit", doors.file, "-o", file)
        with open(file, encoding="utf-8") as text:
            self.made.append(Emitted(self, place, text.read(), externals))
        return self.made[-1]

    def build(self):
        parts = [PROGRAM]
        for made in self.made:
            parts.append(f"#[allow(dead_code, unused)]\nmod m{made.place} {{\n    include!(\"m{made.place}.rs\");\n}}\n")
            parts += [text.replace("MODULE", f"m{made.place}") for text in made.externals]
            parts.append(made.dispatcher())
        parts.append("fn main() {\n")
        parts += [f"    let mut s{m.place} = {m.kind()}::default();\n" for m in self.made]
        parts.append("    for line in std::io::stdin().lock().lines() {\n        let line = line.unwrap();\n")
        parts.append("        let n = &mut line.split_whitespace();\n        let mut out = Vec::new();\n        match n.next().unwrap() {\n")
        parts += [f'            "{m.place}" => call{m.place}(&mut s{m.place}, n, &mut out),\n' for m in self.made]
        parts.append('            other => panic!("{other}"),\n        }\n        println!("{}", out.join(" "));\n')
        parts.append("        std::io::stdout().flush().unwrap();\n    }\n}\n")
        with open(os.path.join(self.folder, "src", "main.rs"), "w", encoding="utf-8") as out:
            out.write("".join(parts))
        with open(os.path.join(self.folder, "Cargo.toml"), "w", encoding="utf-8") as out:
            out.write(MANIFEST.format(root=self.root))
        target = os.path.join(self.folder, "target")
        command = ["cargo", "build", "--quiet", "--target-dir", target]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        if done.returncode != 0:
            raise Refused("cargo build: " + done.stderr[:4000])
        program = os.path.join(target, "debug", "witness")
        self.program = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, words):
        self.program.stdin.write(" ".join(words) + "\n")
        self.program.stdin.flush()
        return self.program.stdout.readline().strip()

    def close(self):
        if self.program:
            self.program.stdin.close()
            self.program.wait()


class Emitted:
    """One system of the crate, as a substitute for generated C."""

    def __init__(self, crate, place, text, externals):
        self.crate, self.place, self.externals = crate, place, externals
        self.name = re.search(r"pub struct (\w+)<S", text).group(1)
        fields = re.search(rf"pub struct {self.name}Parameters<S> \{{(.*?)\n\}}", text, re.S)
        self.fields = re.findall(r"pub (\w+):", fields.group(1)) if fields else []
        self.functions = {}
        for name, arguments in re.findall(r"\n    pub fn (\w+)\(\s*&self,?([^()]*)\)\s*->", text, re.S):
            names = re.findall(r"(\w+): &\[S; \d+\]", arguments)
            if arguments.count(":") == len(names) and set(names) <= ARGUMENTS and name not in ("to_array", "to_arrays"):
                self.functions[name] = names
        for field in self.fields:
            self.functions.pop(field, None)
        if self.fields:
            self.functions["set_parameters"] = []

    def kind(self):
        return f"m{self.place}::{self.name}::<f64{', Polar' if self.externals else ''}>"

    def dispatcher(self):
        """The function that calls a function by name."""
        lines = [f"fn call{self.place}(system: &mut {self.kind()}, n: &mut SplitWhitespace, out: &mut Vec<String>) {{\n", "    match n.next().unwrap() {\n"]
        if self.fields:
            values = ", ".join(f"{field}: take(n)" for field in self.fields)
            more = ", Polar" if self.externals else ""
            lines.append(f'        "set_parameters" => *system = <{self.kind()}>::new(m{self.place}::{self.name}Parameters {{ {values} }}{more}).unwrap(),\n')
        for name, arguments in self.functions.items():
            if name != "set_parameters":
                lines.append(f'        "{name}" => system.{name}({", ".join(["&take(n)"] * len(arguments))}).put(out),\n')
        return "".join([*lines, '        other => panic!("{other}"),\n    }\n}\n'])

    def __contains__(self, name):
        return name in self.functions

    def set(self, values):
        if self.fields:
            self.crate.ask([str(self.place), "set_parameters", *map(repr, values)])

    def call(self, name, size, **arguments):
        numbers = [repr(float(v)) for argument in self.functions[name] for v in arguments["momentum" if argument == "p" else argument]]
        said = self.crate.ask([str(self.place), name, *numbers])
        if said.startswith("refused"):
            raise Refused(f"{name}: {said}")
        found = [float(word) for word in said.split()]
        # As many as there is room for, as in C.
        return found + [777.0] * (size - len(found))


__all__ = ["Crate"]
