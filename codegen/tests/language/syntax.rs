//! The syntax of the language: accepted and refused texts with their messages, and inputs that must not break the
//! parser.

mod accepted;
mod elements;
mod hostile;
mod joints;
mod refused;
mod refused_expressions;
mod rendered;
mod reuse;

use hamel_language::syntax::ast::{
    Acting, BinaryOp, End, Expr, ExprKind, ItemKind, System, Target, Wanted,
};
use hamel_language::syntax::parse_text;

/// Parses a correct text.
fn parsed(text: &str) -> System {
    match parse_text(text) {
        Ok(system) => system,
        Err(errors) => panic!("{errors:#?}"),
    }
}

/// Returns the only statement of a system.
fn statement(text: &str) -> ItemKind {
    let mut items = parsed(&format!("system S {{ {text} }}")).items;
    assert_eq!(items.len(), 1);
    items.remove(0).kind
}

/// Formats an expression with brackets around every operation.
fn spelled(expr: &Expr) -> String {
    let list = |entries: &[Expr]| entries.iter().map(spelled).collect::<Vec<_>>().join(", ");
    match &expr.kind {
        ExprKind::Number(number) => number.value.to_string(),
        ExprKind::Quantity(quantity) => spelled(&quantity.value),
        ExprKind::Name(name) => name.clone(),
        ExprKind::Field(of, field) => format!("{}.{}", spelled(of), field.name),
        ExprKind::Index(of, indices) => format!("{}[{}]", spelled(of), list(indices)),
        ExprKind::InAxes(call, frame) => format!("({} in {})", spelled(call), spelled(frame)),
        ExprKind::Call(function, arguments) => format!("{}({})", function.name, list(arguments)),
        ExprKind::Neg(of) => format!("(-{})", spelled(of)),
        ExprKind::Binary(op, left, right) => {
            let sign = match op {
                BinaryOp::Add => '+',
                BinaryOp::Sub => '-',
                BinaryOp::Mul => '*',
                BinaryOp::Div => '/',
                BinaryOp::Pow => '^',
            };
            format!("({} {sign} {})", spelled(left), spelled(right))
        }
        ExprKind::If(choice) => {
            let parts: Vec<String> = expr.parts().into_iter().map(spelled).collect();
            let sign = choice.comparison.sign();
            let [left, right, then, otherwise] = &parts[..] else {
                panic!("four parts");
            };
            format!("(if {left} {sign} {right} {{{then}}} else {{{otherwise}}})")
        }
        ExprKind::Array(entries) => format!("[{}]", list(entries)),
    }
}

fn maybe(expr: &Option<Expr>) -> String {
    expr.as_ref().map_or_else(|| "none".to_owned(), spelled)
}

fn aimed(target: &Target) -> String {
    match &target.field {
        Some(field) => format!("{}.{}", target.name.name, field.name),
        None => target.name.name.clone(),
    }
}

fn end(end: &End) -> String {
    format!("{} on {}", maybe(&end.at), end.frame.name)
}

fn acts(acting: &Acting) -> String {
    match acting {
        Acting::Between(from, to) => format!("from {} to {}", end(from), end(to)),
        Acting::On(value) => format!("on {}", spelled(value)),
    }
}

/// Formats the claim of an invariant.
fn kept(conserved: &hamel_language::syntax::ast::Conserved) -> String {
    use hamel_language::syntax::ast::Conserved::*;
    let frame =
        |of: &Option<hamel_language::syntax::ast::Ident>| of.as_ref().map(|of| of.name.clone());
    match conserved {
        Energy => "energy".into(),
        LinearMomentum { of, along } => format!("P of {:?} along {}", frame(of), maybe(along)),
        AngularMomentum { of, about, along } => {
            let of = frame(of);
            format!("L of {of:?} about {} along {}", maybe(about), maybe(along))
        }
        Value(value) => spelled(value),
    }
}

