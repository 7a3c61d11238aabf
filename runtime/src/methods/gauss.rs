//! Gauss collocation on (x, p): symplectic methods for systems with M(x).
//!
//! Zᵢ = z + h Σⱼ aᵢⱼ kⱼ, Pᵢ = p + h Σⱼ aᵢⱼ ṗⱼ, and the step ends with the weights b. Within a step a rotation is R₀
//! times an unnormalised quaternion that starts at 1 and moves by ½ z ⊗ ω; a circle is treated likewise, with a plane
//! vector. The squares |z|² and |P|² and the energy of a free body are then quadratic invariants, which Gauss methods
//! conserve exactly. The stages are found by fixed-point iteration to rounding. Convergence is judged for each entry of
//! x and of p by itself, so that a large momentum does not hide the error of a small one. Sources: J. C. Butcher, Math.
//! Comput. 18 (1964) 50; E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical Integration* (2006), IV.2, VIII.6.

use core::array::from_fn;

use crate::canonical::Canonical;
use crate::error::StepError;
use crate::manifold;
use crate::methods::Method;
use crate::scalar::{Scalar, epsilon};
use crate::state::State;
use crate::store::{Store, add, add_scaled, is_finite, largest};
use crate::system::Block;
use crate::{s1, s3, so3};

/// Gauss collocation of order 4, two stages; symplectic. For systems that implement [`Canonical`].
///
/// The iteration converges if h times the rates is below about 2; otherwise the step returns
/// [`StepError::NotConverged`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gauss4;

/// Gauss collocation of order 6, three stages; symplectic, on (x, p), with a fixed-point iteration as in [`Gauss4`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gauss6;

/// Nodes, matrix and weights of a collocation method of N stages.
struct Tableau<const N: usize> {
    c: [f64; N],
    a: [[f64; N]; N],
    b: [f64; N],
}

/// The roots √3 and √15.
const ROOTS: (f64, f64) = (1.732_050_807_568_877_3, 3.872_983_346_207_417);

const TWO_STAGES: Tableau<2> = Tableau {
    c: [0.5 - ROOTS.0 / 6.0, 0.5 + ROOTS.0 / 6.0],
    a: [[0.25, 0.25 - ROOTS.0 / 6.0], [0.25 + ROOTS.0 / 6.0, 0.25]],
    b: [0.5, 0.5],
};

const THREE_STAGES: Tableau<3> = Tableau {
    c: [0.5 - ROOTS.1 / 10.0, 0.5, 0.5 + ROOTS.1 / 10.0],
    a: [
        [
            5.0 / 36.0,
            2.0 / 9.0 - ROOTS.1 / 15.0,
            5.0 / 36.0 - ROOTS.1 / 30.0,
        ],
        [
            5.0 / 36.0 + ROOTS.1 / 24.0,
            2.0 / 9.0,
            5.0 / 36.0 - ROOTS.1 / 24.0,
        ],
        [
            5.0 / 36.0 + ROOTS.1 / 30.0,
            2.0 / 9.0 + ROOTS.1 / 15.0,
            5.0 / 36.0,
        ],
    ],
    b: [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0],
};

/// Largest number of iterations; at a contraction of one half, 52 reach rounding.
const ITERATIONS: u32 = 100;
/// Change at which the iteration ends, in rounding units.
const ULPS: f64 = 4.0;
/// Change that is accepted after the last iteration, in rounding units: rounding may sustain changes of this size.
const ULPS_AT_LAST: f64 = 256.0;

macro_rules! method {
    ($name:ident, $order:expr, $tableau:expr) => {
        impl<Sys: Canonical + ?Sized> Method<Sys> for $name {
            fn order(&self) -> u32 {
                $order
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
                step(&$tableau, system, state, h, inputs)
            }
        }
    };
}

method!(Gauss4, 4, TWO_STAGES);
method!(Gauss6, 6, THREE_STAGES);

