//! Times generated Rust against Pinocchio's C++ for the same robots, alternately in one process: inverse and forward
//! dynamics, the slopes of forward dynamics, the torque regressor, and the Jacobian of a link.
//!
//! Started by `lab/pinocchio/run.sh`; inputs, rounds and medians are those of `lab/c` and `lab/casadi`. All
//! values are compared before they are timed. Pinocchio is called in several ways: by the functions compiled in its
//! wheel, by the same templates compiled for this machine by g++ and clang++, and with ABA in the faster of its
//! conventions. Each way has a column; ratios refer to the fastest.
//!
//! The functions differ slightly:
//! - `slopes` are [A B] together with ξ̇, written to the same memory in each call: in addition to ∂ξ̇/∂h, ∂ξ̇/∂ξ and
//!   ∂ξ̇/∂u, which `computeABADerivatives` gives as well, they contain the rows of ∂ḣ/∂h and ∂ḣ/∂ξ.
//! - `regressor` has a column for each base parameter, `computeJointTorqueRegressor` ten for each body. Therefore the
//!   forces Y β and Y π are compared.
//! - `computeFrameJacobian` in `LOCAL_WORLD_ALIGNED` includes its forward kinematics, as the emitted Jacobian does.
//!
//! A floating base has other coordinates in Pinocchio, a quaternion for the rotation, but the same velocities and the
//! same displacements, those of the body in body axes. Therefore all values can be compared.

mod peer;

use hamel::{System, Table, Tangent};
use hamel_lab::input::{Input, input};
use hamel_lab::measure::INPUTS;
use hamel_lab::robots::Robot;
use hamel_lab::{measure, robots};
use libloading::Library;
use peer::{Description, Peer};
use std::cell::RefCell;
use std::error::Error;
use std::hint::black_box;
use std::path::{Path, PathBuf};

mod ur5 {
    include!(concat!(env!("OUT_DIR"), "/ur5.rs"));
    pub mod link {
        include!(concat!(env!("OUT_DIR"), "/ur5_wrist_3_link.rs"));
    }
}
mod panda {
    include!(concat!(env!("OUT_DIR"), "/panda.rs"));
    pub mod link {
        include!(concat!(env!("OUT_DIR"), "/panda_panda_link7.rs"));
    }
}
mod solo12 {
    include!(concat!(env!("OUT_DIR"), "/solo12.rs"));
    pub mod link {
        include!(concat!(env!("OUT_DIR"), "/solo12_FL_FOOT.rs"));
    }
}

/// Largest accepted difference of results, relative to the largest component.
const AGREEMENT: f64 = 1e-9;

/// The reader of URDF files, and the driver compiled in several ways.
struct Libraries {
    reader: Library,
    drivers: Vec<(String, Library)>,
}

/// The arguments of the functions.
struct Point<S: System> {
    x: S::Coordinates,
    xi: S::Velocities,
    u: S::Inputs,
    xi_dot: S::Velocities,
}

/// The inputs of `lab/c`; further velocities serve as accelerations.
fn points<S: System>(system: &S) -> Vec<Point<S>> {
    let point = |k| {
        let Input { x, xi, u } = input(system, k);
        let xi_dot = input(system, k + INPUTS).xi;
        Point { x, xi, u, xi_dot }
    };
    (0..INPUTS).map(point).collect()
}

/// Pinocchio's configuration. A floating base has its position and a quaternion, the real part last. The rotations of
/// the inputs are less than half a turn, so the real part is not small.
fn configuration(x: &[f64], floating: bool) -> Vec<f64> {
    let (base, joints) = x.split_at(if floating { 12 } else { 0 });
    if base.is_empty() {
        return joints.to_vec();
    }
    let entry = |i: usize, j: usize| base[3 + 3 * i + j];
    let w = (1.0 + entry(0, 0) + entry(1, 1) + entry(2, 2)).sqrt() / 2.0;
    let [a, b, c] = [(2, 1), (0, 2), (1, 0)].map(|(i, j)| (entry(i, j) - entry(j, i)) / (4.0 * w));
    [&base[..3], &[a, b, c, w], joints].concat()
}

/// The columns of ∂ξ̇ in [A B] for n variables from `first` on, by rows.
fn block<S: Tangent<Scalar = f64>>(slopes: &S::Slopes, first: usize, n: usize) -> Vec<f64> {
    let rows = (n..2 * n).map(|i| &slopes.row(i)[first..first + n]);
    rows.flatten().copied().collect()
}

