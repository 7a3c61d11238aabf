//! What the hand-written bodies offer to methods of their structure.

use hamel::{Block, Canonical, Energies, Rotor, Scalar, Singular, Split, System, s3, so3};
use so3::{Matrix, Vector};

#[cfg(feature = "std")]
use super::Pendulum;
use super::{
    Body, FreeBody, QuaternionTop, Top, add, pose, position, rotation, rows, solve, sub, twist,
};

impl<S: Scalar> Body<S> {
    /// s × m Rᵀ g
    pub fn torque(&self, r: Matrix<S>) -> Vector<S> {
        let weight = so3::apply_transpose(r, self.g).map(|g| self.m * g);
        so3::cross(self.s, weight)
    }

    pub fn momentum(&self, w: Vector<S>) -> Vector<S> {
        so3::apply(self.inertia, w)
    }

    /// J⁻¹ p by J = L D Lᵀ, for a positive definite J.
    pub fn velocity(&self, p: Vector<S>) -> Vector<S> {
        let [d, _, _, a, e, _, b, c, f] = self.inertia;
        let (l10, l20) = (a / d, b / d);
        let d1 = e - l10 * a;
        let l21 = (c - l20 * a) / d1;
        let d2 = f - l20 * b - l21 * (c - l20 * a);
        let y1 = p[1] - l10 * p[0];
        let y2 = p[2] - l20 * p[0] - l21 * y1;
        let w2 = y2 / d2;
        let w1 = y1 / d1 - l21 * w2;
        [p[0] / d - l10 * w1 - l20 * w2, w1, w2]
    }
}

/// A body about a fixed point or its centre of mass, without forces; x = R or q.
#[derive(Clone, Debug)]
pub struct Spin<T>(pub T);

/// [`System`] of the wrapped top.
macro_rules! delegate {
    ($top:ident, $coordinates:ty) => {
        impl<S: Scalar> System for Spin<$top<S>> {
            type Scalar = S;
            type Coordinates = $coordinates;
            type Velocities = [S; 3];
            type Chart = [S; 3];
            type Inputs = [S; 0];

            fn blocks(&self) -> &[Block] {
                self.0.blocks()
            }
            fn start(&self) -> (Self::Coordinates, [S; 3]) {
                self.0.start()
            }
            fn chart_rate(&self, x: &Self::Coordinates, xi: &[S; 3]) -> [S; 3] {
                self.0.chart_rate(x, xi)
            }
            fn forward_dynamics(
                &self,
                x: &Self::Coordinates,
                xi: &[S; 3],
                u: &[S; 0],
            ) -> Result<[S; 3], Singular> {
                self.0.forward_dynamics(x, xi, u)
            }
        }

        impl<S: Scalar> Energies for Spin<$top<S>> {
            fn kinetic_energy(&self, x: &Self::Coordinates, xi: &[S; 3]) -> S {
                self.0.kinetic_energy(x, xi)
            }
            fn potential_energy(&self, _: &Self::Coordinates) -> S {
                S::default()
            }
        }
    };
}

delegate!(Top, [S; 9]);
delegate!(QuaternionTop, [S; 4]);

macro_rules! split {
    ($system:ty, $free:literal, $coordinates:ty, |$this:ident| $body:expr, |$x:ident| $matrix:expr) => {
        impl<S: Scalar> Split for $system {
            type Rotors = [Rotor<S>; 1];
            const FREE: bool = $free;

            fn rotors(&self) -> [Rotor<S>; 1] {
                let $this = self;
                [Rotor::general($body.inertia)]
            }
            fn centre(&self, x: &$coordinates) -> $coordinates {
                *x
            }
            fn uncentre(&self, y: &$coordinates) -> $coordinates {
                *y
            }
            fn split_momenta(&self, _: &$coordinates, xi: &[S; 3]) -> [S; 3] {
                let $this = self;
                $body.momentum(*xi)
            }
            fn split_velocities(&self, _: &$coordinates, p: &[S; 3]) -> [S; 3] {
                let $this = self;
                $body.velocity(*p)
            }
            fn kick(&self, $x: &$coordinates, _: &[S; 0]) -> [S; 3] {
                let $this = self;
                if $free {
                    [S::default(); 3]
                } else {
                    $body.torque($matrix)
                }
            }
        }

        impl<S: Scalar> Canonical for $system {
            fn momentum(&self, _: &$coordinates, xi: &[S; 3]) -> [S; 3] {
                let $this = self;
                $body.momentum(*xi)
            }
            fn momentum_rate(&self, x: &$coordinates, xi: &[S; 3], u: &[S; 0]) -> [S; 3] {
                let $this = self;
                add(
                    so3::cross($body.momentum(*xi), *xi),
                    Split::kick(self, x, u),
                )
            }
            fn velocity_from_momentum(
                &self,
                _: &$coordinates,
                p: &[S; 3],
            ) -> Result<[S; 3], Singular> {
                let $this = self;
                Ok($body.velocity(*p))
            }
        }
    };
}

split!(Top<S>, false, [S; 9], |this| this.0, |x| *x);
split!(Spin<Top<S>>, true, [S; 9], |this| this.0.0, |x| *x);
split!(QuaternionTop<S>, false, [S; 4], |this| this.0, |x| {
    s3::to_matrix(*x)
});
split!(Spin<QuaternionTop<S>>, true, [S; 4], |this| this.0.0, |x| {
    s3::to_matrix(*x)
});

