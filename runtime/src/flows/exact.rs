//! Closed-form motion of the torque-free rotor with three different moments.
//!
//! The principal axes are numbered such that the component of P along the third never vanishes. Then
//! P/|P| = (a cn, a/√r sn, σ b dn)(u | m), and the attitude follows from the angle of P's frame about the constant R P.
//! With κᵢ = 1/Iᵢ, r = (κ₂−κ₃)/(κ₁−κ₃), q = (κ₁−κ₂)/(κ₁−κ₃), r + q = 1 and (p₁, p₂, p₃) = P/|P| at the start
//!
//! a² = p₁² + r p₂², b² = p₃² + q p₂², m = a² q/(b² r), 1 − m = (r p₃² − q p₁²)/(r b²),
//! u̇ = ±|P| b √r (κ₁−κ₃).
//!
//! These formulas do not subtract |P|² from 2 E I, which would cancel: all terms are sums, or differences of given
//! inertias. At the start sn = p₂ √r/a, cn = p₁/a and dn = |p₃|/b, so that no inverse function is needed; the functions
//! are advanced by the addition theorem.
//!
//! P is constant in the body for a rotation about a principal axis, at rest, and with three equal moments. There the
//! amplitudes carry no information on neighbouring motions, so the first-order dependence is computed from Euler's
//! equations instead, which gives dual numbers the right slopes. Sources: E. Celledoni, F. Fassò, N. Säfström, A.
//! Zanna, SIAM J. Sci. Comput. 30 (2008) 2084; R. van Zon, J. Schofield, J. Comput. Phys. 225 (2007) 145.

use core::array::from_fn;

use crate::flows::attitude::{Attitude, SineCosine};
use crate::flows::jacobi::{Jacobi, Mean};
use crate::flows::nodes::{self, Angle};
use crate::s3;
use crate::scalar::Scalar;
use crate::so3::{self, Matrix, Vector};

/// Constants and initial values of one torque-free motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FreeRotation<S> {
    /// Unit vector P/|P|, in principal axes.
    unit: Vector<S>,
    /// Length |P|.
    length: S,
    /// Angular momentum P, in principal axes.
    momentum: Vector<S>,
    /// Inverse moments 1/I, in principal axes.
    flexibility: Vector<S>,
    /// The axes numbered as in the formulas, as rows, in principal axes.
    names: [Vector<S>; 3],
    /// Inverse moments κ₁, κ₃.
    inverses: [S; 2],
    /// Factor of the integral, |P| (κ₁ − κ₃).
    pub(crate) factor: S,
    /// Amplitudes a, a/√r, σ b.
    amplitudes: Vector<S>,
    /// 1 if P moves in the body; 0 for a rotation about a principal axis, or about any axis if the moments are equal.
    moving: S,
    pub(crate) m: S,
    pub(crate) complement: S,
    pub(crate) start: Jacobi<S>,
    /// Rate u̇ of the argument.
    pub(crate) rate: S,
    /// Parameter n ≤ 1 of the integral of |P| (κ₁ − κ₃) n sn²/(1 + n sn²). The angle about R P is |P| κ h, plus this
    /// integral with κ = κ₃ if the node is that of the first axis, or minus this integral with κ = κ₁ if it is that of
    /// the third.
    pub(crate) n: S,
    /// Rate u̇ divided by the factor of the integral.
    pub(crate) per_factor: S,
    /// Whether the node is that of the first axis (1) or of the third (0).
    by_first: S,
    /// Whether names[0], names[1], σ names[2] are right-handed (1) or left-handed (−1).
    turning: S,
}

/// Result of a motion.
pub(crate) struct Turned<S> {
    /// Rotation F of the body, R₁ = R₀ F.
    f: Matrix<S>,
    /// Angular momentum P = Fᵀ P₀.
    momentum: Vector<S>,
    /// Unit vector P/|P|.
    unit: Vector<S>,
    /// Angle about R P.
    angle: S,
    /// Number of sign changes of cn.
    folds: S,
    /// Duration of the motion.
    h: S,
}

