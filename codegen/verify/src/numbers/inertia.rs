//! Contributions of bodies and particles to the three forms (30) at one point, modulo p.

use super::motion::{MotionJet, MovingFrame};
use super::space::{Mat3, Vec3, add, apply, apply_transposed, cross, scale};
use crate::kernel::dot;
use hamel_algebra::residue_pair::ResiduePair;

/// Mass, centre of mass and inertia of a body as numbers modulo p.
pub struct BodyInertia {
    /// Mass.
    pub mass: ResiduePair,
    /// Centre of mass, in frame axes.
    pub com: Vec3,
    /// Inertia about the centre of mass.
    pub inertia_com: Mat3,
    /// Inertia about the frame's origin.
    pub inertia_origin: Mat3,
}

/// Sums over bodies and particles, and over a kinetic energy that the user wrote, from which the forms are composed;
/// numbers modulo p.
pub struct FormSums {
    /// ∂S/∂ξ̇ⁱ by accelerations, (30b).
    pub gibbs: Vec<ResiduePair>,
    /// Generalised weights Σ m ⟨g, ∂ᵢr⟩.
    pub weight: Vec<ResiduePair>,
    /// Generalised momenta ∂T/∂ξⁱ, from velocities.
    pub momentum: Vec<ResiduePair>,
    /// d/dt ∂T/∂ξⁱ.
    pub momentum_rate: Vec<ResiduePair>,
    /// ∂ᵢT.
    pub slope: Vec<ResiduePair>,
    /// Kinetic energy T.
    pub kinetic: ResiduePair,
    /// Mass matrix M, KR18 (20).
    pub mass: Vec<Vec<ResiduePair>>,
    /// Ṁ_ij ξʲ.
    pub mass_rate: Vec<ResiduePair>,
    /// ½ ∂ᵢM_jk ξʲ ξᵏ.
    pub centrifugal: Vec<ResiduePair>,
}

fn half() -> ResiduePair {
    ResiduePair::new(2).inv().unwrap_or(ResiduePair::ONE)
}

fn increase(sum: &mut ResiduePair, by: ResiduePair) {
    *sum = *sum + by;
}

impl FormSums {
    /// Creates sums without any terms, for n velocities.
    pub fn new(n: usize) -> Self {
        let zero = || vec![ResiduePair::ZERO; n];
        FormSums {
            gibbs: zero(),
            weight: zero(),
            momentum: zero(),
            momentum_rate: zero(),
            slope: zero(),
            kinetic: ResiduePair::ZERO,
            mass: vec![zero(); n],
            mass_rate: zero(),
            centrifugal: zero(),
        }
    }

    /// Adds a point mass to the terms of (30a) and (30b), and its weight.
    fn point(&mut self, mass: ResiduePair, gravity: Vec3, point: &MotionJet<Vec3>) {
        let (velocity, acceleration) = (scale(mass, point.rate), scale(mass, point.second));
        let weight = scale(mass, gravity);
        for i in 0..self.gibbs.len() {
            increase(&mut self.gibbs[i], dot(&acceleration, &point.by[i]));
            increase(&mut self.weight[i], dot(&weight, &point.by[i]));
            increase(&mut self.momentum[i], dot(&velocity, &point.by[i]));
            let turned = dot(&velocity, &point.rate_by[i]);
            increase(
                &mut self.momentum_rate[i],
                dot(&acceleration, &point.by[i]) + turned,
            );
            increase(&mut self.slope[i], dot(&velocity, &point.by_rate[i]));
        }
        increase(&mut self.kinetic, half() * dot(&velocity, &point.rate));
    }

    /// Adds to M and its derivatives, given the velocity t = tᵢ ξⁱ with tᵢ, d/dt tᵢ and ∂ᵢt, and the inertia that acts
    /// on it.
    fn metric(
        &mut self,
        twists: &Twists,
        xi: &[ResiduePair],
        inertia: impl Fn(&[ResiduePair]) -> Vec<ResiduePair>,
    ) {
        let n = xi.len();
        let momentum = inertia(&twists.total);
        let mut drift = vec![ResiduePair::ZERO; twists.total.len()];
        for (rate, &speed) in twists.rate_by.iter().zip(xi) {
            for (sum, &entry) in drift.iter_mut().zip(rate) {
                increase(sum, entry * speed);
            }
        }
        let drift = inertia(&drift);
        for i in 0..n {
            let rate = dot(&twists.rate_by[i], &momentum) + dot(&twists.by[i], &drift);
            increase(&mut self.mass_rate[i], rate);
            increase(
                &mut self.centrifugal[i],
                dot(&twists.by_total[i], &momentum),
            );
            if twists.by[i].iter().all(|entry| entry.is_zero()) {
                continue;
            }
            let momentum = inertia(&twists.by[i]);
            for j in 0..=i {
                let entry = dot(&momentum, &twists.by[j]);
                increase(&mut self.mass[i][j], entry);
                if j < i {
                    increase(&mut self.mass[j][i], entry);
                }
            }
        }
    }

