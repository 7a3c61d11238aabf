//! Robots from their URDF files, unchanged and with angles perturbed by 1e-3 … 1e-15 rad, against their
//! dynamics computed from the definitions in double-double arithmetic.
//!
//! The files are those of the wheel `example-robot-data`, which `tests/robots/install.sh` installs below
//! the target folder; without them the test prints this and ends. By default a few robots are tried; all of
//! them with `HAMEL_ATTACK=full` (`tests/robots/shake.sh`).

use crate::described::{Dynamics, Robot};
use crate::installed::installed;
use hamel_codegen::algebra::double::Double;
use hamel_codegen::algebra::residue_pair::Random;
use hamel_codegen::functions::{Asked, FunctionId};
use hamel_codegen::generate::Generated;
use hamel_codegen::lower;
use hamel_codegen::model::layout::{Block, rotation};
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::render::render;
use hamel_codegen::syntax::parse_text;
use hamel_codegen::urdf::{Mimic, Options, TOLERANCE, import};
use std::path::{Path, PathBuf};

/// Largest error relative to the scale of a result.
const CLOSE: f64 = 1e-13;
/// Robots of a default run.
const FEW: [&str; 5] = [
    "ur5_robot.urdf",
    "z1.urdf",
    "so101.urdf",
    "solo12.urdf",
    "finger_edu.urdf",
];
const FUNCTIONS: [FunctionId; 4] = [
    FunctionId::Accel,
    FunctionId::MassMatrix,
    FunctionId::Bias,
    FunctionId::PotentialForce,
];

fn full() -> bool {
    std::env::var("HAMEL_ATTACK").as_deref() == Ok("full")
}

