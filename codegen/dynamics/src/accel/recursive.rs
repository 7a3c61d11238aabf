//! Recursion over a tree of links: ξ̇, M and forces.

use super::best::{AccelerationCandidate, BestCandidates, CandidateFamily};
use super::branches::BranchFactors;
use super::cheapest::MassAndForces;
use super::context::DerivationContext;
use super::parts::EquationTerms;
use super::solve::{EliminationPlan, Solution, solve};
use crate::calculus::Calculus;
use crate::loads;
use crate::numerical_loss::NumericalLoss;
use crate::tree::inverse::{
    Motion, TENSOR_ROUTES, TENSOR_ROUTES_WITH_ALPHA, inverse_dynamics, required_wrenches,
};
use crate::tree::link::TensorRoute;
use crate::tree::momentum::{momentum_columns, quadratic_momentum_rate, total_momentum};
use crate::tree::slopes::{InverseDynamicsDerivatives, inverse_dynamics_derivatives};
use crate::tree::uniform::CommonMotion;
use crate::tree::wrench::Wrench;
use crate::tree::{Placement, Tree, articulated, composite};
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, matrix, zero3};
use hamel_algebra::transplant::map_symbols;
use hamel_language::model::Model;

/// Largest number of links of a tree for which other routes are tried as well.
const MAX_SHORT_TREE_LINKS: usize = 3;

/// A model whose inertia is that of a tree of links, ready for the recursive algorithms.
pub struct TreeRecursion {
    /// The model, with constants and loads in its graph. It is the model in the full frame if the system's other
    /// velocities are given as functions of time.
    model: Model,
    tree: Tree,
    /// Whether numerical accuracy takes precedence over cost.
    careful: bool,
    /// Forces −∂V of potentials other than gravity.
    elastic: Vec<Edge>,
    /// Applied loads fᴱ.
    applied: Vec<Edge>,
    /// Transformation from the full frame to the free velocities.
    free: Option<Free>,
}

/// The free velocities of a full frame.
struct Free {
    /// Graph of the system in the free velocities.
    graph: Graph,
    /// Image in that graph of each symbol of the full frame's graph.
    images: Vec<Edge>,
    /// Places of the free velocities in the full ξ.
    active: Vec<usize>,
}

impl TreeRecursion {
    /// Sets up the recursion over a model's links; `None` if the model is not an unconstrained tree of links.
    pub fn of(
        context: &DerivationContext,
        placement: Placement,
        numerical_loss: &NumericalLoss,
    ) -> Option<Self> {
        let reduced = &context.model;
        if !reduced.constraints.is_empty() || context.back.is_some() {
            return None;
        }
        let (mut model, mut calculus, free) = match &reduced.full_frame {
            Some(frame) => {
                let full = Model::clone(&frame.full);
                let calculus = Calculus::new(&full);
                let free = Free {
                    graph: reduced.graph.clone(),
                    images: frame.images.clone(),
                    active: frame.active.clone(),
                };
                (full, calculus, Some(free))
            }
            None if reduced.is_affine() => return None,
            None => (reduced.clone(), context.calculus.clone(), None),
        };
        let tree = Tree::of(&mut model, &mut calculus, placement)?;
        let elastic = loads::elastic_force(&mut model, &mut calculus);
        let loads = loads::applied_force_terms(&mut model, &mut calculus);
        let applied = (0..model.n())
            .map(|i| {
                let column: Vec<Edge> = loads.iter().map(|load| load[i]).collect();
                model.graph.sum(&column)
            })
            .collect();
        Some(TreeRecursion {
            model,
            tree,
            careful: numerical_loss.is_compared_first(),
            elastic,
            applied,
            free,
        })
    }

    /// Returns the tree that computes U = α̂ + ω̂ ω̂ of its links in the cheapest of some ways.
    ///
    /// If accuracy takes precedence, the tree is returned unchanged, with U computed from each link's ω and α.
    fn cheapest(&self, ways: &[TensorRoute], graph: &Graph, motion: Motion) -> Tree {
        match self.careful {
            true => self.tree.clone(),
            false => self.tree.cheapest(ways, graph, motion),
        }
    }

    /// Returns whether the tree is so long that the recursion is certainly the cheapest route.
    pub fn is_long(&self) -> bool {
        self.tree.links.len() > MAX_SHORT_TREE_LINKS
    }

    /// Returns the generalised forces other than gravity.
    fn load(&self, graph: &mut Graph) -> Vec<Edge> {
        let both = self.elastic.iter().zip(&self.applied);
        both.map(|(&a, &b)| graph.add(a, b)).collect()
    }

