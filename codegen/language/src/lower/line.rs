//! The line between two points of frames, d = r₂ − r₁, with its length ℓ = |d| and forces along it.
//!
//! If d·d is a perfect square on X, such as for points on one straight line, ℓ is its root with the sign that makes
//! it positive at the start: smooth, and as in textbooks.

use super::reader::Reader;
use crate::algebra::graph::{Edge, Function, Graph, Node};
use crate::algebra::linear::{Vec3, add3, apply3, scale3, sub3, zero3};
use crate::algebra::numeric::evaluate;
use crate::diagnostics::Diagnostic;
use crate::model::Wrench;
use crate::syntax::ast::{Axes, End, Span};

/// Length (m) below which two points coincide at the start.
const COINCIDENT: f64 = 1e-12;

/// Two points of frames, with the words for them in messages.
pub struct Line<'a> {
    what: &'a str,
    span: Span,
    ends: (&'a End, &'a End),
    /// First point.
    pub from: Point,
    /// Second point.
    pub to: Point,
    /// Difference d.
    pub difference: Vec3,
    /// Square d·d.
    pub square: Edge,
}

/// A point of a frame.
#[derive(Clone, Copy)]
pub struct Point {
    /// Index of the frame; `None` for the world.
    frame: Option<usize>,
    /// Position in frame axes.
    at: Vec3,
    /// Position in the world.
    pub world: Vec3,
}

impl Reader<'_, '_> {
    /// Reads two points, and reports an error if their distance does not vary.
    pub fn line<'a>(
        &mut self,
        what: &'a str,
        span: Span,
        from: &'a End,
        to: &'a End,
    ) -> Option<Line<'a>> {
        let ends = (from, to);
        let (from, to) = (self.end(from), self.end(to));
        let (from, to) = (from?, to?);
        let graph = &mut *self.evaluator.graph;
        let difference = sub3(graph, to.world, from.world);
        let square = graph.dot(&difference, &difference);
        if self.rate(square)? != self.evaluator.graph.zero() {
            return Some(Line {
                what,
                span,
                ends,
                from,
                to,
                difference,
                square,
            });
        }
        let (first, second) = (&ends.0.frame, &ends.1.frame);
        let message = if first.name == second.name {
            let frame = &first.name;
            format!("this {what} does nothing: both its endpoints are fixed to `{frame}`")
        } else if square == self.evaluator.graph.zero() {
            format!(
                "this {what} does nothing: its endpoints always coincide, so it has no direction"
            )
        } else {
            format!("this {what} does nothing: the distance between its endpoints never changes")
        };
        self.evaluator.error(
            Diagnostic::new(first.span, message)
                .help("make it act between points of frames that move relative to one another")
                .note(second.span, "the other point"),
        )
    }

    /// Returns d/dt of an expression; `None` if the rates are in error.
    pub fn rate(&mut self, edge: Edge) -> Option<Edge> {
        let motion = self.evaluator.scope.motion.as_ref()?;
        let [rate] = motion.rates(self.evaluator.graph, [edge]);
        Some(rate)
    }

    fn end(&mut self, end: &End) -> Option<Point> {
        const WHAT: &str = "a point of a frame";
        let at = match &end.at {
            Some(expr) => self.constant_vec3(expr, WHAT),
            None => Some(zero3(self.evaluator.graph)),
        };
        if end.frame.name == "world" {
            return at.map(|at| Point {
                frame: None,
                at,
                world: at,
            });
        }
        let index = self.frame(&end.frame);
        let (index, at) = (index?, at?);
        let frame = &self.frames[index];
        let arm = apply3(self.evaluator.graph, &frame.rotation, at);
        let world = add3(self.evaluator.graph, frame.position, arm);
        Some(Point {
            frame: Some(index),
            at,
            world,
        })
    }

    /// Returns ℓ, positive at the start. It contains the square root of a varying expression only if that cannot be
    /// avoided.
    pub fn length(&mut self, line: &Line, start: &[f64]) -> Option<Edge> {
        let length = match self.smooth_length(line) {
            Some(length) => length,
            None => self.evaluator.graph.apply(Function::Sqrt, line.square),
        };
        let now = self.apart_at_start(line, length, start)?;
        Some(length.signed(now < 0.0))
    }

    /// Returns ±ℓ without the square root of a varying expression, if d·d is the square of a known expression or d
    /// has a fixed direction.
    pub fn smooth_length(&mut self, line: &Line) -> Option<Edge> {
        let graph = &mut *self.evaluator.graph;
        if let Some(known) = graph.known_root(line.square) {
            return Some(known);
        }
        let d = line.difference;
        let first = *d.iter().find(|entry| **entry != graph.zero())?;
        let ratios = d.map(|entry| graph.div(entry, first).unwrap_or(graph.zero()));
        let motion = self.evaluator.scope.motion.as_ref()?;
        let graph = &mut *self.evaluator.graph;
        if motion.rates(graph, ratios) != zero3(graph) {
            return None;
        }
        let square = graph.dot(&ratios, &ratios);
        let factor = graph.apply(Function::Sqrt, square);
        Some(graph.mul(first, factor))
    }

    /// Returns a measure of the distance at the start, NaN if it is unknown; reports an error if it is 0.
    pub fn apart_at_start(&mut self, line: &Line, measure: Edge, start: &[f64]) -> Option<f64> {
        let now = evaluate(self.evaluator.graph, &[measure], start)
            .first()
            .copied()
            .unwrap_or(f64::NAN);
        if now.is_nan() || now.abs() > COINCIDENT {
            return Some(now);
        }
        let what = line.what;
        let message = format!(
            "the endpoints of this {what} coincide at the start, so it has no direction there"
        );
        let help = match what {
            "spring" => "start elsewhere, or leave out its `length`",
            _ => "start elsewhere, or choose other points",
        };
        self.evaluator.error(
            Diagnostic::new(line.span, message)
                .help(help)
                .note(line.ends.0.frame.span, "from here")
                .note(line.ends.1.frame.span, "to here"),
        )
    }

    /// Returns the wrenches of a force on the second point and of its reaction on the first.
    pub fn pair(&mut self, line: &Line, force: Vec3) -> Vec<Wrench> {
        let zero = zero3(self.evaluator.graph);
        let opposite = force.map(|entry| -entry);
        [(line.to, force), (line.from, opposite)]
            .into_iter()
            .filter_map(|(point, force)| {
                Some(Wrench {
                    frame: point.frame?,
                    at: point.at,
                    force,
                    torque: zero,
                    axes: Axes::World,
                })
            })
            .collect()
    }

    /// Returns the wrenches of a force along the line; a positive force pushes the points apart.
    pub fn along_line(&mut self, line: &Line, length: Edge, force: Edge) -> Option<Vec<Wrench>> {
        let graph = &mut *self.evaluator.graph;
        let force = if is_root(graph, length) {
            let factor = graph.div(force, length)?;
            scale3(graph, factor, line.difference)
        } else {
            let mut direction = [graph.zero(); 3];
            for (unit, d) in direction.iter_mut().zip(line.difference) {
                *unit = graph.div(d, length)?;
            }
            scale3(graph, force, direction)
        };
        Some(self.pair(line, force))
    }
}

/// Returns whether an expression is a square root as it stands.
pub fn is_root(graph: &Graph, edge: Edge) -> bool {
    matches!(graph.node(edge.node()), Node::Apply(Function::Sqrt, _))
}
