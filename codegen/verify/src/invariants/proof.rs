//! Proofs of d/dt I = 0 by normal forms over the rationals.
//!
//! M ξ̇ = F is never divided by M: with a covector w such that w M = σ ∂I/∂ξ for a scalar σ ≠ 0,
//! σ d/dt I = σ ∂I/∂x A ξ + w F is a polynomial. For momenta and the energy w is a simple vector with σ = 1 (ξ for the
//! energy, an axis for an angular momentum), to which M⁻¹ ∂I/∂ξ simplifies in a graph where equal values are one node;
//! otherwise, for n ≤ 3, w = ∂I/∂ξ adj M and σ = det M.

use super::MotionEquations;
use super::remainder::polynomial_text;
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph, Node};
use hamel_algebra::linear::{cross, identity3, matrix, solve_symmetric};
use hamel_algebra::transplant::{rebuild, substitute};
use hamel_dynamics::calculus::{Calculus, into_frame};
use hamel_dynamics::connection::bias_forces;
use hamel_dynamics::loads::applied_force;
use hamel_dynamics::normal::{NormalForms, build_expression};
use hamel_dynamics::tables::EquationTables;
use hamel_language::model::Model;
use hamel_language::model::invariants::Invariant;

/// Largest number of velocities of models whose claims are proved; those of larger models are only checked modulo p.
const MAX_PROVED_VELOCITIES: usize = 8;
/// Largest number of nodes of expressions that are expanded.
const MAX_EXPANDED_NODES: usize = 20_000;

/// Budget of products and sums of terms for all expansions together; beyond it, the claim is only checked modulo p.
const EXPANSION_WORK: usize = 300_000;

/// Outcome of the attempt to prove d/dt I = 0 by normal forms.
pub enum ProofOutcome {
    /// d/dt I lies in the ideal of φ.
    Proved,
    /// d/dt I is not zero; its normal form, which is short.
    Leaves(String),
    /// Undecided: too large, or not polynomial.
    Open,
}

/// Prover of invariants: equations of motion in free coordinates, where nothing is merged modulo φ.
pub struct InvariantProver {
    model: Model,
    calculus: Calculus,
    mass: Vec<Vec<Edge>>,
    /// F = f − Γ ξ ξ − ∂V.
    force: Vec<Edge>,
    forms: NormalForms,
}

impl InvariantProver {
    /// Derives the equations of motion of a model; `None` if the model is too large, or its kinematics have no left
    /// inverse.
    pub fn new(model: &Model) -> Option<Self> {
        if model.n() > MAX_PROVED_VELOCITIES {
            return None;
        }
        let EquationTables {
            model: mut free,
            mut calculus,
            mut gamma,
            mut mass,
            mut potential,
            ..
        } = EquationTables::unreduced(model)?;
        // Normal forms at every stage keep the polynomials small. They may be differentiated, since the columns of A
        // are tangent to X.
        let mut forms = NormalForms::with_budget(&model.points, EXPANSION_WORK);
        let entries = gamma.iter_mut().flatten().flatten();
        for entry in entries.chain(mass.iter_mut().flatten()) {
            *entry = normal(&mut forms, &mut free.graph, *entry);
        }
        potential = normal(&mut forms, &mut free.graph, potential);
        let bias = bias_forces(&mut free, &mut calculus, &mass, &gamma);
        let applied = applied_force(&mut free, &mut calculus);
        let graph = &mut free.graph;
        let force = (0..mass.len())
            .map(|i| {
                let slope = calculus.along(graph, i, potential);
                let sum = graph.sub(applied[i], bias[i]);
                let sum = graph.sub(sum, slope);
                normal(&mut forms, graph, sum)
            })
            .collect();
        Some(InvariantProver {
            forms,
            model: free,
            calculus,
            mass,
            force,
        })
    }

    /// Tries to prove that an expression of the motion's graph is constant.
    pub fn prove(
        &mut self,
        motion: &mut MotionEquations,
        claim: &Invariant,
        entry: Edge,
    ) -> ProofOutcome {
        let covector = self.covector(motion, claim, entry);
        let graph = &motion.reference.model.graph;
        let entry = rebuild(graph, &mut self.model.graph, &[entry])[0];
        let entry = normal(&mut self.forms, &mut self.model.graph, entry);
        let slopes = self.slopes(entry);
        if let Some(w) = covector {
            let proof = self.with(claim, entry, &slopes, &w, None);
            if !matches!(proof, ProofOutcome::Open) {
                return proof;
            }
        }
        if self.mass.len() > 3 {
            return ProofOutcome::Open;
        }
        let (adjugate, determinant) = adjugate(&mut self.model.graph, &self.mass);
        let w: Vec<Edge> = adjugate
            .iter()
            .map(|row| self.model.graph.dot(row, &slopes))
            .collect();
        match self.with(claim, entry, &slopes, &w, Some(determinant)) {
            // The remainder is a multiple of d/dt I, which is not worth showing.
            ProofOutcome::Leaves(_) => ProofOutcome::Open,
            proof => proof,
        }
    }