    /// Returns the places of the state's velocities, and of those that are given functions of time.
    fn places(&self) -> (Vec<usize>, Vec<usize>) {
        let all = 0..self.model.n();
        match &self.free {
            None => (all.collect(), Vec::new()),
            Some(free) => all.partition(|i| free.active.contains(i)),
        }
    }

    /// Returns the full ξ̇ with zero accelerations for the state's velocities.
    fn given_rates(&self) -> Vec<Edge> {
        let mut rates = vec![self.model.graph.zero(); self.model.n()];
        for i in self.places().1 {
            rates[i] = self.model.xi_dot[i];
        }
        rates
    }

    /// Assembles ξ̇ of the state's velocities from prescribed rates and from those of the other velocities (`free`,
    /// by place in the full frame).
    fn driven(&self, active: &[usize], free: impl Fn(usize) -> Edge) -> Vec<Edge> {
        let given = |i: usize| self.model.accelerated.iter().find(|(place, _)| *place == i);
        let rate = |&i: &usize| given(i).map_or_else(|| free(i), |(_, rate)| *rate);
        active.iter().map(rate).collect()
    }

    /// Rewrites expressions of the full frame in the free velocities, and returns them with their graph.
    fn in_active_velocities<const N: usize>(
        &self,
        graph: Graph,
        lists: [Vec<Edge>; N],
    ) -> (Graph, [Vec<Edge>; N]) {
        let Some(free) = &self.free else {
            return (graph, lists);
        };
        let mut into = free.graph.clone();
        let lists = lists.map(|list| map_symbols(&graph, &mut into, &list, &free.images));
        (into, lists)
    }

    /// Offers the recursive candidates to `best`: articulated bodies, and composite bodies with M eliminated from
    /// the leaves and from the root.
    pub(super) fn search(&self, best: &mut BestCandidates) {
        let n = self.model.n();
        let (active, mut given) = self.places();
        let mut rates = self.given_rates();
        for &(place, rate) in &self.model.accelerated {
            rates[place] = rate;
            given.push(place);
        }
        let solved: Vec<usize> = active
            .iter()
            .copied()
            .filter(|i| !given.contains(i))
            .collect();
        let (xi, gravity) = (&self.model.xi, self.model.gravity);
        // If time gives velocities, other functions need ω of the links; this outweighs what a cheaper U saves for
        // ξ̇.
        let tree = match self.free {
            Some(_) => self.tree.clone(),
            None => self.cheapest(&TENSOR_ROUTES, &self.model.graph, (xi, &rates, gravity)),
        };
        if self.tree.is_plain(&self.model.graph, n, &given) {
            let mut graph = self.model.graph.clone();
            self.tree.register_polar_moments(&mut graph);
            let load = self.load(&mut graph);
            let forces = required_wrenches(&mut graph, &tree, xi, &rates, gravity);
            let solution = articulated::articulated_body_dynamics(
                &mut graph, &self.tree, &given, &forces, &load,
            );
            if let Some(Solution { xi_dot, pivots }) = solution {
                let route = "links traced, articulated bodies".to_string();
                let xi_dot = self.driven(&active, |i| xi_dot[i]);
                let pivots = active.iter().map(|&i| pivots[i]).collect();
                let (graph, [xi_dot, pivots]) = self.in_active_velocities(graph, [xi_dot, pivots]);
                let candidate = AccelerationCandidate::with_counts(graph, xi_dot, pivots, route);
                best.keep(CandidateFamily::Links, candidate);
            }
        }
        let mut graph = self.model.graph.clone();
        self.tree.register_polar_moments(&mut graph);
        let load = self.load(&mut graph);
        let bias = inverse_dynamics(&mut graph, &tree, xi, &rates, gravity);
        let mass = composite::mass_matrix(&mut graph, &self.tree, n);
        let right = solved.iter().map(|&i| graph.sub(load[i], bias[i]));
        let right = right.collect();
        let of_free = |row: &Vec<Edge>| solved.iter().map(|&j| row[j]).collect();
        let of_parts = EquationTerms {
            mass: solved.iter().map(|&i| of_free(&mass[i])).collect(),
            groups: vec![right],
            ..EquationTerms::default()
        };
        let free = solved.len();
        for order in [(0..free).rev().collect::<Vec<_>>(), (0..free).collect()] {
            let way = if order.first() == Some(&0) {
                "from the first velocity to the last"
            } else {
                "from the last velocity to the first"
            };
            let plan = EliminationPlan {
                order,
                apart: 0,
                scale: false,
                inverse: false,
            };
            let mut graph = graph.clone();
            if let Some(Solution { xi_dot, pivots }) = solve(&mut graph, &of_parts, &plan) {
                let route = format!("links traced, composite bodies, M eliminated {way}");
                let place = |i: usize| solved.iter().position(|&place| place == i);
                let xi_dot = self.driven(&active, |i| place(i).map_or(xi_dot[0], |at| xi_dot[at]));
                let one = graph.one();
                let pivots = active
                    .iter()
                    .map(|&i| place(i).map_or(one, |at| pivots[at]));
                let pivots = pivots.collect();
                let (graph, [xi_dot, pivots]) = self.in_active_velocities(graph, [xi_dot, pivots]);
                let candidate = AccelerationCandidate::with_counts(graph, xi_dot, pivots, route);
                best.keep(CandidateFamily::Links, candidate);
            }
        }
    }