#[inline]
fn step<Sys, U, const N: usize>(
    tableau: &Tableau<N>,
    system: &Sys,
    state: &State<Sys>,
    h: f64,
    inputs: &U,
) -> Result<State<Sys>, StepError>
where
    Sys: Canonical + ?Sized,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    state.check_shape(system)?;
    let blocks = system.blocks();
    let singular = |cause| StepError::Singular {
        cause,
        time: state.t,
    };
    let unfinite = StepError::NonFinite { time: state.t };
    let start = unit::<Sys>(blocks, system.zero_coordinates());
    let p = system.momentum(&state.x, &state.xi);

    // Returns (ż, ṗ) at the increment z and the momentum p.
    let rates = |node: f64, z: &Sys::Coordinates, p: &Sys::Velocities| {
        let mut x = state.x.clone();
        compose(blocks, x.as_mut(), z.as_ref());
        let xi = system.velocity_from_momentum(&x, p).map_err(|cause| {
            if is_finite(x.as_ref()) && is_finite(p.as_ref()) {
                singular(cause)
            } else {
                unfinite
            }
        })?;
        let u = inputs(state.t + node * h, &x, &xi);
        let mut k = z.clone();
        slope(blocks, k.as_mut(), system.chart_rate(&x, &xi).as_ref());
        Ok((k, system.momentum_rate(&x, &xi, &u)))
    };
    // Returns the start moved by h times the rates, weighted by one row of the tableau.
    let moved = |weights: &[f64; N], rates: &[(Sys::Coordinates, Sys::Velocities); N]| {
        let (mut z, mut p) = (start.clone(), p.clone());
        for (weight, (k, f)) in weights.iter().zip(rates) {
            let weight = weight * h;
            add_scaled(z.as_mut(), weight, k.as_ref());
            add_scaled(p.as_mut(), weight, f.as_ref());
        }
        (z, p)
    };

    let first = rates(0.0, &start, &p)?;
    let mut stages: [_; N] = from_fn(|_| first.clone());
    let length = Sys::Scalar::from_f64(h.abs());
    let one = Sys::Scalar::from_f64(1.0);
    let sizes = (own_sizes(blocks, state.x.clone()), p.clone());
    let whole_x = one + largest(state.x.as_ref());
    let whole_p = largest(p.as_ref()) + Sys::Scalar::from_f64(1e-30);
    let mut least = stages
        .each_ref()
        .map(|_| (system.zero_coordinates(), system.zero_velocities()));
    let mut change = one;
    let mut found = false;
    for _ in 0..ITERATIONS {
        change = Sys::Scalar::default();
        let mut moving = Sys::Scalar::default();
        for (i, (node, row)) in tableau.c.iter().zip(&tableau.a).enumerate() {
            let (z, p) = moved(row, &stages);
            let new = rates(*node, &z, &p)?;
            if let (Some(old), Some(least)) = (stages.get_mut(i), least.get_mut(i)) {
                let of_z = length * largest_difference(new.0.as_ref(), old.0.as_ref()) / whole_x;
                let of_p = length * largest_difference(new.1.as_ref(), old.1.as_ref()) / whole_p;
                change = Scalar::max(change, Scalar::max(of_z, of_p));
                // Small entries are tested only after the largest have converged; few extra sweeps are needed for them.
                if is_below(change, ULPS) {
                    let of_z = (old.0.as_ref(), new.0.as_ref(), sizes.0.as_ref());
                    let of_p = (old.1.as_ref(), new.1.as_ref(), sizes.1.as_ref());
                    let z_moving = still_moving(length, of_z, least.0.as_mut());
                    let p_moving = still_moving(length, of_p, least.1.as_mut());
                    moving = Scalar::max(moving, Scalar::max(z_moving, p_moving));
                }
                *old = new;
            }
        }
        if is_below(change, ULPS) && moving.largest_lane() == 0.0 {
            found = true;
            break;
        }
        if !change.is_finite() {
            break;
        }
    }
    if !found && !is_below(change, ULPS_AT_LAST) {
        return Err(StepError::NotConverged {
            time: state.t,
            iterations: ITERATIONS,
        });
    }

    let (z, p) = moved(&tableau.b, &stages);
    let mut next = state.clone();
    next.t += h;
    compose(blocks, next.x.as_mut(), z.as_ref());
    manifold::normalise(blocks, next.x.as_mut());
    next.xi = system
        .velocity_from_momentum(&next.x, &p)
        .map_err(singular)?;
    if next.is_finite() {
        Ok(next)
    } else {
        Err(unfinite)
    }
}

/// Returns the zero increment, in the storage of x: zeros (flat), (1, 0) (circle), the quaternion 1 (quaternion, and
/// the first four entries of a rotation).
#[inline]
fn unit<Sys: Canonical + ?Sized>(blocks: &[Block], mut z: Sys::Coordinates) -> Sys::Coordinates {
    let mut rest = z.as_mut();
    for block in blocks {
        let Some((here, after)) = rest.split_at_mut_checked(block.coordinates()) else {
            break;
        };
        if let (Block::Circle | Block::Quaternion | Block::Rotation, [first, ..]) = (block, here) {
            *first = Sys::Scalar::from_f64(1.0);
        }
        rest = after;
    }
    z
}