/// A principal axis with its moment of inertia.
#[derive(Clone, Copy)]
struct Named<S> {
    moment: S,
    axis: Vector<S>,
}

/// Exchanges two axes in the lanes where `condition` is positive.
fn exchange<S: Scalar>(axes: &mut [Named<S>; 3], a: usize, b: usize, condition: S) {
    let zero = S::default();
    let pick = |yes: S, no: S| zero.select_lt(condition, yes, no);
    let (first, second) = (axes[a], axes[b]);
    let mix = |yes: Named<S>, no: Named<S>| Named {
        moment: pick(yes.moment, no.moment),
        axis: from_fn(|i| pick(yes.axis[i], no.axis[i])),
    };
    axes[a] = mix(second, first);
    axes[b] = mix(first, second);
}

impl<S: Scalar> FreeRotation<S> {
    /// Creates the motion that starts with the angular momentum `p`, in principal axes.
    pub(crate) fn new(moments: Vector<S>, p: Vector<S>) -> Self {
        let (zero, one) = (S::default(), S::from_f64(1.0));
        // P is scaled by its largest component, so that the square of a small P does not underflow.
        let largest = Scalar::max(Scalar::max(p[0].abs(), p[1].abs()), p[2].abs());
        let scaled: Vector<S> = from_fn(|i| {
            let rest = if i == 2 { one } else { zero };
            zero.select_lt(largest, p[i] / largest, rest)
        });
        let norm = so3::dot(scaled, scaled).sqrt();
        let length = largest * norm;
        let unit = scaled.map(|component| component / norm);

        let mut axes: [Named<S>; 3] = from_fn(|i| Named {
            moment: moments[i],
            axis: from_fn(|k| if i == k { one } else { zero }),
        });
        for (a, b) in [(0, 1), (1, 2), (0, 1)] {
            let excess = axes[a].moment - axes[b].moment;
            exchange(&mut axes, a, b, excess);
        }
        let differences = |axes: &[Named<S>; 3]| {
            let k = |i: usize, j: usize| {
                (axes[j].moment - axes[i].moment) / (axes[i].moment * axes[j].moment)
            };
            let whole = k(0, 2);
            let spread = zero.select_lt(whole.abs(), whole, one);
            (k(1, 2) / spread, k(0, 1) / spread, whole)
        };
        let (r, q, _) = differences(&axes);
        let x = r.sqrt() * so3::dot(axes[2].axis, unit).abs();
        let y = q.sqrt() * so3::dot(axes[0].axis, unit).abs();
        // On the separatrix either order of the axes works, unless r = 0.
        let tie = r.select_lt(q, one, zero);
        let swap = x.select_lt(y, one, y.select_lt(x, zero, tie));
        exchange(&mut axes, 0, 2, swap);
        let (r, q, whole) = differences(&axes);

        let names = axes.map(|named| named.axis);
        let [p1, p2, p3] = names.map(|axis| so3::dot(axis, unit));
        let a2 = p1 * p1 + r * (p2 * p2);
        let b2 = p3 * p3 + q * (p2 * p2);
        let (a, b, root) = (a2.sqrt(), b2.sqrt(), r.sqrt());
        let (x, y) = (root * p3.abs(), q.sqrt() * p1.abs());
        let sigma = p3.select_lt(zero, -one, one);
        let parity = so3::dot(names[0], so3::cross(names[1], names[2]));
        let circling = zero.select_lt(a, one, zero);
        let start = Jacobi {
            sn: zero.select_lt(a, p2 * root / a, zero),
            cn: zero.select_lt(a, p1 / a, one),
            dn: p3.abs() / b,
        };
        let off_axis = zero.select_lt(p1 * p1 + p3 * p3, one, zero);
        let by_first = b2.select_lt(a2, zero, one);
        let per_factor = sigma * parity * b * root;
        Self {
            unit,
            length,
            momentum: p,
            flexibility: moments.map(|moment| one / moment),
            names,
            inverses: [one / axes[0].moment, one / axes[2].moment],
            factor: length * whole,
            amplitudes: [a, a / root, sigma * b],
            moving: circling * off_axis * zero.select_lt(whole.abs() * b2, one, zero),
            m: a2 * q / (b2 * r),
            // If q is 0, its root has no finite slope.
            complement: zero.select_lt(q, (x - y) * (x + y), r * (p3 * p3) - q * (p1 * p1))
                / (r * b2),
            start,
            rate: length * per_factor * whole,
            n: by_first.select_lt(one, q / r, a2 / b2),
            per_factor,
            by_first,
            turning: sigma * parity,
        }
    }

