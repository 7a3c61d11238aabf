//! Claims of constancy along the motion: d/dt I = ∂I/∂x A ξ + ∂I/∂ξ ξ̇ = 0 with ξ̇ from
//! M ξ̇ = f − Γ ξ ξ − ∂V (KR18 (30c)).
//!
//! Every claim is checked at fresh exact points of X modulo p, where M ξ̇ = … is solved in numbers and I is
//! differentiated by dual numbers. For `hamel check` it is proved over the rationals where that is possible, and for a
//! false claim the remainder of d/dt I is written out.
//!
//! | file | owns |
//! |---|---|
//! | `constrained` | claims about systems with constraints on their velocities |
//! | `proof` | normal forms of d/dt I |
//! | `remainder` | the text of a polynomial |

pub mod constrained;
mod proof;
mod remainder;

use super::confidence::Confidence;
use super::points::{COMPARED_POINTS, Disagreement, compare_at_fresh_points};
use super::reference::ReferenceQuantities;
use super::verdict::{Identity, Verdict};
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::{Edge, Graph, Node};
use hamel_algebra::linear::matrix;
use hamel_algebra::numeric::{evaluate_at, solve};
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::tangent::tangent_at;
use hamel_dynamics::calculus::Calculus;
use hamel_dynamics::quantity;
use hamel_language::diagnostics::{Diagnostic, rough};
use hamel_language::model::Model;
use hamel_language::model::invariants::Invariant;
use proof::{InvariantProver, ProofOutcome};

/// Returns an error for every quantity that an `invariant` statement claims to be constant and that is not, with the
/// remainder of d/dt I; for systems without constraints.
pub fn reject_false_invariants(model: &Model) -> Result<(), Vec<Diagnostic>> {
    if model.invariants.is_empty() {
        return Ok(());
    }
    let Some(mut motion) = MotionEquations::new(model) else {
        let message = "the invariants cannot be checked: the rates leave A without a left inverse";
        return Err(vec![
            Diagnostic::new(model.span, message).help("check the rates"),
        ]);
    };
    let mut errors = Vec::new();
    let mut prover: Option<Option<InvariantProver>> = None;
    for claim in &model.invariants {
        let entries = motion.entries(claim);
        match motion.find_refutation(claim, &entries) {
            None => {}
            Some(Disagreement::Nowhere) => {
                let message = format!(
                    "the claim `{}` cannot be checked: the motion has no value where the claim is made",
                    claim.name
                );
                let help = "check the values after `when`: they may make the mass matrix singular, or a divisor zero";
                errors.push(Diagnostic::new(claim.span, message).help(help));
            }
            Some(Disagreement::Differs(entry)) => {
                let prover = prover.get_or_insert_with(|| InvariantProver::new(model));
                let leaves = prover
                    .as_mut()
                    .and_then(
                        |prover| match prover.prove(&mut motion, claim, entries[entry]) {
                            ProofOutcome::Leaves(text) => Some(format!("d/dt leaves {text}")),
                            _ => None,
                        },
                    )
                    .or_else(|| motion.at_start(claim, entries[entry]))
                    .unwrap_or_else(|| "d/dt is not zero on the configuration manifold".into());
                let subject = if entries.len() > 1 {
                    format!("entry {} of `{}`", entry + 1, claim.name)
                } else {
                    format!("`{}`", claim.name)
                };
                let under = match claim.when.as_str() {
                    "" => String::new(),
                    when => format!(" when {when}"),
                };
                let message =
                    format!("{subject} is not constant along the motion{under}: {leaves}");
                errors.push(Diagnostic::new(claim.span, message).help(
                    "claim only what is constant, or give the inputs and parameters for which it is: `when F = 0`",
                ));
            }
        }
    }
    if errors.is_empty() {
        Ok(())
    } else {
        Err(errors)
    }
}

/// Checks that every quantity that an `invariant` statement claims to be constant is so, d/dt I = 0, and returns one
/// verdict for each, for `hamel check`.
pub fn check_invariants(model: &Model) -> Vec<Identity> {
    if model.invariants.is_empty() {
        return Vec::new();
    }
    let Some(mut motion) = MotionEquations::new(model) else {
        return Vec::new();
    };
    let mut prover = InvariantProver::new(model);
    let mut all = Vec::new();
    for claim in &model.invariants {
        let entries = motion.entries(claim);
        let verdict = match motion.find_refutation(claim, &entries) {
            Some(Disagreement::Nowhere) => {
                Verdict::Failed("no point was found at which to check it".into())
            }
            Some(Disagreement::Differs(entry)) => Verdict::Failed(format!(
                "entry {} of {} is not constant",
                entry + 1,
                entries.len()
            )),
            None => {
                let mut proved = |prover: &mut InvariantProver| {
                    entries.iter().all(|&entry| {
                        matches!(
                            prover.prove(&mut motion, claim, entry),
                            ProofOutcome::Proved
                        )
                    })
                };
                if prover.as_mut().is_some_and(&mut proved) {
                    Verdict::Proved
                } else {
                    Verdict::Checked(motion.confidence(model, &entries))
                }
            }
        };
        let under = match claim.when.as_str() {
            "" => String::new(),
            when => format!(" when {when}"),
        };
        all.push(Identity {
            label: "invariant",
            equation: format!("d/dt {} = 0{under}", claim.name),
            verdict,
        });
    }
    all
}

/// Equations of motion with which claims are compared.
struct MotionEquations {
    reference: ReferenceQuantities,
    calculus: Calculus,
}

