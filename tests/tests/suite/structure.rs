//! The verdict on the structure of every model, checked by laws that are independent of the analysis.
//!
//! For a system that splits: T = ½ Σ P·J⁻¹P + ½ pᵀ D p with constant D, and the momenta change along ξ̇ of `accel` as
//! those of free rotors with kicks. For one that does not, each stated reason holds.

mod case;

use crate::derived::model;
use case::{Case, cases};
use hamel_codegen::derive::structure::choice::choose_method;
use hamel_codegen::model::layout::Block;
use hamel_codegen::program::structure::{Inertia, Reason, Splitting, Symmetry};
use hamel_codegen::proof::validate::validate;
use nalgebra::{DMatrix, DVector};
use std::fmt::Write;
use std::ops::Range;

/// Rounding of exact laws, relative to the largest term.
const ROUNDING_TOLERANCE: f64 = 1e-10;
/// Error of central differences of step [`DIFFERENCE_STEP`]: rounding 1e-16 / 1e-5 times the terms, truncation 1e-10 times third
/// derivatives.
const DIFFERENCE_TOLERANCE: f64 = 2e-7;
const DIFFERENCE_STEP: f64 = 1e-5;
/// Relative difference above which numbers count as different.
const DISTINCT_TOLERANCE: f64 = 1e-4;
/// Number of states for each law.
const STATES_PER_LAW: u64 = 5;

fn close(a: &DVector<f64>, b: &DVector<f64>, tolerance: f64, what: &str) {
    let scale = a.amax().max(b.amax()).max(1.0);
    let distance = (a - b).amax();
    assert!(
        distance <= tolerance * scale,
        "{what}: {distance:e} of {scale:e}"
    );
}

fn differ(a: &DMatrix<f64>, b: &DMatrix<f64>) -> bool {
    (a - b).amax() > DISTINCT_TOLERANCE * a.amax().max(b.amax())
}

/// T as a function of momenta is ½ Σ P·J⁻¹P + ½ pᵀ D p, with D determined at another state.
fn kinetic_energy_falls_apart(case: &mut Case, splitting: &Splitting) {
    let n = case.generated.program.n;
    let energy = |case: &Case, x: &[f64], p: &[f64]| {
        let xi = case.call("split_velocities", x, &[], &[], p);
        case.call("kinetic_energy", x, xi.as_slice(), &[], &[])[0]
    };
    let rotors = case.rotors(splitting);
    let turning: Vec<Range<usize>> = case
        .parts()
        .into_iter()
        .filter(|(_, block, ..)| matches!(block, Block::Quaternion | Block::Rotation))
        .map(|(.., rates)| rates)
        .collect();
    let uniform: Vec<usize> = (0..n)
        .filter(|i| turning.iter().all(|rates| !rates.contains(i)))
        .collect();
    let elsewhere = case.x();
    // ½ D_ij = T(eᵢ + eⱼ) − T(eᵢ) − T(eⱼ), halved on the diagonal.
    let single = |case: &Case, places: &[usize]| {
        let mut p = vec![0.0; n];
        places.iter().for_each(|&place| p[place] += 1.0);
        energy(case, &elsewhere, &p)
    };
    let d = DMatrix::from_fn(uniform.len(), uniform.len(), |i, j| {
        let (i, j) = (uniform[i], uniform[j]);
        single(case, &[i, j]) - single(case, &[i]) - single(case, &[j])
    });
    for _ in 0..STATES_PER_LAW {
        let (x, p) = (case.x(), case.numbers(n));
        let mut expected: f64 = 0.0;
        for (rates, j) in turning.iter().zip(&rotors) {
            let own = DVector::from_column_slice(&p[rates.clone()]);
            let inverse = j.clone().try_inverse().expect("a rotor has inertia");
            expected += 0.5 * own.dot(&(inverse * &own));
        }
        let own = DVector::from_iterator(uniform.len(), uniform.iter().map(|&i| p[i]));
        expected += 0.5 * own.dot(&(&d * &own));
        let found = energy(case, &x, &p);
        let scale = expected.abs().max(1e-300);
        assert!(
            (found - expected).abs() <= ROUNDING_TOLERANCE * scale,
            "{}: T = {found}, {expected}",
            case.name
        );
    }
}