    /// Advances the motion by the time `h`.
    pub(crate) fn after(&self, h: S) -> Turned<S> {
        let zero = S::default();
        let Angle {
            end,
            integral,
            folds,
        } = nodes::advance(self, h);
        let named = [
            self.amplitudes[0] * end.cn,
            self.amplitudes[1] * end.sn,
            self.amplitudes[2] * end.dn,
        ];
        let mut unit: Vector<S> =
            from_fn(|i| (0..3).fold(zero, |sum, k| self.names[k][i].mul_add(named[k], sum)));
        let norm = so3::dot(unit, unit).sqrt();
        let part = self.n * integral;
        let time = self.length * h;
        let by_first = self.inverses[1] * time + part;
        let by_third = self.inverses[0] * time - part;
        let mut angle = zero.select_lt(self.by_first, by_first, by_third);
        unit = unit.map(|component| component / norm);
        if !self.moving.is_positive() {
            let (still, rate) = (self.still(time), self.steady_rate());
            unit = from_fn(|i| zero.select_lt(self.moving, unit[i], still[i]));
            angle = zero.select_lt(self.moving, angle, rate * time);
        }
        let reference: Vector<S> =
            from_fn(|i| zero.select_lt(self.by_first, self.names[0][i], self.names[2][i]));
        let (before, after) = (frame(reference, self.unit), frame(reference, unit));
        let (turned, _) = before.turned_about(2, angle);
        let transposed: Matrix<S> = from_fn(|k| after[3 * (k % 3) + k / 3]);
        let mut f = so3::product(turned, transposed);
        let mut momentum = unit.map(|component| self.length * component);
        if !self.length.is_positive() {
            let resting = so3::exp(self.turn_at_rest(h));
            f = from_fn(|k| zero.select_lt(self.length, f[k], resting[k]));
            momentum = from_fn(|i| zero.select_lt(self.length, momentum[i], self.momentum[i]));
        }
        Turned {
            f,
            momentum,
            unit,
            angle,
            folds,
            h,
        }
    }

