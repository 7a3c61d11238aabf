//! The report on the geometry of a system, as aligned lines and as JSON.
//!
//! JSON: `{ "algebra", "christoffel", "constant_mass", "invariant", "velocities": [{ "name",
//! "integrable", "rate_of", "mass_constant", "keeps_kinetic", "keeps_potential",
//! "conserved_momentum" }], "blocks": [{ "velocities", "constant", "algebra", "at_defaults", "side" }],
//! "commuting": [names], "pattern": [rows of "." zero, "c" constant, "x" varying],
//! "inertia_blocks": [[names]] }`; what is unknown is null.

use hamel_dynamics::geometry::blocks::EntryDependence;
use hamel_dynamics::geometry::side::Side;
use hamel_dynamics::geometry::symmetry::Symmetry;
use hamel_dynamics::geometry::{Inspection, VelocityBlock};
use serde_json::{Value, json as object};

/// Size of the largest mass matrix whose pattern is drawn.
const MAX_DRAWN_SIZE: usize = 24;

/// Returns the report as lines of two columns.
pub fn lines(inspection: &Inspection) -> Vec<String> {
    let mut rows = integrability(inspection);
    rows.extend(algebra(inspection));
    if inspection.has_inertia {
        rows.extend(inertia(inspection));
    }
    rows.extend(symmetries(inspection));
    let width = rows.iter().map(|(head, _)| head.chars().count()).max();
    let width = width.unwrap_or(0);
    let mut lines = Vec::new();
    let mut last = String::new();
    for (head, text) in rows {
        let shown = if head == last { "" } else { head.as_str() };
        lines.push(format!("{shown:width$}  {text}"));
        last = head;
    }
    lines
}

type Row = (String, String);

fn row(head: &str, text: impl Into<String>) -> Row {
    (head.to_string(), text.into())
}

fn integrability(inspection: &Inspection) -> Vec<Row> {
    let mut rows = Vec::new();
    for velocity in inspection.velocities.iter().filter(|v| v.integrable) {
        let text = match &velocity.potential {
            Some(potential) => format!("{} = d/dt ({potential})", velocity.name),
            None => format!("{}, of no function that was tried", velocity.name),
        };
        rows.push(row("integrable, γᵢⱼᵏ = 0 for all i, j", text));
    }
    let numbered = inspection.velocities.iter().enumerate();
    let others: Vec<usize> = numbered
        .filter(|(_, velocity)| !velocity.integrable)
        .map(|(i, _)| i)
        .collect();
    if !others.is_empty() {
        rows.push(row(
            "not integrable (quasi-velocities)",
            inspection.join_names(&others),
        ));
    }
    rows
}

fn algebra(inspection: &Inspection) -> Vec<Row> {
    let mut rows = Vec::new();
    let whole = match inspection.algebra_name() {
        Some(name) => format!("{name}: γ is constant"),
        None => "none with a name: see the blocks of γ".into(),
    };
    rows.push(row("Lie algebra of the ∂ᵢ", whole));
    for block in &inspection.blocks {
        let text = format!(
            "{}: {}",
            inspection.join_names(&block.members),
            describe(block)
        );
        rows.push(row("blocks of γ", text));
    }
    if !inspection.blocks.is_empty() && !inspection.commuting.is_empty() {
        let text = format!(
            "{}: commute with all others",
            inspection.join_names(&inspection.commuting)
        );
        rows.push(row("blocks of γ", text));
    }
    if inspection.coordinate_rates && inspection.has_inertia {
        rows.push(row(
            "Γ",
            "Christoffel symbols of the first kind of M: A = I, γ = 0",
        ));
    }
    rows
}

fn describe(block: &VelocityBlock) -> String {
    let mut text = match &block.algebra {
        Some(name) => name.text(),
        None if block.constant => return "γ is constant, a function of parameters".into(),
        None => return "γ depends on x".into(),
    };
    if let Some(side) = block.side {
        text.push_str(&format!(", {}", side.text()));
    }
    if block.at_defaults {
        text.push_str(", at the parameters' default values");
    }
    text
}

/// Returns the side on which T is invariant: M is constant in a left- or right-invariant frame of a group.
fn invariant(inspection: &Inspection) -> Option<Side> {
    let is_group = inspection.has_constant_mass_matrix() && inspection.algebra_name().is_some();
    is_group.then(|| inspection.side()).flatten()
}

