//! Shapes of calls of functions of the description, of external functions in Rust, and of tables.

use super::infer::Inference;
use super::shape::{Shape, Shaped};
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{self, Expr, External, Function, Ident, ShapeKind, Span};
use std::collections::BTreeMap;

impl<'a> Inference<'a> {
    /// Returns the shape of a call of a function of the description. An error in the function's body is reported there,
    /// with a note at the call.
    pub fn applied(
        &mut self,
        function: &'a Function,
        arguments: &'a [Expr],
        span: Span,
    ) -> Option<Shaped> {
        let parameters = function.parameters.iter();
        let names: Vec<&'a Ident> = parameters.map(|(name, _)| name).collect();
        let values = self.counted(&function.name, &names, arguments, span, "defined here")?;
        let parameters = function.parameters.iter().zip(arguments);
        for (((parameter, shape), argument), value) in parameters.zip(&values) {
            if !fits(shape, value.shape) {
                let (what, found) = (shape.kind.describe(), value.shape.describe());
                let message = format!(
                    "`{}` of `{}` has to be {what}, but this is {found}",
                    parameter.name, function.name.name
                );
                return self.error(
                    Diagnostic::new(argument.span, message)
                        .help("make the shapes agree")
                        .note(shape.span, "declared here"),
                );
            }
        }
        self.written_out(&function.name, &names, &function.value, values, span)
    }

    /// Returns the shapes of the arguments of a call. Reports an error unless there are as many as parameters.
    fn counted(
        &mut self,
        name: &Ident,
        parameters: &[&Ident],
        arguments: &'a [Expr],
        span: Span,
        note: &str,
    ) -> Option<Vec<Shaped>> {
        let values = self.all(arguments);
        let (wanted, given) = (parameters.len(), arguments.len());
        if wanted == given {
            return values;
        }
        let plural = if wanted == 1 { "" } else { "s" };
        let message = format!(
            "`{}` takes {wanted} argument{plural}, not {given}",
            name.name
        );
        let parameters: Vec<&str> = parameters.iter().map(|name| name.name.as_str()).collect();
        let usage = format!("write `{}({})`", name.name, parameters.join(", "));
        let error = Diagnostic::new(span, message).help(usage);
        self.error(error.note(name.span, note))
    }

    /// Returns the shape of a function's body for arguments of these shapes. Each combination is inferred only once.
    fn written_out(
        &mut self,
        name: &'a Ident,
        parameters: &[&'a Ident],
        value: &'a Expr,
        arguments: Vec<Shaped>,
        span: Span,
    ) -> Option<Shaped> {
        let call = (name.name.as_str(), arguments);
        if let Some(known) = self.called.get(&call) {
            return known.clone();
        }
        let names = parameters.iter().map(|name| name.name.as_str());
        let locals: BTreeMap<&'a str, Shaped> = names.zip(call.1.iter().cloned()).collect();
        let outer = std::mem::replace(&mut self.locals, locals);
        let report = std::mem::replace(&mut self.report, Report::new());
        let found = self.of(value);
        self.locals = outer;
        let inner = std::mem::replace(&mut self.report, report);
        for error in inner.finish().err().unwrap_or_default() {
            self.report.push_once(error.in_call(span));
        }
        self.called.insert(call, found.clone());
        found
    }

    /// Returns the shape of the result of a function in Rust: a scalar, or a vector if it has several components.
    pub fn external(
        &mut self,
        function: &'a External,
        arguments: &'a [Expr],
        span: Span,
    ) -> Option<Shaped> {
        let names: Vec<&'a Ident> = function.parameters.iter().collect();
        let values = self.counted(&function.name, &names, arguments, span, "declared here")?;
        for (value, argument) in values.iter().zip(arguments) {
            if value.shape != Shape::Scalar {
                let what = "an argument of a function in Rust";
                return self.wrong(argument.span, what, "a scalar", value.shape);
            }
        }
        let (count, place) = function.components;
        let wanted = match count {
            0 | 1 => Shape::Scalar,
            _ => Shape::Vector(count),
        };
        let Some(value) = &function.stand_in else {
            return Some(Shaped::of(wanted));
        };
        let found = self.written_out(&function.name, &names, value, values, span)?;
        if found.shape != wanted {
            let message = format!(
                "the stand-in of `{}` has to be {}, but this is {}",
                function.name.name,
                wanted.describe(),
                found.shape.describe()
            );
            let error = Diagnostic::new(value.span, message).help("make the shapes agree");
            return self.error(error.note(place, "declared here"));
        }
        Some(match function.evaluated {
            true => found,
            false => Shaped::of(wanted),
        })
    }

    /// Returns the shape of the value of a table.
    pub fn table(&mut self, name: &str, arguments: &'a [Expr], span: Span) -> Option<Shaped> {
        let values = self.all(arguments);
        let [argument] = arguments else {
            let count = arguments.len();
            let message = format!("the table `{name}` takes 1 argument, not {count}");
            let error = Diagnostic::new(span, message);
            return self.error(error.help(format!("write `{name}(a)`")));
        };
        match values?.first()?.shape {
            Shape::Scalar => Some(Shaped::of(Shape::Scalar)),
            other => self.wrong(argument.span, "the argument of a table", "a scalar", other),
        }
    }
}

/// Returns whether a value fits the shape of a parameter. A parameter without a shape takes any value.
fn fits(shape: &ast::Shape, found: Shape) -> bool {
    shape.kind == ShapeKind::Scalar || Shape::declared(shape.kind) == found
}
