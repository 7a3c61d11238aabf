//! The trace of emitted code says what the statements compute, and why.

use crate::derived::{Derived, models};
use hamel_codegen::algebra::graph::{Edge, Function};
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::algebra::residue_pair::Random;
use hamel_codegen::emit::names::ProgramNames;
use hamel_codegen::emit::trace::AnnotatedStatement;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::model::states::states;
use hamel_codegen::program::Program;
use hamel_codegen::program::places::Places;
use hamel_codegen::program::schedule::Schedule;
use hamel_codegen::syntax::ast::ShapeKind;
use rayon::prelude::*;
use std::collections::{BTreeSet, HashMap};

/// Statements of each model that are compared.
const COMPARED: usize = 10;

/// Largest difference of the two evaluations, relative to the largest value of the function.
const TOLERANCE: f64 = 1e-9;

/// Values of arguments, parameters, constants and statements, by name.
type Known = HashMap<String, f64>;

/// Returns the values of everything that statements read, given those of the symbols.
fn arguments(program: &Program, symbols: &[f64]) -> Known {
    let [params, x, xi, u, z, xi_dot, momenta, _] = program.symbols();
    let raised = Function::ALL.iter();
    let mut raised = raised.filter(|function| function.name() == "(1 + ε) ");
    let raised = raised
        .next()
        .map_or(f64::NAN, |function| (function.row().value)(1.0));
    let mut known = Known::from([
        ("pi".into(), std::f64::consts::PI),
        ("ε".into(), raised - 1.0),
    ]);
    let lists = [
        ("x", x, program.nu),
        ("xi", xi, program.n),
        ("u", u, program.m),
        ("xi_dot", xi_dot, program.n),
        ("momentum", momenta, program.n),
    ];
    for (name, first, length) in lists {
        let entries = (0..length).map(|i| (format!("{name}[{i}]"), symbols[first + i]));
        known.extend(entries);
    }
    let states = (0..program.n_z).map(|i| (format!("xi[{}]", program.n + i), symbols[z + i]));
    known.extend(states);
    let names = ProgramNames::new(program);
    let mut next = params;
    for (group, field) in program.params.iter().zip(&names.fields) {
        let matrix = |n: usize, first: fn(usize) -> usize| -> Vec<String> {
            let rows = (0..n).flat_map(|i| (first(i)..n).map(move |j| format!("[{i}][{j}]")));
            rows.collect()
        };
        let indices = match group.shape {
            ShapeKind::Scalar => vec![String::new()],
            ShapeKind::Vector(n) => (0..n).map(|i| format!("[{i}]")).collect(),
            ShapeKind::Matrix(n) => matrix(n, |_| 0),
            ShapeKind::Symmetric(n) => matrix(n, |i| i),
        };
        for index in indices {
            known.insert(format!("self.{field}{index}"), symbols[next]);
            next += 1;
        }
    }
    let kept = Places::new(program, &Schedule::of(program).kept).kept();
    let values = evaluate(&program.graph, &kept, symbols).into_iter();
    known.extend(
        values
            .enumerate()
            .map(|(i, value)| (format!("k[{i}]"), value)),
    );
    known
}

/// Reads the expressions of a trace.
struct Reader<'a> {
    text: &'a str,
    known: &'a Known,
}

impl Reader<'_> {
    fn take(&mut self, word: &str) -> bool {
        let rest = self.text.trim_start();
        let found = rest.strip_prefix(word);
        self.text = found.unwrap_or(rest);
        found.is_some()
    }

    fn expect(&mut self, word: &str) {
        assert!(self.take(word), "`{word}` expected before `{}`", self.text);
    }

    fn sum(&mut self) -> f64 {
        let mut sum = self.product();
        loop {
            if self.take("+") {
                sum += self.product();
            } else if self.take("-") {
                sum -= self.product();
            } else {
                return sum;
            }
        }
    }

    fn product(&mut self) -> f64 {
        let mut product = self.factor();
        loop {
            if self.take("*") {
                product *= self.factor();
            } else if self.take("/") {
                product /= self.factor();
            } else {
                return product;
            }
        }
    }

    fn factor(&mut self) -> f64 {
        if self.take("-") {
            return -self.factor();
        }
        if self.take("(") {
            let value = self.sum();
            self.expect(")");
            return value;
        }
        if self.take("if ") {
            let c = self.sum();
            self.expect("> 0 {");
            let a = self.sum();
            self.expect("} else {");
            let b = self.sum();
            self.expect("}");
            return if c > 0.0 { a } else { b };
        }
        let part = |c: char| c.is_alphanumeric() || "_.[]'".contains(c);
        let end = self.text.find(|c| !part(c)).unwrap_or(self.text.len());
        let (word, rest) = self.text.split_at(end);
        self.text = rest;
        if !self.take("(") {
            let number = || {
                word.parse()
                    .unwrap_or_else(|_| panic!("`{word}` is unknown"))
            };
            return self.known.get(word).copied().unwrap_or_else(number);
        }
        let a = self.sum();
        let value = match word {
            "atan2" => {
                self.expect(",");
                a.atan2(self.sum())
            }
            _ => {
                let mut all = Function::ALL.iter();
                let function = all.find(|function| function.name() == word);
                let function = function.unwrap_or_else(|| panic!("no function `{word}`"));
                (function.row().value)(a)
            }
        };
        self.expect(")");
        value
    }
}