fn inertia(inspection: &Inspection) -> Vec<Row> {
    let varying = match (inspection.has_constant_mass_matrix(), invariant(inspection)) {
        (false, _) => "depends on x".to_string(),
        (true, None) => "constant".into(),
        (true, Some(Side::Left)) => "constant: T is left-invariant".into(),
        (true, Some(Side::Right)) => "constant: T is right-invariant".into(),
    };
    let mut rows = vec![row("M", varying)];
    let blocks: Vec<String> = inspection
        .inertia_blocks
        .iter()
        .map(|members| format!("{{{}}}", inspection.join_names(members)))
        .collect();
    if blocks.len() > 1 {
        rows.push(row("M in blocks", blocks.join(" ")));
    }
    if (2..=MAX_DRAWN_SIZE).contains(&inspection.pattern.len()) {
        for line in &inspection.pattern {
            rows.push(row(
                "pattern: . zero, c constant, x varying",
                draw_pattern(line, " "),
            ));
        }
    }
    rows
}

fn draw_pattern(line: &[EntryDependence], between: &str) -> String {
    let letters: Vec<&str> = line
        .iter()
        .map(|entry| match entry {
            EntryDependence::Zero => ".",
            EntryDependence::Constant => "c",
            EntryDependence::Varying => "x",
        })
        .collect();
    letters.join(between)
}

fn symmetries(inspection: &Inspection) -> Vec<Row> {
    let having = |property: fn(&Symmetry) -> bool| {
        let numbered = inspection.velocities.iter().enumerate();
        let having = numbered.filter(|(_, velocity)| property(&velocity.symmetry));
        let members: Vec<usize> = having.map(|(i, _)| i).collect();
        match members.len() {
            0 => "none".to_string(),
            all if all == inspection.velocities.len() && all > 1 => "all".into(),
            _ => inspection.join_names(&members),
        }
    };
    let potential = row("flows of ∂ᵢ that keep V", having(|s| s.keeps_potential));
    if !inspection.has_inertia {
        return vec![potential];
    }
    vec![
        row("∂ᵢM = 0 along", having(|s| s.mass_constant)),
        row("flows of ∂ᵢ that keep T", having(|s| s.keeps_kinetic)),
        potential,
        row("conserved momenta pᵢ", having(Symmetry::conserves_momentum)),
    ]
}

/// Returns the report as JSON.
pub fn json(inspection: &Inspection) -> Value {
    let names = |members: &[usize]| -> Vec<&str> {
        let velocities = members.iter().filter_map(|&i| inspection.velocities.get(i));
        velocities.map(|velocity| velocity.name.as_str()).collect()
    };
    let side = |side: Option<Side>| side.map(Side::text);
    let with_inertia = inspection.has_inertia;
    let velocities = inspection.velocities.iter().map(|velocity| {
        let symmetry = velocity.symmetry;
        object!({
            "name": velocity.name,
            "integrable": velocity.integrable,
            "rate_of": velocity.potential,
            "mass_constant": with_inertia.then_some(symmetry.mass_constant),
            "keeps_kinetic": with_inertia.then_some(symmetry.keeps_kinetic),
            "keeps_potential": symmetry.keeps_potential,
            "conserved_momentum": with_inertia.then(|| symmetry.conserves_momentum()),
        })
    });
    let blocks = inspection.blocks.iter().map(|block| {
        object!({
            "velocities": names(&block.members),
            "algebra": block.algebra.as_ref().map(|name| name.text()),
            "constant": block.constant,
            "at_defaults": block.at_defaults,
            "side": side(block.side),
        })
    });
    let pattern = inspection.pattern.iter().map(|line| draw_pattern(line, ""));
    let inertia = inspection.inertia_blocks.iter();
    let inertia: Vec<Vec<&str>> = inertia.map(|members| names(members)).collect();
    object!({
        "algebra": inspection.algebra_name(),
        "christoffel": inspection.coordinate_rates,
        "constant_mass": with_inertia.then(|| inspection.has_constant_mass_matrix()),
        "invariant": side(invariant(inspection).filter(|_| with_inertia)),
        "velocities": velocities.collect::<Vec<Value>>(),
        "blocks": blocks.collect::<Vec<Value>>(),
        "commuting": names(&inspection.commuting),
        "pattern": with_inertia.then(|| pattern.collect::<Vec<String>>()),
        "inertia_blocks": with_inertia.then_some(inertia),
    })
}
