//! Expressions in readable form: quotients of products of powers, sums, calls.

use hamel_algebra::graph::Function;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

/// A factor of a product.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Atom {
    /// A symbol of the description or a temporary, by its name in text.
    Name(String),
    /// A sum of two or more terms.
    Sum(Vec<Term>),
    /// A built-in function with its arguments.
    Call(Function, Vec<Term>),
    /// A component of an external function.
    External {
        /// Text before the arguments.
        name: String,
        /// The arguments.
        arguments: Vec<Term>,
        /// Index of the component, as in `[1]`; empty if there is only one.
        part: String,
    },
}

/// A product: coefficient · Π over / Π under, where every factor has a power.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Term {
    /// Numeric coefficient.
    pub coefficient: BigRational,
    /// Factors of the numerator.
    pub over: Vec<(Atom, u32)>,
    /// Factors of the denominator.
    pub under: Vec<(Atom, u32)>,
}

impl Term {
    /// Creates a number.
    pub fn number(value: BigRational) -> Self {
        Term {
            coefficient: value,
            over: Vec::new(),
            under: Vec::new(),
        }
    }

    /// Creates a product of a single factor.
    pub fn atom(atom: Atom) -> Self {
        Term {
            coefficient: BigRational::one(),
            over: vec![(atom, 1)],
            under: Vec::new(),
        }
    }

    /// Creates a name.
    pub fn name(name: &str) -> Self {
        Term::atom(Atom::Name(name.to_string()))
    }

    /// Whether the term is 0.
    pub fn is_zero(&self) -> bool {
        self.coefficient.is_zero()
    }

    /// Whether the coefficient is negative.
    pub fn is_negative(&self) -> bool {
        self.coefficient.is_negative()
    }

    /// Returns −t. If the term is a sum alone, its terms change their signs.
    pub fn negated(mut self) -> Self {
        match self.terms_mut() {
            Some(terms) => {
                for term in terms.iter_mut() {
                    term.coefficient = -term.coefficient.clone();
                }
                positive_first(terms);
            }
            None => self.coefficient = -self.coefficient,
        }
        self
    }

    /// Returns −t if `negative`, else t.
    pub fn signed(self, negative: bool) -> Self {
        if negative { self.negated() } else { self }
    }

    /// Returns the product a b; equal factors of numerator and denominator cancel.
    pub fn times(mut self, other: &Term) -> Self {
        self.coefficient *= &other.coefficient;
        if self.coefficient.is_zero() {
            return Term::number(self.coefficient);
        }
        for (atom, power) in &other.over {
            multiply(&mut self.over, &mut self.under, atom, *power);
        }
        for (atom, power) in &other.under {
            multiply(&mut self.under, &mut self.over, atom, *power);
        }
        self
    }

    /// Returns the quotient a / b, or a if b is 0, which is no case of a quotient in the graph.
    pub fn divided(self, other: &Term) -> Self {
        if other.is_zero() {
            return self;
        }
        self.times(&Term {
            coefficient: other.coefficient.recip(),
            over: other.under.clone(),
            under: other.over.clone(),
        })
    }

    /// Returns the sum of the parts. Nested sums are flattened, and a positive term comes first if there is one.
    pub fn sum(parts: Vec<Term>) -> Self {
        let mut terms: Vec<Term> = Vec::new();
        for part in parts {
            match part.bare_sum() {
                Some(inner) => terms.extend(inner.iter().cloned()),
                None if part.is_zero() => {}
                None => terms.push(part),
            }
        }
        positive_first(&mut terms);
        match terms.len() {
            0 => Term::number(BigRational::zero()),
            1 => terms.remove(0),
            _ => Term::atom(Atom::Sum(terms)),
        }
    }

    /// Returns the terms of a sum that is the whole expression, with coefficient 1.
    pub fn bare_sum(&self) -> Option<&[Term]> {
        match self.over.as_slice() {
            [(Atom::Sum(terms), 1)] if self.coefficient.is_one() && self.under.is_empty() => {
                Some(terms)
            }
            _ => None,
        }
    }

    fn terms_mut(&mut self) -> Option<&mut Vec<Term>> {
        let alone = self.under.is_empty() && self.coefficient.abs().is_one();
        let positive = self.coefficient.is_positive();
        match self.over.as_mut_slice() {
            [(Atom::Sum(terms), 1)] if alone && positive => Some(terms),
            _ => None,
        }
    }

    /// Counts the names and numbers in the expression.
    pub fn weight(&self) -> usize {
        let factors = self.over.iter().chain(&self.under);
        let inner: usize = factors.map(|(atom, _)| atom.weight()).sum();
        inner + usize::from(!self.coefficient.abs().is_one() || inner == 0)
    }

    /// Returns all names, in order of appearance.
    pub fn names(&self) -> Vec<&str> {
        let factors = self.over.iter().chain(&self.under);
        factors.flat_map(|(atom, _)| atom.names()).collect()
    }
}

impl Atom {
    fn weight(&self) -> usize {
        match self {
            Atom::Name(_) => 1,
            Atom::Sum(terms) => terms.iter().map(Term::weight).sum(),
            Atom::Call(_, arguments) | Atom::External { arguments, .. } => {
                1 + arguments.iter().map(Term::weight).sum::<usize>()
            }
        }
    }

    fn names(&self) -> Vec<&str> {
        match self {
            Atom::Name(name) => vec![name],
            Atom::Sum(terms)
            | Atom::Call(_, terms)
            | Atom::External {
                arguments: terms, ..
            } => terms.iter().flat_map(Term::names).collect(),
        }
    }
}

/// Multiplies `into` by a power, after cancelling it against `against`, the other side of the fraction.
fn multiply(into: &mut Vec<(Atom, u32)>, against: &mut Vec<(Atom, u32)>, atom: &Atom, power: u32) {
    let mut left = power;
    if let Some(place) = against.iter().position(|(other, _)| other == atom) {
        let common = left.min(against[place].1);
        left -= common;
        against[place].1 -= common;
        if against[place].1 == 0 {
            against.remove(place);
        }
    }
    if left == 0 {
        return;
    }
    match into.iter_mut().find(|(other, _)| other == atom) {
        Some((_, known)) => *known += left,
        None => into.push((atom.clone(), left)),
    }
}

fn positive_first(terms: &mut Vec<Term>) {
    if let Some(place) = terms.iter().position(|term| !term.is_negative())
        && place > 0
    {
        let first = terms.remove(place);
        terms.insert(0, first);
    }
}
