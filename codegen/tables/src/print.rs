//! Expressions as text, LaTeX or MathML.

use super::expression::{Atom, Term};
use super::notation::{latex_name, mathml_name};
use hamel_algebra::graph::Function;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed};

/// A notation for expressions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notation {
    /// `(Theta[1,1] - Theta[2,2])/2`, in the syntax of descriptions.
    Text,
    /// `\tfrac{1}{2}(\Theta_{11} - \Theta_{22})`
    Latex,
    /// Elements of MathML Core, without the `math` element around them.
    MathMl,
}

impl Notation {
    /// Prints an expression.
    pub fn term(self, term: &Term) -> String {
        let sign = if term.is_negative() {
            self.sign(0, true)
        } else {
            ""
        };
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
            Notation::Latex | Notation::MathMl => self.product(term, &number),
        }
    }

    /// Returns the sign in front of the term at a place of a sum.
    fn sign(self, place: usize, negative: bool) -> &'static str {
        match (self, place, negative) {
            (_, 0, false) => "",
            (Notation::MathMl, _, false) => "<mo>+</mo>",
            (Notation::MathMl, _, true) => "<mo>−</mo>",
            (_, 0, true) => "-",
            (_, _, false) => " + ",
            (_, _, true) => " - ",
        }
    }

    fn sum(self, terms: &[Term]) -> String {
        let mut text = String::new();
        for (place, term) in terms.iter().enumerate() {
            text.push_str(self.sign(place, term.is_negative()));
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
            Notation::MathMl => format!("<mrow><mo>(</mo>{text}<mo>)</mo></mrow>"),
        }
    }

    fn power(self, atom: &Atom, power: u32) -> String {
        match (self, atom, power) {
            (_, Atom::Sum(terms), _) => with_exponent(self, self.group(&self.sum(terms)), power),
            (_, Atom::Name(name), _) => with_exponent(self, self.name(name), power),
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
                    Notation::Latex | Notation::MathMl => {
                        let index = part.trim_matches(['[', ']']);
                        let name = self.name(name);
                        match (index, self) {
                            ("", _) => format!("{name}{given}"),
                            (_, Notation::MathMl) => {
                                format!("<msub><mrow>{name}{given}</mrow><mn>{index}</mn></msub>")
                            }
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
            (_, Atom::Call(Function::Sqrt | Function::Norm, arguments), _) => {
                let under = self.arguments(arguments);
                let root = match self {
                    Notation::MathMl => format!("<msqrt>{under}</msqrt>"),
                    _ => format!(r"\sqrt{{{under}}}"),
                };
                with_exponent(
                    self,
                    if power > 1 { self.group(&root) } else { root },
                    power,
                )
            }
            (_, Atom::Call(function, arguments), _) => {
                let name = match self {
                    Notation::MathMl => format!("<mi>{}</mi>", function.name()),
                    _ => function.row().latex.into(),
                };
                let name = with_exponent(self, name, power);
                let applied = match self {
                    Notation::MathMl => "<mo>\u{2061}</mo>",
                    _ => "",
                };
                format!("{name}{applied}{}", self.group(&self.arguments(arguments)))
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
            Notation::MathMl => format!(
                "<mrow><mo>{{</mo><mtable><mtr><mtd>{a}</mtd><mtd>{c}<mo>&gt;</mo><mn>0</mn></mtd></mtr>\
                 <mtr><mtd>{b}</mtd><mtd><mtext>else</mtext></mtd></mtr></mtable></mrow>"
            ),
        }
    }

    fn arguments(self, arguments: &[Term]) -> String {
        let written: Vec<String> = arguments
            .iter()
            .map(|argument| self.term(argument))
            .collect();
        written.join(match self {
            Notation::MathMl => "<mo>,</mo>",
            Notation::Text | Notation::Latex => ", ",
        })
    }

    /// Prints the name of a symbol with its indices.
    pub fn name(self, name: &str) -> String {
        match self {
            Notation::Text => name.to_string(),
            Notation::Latex => latex_name(name),
            Notation::MathMl => mathml_name(name),
        }
    }

    /// Prints 0.
    pub fn zero(self) -> String {
        self.number(&BigInt::default())
    }

    fn number(self, number: &BigInt) -> String {
        match self {
            Notation::MathMl => format!("<mn>{number}</mn>"),
            Notation::Text | Notation::Latex => number.to_string(),
        }
    }

    fn fraction(self, over: &str, under: &str) -> String {
        match self {
            Notation::MathMl => {
                format!("<mfrac><mrow>{over}</mrow><mrow>{under}</mrow></mfrac>")
            }
            Notation::Text | Notation::Latex => format!(r"\frac{{{over}}}{{{under}}}"),
        }
    }

    /// Prints a product in LaTeX or MathML.
    fn product(self, term: &Term, number: &BigRational) -> String {
        let mut over = self.factors(&term.over);
        let mut under = self.factors(&term.under);
        if under.is_empty() && !number.denom().is_one() {
            let (numerator, denominator) =
                (self.number(number.numer()), self.number(number.denom()));
            let fraction = match self {
                Notation::MathMl => self.fraction(&numerator, &denominator),
                _ => format!(r"\tfrac{{{numerator}}}{{{denominator}}}"),
            };
            return format!("{fraction}{}", self.juxtapose(&over));
        }
        if !number.numer().is_one() || over.is_empty() {
            over.insert(0, self.number(number.numer()));
        }
        if under.is_empty() {
            return self.juxtapose(&over);
        }
        if !number.denom().is_one() {
            under.insert(0, self.number(number.denom()));
        }
        let over = self.fraction_part(&term.over, over);
        self.fraction(&over, &self.fraction_part(&term.under, under))
    }

    /// Prints a numerator or denominator; a sum that is its only factor needs no parentheses.
    fn fraction_part(self, factors: &[(Atom, u32)], written: Vec<String>) -> String {
        if let ([(Atom::Sum(terms), 1)], [_]) = (factors, written.as_slice()) {
            return self.sum(terms);
        }
        self.juxtapose(&written)
    }

    /// Joins factors; factors that are words are separated by a gap.
    fn juxtapose(self, factors: &[String]) -> String {
        if self == Notation::MathMl {
            return factors.join("<mspace width=\"0.17em\"/>");
        }
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
        (Notation::MathMl, _) => format!("<msup><mrow>{base}</mrow><mn>{power}</mn></msup>"),
    }
}

fn text_product(term: &Term, number: &BigRational) -> String {
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

/// Prints indices, which are counted from 1: `135` if every size is at most 9, else `1,3,15`.
pub fn index(index: &[usize], shape: &[usize]) -> String {
    let digits: Vec<String> = index.iter().map(usize::to_string).collect();
    digits.join(if shape.iter().all(|&size| size <= 9) {
        ""
    } else {
        ","
    })
}
