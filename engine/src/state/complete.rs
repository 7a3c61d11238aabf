//! Completes a partially given state, as if the description had the given values for its parameters and starts: exact
//! starts of the description stay, prescribed motion is followed, loops are closed, constraints on velocities are
//! satisfied. If the given values contradict exact starts, those starts are released that violated equations couple,
//! and move to the nearest values that satisfy these.

use super::State;
use super::coupling::{Coupling, symbols};
use super::given_entries::{GivenEntries, full_frame_indices};
use super::problem::StateProblem;
use hamel_codegen::algebra::graph::Edge;
use hamel_codegen::algebra::nearest_solution::find_nearest;
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::algebra::residual_scale::relative_residuals;
use hamel_codegen::generate::Generated;
use hamel_codegen::model::closest::Constraints;
use hamel_codegen::model::initial_conditions::InitialConditions;
use hamel_codegen::model::loop_closure::{LoopClosure, Open, normalise};
use hamel_codegen::model::pfaffian::Kind;
use hamel_codegen::model::twists::KinematicExpressions;

/// Values of |φ(x)| up to this are not corrected.
const EXACT_RESIDUAL: f64 = 1e-12;
/// Largest rate of a constraint that counts as rounding.
const RATE_TOLERANCE: f64 = 1e-9;

/// Completion of a state.
struct Completion<'a> {
    generated: &'a Generated,
    given: &'a GivenEntries,
    state: &'a State,
}

impl State {
    /// Completes a state whose given entries of x have been set; contradictions of the description are refused, with
    /// the residual. `from` is the state that is changed.
    pub(super) fn complete(
        &mut self,
        generated: &Generated,
        given: &GivenEntries,
        from: &State,
    ) -> Result<(), Vec<StateProblem>> {
        let opening = opening(generated, self, given, from);
        let completion = Completion {
            generated,
            given,
            state: self,
        };
        let x = match completion.as_written(&opening) {
            Ok(x) => x,
            Err(_) => completion.release_exact_starts(&opening)?,
        };
        let xi = completion.velocities(opening.clone(), &x, from)?;
        self.x = x;
        let stay = full_frame_indices(generated)
            .into_iter()
            .map(|place| xi[place]);
        let (moving, behind) = self.xi.split_at_mut(generated.active.n());
        let z = &from.xi[moving.len()..];
        moving
            .iter_mut()
            .zip(stay)
            .for_each(|(entry, value)| *entry = value);
        if z == generated.active.start_z {
            let free = (0..z.len()).filter(|&place| !given.z[place]);
            free.for_each(|place| behind[place] = opening.z[place]);
        }
        Ok(())
    }
}

/// Returns the start of the description with the parameters of a state, in which given values replace those of the
/// text; if `from` is not the start, its values replace those of the start.
fn opening(
    generated: &Generated,
    state: &State,
    given: &GivenEntries,
    from: &State,
) -> InitialConditions {
    let (model, active) = (&generated.model, &generated.active);
    let mut opening = model.initial_conditions.at(&state.params);
    if from.x != active.start_x {
        opening.x.clone_from(&from.x);
    }
    if from.xi[..active.n()] != active.start_xi {
        for (place, value) in full_frame_indices(generated).into_iter().zip(&from.xi) {
            opening.xi[place] = *value;
        }
    }
    for (alpha, _) in given.x.iter().enumerate().filter(|(_, given)| **given) {
        opening.x[alpha] = state.x[alpha];
        opening.exact_x[alpha] = true;
        opening.guessed_x[alpha] = false;
    }
    for (i, value) in given.xi.iter().enumerate() {
        if let Some(value) = value {
            opening.xi[i] = *value;
            opening.exact_xi[i] = true;
            opening.guessed_xi[i] = false;
        }
    }
    opening
}