/// A random number in ±1.
fn number(random: &mut Random) -> f64 {
    (random.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// The text with 10^-`power` times a number in ±1 added to every angle of every `rpy`.
fn shaken(text: &str, power: i32, random: &mut Random) -> String {
    let mut parts = text.split("rpy=\"");
    let mut all = parts.next().unwrap_or_default().to_string();
    for part in parts {
        let (angles, rest) = part.split_once('"').expect("a quoted attribute");
        let moved: Vec<String> = angles
            .split_whitespace()
            .map(|text| match text.parse::<f64>() {
                Ok(angle) => (angle + number(random) * 10.0_f64.powi(-power)).to_string(),
                // Some files have text there that the import refuses.
                Err(_) => text.to_string(),
            })
            .collect();
        all += &format!("rpy=\"{}\"{rest}", moved.join(" "));
    }
    all
}

fn unit(n: usize, random: &mut Random) -> Vec<f64> {
    let entries: Vec<f64> = (0..n).map(|_| number(random)).collect();
    let length = entries.iter().map(|e| e * e).sum::<f64>().sqrt();
    entries.iter().map(|e| e / length).collect()
}

fn configuration(blocks: &[Block], random: &mut Random) -> Vec<f64> {
    let mut x = Vec::new();
    for &block in blocks {
        match block {
            Block::Circle => x.extend(unit(2, random)),
            Block::Quaternion => x.extend(unit(4, random)),
            Block::Rotation => {
                let q = unit(4, random);
                x.extend(rotation([q[0], q[1], q[2], q[3]], 2.0));
            }
            Block::Flat(n) => x.extend((0..n).map(|_| number(random))),
        }
    }
    x
}

fn largest<'a>(entries: impl IntoIterator<Item = &'a Double>) -> f64 {
    let sizes = entries.into_iter().map(|entry| entry.abs().to_f64());
    sizes.fold(0.0, f64::max)
}

fn apart(found: &[f64], wanted: &[Double]) -> f64 {
    assert_eq!(found.len(), wanted.len());
    let both = found.iter().zip(wanted);
    let far = both.map(|(&a, &b)| (Double::new(a) - b).abs().to_f64());
    far.fold(0.0, |most, d| {
        if d.is_nan() {
            f64::INFINITY
        } else {
            f64::max(most, d)
        }
    })
}

/// The errors of ξ̇, M, bias and gradient of the potential at a random state, relative to their scales, or the reason
/// why there is no program.
fn errors(text: &str, seed: u64) -> Result<Option<[f64; 4]>, String> {
    let shown = |errors: Vec<_>| render(&errors, "robot", text, false);
    let system = parse_text(text).map_err(shown)?;
    let Some(robot) = Robot::of(&system) else {
        return Ok(None);
    };
    let mut model = lower::build(&system).map_err(shown)?;
    model.asked = Asked::only(&FUNCTIONS);
    // If bodies have no moments, or freedoms no inertia, there is no ξ̇.
    let (generated, singular) = Generated::available(model, 0).map_err(shown)?;
    let program = &generated.program;
    let mut random = Random::new(seed);
    let x = configuration(&program.blocks, &mut random);
    let mut list = |n: usize| -> Vec<f64> { (0..n).map(|_| number(&mut random)).collect() };
    let (xi, u) = (list(program.n), list(program.m));
    let of = |name: &str| -> Result<Vec<f64>, String> {
        let function = program.function(name).expect("it was asked for");
        let compiled = Interpreter::new(program, function, &program.defaults);
        let value = compiled.call_with([&x, &xi, &u, &[], &[]]);
        value.map_err(|pivot| format!("{name}: pivot {pivot} is not positive"))
    };
    let Dynamics { mass, bias, slope } = &robot.dynamics(&x, &xi);
    let size = largest(mass.iter().flatten());
    let mut errors = [0.0; 4];
    if singular.is_none() {
        let exact = robot.dynamics(&x, &xi);
        let applied = applied(&generated, [&x, &xi, &u]);
        let right: Vec<Double> = (0..program.n)
            .map(|i| Double::new(applied[i]) - bias[i] - slope[i])
            .collect();
        let motion = exact.solve(&right);
        let of_motion = apart(&of("accel")?, &motion) / largest(&motion);
        errors[0] = of_motion / exact.condition();
    }
    errors[1] = apart(&of("mass_matrix")?, &mass.concat()) / size;
    errors[2] = apart(&of("bias")?, bias) / largest(bias).max(size);
    errors[3] = apart(&of("potential_force")?, slope) / largest(slope).max(size);
    Ok(Some(errors))
}

/// Forces of drives and dampers: products of a few numbers.
fn applied(generated: &Generated, [x, xi, u]: [&[f64]; 3]) -> Vec<f64> {
    let mut model = generated.model.clone();
    model.asked = Asked::only(&[FunctionId::GeneralizedForce]);
    let forces = Generated::of(model, 0).expect("the same model");
    let function = forces
        .program
        .function("generalized_force")
        .expect("it was asked for");
    let compiled = Interpreter::new(&forces.program, function, &forces.program.defaults);
    compiled.call_with([x, xi, u, &[], &[]]).expect("no pivots")
}

/// All URDF files of the wheel, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "urdf") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

#[test]
fn robots_keep_their_digits() {
    let Some(folder) = installed() else {
        eprintln!("robots are not shaken: tests/robots/install.sh installs their URDF");
        return;
    };
    let powers: &[i32] = if full() {
        &[3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]
    } else {
        &[4, 8]
    };
    let (mut failures, mut tried) = (Vec::new(), 0);
    for path in files(&folder) {
        let name = path
            .file_name()
            .expect("a file")
            .to_string_lossy()
            .into_owned();
        if !full() && !FEW.contains(&name.as_str()) {
            continue;
        }
        let urdf = std::fs::read_to_string(&path).expect("a text");
        let mut random = Random::new(0x5aa4);
        let mut texts = vec![("as it is".to_string(), urdf.clone())];
        texts.extend(powers.iter().map(|&power| {
            (
                format!("shaken by 1e-{power}"),
                shaken(&urdf, power, &mut random),
            )
        }));
        let ways = [
            (false, TOLERANCE),
            (false, 0.0),
            (true, TOLERANCE),
            (true, 0.0),
        ];
        for (turn, (how, text)) in texts.into_iter().enumerate() {
            // Unchanged with all options, perturbed with each option in turn.
            let chosen = ways
                .iter()
                .enumerate()
                .filter(|(way, _)| turn == 0 || turn % 4 == *way);
            for (_, &(floating, tolerance)) in chosen {
                let options = Options {
                    floating,
                    tolerance,
                    mimic: Mimic::Free,
                    ..Options::default()
                };
                let Ok(imported) = import(&text, &options) else {
                    continue;
                };
                let case = format!("{name}, {how}, floating {floating}, rounding {tolerance}");
                let errors = errors(&imported.text(), 7);
                if full() {
                    eprintln!("{case}: {errors:?}");
                }
                match errors {
                    Ok(None) => continue,
                    Ok(Some(errors)) if errors.iter().all(|&error| error <= CLOSE) => {}
                    other => failures.push(format!("{case}: {other:?}")),
                }
                tried += 1;
            }
        }
    }
    assert!(tried >= 3 * FEW.len(), "{tried} robots");
    assert!(
        failures.is_empty(),
        "{} of {tried}:\n{}",
        failures.len(),
        failures.join("\n")
    );
}
