//! Expressions as text or LaTeX.

use super::expression::{Atom, Term};
use super::notation::latex_name;
use hamel_algebra::graph::Function;
use num_traits::{One, Signed};

/// A notation for expressions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notation {
    /// `(Theta[1,1] - Theta[2,2])/2`, in the syntax of descriptions.
    Text,
    /// `\tfrac{1}{2}(\Theta_{11} - \Theta_{22})`
    Latex,
}

impl Notation {
    /// Prints an expression.
    pub fn term(self, term: &Term) -> String {
        let sign = if term.is_negative() { "-" } else { "" };
        format!("{sign}{}", self.unsigned(term))
    }

    fn unsigned(self, term: &Term) -> String {
        let number = term.coefficient.abs();
        if let [(Atom::Sum(terms), 1)] = term.over.as_slice()
            && number.is_one()
            && term.under.is_empty()
            && !term.is_negative()
        {
            return self.sum(terms);
        }
        match self {
            Notation::Text => text_product(term, &number),
            Notation::Latex => latex_product(term, &number),
        }
    }

    fn sum(self, terms: &[Term]) -> String {
        let mut text = String::new();
        for (place, term) in terms.iter().enumerate() {
            let sign = match (place, term.is_negative()) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => " + ",
                (_, true) => " - ",
            };
            text.push_str(sign);
            text.push_str(&self.unsigned_operand(term));
        }
        text
    }

    /// Prints a term after a sign, where a sum needs parentheses.
    fn unsigned_operand(self, term: &Term) -> String {
        let positive = Term {
            coefficient: term.coefficient.abs(),
            ..term.clone()
        };
        if positive.bare_sum().is_some() {
            return self.group(&self.unsigned(&positive));
        }
        self.unsigned(&positive)
    }

    fn group(self, text: &str) -> String {
        match self {
            Notation::Latex if text.contains(r"\frac") => format!(r"\left({text}\right)"),
            Notation::Text | Notation::Latex => format!("({text})"),
        }
    }

    fn power(self, atom: &Atom, power: u32) -> String {
        match (self, atom, power) {
            (_, Atom::Sum(terms), _) => with_exponent(self, self.group(&self.sum(terms)), power),
            (Notation::Text, Atom::Name(name), _) => with_exponent(self, name.clone(), power),
            (Notation::Latex, Atom::Name(name), _) => with_exponent(self, latex_name(name), power),
            (
                _,
                Atom::External {
                    name,
                    arguments,
                    part,
                },
                _,
            ) => {
                let given = self.group(&self.arguments(arguments));
                let called = match self {
                    Notation::Text => format!("{name}{given}{part}"),
                    Notation::Latex => {
                        let index = part.trim_matches(['[', ']']);
                        let name = latex_name(name);
                        match index {
                            "" => format!("{name}{given}"),
                            _ => format!("{name}{given}_{{{index}}}"),
                        }
                    }
                };
                with_exponent(self, called, power)
            }
            (_, Atom::Call(Function::Select, arguments), _) => {
                with_exponent(self, self.choice(arguments), power)
            }
            (Notation::Text, Atom::Call(function, arguments), _) => {
                let name = function.name();
                with_exponent(
                    self,
                    format!("{name}({})", self.arguments(arguments)),
                    power,
                )
            }
            (Notation::Latex, Atom::Call(Function::Sqrt | Function::Norm, arguments), _) => {
                let root = format!(r"\sqrt{{{}}}", self.arguments(arguments));
                with_exponent(
                    self,
                    if power > 1 { self.group(&root) } else { root },
                    power,
                )
            }
            (Notation::Latex, Atom::Call(function, arguments), _) => {
                let name = with_exponent(self, function.row().latex.into(), power);
                format!("{name}{}", self.group(&self.arguments(arguments)))
            }
        }
    }

    /// Prints a selection: a if c > 0, otherwise b.
    fn choice(self, arguments: &[Term]) -> String {
        let [c, a, b] = arguments else {
            return self.arguments(arguments);
        };
        let [c, a, b] = [c, a, b].map(|argument| self.term(argument));
        match self {
            Notation::Text => format!("(if {c} > 0 {{ {a} }} else {{ {b} }})"),
            Notation::Latex => {
                format!(r"\begin{{cases}} {a} & {c} > 0 \\ {b} & \text{{else}} \end{{cases}}")
            }
        }
    }

    fn arguments(self, arguments: &[Term]) -> String {
        let written: Vec<String> = arguments
            .iter()
            .map(|argument| self.term(argument))
            .collect();
        written.join(", ")
    }

    fn factors(self, factors: &[(Atom, u32)]) -> Vec<String> {
        factors
            .iter()
            .map(|(atom, power)| self.power(atom, *power))
            .collect()
    }
}

fn with_exponent(notation: Notation, base: String, power: u32) -> String {
    match (notation, power) {
        (_, 1) => base,
        (Notation::Text, _) => format!("{base}^{power}"),
        (Notation::Latex, _) => format!("{base}^{{{power}}}"),
    }
}

fn text_product(term: &Term, number: &num_rational::BigRational) -> String {
    let mut over = Notation::Text.factors(&term.over);
    let mut under = Notation::Text.factors(&term.under);
    if !number.numer().is_one() || over.is_empty() {
        over.insert(0, number.numer().to_string());
    }
    if !number.denom().is_one() {
        under.insert(0, number.denom().to_string());
    }
    let over = over.join("*");
    match under.as_slice() {
        [] => over,
        [one] => format!("{over}/{one}"),
        _ => format!("{over}/({})", under.join("*")),
    }
}

fn latex_product(term: &Term, number: &num_rational::BigRational) -> String {
    let mut over = Notation::Latex.factors(&term.over);
    let mut under = Notation::Latex.factors(&term.under);
    if under.is_empty() && !number.denom().is_one() {
        let fraction = format!(r"\tfrac{{{}}}{{{}}}", number.numer(), number.denom());
        return format!("{fraction}{}", juxtapose(&over));
    }
    if !number.numer().is_one() || over.is_empty() {
        over.insert(0, number.numer().to_string());
    }
    if under.is_empty() {
        return juxtapose(&over);
    }
    if !number.denom().is_one() {
        under.insert(0, number.denom().to_string());
    }
    format!(
        r"\frac{{{}}}{{{}}}",
        fraction_part(&term.over, over),
        fraction_part(&term.under, under)
    )
}

/// Prints a numerator or denominator; a sum that is its only factor needs no parentheses.
fn fraction_part(factors: &[(Atom, u32)], written: Vec<String>) -> String {
    if let ([(Atom::Sum(terms), 1)], [_]) = (factors, written.as_slice()) {
        return Notation::Latex.sum(terms);
    }
    juxtapose(&written)
}

/// Joins factors; factors that are words are separated by a gap.
fn juxtapose(factors: &[String]) -> String {
    let is_word = |factor: &String| factor.contains(r"\mathrm");
    let mut text = String::new();
    for (place, factor) in factors.iter().enumerate() {
        if place > 0 {
            let gap = is_word(factor) || is_word(&factors[place - 1]);
            text.push_str(if gap { r" \, " } else { " " });
        }
        text.push_str(factor);
    }
    text
}

/// Prints indices, which are counted from 1: `135` if every size is at most 9, else `1,3,15`.
pub fn index(index: &[usize], shape: &[usize]) -> String {
    let digits: Vec<String> = index.iter().map(usize::to_string).collect();
    digits.join(if shape.iter().all(|&size| size <= 9) {
        ""
    } else {
        ","
    })
}
