//! Rapier: its rigid body, free or on a ball joint, stepped by its full pipeline without colliders.

use crate::runner::{BenchError, Runner, rows};
use hamel::{Energies, so3};
use hamel_report::data::Kind;
use hamel_report::entry::{Deviation, Entry, Outcome};
use hamel_report::problem::Problem;
use rapier3d_f64::prelude::*;
use std::hint::black_box;
use std::time::Instant;

/// A body in Rapier's form, about its centre of mass.
struct Body {
    mass: f64,
    centre: [f64; 3],
    inertia: [[f64; 3]; 3],
    gravity: [f64; 3],
    joint: bool,
}

/// The entry of Rapier for a problem; with a joint, about the origin of the body.
pub fn entry<'p, Sys, U>(
    runner: &Runner,
    problem: &'p Problem<'_, Sys, U>,
    joint: bool,
) -> Result<Entry<'p>, BenchError>
where
    Sys: Energies<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>,
    U: Fn(f64, &[f64; 9], &[f64; 3]) -> [f64; 0],
{
    let mut body = Body {
        mass: 1.0,
        centre: [0.0; 3],
        inertia: rows(runner.parameter("J")?),
        gravity: [0.0; 3],
        joint,
    };
    if joint {
        let [mass] = runner.parameter("m")?;
        let s: [f64; 3] = runner.parameter("s")?;
        for (i, row) in body.inertia.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let own = if i == j { so3::dot(s, s) } else { 0.0 };
                *entry -= mass * (own - s[i] * s[j]);
            }
        }
        body = Body {
            mass,
            centre: s,
            gravity: runner.parameter("g")?,
            ..body
        };
    }
    let other = Body { ..body };
    Ok(Entry::new(
        "Rapier",
        Kind::Peer,
        Some(1),
        move |steps, until, watch: &mut dyn FnMut(Deviation)| {
            let (mut world, handle) = body.world(problem, until / steps as f64);
            let deviation = problem.deviation();
            for _ in 0..steps {
                world.step();
                let (x, xi) = state(&world, handle);
                watch(deviation(&x, &xi));
            }
            let (x, xi) = state(&world, handle);
            let error = (problem.error)(&x, &xi);
            Outcome {
                evaluations: Some(steps),
                error,
                failure: (!error.is_finite()).then(|| "not finite".to_string()),
                statistics: None,
            }
        },
        move |steps, part| {
            let (mut world, handle) = other.world(problem, problem.until / steps as f64);
            let begin = Instant::now();
            for _ in 0..part {
                world.step();
            }
            let seconds = begin.elapsed().as_secs_f64();
            black_box(state(&world, handle));
            Some(seconds)
        },
    ))
}

fn vector([x, y, z]: [f64; 3]) -> Vector {
    Vector::new(x, y, z)
}

/// Makes a matrix from its rows.
fn matrix(m: [[f64; 3]; 3]) -> Matrix {
    Matrix::from_cols_array_2d(&m).transpose()
}

impl Body {
    fn world<Sys, U>(
        &self,
        problem: &Problem<'_, Sys, U>,
        step: f64,
    ) -> (PhysicsWorld, RigidBodyHandle)
    where
        Sys: Energies<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>,
    {
        let (r, w) = (problem.x, so3::apply(problem.x, problem.xi));
        let centre = so3::apply(r, self.centre);
        let velocity = if self.joint {
            so3::cross(w, centre)
        } else {
            [0.0; 3]
        };
        let mut world = PhysicsWorld::new();
        world.gravity = vector(self.gravity);
        world.integration_parameters.dt = step;
        let inertia = MassProperties::with_inertia_matrix(
            vector(self.centre),
            self.mass,
            matrix(self.inertia),
        );
        let body = RigidBodyBuilder::dynamic()
            .pose(Pose::from_parts(
                Vector::ZERO,
                Rotation::from_mat3(&matrix(rows(r))),
            ))
            .additional_mass_properties(inertia)
            .linvel(vector(velocity))
            .angvel(vector(w))
            .gyroscopic_forces_enabled(true)
            .allow_fast_rotation(true)
            .can_sleep(false);
        let body = world.insert_body(body);
        if self.joint {
            let ground = world.insert_body(RigidBodyBuilder::fixed());
            world.insert_impulse_joint(ground, body, SphericalJointBuilder::new());
        }
        (world, body)
    }
}

/// Returns (R, ω) in our axes.
fn state(world: &PhysicsWorld, handle: RigidBodyHandle) -> ([f64; 9], [f64; 3]) {
    let Some(body) = world.bodies.get(handle) else {
        return ([f64::NAN; 9], [f64::NAN; 3]);
    };
    let [[a, d, g], [b, e, h], [c, f, i]] = Matrix::from_quat(*body.rotation()).to_cols_array_2d();
    let r = [a, b, c, d, e, f, g, h, i];
    let w: Vector = body.angvel();
    (r, so3::apply_transpose(r, [w.x, w.y, w.z]))
}
