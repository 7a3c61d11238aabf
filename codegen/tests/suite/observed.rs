//! Observed functions on every model of the tests: poses, twists, Jacobians and bias accelerations of frames, the
//! momentum about the centre of mass, and the slopes of outputs, of inverse dynamics and of ξ̇ by parameters, compared
//! with numerical differences. This is independent of the proofs: no derivative is taken here.

use crate::common::{Random, attack, generated, value};
use crate::thinning::thin_out;
use crate::tree::{ALL, Kind, Link, text};
use hamel_codegen::functions::{FrameFunction, Jacobian};
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::lower::build;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::render::render;
use hamel_codegen::syntax::{parse_text, read_files};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/models");
/// Step of differences, which are extrapolated to fourth order.
const DIFFERENCE_STEP: f64 = 2e-4;
/// Relative to the largest entry: h⁴ times derivatives, and rounding over h.
const TOLERANCE: f64 = 1e-8;

struct Case {
    name: String,
    generated: Generated,
    x: Vec<f64>,
    xi: Vec<f64>,
    u: Vec<f64>,
}

impl Case {
    fn call(&self, function: &str, x: &[f64], xi: &[f64], xi_dot: &[f64]) -> Vec<f64> {
        self.call_at(function, x, xi, &self.u, xi_dot)
    }

    fn call_at(
        &self,
        function: &str,
        x: &[f64],
        xi: &[f64],
        u: &[f64],
        xi_dot: &[f64],
    ) -> Vec<f64> {
        let found = self.generated.program.function(function);
        let found = found.unwrap_or_else(|| panic!("{}: no {function}", self.name));
        let params = &self.generated.model.defaults;
        let interpreter = Interpreter::new(&self.generated.program, found, params);
        let value = interpreter.call(x, xi, u, xi_dot);
        value.unwrap_or_else(|pivot| panic!("{}: {function}: pivot {pivot}", self.name))
    }

    /// Returns x after a time h at constant ξ, by one Runge-Kutta step.
    fn later(&self, h: f64) -> Vec<f64> {
        let rate = |x: &[f64]| self.call("rate", x, &self.xi, &[]);
        let ahead = |k: &[f64], h: f64| -> Vec<f64> {
            self.x.iter().zip(k).map(|(x, k)| x + h * k).collect()
        };
        let k1 = rate(&self.x);
        let k2 = rate(&ahead(&k1, h / 2.0));
        let k3 = rate(&ahead(&k2, h / 2.0));
        let k4 = rate(&ahead(&k3, h));
        let sum = |i: usize| k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i];
        let steps = (0..self.x.len()).map(|i| self.x[i] + h / 6.0 * sum(i));
        steps.collect()
    }

    fn same(&self, what: &str, found: &[f64], wanted: &[f64]) {
        assert_eq!(found.len(), wanted.len(), "{}: {what}", self.name);
        let size = wanted.iter().fold(1.0_f64, |most, v| most.max(v.abs()));
        let pairs = found.iter().zip(wanted);
        let worst = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(
            worst <= TOLERANCE * size,
            "{}: {what} differs by {worst:.1e}: {found:?}, {wanted:?}",
            self.name
        );
    }
}

/// d/dh of f at 0, to fourth order
fn slope(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let central = |h: f64| -> Vec<f64> {
        let (ahead, behind) = (f(h), f(-h));
        let pairs = ahead.iter().zip(&behind);
        pairs.map(|(a, b)| (a - b) / (2.0 * h)).collect()
    };
    let (near, far) = (central(DIFFERENCE_STEP), central(2.0 * DIFFERENCE_STEP));
    near.iter()
        .zip(&far)
        .map(|(n, f)| (4.0 * n - f) / 3.0)
        .collect()
}

/// Generates a model with all observed functions; `None` if it has none.
fn case(path: &Path) -> Option<Case> {
    let text = std::fs::read_to_string(path).expect("a text");
    let mut open = |name: &str| std::fs::read_to_string(path.with_file_name(name));
    let mut system = parse_text(&text).expect("a description");
    read_files(&mut system, &mut open).expect("files");
    let model = build(&system).expect("a model");
    let frame = model.frames.last().map(|frame| frame.name.clone());
    let mut asked = vec!["rate".to_string()];
    if let Some(name) = frame {
        asked.push(format!("jacobian {name}, jacobian {name} in {name}"));
    }
    // Energies given by `kinetic` have no momentum in space, and neither has a body at rest.
    if !model.bodies.is_empty() && !text.contains("kinetic") {
        asked.push("centroidal_map, centroidal_bias, centre_of_mass".into());
    }
    let slopes = model
        .outputs
        .iter()
        .map(|(name, _)| format!("{name}_slopes, {name}"));
    asked.extend(slopes);
    if asked.len() == 1 {
        return None;
    }
    let case = asked_for(path, &asked.join(", "));
    Some(case.unwrap_or_else(|errors| panic!("{errors}")))
}

