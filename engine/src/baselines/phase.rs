//! Positions and momenta of a split system during a step of Buss' methods.

use super::angular_momentum::Buss;
use super::step::add_scaled;
use hamel::{Block, Scalar, Split, State, StepError, manifold, s1};

/// Centred coordinates y and momenta p of [`Split`] during one step.
pub(super) struct Phase<'s, Sys: Split + ?Sized> {
    system: &'s Sys,
    rotors: Sys::Rotors,
    /// Start of the step.
    start: f64,
    /// Time since then.
    elapsed: f64,
    y: Sys::Coordinates,
    p: Sys::Chart,
}

impl<'s, Sys: Split + ?Sized> Phase<'s, Sys> {
    #[inline(always)]
    pub(super) fn new(system: &'s Sys, state: &State<Sys>) -> Result<Self, StepError> {
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

    /// Returns ṗ from the forces, with the inputs at this time.
    #[inline(always)]
    pub(super) fn force<U>(&self, inputs: &U) -> Sys::Chart
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let x = self.system.uncentre(&self.y);
        let xi = self.system.split_velocities(&x, &self.p);
        let u = inputs(self.start + self.elapsed, &x, &xi);
        self.system.kick(&x, &u)
    }

    /// p ← p + h ṗ
    #[inline(always)]
    pub(super) fn kick<U>(&mut self, h: f64, inputs: &U)
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let force = self.force(inputs);
        self.push(h, &force);
    }

    /// p ← p + h ṗ for a known force.
    #[inline(always)]
    pub(super) fn push(&mut self, h: f64, force: &Sys::Chart) {
        add_scaled(self.p.as_mut(), Sys::Scalar::from_f64(h), force.as_ref());
    }

    /// Moves without forces for the time `h`, rotors by a method of Buss.
    #[inline(always)]
    pub(super) fn drift(&mut self, h: f64, method: Buss) {
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
                Block::Flat(_) => add_scaled(here, time, along),
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
                        *q = method.turn::<_, [Sys::Scalar; 4]>(rotor, *q, p, time);
                    }
                }
                Block::Rotation => {
                    if let (Some(r), Some(p), Some(rotor)) = (
                        here.first_chunk_mut(),
                        along.first_chunk_mut(),
                        rotors.next(),
                    ) {
                        *r = method.turn::<_, [Sys::Scalar; 9]>(rotor, *r, p, time);
                    }
                }
            }
            (y, p) = (y_rest, p_rest);
        }
        self.elapsed += h;
    }

    /// Removes rounding errors at the end of a step by normalising the coordinates.
    #[inline(always)]
    pub(super) fn arrive(&mut self) {
        manifold::normalise(self.system.blocks(), self.y.as_mut());
    }

    /// Returns the normalised state after a step of length `h`.
    #[inline(always)]
    pub(super) fn state(&self, h: f64) -> Result<State<Sys>, StepError> {
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

/// Takes a step: a kick of h/2, motion without forces, a kick of h/2. Order 2. `force` has the meaning of
/// [`Method::step_reusing_force`](hamel::Method::step_reusing_force).
#[inline(always)]
pub(super) fn strang<Sys, U>(
    system: &Sys,
    state: &State<Sys>,
    h: f64,
    method: Buss,
    inputs: &U,
    force: &mut Option<Sys::Chart>,
) -> Result<State<Sys>, StepError>
where
    Sys: Split + ?Sized,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    let mut phase = Phase::new(system, state)?;
    let first = force.take().unwrap_or_else(|| phase.force(inputs));
    phase.push(0.5 * h, &first);
    phase.drift(h, method);
    phase.arrive();
    let last = phase.force(inputs);
    phase.push(0.5 * h, &last);
    let next = phase.state(h)?;
    *force = Some(last);
    Ok(next)
}
