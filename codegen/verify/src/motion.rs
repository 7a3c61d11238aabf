//! Identities of the equations of motion: T against M (20), loads (28), the three forms (30) against one another, and
//! the emitted ξ̇ inserted in them.

use super::forms::ComparedQuantities;
use super::gibbs::{Coverage, coverage};
use super::hamel_form::velocity_gradient;
use super::levi_civita::{contract_connection, explicit_form};
use super::verdict::Sides;
use super::virtual_power;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::transplant::{rebuild, substitute};
use hamel_dynamics::calculus::Calculus;
use hamel_dynamics::tables::EquationTables;
use hamel_program::Program;

/// Returns the sides of ∂²T/∂ξⁱ∂ξʲ = M_ij, of fᵢ by virtual work, and of (30a) = (30b) and (30a) = (30c) for all ξ̇.
pub(super) fn forms(symbols: &mut ComparedQuantities) -> Vec<Sides> {
    let geometry = &mut symbols.geometry;
    let momentum = velocity_gradient(&mut geometry.model, symbols.kinetic);
    let hessian: Vec<Edge> = momentum
        .iter()
        .flat_map(|&entry| velocity_gradient(&mut geometry.model, entry))
        .collect();
    let bias = contract_connection(&mut geometry.model, &geometry.connection);
    let xi_dot = geometry.model.xi_dot.clone();
    let explicit = explicit_form(
        &mut geometry.model,
        &mut geometry.calculus,
        &geometry.mass,
        &bias,
        geometry.potential,
        &xi_dot,
    );
    let gibbs = match coverage(&geometry.model) {
        Coverage::Whole => "d/dt ∂L/∂ξⁱ + γᵢⱼᵏ ξʲ ∂L/∂ξᵏ − ∂ᵢL = ∂S/∂ξ̇ⁱ + ∂ᵢV",
        Coverage::Part => "(30a) = ∂S/∂ξ̇ⁱ + ∂ᵢV; S of `kinetic` from its M and Γ",
        Coverage::None => "(30a) = ∂S/∂ξ̇ⁱ + ∂ᵢV; S from M and Γ, not independent",
    };
    vec![
        Sides {
            label: "(20)",
            equation: "∂²T/∂ξⁱ∂ξʲ = M_ij, T from velocities",
            left: hessian,
            right: geometry.mass.concat(),
        },
        loads(symbols),
        Sides {
            label: "(30a) = (30b)",
            equation: gibbs,
            left: symbols.hamel.clone(),
            right: symbols.gibbs.clone(),
        },
        Sides {
            label: "(30a) = (30c)",
            equation: "d/dt ∂L/∂ξⁱ + γᵢⱼᵏ ξʲ ∂L/∂ξᵏ − ∂ᵢL = M ξ̇ + Γ ξ ξ + ∂V",
            left: symbols.hamel.clone(),
            right: explicit,
        },
    ]
}

/// Returns the sides of fᵢ by virtual work.
pub(super) fn loads(symbols: &ComparedQuantities) -> Sides {
    Sides {
        label: "(28)",
        equation: "fᵢ of the loads is their virtual work Σ ⟨F_p, ∂ᵢr_p⟩",
        left: symbols.applied.clone(),
        right: symbols.virtual_work.clone(),
    }
}

