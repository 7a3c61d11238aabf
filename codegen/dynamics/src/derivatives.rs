//! Derivatives of the dynamics that `linearize` does not provide: of the inverse-dynamics force by
//! displacements and velocities, and of ξ̇ by parameters.

use super::accel::branches::BranchFactors;
use super::accel::context::DerivationContext;
use super::accel::tree_recursions;
use super::candidates::Candidates;
use super::linearize::Displacements;
use super::program::{MAX_LITERAL_VELOCITIES, ProgramBuilder};
use super::reduction::Reduction;
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::{Model, class};
use hamel_program::FunctionId;

impl ProgramBuilder<'_> {
    /// Adds the n rows of `[∂f/∂h ∂f/∂ξ]` for the force f that ξ̇ requires, with ξ̇ held fixed.
    pub(super) fn inverse_dynamics_derivatives(
        &mut self,
        full: &Model,
        reduction: Option<&Reduction>,
    ) {
        let id = FunctionId::InverseDynamicsSlopes;
        let model = self.model;
        let mut functions = self.functions.iter();
        let inverse = functions.find(|function| function.id == Some(FunctionId::InverseDynamics));
        let Some(force) = inverse.map(|function| function.outputs.clone()) else {
            return;
        };
        if !model.asked.wants(id) {
            return;
        }
        let mut candidates = Candidates::new(&self.numerical_loss);
        let mut columns = 0;
        let mut recursive = false;
        if reduction.is_none() {
            for recursion in tree_recursions(
                &DerivationContext::in_given_velocities(model),
                &self.numerical_loss,
            ) {
                if let Some((graph, rows)) = recursion.inverse_dynamics_derivatives() {
                    columns = rows.first().map_or(0, Vec::len);
                    candidates.offer_polished(graph, rows.concat(), &model.graph);
                    recursive = true;
                }
            }
        }
        if !recursive || model.n() <= MAX_LITERAL_VELOCITIES {
            let mut graph = self.graph.clone();
            let Some(displacements) = Displacements::new(full, reduction, &mut graph) else {
                return;
            };
            let along = (0..displacements.n()).map(|j| {
                let x = model.x.iter().zip(&displacements.a);
                Derivation::new(x.map(|(x, row)| (x.node(), row[j])))
            });
            let by = derivations(&graph, &model.xi);
            let mut along: Vec<Derivation> = along.chain(by).collect();
            columns = along.len();
            let entries = force.iter().flat_map(|&force| {
                let entries = along.iter_mut().map(|d| d.of(&mut graph, force));
                entries.collect::<Vec<Edge>>()
            });
            let entries = entries.collect();
            candidates.offer_own(graph, entries);
        }
        let entries = candidates.cheapest(&mut self.graph);
        self.push(id, entries);
        self.set_columns(columns);
    }

    /// Adds ∂ξ̇/∂p, followed by ∂ż/∂p, for all run-time parameters p, with a column for each
    /// number.
    ///
    /// # Errors
    /// Returns a diagnostic if the manifold itself depends on parameters: a state then leaves it
    /// when they change. Also if no parameter can change at run time.
    pub(super) fn parameter_derivatives(&mut self, full: &Model) -> Result<(), Diagnostic> {
        let id = FunctionId::ParameterSlopes;
        let model = self.model;
        if !model.asked.wants(id) {
            return Ok(());
        }
        let refused = |why: &str, help: &str| {
            let message = format!("`{}` is not known: {why}", id.name());
            Err(Diagnostic::new(model.span, message).help(help))
        };
        let free = &full.points.free;
        let moves = |edge: Edge| free.class(edge.node()) & class::PARAM != 0;
        let loops = model
            .constraints
            .iter()
            .map(|constraint| constraint.residual);
        let kept = |edge: Edge| model.graph.class(edge.node()) & class::PARAM != 0;
        if full.phi.iter().any(|(edge, _)| moves(*edge)) || loops.into_iter().any(kept) {
            return refused(
                "the constraints on the coordinates depend on parameters, so a state that satisfies them no longer does when a parameter changes",
                "use numbers for the lengths in the constraints, or describe the system in coordinates without constraints",
            );
        }
        let mut given = full.prescribed.iter();
        if given.any(|(_, edge)| full.graph.class(edge.node()) & class::PARAM != 0) {
            return refused(
                "a prescribed coordinate depends on parameters, and is part of the state",
                "use only numbers in its `prescribe`, or prescribe its velocity",
            );
        }
        // The symbol π precedes them.
        let count = model.params.iter().map(|group| group.len).sum();
        let symbols = model.graph.symbols().iter().skip(1).take(count);
        let symbols: Vec<Edge> = symbols.map(|symbol| Edge::of(symbol.node)).collect();
        if symbols.is_empty() {
            return refused(
                "no parameter can change at run time",
                "declare the values of interest with `param`",
            );
        }
        let mut candidates = Candidates::new(&self.numerical_loss);
        let mut graph = self.chosen.graph.clone();
        let entries = by_columns(&mut graph, &self.chosen.xi_dot, &symbols);
        candidates.offer_polished(graph, entries, &model.graph);
        if let Some((graph, entries)) = self.by_one_factorisation(&symbols) {
            candidates.offer_polished(graph, entries, &model.graph);
        }
        let mut entries = candidates.cheapest(&mut self.graph);
        if !model.states.is_empty() {
            let xi_dot = self.chosen.xi_dot.clone();
            let rates = self.state_rates(&xi_dot);
            entries.extend(by_columns(&mut self.graph, &rates, &symbols));
        }
        let guards = self.guards();
        self.push_guarded(id, entries, guards);
        self.set_columns(symbols.len());
        if let Some(function) = self.functions.last_mut() {
            let names = model.params.iter().map(|group| match group.len {
                1 => format!("`{}`", group.name),
                len => format!("`{}` ({len})", group.name),
            });
            let names: Vec<String> = names.collect();
            let lines = names.chunks(6).map(|names| names.join(", "));
            function
                .docs
                .push(lines.collect::<Vec<_>>().join(",\n") + ".");
        }
        Ok(())
    }

    /// Solves M ∂ξ̇ = ∂(f − Γ ξ ξ − ∂V) − (∂M) ξ̇ for all columns with one factorisation.
    ///
    /// Returns `None` with multipliers or drives, for which the right-hand side is different.
    fn by_one_factorisation(&self, symbols: &[Edge]) -> Option<(Graph, Vec<Edge>)> {
        let model = self.model;
        if !(model.constraints.is_empty() && model.accelerated.is_empty()) {
            return None;
        }
        let (mut graph, parts) = (self.shared.graph.clone(), &self.shared.parts);
        let right = parts.right_hand_side(&mut graph);
        let mut along = derivations(&graph, symbols);
        let branches = BranchFactors::factorize(&mut graph, &parts.mass, &[])?;
        let columns: Vec<Vec<Edge>> = (along.iter_mut())
            .map(|along| {
                let changes = parts.mass.iter().zip(&right).map(|(row, &force)| {
                    let change = along.of(&mut graph, force);
                    let masses = along.all(&mut graph, row);
                    let held = graph.dot(&masses, &self.chosen.xi_dot);
                    graph.sub(change, held)
                });
                let changes: Vec<Edge> = changes.collect();
                branches.solve(&mut graph, &changes)
            })
            .collect();
        let rows = (0..model.n()).flat_map(|i| columns.iter().map(move |column| column[i]));
        let solved = rows.collect();
        Some((graph, solved))
    }
}

/// Creates the derivations by symbols.
fn derivations(graph: &Graph, symbols: &[Edge]) -> Vec<Derivation> {
    let by = |symbol: &Edge| Derivation::new([(symbol.node(), graph.one())]);
    symbols.iter().map(by).collect()
}

/// Returns the derivatives of expressions by symbols, with a row for each expression.
fn by_columns(graph: &mut Graph, expressions: &[Edge], symbols: &[Edge]) -> Vec<Edge> {
    let mut along = derivations(graph, symbols);
    let rows = expressions.iter().flat_map(|&expression| {
        let entries = along.iter_mut().map(|along| along.of(graph, expression));
        entries.collect::<Vec<Edge>>()
    });
    rows.collect()
}
