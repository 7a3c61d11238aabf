//! Prints a description as text: one statement per line, in the order of the description, with exact numbers.
//!
//! The printed text reads back as an equal system. Of comments, it has those that a program added as [`Remarks`].

use super::ast::{
    About, Acting, Body, Component, Components, Conserved, CoordKind, Counter, Declaration, End,
    Expr, ExprKind, Ident, Item, ItemKind, Joint, JointField, JointKind, Load, Part, Remark,
    Remarks, Repeat, Source, System, Table, Target, Wanted,
};
use super::written::{conditions, equation, list, written};
use super::{joint_field, joint_kind};
use crate::units::Unit;

/// Largest width of a line, without its indentation, where a list or the fields of a body can be broken.
const MAX_WIDTH: usize = 110;

/// Prints a description as text that parses to an equal system; comments of the original text are lost.
pub fn print_description(system: &System) -> String {
    let mut text = String::new();
    for line in &system.docs {
        let line = match line {
            line if line.is_empty() => "///".into(),
            // A comment cannot contain a carriage return.
            line if line.contains('\r') => format!("#[doc = {:?}]", format!(" {line}")),
            line => format!("/// {line}"),
        };
        text.push_str(&line);
        text.push('\n');
    }
    for line in &system.remarks.head {
        text.push_str(&comment(line));
        text.push('\n');
    }
    let public = if system.public { "pub " } else { "" };
    text.push_str(&format!("{public}system {} ", system.name.name));
    text.push_str(&block(&system.items, &system.remarks));
    text.push('\n');
    text
}

/// Returns a comment, which cannot contain a line break.
fn comment(text: &str) -> String {
    match text.replace(char::is_control, " ") {
        text if text.is_empty() => "//".into(),
        text => format!("// {text}"),
    }
}

/// Returns statements in braces, indented, with the remarks between them.
fn block(items: &[Item], remarks: &Remarks) -> String {
    let mut lines = Vec::new();
    let remark = |remark: &Remark| match remark {
        Remark::Blank => String::new(),
        Remark::Comment(text) => comment(text),
    };
    let mut index = 0;
    while index < items.len() {
        lines.extend(remarks.above(index).iter().map(remark));
        let end = end_of_loop(items, remarks, index);
        let printed = match &items[index..end] {
            [item] => statement(item),
            equations => equations_of_loop(equations),
        };
        lines.extend(printed.lines().map(str::to_string));
        index = end;
    }
    lines.extend(remarks.above(items.len()).iter().map(remark));
    let lines = lines.iter().map(|line| match line.is_empty() {
        true => "\n".into(),
        false => format!("    {line}\n"),
    });
    format!("{{\n{}}}", lines.collect::<String>())
}

/// Returns the end of the `loop` equations that begin at an index and have nothing between them; for any other
/// statement, the index after it.
fn end_of_loop(items: &[Item], remarks: &Remarks, index: usize) -> usize {
    let is_loop = |index: &usize| matches!(items[*index].kind, ItemKind::Loop { .. });
    let mut end = index + 1;
    while end < items.len() && is_loop(&index) && is_loop(&end) && remarks.above(end).is_empty() {
        end += 1;
    }
    end
}

/// Prints several equations as one `loop` statement.
fn equations_of_loop(equations: &[Item]) -> String {
    let one = |item: &Item| {
        let text = statement(item);
        let text = text.strip_prefix("loop ").unwrap_or(&text);
        format!("\n    {}", text.trim_end_matches(';'))
    };
    let equations: Vec<String> = equations.iter().map(one).collect();
    format!("loop{};", equations.join(","))
}

