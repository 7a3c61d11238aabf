//! Positions and momenta of a system that splits, and the two motions, kick and drift, that methods compose.

use crate::error::StepError;
use crate::flows::{Attitude, Flow};
use crate::manifold;
use crate::rotor::Rotor;
use crate::s1;
use crate::scalar::Scalar;
use crate::so3::Vector;
use crate::split::Split;
use crate::state::State;
use crate::store::add_scaled;
use crate::system::Block;

/// The free motion of one rotor: [`Flow`], or the approximation that defines a method.
pub(crate) trait Drift {
    /// Returns the attitude after the time `h` and updates P; `None` if an iteration does not converge.
    fn turn<S: Scalar, A: Attitude<S>>(
        &self,
        rotor: &Rotor<S>,
        attitude: A,
        p: &mut Vector<S>,
        h: S,
    ) -> Option<A>;
}

impl Drift for Flow {
    #[inline(always)]
    fn turn<S: Scalar, A: Attitude<S>>(
        &self,
        rotor: &Rotor<S>,
        attitude: A,
        p: &mut Vector<S>,
        h: S,
    ) -> Option<A> {
        Some(Self::turn(*self, rotor, attitude, p, h))
    }
}

/// Centred coordinates y and momenta p of [`Split`], during one step.
pub(crate) struct Phase<'s, Sys: Split + ?Sized> {
    system: &'s Sys,
    rotors: Sys::Rotors,
    /// Time at the start of the step.
    start: f64,
    /// Time since the start of the step.
    elapsed: f64,
    y: Sys::Coordinates,
    pub(crate) p: Sys::Chart,
}

impl<'s, Sys: Split + ?Sized> Phase<'s, Sys> {
    #[inline(always)]
    pub(crate) fn new(system: &'s Sys, state: &State<Sys>) -> Result<Self, StepError> {
        state.check_shape(system)?;
        Ok(Self {
            system,
            rotors: system.rotors(),
            start: state.t,
            elapsed: 0.0,
            y: system.centre(&state.x),
            p: system.split_momenta(&state.x, &state.xi),
        })
    }

    /// Returns ṗ due to the forces, with the inputs at the current time.
    #[inline(always)]
    pub(crate) fn force<U>(&self, inputs: &U) -> Sys::Chart
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let x = self.system.uncentre(&self.y);
        let xi = self.system.split_velocities(&x, &self.p);
        let u = inputs(self.start + self.elapsed, &x, &xi);
        self.system.kick(&x, &u)
    }

    /// Applies a kick, p ← p + h ṗ, for a known force.
    #[inline(always)]
    pub(crate) fn push(&mut self, h: f64, force: &Sys::Chart) {
        add_scaled(self.p.as_mut(), h, force.as_ref());
    }

    /// Applies free motion for the time `h`; returns `None` if an iteration does not converge.
    #[inline(always)]
    pub(crate) fn drift<D: Drift>(&mut self, h: f64, drift: &D) -> Option<()> {
        let time = Sys::Scalar::from_f64(h);
        let mut rotors = self.rotors.as_ref().iter();
        let (mut y, mut p) = (self.y.as_mut(), self.p.as_mut());
        for block in self.system.blocks() {
            let (Some((here, y_rest)), Some((along, p_rest))) = (
                y.split_at_mut_checked(block.coordinates()),
                p.split_at_mut_checked(block.chart()),
            ) else {
                break;
            };
            match block {
                Block::Flat(_) => add_scaled(here, h, along),
                Block::Circle => {
                    if let (Some(point), [rate]) = (here.first_chunk_mut(), along) {
                        *point = s1::retract(*point, time * *rate);
                    }
                }
                Block::Quaternion => {
                    if let (Some(q), Some(p), Some(rotor)) = (
                        here.first_chunk_mut(),
                        along.first_chunk_mut(),
                        rotors.next(),
                    ) {
                        *q = drift.turn::<_, [Sys::Scalar; 4]>(rotor, *q, p, time)?;
                    }
                }
                Block::Rotation => {
                    if let (Some(r), Some(p), Some(rotor)) = (
                        here.first_chunk_mut(),
                        along.first_chunk_mut(),
                        rotors.next(),
                    ) {
                        *r = drift.turn::<_, [Sys::Scalar; 9]>(rotor, *r, p, time)?;
                    }
                }
            }
            (y, p) = (y_rest, p_rest);
        }
        self.elapsed += h;
        Some(())
    }

    /// Normalises y at the end of a step, to remove the drift off the manifold that rounding causes.
    #[inline(always)]
    pub(crate) fn arrive(&mut self) {
        manifold::normalise(self.system.blocks(), self.y.as_mut());
    }

    /// Returns the state after a step of length `h`, once [`arrive`](Self::arrive) has normalised y.
    #[inline(always)]
    pub(crate) fn state(&self, h: f64) -> Result<State<Sys>, StepError> {
        let x = self.system.uncentre(&self.y);
        let xi = self.system.split_velocities(&x, &self.p);
        let t = self.start + h;
        let next = State { t, x, xi };
        if next.is_finite() {
            Ok(next)
        } else {
            Err(StepError::NonFinite { time: self.start })
        }
    }
}

/// Makes a Strang step: a kick of h/2, free motion, a kick of h/2. Order 2, symmetric, and symplectic if the free
/// motion is. `force` is that of [`Method::step_reusing_force`](crate::Method::step_reusing_force). Returns `None` if the free motion does not
/// converge.
#[inline(always)]
pub(crate) fn strang<Sys, D, U>(
    system: &Sys,
    state: &State<Sys>,
    h: f64,
    drift: &D,
    inputs: &U,
    force: &mut Option<Sys::Chart>,
) -> Result<Option<State<Sys>>, StepError>
where
    Sys: Split + ?Sized,
    D: Drift,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    let mut phase = Phase::new(system, state)?;
    let first = force.take().unwrap_or_else(|| phase.force(inputs));
    phase.push(0.5 * h, &first);
    if phase.drift(h, drift).is_none() {
        return Ok(None);
    }
    phase.arrive();
    let last = phase.force(inputs);
    phase.push(0.5 * h, &last);
    let next = phase.state(h)?;
    *force = Some(last);
    Ok(Some(next))
}