/// Generates these functions of a model at a state near its start, not at rest; returns the errors if they are refused.
fn asked_for(path: &Path, asked: &str) -> Result<Case, String> {
    let generated = crate::models::asked_for(path, asked)?;
    let name = path.display().to_string();
    let model = &generated.active;
    // Near the start, and not at rest.
    let moving = |i: usize| 0.3 + 0.17 * i as f64 - 0.01 * (i * i) as f64;
    let xi = [&model.start_xi[..], &model.start_z].concat();
    let n = model.n();
    let xi = xi.iter().enumerate();
    let xi = xi.map(|(i, v)| if i < n { v + moving(i) } else { *v });
    Ok(Case {
        x: model.start_x.clone(),
        xi: xi.collect(),
        u: (0..model.m()).map(moving).collect(),
        name,
        generated,
    })
}

/// Returns the models for slow comparisons, and a function that scales a count for all models to these.
fn slow() -> (Vec<PathBuf>, impl Fn(usize) -> usize) {
    let all = crate::models::models(Path::new(FOLDER));
    let of = all.len();
    let some = thin_out(all);
    let looked = some.len();
    (some, move |number| number * looked / of)
}

#[test]
fn what_is_observed_agrees_with_differences() {
    let (all, part) = slow();
    let seen = all.par_iter().filter_map(|path| {
        let case = case(path)?;
        let asked = &case.generated.active.asked;
        for jacobian in &asked.jacobians {
            frame(&case, jacobian);
        }
        let centroidal = case.generated.program.function("centroidal_map").is_some();
        if centroidal {
            momentum(&case);
        }
        for output in &asked.slopes {
            output_slopes(&case, output);
        }
        Some([
            asked.jacobians.len(),
            usize::from(centroidal),
            asked.slopes.len(),
        ])
    });
    let [frames, centroidal, slopes] = summed(seen);
    assert!(
        frames > part(60) && centroidal > part(20) && slopes > part(20),
        "{frames} {centroidal} {slopes}"
    );
}

/// Returns the sums of the counts.
fn summed<const N: usize>(seen: impl ParallelIterator<Item = [usize; N]>) -> [usize; N] {
    seen.reduce(|| [0; N], |a, b| std::array::from_fn(|i| a[i] + b[i]))
}

/// Slopes of inverse dynamics by displacements and velocities, and of ξ̇ by parameters.
#[test]
fn slopes_of_dynamics_agree_with_differences() {
    let (all, part) = slow();
    let seen = all.par_iter().map(|path| {
        let inverse = asked_for(path, "linearize, inverse_dynamics_slopes");
        if let Ok(case) = &inverse {
            inverse_slopes(case);
        }
        let parameters = asked_for(path, "parameter_slopes");
        match &parameters {
            Ok(case) => parameter_slopes(case),
            Err(why) => assert!(why.contains("`parameter_slopes` is not known"), "{why}"),
        }
        [inverse.is_ok(), parameters.is_ok()].map(usize::from)
    });
    let [inverse, parameters] = summed(seen);
    assert!(
        inverse > part(60) && parameters > part(50),
        "{inverse} {parameters}"
    );
}

fn inverse_slopes(case: &Case) {
    let (n_x, n) = (case.x.len(), case.generated.active.n());
    let frame = case.call("displacement_frame", &case.x, &case.xi, &[]);
    let h = frame.len() / n_x;
    let xi_dot: Vec<f64> = (0..case.xi.len()).map(|i| 0.7 - 0.2 * i as f64).collect();
    let found = case.call("inverse_dynamics_slopes", &case.x, &case.xi, &xi_dot);
    assert_eq!(found.len(), n * (h + n), "{}", case.name);
    for column in 0..h + n {
        let ours: Vec<f64> = found.iter().skip(column).step_by(h + n).copied().collect();
        let along = |d: f64| {
            let (mut x, mut xi) = (case.x.clone(), case.xi.clone());
            match column.checked_sub(h) {
                None => x
                    .iter_mut()
                    .enumerate()
                    .for_each(|(i, x)| *x += d * frame[i * h + column]),
                Some(j) => xi[j] += d,
            }
            case.call("inverse_dynamics", &x, &xi, &xi_dot)
        };
        case.same("a slope of inverse dynamics", &ours, &slope(along));
    }
}