/// Prints one statement with its final `;` or `}`.
pub fn statement(item: &Item) -> String {
    let line = match &item.kind {
        ItemKind::Param(list) => return declarations("param", list),
        ItemKind::Const(list) => return declarations("const", list),
        ItemKind::Let(list) => return declarations("let", list),
        ItemKind::Function(function) => {
            let parameters = each(&function.parameters, |(name, of)| {
                format!("{}{}", name.name, of.kind.annotation())
            });
            let (name, value) = (&function.name.name, written(&function.value));
            format!("fn {name}({parameters}) = {value}")
        }
        ItemKind::External(function) => {
            let parameters = each(&function.parameters, |name| name.name.clone());
            let (name, count) = (&function.name.name, function.components.0);
            let stand_in = function.stand_in.as_ref();
            let stand_in = stand_in.map(|value| format!(" = {}", written(value)));
            format!(
                "extern fn {name}({parameters}) -> {count}{}",
                stand_in.unwrap_or_default()
            )
        }
        ItemKind::Table(values) => table(values),
        ItemKind::Coord(list) => format!("coord {}", each(list, coordinate)),
        ItemKind::Velocity(list) => return declarations("velocity", list),
        ItemKind::Constraint { left, right } => format!("constraint {}", equation(left, right)),
        ItemKind::Rate { target, value } => {
            format!("rate {} = {}", part(target), written(value))
        }
        ItemKind::Time(name) => format!("time {}", name.name),
        ItemKind::Prescribe {
            target,
            rate,
            value,
        } => {
            let of = match rate {
                true => format!("rate({})", part(target)),
                false => part(target),
            };
            format!("prescribe {of} = {}", written(value))
        }
        ItemKind::Inactive(velocities) => format!("inactive {}", list(velocities)),
        ItemKind::Independent(velocities) => format!("independent {}", list(velocities)),
        ItemKind::Nonholonomic {
            left,
            right,
            stabilized,
        } => {
            let rate = after("stabilized", stabilized.as_ref().map(written));
            format!("nonholonomic {}{rate}", equation(left, right))
        }
        ItemKind::Loop {
            left,
            right,
            stabilized,
        } => {
            let rate = after("stabilized", stabilized.as_ref().map(written));
            format!("loop {}{rate}", equation(left, right))
        }
        ItemKind::Frame { name, on, pose } => {
            let (name, pose) = (&name.name, written(pose));
            match on {
                Some(on) => format!("frame {name} on {} at {pose}", on.name),
                None => format!("frame {name} = {pose}"),
            }
        }
        ItemKind::Joint(description) => return joint(description),
        ItemKind::Body(description) => return body(description),
        ItemKind::Particle { mass, at, on } => {
            let on = after("on", on.as_ref().map(word));
            format!("particle mass {} at {}{on}", written(mass), written(at))
        }
        ItemKind::Kinetic(energy) => format!("kinetic {}", written(energy)),
        ItemKind::Potential(energy) => format!("potential {}", written(energy)),
        ItemKind::Gravity(acceleration) => format!("gravity {}", written(acceleration)),
        ItemKind::Input(list) => return declarations("input", list),
        ItemKind::State(list) => return declarations("state", list),
        ItemKind::Load {
            load,
            frame,
            from,
            axes,
        } => {
            let from = after("from", from.as_ref().map(word));
            let axes = match axes {
                Components::Body => "body",
                Components::World => "world",
                Components::Frame(frame) => &frame.name,
            };
            format!("{} on {}{from} in {axes}", applied(load), frame.name)
        }
        ItemKind::Push { force, from, to } => {
            format!("force {} {}", written(force), between(from, to))
        }
        ItemKind::Spring {
            stiffness,
            length,
            acting,
        } => {
            let length = after("length", length.as_ref().map(written));
            let stiffness = written(stiffness);
            format!("spring stiffness {stiffness}{length} {}", on_what(acting))
        }
        ItemKind::Cable {
            stiffness,
            length,
            from,
            to,
        } => {
            let (stiffness, length) = (written(stiffness), written(length));
            format!(
                "cable stiffness {stiffness} length {length} {}",
                between(from, to)
            )
        }
        ItemKind::Damper {
            coefficient,
            acting,
        } => {
            let coefficient = written(coefficient);
            format!("damper coefficient {coefficient} {}", on_what(acting))
        }
        ItemKind::Inerter { inertance, acting } => {
            format!(
                "inerter inertance {} {}",
                written(inertance),
                on_what(acting)
            )
        }
        ItemKind::Dissipation(power) => format!("dissipation {}", written(power)),
        ItemKind::Generalized { target, value } => {
            format!("generalized force {} = {}", part(target), written(value))
        }
        ItemKind::Start { target, value } => {
            format!("start {} = {}", part(target), written(value))
        }
        ItemKind::Guess { target, value } => {
            format!("start {} ~ {}", part(target), written(value))
        }
        ItemKind::Output { name, unit, value } => {
            let unit = annotation("", unit.as_ref());
            format!("output {}{unit} = {}", name.name, written(value))
        }
        ItemKind::Invariant {
            name,
            conserved,
            when,
        } => {
            let when = (!when.is_empty()).then(|| conditions(when));
            format!(
                "invariant {}{}",
                claim(name, conserved),
                after("when", when)
            )
        }
        ItemKind::Generate(names) => {
            let written = |wanted: &Wanted| match wanted {
                Wanted::Function(name) => name.name.clone(),
                Wanted::Jacobian { frame, axes } => {
                    let axes = axes.as_ref().map(|axes| axes.name.clone());
                    format!("jacobian {}{}", frame.name, after("in", axes))
                }
            };
            format!("generate {}", each(names, written))
        }
        ItemKind::Include(name, _) => format!("include {name:?}"),
        ItemKind::Part(description) => part_of(description),
        ItemKind::Component(description) => return component(description),
        ItemKind::Repeat(Repeat { counter: i, items }) => {
            return format!("for {} {}", counter(i), block(items, &Remarks::default()));
        }
    };
    line + ";"
}