/// Returns the sides of (30c) and d/dt (T + V) = fᵢ ξⁱ for the emitted ξ̇, and those of emitted ż and loads.
pub(super) fn emitted_sides(symbols: &mut ComparedQuantities, program: &Program) -> Vec<Sides> {
    let Some(xi_dot) = program.xi_dot() else {
        return Vec::new();
    };
    let geometry = &mut symbols.geometry;
    let xi = geometry.model.xi.clone();
    let xi_dot = rebuild(&program.graph, &mut geometry.model.graph, xi_dot);
    let mut calculus = Calculus::new(&geometry.model);
    let bias = contract_connection(&mut geometry.model, &geometry.connection);
    let forces = explicit_form(
        &mut geometry.model,
        &mut calculus,
        &geometry.mass,
        &bias,
        geometry.potential,
        &xi_dot,
    );
    // Ė = Dᵗ(T + V) at ξ̇ = 0, plus p·ξ̇.
    let graph = &mut geometry.model.graph;
    let rows = geometry.mass.iter();
    let momentum: Vec<Edge> = rows.map(|row| graph.dot(row, &xi)).collect();
    let twice = graph.dot(&momentum, &xi);
    let half = graph.ratio(1, 2);
    let kinetic = graph.mul(half, twice);
    let energy = graph.add(kinetic, geometry.potential);
    let drift = calculus.rate(graph, energy);
    let gain = graph.dot(&momentum, &xi_dot);
    let change = graph.add(drift, gain);
    let power = graph.dot(&symbols.applied, &xi);
    let mut all = vec![
        Sides {
            label: "(30c)",
            equation: "M ξ̇ + Γ ξ ξ + ∂V = f for the emitted ξ̇",
            left: forces,
            right: symbols.applied.clone(),
        },
        Sides {
            label: "power",
            equation: "d/dt (T + V) = fᵢ ξⁱ for the emitted ξ̇",
            left: vec![change],
            right: vec![power],
        },
    ];
    if let Some(found) = program.state_rates()
        && !found.is_empty()
    {
        let model = &mut geometry.model;
        let found = rebuild(&program.graph, &mut model.graph, found);
        let set = model.xi_dot.iter().zip(&xi_dot);
        let set = set.filter_map(|(symbol, &rate)| Some((model.graph.as_symbol(*symbol)?, rate)));
        let set: Vec<(usize, Edge)> = set.collect();
        all.push(Sides {
            label: "states",
            equation: "ż as described, with the emitted ξ̇",
            left: found,
            right: substitute(&mut model.graph, &model.state_rates, &set),
        });
    }
    all.extend(of_loads(geometry, program));
    all
}

/// Returns the sides of (28) for emitted forces, of 2 D, and of the motions of points, each derived from single
/// particles.
fn of_loads(geometry: &mut EquationTables, program: &Program) -> Vec<Sides> {
    let mut graph = geometry.model.graph.clone();
    let graph = &mut graph;
    let model = &geometry.model;
    let mut calculus = Calculus::new(model);
    let calculus = &mut calculus;
    let mut all = Vec::new();
    let mut side = |label, equation, (left, right): (Vec<Edge>, Vec<Edge>)| {
        all.push(Sides {
            label,
            equation,
            left,
            right,
        });
    };
    let emitted = |graph: &mut Graph, name: &str| {
        let function = program.function(name)?;
        Some(rebuild(&program.graph, graph, &function.outputs))
    };
    if let Some(force) = emitted(graph, "generalized_force") {
        let virtual_force = virtual_power::applied_forces(model, graph, calculus);
        let equation = "fᵢ = Σ ⟨F_p, ∂ᵢr_p⟩ for the emitted f";
        side("(28)", equation, (force, virtual_force));
    }
    if let Some(slope) = emitted(graph, "potential_force") {
        let force = virtual_power::conservative_forces(model, graph, calculus);
        let force = force.into_iter().map(|edge| -edge).collect();
        let equation = "−∂ᵢV = Σ ⟨F_p, ∂ᵢr_p⟩ of weights and springs";
        side("(28)", equation, (slope, force));
    }
    if let Some(dissipation) = emitted(graph, "dissipation") {
        let twice = dissipation
            .iter()
            .map(|&edge| graph.add(edge, edge))
            .collect();
        let power = vec![virtual_power::dissipated_power(model, graph, calculus)];
        side("Rayleigh", "2 D = −fᵢ ξⁱ of dampers", (twice, power));
    }
    let lengths = virtual_power::squared_lengths(model, graph);
    side(
        "lines",
        "ℓ² = d·d of springs and forces along lines",
        lengths,
    );
    let motions = virtual_power::observed_motions(model, graph, calculus);
    let equation = "ṙ and r̈ of points from ∂ᵢr and ∂ᵢ∂ⱼr";
    side("motion", equation, motions);
    let zero = graph.zero();
    let says = |sides: &Sides| {
        sides
            .left
            .iter()
            .chain(&sides.right)
            .any(|&edge| edge != zero)
    };
    all.retain(says);
    geometry.model.graph = graph.clone();
    all
}