    /// Returns P/|P| after `time` (|P| times the physical time) if P is constant in the body: the constant value, and
    /// its first-order dependence for dual numbers.
    ///
    /// With f = p × κ p, f = 0, that is p + t f + ½ t² f′ f if two moments are equal, where f′ f′ is 0; for a rotation
    /// about axis k, ṗᵢ = pₖ (κₖ − κⱼ) pⱼ and ṗⱼ = pₖ (κᵢ − κₖ) pᵢ for i, j, k in cyclic order.
    fn still(&self, time: S) -> Vector<S> {
        let (zero, one, half) = (S::default(), S::from_f64(1.0), S::from_f64(0.5));
        let (p, flexibility) = (self.unit, self.flexibility);
        let product = |a: Vector<S>, b: Vector<S>| -> Vector<S> {
            from_fn(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                a[j] * b[k] * (flexibility[k] - flexibility[j])
            })
        };
        let f = product(p, p);
        let (once, again) = (product(f, p), product(p, f));
        let bend = from_fn::<S, 3, _>(|i| half * time * (once[i] + again[i]));
        let mut still: Vector<S> = from_fn(|i| time.mul_add(f[i] + bend[i], p[i]));
        let aligned = one - S::from_f64(4.0 * S::EPSILON);
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let by_j = flexibility[k] - flexibility[j];
            let by_i = flexibility[i] - flexibility[k];
            let square = by_i * by_j;
            let root = square.abs().sqrt();
            let (far, way) = (nodes::farthest::<S>(), time * p[k]);
            let angle = root * way;
            let (sine, cosine) = angle.sin_cos();
            let bounded = Scalar::max(far.select_lt(angle, far, angle), -far);
            let cosine = square.select_lt(zero, cosine, bounded.cosh());
            let sine = square.select_lt(zero, sine, bounded.sinh());
            let sine = zero.select_lt(root, sine / root, way);
            let moved = [
                cosine * p[i] + by_j * sine * p[j],
                cosine * p[j] + by_i * sine * p[i],
                p[k],
            ];
            for (place, moved) in [i, j, k].into_iter().zip(moved) {
                still[place] = (p[k] * p[k]).select_lt(aligned, still[place], moved);
            }
        }
        still
    }

    /// Returns the rate of the angle about R P divided by |P|, if P is constant in the body: Σ κᵢ pᵢ²/Σ pᵢ² over the
    /// axes other than that of the node.
    fn steady_rate(&self) -> S {
        let zero = S::default();
        let squares = self.names.map(|axis| {
            let p = so3::dot(axis, self.unit);
            p * p
        });
        let beside = [
            zero.select_lt(self.by_first, zero, squares[0]),
            squares[1],
            zero.select_lt(self.by_first, squares[2], zero),
        ];
        let weighed = from_fn(|k| so3::dot(self.names[k], self.flexibility) * beside[k]);
        let sum = |list: [S; 3]| list[0] + list[1] + list[2];
        sum(weighed) / sum(beside)
    }

    /// Returns the rotation vector of a body at rest, in principal axes: h J⁻¹ P, which is zero but may have slopes.
    fn turn_at_rest(&self, h: S) -> Vector<S> {
        from_fn(|i| h * (self.flexibility[i] * self.momentum[i]))
    }

    /// Returns F as a unit quaternion, with the sign that results from moving continuously from 1.
    ///
    /// F = G(p₀) exp(e ψ) G(p)ᵀ with e = σ names[2], where e · p is never negative and G(p) is the shortest rotation
    /// from e to p. ψ is the angle about R P, less the change of the azimuth of the node about e relative to G. This
    /// azimuth must be continuous, since F and −F are the same rotation but not the same quaternion.
    fn lift(&self, turned: &Turned<S>) -> s3::Quaternion<S> {
        let (zero, half) = (S::default(), S::from_f64(0.5));
        // α/2, half of the azimuth, advances by a quarter turn at each sign change of cn.
        let quarters = zero.select_lt(self.moving, turned.folds, zero);
        let quarters = self.by_first.select_lt(half, quarters, zero);
        let side = nodes::side(self.start);
        let twist = by_angle(half * turned.angle);
        let twist = times(twist, self.half_azimuth(self.unit, side));
        let side = side * nodes::parity(quarters);
        let twist = times(twist, conjugate(self.half_azimuth(turned.unit, side)));
        let twist = times(twist, by_quarters(-(quarters * self.turning)));

        let axis = self.third();
        let (before, after) = (shortest(axis, self.unit), shortest(axis, turned.unit));
        let [x, y, z] = axis.map(|component| component * twist[1]);
        let back = [after[0], -after[1], -after[2], -after[3]];
        let lifted = s3::product(s3::product(before, [twist[0], x, y, z]), back);
        if self.length.is_positive() {
            return lifted;
        }
        let resting = s3::exp(self.turn_at_rest(turned.h));
        from_fn(|i| zero.select_lt(self.length, lifted[i], resting[i]))
    }

    /// Returns e = σ names[2]; the component of p along e keeps its sign.
    fn third(&self) -> Vector<S> {
        let zero = S::default();
        let minus = self.amplitudes[2].select_lt(zero, -S::from_f64(1.0), S::from_f64(1.0));
        self.names[2].map(|component| minus * component)
    }

    /// Returns half of the azimuth about e of the node of names[0] or names[2] relative to the frame G(p), as cosine
    /// and sine. For names[2], `side`, 1 or −1, rotates p to where cn is positive.
    fn half_azimuth(&self, p: Vector<S>, side: S) -> [S; 2] {
        let (zero, one) = (S::default(), S::from_f64(1.0));
        let along = so3::dot(self.names[0], p);
        let across = self.turning * so3::dot(self.names[1], p);
        let height = so3::dot(self.third(), p);
        let cosine = zero.select_lt(self.by_first, one + height - along * along, side * along);
        let sine = zero.select_lt(self.by_first, -(along * across), side * across);
        let length = (cosine * cosine + sine * sine).sqrt();
        let (cosine, sine) = (cosine / length, sine / length);
        let cosine = cosine + one;
        let length = (cosine * cosine + sine * sine).sqrt();
        [cosine / length, sine / length]
    }
}