/// Returns a counter with its range, such as `i in 1..n`.
fn counter(counter: &Counter) -> String {
    let (first, last) = (written(&counter.first), written(&counter.last));
    format!("{} in {first}..{last}", counter.name.name)
}

fn component(component: &Component) -> String {
    let parameters = each(&component.parameters, |parameter| {
        let of = match &parameter.shape {
            _ if parameter.frame => ": frame".into(),
            Some(of) => of.kind.annotation(),
            None => String::new(),
        };
        let default = parameter.default.as_ref();
        let default = default.map(|value| format!(" = {}", written(value)));
        format!("{}{of}{}", parameter.name.name, default.unwrap_or_default())
    });
    let (name, items) = (
        &component.name.name,
        block(&component.items, &Remarks::default()),
    );
    format!("component {name}({parameters}) {items}")
}

fn part_of(part: &Part) -> String {
    let arguments = each(&part.arguments, |argument| {
        let name = argument.name.as_ref();
        let name = name.map(|name| format!("{} = ", name.name));
        name.unwrap_or_default() + &written(&argument.value)
    });
    let index = part.counter.as_ref().map(|i| format!("[{}]", counter(i)));
    let (name, of) = (&part.name.name, &part.component.name);
    format!(
        "part {name}{} = {of}({arguments})",
        index.unwrap_or_default()
    )
}

fn table(table: &Table) -> String {
    let points = match &table.source {
        Source::Points(points, _) => {
            let point = |(a, b): &(Expr, Expr)| format!("({}, {})", written(a), written(b));
            format!("= [{}]", each(points, point))
        }
        Source::File(name, _) => format!("from {name:?}"),
    };
    let (name, between, beyond) = (&table.name.name, table.between.word(), table.beyond.word());
    format!("table {name} {points} {between} extrapolate {beyond}")
}

/// Prints a coordinate's kind as it follows the name, such as `: S1`; empty for a real number.
pub fn kind(kind: CoordKind) -> String {
    match kind {
        CoordKind::Real => String::new(),
        CoordKind::Euclidean(n) => format!(": R{n}"),
        CoordKind::S1 => ": S1".into(),
        CoordKind::S3 => ": S3".into(),
        CoordKind::SO3 => ": SO3".into(),
        CoordKind::SE3 => ": SE3".into(),
    }
}

