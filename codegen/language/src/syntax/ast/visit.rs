//! Visitor for the names, expressions and source positions of a statement.

use super::{
    Acting, Body, Choice, Components, Condition, Conserved, Declaration, End, Expr, ExprKind,
    External, Function, Ident, Item, ItemKind, Joint, Load, Source, Span, Table, Target, Wanted,
};

use crate::units::Unit;

/// Operations on the parts of a statement.
pub trait Visit {
    /// Visits a name that the statement declares. `frame` says whether it is the name of a frame.
    fn declares(&mut self, name: &mut Ident, frame: bool);
    /// Visits a name that is declared elsewhere.
    fn uses(&mut self, name: &mut Ident);
    /// Visits a coordinate or velocity, or a part of one.
    fn target(&mut self, target: &mut Target);
    /// Visits an expression.
    fn expr(&mut self, expr: &mut Expr);
    /// Visits the span of anything that is neither a name nor an expression.
    fn place(&mut self, span: &mut Span);
}

/// Visits all parts of a statement in the order of the text. Statements that contain or expand into others are not
/// entered.
pub fn visit(item: &mut Item, to: &mut impl Visit) {
    let Item { kind, span } = item;
    to.place(span);
    match kind {
        ItemKind::Param(list)
        | ItemKind::Const(list)
        | ItemKind::Let(list)
        | ItemKind::Velocity(list)
        | ItemKind::Input(list)
        | ItemKind::State(list) => list.iter_mut().for_each(|one| declaration(one, to)),
        ItemKind::Function(Function {
            name,
            parameters,
            value,
        }) => {
            to.declares(name, false);
            for (name, shape) in parameters {
                to.place(&mut name.span);
                to.place(&mut shape.span);
            }
            to.expr(value);
        }
        ItemKind::External(External {
            name,
            parameters,
            components,
            stand_in,
            evaluated: _,
        }) => {
            to.declares(name, false);
            for name in parameters {
                to.place(&mut name.span);
            }
            to.place(&mut components.1);
            if let Some(value) = stand_in {
                to.expr(value);
            }
        }
        ItemKind::Table(Table {
            name,
            source,
            between: _,
            beyond: _,
        }) => {
            to.declares(name, false);
            match source {
                Source::Points(points, span) => {
                    to.place(span);
                    for (argument, value) in points {
                        to.expr(argument);
                        to.expr(value);
                    }
                }
                Source::File(_, span) => to.place(span),
            }
        }
        ItemKind::Coord(list) => list
            .iter_mut()
            .for_each(|(name, _, unit)| declared(name, unit, to)),
        ItemKind::Constraint { left, right } => [left, right].into_iter().for_each(|e| to.expr(e)),
        ItemKind::Rate { target, value }
        | ItemKind::Generalized { target, value }
        | ItemKind::Start { target, value }
        | ItemKind::Guess { target, value }
        | ItemKind::Prescribe {
            target,
            rate: _,
            value,
        } => {
            to.target(target);
            to.expr(value);
        }
        ItemKind::Time(name) => to.declares(name, false),
        ItemKind::Inactive(list) | ItemKind::Independent(list) => {
            list.iter_mut().for_each(|e| to.expr(e))
        }
        ItemKind::Nonholonomic {
            left,
            right,
            stabilized,
        }
        | ItemKind::Loop {
            left,
            right,
            stabilized,
        } => [left, right]
            .into_iter()
            .chain(stabilized)
            .for_each(|e| to.expr(e)),
        ItemKind::Frame { name, on, pose } => {
            to.declares(name, true);
            on.iter_mut().for_each(|name| to.uses(name));
            to.expr(pose);
        }
        ItemKind::Joint(found) => joint(found, to),
        ItemKind::Body(Body {
            frame,
            mass,
            com,
            inertia,
        }) => {
            to.uses(frame);
            mass.iter_mut().chain(com).for_each(|e| to.expr(e));
            inertia.iter_mut().for_each(|(e, _)| to.expr(e));
        }
        ItemKind::Particle { mass, at, on } => {
            to.expr(mass);
            to.expr(at);
            on.iter_mut().for_each(|name| to.uses(name));
        }
        ItemKind::Kinetic(e)
        | ItemKind::Potential(e)
        | ItemKind::Gravity(e)
        | ItemKind::Dissipation(e) => to.expr(e),
        ItemKind::Load {
            load,
            frame,
            from,
            axes,
        } => {
            applied(load, to);
            to.uses(frame);
            from.iter_mut().for_each(|name| to.uses(name));
            match axes {
                Components::Body | Components::World => {}
                Components::Frame(frame) => to.uses(frame),
            }
        }
        ItemKind::Push {
            force,
            from,
            to: end,
        } => {
            to.expr(force);
            ends(from, end, to);
        }
        ItemKind::Spring {
            stiffness,
            length,
            acting: on,
        } => {
            to.expr(stiffness);
            length.iter_mut().for_each(|e| to.expr(e));
            acting(on, to);
        }
        ItemKind::Cable {
            stiffness,
            length,
            from,
            to: end,
        } => {
            to.expr(stiffness);
            to.expr(length);
            ends(from, end, to);
        }
        ItemKind::Damper {
            coefficient: factor,
            acting: on,
        }
        | ItemKind::Inerter {
            inertance: factor,
            acting: on,
        } => {
            to.expr(factor);
            acting(on, to);
        }
        ItemKind::Output { name, unit, value } => {
            declared(name, unit, to);
            to.expr(value);
        }
        ItemKind::Invariant {
            name,
            conserved,
            when,
        } => {
            to.declares(name, false);
            claim(conserved, to);
            for Condition { target, value } in when {
                to.expr(target);
                to.expr(value);
            }
        }
        ItemKind::Generate(all) => {
            for wanted in all {
                match wanted {
                    Wanted::Function(name) => to.uses(name),
                    Wanted::Jacobian { frame, axes } => {
                        to.uses(frame);
                        axes.iter_mut().for_each(|axes| to.uses(axes));
                    }
                }
            }
        }
        // These contain or expand into other statements.
        ItemKind::Include(..)
        | ItemKind::Component(_)
        | ItemKind::Part(_)
        | ItemKind::Repeat(_) => {}
    }
}

