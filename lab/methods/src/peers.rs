//! Other programs on the same cases, each an optional feature or script. The report names the missing ones.

pub mod mujoco;
#[cfg(feature = "ode")]
mod ode;
#[cfg(feature = "rapier")]
mod rapier;

use crate::runner::{BenchError, Runner};
use hamel::Energies;
use hamel_report::data::{Case, MethodRuns, Missing, Peer};
use hamel_report::entry::Entry;
use hamel_report::problem::Problem;
use serde::Deserialize;

/// The results of other programs.
#[derive(Debug, Default)]
pub struct Peers {
    /// The programs, with version or reason of absence.
    pub list: Vec<Peer>,
    /// Results that were measured by another program.
    pub foreign: Vec<ForeignResults>,
}

/// The results of another program on one case.
#[derive(Debug, Deserialize)]
pub struct ForeignResults {
    /// Name of the case.
    pub case: String,
    /// Results of its methods.
    pub methods: Vec<MethodRuns>,
}

impl Peers {
    /// Finds the programs that are available. `python` runs the script for MuJoCo.
    pub fn find(python: &std::path::Path) -> Self {
        let mut peers = Peers::default();
        let with = "cargo run --release --manifest-path lab/Cargo.toml -p hamel-bench --features rapier,ode -- --out docs/report";
        peers.list.push(built(
            "Rapier 0.36 (rapier3d-f64)",
            cfg!(feature = "rapier"),
            "semi-implicit Euler of one rigid body, gyroscopic forces on; bodies of a ball joint by its solver",
            with,
        ));
        peers.list.push(built(
            "ode_solvers 0.6",
            cfg!(feature = "ode"),
            "classical Runge-Kutta of order 4 on the entries of R and ω, with the generated ξ̇",
            with,
        ));
        match mujoco::run(python) {
            Ok((version, foreign)) => {
                peers.foreign = foreign;
                peers.list.push(Peer {
                    name: format!("MuJoCo {version}"),
                    available: true,
                    note: "Euler, RK4, implicit: a free body and a top on a ball joint, through its Python wheel".into(),
                    start: mujoco::SETUP_COMMAND.into(),
                });
            }
            Err(why) => peers.list.push(Peer {
                name: "MuJoCo".into(),
                available: false,
                note: why,
                start: mujoco::SETUP_COMMAND.into(),
            }),
        }
        peers
    }

    /// Adds to a case the measurements of other programs; names the missing ones.
    pub fn add(&self, case: &mut Case) {
        for foreign in &self.foreign {
            if foreign.case == case.name {
                case.methods.extend(foreign.methods.iter().cloned());
            }
        }
    }
}

fn built(name: &str, available: bool, note: &str, start: &str) -> Peer {
    Peer {
        name: name.into(),
        available,
        note: if available {
            note.into()
        } else {
            "this run was built without it".into()
        },
        start: start.into(),
    }
}

/// Other programs on a torque-free body.
///
/// # Errors
/// If the reference lacks a value that they need.
pub fn free<'p, Sys, U>(
    runner: &mut Runner,
    problem: &'p Problem<'_, Sys, U>,
) -> Result<Vec<Entry<'p>>, BenchError>
where
    Sys: Energies<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>,
    U: Fn(f64, &[f64; 9], &[f64; 3]) -> [f64; 0],
{
    peers(runner, problem, false)
}

/// Other programs on a top.
///
/// # Errors
/// If the reference lacks a value that they need.
pub fn tops<'p, Sys, U>(
    runner: &mut Runner,
    problem: &'p Problem<'_, Sys, U>,
) -> Result<Vec<Entry<'p>>, BenchError>
where
    Sys: Energies<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>,
    U: Fn(f64, &[f64; 9], &[f64; 3]) -> [f64; 0],
{
    peers(runner, problem, true)
}

fn peers<'p, Sys, U>(
    runner: &mut Runner,
    problem: &'p Problem<'_, Sys, U>,
    joint: bool,
) -> Result<Vec<Entry<'p>>, BenchError>
where
    Sys: Energies<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>,
    U: Fn(f64, &[f64; 9], &[f64; 3]) -> [f64; 0],
{
    #[allow(unused_mut)]
    let mut entries: Vec<Entry<'p>> = Vec::new();
    #[cfg(feature = "ode")]
    entries.push(ode::rk4(problem));
    #[cfg(feature = "rapier")]
    entries.push(rapier::entry(runner, problem, joint)?);
    let _ = (problem, joint);
    for peer in &runner.peers.list {
        if !peer.available {
            runner.case.missing.push(Missing {
                method: peer.name.clone(),
                why: peer.note.clone(),
            });
        }
    }
    Ok(entries)
}
