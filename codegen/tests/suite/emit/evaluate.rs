//! Evaluates generated text directly; the parts of a split function are run in order.

use std::collections::HashMap;
use syn::{BinOp, Expr, Lit, Pat, Stmt, UnOp};

/// Names and array entries with their values; an entry that was not written has none.
#[derive(Debug, Default)]
pub struct Values {
    names: HashMap<String, f64>,
    entries: HashMap<String, f64>,
}

impl Values {
    /// Sets the entries of an array.
    pub fn array(&mut self, name: &str, values: &[f64]) {
        for (index, &value) in values.iter().enumerate() {
            self.entries.insert(format!("{name}[{index}]"), value);
        }
    }

    /// Returns the values of a vector, or of a matrix by rows; entries that were not written are zero.
    pub fn of(&self, name: &str, rows: usize, columns: usize) -> Vec<f64> {
        let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let names = places.map(|(row, column)| match rows {
            1 => format!("{name}[{column}]"),
            _ => format!("{name}[{row}][{column}]"),
        });
        names
            .map(|name| self.entries.get(&name).copied().unwrap_or(0.0))
            .collect()
    }

    /// Runs the methods of a function: its parts in order, then the function.
    pub fn run(&mut self, methods: &[&syn::ImplItemFn], name: &str) {
        let named = |wanted: &str| methods.iter().find(|method| method.sig.ident == wanted);
        for part in 1.. {
            let Some(method) = named(&format!("{name}_part{part}")) else {
                break;
            };
            self.block(&method.block);
        }
        self.block(&named(name).expect("the function").block);
    }

    fn block(&mut self, block: &syn::Block) {
        self.names.clear();
        for statement in &block.stmts {
            match statement {
                Stmt::Local(local) => {
                    let value = &local.init.as_ref().expect("a value").expr;
                    self.bind(&local.pat, value);
                }
                Stmt::Expr(Expr::Assign(assign), _) => self.assign(&assign.left, &assign.right),
                Stmt::Expr(Expr::Array(list), None) => {
                    let values: Vec<f64> = list.elems.iter().map(|e| self.value(e)).collect();
                    self.array("out", &values);
                }
                // Guards, calls of parts, and the result variable.
                Stmt::Expr(..) => {}
                _ => panic!("no such statement is generated"),
            }
        }
    }

    fn bind(&mut self, pattern: &Pat, value: &Expr) {
        match (pattern, value) {
            // Arrays of zeros, and `k`: their entries are stored under the array's name.
            (Pat::Ident(_), Expr::Repeat(_) | Expr::Reference(_)) => {}
            (Pat::Ident(name), value) => {
                let value = self.value(value);
                self.names.insert(name.ident.to_string(), value);
            }
            (Pat::Tuple(pair), Expr::MethodCall(call)) if call.method == "sin_cos" => {
                let (sin, cos) = self.value(&call.receiver).sin_cos();
                for (name, value) in pair.elems.iter().zip([sin, cos]) {
                    if let Pat::Ident(name) = name {
                        self.names.insert(name.ident.to_string(), value);
                    }
                }
            }
            _ => panic!("no such binding is generated"),
        }
    }

    fn assign(&mut self, place: &Expr, value: &Expr) {
        let place = place_of(place);
        let value = self.value(value);
        self.entries.insert(place, value);
    }

    fn value(&self, expression: &Expr) -> f64 {
        match expression {
            Expr::Paren(inner) => self.value(&inner.expr),
            Expr::Unary(inner) if matches!(inner.op, UnOp::Neg(_)) => -self.value(&inner.expr),
            Expr::Path(_) => *self.names.get(&place_of(expression)).expect("a name"),
            Expr::Index(_) => {
                let place = place_of(expression);
                *self.entries.get(&place).expect(&place)
            }
            Expr::Binary(both) => {
                let [a, b] = [&both.left, &both.right].map(|side| self.value(side));
                match both.op {
                    BinOp::Add(_) => a + b,
                    BinOp::Sub(_) => a - b,
                    BinOp::Mul(_) => a * b,
                    BinOp::Div(_) => a / b,
                    _ => panic!("no such operator is generated"),
                }
            }
            Expr::MethodCall(call) if call.method == "mul_add" => {
                let [b, c] = [0, 1].map(|argument| self.value(&call.args[argument]));
                self.value(&call.receiver).mul_add(b, c)
            }
            Expr::Call(call) => call.args.first().map_or(0.0, number),
            _ => panic!("no such expression in the samples"),
        }
    }
}

/// Parses the number in `S::from_f64`.
fn number(expression: &Expr) -> f64 {
    match expression {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Float(number) => number.base10_parse().expect("a number"),
            _ => panic!("a number of another type"),
        },
        Expr::Unary(inner) => -number(&inner.expr),
        _ => std::f64::consts::PI,
    }
}

/// Returns the text of a place such as `slots[3]`.
fn place_of(expression: &Expr) -> String {
    match expression {
        Expr::Path(path) => path.path.get_ident().expect("a name").to_string(),
        Expr::Index(index) => {
            let Expr::Lit(at) = &*index.index else {
                panic!("an index")
            };
            let Lit::Int(at) = &at.lit else {
                panic!("an index")
            };
            format!("{}[{at}]", place_of(&index.expr))
        }
        Expr::Field(field) => match &field.member {
            syn::Member::Named(name) => name.to_string(),
            syn::Member::Unnamed(_) => panic!("fields have names"),
        },
        _ => panic!("no such place is generated"),
    }
}