/// `centre` and `uncentre` are inverse, and so are `split_momenta` and `split_velocities`.
fn inverses(case: &mut Case) {
    let n = case.generated.program.n;
    for _ in 0..STATES_PER_LAW {
        let (x, xi) = (case.x(), case.numbers(n));
        let y = case.moved("centre", &x);
        let back = case.moved("uncentre", y.as_slice());
        let x_vector = DVector::from_column_slice(&x);
        close(
            &back,
            &x_vector,
            ROUNDING_TOLERANCE,
            &format!("{}: x of y", case.name),
        );
        let p = case.call("split_momenta", &x, &xi, &[], &[]);
        let back = case.call("split_velocities", &x, &[], &[], p.as_slice());
        let xi = DVector::from_vec(xi);
        close(
            &back,
            &xi,
            ROUNDING_TOLERANCE,
            &format!("{}: ξ of p", case.name),
        );
    }
}

/// Along ξ̇ of `accel`, ẏ = p, and ṗ is the kick, plus P × J⁻¹P for rotors.
fn motion_is_free_motion_and_kicks(case: &mut Case, splitting: &Splitting) {
    let (n, m) = (case.generated.program.n, case.generated.program.m);
    let rotors = case.rotors(splitting);
    for _ in 0..STATES_PER_LAW {
        let (x, xi, u) = (case.x(), case.numbers(n), case.numbers(m));
        let (rate, accel) = (
            case.call("rate", &x, &xi, &[], &[]),
            case.call("accel", &x, &xi, &u, &[]),
        );
        let after = |h: f64| -> (Vec<f64>, Vec<f64>) {
            let step = |v: &[f64], by: &DVector<f64>| -> Vec<f64> {
                v.iter().zip(by).map(|(v, by)| v + h * by).collect()
            };
            (step(&x, &rate), step(&xi, &accel))
        };
        let ((x1, xi1), (x2, xi2)) = (after(DIFFERENCE_STEP), after(-DIFFERENCE_STEP));
        let p_dot = (case.call("split_momenta", &x1, &xi1, &[], &[])
            - case.call("split_momenta", &x2, &xi2, &[], &[]))
            / (2.0 * DIFFERENCE_STEP);
        let y_dot =
            (case.moved("centre", &x1) - case.moved("centre", &x2)) / (2.0 * DIFFERENCE_STEP);
        let p = case.call("split_momenta", &x, &xi, &[], &[]);
        let mut expected = case.call("kick", &x, &[], &u, &[]);
        let mut rotor = rotors.iter();
        for (name, block, entries, rates) in case.parts() {
            let own = p.rows(rates.start, rates.len()).into_owned();
            match block {
                Block::Flat(_) => {
                    let moved = y_dot.rows(entries.start, entries.len()).into_owned();
                    close(
                        &moved,
                        &own,
                        DIFFERENCE_TOLERANCE,
                        &format!("{}: ẏ of {name}", case.name),
                    );
                }
                Block::Circle => {}
                _ => {
                    let j = rotor.next().expect("one rotor for each rotation");
                    let w = j.clone().try_inverse().expect("inertia") * &own;
                    let turn = own.cross(&w);
                    for (i, rate) in rates.enumerate() {
                        expected[rate] += turn[i];
                    }
                }
            }
        }
        close(
            &p_dot,
            &expected,
            DIFFERENCE_TOLERANCE,
            &format!("{}: ṗ", case.name),
        );
    }
}

/// The stated forms of inertias hold at the default parameters.
fn symmetries_hold(case: &Case, splitting: &Splitting) {
    for (form, j) in splitting.rotors.iter().zip(case.rotors(splitting)) {
        let equal =
            |a: usize, b: usize| (j[(a, a)] - j[(b, b)]).abs() <= ROUNDING_TOLERANCE * j[(a, a)];
        let [x, y, z] = [equal(1, 2), equal(2, 0), equal(0, 1)];
        match form.inertia {
            Inertia::Principal(Symmetry::Spherical) => assert!(x && y && z, "{}", case.name),
            Inertia::Principal(Symmetry::Axial(axis)) => assert!([x, y, z][axis], "{}", case.name),
            Inertia::Principal(Symmetry::None) => assert!(!(x || y || z), "{}", case.name),
            Inertia::Moments => {}
            Inertia::General => {
                let off = j[(0, 1)].abs() + j[(0, 2)].abs() + j[(1, 2)].abs();
                assert!(off > 0.0, "{}: a full inertia", case.name);
                assert!((&j - j.transpose()).amax() <= ROUNDING_TOLERANCE * j.amax());
            }
        }
    }
}