    /// Returns M and the generalised forces by the composite-body and Newton-Euler recursions, in a graph of their own.
    pub fn mass_and_forces(&self) -> MassAndForces {
        let mut graph = self.model.graph.clone();
        let n = self.model.n();
        let (active, _) = self.places();
        let (xi, gravity) = (&self.model.xi, self.model.gravity);
        let (still, weightless) = (vec![graph.zero(); n], zero3(&graph));
        let tree = self.cheapest(&TENSOR_ROUTES, &graph, (xi, &self.model.xi_dot, gravity));
        let force = inverse_dynamics(&mut graph, &tree, xi, &self.model.xi_dot, gravity);
        let required = (active.iter())
            .map(|&i| graph.sub(force[i], self.elastic[i]))
            .collect();
        let rates = self.given_rates();
        let tree = self.cheapest(&TENSOR_ROUTES, &graph, (xi, &rates, weightless));
        let bias = inverse_dynamics(&mut graph, &tree, xi, &rates, weightless);
        let weight = inverse_dynamics(&mut graph, &self.tree, &still, &still, gravity);
        let momentum = inverse_dynamics(&mut graph, &self.tree, &still, xi, weightless);
        let mass = composite::mass_matrix_alone(&mut graph, &self.tree, n);
        let conservative = (active.iter())
            .map(|&i| graph.sub(self.elastic[i], weight[i]))
            .collect();
        let kinetic: Vec<Edge> = match self.free {
            None => Vec::new(),
            Some(_) => {
                let twice = graph.dot(&momentum, xi);
                let half = graph.ratio(1, 2);
                vec![graph.mul(half, twice)]
            }
        };
        let of_free = |list: &[Edge]| active.iter().map(|&i| list[i]).collect::<Vec<Edge>>();
        let rows: Vec<Edge> = active.iter().flat_map(|&i| of_free(&mass[i])).collect();
        let lists = [
            rows,
            of_free(&bias).into_iter().map(|edge| -edge).collect(),
            conservative,
            of_free(&self.applied),
            required,
            of_free(&momentum),
            kinetic,
        ];
        let (graph, lists) = self.in_active_velocities(graph, lists);
        let [
            mass,
            inertia,
            conservative,
            applied,
            inverse_dynamics,
            momentum,
            kinetic,
        ] = lists;
        let parts = EquationTerms {
            mass: matrix(&mass, active.len()),
            groups: Vec::new(),
            inertia,
            conservative,
            applied,
            inverse_dynamics: Some(inverse_dynamics),
            momentum: Some(momentum),
            kinetic: kinetic.first().copied(),
        };
        MassAndForces { graph, parts }
    }

    /// Returns M ξ̇ + Γ ξ ξ + ∂V − f for some velocities of the full frame: the forces of their drives.
    pub fn residuals(&self, velocities: &[usize]) -> (Graph, Vec<Edge>) {
        let mut graph = self.model.graph.clone();
        let (xi, xi_dot) = (&self.model.xi, &self.model.xi_dot);
        let tree = self.cheapest(&TENSOR_ROUTES, &graph, (xi, xi_dot, self.model.gravity));
        let force = inverse_dynamics(&mut graph, &tree, xi, xi_dot, self.model.gravity);
        let load = self.load(&mut graph);
        let rows = velocities.iter().map(|&i| graph.sub(force[i], load[i]));
        let rows = rows.collect();
        let (graph, [rows]) = self.in_active_velocities(graph, [rows]);
        (graph, rows)
    }

