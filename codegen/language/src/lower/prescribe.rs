//! Reads prescribed motion: `prescribe q = f(t);` for a coordinate, `prescribe v = w(t);` for a velocity, and
//! `prescribe rate(v) = a;` for the rate of a velocity.
//!
//! A prescribed coordinate has the rate ḟ, which is the row A_q ξ − ḟ ξ⁰ = 0; a prescribed velocity is the row
//! v − w ξ⁰ = 0. Their multipliers are the forces of the drives. If a rate is prescribed, the velocity remains part
//! of the state, and inverse dynamics replaces forward dynamics for it (Featherstone 2008, 9.2); the rate may be an
//! input, or any expression of the state.

use super::configuration_manifold::{ConfigurationManifold, Origin};
use super::declare::Declared;
use super::expression::Evaluator;
use super::rate::{Kinematics, entry, part};
use super::scope::Scope;
use super::time;
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Function, Graph, Node};
use crate::diagnostics::{Diagnostic, Report};
use crate::model::pfaffian::{Kind, Pfaffian};
use crate::model::value::Value;
use crate::model::{Coordinate, class};
use crate::syntax::ast::{CoordKind, Expr, ItemKind, Span, System, Target};
use crate::syntax::written::{target as written, written as shown};

/// The rows, the coordinates with prescribed values, and the velocities with prescribed rates.
type Prescribed = (Vec<Pfaffian>, Vec<(usize, Edge)>, Vec<(usize, Edge)>);

/// Reads all `prescribe` statements, in the order of the text.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    manifold: &ConfigurationManifold,
    kinematics: Option<&Kinematics>,
    report: &mut Report,
) -> Prescribed {
    let mut all = (Vec::new(), Vec::new(), Vec::new());
    let mut targets: Vec<&Target> = Vec::new();
    for item in &system.items {
        let ItemKind::Prescribe {
            target,
            rate,
            value,
        } = &item.kind
        else {
            continue;
        };
        let first = targets.iter().find(|other| other.overlaps(target));
        if let Some(first) = first {
            let message = format!("the motion of `{}` is prescribed twice", written(target));
            let error = Diagnostic::new(target.span(), message).help("remove one of the two");
            report.push(error.note(first.span(), "first prescribed here"));
            continue;
        }
        targets.push(target);
        let mut reader = Reader {
            system,
            evaluator: Evaluator::new(graph, scope, report),
            declared,
            manifold,
            kinematics,
        };
        match rate {
            true => reader.rate(target, value, &mut all),
            false => reader.motion(target, value, &mut all),
        };
    }
    all
}

struct Reader<'a> {
    system: &'a System,
    evaluator: Evaluator<'a>,
    declared: &'a Declared,
    manifold: &'a ConfigurationManifold,
    kinematics: Option<&'a Kinematics>,
}