#[test]
fn what_splits_is_free_motion_and_kicks() {
    let mut found = 0;
    for mut case in cases() {
        let structure = case.generated.program.structure.clone();
        let Ok(splitting) = &structure.split else {
            assert!(case.interpreter("kick").is_none());
            continue;
        };
        found += 1;
        kinetic_energy_falls_apart(&mut case, splitting);
        inverses(&mut case);
        motion_is_free_motion_and_kicks(&mut case, splitting);
        symmetries_hold(&case, splitting);
        let (x, m) = (case.x(), case.generated.program.m);
        let u = case.numbers(m);
        let still = case.call("kick", &x, &[], &u, &[]).amax() == 0.0;
        assert_eq!(still, splitting.free, "{}", case.name);
    }
    assert!(found >= 15, "{found} models split");
}

/// Returns whether forces at two velocities differ.
fn forces_change(case: &mut Case) -> bool {
    let (n, m) = (case.generated.program.n, case.generated.program.m);
    let model = &case.generated.model;
    let tied = !model.points.constraints.is_empty() || !model.constraints.is_empty();
    // Some forces act on one side only.
    [1.0, -1.0].into_iter().any(|side| {
        let (mut x, u) = (case.x(), case.numbers(m));
        for (_, block, entries, _) in case.parts() {
            if matches!(block, Block::Flat(_)) && !tied {
                x[entries].iter_mut().for_each(|entry| *entry *= side);
            }
        }
        let (a, b) = (case.numbers(n), case.numbers(n));
        let at = |xi: &[f64]| case.call("generalized_force", &x, xi, &u, &[]);
        (at(&a) - at(&b)).amax() > DISTINCT_TOLERANCE
    })
}

/// Returns whether M in the rates of the coordinates changes with each named coordinate, and whether det M changes,
/// which no shift of plain coordinates by a function of rotating ones could undo.
fn inertia_changes(case: &mut Case, on: &[String]) -> bool {
    let x = case.x();
    let here = case.inertia(&x);
    let parts = case.parts();
    let all = on.iter().all(|name| {
        let (_, block, entries, _) = parts
            .iter()
            .find(|(known, ..)| known == name)
            .expect("a coordinate");
        let mut there = x.clone();
        let point = case.point(*block);
        there[entries.clone()].copy_from_slice(&point);
        differ(&case.inertia(&there), &here)
    });
    let elsewhere = case.x();
    let there = case.inertia(&elsewhere).determinant();
    let plain = parts
        .iter()
        .all(|(_, block, ..)| matches!(block, Block::Flat(_)));
    all && (plain || (there / here.determinant() - 1.0).abs() > DISTINCT_TOLERANCE)
}

/// Returns whether the rates of a rotor and of another coordinate remain coupled after elimination of plain
/// coordinates.
fn coupled(case: &mut Case, rotor: &str, other: &str) -> bool {
    let x = case.x();
    let inertia = case.inertia(&x);
    let parts = case.parts();
    let flat = parts
        .iter()
        .filter(|(_, block, ..)| matches!(block, Block::Flat(_)));
    let plain: Vec<usize> = flat.flat_map(|(.., rates)| rates.clone()).collect();
    let block = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
            inertia[(rows[i], columns[j])]
        })
    };
    let rates = |name: &str| -> Vec<usize> {
        let found = parts.iter().find(|(known, ..)| known == name);
        found.expect("a coordinate").3.clone().collect()
    };
    let (a, b) = (rates(rotor), rates(other));
    let mut left = block(&a, &b);
    if !plain.is_empty() {
        let inverse = block(&plain, &plain).try_inverse().expect("masses");
        left -= block(&a, &plain) * inverse * block(&plain, &b);
    }
    left.amax() > DISTINCT_TOLERANCE * inertia.amax()
}