fn each<T>(list: &[T], one: impl Fn(&T) -> String) -> String {
    list.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Prints `word a, b, c;`, over several lines if it is too long for one.
fn declarations(word: &str, list: &[Declaration]) -> String {
    let mut text = String::new();
    let mut line = word.to_string();
    for (index, one) in list.iter().enumerate() {
        // The value of a declaration with another unit than that of SI was converted.
        let value = one.value.as_ref().map(|value| match &value.kind {
            ExprKind::Quantity(found) if one.unit.as_ref().is_some_and(|unit| !unit.is_si()) => {
                &found.number
            }
            _ => value,
        });
        let value = value.map(|value| format!(" = {}", written(value)));
        let value = value.unwrap_or_default();
        let end = if index + 1 < list.len() { "," } else { ";" };
        let (name, shape) = (
            &one.name.name,
            annotation(&one.shape.kind.annotation(), one.unit.as_ref()),
        );
        let piece = format!(" {name}{shape}{value}{end}");
        if index > 0 && line.len() + piece.len() > MAX_WIDTH {
            text += &(line + "\n");
            line = "   ".into();
        }
        line += &piece;
    }
    text + &line
}

fn coordinate((name, of, unit): &(Ident, CoordKind, Option<Unit>)) -> String {
    format!("{}{}", name.name, annotation(&kind(*of), unit.as_ref()))
}

/// Returns what follows a name: `: vec3 [m]`, `: [m]`, or less if it has no shape or no unit.
fn annotation(shape: &str, unit: Option<&Unit>) -> String {
    match unit {
        Some(unit) if shape.is_empty() => format!(": [{}]", unit.text),
        Some(unit) => format!("{shape} [{}]", unit.text),
        None => shape.to_owned(),
    }
}

fn part(target: &Target) -> String {
    super::written::target(target)
}

fn word(name: &Ident) -> String {
    name.name.clone()
}

/// Returns a keyword followed by the text; empty if there is no text.
fn after(word: &str, text: Option<String>) -> String {
    text.map_or(String::new(), |text| format!(" {word} {text}"))
}

fn joint(joint: &Joint) -> String {
    let kind = match joint.kind.0 {
        JointKind::SphericalS3 => "spherical S3",
        kind => joint_kind(kind),
    };
    let axes = match joint.axes.is_empty() {
        true => String::new(),
        false => format!(" {}", list(&joint.axes)),
    };
    let on = after("on", joint.on.as_ref().map(word));
    let at = after("at", joint.at.as_ref().map(written));
    let follows = after("follows", joint.follows.as_ref().map(written));
    let (name, moves) = (&joint.name.name, &joint.moves.name);
    let head = format!("joint {name}: {kind}{axes}{on}{at} moves {moves}{follows}");
    if joint.fields.is_empty() {
        return head + ";";
    }
    let mut text = head + " {";
    let mut last = None;
    for (field, _, values) in &joint.fields {
        text.push_str(match last.is_some_and(|last| share_a_line(last, *field)) {
            true => " ",
            false => "\n    ",
        });
        let values: Vec<String> = values.iter().map(written).collect();
        text += &format!("{} {};", joint_field(*field), values.join(" to "));
        last = Some(*field);
    }
    text + "\n};"
}

/// Whether two fields of a joint that follow each other are printed on one line: a spring, or bounds.
fn share_a_line(first: JointField, second: JointField) -> bool {
    use JointField::{Limit, MaxForce, MaxSpeed, Rest, Stiffness};
    matches!(
        (first, second),
        (Stiffness, Rest) | (Limit | MaxSpeed | MaxForce, Limit | MaxSpeed | MaxForce)
    )
}

fn body(body: &Body) -> String {
    let mut fields = Vec::new();
    fields.extend(
        body.mass
            .iter()
            .map(|mass| format!("mass {};", written(mass))),
    );
    fields.extend(body.com.iter().map(|com| format!("com {};", written(com))));
    fields.extend(body.inertia.iter().map(|(inertia, about)| {
        let about = match about {
            Some(About::Com) => " about com",
            Some(About::Origin) => " about origin",
            None => "",
        };
        format!("inertia {}{about};", written(inertia))
    }));
    let head = format!("body on {} {{", body.frame.name);
    let short: String = fields.iter().map(|field| format!("{field} ")).collect();
    let short = format!("{head} {short}}}");
    if short.len() <= MAX_WIDTH {
        return short;
    }
    let fields = fields.iter().map(|field| format!("    {field}\n"));
    format!("{head}\n{}}}", fields.collect::<String>())
}

fn applied(load: &Load) -> String {
    match load {
        Load::Force { force, at } => {
            let at = after("at", at.as_ref().map(written));
            format!("force {}{at}", written(force))
        }
        Load::Torque { torque } => format!("torque {}", written(torque)),
        Load::Wrench { force, torque, at } => {
            let at = after("at", at.as_ref().map(written));
            format!("wrench ({}, {}){at}", written(force), written(torque))
        }
    }
}

fn end(end: &End) -> String {
    match &end.at {
        Some(point) => format!("{} on {}", written(point), end.frame.name),
        None => end.frame.name.clone(),
    }
}

fn between(from: &End, to: &End) -> String {
    format!("from {} to {}", end(from), end(to))
}

fn on_what(acting: &Acting) -> String {
    match acting {
        Acting::Between(from, to) => between(from, to),
        Acting::On(value) => format!("on {}", written(value)),
    }
}

/// Returns a claim, with its name if that differs from the name of the quantity.
fn claim(name: &Ident, conserved: &Conserved) -> String {
    let (quantity, text) = match conserved {
        Conserved::Energy => ("energy", "energy".to_string()),
        Conserved::LinearMomentum { of, along } => {
            let of = after("of", of.as_ref().map(word));
            let along = after("along", along.as_ref().map(written));
            ("linear_momentum", format!("linear_momentum{of}{along}"))
        }
        Conserved::AngularMomentum { of, about, along } => {
            let of = after("of", of.as_ref().map(word));
            let about = after("about", about.as_ref().map(written));
            let along = after("along", along.as_ref().map(written));
            let text = format!("angular_momentum{of}{about}{along}");
            ("angular_momentum", text)
        }
        Conserved::Value(value) => ("", written(value)),
    };
    if quantity == name.name {
        text
    } else {
        format!("{} = {text}", name.name)
    }
}