    /// Returns ṗ as a function of (x, ξ, u), in its own graph; `None` if a joint varies with x.
    pub fn momentum_rate(&self) -> Option<(Graph, Vec<Edge>)> {
        if self.free.is_some() {
            return None;
        }
        let mut graph = self.model.graph.clone();
        let still = vec![graph.zero(); self.model.n()];
        let quadratic = quadratic_momentum_rate(&mut graph, &self.tree, &self.model.xi)?;
        let weight = inverse_dynamics(&mut graph, &self.tree, &still, &still, self.model.gravity);
        let load = self.load(&mut graph);
        let rate = (0..self.model.n()).map(|i| {
            let terms = [quadratic[i], load[i], -weight[i]];
            graph.sum(&terms)
        });
        let rate = rate.collect();
        Some((graph, rate))
    }

    /// Returns the total linear momentum and the total angular momentum about the world origin, in world axes and
    /// in their own graph.
    ///
    /// The links must be those of the description: equivalent links have the same motion but different momenta.
    pub fn total_momentum(&self) -> (Graph, Vec3, Vec3) {
        let mut graph = self.model.graph.clone();
        let (linear, angular) = total_momentum(&mut graph, &self.tree, &self.model.xi);
        let (graph, [linear, angular]) =
            self.in_active_velocities(graph, [linear.to_vec(), angular.to_vec()]);
        let three = |list: &[Edge]| std::array::from_fn(|i| list[i]);
        (graph, three(&linear), three(&angular))
    }

    /// Returns the total momentum due to a unit of each velocity alone; `None` if other velocities are given.
    pub fn momentum_columns(&self) -> Option<(Graph, Vec<(Vec3, Vec3)>)> {
        if self.free.is_some() {
            return None;
        }
        let mut graph = self.model.graph.clone();
        let columns = momentum_columns(&mut graph, &self.tree, self.model.n());
        Some((graph, columns))
    }

    /// Returns ξ = M⁻¹ p by the articulated-body algorithm: ξ equals the ξ̇ that the forces p alone would cause.
    ///
    /// Returns `None` if a velocity is not the rate of a single freedom, or if M is singular everywhere.
    pub fn velocity_from_momentum(&self) -> Option<(Graph, Solution)> {
        let mut graph = self.model.graph.clone();
        if self.free.is_some() || !self.tree.is_plain(&graph, self.model.n(), &[]) {
            return None;
        }
        self.tree.register_polar_moments(&mut graph);
        let none = zero3(&graph);
        let nothing = Wrench {
            force: none,
            torque: none,
        };
        let wrenches = vec![nothing; self.tree.links.len()];
        let momenta = &self.model.momenta;
        let solution = articulated::articulated_body_dynamics(
            &mut graph,
            &self.tree,
            &[],
            &wrenches,
            momenta,
        )?;
        Some((graph, solution))
    }

    /// Returns the derivatives of M ξ̇ + Γ ξ ξ + ∂V along displacements and velocities at constant ξ̇, in their own
    /// graph: n rows of 2 n entries.
    ///
    /// Returns `None` if a joint varies with x.
    pub fn inverse_dynamics_derivatives(&self) -> Option<(Graph, Vec<Vec<Edge>>)> {
        if self.free.is_some() {
            return None;
        }
        let mut graph = self.model.graph.clone();
        let Model {
            xi,
            xi_dot,
            gravity,
            ..
        } = &self.model;
        let tree = self.cheapest(&TENSOR_ROUTES_WITH_ALPHA, &graph, (xi, xi_dot, *gravity));
        let found = inverse_dynamics_derivatives(&mut graph, &tree, xi, xi_dot, *gravity)?;
        let mut columns = self.changes(&self.elastic, &mut graph, &found);
        columns.truncate(2 * self.model.n());
        let row = |i: usize| columns.iter().map(|column| -column[i]).collect();
        Some((graph, (0..self.model.n()).map(row).collect()))
    }