/// y = (r + R s, R), p = (ẏ, P about the centre of mass).
impl Split for FreeBody {
    type Rotors = [Rotor<f64>; 1];
    const FREE: bool = false;

    fn rotors(&self) -> [Rotor<f64>; 1] {
        [Rotor::general(self.about_centre())]
    }
    fn centre(&self, x: &[f64; 12]) -> [f64; 12] {
        let lever = so3::apply(rotation(x), self.body.s);
        pose(add(position(x), lever), rotation(x))
    }
    fn uncentre(&self, y: &[f64; 12]) -> [f64; 12] {
        let lever = so3::apply(rotation(y), self.body.s);
        pose(sub(position(y), lever), rotation(y))
    }
    fn split_momenta(&self, x: &[f64; 12], xi: &[f64; 6]) -> [f64; 6] {
        let (v, w) = twist(xi);
        let [a, b, c] = so3::apply(rotation(x), add(v, so3::cross(w, self.body.s)));
        let [d, e, f] = so3::apply(self.about_centre(), w);
        [a, b, c, d, e, f]
    }
    fn split_velocities(&self, x: &[f64; 12], p: &[f64; 6]) -> [f64; 6] {
        let (velocity, momentum) = twist(p);
        let w = solve(rows(self.about_centre()), momentum).expect("an inertia");
        let v = so3::apply_transpose(rotation(x), velocity);
        let [a, b, c] = sub(v, so3::cross(w, self.body.s));
        [a, b, c, w[0], w[1], w[2]]
    }
    fn kick(&self, x: &[f64; 12], u: &[f64; 6]) -> [f64; 6] {
        let (force, torque) = twist(u);
        let push = so3::apply(rotation(x), force).map(|f| f / self.body.m);
        let [a, b, c] = add(push, self.body.g);
        let [d, e, f] = sub(torque, so3::cross(self.body.s, force));
        [a, b, c, d, e, f]
    }
}

impl FreeBody {
    /// Θ − m (|s|² I − s sᵀ)
    fn about_centre(&self) -> Matrix<f64> {
        let Body { m, s, inertia, .. } = self.body;
        std::array::from_fn(|k| {
            let (i, j) = (k / 3, k % 3);
            let unit = if i == j { so3::dot(s, s) } else { 0.0 };
            inertia[k] - m * (unit - s[i] * s[j])
        })
    }
}

/// A body about its pivot: the circle moves uniformly between kicks.
#[cfg(feature = "std")]
impl Split for Pendulum {
    type Rotors = [Rotor<f64>; 0];
    const FREE: bool = false;

    fn rotors(&self) -> [Rotor<f64>; 0] {
        []
    }
    fn centre(&self, x: &Vec<f64>) -> Vec<f64> {
        x.clone()
    }
    fn uncentre(&self, y: &Vec<f64>) -> Vec<f64> {
        y.clone()
    }
    fn split_momenta(&self, _: &Vec<f64>, xi: &Vec<f64>) -> Vec<f64> {
        xi.clone()
    }
    fn split_velocities(&self, _: &Vec<f64>, p: &Vec<f64>) -> Vec<f64> {
        p.clone()
    }
    fn kick(&self, x: &Vec<f64>, u: &Vec<f64>) -> Vec<f64> {
        vec![(u[0] / self.l - self.g * x[1]) / self.l]
    }
}

#[cfg(feature = "std")]
impl Canonical for Pendulum {
    fn momentum(&self, _: &Vec<f64>, xi: &Vec<f64>) -> Vec<f64> {
        vec![self.l * self.l * xi[0]]
    }
    fn momentum_rate(&self, x: &Vec<f64>, _: &Vec<f64>, u: &Vec<f64>) -> Vec<f64> {
        vec![u[0] - self.g * self.l * x[1]]
    }
    fn velocity_from_momentum(&self, _: &Vec<f64>, p: &Vec<f64>) -> Result<Vec<f64>, Singular> {
        solve([[self.l * self.l]], [p[0]]).map(|xi| xi.to_vec())
    }
}

/// Kirchhoff's equations: p in body axes, ṗ = p × ω + F, L̇ = L × ω + p × v + τ.
impl Canonical for FreeBody {
    fn momentum(&self, _: &[f64; 12], xi: &[f64; 6]) -> [f64; 6] {
        let (v, w) = twist(xi);
        let ([a, b, c], [d, e, f]) = self.momentum(v, w);
        [a, b, c, d, e, f]
    }
    fn momentum_rate(&self, x: &[f64; 12], xi: &[f64; 6], u: &[f64; 6]) -> [f64; 6] {
        let Body { m, s, g, .. } = self.body;
        let ((v, w), (force, torque)) = (twist(xi), twist(u));
        let (p, l) = self.momentum(v, w);
        let weight = so3::apply_transpose(rotation(x), g).map(|g| m * g);
        let [a, b, c] = add(so3::cross(p, w), add(weight, force));
        let turning = add(so3::cross(l, w), so3::cross(p, v));
        let [d, e, f] = add(turning, add(so3::cross(s, weight), torque));
        [a, b, c, d, e, f]
    }
    fn velocity_from_momentum(&self, _: &[f64; 12], p: &[f64; 6]) -> Result<[f64; 6], Singular> {
        solve(self.mass(), *p)
    }
}