fn parameter_slopes(case: &Case) {
    let program = &case.generated.program;
    let defaults = &case.generated.model.defaults;
    let found = case.call("parameter_slopes", &case.x, &case.xi, &[]);
    let accel = program.function("accel").expect("ξ̇");
    for column in 0..defaults.len() {
        let ours = found.iter().skip(column).step_by(defaults.len());
        let ours: Vec<f64> = ours.copied().collect();
        let along = |d: f64| {
            let mut params = defaults.clone();
            params[column] += d;
            let changed = Interpreter::new(program, accel, &params);
            let value = changed.call(&case.x, &case.xi, &case.u, &[]);
            value.unwrap_or_else(|pivot| panic!("{}: pivot {pivot}", case.name))
        };
        // Small steps for parameters of any size.
        let scale = 1e-2 * defaults[column].abs().clamp(1e-3, 1.0);
        let slopes = slope(|d| along(d * scale));
        let ours: Vec<f64> = ours.iter().map(|slope| slope * scale).collect();
        case.same("a slope by a parameter", &ours, &slopes);
    }
}

/// Random trees with all kinds of joints, mounts in any direction, frames on frames, and joints that follow others.
#[test]
fn frames_of_random_trees_agree_with_differences() {
    attack(6, 600, |seed| {
        let mut random = Random::new(0xf4a3e + seed);
        let count = 2 + random.below(5);
        let mut links: Vec<Link> = Vec::new();
        while links.len() < count || links.iter().all(|link| link.freedoms() == 0) {
            let kinds = if links.len() > 6 {
                &[Kind::Revolute][..]
            } else {
                &ALL
            };
            links.push(Link::random(&mut random, &links, kinds));
        }
        let plain = from_text(&text(&links, "rate")).expect("a tree");
        let frames = &plain.model.frames;
        let name = &frames[random.below(frames.len())].name;
        let asked = format!(
            "rate, jacobian {name}, jacobian {name} in body, centroidal_map, centroidal_bias, centre_of_mass"
        );
        let text = text(&links, &asked);
        let name = format!("tree {seed}");
        let generated = from_text(&text)
            .unwrap_or_else(|errors| panic!("{}", render(&errors, &name, &text, false)));
        let program = &generated.program;
        let case = Case {
            x: random.configuration(&program.blocks),
            xi: random.numbers(program.n),
            u: random.numbers(program.m),
            name,
            generated,
        };
        for jacobian in &case.generated.active.asked.jacobians {
            frame(&case, jacobian);
        }
        momentum(&case);
        Vec::new()
    });
}

fn frame(case: &Case, jacobian: &Jacobian) {
    let name = |of: FrameFunction| jacobian.name_of(of);
    let pose = |h: f64| case.call(&name(FrameFunction::Pose), &case.later(h), &case.xi, &[]);
    let here = pose(0.0);
    let rate = slope(pose);
    let r = |i: usize, j: usize| here[4 * i + j];
    let spin = |i: usize, j: usize| (0..3).map(|k| rate[4 * i + k] * r(j, k)).sum::<f64>();
    let axes = |v: [f64; 3]| -> [f64; 3] {
        match jacobian.own {
            true => [0, 1, 2].map(|j| (0..3).map(|i| r(i, j) * v[i]).sum()),
            false => v,
        }
    };
    let twist = [
        axes([rate[3], rate[7], rate[11]]),
        axes([spin(2, 1), spin(0, 2), spin(1, 0)]),
    ];
    let twist_at = |x: &[f64], xi: &[f64]| case.call(&name(FrameFunction::Twist), x, xi, &[]);
    let found = twist_at(&case.x, &case.xi);
    case.same("a twist", &found, &twist.concat());
    let bias = case.call(
        &name(FrameFunction::BiasAcceleration),
        &case.x,
        &case.xi,
        &[],
    );
    case.same(
        "a bias",
        &bias,
        &slope(|h| twist_at(&case.later(h), &case.xi)),
    );
    let map = case.call(&name(FrameFunction::Jacobian), &case.x, &case.xi, &[]);
    columns(case, "a Jacobian", &map, |xi| twist_at(&case.x, xi));
}

/// Checks that each column of a map is the contribution of one velocity.
fn columns(case: &Case, what: &str, map: &[f64], of: impl Fn(&[f64]) -> Vec<f64>) {
    let n = case.generated.active.n();
    let here = of(&case.xi);
    for j in 0..n {
        let mut xi = case.xi.clone();
        xi[j] += 1.0;
        let more = of(&xi);
        let added: Vec<f64> = more.iter().zip(&here).map(|(a, b)| a - b).collect();
        let column: Vec<f64> = map.iter().skip(j).step_by(n).copied().collect();
        case.same(what, &column, &added);
    }
}