    /// Returns ξ̇ and its derivatives from one factorisation of M: δξ̇ = M⁻¹ δ(f − M ξ̇ − Γ ξ ξ − ∂V) with ξ̇ held
    /// constant.
    ///
    /// Returns `None` if a joint varies with x, or if M is singular everywhere.
    pub fn acceleration_derivatives(&self) -> Option<AccelerationDerivatives> {
        let model = &self.model;
        let n = model.n();
        if self.free.is_some() || !model.accelerated.is_empty() {
            return None;
        }
        let mut graph = model.graph.clone();
        let load = self.load(&mut graph);
        let rates = self.given_rates();
        let tree = &self.cheapest(
            &TENSOR_ROUTES_WITH_ALPHA,
            &graph,
            (&model.xi, &rates, model.gravity),
        );
        let free = tree.common_motion(&mut graph, &model.xi, model.gravity);
        let (proper, gravity) = match &free {
            Some(uniform) => (&uniform.xi, zero3(&graph)),
            None => (&model.xi, model.gravity),
        };
        let bias = inverse_dynamics(&mut graph, tree, proper, &rates, gravity);
        let mass = composite::mass_matrix_by_second_moments(&mut graph, tree, n);
        let equivalent = tree.equivalent_motions(&mut graph);
        let branches = BranchFactors::factorize(&mut graph, &mass, &equivalent)?;
        let right: Vec<Edge> = (0..n).map(|i| graph.sub(load[i], bias[i])).collect();
        let mut xi_dot = branches.solve(&mut graph, &right);
        let found = inverse_dynamics_derivatives(&mut graph, tree, proper, &xi_dot, gravity)?;
        let mut changes = self.changes(&load, &mut graph, &found);
        if let Some(uniform) = &free {
            // The velocities left out of the recursion affect the derivatives only through their contribution to ξ̇
            // and the load.
            for &i in &uniform.common {
                changes[n + i] = self.along(&graph, n + i).all(&mut graph, &load);
            }
        }
        // Solve for the input columns first: the other columns can reuse much of their work.
        let mut columns: Vec<Vec<Edge>> = (changes[2 * n..].iter())
            .map(|column| branches.solve(&mut graph, column))
            .collect();
        let moved = changes[..2 * n].iter();
        let moved = moved.map(|column| branches.solve(&mut graph, column));
        columns.splice(..0, moved.collect::<Vec<_>>());
        if let Some(CommonMotion { rates, .. }) = &free {
            for (j, column) in columns.iter_mut().enumerate() {
                let more = self.along(&graph, j).all(&mut graph, rates);
                for (entry, more) in column.iter_mut().zip(more) {
                    *entry = graph.add(*entry, more);
                }
            }
            for (rate, &more) in xi_dot.iter_mut().zip(rates) {
                *rate = graph.add(*rate, more);
            }
        }
        let row = |i: usize| columns.iter().map(|column| column[i]).collect();
        Some(AccelerationDerivatives {
            rows: (0..n).map(row).collect(),
            graph,
            xi_dot,
            pivots: branches.pivots,
        })
    }

    /// Returns the derivation along the j-th direction: displacements, then velocities, then inputs.
    fn along(&self, graph: &Graph, j: usize) -> Derivation {
        let model = &self.model;
        let one = graph.one();
        match j.checked_sub(model.n()) {
            None => {
                let seeds = model.x.iter().zip(&model.a);
                Derivation::new(seeds.map(|(x, row)| (x.node(), row[j])))
            }
            Some(i) => {
                let symbol = model.xi.iter().chain(&model.u).nth(i);
                Derivation::new(symbol.map(|symbol| (symbol.node(), one)))
            }
        }
    }

    /// Returns the derivatives of load − M ξ̇ − Γ ξ ξ, gravity included, along displacements, velocities and inputs
    /// at constant ξ̇: 2 n + m columns.
    fn changes(
        &self,
        load: &[Edge],
        graph: &mut Graph,
        found: &InverseDynamicsDerivatives,
    ) -> Vec<Vec<Edge>> {
        let n = self.model.n();
        let columns = (0..2 * n + self.model.u.len()).map(|j| {
            let mut column = self.along(graph, j).all(graph, load);
            let table = match j.checked_sub(n) {
                None => Some((&found.displacement, j)),
                Some(velocity) => (velocity < n).then_some((&found.velocity, velocity)),
            };
            if let Some((table, j)) = table {
                for (entry, row) in column.iter_mut().zip(table) {
                    *entry = graph.sub(*entry, row[j]);
                }
            }
            column
        });
        columns.collect()
    }
}

/// ξ̇ and its derivatives.
pub struct AccelerationDerivatives {
    /// Graph of all expressions.
    pub graph: Graph,
    /// Accelerations ξ̇.
    pub xi_dot: Vec<Edge>,
    /// Pivots that must be positive, one per velocity.
    pub pivots: Vec<Edge>,
    /// Derivatives of ξ̇ along displacements, velocities and inputs: n rows of 2 n + m entries.
    pub rows: Vec<Vec<Edge>>,
}