impl Reader<'_> {
    /// Reads the prescribed rate of a velocity.
    fn rate(&mut self, target: &Target, expr: &Expr, all: &mut Prescribed) -> Option<()> {
        let value = self.evaluator.value(expr);
        let name = &target.name.name;
        let velocity = self.declared.velocities.iter().find(|g| g.name == *name);
        let group = velocity.filter(|_| target.field.is_none())?;
        let value = value?;
        let range = group.offset..group.offset + group.len;
        let (range, wanted) = entry(target, range, group.value.clone());
        if !value.same_shape(&wanted) {
            return self.evaluator.miss();
        }
        let graph = &*self.evaluator.graph;
        let entries = value.entries();
        let class = entries
            .iter()
            .fold(0, |class, e| class | graph.class(e.node()));
        if class & class::ACCEL != 0 {
            let message = format!("the rate of `{name}` depends on rates of velocities");
            return self.evaluator.error(
                Diagnostic::new(expr.span, message)
                    .help("it is a function of coordinates, velocities, states, time and inputs"),
            );
        }
        all.2.extend(
            entries
                .into_iter()
                .enumerate()
                .map(|(i, e)| (range.start + i, e)),
        );
        Some(())
    }

    /// Reads the prescribed value of a coordinate or of a velocity.
    fn motion(&mut self, target: &Target, expr: &Expr, all: &mut Prescribed) -> Option<()> {
        let value = self.evaluator.value(expr);
        let name = &target.name.name;
        let velocity = self.declared.velocities.iter().find(|g| g.name == *name);
        let (place, wanted, coordinate) = match velocity {
            Some(group) if target.field.is_none() => {
                let range = group.offset..group.offset + group.len;
                let (range, wanted) = entry(target, range, group.value.clone());
                (range.start, wanted, None)
            }
            _ => {
                let (range, wanted) = part(target, self.declared)?;
                let mut coordinates = self.declared.coordinates.iter();
                let coordinate = coordinates.find(|c| c.name == *name)?;
                (range.start, wanted, Some(coordinate))
            }
        };
        let value = value?;
        if time::name(self.system).is_none() {
            let error = Diagnostic::new(target.span(), "a prescribed motion is a function of time");
            return self.evaluator.error(error.help(
                "declare the time, `time t;`; the motion may depend on it and on parameters",
            ));
        }
        let clock = self.declared.clock?;
        if coordinate.is_some_and(|c| c.offset == clock.x)
            || velocity.is_some_and(|g| g.offset == clock.xi)
        {
            let error = Diagnostic::new(target.span(), "the time cannot be prescribed");
            return self
                .evaluator
                .error(error.help("prescribe a coordinate or a velocity"));
        }
        let angle = coordinate.is_some_and(|c| c.kind == CoordKind::S1) && target.field.is_none();
        let fits = match (angle, &value) {
            (true, value) => matches!(value, Value::Scalar(_)),
            (false, value) => value.same_shape(&wanted),
        };
        if let Some(coordinate) = coordinate {
            self.can_be_given(target, coordinate)?;
        }
        if !fits {
            return self.evaluator.miss();
        }
        self.known_ahead(name, expr.span, &value)?;
        self.evaluator
            .continuous(&value, expr.span, "a prescribed motion")?;
        match coordinate {
            None => self.velocity(place, &value, expr, target, all),
            Some(coordinate) => self.coordinate(place, coordinate, &value, expr, target, all),
        }
    }

    /// Checks that a coordinate is real or an angle: only these have values that an expression gives without
    /// redundancy.
    fn can_be_given(&mut self, target: &Target, coordinate: &Coordinate) -> Option<()> {
        let error = Diagnostic::new(
            target.span(),
            format!("the value of `{}` cannot be prescribed", written(target)),
        );
        let plain = matches!(
            coordinate.kind,
            CoordKind::Real | CoordKind::Euclidean(_) | CoordKind::S1
        );
        let of_angle = coordinate.kind == CoordKind::S1 && !target.entry.is_empty();
        if !plain || of_angle || target.field.is_some() {
            return self.evaluator.error(
                error.help("prescribe its velocity, or make the pose of a frame depend on time"),
            );
        }
        let mut statements = (self.manifold.origins.iter().zip(&self.manifold.phi)).filter_map(
            |(origin, (row, _))| match origin {
                Origin::Statement(item) => Some((*item, *row)),
                Origin::Coordinate(_) => None,
            },
        );
        let free = &self.manifold.points.free;
        let first = self.manifold.points.first;
        let (given, _) = part(target, self.declared)?;
        let given = first + given.start..first + given.end;
        let tied = statements.find(|(_, row)| {
            let reached = free.reachable(&[*row]);
            reached
                .iter()
                .any(|&id| matches!(free.node(id), Node::Symbol(index) if given.contains(&(index as usize))))
        });
        match tied {
            Some((item, _)) => {
                let span = self.system.items[item].span;
                self.evaluator.error(
                    error
                        .help("write the constraint as a `loop`, or prescribe a velocity")
                        .note(span, "this constraint ties it to others"),
                )
            }
            None => Some(()),
        }
    }

    /// Checks that a prescribed value depends on time and parameters alone.
    fn known_ahead(&mut self, name: &str, span: Span, value: &Value) -> Option<()> {
        let graph = &*self.evaluator.graph;
        let clock = self.declared.clock?;
        let time = self.declared.x[clock.x].node();
        let symbols = graph.reachable(&value.entries()).into_iter();
        let symbols = symbols.filter(|&id| matches!(graph.node(id), Node::Symbol(_)) && id != time);
        let found = symbols.fold(0, |found, id| found | graph.class(id)) & !class::PARAM;
        let help = match found {
            0 => return Some(()),
            class::INPUT => {
                "an input or a state can give the rate of a velocity: `prescribe rate(v) = a;`, and the velocity has a `start`"
            }
            _ => {
                "make it a function of time and parameters; write what depends on the motion as a force or a constraint"
            }
        };
        let message = format!("the motion of `{name}` has to be known in advance");
        self.evaluator
            .error(Diagnostic::new(span, message).help(help))
    }

    fn velocity(
        &mut self,
        place: usize,
        value: &Value,
        expr: &Expr,
        target: &Target,
        all: &mut Prescribed,
    ) -> Option<()> {
        let clock = self.declared.clock?;
        let graph = &mut *self.evaluator.graph;
        for (i, given) in value.entries().into_iter().enumerate() {
            let mut row = vec![graph.zero(); self.declared.xi.len()];
            row[place + i] = graph.one();
            row[clock.xi] = -given;
            all.0.push(driven(graph, row, None, target, expr));
        }
        Some(())
    }

    fn coordinate(
        &mut self,
        place: usize,
        coordinate: &Coordinate,
        value: &Value,
        expr: &Expr,
        target: &Target,
        all: &mut Prescribed,
    ) -> Option<()> {
        let clock = self.declared.clock?;
        let a = &self.kinematics?.a;
        let n = self.declared.xi.len();
        let x = &self.declared.x;
        let graph = &mut *self.evaluator.graph;
        let one = graph.one();
        let mut along = Derivation::new([(x[clock.x].node(), one)]);
        for (i, given) in value.entries().into_iter().enumerate() {
            let (mut row, residual): (Vec<Edge>, Edge) = match coordinate.kind {
                CoordKind::S1 => {
                    let (c, s) = (x[place], x[place + 1]);
                    let cos = graph.apply(Function::Cos, given);
                    let sin = graph.apply(Function::Sin, given);
                    all.1.extend([(place, cos), (place + 1, sin)]);
                    let row = (0..n).map(|j| {
                        let (turned, back) =
                            (graph.mul(c, a[place + 1][j]), graph.mul(s, a[place][j]));
                        graph.sub(turned, back)
                    });
                    let row = row.collect();
                    let (ahead, behind) = (graph.mul(s, cos), graph.mul(c, sin));
                    (row, graph.sub(ahead, behind))
                }
                _ => {
                    all.1.push((place + i, given));
                    (a[place + i].clone(), graph.sub(x[place + i], given))
                }
            };
            let rate = along.of(graph, given);
            row[clock.xi] = graph.sub(row[clock.xi], rate);
            all.0.push(driven(graph, row, Some(residual), target, expr));
        }
        Some(())
    }
}

/// Returns the row of a drive, with residual φ if a coordinate is driven.
fn driven(
    graph: &Graph,
    row: Vec<Edge>,
    residual: Option<Edge>,
    target: &Target,
    expr: &Expr,
) -> Pfaffian {
    Pfaffian {
        kind: Kind::Drive {
            position: residual.is_some(),
        },
        row,
        shift: graph.zero(),
        residual: residual.unwrap_or(graph.zero()),
        stabilized: None,
        written: format!("{} = {}", written(target), shown(expr)),
        entry: String::new(),
        redundant: false,
        span: target.span(),
    }
}