fn read(text: &str, known: &Known) -> f64 {
    let mut reader = Reader { text, known };
    let value = reader.sum();
    assert!(
        reader.text.is_empty(),
        "`{}` remains of `{text}`",
        reader.text
    );
    value
}

/// Compares some statements with the nodes that they stand for, each statement read in the names of the others.
fn compare(name: &str, generated: &Generated) {
    let program = &generated.program;
    let mut random = Random::new(7);
    let traces = generated.trace();
    let places: Vec<(usize, usize)> = (traces.iter().enumerate())
        .flat_map(|(function, trace)| {
            let statements = trace.statements.iter().enumerate();
            let whole = statements.filter(|(_, traced)| traced.node.is_some());
            whole.map(move |(place, _)| (function, place))
        })
        .collect();
    if places.is_empty() {
        return;
    }
    let symbols = states(&generated.active).swap_remove(0);
    for _ in 0..COMPARED {
        let chosen = random.bits() as usize % places.len();
        let (function, place) = places[chosen];
        let mut known = arguments(program, &symbols);
        let statements = &traces[function].statements[..=place];
        let mut scale: f64 = 1.0;
        let mut value = f64::NAN;
        for traced in statements.iter().filter(|traced| !traced.name.is_empty()) {
            value = read(&traced.expression, &known);
            scale = scale.max(value.abs());
            known.insert(traced.name.clone(), value);
        }
        let Some(AnnotatedStatement {
            name: statement,
            node: Some(node),
            ..
        }) = statements.last()
        else {
            panic!("the statement has a node");
        };
        let wanted = evaluate(&program.graph, &[Edge::of(*node)], &symbols)[0];
        let difference = (value - wanted).abs();
        assert!(
            difference <= TOLERANCE * scale || value.is_nan() && wanted.is_nan(),
            "{name}: {statement} of {} is {value}, its expression {wanted}",
            traces[function].function
        );
    }
}

/// Statements without external functions, which have no values here.
#[test]
fn expressions_are_those_of_the_statements() {
    models().par_iter().for_each(|model| {
        let generated = model.generated();
        if generated.program.graph.externals().is_empty() {
            compare(&model.name, generated);
        }
    });
}

#[test]
fn every_statement_serves_a_quantity_of_the_description() {
    let described = |name: &str, generated: &Generated| {
        let mut places = hamel_codegen::trace::Places::of(generated, &generated.text);
        let lines = generated.text.lines().count();
        for trace in generated.trace() {
            for traced in &trace.statements {
                let place = places.place(traced).unwrap_or_else(|| {
                    panic!("{name}: {traced:?} of {} has no place", trace.function)
                });
                assert!((1..=lines).contains(&place.line), "{name}: {place:?}");
                let origin = traced.origin.as_ref().expect("an origin");
                assert!(!origin.quantity.is_empty() && !origin.equation.is_empty());
            }
        }
    };
    models()
        .par_iter()
        .for_each(|model| described(&model.name, model.generated()));
    let ur5 = include_str!("../../../examples/gallery/ur5.eom");
    described("ur5", &from_text(ur5).expect("correct"));
}

/// Returns the quantities that the statements of a function serve.
fn quantities(generated: &Generated, function: &str) -> BTreeSet<String> {
    let traces = generated.trace().into_iter();
    let traces = traces.filter(|trace| trace.function == function);
    let statements = traces.flat_map(|trace| trace.statements);
    let origins = statements.filter_map(|traced| traced.origin);
    origins.map(|origin| origin.quantity.clone()).collect()
}

#[test]
fn particles_and_linearisations_have_quantities_of_their_own() {
    let is_of_particle = |model: &Derived| {
        let functions = model.generated().trace().into_iter();
        let mut functions = functions.map(|trace| quantities(model.generated(), &trace.function));
        functions.any(|all| all.iter().any(|quantity| quantity.starts_with("particle ")))
    };
    assert!(models().par_iter().any(is_of_particle));
    let ur5 = include_str!("../../../examples/gallery/ur5.eom");
    let (body, _) = ur5.rsplit_once('}').expect("a description");
    let ur5 = from_text(&format!("{body}generate linearize;\n}}")).expect("correct");
    let of = |function: &str| quantities(&ur5, function).into_iter();
    assert!(of("accel_and_linearize").any(|quantity| quantity.ends_with("derivatives of ξ̇")));
    assert!(
        of("accel_and_linearize")
            .any(|quantity| quantity.ends_with("change of the wrench through the joint"))
    );
}