fn momentum(case: &Case) {
    let at = |x: &[f64], xi: &[f64]| case.call("centroidal_momentum", x, xi, &[]);
    let here = at(&case.x, &case.xi);
    let map = case.call("centroidal_map", &case.x, &case.xi, &[]);
    columns(case, "a centroidal map", &map, |xi| at(&case.x, xi));
    let bias = case.call("centroidal_bias", &case.x, &case.xi, &[]);
    case.same(
        "a centroidal bias",
        &bias,
        &slope(|h| at(&case.later(h), &case.xi)),
    );
    // P = m ċ, where m is the moving mass: the same factor in all directions.
    let speed = slope(|h| case.call("centre_of_mass", &case.later(h), &case.xi, &[]));
    let largest = (0..3).max_by(|&i, &j| speed[i].abs().total_cmp(&speed[j].abs()));
    let largest = largest.expect("three");
    let mass = here[largest] / speed[largest];
    if speed[largest].abs() > 1e-6 {
        let expected: Vec<f64> = speed.iter().map(|v| mass * v).collect();
        case.same("m ċ", &here[..3], &expected);
        assert!(mass > 0.0, "{}: {mass}", case.name);
    }
}

fn output_slopes(case: &Case, output: &str) {
    let program = &case.generated.program;
    let (n_x, moved) = (case.x.len(), case.xi.len());
    let frame = case.call("displacement_frame", &case.x, &case.xi, &[]);
    let h = frame.len() / n_x;
    let columns = h + moved + case.u.len();
    let found = case.call(&format!("{output}_slopes"), &case.x, &case.xi, &[]);
    let follows = program.function(output).is_some_and(|function| {
        let mut arguments = function.arguments.iter();
        arguments.any(|argument| *argument == hamel_codegen::functions::Argument::Accelerations)
    });
    let value = |column: usize, d: f64| -> Vec<f64> {
        let (mut x, mut xi, mut u) = (case.x.clone(), case.xi.clone(), case.u.clone());
        match column {
            j if j < h => x
                .iter_mut()
                .enumerate()
                .for_each(|(i, x)| *x += d * frame[i * h + j]),
            j if j < h + moved => xi[j - h] += d,
            j => u[j - h - moved] += d,
        }
        let xi_dot = match follows {
            true => case.call_at("accel", &x, &xi, &u, &[]),
            false => vec![0.0; moved],
        };
        case.call_at(output, &x, &xi, &u, &xi_dot)
    };
    for column in 0..columns {
        let ours: Vec<f64> = found
            .iter()
            .skip(column)
            .step_by(columns)
            .copied()
            .collect();
        case.same(
            &format!("the slopes of `{output}`"),
            &ours,
            &slope(|d| value(column, d)),
        );
    }
}

/// The momentum about the centre of mass is the same in orbit and on the ground, without loss of digits from position
/// and velocity of the whole.
#[test]
fn momenta_about_the_centre_of_mass_are_the_same_anywhere() {
    let of = generated(
        "system Orb {
            joint A: free moves a;
            joint h: revolute [0, 0, 1] on a at translation([1, 0, 0]) moves b;
            body on a { mass 100; com [0.1, 0, 0]; inertia diag(10, 20, 30) about com; }
            body on b { mass 20; com [0.5, 0, 0]; inertia diag(1, 2, 3) about com; }
            generate all, centroidal_momentum, centroidal_map, centroidal_bias;
        }",
    );
    let random = &mut Random::new(5);
    let mut x = random.configuration(&of.model.blocks);
    let mut xi = random.numbers(7);
    let angular = |x: &[f64], xi: &[f64]| {
        let mut all = Vec::new();
        for name in ["centroidal_momentum", "centroidal_map", "centroidal_bias"] {
            let found = value(&of, name, [x, xi, &[], &[]]);
            all.extend_from_slice(&found[found.len() / 2..]);
        }
        all
    };
    let near = angular(&x, &xi);
    for (place, far) in [7e6, -3e6, 2e6].into_iter().enumerate() {
        x[place] += far;
        xi[place] += far / 1000.0;
    }
    for (far, near) in angular(&x, &xi).into_iter().zip(near) {
        assert!(
            (far - near).abs() < 1e-12 * near.abs().max(1.0),
            "{far} for {near}"
        );
    }
}