fn declared(name: &mut Ident, unit: &mut Option<Unit>, to: &mut impl Visit) {
    to.declares(name, false);
    unit.iter_mut().for_each(|unit| to.place(&mut unit.span));
}

fn declaration(declaration: &mut Declaration, to: &mut impl Visit) {
    let Declaration {
        name,
        shape,
        unit,
        value,
    } = declaration;
    declared(name, unit, to);
    to.place(&mut shape.span);
    value.iter_mut().for_each(|e| to.expr(e));
}

fn joint(joint: &mut Joint, to: &mut impl Visit) {
    let Joint {
        name,
        kind: (_, span),
        axes,
        on,
        at,
        moves,
        follows,
        fields,
    } = joint;
    to.declares(name, false);
    to.place(span);
    axes.iter_mut().for_each(|e| to.expr(e));
    on.iter_mut().for_each(|name| to.uses(name));
    at.iter_mut().for_each(|e| to.expr(e));
    to.declares(moves, true);
    follows.iter_mut().for_each(|e| to.expr(e));
    for (_, span, values) in fields {
        to.place(span);
        values.iter_mut().for_each(|e| to.expr(e));
    }
}

fn applied(load: &mut Load, to: &mut impl Visit) {
    match load {
        Load::Force { force, at } => [force].into_iter().chain(at).for_each(|e| to.expr(e)),
        Load::Torque { torque } => to.expr(torque),
        Load::Wrench { force, torque, at } => [force, torque]
            .into_iter()
            .chain(at)
            .for_each(|e| to.expr(e)),
    }
}

fn acting(acting: &mut Acting, to: &mut impl Visit) {
    match acting {
        Acting::Between(first, second) => ends(first, second, to),
        Acting::On(e) => to.expr(e),
    }
}

fn ends(first: &mut End, second: &mut End, to: &mut impl Visit) {
    for End { at, frame } in [first, second] {
        at.iter_mut().for_each(|e| to.expr(e));
        to.uses(frame);
    }
}

fn claim(conserved: &mut Conserved, to: &mut impl Visit) {
    match conserved {
        Conserved::Energy => {}
        Conserved::LinearMomentum { of, along } => {
            of.iter_mut().for_each(|name| to.uses(name));
            along.iter_mut().for_each(|e| to.expr(e));
        }
        Conserved::AngularMomentum { of, about, along } => {
            of.iter_mut().for_each(|name| to.uses(name));
            about.iter_mut().chain(along).for_each(|e| to.expr(e));
        }
        Conserved::Value(e) => to.expr(e),
    }
}

/// Applies `to` to all spans of an expression.
pub fn places(expr: &mut Expr, to: &mut impl FnMut(&mut Span)) {
    to(&mut expr.span);
    match &mut expr.kind {
        ExprKind::Field(_, name) | ExprKind::Call(name, _) => to(&mut name.span),
        ExprKind::Quantity(quantity) => {
            to(&mut quantity.unit.span);
            places(&mut quantity.number, to);
        }
        _ => {}
    }
    for part in parts(expr) {
        places(part, to);
    }
}

/// Returns the direct subexpressions of an expression, mutably.
pub fn parts(expr: &mut Expr) -> Vec<&mut Expr> {
    match &mut expr.kind {
        ExprKind::Number(_) | ExprKind::Name(_) => Vec::new(),
        ExprKind::Quantity(quantity) => vec![&mut quantity.value],
        ExprKind::Field(base, _) | ExprKind::Neg(base) => vec![base],
        ExprKind::Index(base, list) => [&mut **base].into_iter().chain(list).collect(),
        ExprKind::Call(_, list) | ExprKind::Array(list) => list.iter_mut().collect(),
        ExprKind::Binary(_, left, right) | ExprKind::InAxes(left, right) => vec![left, right],
        ExprKind::If(choice) => {
            let Choice {
                left,
                comparison: _,
                right,
                then,
                otherwise,
            } = &mut **choice;
            vec![left, right, then, otherwise]
        }
    }
}