/// Returns the shortest rotation from one unit vector to another that is less than half a turn away.
fn shortest<S: Scalar>(from: Vector<S>, to: Vector<S>) -> s3::Quaternion<S> {
    let [x, y, z] = so3::cross(from, to);
    let cosine = S::from_f64(1.0) + so3::dot(from, to);
    let length = (cosine * cosine + x * x + y * y + z * z).sqrt();
    [cosine, x, y, z].map(|entry| entry / length)
}

/// Returns cosine and sine of an angle in rad.
fn by_angle<S: Scalar>(angle: S) -> [S; 2] {
    let SineCosine { sine, cosine } = SineCosine::of(angle);
    [cosine, sine]
}

/// Returns cosine and sine of a whole number of quarter turns.
fn by_quarters<S: Scalar>(count: S) -> [S; 2] {
    let (one, two, four) = (S::from_f64(1.0), S::from_f64(2.0), S::from_f64(4.0));
    let turns = count / four;
    let rest = turns - nodes::round(turns);
    let size = four * rest.abs();
    [one - size, four * rest * (two - size)]
}

/// Returns the sum of two angles, each as cosine and sine.
fn times<S: Scalar>(a: [S; 2], b: [S; 2]) -> [S; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// Returns the negative of an angle.
fn conjugate<S: Scalar>(a: [S; 2]) -> [S; 2] {
    [a[0], -a[1]]
}

/// Returns the frame of a unit vector p, with the columns node = reference × p (normalised), p × node, and p.
fn frame<S: Scalar>(reference: Vector<S>, p: Vector<S>) -> Matrix<S> {
    let node = so3::cross(reference, p);
    let length = so3::dot(node, node).sqrt();
    let node = node.map(|component| component / length);
    let third = so3::cross(p, node);
    from_fn(|k| match k % 3 {
        0 => node[k / 3],
        1 => third[k / 3],
        _ => p[k / 3],
    })
}

/// Flow for any moments, such as three different ones: returns the attitude after the time `h` and updates P. Exact.
#[inline]
pub fn exact<S: Scalar, A: Attitude<S>>(
    attitude: A,
    p: &mut Vector<S>,
    moments: Vector<S>,
    h: S,
) -> A {
    let motion = FreeRotation::new(moments, *p);
    let turned = motion.after(h);
    *p = turned.momentum;
    attitude.turned_by_matrix(turned.f, || motion.lift(&turned))
}

/// Returns the time between two flips of a torque-free rotor, half a period of its angular velocity: 2K/|u̇|, for a
/// given angular momentum in principal axes. Infinite or NaN if the rotor does not flip.
pub fn half_period<S: Scalar>(moments: Vector<S>, p: Vector<S>) -> S {
    let motion = FreeRotation::new(moments, p);
    let quarter = Mean::new(motion.complement).quarter_period();
    S::from_f64(2.0) * quarter / motion.rate.abs()
}
