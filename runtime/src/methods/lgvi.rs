//! The discrete rotor of Moser and Veselov as a Lie group variational integrator.
//!
//! h (P + (h/2) τ)^ = F J_d − J_d Fᵀ with J_d = (tr J/2) I − J; R₁ = R F, P₁ = Fᵀ(P + (h/2) τ) + (h/2) τ₁. With
//! F = cay(f) = I + 2/(1+f·f) (f̂ + f̂²) this becomes (1 + f·f)/2 a = J f + f × J f, a = h (P + (h/2) τ), which is
//! solved by Newton's method. Sources: J. Moser, A. Veselov, Commun. Math. Phys. 139 (1991) 217; T. Lee, M. Leok, N. H.
//! McClamroch, Comput. Methods Appl. Mech. Eng. 196 (2007) 2907.

use core::array::from_fn;

use crate::error::StepError;
use crate::flows::Attitude;
use crate::methods::Method;
use crate::methods::phase::{Drift, strang};
use crate::rotor::Rotor;
use crate::scalar::{Scalar, epsilon};
use crate::so3::{self, Matrix, Vector};
use crate::split::Split;
use crate::state::State;

/// Lie group variational integrator: order 2, one evaluation of the forces per step of a run; symplectic; conserves R P
/// and the energy of a free body.
///
/// A steady spin has a phase error of order (h|ω|)², so splitting methods are more accurate; this method is the
/// variational reference. Beyond h|ω| of about 1.5 the equation for f has no solution, and the step returns
/// [`StepError::NotConverged`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lgvi;

/// Largest number of Newton iterations; three or four are usual.
const ITERATIONS: u32 = 20;

impl<Sys: Split + ?Sized> Method<Sys> for Lgvi {
    fn order(&self) -> u32 {
        2
    }

    #[inline]
    fn preserves_constraints(&self) -> bool {
        true
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
        strang(system, state, h, self, inputs, force)?.ok_or(StepError::NotConverged {
            time: state.t,
            iterations: ITERATIONS,
        })
    }
}

impl Drift for Lgvi {
    #[inline]
    fn turn<S: Scalar, A: Attitude<S>>(
        &self,
        rotor: &Rotor<S>,
        attitude: A,
        p: &mut Vector<S>,
        h: S,
    ) -> Option<A> {
        let own = rotor.to_principal(*p);
        let f = solve(rotor.moments, own.map(|p| h * p))?;
        let f = rotor.to_body(f);
        *p = turned_back(f, *p);
        Some(attitude.turned_by_cayley(f))
    }
}

/// Returns cay(f)ᵀ p = p − 2/(1+f·f) (f × p − f × (f × p)).
#[inline]
fn turned_back<S: Scalar>(f: Vector<S>, p: Vector<S>) -> Vector<S> {
    let factor = S::from_f64(2.0) / (S::from_f64(1.0) + so3::dot(f, f));
    let once = so3::cross(f, p);
    let twice = so3::cross(f, once);
    from_fn(|i| p[i] + factor * (twice[i] - once[i]))
}

/// Solves (1 + f·f)/2 a = J f + f × J f for f; `None` if not all lanes converge.
///
/// The initial value is one fixed-point step from f₀ = J⁻¹ a/2, J f₁ = (1 + f₀·f₀)/2 a − f₀ × J f₀, which saves one
/// Newton iteration.
#[inline]
fn solve<S: Scalar>(j: Vector<S>, a: Vector<S>) -> Option<Vector<S>> {
    let (half, one) = (S::from_f64(0.5), S::from_f64(1.0));
    let epsilon = epsilon::<S>();
    let inverse = j.map(|j| one / j);
    let moved: Vector<S> = a.map(|a| half * a);
    let first: Vector<S> = from_fn(|i| inverse[i] * moved[i]);
    let (more, across) = (so3::dot(first, first), so3::cross(first, moved));
    let mut f: Vector<S> = from_fn(|i| inverse[i] * (more.mul_add(moved[i], moved[i]) - across[i]));
    for _ in 0..ITERATIONS {
        let jf: Vector<S> = from_fn(|i| j[i] * f[i]);
        let fjf = so3::cross(f, jf);
        let factor = half * (one + so3::dot(f, f));
        let residual: Vector<S> = from_fn(|i| (-factor).mul_add(a[i], jf[i] + fjf[i]));
        // Minus the Jacobian of the residual: a fᵀ − J + (J f)^ − f̂ J.
        let (hat_jf, hat_f) = (so3::hat(jf), so3::hat(f));
        let slope: Matrix<S> = from_fn(|k| {
            let (row, column) = (k / 3, k % 3);
            let own = if row == column { j[row] } else { S::default() };
            let turned = hat_jf[k] - hat_f[k] * j[column];
            a[row].mul_add(f[column], turned - own)
        });
        let change = cramer(slope, residual);
        f = from_fn(|i| f[i] + change[i]);
        // Newton's method squares the error: after a change of √ε, the remaining error is below rounding.
        let limit = epsilon * (so3::dot(f, f) + epsilon * epsilon);
        if (limit - so3::dot(change, change)).is_positive() {
            return Some(f);
        }
    }
    None
}

/// Solves M v = b by cross products of the rows of M (Cramer's rule).
#[inline]
fn cramer<S: Scalar>(m: Matrix<S>, b: Vector<S>) -> Vector<S> {
    let [m0, m1, m2]: [Vector<S>; 3] = from_fn(|row| from_fn(|column| m[3 * row + column]));
    let columns = [so3::cross(m1, m2), so3::cross(m2, m0), so3::cross(m0, m1)];
    let inverse = S::from_f64(1.0) / so3::dot(m0, columns[0]);
    from_fn(|i| inverse * so3::dot(columns.map(|column| column[i]), b))
}
