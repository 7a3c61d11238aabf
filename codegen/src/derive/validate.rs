//! The proof that stands before every emission: at fresh points of X modulo p the three forms (30a),
//! (30b), (30c) have the same left side F(x, ξ, ξ̇), and every emitted function is the one that F,
//! f, T and V imply.
//!
//! | function | has to be |
//! |---|---|
//! | `accel` | the ξ̇ with F(x, ξ, ξ̇) = f |
//! | `inverse_dynamics` | F(x, ξ, ξ̇) |
//! | `bias` | h = ⅓ (F(x, 2ξ, 0) − F(x, ξ, 0)), as h is quadratic in ξ |
//! | `potential_force` | F(x, ξ, 0) − h |
//! | `generalized_force` | f by virtual work |
//! | `momentum` | ∂T/∂ξ |
//! | `dissipation` | D of the dampers' forces on points |
//! | `kick` and its kind | the motion of the system, see `structure/proof` |
//! | `mass_matrix` | M with M ξ̇ = F(x, ξ, ξ̇) − F(x, ξ, 0), for any ξ̇ |

use super::forms::Forms;
use super::reference::Reference;
use super::slopes::Slopes;
use super::structure::Proof;
use crate::algebra::fp::Fp;
use crate::algebra::graph::{Edge, Node};
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::diagnostics::Diagnostic;
use crate::model::Model;
use crate::program::Program;

/// Fresh points for every program.
pub const POINTS: u64 = 8;
/// Points tried where square roots have no value.
const TRIES: u64 = 400;

/// Validates the functions of a program; an error here is a fault of the generator, never emitted.
pub fn validate(model: &Model, program: &Program) -> Result<(), Diagnostic> {
    let forms = Forms::new(model).ok_or_else(|| failure(model, "Y A = I"))?;
    let mut reference = Reference::new(model).ok_or_else(|| failure(model, "Y A = I"))?;
    let slopes = Slopes::new(&mut reference, program);
    let splitting = Proof::new(&mut reference, program);
    let mut seed = 0;
    for _ in 0..POINTS {
        loop {
            seed += 1;
            if seed > TRIES {
                return Err(failure(
                    model,
                    "that the equations have values at some points",
                ));
            }
            let Some(lane) = model.points.lane(0x7a11 + seed) else {
                continue;
            };
            let found = at_point(&forms, program, &lane);
            let found = match found {
                Some(Ok(())) => slopes
                    .at_point(&reference, program, &lane)
                    .map(|found| found.map_err(str::to_string)),
                found => found,
            };
            let found = match (found, &splitting) {
                (Some(Ok(())), Some(splitting)) => splitting
                    .at_point(&reference, program, &lane)
                    .map(|found| found.map_err(str::to_string)),
                (found, _) => found,
            };
            match found {
                None => continue,
                Some(Ok(())) => break,
                Some(Err(what)) => return Err(failure(model, &what)),
            }
        }
    }
    Ok(())
}

/// A fault of the generator, which is never emitted.
pub(super) fn failure(model: &Model, what: &str) -> Diagnostic {
    Diagnostic::new(
        model.span,
        format!(
            "internal check failed for `{}`: {what} does not hold",
            model.name
        ),
    )
    .help("this is a fault of the generator, nothing was emitted; please report the description")
}

/// What the forms give at one point.
struct Values {
    left: [Vec<Fp>; 3],
    force: Vec<Fp>,
    momentum: Vec<Fp>,
    kinetic: Fp,
    potential: Fp,
    dissipation: Fp,
}

fn values(forms: &Forms, lane: &Lane) -> Option<Values> {
    let n = forms.model.n();
    let mut roots: Vec<Edge> = Vec::with_capacity(5 * n + 3);
    for part in [
        &forms.hamel,
        &forms.gibbs,
        &forms.levi_civita,
        &forms.force,
        &forms.momentum,
    ] {
        roots.extend(part);
    }
    roots.extend([forms.kinetic, forms.potential, forms.dissipation]);
    let values = evaluate_at(&forms.model.graph, &roots, &mut lane.clone())?;
    let mut parts = values.chunks(n.max(1)).map(<[Fp]>::to_vec);
    let left = [parts.next()?, parts.next()?, parts.next()?];
    let (force, momentum) = (parts.next()?, parts.next()?);
    let [.., kinetic, potential, dissipation] = values.as_slice() else {
        return None;
    };
    Some(Values {
        left,
        force,
        momentum,
        kinetic: *kinetic,
        potential: *potential,
        dissipation: *dissipation,
    })
}