    /// Returns M⁻¹ ∂I/∂ξ, computed in the motion's graph, where it merges with known expressions, and copied to free
    /// coordinates; `None` if quotients remain.
    fn covector(
        &mut self,
        motion: &mut MotionEquations,
        claim: &Invariant,
        entry: Edge,
    ) -> Option<Vec<Edge>> {
        let mut all = motion.reference.mass.concat();
        all.push(entry);
        let xi = motion.reference.model.xi.clone();
        let n = xi.len();
        seed_rotations(&mut motion.reference.model);
        let graph = motion.graph();
        let all = substitute(graph, &all, &claim.set);
        let mass: Vec<Vec<Edge>> = matrix(&all[..n * n], n);
        let slopes: Vec<Vec<Edge>> = xi
            .iter()
            .map(|xi| vec![Derivation::new([(xi.node(), graph.one())]).of(graph, all[n * n])])
            .collect();
        let w: Vec<Edge> = solve_symmetric(graph, &mass, &slopes)?.concat();
        // Quotients are not polynomial, and expressions built later would merge with them.
        let quotient = |id: &u32| matches!(graph.node(*id), Node::Div(..));
        if graph.reachable(&w).iter().any(quotient) {
            return None;
        }
        Some(rebuild(graph, &mut self.model.graph, &w))
    }

    /// Returns ∂I/∂ξ.
    fn slopes(&mut self, entry: Edge) -> Vec<Edge> {
        let xi = self.model.xi.clone();
        let graph = &mut self.model.graph;
        xi.iter()
            .map(|xi| Derivation::new([(xi.node(), graph.one())]).of(graph, entry))
            .collect()
    }

    /// Attempts the proof with a covector: w M = σ ∂I/∂ξ and σ ∂I/∂x A ξ + w F = 0.
    ///
    /// If σ is given as `scale`, w was constructed with it, and the first equation holds; otherwise σ = 1.
    fn with(
        &mut self,
        claim: &Invariant,
        entry: Edge,
        slopes: &[Edge],
        w: &[Edge],
        scale: Option<Edge>,
    ) -> ProofOutcome {
        let graph = &mut self.model.graph;
        let drift = self.calculus.rate(graph, entry);
        let drift = scale.map_or(drift, |scale| graph.mul(scale, drift));
        let gain = graph.dot(w, &self.force);
        let total = graph.add(drift, gain);
        let mut claims = vec![total];
        if scale.is_none() {
            for (row, &slope) in self.mass.iter().zip(slopes) {
                let product = graph.dot(row, w);
                claims.push(graph.sub(product, slope));
            }
        }
        let claims = substitute(graph, &claims, &claim.set);
        if graph.reachable(&claims).len() > MAX_EXPANDED_NODES {
            return ProofOutcome::Open;
        }
        let mut forms = Vec::new();
        for &edge in &claims {
            let Some(expanded) = self.forms.expand(&self.model.graph, edge) else {
                return ProofOutcome::Open;
            };
            forms.push(self.forms.reduce(&self.model.graph, &expanded));
        }
        if forms[1..].iter().any(|form| !form.is_zero()) {
            return ProofOutcome::Open;
        }
        if forms[0].is_zero() {
            return ProofOutcome::Proved;
        }
        match polynomial_text(&self.model.graph, &forms[0]) {
            Some(text) => ProofOutcome::Leaves(text),
            None => ProofOutcome::Open,
        }
    }
}

/// Adds Rᵀ (eₖ × r) of every frame to the graph: the covectors of angular momenta, so that M⁻¹ ∂I/∂ξ can merge with
/// them.
fn seed_rotations(model: &mut Model) {
    let graph = &mut model.graph;
    let axes = identity3(graph);
    for frame in &model.frames {
        for axis in axes {
            let moved = cross(graph, axis, frame.position);
            into_frame(graph, &frame.rotation, moved);
        }
    }
}

/// Returns the normal form of an expression, or the expression itself if it is too large.
fn normal(forms: &mut NormalForms, graph: &mut Graph, edge: Edge) -> Edge {
    if graph.reachable(&[edge]).len() > MAX_EXPANDED_NODES {
        return edge;
    }
    let Some(polynomial) = forms.expand(graph, edge) else {
        return edge;
    };
    let reduced = forms.reduce(graph, &polynomial);
    build_expression(graph, &reduced)
}

/// Returns adj M and det M of a symmetric matrix with at most three rows.
fn adjugate(graph: &mut Graph, m: &[Vec<Edge>]) -> (Vec<Vec<Edge>>, Edge) {
    let n = m.len();
    let mut adjugate = vec![vec![graph.one(); n]; n];
    for i in 0..n {
        for j in 0..n {
            let rows: Vec<usize> = (0..n).filter(|&row| row != i).collect();
            let columns: Vec<usize> = (0..n).filter(|&column| column != j).collect();
            let minor = match (rows.as_slice(), columns.as_slice()) {
                ([r], [c]) => m[*r][*c],
                ([r, s], [c, d]) => {
                    let (plus, minus) = (
                        graph.mul(m[*r][*c], m[*s][*d]),
                        graph.mul(m[*r][*d], m[*s][*c]),
                    );
                    graph.sub(plus, minus)
                }
                _ => graph.one(),
            };
            adjugate[j][i] = minor.signed((i + j) % 2 == 1);
        }
    }
    let first: Vec<Edge> = adjugate.iter().map(|row| row[0]).collect();
    let determinant = graph.dot(&m[0], &first);
    (adjugate, determinant)
}