/// Formats a statement in one line.
fn told(kind: &ItemKind) -> String {
    use ItemKind::*;
    use hamel_language::syntax::ast::{Declaration, Load::*};
    let declared = |all: &[Declaration]| {
        let one = |one: &Declaration| {
            format!(
                "{}: {:?} = {}",
                one.name.name,
                one.shape.kind,
                maybe(&one.value)
            )
        };
        all.iter().map(one).collect::<Vec<_>>().join("; ")
    };
    match kind {
        Function(function) => {
            let parameters = function.parameters.iter();
            let parameters =
                parameters.map(|(name, shape)| format!("{}: {:?}", name.name, shape.kind));
            let parameters = parameters.collect::<Vec<_>>().join(", ");
            let value = spelled(&function.value);
            format!("fn {}({parameters}) = {value}", function.name.name)
        }
        External(function) => {
            let parameters = function.parameters.iter().map(|name| name.name.as_str());
            let parameters = parameters.collect::<Vec<_>>().join(", ");
            let (name, count) = (&function.name.name, function.components.0);
            format!(
                "extern fn {name}({parameters}) -> {count}, stand-in {}",
                maybe(&function.stand_in)
            )
        }
        Table(table) => {
            let source = match &table.source {
                hamel_language::syntax::ast::Source::Points(points, _) => {
                    let one = |(a, b): &(Expr, Expr)| format!("{}: {}", spelled(a), spelled(b));
                    points.iter().map(one).collect::<Vec<_>>().join("; ")
                }
                hamel_language::syntax::ast::Source::File(name, _) => format!("file {name}"),
            };
            let (name, between, beyond) = (&table.name.name, table.between, table.beyond);
            format!("table {name} = {source}, {between:?}, beyond {beyond:?}")
        }
        Independent(all) => {
            let all: Vec<String> = all.iter().map(spelled).collect();
            format!("independent {}", all.join(", "))
        }
        Guess { target, value } => format!("guess {target:?} ~ {}", spelled(value)),
        Param(all) => format!("param {}", declared(all)),
        Const(all) => format!("const {}", declared(all)),
        Let(all) => format!("let {}", declared(all)),
        Velocity(all) => format!("velocity {}", declared(all)),
        Input(all) => format!("input {}", declared(all)),
        State(all) => format!("state {}", declared(all)),
        Coord(all) => {
            let one = |(name, kind, _): &(hamel_language::syntax::ast::Ident, _, _)| {
                format!("{}: {kind:?}", name.name)
            };
            format!(
                "coord {}",
                all.iter().map(one).collect::<Vec<_>>().join("; ")
            )
        }
        Constraint { left, right } => format!("constraint {} = {}", spelled(left), spelled(right)),
        Time(name) => format!("time {}", name.name),
        Prescribe {
            target,
            rate,
            value,
        } => {
            let of = if *rate { "rate of " } else { "" };
            format!("prescribe {of}{} = {}", aimed(target), spelled(value))
        }
        Inactive(list) => {
            let list: Vec<String> = list.iter().map(spelled).collect();
            format!("inactive {}", list.join("; "))
        }
        Nonholonomic {
            left,
            right,
            stabilized,
        } => format!(
            "nonholonomic {} = {} stabilized {}",
            spelled(left),
            spelled(right),
            maybe(stabilized)
        ),
        Loop {
            left,
            right,
            stabilized,
        } => format!(
            "loop {} = {} stabilized {}",
            spelled(left),
            spelled(right),
            maybe(stabilized)
        ),
        Rate { target, value } => format!("rate {} = {}", aimed(target), spelled(value)),
        Start { target, value } => format!("start {} = {}", aimed(target), spelled(value)),
        Generalized { target, value } => {
            format!("generalized force {} = {}", aimed(target), spelled(value))
        }
        Output { name, value, .. } => format!("output {} = {}", name.name, spelled(value)),
        Frame { name, on, pose } => {
            format!(
                "frame {} on {:?} = {}",
                name.name,
                on.as_ref().map(|on| &on.name),
                spelled(pose)
            )
        }
        Body(body) => {
            let inertia = body
                .inertia
                .as_ref()
                .map(|(inertia, about)| (spelled(inertia), about));
            format!(
                "body on {}: {}, {}, {inertia:?}",
                body.frame.name,
                maybe(&body.mass),
                maybe(&body.com)
            )
        }
        Joint(joint) => {
            let list = |all: &[Expr]| all.iter().map(spelled).collect::<Vec<_>>().join(", ");
            let fields = joint.fields.iter();
            let fields = fields.map(|(field, _, values)| format!("{field:?} {}", list(values)));
            format!(
                "joint {}: {:?} [{}] on {:?} at {} moves {} follows {} {{{}}}",
                joint.name.name,
                joint.kind.0,
                list(&joint.axes),
                joint.on.as_ref().map(|on| &on.name),
                maybe(&joint.at),
                joint.moves.name,
                maybe(&joint.follows),
                fields.collect::<Vec<_>>().join("; ")
            )
        }
        Particle { mass, at, on } => {
            format!(
                "particle {} at {} on {:?}",
                spelled(mass),
                spelled(at),
                on.as_ref().map(|on| &on.name)
            )
        }
        Kinetic(value) => format!("kinetic {}", spelled(value)),
        Potential(value) => format!("potential {}", spelled(value)),
        Gravity(value) => format!("gravity {}", spelled(value)),
        Load {
            load,
            frame,
            from,
            axes,
        } => {
            let load = match load {
                Force { force, at } => format!("force {} at {}", spelled(force), maybe(at)),
                Torque { torque } => format!("torque {}", spelled(torque)),
                Wrench { force, torque, at } => {
                    format!(
                        "wrench {}, {} at {}",
                        spelled(force),
                        spelled(torque),
                        maybe(at)
                    )
                }
            };
            let from = from
                .as_ref()
                .map_or(String::new(), |from| format!(" from {}", from.name));
            let axes = match axes {
                hamel_language::syntax::ast::Components::Frame(frame) => frame.name.clone(),
                axes => format!("{axes:?}"),
            };
            format!("{load} on {}{from} in {axes}", frame.name)
        }
        Push { force, from, to } => {
            format!("force {} from {} to {}", spelled(force), end(from), end(to))
        }
        Spring {
            stiffness,
            length,
            acting,
        } => {
            let (stiffness, length) = (spelled(stiffness), maybe(length));
            format!("spring {stiffness} length {length} {}", acts(acting))
        }
        Cable {
            stiffness,
            length,
            from,
            to,
        } => {
            let (stiffness, length) = (spelled(stiffness), spelled(length));
            format!(
                "cable {stiffness} length {length} from {} to {}",
                end(from),
                end(to)
            )
        }
        Damper {
            coefficient,
            acting,
        } => format!("damper {} {}", spelled(coefficient), acts(acting)),
        Inerter { inertance, acting } => {
            format!("inerter {} {}", spelled(inertance), acts(acting))
        }
        Dissipation(value) => format!("dissipation {}", spelled(value)),
        Invariant {
            name,
            conserved,
            when,
        } => {
            let when = hamel_language::syntax::written::conditions(when);
            format!("invariant {} {} when {when}", name.name, kept(conserved))
        }
        Include(name, _) => format!("include {name}"),
        Component(component) => {
            let items = component.items.iter().map(|item| told(&item.kind));
            let parameters = component.parameters.iter().map(|parameter| {
                let frame = if parameter.frame { ": frame" } else { "" };
                let (name, default) = (&parameter.name.name, maybe(&parameter.default));
                format!("{name}{frame} = {default}")
            });
            let parameters = parameters.collect::<Vec<_>>().join("; ");
            let items = items.collect::<Vec<_>>().join(" | ");
            format!("component {}({parameters}): {items}", component.name.name)
        }
        Part(part) => {
            let arguments = part.arguments.iter().map(|argument| {
                let name = argument.name.as_ref().map(|name| &name.name);
                format!("{name:?} {}", spelled(&argument.value))
            });
            let arguments = arguments.collect::<Vec<_>>().join("; ");
            let counter = part.counter.as_ref().map(counts);
            let (name, of) = (&part.name.name, &part.component.name);
            format!("part {name} {counter:?} of {of}: {arguments}")
        }
        Repeat(repeat) => {
            let items = repeat.items.iter().map(|item| told(&item.kind));
            let items = items.collect::<Vec<_>>().join(" | ");
            format!("for {}: {items}", counts(&repeat.counter))
        }
        Generate(names) => {
            format!(
                "generate {}",
                names
                    .iter()
                    .map(|wanted| match wanted {
                        Wanted::Function(name) => name.name.clone(),
                        Wanted::Jacobian { frame, axes } => {
                            let axes = axes.as_ref().map(|axes| axes.name.as_str());
                            format!("jacobian of {} in {axes:?}", frame.name)
                        }
                    })
                    .collect::<Vec<_>>()
                    .join(", ")
            )
        }
    }
}

fn counts(counter: &hamel_language::syntax::ast::Counter) -> String {
    let (first, last) = (spelled(&counter.first), spelled(&counter.last));
    format!("{} from {first} to {last}", counter.name.name)
}
