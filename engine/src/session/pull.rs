//! Pulls a mechanism by one of its points, as by hand: it moves along its velocities, within its constraints.
//!
//! A picture does not show depth: dragging in it specifies the line of sight through a place, and only the distance
//! from that line counts. With p(x) the point and J its derivative along δx = A h, each round moves by h = Jᵀ (J Jᵀ +
//! λ² I)⁻¹ (target − p), where λ keeps h small near singular positions. Directions that violate constraints are
//! projected out, so that loops stay closed and wheels roll. Derivatives are finite differences, whose accuracy
//! suffices for dragging by hand.

use super::Session;
use crate::drawing::{ParametrizedDrawing, Scene, Vector};
use crate::error::Error;
use crate::mechanism::{Instance, Numbers};
use crate::state::State;
use hamel::{System, manifold};
use nalgebra::{Matrix3, Vector3};

/// Largest number of moves of one pull, and of reductions of one move.
const MAX_ROUNDS: usize = 6;
/// Step of the finite differences, in units of velocity times time.
const DIFFERENCE_STEP: f64 = 1e-6;
/// The longest move of a round, in the same units: a third of a turn about a joint.
const MAX_MOVE: f64 = 2.0;
/// λ² relative to the mean square of the derivatives.
const RELATIVE_DAMPING: f64 = 1e-4;
/// Largest residual of constraints after a move.
const CONSTRAINT_TOLERANCE: f64 = 1e-10;

/// Point by which a mechanism is pulled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// A point of a frame, by the index of the frame in [`Scene::frames`], in its axes (m).
    Frame(usize, Vector),
    /// A particle, by its index in [`Scene::particles`].
    Particle(usize),
}

impl Grip {
    /// Returns the position of the point.
    fn of(self, scene: &Scene) -> Option<Vector3<f64>> {
        match self {
            Grip::Frame(frame, at) => {
                let frame = scene.frames.get(frame)?;
                Some(Vector3::from(frame.point(at)))
            }
            Grip::Particle(place) => {
                let particle = scene.particles.get(place)?;
                Some(Vector3::from(particle.position))
            }
        }
    }
}

impl Session {
    /// Returns the state reached when the mechanism is pulled by a point towards a place in the world (m), as near as
    /// its joints, loops and constraints permit; with a line of sight, as near to that line through the place.
    /// Velocities are kept as far as constraints permit.
    ///
    /// # Errors
    /// There is no such point, or the kinematics are singular.
    pub fn pull(
        &self,
        state: &State,
        grip: Grip,
        (target, sight): (Vector, Option<Vector>),
    ) -> Result<State, Error> {
        let drawn = self.drawing()?.with_parameters(&state.params);
        let instance = self.instance(state)?;
        let n = self.active().n();
        let mut pulled = Pull {
            instance: &instance,
            drawn,
            grip,
            seen: seen(sight),
            x: Numbers::from(state.x.as_slice()),
        };
        let target = Vector3::from(target);
        for _ in 0..MAX_ROUNDS {
            if !pulled.round(n, target)? {
                break;
            }
        }
        let xi = Numbers::from(state.xi.as_slice());
        let kept = instance.project_velocity(&pulled.x, &xi);
        let kept = kept.map_err(|_| Error::SingularPull)?.unwrap_or(xi);
        Ok(State {
            x: pulled.x.to_vec(),
            xi: kept.to_vec(),
            ..state.clone()
        })
    }
}

/// Mechanism while it is pulled.
struct Pull<'a> {
    instance: &'a Instance,
    drawn: ParametrizedDrawing<'a>,
    grip: Grip,
    /// The projection along the line of sight.
    seen: Matrix3<f64>,
    x: Numbers,
}