impl MotionEquations {
    fn new(model: &Model) -> Option<Self> {
        let reference = ReferenceQuantities::new(model)?;
        let calculus = Calculus::new(&reference.model);
        Some(MotionEquations {
            reference,
            calculus,
        })
    }

    fn graph(&mut self) -> &mut Graph {
        &mut self.reference.model.graph
    }

    /// Returns the entries of the quantity that is claimed to be constant.
    fn entries(&mut self, claim: &Invariant) -> Vec<Edge> {
        let energies = (self.reference.kinetic, self.reference.potential);
        let model = &mut self.reference.model;
        quantity::quantity_value(model, &mut self.calculus, energies, &claim.quantity).entries()
    }

    /// Returns f − Γ ξ ξ − ∂V.
    fn force(&mut self) -> Vec<Edge> {
        let reference = &mut self.reference;
        let graph = &mut reference.model.graph;
        (0..reference.force.len())
            .map(|i| {
                let sum = graph.sub(reference.force[i], reference.bias[i]);
                graph.sub(sum, reference.slope[i])
            })
            .collect()
    }

    /// Bounds the chance of error: the entries are differentiated along a solution of n equations.
    fn confidence(&mut self, model: &Model, entries: &[Edge]) -> Confidence {
        let force = self.force();
        let reference = &self.reference;
        let mut roots = reference.mass.concat();
        roots.extend(force.iter().chain(&reference.model.rate).chain(entries));
        let graph = &reference.model.graph;
        let terms = 2 * (model.n() + 1);
        Confidence::new(
            model,
            &[(graph, &roots)],
            terms,
            COMPARED_POINTS,
            entries.len(),
        )
    }

    /// Returns how the claim fails; `None` if it does not.
    fn find_refutation(
        &mut self,
        claim: &Invariant,
        entries: &[Edge],
    ) -> Option<Disagreement<usize>> {
        let force = self.force();
        let model = &self.reference.model;
        let compared = compare_at_fresh_points(
            |number| {
                let points = &model.points;
                points.lane_where(0x1a7e + number, &model.graph, &claim.set)
            },
            |point, _| {
                let slopes = self.slopes(entries, &force, point)?;
                let changes = slopes.iter().position(|slope| !slope.is_zero());
                Some(changes.map_or(Ok(()), Err))
            },
        );
        compared.err()
    }

    /// Returns d/dt of the entries at a point.
    fn slopes(
        &self,
        entries: &[Edge],
        force: &[Edge],
        point: &FieldPoint,
    ) -> Option<Vec<ResiduePair>> {
        let model = &self.reference.model;
        let graph = &model.graph;
        let n = model.n();
        let mut roots = self.reference.mass.concat();
        roots.extend(force.iter().chain(&model.rate));
        let values = evaluate_at(graph, &roots, &mut point.clone())?;
        let (mass, rest) = values.split_at(n * n);
        let (force, rate) = rest.split_at(n);
        let rows = matrix(mass, n);
        let xi_dot = solve(rows, force.to_vec())?;
        let direction = direction(model, rate, &xi_dot);
        let duals = tangent_at(graph, entries, &mut point.clone(), &direction)?;
        Some(duals.into_iter().map(|dual| dual.1).collect())
    }

    /// Describes the rate of an entry at the initial state; `None` if it is zero or has no value.
    fn at_start(&mut self, claim: &Invariant, entry: Edge) -> Option<String> {
        let force = self.force();
        let set = claim.set.clone();
        let mut all = self.reference.mass.concat();
        all.extend(force);
        all.push(entry);
        let all = hamel_algebra::transplant::substitute(self.graph(), &all, &set);
        let n = self.reference.model.n();
        let mass: Vec<Vec<Edge>> = matrix(&all[..n * n], n);
        let right: Vec<Vec<Edge>> = all[n * n..n * n + n].iter().map(|&f| vec![f]).collect();
        let entry = all[n * n + n];
        let xi_dot = hamel_algebra::linear::solve_symmetric(self.graph(), &mass, &right)?;
        let xi = self.reference.model.xi.clone();
        let seeds = xi
            .iter()
            .zip(&xi_dot)
            .map(|(xi, rate)| (xi.node(), rate[0]));
        let gain = hamel_algebra::derivation::Derivation::new(seeds).of(self.graph(), entry);
        let graph = &mut self.reference.model.graph;
        let drift = self.calculus.rate(graph, entry);
        let rate = graph.add(drift, gain);
        let model = &self.reference.model;
        let numbers = model.numbers(
            &model.defaults,
            &model.start_x,
            &model.start_xi,
            &vec![0.0; model.u.len()],
            &vec![0.0; n],
        );
        let rate = hamel_algebra::numeric::evaluate(&model.graph, &[rate], &numbers)[0];
        (rate.is_finite() && rate.abs() > 1e-9)
            .then(|| format!("it changes at the rate {} at the start", rough(rate)))
    }
}

/// Returns the direction of the motion in all symbols, from ẋ and ξ̇.
pub(super) fn direction(
    model: &Model,
    rate: &[ResiduePair],
    xi_dot: &[ResiduePair],
) -> Vec<ResiduePair> {
    let mut direction = vec![ResiduePair::ZERO; model.graph.symbols().len()];
    let moving = model.x.iter().zip(rate).chain(model.xi.iter().zip(xi_dot));
    for (symbol, &slope) in moving {
        if let Node::Symbol(index) = model.graph.node(symbol.node()) {
            direction[index as usize] = slope;
        }
    }
    direction
}
