//! Shapes of motions of frames and their points, of components in the axes of frames, and of rates of expressions.

use super::infer::Inference;
use super::shape::{Shape, Shaped};
use crate::diagnostics::Diagnostic;
use crate::symbols::words::FUNCTIONS;
use crate::syntax::ast::{Expr, ExprKind, Span};

impl<'a> Inference<'a> {
    /// Returns the shape of a call of one of the [`FUNCTIONS`], such as `velocity`. Arguments are a frame, optionally a
    /// point of it, and optionally a frame of reference.
    pub fn motion(&mut self, name: &str, found: &[Shaped], span: Span) -> Option<Shaped> {
        use Shape::{Pose, Vector};
        let shapes: Vec<Shape> = found.iter().map(|one| one.shape).collect();
        let angular = name.starts_with("angular");
        match (angular, shapes.as_slice()) {
            (_, [Pose] | [Pose, Pose]) | (false, [Pose, Vector(3)] | [Pose, Vector(3), Pose]) => {
                return Some(Shaped::of(Vector(3)));
            }
            _ => {}
        }
        let help = match angular {
            true => {
                format!("write `{name}(f)` of a frame, or `{name}(f, g)` as the frame g sees it")
            }
            false => format!(
                "write `{name}(f)` or `{name}(f, p)` of a frame and a point in its axes, or `{name}(f, p, g)` as the frame g sees it"
            ),
        };
        let message = format!("`{name}` takes a frame, a point of it, and an observing frame");
        self.error(Diagnostic::new(span, message).help(help))
    }

    /// Returns the shape of `velocity(f, p) in g`: the components of a motion in the axes of a frame. `in body` means
    /// the axes of f itself.
    pub fn in_axes(&mut self, call: &'a Expr, frame: &'a Expr) -> Option<Shaped> {
        let own = &self.symbols.functions;
        let moves = matches!(&call.kind, ExprKind::Call(function, _) if FUNCTIONS.contains(&function.name.as_str())
            && !own.contains_key(function.name.as_str()));
        if !moves {
            let error = Diagnostic::new(
                call.span,
                "only the motion of a frame can be written in axes",
            );
            return self.error(error.help(
                "write `velocity(f, p) in g` or the like; a vector v with components in world axes is `g.R.T * v` in those of g",
            ));
        }
        let value = self.of(call);
        if !matches!(&frame.kind, ExprKind::Name(name) if name == "body") {
            let axes = self.of(frame)?.shape;
            if axes != Shape::Pose {
                let message = format!("this is {}, which has no axes", axes.describe());
                return self
                    .error(Diagnostic::new(frame.span, message).help(
                        "write the name of a frame, `world`, or `body` for the frame itself",
                    ));
            }
        }
        value
    }

    /// Returns the shape of `rate(…)`: that of its argument, or a scalar (the angular rate) for an S1 coordinate.
    pub fn rate(&mut self, arguments: &'a [Expr], span: Span) -> Option<Shaped> {
        let [argument] = arguments else {
            let message = format!("`rate` takes one expression, not {}", arguments.len());
            return self.error(
                Diagnostic::new(span, message)
                    .help("write `rate(q)` of a coordinate, or `rate(e)` of an expression"),
            );
        };
        let shape = self.of(argument)?.shape;
        if shape == Shape::Pose {
            return self.error(
                Diagnostic::new(argument.span, "the rate of a pose is not a pose")
                    .help("take its parts: `rate(X.p)` and `rate(X.R)`"),
            );
        }
        Some(Shaped::of(match self.is_circle(argument) {
            true => Shape::Scalar,
            false => shape,
        }))
    }
}
