//! What a state does not give follows from what it gives: loops are closed, constraints on velocities
//! kept, unit quaternions and rotations cleared of rounding.

use super::State;
use hamel_codegen::generate::Generated;
use hamel_codegen::model::Model;
use hamel_codegen::model::assembly::nearest;
use hamel_codegen::model::closest::Constraints;
use hamel_codegen::model::closure::{Closure, Open, normalise};
use hamel_codegen::model::twists::Moving;

/// Smaller values of |φ(x)| are left as they are.
const EXACT: f64 = 1e-12;

impl State {
    /// Completes a state whose entries of x and ξ are given or not; what contradicts the description is
    /// refused, with the residual.
    pub(super) fn complete(
        &mut self,
        generated: &Generated,
        given_x: &[bool],
        given_xi: &[bool],
    ) -> Result<(), Vec<String>> {
        let (full, active) = (&generated.model, &generated.active);
        let none = |errors: Vec<String>| match errors.is_empty() {
            true => Ok(()),
            false => Err(errors),
        };
        let mut residuals = self.residuals(active);
        let violations = self.violations(active, &residuals);
        let mut moved = !violations.is_empty();
        if moved && !given_x.iter().all(|given| *given) {
            self.x = self.satisfied(full, given_x).ok_or(violations)?;
            residuals = self.residuals(active);
        } else {
            none(violations)?;
        }
        if residuals.iter().any(|size| size.abs() > EXACT) {
            normalise(&active.blocks, &mut self.x);
            moved = true;
        }
        let mut x = self.x.clone();
        let closure = Closure::of(full, &self.params).with_inputs(&self.u);
        let mut closed = closure.close_loops(&mut x, given_x);
        if full.constraints.iter().any(|row| row.is_holonomic()) && !given_x.iter().all(|g| *g) {
            // As the guesses of a description: nearest to its start, in the metric of M.
            let (mut near, mass) = (self.x.clone(), self.mass(full));
            let assembled = closure.assemble(&mut near, given_x, &mass);
            if assembled.is_ok() || closed.is_err() {
                closed = assembled;
                x = near;
            }
        }
        closed.map_err(|open| {
            vec![format!(
                "coord: this configuration leaves {} open by {:.2e}, and no change of coordinates that are not given closes it",
                text(full, open),
                open.residual
            )]
        })?;
        moved |= self.x != x;
        self.x = x;
        // Steps along the loops may leave constraints that are no loops; what has not moved was looked at.
        if moved {
            none(self.violations(active, &self.residuals(active)))?;
        }
        let mut xi = self.xi[..active.n()].to_vec();
        let settled = Closure::of(active, &self.params)
            .with_inputs(&self.u)
            .settle(&self.x, &mut xi, given_xi);
        settled.map_err(|open| {
            vec![format!(
                "velocity: violates {} by {:.2e}, and no change of velocities that are not given keeps it",
                text(active, open),
                open.residual
            )]
        })?;
        self.xi[..xi.len()].copy_from_slice(&xi);
        Ok(())
    }
}

impl State {
    /// The nearest x that satisfies the description's constraints, where what is given stays.
    fn satisfied(&self, full: &Model, given: &[bool]) -> Option<Vec<f64>> {
        let still = vec![0.0; full.n()];
        let numbers = full.numbers(&self.params, &self.x, &still, &self.u, &still);
        let kept = |alpha: &usize| given[*alpha];
        let problem = Constraints {
            graph: &full.points.free,
            phi: full.phi.iter().map(|(edge, _)| *edge).collect(),
            first: full.points.first,
            numbers: &numbers,
            blocks: &full.blocks,
            guess: &self.x,
            given: (0..given.len()).filter(kept).collect(),
        };
        let mut found = nearest(&problem, &self.x)?;
        for &alpha in &problem.given {
            found[alpha] = self.x[alpha];
        }
        Some(found)
    }

    /// M of the full frame.
    fn mass(&self, full: &Model) -> Vec<Vec<f64>> {
        let first = 1 + self.params.len();
        let moving = Moving {
            graph: &full.graph,
            a: &full.a,
            first,
            velocity: first + full.nu(),
            n: full.n(),
        };
        let still = vec![0.0; full.n()];
        let numbers = full.numbers(&self.params, &self.x, &still, &self.u, &still);
        let inertia = (&full.bodies[..], &full.particles[..], full.kinetic);
        moving.mass(&full.frames, inertia, &numbers)
    }
}

/// A constraint as it was written.
fn text(model: &Model, open: Open) -> String {
    let number = open.constraint + 1;
    match model.constraints.get(open.constraint) {
        Some(row) => format!("`{}`", row.written),
        None => format!("constraint {number} on the velocities"),
    }
}