impl Completion<'_> {
    /// x as the start of the description with the given values in its text.
    fn as_written(&self, opening: &InitialConditions) -> Result<Vec<f64>, Vec<StateProblem>> {
        let model = &self.generated.model;
        let mut opening = opening.clone();
        let (near, kept) = (opening.guesses_coordinates(), opening.exact_x.clone());
        self.restore(&mut opening.x, |x, violations| match near {
            true => self.satisfied(x, &kept).ok_or(violations),
            false => Err(violations),
        })?;
        let mass = |x: &[f64]| self.mass(x);
        let closed = opening.configure(&self.closure(), &model.prescribed, &mass);
        closed.map_err(|open| vec![self.open(open)])?;
        self.on_manifold(&opening.x)?;
        Ok(opening.x)
    }

    /// x if given values contradict those of the description: nearest to its start, first with all exact starts, then
    /// without the exact starts that are tied to violated equations.
    fn release_exact_starts(
        &self,
        opening: &InitialConditions,
    ) -> Result<Vec<f64>, Vec<StateProblem>> {
        let mut from = self.state.x.clone();
        let all = 0..from.len();
        // Exact starts may depend on parameters.
        let exact = all.clone().filter(|&alpha| opening.exact_x[alpha]);
        exact.for_each(|alpha| from[alpha] = opening.x[alpha]);
        let tied = self.tied(&from);
        let loose = |alpha: usize| tied.contains(&alpha) && !self.given.x[alpha];
        let given: Vec<bool> = all.clone().map(|alpha| !loose(alpha)).collect();
        let kept: Vec<bool> = all
            .map(|alpha| given[alpha] || opening.exact_x[alpha])
            .collect();
        if kept != given
            && let Ok(x) = self.near(from.clone(), &kept)
        {
            return Ok(x);
        }
        self.near(from, &given)
    }

    /// Returns the x nearest to another one that satisfies the constraints and closes the loops, with the given entries
    /// fixed.
    fn near(&self, mut x: Vec<f64>, given: &[bool]) -> Result<Vec<f64>, Vec<StateProblem>> {
        let model = &self.generated.model;
        let free = given.contains(&false);
        self.restore(&mut x, |x, violations| match free {
            true => self.satisfied(x, given).ok_or(violations),
            false => Err(violations),
        })?;
        let closure = self.closure();
        let mut straight = x.clone();
        let mut closed = closure.close_loops(&mut straight, given);
        if free && model.constraints.iter().any(|row| row.is_holonomic()) {
            // Like the guesses of a description: nearest to its start, in the metric of M.
            let mass = self.mass(&x);
            let assembled = closure.assemble(&mut x, given, &mass);
            if assembled.is_ok() || closed.is_err() {
                closed = assembled;
                straight = x;
            }
        }
        closed.map_err(|open| vec![self.open(open)])?;
        self.on_manifold(&straight)?;
        Ok(straight)
    }

    /// ξ of the full frame.
    fn velocities(
        &self,
        mut opening: InitialConditions,
        x: &[f64],
        from: &State,
    ) -> Result<Vec<f64>, Vec<StateProblem>> {
        let (model, active) = (&self.generated.model, &self.generated.active);
        let closure = self.closure();
        let mass = |x: &[f64]| self.mass(x);
        opening.x = x.to_vec();
        let Err(first) = opening.settle(&closure, &mass) else {
            return Ok(opening.xi);
        };
        // Velocities tied to a violated constraint are released.
        let mut xi = model.start_xi.clone();
        if from.xi[..active.n()] != active.start_xi {
            xi.clone_from(&opening.xi);
        }
        let (b, rates) = self.rates(x, &opening.xi);
        let time = model.clock.map(|clock| clock.xi);
        let coupling = Coupling::new(b.iter().map(|row| {
            let moving = row.iter().enumerate();
            let moving = moving.filter(|(i, factor)| **factor != 0.0 && Some(*i) != time);
            moving.map(|(i, _)| i).collect()
        }));
        let tied =
            coupling.coupled_to(|row| rates[row].is_nan() || rates[row].abs() > RATE_TOLERANCE);
        let mut kept = vec![true; xi.len()];
        for (i, value) in self.given.xi.iter().enumerate() {
            match value {
                Some(value) => xi[i] = *value,
                None if tied.contains(&i) => kept[i] = false,
                None => xi[i] = opening.xi[i],
            }
        }
        closure.settle(x, &mut xi, &kept).map_err(|open| {
            let residual = match open.residual.is_nan() {
                true => first.residual,
                false => open.residual,
            };
            let message = format!(
                "violates {} by {residual:.2e}, and no choice of the velocities that are not given satisfies it",
                self.text(open)
            );
            vec![StateProblem::new("velocity", message)]
        })?;
        Ok(xi)
    }

    /// Restores x to the manifold by `mend` if its distance exceeds the rounding of written numbers.
    fn restore(
        &self,
        x: &mut Vec<f64>,
        mend: impl FnOnce(&[f64], Vec<StateProblem>) -> Result<Vec<f64>, Vec<StateProblem>>,
    ) -> Result<(), Vec<StateProblem>> {
        let active = &self.generated.active;
        let state = self.with(x);
        let mut residuals = state.residuals(active);
        let violations = state.violations(active, &residuals);
        if !violations.is_empty() {
            *x = mend(x, violations)?;
            residuals = self.with(x).residuals(active);
        }
        if residuals.iter().any(|size| size.abs() > EXACT_RESIDUAL) {
            normalise(&active.blocks, x);
        }
        Ok(())
    }

    /// Checks the constraints other than loops, which steps along the loops may violate.
    fn on_manifold(&self, x: &[f64]) -> Result<(), Vec<StateProblem>> {
        let active = &self.generated.active;
        let state = self.with(x);
        let violations = state.violations(active, &state.residuals(active));
        match violations.is_empty() {
            true => Ok(()),
            false => Err(violations),
        }
    }

    fn with(&self, x: &[f64]) -> State {
        State {
            x: x.to_vec(),
            ..self.state.clone()
        }
    }

    fn closure(&self) -> LoopClosure<'_> {
        let closure = LoopClosure::of(&self.generated.model, &self.state.params);
        closure.with_inputs(&self.state.u)
    }

    /// Returns the coordinates tied to one another by equations that x violates.
    fn tied(&self, x: &[f64]) -> std::collections::BTreeSet<usize> {
        let model = &self.generated.model;
        let numbers = self.numbers(x);
        let places = (model.points.first, model.nu());
        let time = model.clock.map(|clock| clock.x);
        let holonomic = model.constraints.iter().filter(|row| row.is_holonomic());
        let loops: Vec<Edge> = holonomic.map(|row| row.residual).collect();
        let phi: Vec<Edge> = model.phi.iter().map(|(edge, _)| *edge).collect();
        let free = &model.points.free;
        let all = model.points.places();
        let mut open = relative_residuals(&model.graph, &loops, &numbers, all.clone());
        open.extend(relative_residuals(free, &phi, &numbers, all));
        let loops = loops
            .iter()
            .map(|&edge| symbols(&model.graph, edge, places, time));
        let phi = phi.iter().map(|&edge| symbols(free, edge, places, time));
        let coupling = Coupling::new(loops.chain(phi));
        coupling.coupled_to(|row| open[row].is_nan() || open[row].abs() > EXACT_RESIDUAL)
    }

    /// Returns the rows of B, and their residuals relative to 1 or their terms.
    fn rates(&self, x: &[f64], xi: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let model = &self.generated.model;
        let numbers = self.numbers(x);
        let row = |edges: &[Edge]| evaluate(&model.graph, edges, &numbers);
        let rows = model.constraints.iter().map(|constraint| {
            let b = row(&constraint.row);
            let shift = row(&[constraint.shift])[0];
            let terms = || b.iter().zip(xi).map(|(b, v)| b * v);
            let size = terms().fold(shift.abs().max(1.0), |sum, term| sum + term.abs());
            let rate = (terms().sum::<f64>() + shift) / size;
            (b, rate)
        });
        rows.unzip()
    }

    fn numbers(&self, x: &[f64]) -> Vec<f64> {
        let model = &self.generated.model;
        let still = vec![0.0; model.n()];
        model.numbers(&self.state.params, x, &still, &self.state.u, &still)
    }

    /// Returns the nearest x that satisfies the description's constraints, with the given entries fixed.
    fn satisfied(&self, x: &[f64], given: &[bool]) -> Option<Vec<f64>> {
        let full = &self.generated.model;
        let numbers = self.numbers(x);
        let kept = |alpha: &usize| given[*alpha];
        let problem = Constraints {
            graph: &full.points.free,
            phi: full.phi.iter().map(|(edge, _)| *edge).collect(),
            first: full.points.first,
            numbers: &numbers,
            blocks: &full.blocks,
            guess: x,
            given: (0..given.len()).filter(kept).collect(),
            sizes: Vec::new(),
        }
        .measured();
        let mut found = find_nearest(&problem, x)?;
        for &alpha in &problem.given {
            found[alpha] = x[alpha];
        }
        Some(found)
    }

    /// M of the full frame.
    fn mass(&self, x: &[f64]) -> Vec<Vec<f64>> {
        let full = &self.generated.model;
        let first = 1 + self.state.params.len();
        let moving = KinematicExpressions {
            graph: &full.graph,
            a: &full.a,
            first,
            velocity: first + full.nu(),
            n: full.n(),
        };
        let inertia = (&full.bodies[..], &full.particles[..], full.kinetic);
        moving.mass(&full.frames, inertia, &self.numbers(x))
    }

    fn open(&self, open: Open) -> StateProblem {
        let message = format!(
            "this configuration leaves {} open by {:.2e}, and no choice of the coordinates that are not given closes it",
            self.text(open),
            open.residual
        );
        StateProblem::new("coord", message)
    }

    /// Returns a constraint as written.
    fn text(&self, open: Open) -> String {
        let number = open.constraint + 1;
        match self.generated.model.constraints.get(open.constraint) {
            Some(row) if row.kind == Kind::Inactive => format!("`inactive {}`", row.written),
            Some(row) => format!("`{}`", row.written),
            None => format!("constraint {number} on the velocities"),
        }
    }
}