/// The symbols of a vector, given other values.
fn with(lane: &Lane, forms: &Forms, symbols: &[Edge], to: impl Fn(usize, Fp) -> Fp) -> Lane {
    let mut changed = lane.clone();
    for (i, symbol) in symbols.iter().enumerate() {
        if let Node::Symbol(index) = forms.model.graph.node(symbol.node()) {
            let index = index as usize;
            changed.set_symbol(index, to(i, lane.symbol(index)));
        }
    }
    changed
}

/// Compares at one point; `None` where it cannot be evaluated there.
fn at_point(forms: &Forms, program: &Program, lane: &Lane) -> Option<Result<(), String>> {
    let model = &forms.model;
    let moving = values(forms, lane)?;
    let broken = disagreements(&moving.left);
    if !broken.is_empty() {
        return Some(Err(broken.join(", ")));
    }
    let value = |name: &str| {
        let function = program.function(name)?;
        evaluate_at(&program.graph, &function.outputs, &mut lane.clone())
    };
    let wanted = |name: &str| program.function(name).is_some();
    let coasting = with(lane, forms, &model.xi_dot, |_, _| Fp::ZERO);
    let twice = with(&coasting, forms, &model.xi, |_, value| value + value);
    let slow = values(forms, &coasting)?;
    let fast = values(forms, &twice)?;
    let third = Fp::new(3).inv()?;
    let difference =
        |a: &[Fp], b: &[Fp]| -> Vec<Fp> { a.iter().zip(b).map(|(&a, &b)| a - b).collect() };
    let left = &moving.left[0];
    let bias: Vec<Fp> = difference(&fast.left[0], &slow.left[0])
        .into_iter()
        .map(|entry| entry * third)
        .collect();
    let slope = difference(&slow.left[0], &bias);
    if wanted("mass_matrix") {
        let xi_dot = evaluate_at(&model.graph, &model.xi_dot, &mut lane.clone())?;
        let inertial: Vec<Fp> = value("mass_matrix")?
            .chunks(model.n().max(1))
            .map(|row| {
                let products = row.iter().zip(&xi_dot).map(|(&m, &rate)| m * rate);
                products.fold(Fp::ZERO, |sum, product| sum + product)
            })
            .collect();
        if inertial != difference(left, &slow.left[0]) {
            return Some(Err(
                "(20), M_ij = Σ m_p ⟨∂ᵢr_p, ∂ⱼr_p⟩ for the emitted M".into()
            ));
        }
    }
    let energy = moving.kinetic + moving.potential;
    let table: [(&str, &[Fp], &str); 9] = [
        ("bias", &bias, "h = Γ ξ ξ for the emitted bias force"),
        ("potential_force", &slope, "∂ᵢV for the emitted slope"),
        (
            "generalized_force",
            &moving.force,
            "(28), fᵢ = Σ ⟨F_p, ∂ᵢr_p⟩ for the emitted loads",
        ),
        (
            "inverse_dynamics",
            left,
            "(30c) for the emitted inverse dynamics",
        ),
        ("momentum", &moving.momentum, "p = ∂T/∂ξ"),
        ("kinetic_energy", &[moving.kinetic], "T = ½ Σ m_p ‖ṙ_p‖²"),
        (
            "potential_energy",
            &[moving.potential],
            "V = −Σ m_p ⟨g, r_p⟩",
        ),
        ("energy", &[energy], "T + V"),
        (
            "dissipation",
            &[moving.dissipation],
            "2 D = −fᵢ ξⁱ of dampers",
        ),
    ];
    for (name, expected, what) in table {
        if wanted(name) && value(name)? != expected {
            return Some(Err(what.into()));
        }
    }
    if wanted("accel") {
        let xi_dot = value("accel")?;
        let driven = with(lane, forms, &model.xi_dot, |i, value| {
            xi_dot.get(i).copied().unwrap_or(value)
        });
        if values(forms, &driven)?.left[0] != moving.force {
            return Some(Err("(30c) for the emitted ξ̇".into()));
        }
    }
    for (name, expected) in &model.outputs {
        let expected = evaluate_at(&model.graph, &expected.entries(), &mut lane.clone())?;
        if wanted(name) && value(name)? != expected {
            return Some(Err(format!("output `{name}`")));
        }
    }
    Some(Ok(()))
}

/// The pairs of forms that differ.
fn disagreements([hamel, gibbs, levi_civita]: &[Vec<Fp>; 3]) -> Vec<&'static str> {
    let pairs = [
        (hamel == gibbs, "(30a) = (30b)"),
        (hamel == levi_civita, "(30a) = (30c)"),
        (gibbs == levi_civita, "(30b) = (30c)"),
    ];
    let broken = pairs.iter().filter(|(agree, _)| !agree);
    broken.map(|(_, name)| *name).collect()
}