#[test]
fn what_stands_in_the_way_is_there() {
    let mut kinds = [0; 7];
    for mut case in cases() {
        let structure = case.generated.program.structure.clone();
        let Err(reasons) = &structure.split else {
            continue;
        };
        assert!(!reasons.is_empty(), "{}: no reason", case.name);
        for reason in reasons {
            let (kind, holds) = match reason {
                Reason::Constrained { .. } => (0, case.generated.model.is_constrained()),
                Reason::Time => (5, case.generated.model.clock.is_some()),
                Reason::States => (6, case.generated.program.n_z > 0),
                Reason::Tied {
                    directions,
                    velocities,
                } => (
                    1,
                    directions > velocities && !case.generated.model.points.constraints.is_empty(),
                ),
                Reason::Mass { on } => (2, !on.is_empty() && inertia_changes(&mut case, on)),
                Reason::Coupled { rotor, other } => (3, coupled(&mut case, rotor, other)),
                Reason::Velocities { .. } => (4, forces_change(&mut case)),
                Reason::Rates => panic!("{}: rates are measured alike everywhere", case.name),
            };
            kinds[kind] += 1;
            assert!(holds, "{}: {reason}", case.name);
        }
        let named = reasons
            .iter()
            .any(|reason| matches!(reason, Reason::Velocities { .. }));
        assert_eq!(named, forces_change(&mut case), "{}: forces", case.name);
    }
    assert!(kinds.iter().all(|&count| count > 0), "{kinds:?}");
}

/// M depends on exactly the coordinates that are named.
#[test]
fn the_mass_matrix_depends_on_what_is_named() {
    for mut case in cases() {
        let model = &case.generated.model;
        if !model.points.constraints.is_empty() || !model.constraints.is_empty() {
            continue;
        }
        let x = case.x();
        let here = case.call("mass_matrix", &x, &[], &[], &[]);
        for (name, block, entries, _) in case.parts() {
            let mut there = x.clone();
            let point = case.point(block);
            there[entries].copy_from_slice(&point);
            let there = case.call("mass_matrix", &there, &[], &[], &[]);
            let changes = (&there - &here).amax() > DISTINCT_TOLERANCE * here.amax();
            let named = case.generated.program.structure.mass.contains(&name);
            assert_eq!(changes, named, "{}: {name}", case.name);
        }
    }
}

/// The verdicts on all models, and the method chosen for each of them.
#[test]
fn verdicts() {
    let mut text = String::new();
    for case in cases() {
        let structure = &case.generated.program.structure;
        let _ = writeln!(text, "{}", case.name);
        for line in structure.lines() {
            let _ = writeln!(text, "  {line}");
        }
        let _ = writeln!(text, "  {}", choose_method(structure, None));
        let (short, long) = (
            choose_method(structure, Some(1000)),
            choose_method(structure, Some(1_000_000)),
        );
        if short != long {
            let _ = writeln!(text, "  a million steps: {long}");
        }
        text.push('\n');
    }
    insta::assert_snapshot!(text);
}

/// Validation detects a wrong sign in every function of a system that splits.
#[test]
fn wrong_signs_are_noticed_before_emission() {
    for name in ["free_body", "free_body_both", "planar_body"] {
        let generated = model(name).generated();
        assert!(validate(&generated.model, &generated.program).is_ok());
        for function in [
            "centre",
            "uncentre",
            "split_momenta",
            "split_velocities",
            "kick",
            "rotor_inertia",
        ] {
            let mut program = generated.program.clone();
            let functions = program.functions.iter_mut();
            let Some(found) = functions.into_iter().find(|f| f.name == function) else {
                assert_eq!((name, function), ("planar_body", "rotor_inertia"));
                continue;
            };
            let zero = program.graph.zero();
            let edge = found.outputs.iter_mut().find(|edge| **edge != zero);
            let edge = edge.expect("a value");
            *edge = -*edge;
            let verdict = validate(&generated.model, &program);
            assert!(verdict.is_err(), "{name}: {function} has a wrong sign");
        }
    }
}
