//! The identities of the equations of motion: T against M (20), loads (28), the three forms (30)
//! against one another, and the emitted ξ̇ in them.

use super::calculus::Calculus;
use super::check::Sides;
use super::forms::Symbols;
use super::gibbs::{Coverage, coverage};
use super::hamel_form::by_velocity;
use super::levi_civita::{contracted, levi_civita};
use crate::algebra::graph::Edge;
use crate::algebra::transplant::rebuild;
use crate::program::Program;

/// ∂²T/∂ξⁱ∂ξʲ = M_ij, fᵢ by virtual work, (30a) = (30b) and (30a) = (30c) for all ξ̇.
pub(super) fn forms(symbols: &mut Symbols) -> Vec<Sides> {
    let geometry = &mut symbols.geometry;
    let momentum = by_velocity(&mut geometry.model, symbols.kinetic);
    let hessian: Vec<Edge> = momentum
        .iter()
        .flat_map(|&entry| by_velocity(&mut geometry.model, entry))
        .collect();
    let bias = contracted(&mut geometry.model, &geometry.connection);
    let xi_dot = geometry.model.xi_dot.clone();
    let explicit = levi_civita(
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
        Sides {
            label: "(28)",
            equation: "fᵢ of the loads is their virtual work Σ ⟨F_p, ∂ᵢr_p⟩",
            left: symbols.applied.clone(),
            right: symbols.virtual_work.clone(),
        },
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

/// The emitted ξ̇ in (30c), and d/dt (T + V) = fᵢ ξⁱ.
pub(super) fn emitted(symbols: &mut Symbols, program: &Program) -> Vec<Sides> {
    let Some(accel) = program.function("accel") else {
        return Vec::new();
    };
    let geometry = &mut symbols.geometry;
    let xi = geometry.model.xi.clone();
    let xi_dot = rebuild(&program.graph, &mut geometry.model.graph, &accel.outputs);
    let mut calculus = Calculus::new(&geometry.model);
    let bias = contracted(&mut geometry.model, &geometry.connection);
    let forces = levi_civita(
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
    vec![
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
    ]
}