/// Moves x by the increment z; the norm of z does not matter.
#[inline]
fn compose<S: Scalar>(blocks: &[Block], x: &mut [S], z: &[S]) {
    let (mut x, mut z) = (x, z);
    for block in blocks {
        let count = block.coordinates();
        let (Some((here, x_rest)), Some((by, z_rest))) =
            (x.split_at_mut_checked(count), z.split_at_checked(count))
        else {
            return;
        };
        match block {
            Block::Flat(_) => add(here, by),
            Block::Circle => {
                if let (Some(point), Some(by)) = (here.first_chunk_mut::<2>(), by.first_chunk()) {
                    let [c, s] = s1::normalise(*by);
                    let [x, y] = *point;
                    *point = [x * c - y * s, y * c + x * s];
                }
            }
            Block::Quaternion => {
                if let (Some(q), Some(by)) = (here.first_chunk_mut(), by.first_chunk()) {
                    *q = s3::product(*q, s3::normalise(*by));
                }
            }
            Block::Rotation => {
                if let (Some(r), Some(by)) = (here.first_chunk_mut(), by.first_chunk()) {
                    *r = so3::product(*r, s3::to_matrix(s3::normalise(*by)));
                }
            }
        }
        (x, z) = (x_rest, z_rest);
    }
}

/// Replaces z by ż for the chart rate w: w (flat), θ̇ times z turned by 90° (circle), ½ z ⊗ ω.
#[inline]
fn slope<S: Scalar>(blocks: &[Block], z: &mut [S], w: &[S]) {
    let (mut z, mut w) = (z, w);
    for block in blocks {
        let (Some((here, z_rest)), Some((rate, w_rest))) = (
            z.split_at_mut_checked(block.coordinates()),
            w.split_at_checked(block.chart()),
        ) else {
            return;
        };
        match block {
            Block::Flat(_) => {
                for (z, w) in here.iter_mut().zip(rate) {
                    *z = *w;
                }
            }
            Block::Circle => {
                if let (Some(z), [rate]) = (here.first_chunk_mut(), rate) {
                    *z = s1::rate(*z, *rate);
                }
            }
            Block::Quaternion | Block::Rotation => {
                if let (Some(z), Some(w)) = (here.first_chunk_mut(), rate.first_chunk()) {
                    *z = s3::rate(*z, *w);
                }
            }
        }
        (z, w) = (z_rest, w_rest);
    }
}

/// Returns whether a change is below this many rounding units in all lanes.
#[inline]
fn is_below<S: Scalar>(change: S, ulps: f64) -> bool {
    (S::from_f64(ulps) * epsilon() - change).is_positive()
}

#[inline]
fn largest_difference<S: Scalar>(a: &[S], b: &[S]) -> S {
    a.iter().zip(b).fold(S::default(), |largest, (a, b)| {
        Scalar::max(largest, (*a - *b).magnitude())
    })
}

/// Returns the sizes to which changes of the increment are compared: x itself (flat), 1 rad (angles).
#[inline]
fn own_sizes<S: Scalar, X: Store<S>>(blocks: &[Block], mut x: X) -> X {
    let mut rest = x.as_mut();
    for block in blocks {
        let Some((here, after)) = rest.split_at_mut_checked(block.coordinates()) else {
            break;
        };
        if !matches!(block, Block::Flat(_)) {
            here.fill(S::from_f64(1.0));
        }
        rest = after;
    }
    x
}

/// Returns 1 in the lanes in which an entry has not yet converged, 0 elsewhere.
///
/// An entry has not converged if it changes by more than rounding, relative to the sum of its own size and its change
/// over the step, and this change is well below the smallest one so far, or far above it.
#[inline]
fn still_moving<S: Scalar>(length: S, (old, new, sizes): (&[S], &[S], &[S]), least: &mut [S]) -> S {
    let (zero, one) = (S::default(), S::from_f64(1.0));
    let rounding = S::from_f64(ULPS) * epsilon();
    let entries = old.iter().zip(new).zip(sizes.iter().zip(least));
    entries.fold(zero, |moving, ((old, new), (size, least))| {
        let change = (length * (*new - *old)).relative_to(*size, length * *new);
        let shrinks = change.select_lt(S::from_f64(0.75) * *least, one, zero);
        let unsteady = (S::from_f64(16.0) * *least).select_lt(change, one, shrinks);
        // At the first iteration there is no earlier change to compare with.
        let known = zero.select_lt(*least, *least, change);
        *least = change.select_lt(known, change, known);
        Scalar::max(moving, rounding.select_lt(change, unsteady, zero))
    })
}