/// Checks that the matrices of both sides agree. An empty list counts as a failure of ours.
fn agree(what: &str, ours: &[Vec<f64>], theirs: &[Vec<f64>]) -> Result<(), String> {
    if ours.len() != theirs.len() {
        return Err(format!("{what}: no value of hamel"));
    }
    for (ours, theirs) in ours.iter().zip(theirs) {
        let scale = ours.iter().fold(1.0_f64, |most, v| most.max(v.abs()));
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= AGREEMENT * scale;
        if ours.len() != theirs.len() || !ours.iter().zip(theirs).all(near) {
            return Err(format!(
                "{what}: {ours:?} of hamel, {theirs:?} of Pinocchio"
            ));
        }
    }
    Ok(())
}

/// Matrices of a function of the driver at a state.
type Theirs<'a> = &'a dyn Fn(&Peer, &str, usize) -> Result<Vec<Vec<f64>>, Box<dyn Error>>;

/// A robot in hamel and in Pinocchio.
struct Sides<'a> {
    name: &'a str,
    /// Pinocchio's robots, each with the name of the way in which it was compiled.
    peers: Vec<(&'a str, Peer<'a>)>,
}

impl Sides<'_> {
    /// Compares a function, times it and prints a row. The arguments are the equivalent functions of the driver, the
    /// values of both sides to compare, and our function over all states.
    fn row(
        &self,
        function: &str,
        names: &[&str],
        theirs: Theirs<'_>,
        ours: &dyn Fn(usize) -> Vec<Vec<f64>>,
        run: &dyn Fn(u32),
    ) -> Result<(), Box<dyn Error>> {
        print!("| {} | {function} |", self.name);
        let (mut fastest, mut own) = (f64::INFINITY, f64::INFINITY);
        for (way, peer) in &self.peers {
            let mut least = f64::INFINITY;
            for &name in names {
                for k in 0..INPUTS {
                    let what = format!("{}, {name}, {way}", self.name);
                    agree(&what, &ours(k), &theirs(peer, name, k)?)?;
                }
                let function = peer.function(name)?;
                let (a, b) = measure::by_turns(&|count| function.run(count), run);
                (least, own) = (least.min(a), own.min(b));
            }
            print!(" {least:.1} |");
            fastest = fastest.min(least);
        }
        println!(" {own:.1} | {:.2} |", fastest / own);
        Ok(())
    }
}

/// Returns a value with an entry for each velocity.
fn vector(peer: &Peer, name: &str, k: usize) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    Ok(vec![peer.function(name)?.value(k, peer.size("pin_nv")?)])
}

/// Runs a function over all points, behind a pointer.
fn runs<S, P, T>(system: &S, points: &[P], function: &dyn Fn(&S, &P) -> T) -> impl Fn(u32) {
    move |count| {
        let (system, function) = (black_box(system), black_box(function));
        for _ in 0..count {
            for point in points {
                black_box(&function(system, point));
            }
        }
    }
}

/// Returns the robots of each library, with the same states.
fn peers<'a, S: System<Scalar = f64>>(
    libraries: &'a Libraries,
    folder: &Path,
    robot: &Robot,
    points: &[Point<S>],
) -> Result<Vec<(&'a str, Peer<'a>)>, Box<dyn Error>> {
    let description = Description::read(&libraries.reader, folder, robot)?;
    let open = |(way, library): &'a (String, Library)| {
        let mut peer = Peer::open(library, &description)?;
        for at in points {
            let q = configuration(at.x.as_ref(), robot.floating);
            peer.add([&q, at.xi.as_ref(), at.xi_dot.as_ref(), at.u.as_ref()])?;
        }
        Ok((way.as_str(), peer))
    };
    libraries.drivers.iter().map(open).collect()
}

