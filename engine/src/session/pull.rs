//! A mechanism that is pulled by one of its points, as by hand: it moves along its own velocities, as far as they let it.
//!
//! A picture does not show depth: whoever drags in one means the line of sight through a place, and only the distance from that line
//! counts. With p(x) the point and J its slopes along δx = A h, each round moves by h = Jᵀ (J Jᵀ + λ² I)⁻¹ (target − p), where
//! λ keeps h small near singular positions. Directions that constraints do not allow are projected out, so that loops
//! stay closed and wheels roll. Slopes are differences, whose digits suffice for what is dragged by hand.

use super::Session;
use crate::drawing::{Drawn, Scene, Vector};
use crate::error::Error;
use crate::mechanism::{Instance, Numbers};
use crate::state::State;
use hamel::{System, manifold};
use nalgebra::{Matrix3, Vector3};

/// Rounds of one pull.
const ROUNDS: usize = 6;
/// The step of differences, in units of velocity times time.
const STEP: f64 = 1e-6;
/// The longest move of a round, in the same units: a third of a turn about a joint.
const FAR: f64 = 2.0;
/// λ² over the mean square of the slopes.
const DAMPED: f64 = 1e-4;
/// How far constraints may be off after a move.
const CLOSED: f64 = 1e-10;

/// A point by which a mechanism is pulled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// A point of a frame, by the place of the frame in [`Scene::frames`], in its axes (m).
    Frame(usize, Vector),
    /// A particle, by its place in [`Scene::particles`].
    Particle(usize),
}

impl Grip {
    /// Where it is.
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
    /// The state that is reached where a mechanism is pulled by a point towards a place in the world (m), as near as its
    /// joints, loops and constraints let it come; with a line of sight, as near to the line through the place along it. Its
    /// velocities are kept where constraints let them be.
    ///
    /// # Errors
    /// Where there is no such point, and where the kinematics are singular.
    pub fn pulled(
        &self,
        state: &State,
        grip: Grip,
        (target, sight): (Vector, Option<Vector>),
    ) -> Result<State, Error> {
        let drawn = self.drawing()?.with(&state.params);
        let instance = self.instance(state)?;
        let n = self.active().n();
        let mut pulled = Pulled {
            instance: &instance,
            drawn,
            grip,
            seen: seen(sight),
            x: Numbers::from(state.x.as_slice()),
        };
        let target = Vector3::from(target);
        for _ in 0..ROUNDS {
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

/// A mechanism on its way.
struct Pulled<'a> {
    instance: &'a Instance,
    drawn: Drawn<'a>,
    grip: Grip,
    /// The projection along the line of sight.
    seen: Matrix3<f64>,
    x: Numbers,
}

impl Pulled<'_> {
    /// Moves once; whether that brought the point nearer.
    fn round(&mut self, n: usize, target: Vector3<f64>) -> Result<bool, Error> {
        let from = self.point(&self.x)?;
        let away = self.seen * (target - from);
        let directions: Result<Vec<Numbers>, Error> = (0..n).map(|i| self.direction(i)).collect();
        let directions = directions?;
        let slope = |direction: &Numbers| -> Result<Vector3<f64>, Error> {
            let there = self.point(&self.moved(&self.x, direction, STEP))?;
            Ok(self.seen * (there - from) / STEP)
        };
        let slopes: Result<Vec<Vector3<f64>>, Error> = directions.iter().map(slope).collect();
        let slopes = slopes?;
        let squares: Matrix3<f64> = slopes.iter().map(|slope| slope * slope.transpose()).sum();
        let damping = DAMPED * squares.trace() / 3.0;
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
        let mut share = (FAR / length).min(1.0);
        for _ in 0..ROUNDS {
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

    /// What constraints leave of the velocity ξⁱ = 1.
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
        // Of velocities that are given only what can be chosen is left.
        let entries = kept.as_mut().iter_mut().zip(drift.iter());
        entries.for_each(|(entry, drift)| *entry -= drift);
        Ok(kept)
    }

    /// x moved along A h.
    fn moved(&self, x: &Numbers, h: &Numbers, share: f64) -> Numbers {
        let mut chart = self.instance.chart_rate(x, h);
        // A alone: where the time is a coordinate, rates have terms without ξ.
        let still = self
            .instance
            .chart_rate(x, &self.instance.zero_velocities());
        let entries = chart.as_mut().iter_mut().zip(still.iter());
        entries.for_each(|(entry, still)| *entry = share * (*entry - still));
        let mut next = x.clone();
        manifold::retract(self.instance.blocks(), next.as_mut(), &chart);
        next
    }

    /// x back on its constraints, by Newton's method; none where that leads nowhere.
    fn closed(&self, x: Numbers) -> Option<Numbers> {
        let mut x = x;
        for _ in 0..2 * ROUNDS {
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
            if open < CLOSED && self.instance.constraint_norm(&x) < CLOSED {
                return Some(x);
            }
        }
        None
    }
}

/// The projection along a line of sight; without one everything is seen.
fn seen(sight: Option<Vector>) -> Matrix3<f64> {
    let sight = sight.and_then(|sight| Vector3::from(sight).try_normalize(0.0));
    sight.map_or_else(Matrix3::identity, |sight| {
        Matrix3::identity() - sight * sight.transpose()
    })
}
