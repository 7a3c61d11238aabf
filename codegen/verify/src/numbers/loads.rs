//! Generalised forces by virtual work, fᵢ = Σ ⟨F_p, ∂ᵢr_p⟩, KR18 (28), at one point modulo p: every load is a sum of
//! forces on points, as in `virtual_power`, which does the same with expressions.

use super::motion::{MotionJet, MovingFrame};
use super::space::{Vec3, add, apply, column, cross, scale, sub};
use crate::kernel::dot;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_language::syntax::ast::Axes;

/// Generalised forces as a sum over forces on points, by virtual work; numbers modulo p.
pub struct GeneralizedForces {
    /// Generalised forces fᵢ.
    pub sum: Vec<ResiduePair>,
}

impl GeneralizedForces {
    /// Adds generalised forces as they are given.
    pub fn add(&mut self, forces: impl IntoIterator<Item = ResiduePair>) {
        for (sum, force) in self.sum.iter_mut().zip(forces) {
            *sum = *sum + force;
        }
    }

    /// Adds ⟨F, ∂ᵢr⟩, given all ∂ᵢr.
    fn at(&mut self, force: Vec3, by: impl Iterator<Item = Vec3>) {
        self.add(by.map(|column| dot(&force, &column)).collect::<Vec<_>>());
    }

    /// Adds a force between two points along their line, positive if it drives the points apart.
    pub fn add_along_line(&mut self, force: Vec3, from: &MotionJet<Vec3>, to: &MotionJet<Vec3>) {
        self.at(
            force,
            to.by.iter().zip(&from.by).map(|(&to, &from)| sub(to, from)),
        );
    }

    /// Adds a wrench at a point of a frame: the force there, and the torque as three couples, ½ τ × eₖ at the tips of
    /// the frame's axes and −½ τ × eₖ at its origin.
    pub fn add_wrench(&mut self, axes: Axes, [at, force, torque]: [Vec3; 3], frame: &MovingFrame) {
        let world = |a: Vec3| match axes {
            Axes::World => a,
            Axes::Body => apply(&frame.rotation.value, a),
        };
        let point = frame.position.by.iter().zip(&frame.rotation.by);
        self.at(world(force), point.map(|(&p, r)| add(p, apply(r, at))));
        let half = ResiduePair::new(2).inv().unwrap_or(ResiduePair::ONE);
        let torque = scale(half, world(torque));
        for k in 0..3 {
            let couple = cross(torque, column(&frame.rotation.value, k));
            self.at(couple, frame.rotation.by.iter().map(|r| column(r, k)));
        }
    }

    /// Adds a damper along a line, as a force −c (d·ḋ)/(d·d) d on its second point and the opposite one on its first.
    pub fn add_damper(
        &mut self,
        coefficient: ResiduePair,
        from: &MotionJet<Vec3>,
        to: &MotionJet<Vec3>,
    ) -> Option<()> {
        let (d, rate) = (sub(to.value, from.value), sub(to.rate, from.rate));
        let speed = dot(&d, &rate) * dot(&d, &d).inv()?;
        self.add_along_line(scale(-(coefficient * speed), d), from, to);
        Some(())
    }
}