    /// Adds the terms of a particle to all sums.
    pub fn add_particle(
        &mut self,
        mass: ResiduePair,
        gravity: Vec3,
        point: &MotionJet<Vec3>,
        xi: &[ResiduePair],
    ) {
        self.point(mass, gravity, point);
        let all = |list: &[Vec3]| list.iter().map(|entry| entry.to_vec()).collect();
        let twists = Twists {
            total: point.rate.to_vec(),
            by: all(&point.by),
            rate_by: all(&point.rate_by),
            by_total: all(&point.by_rate),
        };
        self.metric(&twists, xi, |v| {
            v.iter().map(|&entry| mass * entry).collect()
        });
    }

    /// Adds the terms of a body: (30a) and (30b) from its centre of mass, M from the twist of its frame's origin.
    pub fn add_body(
        &mut self,
        body: &BodyInertia,
        gravity: Vec3,
        frame: &MovingFrame,
        xi: &[ResiduePair],
    ) {
        let n = xi.len();
        self.point(body.mass, gravity, &frame.fixed_point(body.com));
        let spin = frame.angular_motion();
        let spun = apply(&body.inertia_com, spin.omega);
        let turned = apply(&body.inertia_com, spin.alpha);
        let torque = add(turned, cross(spin.omega, spun));
        for i in 0..n {
            increase(&mut self.gibbs[i], dot(&torque, &spin.by[i]));
            increase(&mut self.momentum[i], dot(&spun, &spin.by[i]));
            let rate = dot(&turned, &spin.by[i]) + dot(&spun, &spin.rate_by[i]);
            increase(&mut self.momentum_rate[i], rate);
            increase(&mut self.slope[i], dot(&spun, &spin.by_omega[i]));
        }
        increase(&mut self.kinetic, half() * dot(&spin.omega, &spun));
        // Rᵀ ∂ᵢr and its derivatives by the product rule.
        let (r, p) = (&frame.rotation, &frame.position);
        let twist = |v: Vec3, w: Vec3| [v, w].concat();
        let into = apply_transposed;
        let each = |f: &dyn Fn(usize) -> Vec<ResiduePair>| (0..n).map(f).collect::<Vec<_>>();
        let twists = Twists {
            total: twist(into(&r.value, p.rate), spin.omega),
            by: each(&|i| twist(into(&r.value, p.by[i]), spin.by[i])),
            rate_by: each(&|i| {
                let v = add(into(&r.rate, p.by[i]), into(&r.value, p.rate_by[i]));
                twist(v, spin.rate_by[i])
            }),
            by_total: each(&|i| {
                let v = add(into(&r.by[i], p.rate), into(&r.value, p.by_rate[i]));
                twist(v, spin.by_omega[i])
            }),
        };
        let first = scale(body.mass, body.com);
        self.metric(&twists, xi, |t| match t {
            &[a, b, c, d, e, f] => {
                let (v, w) = ([a, b, c], [d, e, f]);
                let linear = add(scale(body.mass, v), cross(w, first));
                let angular = add(cross(first, v), apply(&body.inertia_origin, w));
                twist(linear, angular)
            }
            _ => Vec::new(),
        });
    }
}

/// Velocity t, linear in ξ, whose kinetic energy M describes: that of a particle, or the twist of a body in body axes.
struct Twists {
    /// t.
    total: Vec<ResiduePair>,
    /// tᵢ = ∂t/∂ξⁱ.
    by: Vec<Vec<ResiduePair>>,
    /// d/dt tᵢ.
    rate_by: Vec<Vec<ResiduePair>>,
    /// ∂ᵢt.
    by_total: Vec<Vec<ResiduePair>>,
}
