//! Methods that conserve the angular momentum in world axes: slide and Buss' methods.
//!
//! They rotate R by exp(θ) and P inversely, so that only torques change L = R P. None is symplectic: the energy drifts.
//! Source: S. R. Buss, J. Comput. Phys. 164 (2000) 377.

use super::phase::{Phase, strang};
use hamel::flows::Attitude;
use hamel::so3::{self, Vector};
use hamel::{Method, Rotor, Scalar, Split, State, StepError};
use std::array::from_fn;

/// The angular momentum method, R ← exp(h ω) R with ω of L, then L ← L + h τ: order 1, one evaluation
/// of forces a step.
///
/// |L| of a free body is exact, and the energy error of order 1: the body ends in a spin about its axis of
/// least inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Slide;

/// Buss' methods. With forces, the rotation is between two half kicks, which limits the order to 2.
///
/// In world derivatives at the start of the rotation, θ is the sum of h ω (first), h²/2 ω̇ (second), h³/12 ω̇ × ω
/// (augmented second), and h³/6 ω̈ + h⁴/24 (ω⃛ + ω̈ × ω) (fourth), up to the term of the method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Buss {
    /// θ up to h: order 1.
    First,
    /// θ up to h²: order 2.
    Second,
    /// θ up to h² with the commutator: order 2 with a smaller error.
    AugmentedSecond,
    /// θ up to h⁴: order 4 for free bodies.
    Fourth,
}

impl<Sys: Split + ?Sized> Method<Sys> for Slide {
    fn order(&self) -> u32 {
        1
    }

    #[inline]
    fn step<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let mut phase = Phase::new(system, state)?;
        phase.drift(h, Buss::First);
        phase.arrive();
        phase.kick(h, inputs);
        phase.state(h)
    }
}

impl<Sys: Split + ?Sized> Method<Sys> for Buss {
    fn order(&self) -> u32 {
        match self {
            Self::First => 1,
            Self::Fourth if Sys::FREE => 4,
            _ => 2,
        }
    }

    #[inline]
    fn step<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        self.step_reusing_force(system, state, h, inputs, &mut None)
    }

    #[inline]
    fn step_reusing_force<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
        force: &mut Option<Sys::Chart>,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        strang(system, state, h, *self, inputs, force)
    }
}

impl Buss {
    /// Returns the attitude after `h`, and P transformed with it.
    #[inline]
    pub(super) fn turn<S: Scalar, A: Attitude<S>>(
        self,
        rotor: &Rotor<S>,
        attitude: A,
        p: &mut Vector<S>,
        h: S,
    ) -> A {
        let theta = rotor.to_body(self.angle(rotor.moments, rotor.to_principal(*p), h));
        *p = so3::apply(so3::exp(theta.map(|component| -component)), *p);
        attitude.turned(theta)
    }

    /// Returns θ in body axes.
    ///
    /// Derivatives in the body: P' = P × ω, P'' = P' × ω + P × ω', P''' = P'' × ω + 2 P' × ω' + P × ω'';
    /// in the world: ω̇ = ω', ω̈ = ω'' + ω × ω', ω⃛ = ω''' + 2 ω × ω'' + ω × (ω × ω').
    #[inline]
    fn angle<S: Scalar>(self, j: Vector<S>, p: Vector<S>, h: S) -> Vector<S> {
        let cross = so3::cross::<S>;
        let rate = |p: Vector<S>| -> Vector<S> { from_fn(|i| p[i] / j[i]) };
        let sum = |terms: &[(f64, Vector<S>)]| -> Vector<S> {
            from_fn(|i| {
                terms.iter().fold(S::default(), |sum, (factor, term)| {
                    S::from_f64(*factor).mul_add(term[i], sum)
                })
            })
        };
        let with = |power: S, terms: &[(f64, Vector<S>)], theta: Vector<S>| -> Vector<S> {
            let terms = sum(terms);
            from_fn(|i| power.mul_add(terms[i], theta[i]))
        };
        let (h2, h3) = (h * h, h * h * h);

        let w = rate(p);
        let theta = with(h, &[(1.0, w)], [S::default(); 3]);
        if self == Self::First {
            return theta;
        }
        let p1 = cross(p, w);
        let w1 = rate(p1);
        let theta = with(h2, &[(0.5, w1)], theta);
        if self == Self::Second {
            return theta;
        }
        let theta = with(h3, &[(1.0 / 12.0, cross(w1, w))], theta);
        if self == Self::AugmentedSecond {
            return theta;
        }
        let p2 = sum(&[(1.0, cross(p1, w)), (1.0, cross(p, w1))]);
        let w2 = rate(p2);
        let p3 = sum(&[
            (1.0, cross(p2, w)),
            (2.0, cross(p1, w1)),
            (1.0, cross(p, w2)),
        ]);
        let second = sum(&[(1.0, w2), (1.0, cross(w, w1))]);
        let third = sum(&[
            (1.0, rate(p3)),
            (2.0, cross(w, w2)),
            (1.0, cross(w, cross(w, w1))),
        ]);
        let theta = with(h3, &[(1.0 / 6.0, second)], theta);
        let fourth = [(1.0 / 24.0, third), (1.0 / 24.0, cross(second, w))];
        with(h3 * h, &fourth, theta)
    }
}