impl Pull<'_> {
    /// Moves the mechanism once; returns whether the point came nearer.
    fn round(&mut self, n: usize, target: Vector3<f64>) -> Result<bool, Error> {
        let from = self.point(&self.x)?;
        let away = self.seen * (target - from);
        let directions: Result<Vec<Numbers>, Error> = (0..n).map(|i| self.direction(i)).collect();
        let directions = directions?;
        let slope = |direction: &Numbers| -> Result<Vector3<f64>, Error> {
            let there = self.point(&self.moved(&self.x, direction, DIFFERENCE_STEP))?;
            Ok(self.seen * (there - from) / DIFFERENCE_STEP)
        };
        let slopes: Result<Vec<Vector3<f64>>, Error> = directions.iter().map(slope).collect();
        let slopes = slopes?;
        let squares: Matrix3<f64> = slopes.iter().map(|slope| slope * slope.transpose()).sum();
        let damping = RELATIVE_DAMPING * squares.trace() / 3.0;
        let inverse = (squares + Matrix3::identity() * damping).try_inverse();
        let Some(inverse) = inverse.filter(|_| damping > 0.0) else {
            return Ok(false);
        };
        let pull = inverse * away;
        let mut h = self.instance.zero_velocities();
        for (direction, slope) in directions.iter().zip(&slopes) {
            let part = slope.dot(&pull);
            let entries = h.as_mut().iter_mut().zip(direction.iter());
            entries.for_each(|(entry, direction)| *entry += part * direction);
        }
        let length = h.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
        let mut share = (MAX_MOVE / length).min(1.0);
        for _ in 0..MAX_ROUNDS {
            if let Some(next) = self.closed(self.moved(&self.x, &h, share))
                && (self.seen * (target - self.point(&next)?)).norm() < away.norm()
            {
                self.x = next;
                return Ok(true);
            }
            share /= 4.0;
        }
        Ok(false)
    }

    fn point(&self, x: &[f64]) -> Result<Vector3<f64>, Error> {
        let point = self.grip.of(&self.drawn.scene(x));
        point.ok_or(Error::NoSuchPoint)
    }

    /// Returns the projection of the velocity ξⁱ = 1 on the constraints.
    fn direction(&self, i: usize) -> Result<Numbers, Error> {
        let projected = |xi: &Numbers| -> Result<Option<Numbers>, Error> {
            let kept = self.instance.project_velocity(&self.x, xi);
            kept.map_err(|_| Error::SingularPull)
        };
        let still = self.instance.zero_velocities();
        let mut unit = still.clone();
        unit.as_mut()[i] = 1.0;
        let (Some(mut kept), Some(drift)) = (projected(&unit)?, projected(&still)?) else {
            return Ok(unit);
        };
        // Remove the prescribed velocities.
        let entries = kept.as_mut().iter_mut().zip(drift.iter());
        entries.for_each(|(entry, drift)| *entry -= drift);
        Ok(kept)
    }

    /// Moves x along A h.
    fn moved(&self, x: &Numbers, h: &Numbers, share: f64) -> Numbers {
        let mut chart = self.instance.chart_rate(x, h);
        // Use A alone: if time is a coordinate, rates have terms without ξ.
        let still = self
            .instance
            .chart_rate(x, &self.instance.zero_velocities());
        let entries = chart.as_mut().iter_mut().zip(still.iter());
        entries.for_each(|(entry, still)| *entry = share * (*entry - still));
        let mut next = x.clone();
        manifold::retract(self.instance.blocks(), next.as_mut(), &chart);
        next
    }

    /// Restores the constraints by Newton's method; `None` if it does not converge.
    fn closed(&self, x: Numbers) -> Option<Numbers> {
        let mut x = x;
        for _ in 0..2 * MAX_ROUNDS {
            let correction = self.instance.correction(&x);
            let entries = x.as_mut().iter_mut().zip(correction.iter());
            entries.for_each(|(entry, change)| *entry += change);
            manifold::normalise(self.instance.blocks(), x.as_mut());
            let step = self.instance.project_position(&x).ok()?;
            let open = step.as_ref().map_or(0.0, |step| {
                step.iter()
                    .fold(0.0, |most: f64, entry| most.max(entry.abs()))
            });
            if let Some(step) = step {
                x = self.moved(&x, &step, 1.0);
            }
            if open < CONSTRAINT_TOLERANCE
                && self.instance.constraint_norm(&x) < CONSTRAINT_TOLERANCE
            {
                return Some(x);
            }
        }
        None
    }
}

/// Returns the projection along a line of sight; the identity without one.
fn seen(sight: Option<Vector>) -> Matrix3<f64> {
    let sight = sight.and_then(|sight| Vector3::from(sight).try_normalize(0.0));
    sight.map_or_else(Matrix3::identity, |sight| {
        Matrix3::identity() - sight * sight.transpose()
    })
}