/// Prints the rows of a robot. A macro, since the functions of each robot have different types.
macro_rules! robot {
    ($libraries:expr, $folder:expr, $title:literal, $robot:expr, $module:ident::$system:ident, $jacobian:ident) => {{
        type Model = $module::$system<f64>;
        type Link = $module::link::$system<f64>;
        const N: usize = Model::VELOCITIES;
        let (system, link) = (&Model::default(), &Link::new()?);
        let points = &points(system);
        let peers = peers($libraries, $folder, &$robot, points)?;
        let sides = Sides {
            name: $title,
            peers,
        };
        let inverse =
            |system: &Model, at: &Point<Model>| system.inverse_dynamics(&at.x, &at.xi, &at.xi_dot);
        sides.row(
            "inverse dynamics",
            &["pin_rnea"],
            &vector,
            &|k| vec![inverse(system, &points[k]).to_vec()],
            &runs(system, points, &inverse),
        )?;
        let forward = |system: &Model, at: &Point<Model>| system.accel(&at.x, &at.xi, &at.u);
        sides.row(
            "forward dynamics",
            &["pin_aba_local", "pin_aba_world"],
            &vector,
            &|k| {
                let found = forward(system, &points[k]);
                found.map(|found| vec![found.to_vec()]).unwrap_or_default()
            },
            &runs(system, points, &forward),
        )?;
        let slopes = |system: &Model, at: &Point<Model>| system.linearize(&at.x, &at.xi, &at.u);
        // Results are written to the same memory in each call, as Pinocchio's are.
        let place = RefCell::new(<Model as Tangent>::Slopes::zero());
        let slopes_in_place = |system: &Model, at: &Point<Model>| {
            let mut place = place.borrow_mut();
            let rates = system.slopes(&at.x, &at.xi, &at.u, &mut place);
            black_box(&*place);
            rates
        };
        sides.row(
            "slopes of forward dynamics",
            &["pin_derivatives"],
            &|peer, name, k| {
                Ok(vec![
                    peer.function(name)?.value(k, N * N),
                    peer.last("pin_by_velocity", N * N)?,
                    peer.last("pin_by_force", N * N)?,
                ])
            },
            &|k| {
                let found = slopes(system, &points[k]);
                let parts =
                    found.map(|found| [0, N, 2 * N].map(|first| block::<Model>(&found, first, N)));
                parts.map(|parts| parts.to_vec()).unwrap_or_default()
            },
            &runs(system, points, &slopes_in_place),
        )?;
        let regressor =
            |system: &Model, at: &Point<Model>| system.regressor(&at.x, &at.xi, &at.xi_dot);
        sides.row(
            "torque regressor",
            &["pin_regressor"],
            &|peer, name, k| {
                let parameters = peer.parameters()?;
                let columns = peer.function(name)?.value(k, N * parameters.len());
                let mut force = vec![0.0; N];
                for (column, parameter) in columns.chunks(N).zip(parameters) {
                    force
                        .iter_mut()
                        .zip(column)
                        .for_each(|(force, entry)| *force += entry * parameter);
                }
                Ok(vec![force])
            },
            &|k| {
                let beta = system.base_parameters();
                let force = regressor(system, &points[k])
                    .map(|row| row.iter().zip(&beta).map(|(a, b)| a * b).sum());
                vec![force.to_vec()]
            },
            &runs(system, points, &regressor),
        )?;
        let jacobian = |link: &Link, at: &Point<Model>| link.$jacobian(&at.x);
        sides.row(
            &format!("Jacobian of `{}`", $robot.link),
            &["pin_jacobian"],
            &|peer, name, k| Ok(vec![peer.function(name)?.value(k, 6 * N)]),
            &|k| {
                let rows = jacobian(link, &points[k]);
                vec![(0..N).flat_map(|j| rows.map(|row| row[j])).collect()]
            },
            &runs(link, points, &jacobian),
        )?;
    }};
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [folder, reader, drivers @ ..] = arguments.as_slice() else {
        return Err("the folder of the robots and the reader are missing".into());
    };
    // SAFETY: the only constructors are those of Pinocchio and its dependencies, which touch nothing else.
    let open = |path: &PathBuf| unsafe { Library::new(path) };
    let mut libraries = Libraries {
        reader: open(reader)?,
        drivers: Vec::new(),
    };
    let (mut ways, mut lines) = (String::new(), String::new());
    for path in drivers {
        let way = path.file_stem().unwrap_or_default().to_string_lossy();
        ways += &format!(" Pinocchio, {way}, ns |");
        lines += "---:|";
        libraries.drivers.push((way.into_owned(), open(path)?));
    }
    let libraries = &libraries;
    println!("| robot | function |{ways} hamel, ns | ratio |\n|---|---|{lines}---:|---:|");
    robot!(
        libraries,
        folder,
        "UR5",
        robots::UR5,
        ur5::Ur5,
        wrist_3_link_jacobian
    );
    robot!(
        libraries,
        folder,
        "Panda",
        robots::PANDA,
        panda::Panda,
        panda_link7_jacobian
    );
    robot!(
        libraries,
        folder,
        "Solo12",
        robots::SOLO12,
        solo12::Solo,
        fl_foot_jacobian
    );
    Ok(())
}
