//! Redundant rows of any kind are dropped with a warning. The motion is that of the remaining rows, and so are the
//! multipliers that are unique; the others are named.

use crate::common::{Random, attack, difference, generated, value};
use hamel_codegen::derive::reduction::reduce;
use hamel_codegen::derive::undetermined::undetermined_multipliers;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::program::Program;
use hamel_codegen::proof::prove;

/// Returns the values of a function at the start, with these rates.
fn at_start(of: &Generated, name: &str, rates: &[f64]) -> Vec<f64> {
    let model = &of.active;
    let inputs = vec![0.0; model.u.len()];
    value(of, name, [&model.start_x, &model.start_xi, &inputs, rates])
}

fn accel(of: &Generated) -> Vec<f64> {
    at_start(of, "accel", &[])
}

fn messages(of: &Generated) -> Vec<&str> {
    let warnings = of.model.warnings.iter();
    warnings.map(|warning| warning.message.as_str()).collect()
}

/// Returns λ by least squares: Bᵀ λ = M ξ̇ + h + ∂V − f with B = ∂φ/∂ξ by differences, where ẋ = ξ.
fn least_squares(of: &Generated) -> Vec<f64> {
    let model = &of.active;
    let xi_dot = accel(of);
    let needed = at_start(of, "inverse_dynamics", &xi_dot);
    let applied = at_start(of, "generalized_force", &[]);
    let n = xi_dot.len();
    let residual = |i: usize, h: f64| {
        let mut x = model.start_x.clone();
        x[i] += h;
        value(of, "constraint", [&x, &[], &[], &[]])
    };
    let h = 1e-4;
    let slope = |i: usize| -> Vec<f64> {
        let pairs = [h, h / 2.0].map(|h| (residual(i, h), residual(i, -h), h));
        let slopes = pairs.map(|(a, b, h)| -> Vec<f64> {
            a.iter().zip(&b).map(|(a, b)| (a - b) / (2.0 * h)).collect()
        });
        let [coarse, fine] = slopes;
        let both = fine.iter().zip(&coarse);
        both.map(|(fine, coarse)| (4.0 * fine - coarse) / 3.0)
            .collect()
    };
    let columns: Vec<Vec<f64>> = (0..n).map(slope).collect();
    let m = columns[0].len();
    // B Bᵀ λ = B r
    let mut rows: Vec<Vec<f64>> = (0..m)
        .map(|i| {
            let entry = |j: usize| columns.iter().map(|c| c[i] * c[j]).sum::<f64>();
            let right = (0..n)
                .map(|k| columns[k][i] * (needed[k] - applied[k]))
                .sum();
            (0..m).map(entry).chain([right]).collect()
        })
        .collect();
    for c in 0..m {
        let pivot = rows[c].clone();
        for (r, row) in rows.iter_mut().enumerate() {
            let factor = if r == c { 0.0 } else { row[c] / pivot[c] };
            row.iter_mut()
                .zip(&pivot)
                .for_each(|(a, b)| *a -= factor * b);
        }
    }
    (0..m).map(|i| rows[i][m] / rows[i][i]).collect()
}

/// Returns a plate carried by two arms, and welded to the tip of the second one.
fn weld(rows: &str) -> String {
    format!(
        "system Weld {{
            joint a: revolute [0, 0, 1] moves A;
            joint b: revolute [0, 0, 1] on A at translation([1, 0, 0]) moves B;
            joint c: revolute [0, 0, 1] on B at translation([1, 0, 0]) moves P;
            joint d: revolute [0, 0, 1] at translation([2, 0, 0]) moves D;
            joint e: revolute [0, 0, 1] on D at translation([0, 1, 0]) moves Q;
            body on A {{ mass 1; com [0.5, 0, 0]; inertia diag(0, 1, 1) / 12 about com; }}
            body on B {{ mass 1; com [0.5, 0, 0]; inertia diag(0, 1, 1) / 12 about com; }}
            body on D {{ mass 1; com [0, 0.5, 0]; inertia diag(1, 0, 1) / 12 about com; }}
            body on P {{ mass 2; inertia diag(1, 1, 2) / 20 about com; }}
            gravity [0, -9.81, 0];
            {rows}
            start a = 1.2, d ~ 0.4, e ~ -0.4;
        }}"
    )
}

/// The force of the pin is unique, and rotates the second arm; the documentation names the rows of the weld that share
/// a torque.
#[test]
fn the_force_of_a_pin_is_given_beside_rows_without_one() {
    let of = generated(&weld("loop position(P) = position(Q), P.R = Q.R;"));
    assert_eq!(
        messages(&of),
        [
            "entry [3] of this loop always holds, and is left out",
            "entries [1, 3], [2, 3], [3, 1], [3, 2], [3, 3] of this loop always hold, and are left out",
            "entries [2, 1], [2, 2] of this loop follow from the other rows, and are left out",
        ]
    );
    assert_eq!(
        undetermined_multipliers(&of.model),
        [false, false, true, true]
    );
    let function = of
        .program
        .function("constraint_force")
        .expect("it is there");
    for row in [
        "- 1: `position(P) = position(Q)`, entry `[1]`",
        "- 3: `P.R = Q.R`, entry `[1, 1]`; not determined",
    ] {
        assert!(
            function.docs.iter().any(|line| line == row),
            "{:?}",
            function.docs
        );
    }
    let forces = at_start(&of, "constraint_force", &[]);
    assert_eq!(forces.len(), 4);
    let fewer = generated(&weld(
        "loop position(P)[1] = position(Q)[1], position(P)[2] = position(Q)[2], dot(P.R * [1, 0, 0], Q.R * [0, 1, 0]) = 0;",
    ));
    assert!(messages(&fewer).is_empty());
    assert_eq!(undetermined_multipliers(&fewer.model), [false; 3]);
    let unique = at_start(&fewer, "constraint_force", &[]);
    assert!(difference(&forces[..2], &unique[..2]) < 1e-8);
    assert!(difference(&unique, &least_squares(&fewer)) < 1e-8);
    assert!(difference(&accel(&of), &accel(&fewer)) < 1e-8);
    // The arm D about its pivot: J ḋ̇ = c × m g + q × (−λ), without a torque, since its hinge transmits none.
    let d = of.model.start_x[3];
    let (sin, cos) = d.sin_cos();
    let (c, q) = ([-0.5 * sin, 0.5 * cos], [-sin, cos]);
    let torque = -9.81 * c[0] - (q[0] * forces[1] - q[1] * forces[0]);
    let expected = torque / (1.0 / 12.0 + 0.25);
    assert!((accel(&of)[3] - expected).abs() < 1e-8, "{expected}");
}

/// A single row, a row of a vector, one of a component, a ball in a tube: the system is the one without the redundant
/// row.
#[test]
fn whatever_follows_is_dropped_with_a_warning() {
    let four_bar = |rows: &str| {
        format!(
            "system FourBar {{
                joint a: revolute [0, 1, 0] moves A;
                joint b: revolute [0, 1, 0] on A at translation([0, 0, 0.4]) moves B;
                joint c: revolute [0, 1, 0] at translation([0.7, 0, 0]) moves C;
                body on A {{ mass 1; com [0, 0, 0.2]; inertia diag(1, 1, 0.1) / 50 about com; }}
                body on B {{ mass 1; com [0.3, 0, 0]; inertia diag(0.1, 1, 1) / 50 about com; }}
                body on C {{ mass 1; com [0, 0, 0.25]; inertia diag(1, 1, 0.1) / 50 about com; }}
                component Hinge(f: frame, g: frame) {{
                    loop position(f) = position(g);
                    loop dot(f.R * [0, 1, 0], g.R * [1, 0, 0]) = 0, dot(f.R * [0, 1, 0], g.R * [0, 0, 1]) = 0;
                }}
                frame fB on B at [0.6, 0, 0], fC on C at [0, 0, 0.5];
                {rows}
                gravity [0, 0, -9.81];
                start a = 0.1, b ~ 0, c ~ 0;
            }}"
        )
    };
    let hinge = generated(&four_bar("part close = Hinge(fB, fC);"));
    assert_eq!(
        messages(&hinge),
        [
            "entry [2] of this loop always holds, and is left out",
            "this loop always holds, and is left out",
            "this loop always holds, and is left out",
        ]
    );
    let rows = "loop position(fB)[1] = position(fC)[1], position(fB)[3] = position(fC)[3];";
    let fewer = generated(&four_bar(&format!("part _close = Hinge(fB, fB); {rows}")));
    assert!(difference(&accel(&hinge), &accel(&fewer)) < 1e-12);
    let forces = [&hinge, &fewer].map(|of| at_start(of, "constraint_force", &[]));
    assert!(difference(&forces[0], &forces[1]) < 1e-12);
    assert!(difference(&forces[0], &least_squares(&hinge)) < 1e-8);

    // A ball between two walls of a tube does not slip at either: the second contact is redundant.
    let ball = |rows: &str| {
        format!(
            "system Ball {{
                param a = 0.1, m = 0.3;
                coord r: R3, R: SO3; velocity v: vec3, w: vec3;
                rate r = v, R = R * hat(w);
                frame ball = pose(R, r);
                body on ball {{ mass m; inertia 0.4 * m * a^2 * identity(3) about com; }}
                gravity [0.3, 0.1, -9.81];
                {rows}
                start v = [0.2, 0, 0], w = [0, 2, 0];
            }}"
        )
    };
    let below = "nonholonomic v + cross(R * w, [0, 0, -a]) = 0;";
    let above = "nonholonomic v[3] = -2 * v[3], v + cross(R * w, [0, 0, -a]) = [0, 0, v[3]];";
    let one = generated(&ball(below));
    let both = generated(&ball(&format!("{below} {above}")));
    assert_eq!(
        messages(&both),
        [
            "entry [3] of this nonholonomic constraint always holds, and is left out",
            "this nonholonomic constraint follows from the other constraints, and is left out",
            "entries [1], [2] of this nonholonomic constraint follow from the other rows, and are left out",
        ]
    );
    assert!(difference(&accel(&one), &accel(&both)) < 1e-12);
    // The dropped rows might carry a part of any force.
    assert_eq!(undetermined_multipliers(&one.model), [false; 3]);
    assert_eq!(undetermined_multipliers(&both.model), [true; 3]);
    assert_eq!(at_start(&both, "constraint_force", &[]).len(), 3);
}

/// Redundant or contradictory drives are errors.
#[test]
fn drives_are_not_dropped() {
    let text = "system S { time t; joint a: revolute [0, 0, 1] moves A; joint b: revolute [0, 0, 1] on A at [1, 0, 0] moves B;
        body on B { mass 1; com [1, 0, 0]; }
        loop a_sum = 0; let a_sum = a + b; prescribe a_dot = t; prescribe b_dot = -t; }";
    assert!(from_text(text).is_err());
}

/// Returns a rotation whose entries have few digits.
fn turn(random: &mut Random) -> [[f64; 3]; 3] {
    let parts = [(0.6, 0.8), (0.28, 0.96), (0.8, 0.6), (0.96, 0.28)];
    let mut turn = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for axis in 0..3 {
        let (c, s) = parts[random.below(4)];
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        for row in &mut turn {
            (row[i], row[j]) = (c * row[i] + s * row[j], c * row[j] - s * row[i]);
        }
    }
    turn
}

/// Returns the faults of a four-bar in a tilted plane, or perpendicular to it, with a hinge or a weld to a fifth joint:
/// closed by all rows that one would write, and compared with the minimal rows.
fn faults(seed: u64) -> Vec<String> {
    let mut random = Random::new(0x4ed0 + seed);
    let tilt = if seed.is_multiple_of(3) {
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    } else {
        turn(&mut random)
    };
    let welded = random.below(2) == 1;
    let mut digits = |least: f64, span: f64| {
        (1000.0 * (least + span * (0.5 + 0.5 * random.number()))).round() / 1000.0
    };
    let [crank, coupler, rocker] = [digits(0.3, 0.1), digits(0.6, 0.15), digits(0.5, 0.1)];
    let [g1, g2, g3] = [digits(-9.0, 18.0), digits(-9.0, 18.0), digits(-9.0, 18.0)];
    let (a, rate) = (digits(0.6, 0.8), digits(-2.0, 4.0));
    let inertia = digits(0.01, 0.05);
    let tip = match welded {
        true => format!(
            "joint e: revolute [0, 0, 1] on C at translation([{rocker}, 0, 0]) moves Q {{ armature 0.02; }}"
        ),
        false => format!("frame Q on C at [{rocker}, 0, 0];"),
    };
    let text = |rows: &str| {
        let matrix = tilt.map(|row| format!("[{:.12}, {:.12}, {:.12}]", row[0], row[1], row[2]));
        format!(
            "system Bars {{
                frame base = pose([{}], [0, 0, 0]);
                joint a: revolute [0, 0, 1] on base moves A;
                joint b: revolute [0, 0, 1] on A at translation([{crank}, 0, 0]) moves B;
                joint c: revolute [0, 0, 1] on base at translation([0.7, 0, 0]) moves C;
                {tip}
                body on A {{ mass 1; com [0.1, 0.02, 0.01]; inertia diag(0.1, 1, 1) * {inertia} about com; }}
                body on B {{ mass 2; com [0.2, -0.03, 0.02]; inertia diag(0.2, 1, 1.1) * {inertia} about com; }}
                body on C {{ mass 1.5; com [0.3, 0.05, 0]; inertia diag(0.1, 1, 1) * {inertia} about com; }}
                frame P on B at [{coupler}, 0, 0];
                gravity [{g1}, {g2}, {g3}];
                {rows}
                start a = {a}, a_dot = {rate}, b ~ -0.4, c ~ 1.3{};
            }}",
            matrix.join(", "),
            if welded { ", e ~ -0.8" } else { "" }
        )
    };
    let mut few = String::new();
    for axis in 0..2 {
        let normal = format!(
            "[{:.12}, {:.12}, {:.12}]",
            tilt[0][axis], tilt[1][axis], tilt[2][axis]
        );
        few += &format!("loop dot({normal}, position(P) - position(Q)) = 0;");
    }
    let mut many = String::from("loop position(P) = position(Q);");
    if welded {
        few += "loop dot(P.R * [1, 0, 0], Q.R * [0, 1, 0]) = 0;";
        many += "loop P.R = Q.R;";
    } else {
        many +=
            "loop dot(P.R * [0, 0, 1], Q.R * [1, 0, 0]) = 0, P.R * [0, 0, 1] = Q.R * [0, 0, 1];";
    }
    let build = |rows: &str| {
        from_text(&text(rows)).map_err(|errors| {
            let all: Vec<String> = errors.into_iter().map(|error| error.message).collect();
            format!("{seed}: {}\n{}", all.join("; "), text(rows))
        })
    };
    let (few, many) = match (build(&few), build(&many)) {
        (Ok(few), Ok(many)) => (few, many),
        (few, many) => return [few.err(), many.err()].into_iter().flatten().collect(),
    };
    let mut faults = Vec::new();
    let mut judge = |what: &str, error: f64, least: f64| {
        if error.is_nan() || error > least {
            faults.push(format!("{seed}: {what} {error}"));
        }
    };
    judge(
        "x",
        difference(&few.active.start_x, &many.active.start_x),
        1e-9,
    );
    judge("accel", difference(&accel(&few), &accel(&many)), 1e-7);
    let (unique, all) = (
        at_start(&few, "constraint_force", &[]),
        at_start(&many, "constraint_force", &[]),
    );
    judge(
        "by least squares",
        difference(&unique, &least_squares(&few)),
        1e-7,
    );
    // The force at the hinge in its plane, with 0 for dropped rows.
    let mut next = all.iter();
    let rows = many.model.constraints.iter();
    let mut force = [0.0; 3];
    for row in rows.filter(|row| !row.redundant) {
        let value = next.next().copied().unwrap_or(f64::NAN);
        let place = ["[1]", "[2]", "[3]"]
            .iter()
            .position(|name| *name == row.entry);
        if let (true, Some(place)) = (row.written.starts_with("position"), place) {
            force[place] = value;
        }
    }
    for axis in 0..2 {
        let along: f64 = (0..3).map(|k| tilt[k][axis] * force[k]).sum();
        let scale = unique.iter().fold(1.0_f64, |most, v| most.max(v.abs()));
        judge("force", (along - unique[axis]).abs() / scale, 1e-6);
    }
    // For a plane along the axes, the forces are unique.
    let free = undetermined_multipliers(&many.model);
    if seed.is_multiple_of(3) && free[..2] != [false, false]
        || undetermined_multipliers(&few.model).contains(&true)
    {
        faults.push(format!("{seed}: determined {free:?}"));
    }
    if messages(&many).is_empty() || !messages(&few).is_empty() {
        faults.push(format!("{seed}: warnings"));
    }
    faults
}

#[test]
fn redundant_rows_change_neither_motion_nor_unique_forces() {
    attack(9, 200, faults);
}

/// A crank q of 0.5, two more of the same length, and the plate that they carry; a bar on the plate, connected to the
/// ground by another one. Three equations close the plate, one of them redundant; two close the bars.
const CRANKS: &str = "
    joint q: revolute [0, 0, 1] moves first;
    joint b: revolute [0, 0, 1] at [0.7, 0.1, 0] moves second;
    joint c: revolute [0, 0, 1] at [0.3, 0.6, 0] moves third;
    joint top: revolute [0, 0, 1] on first at [0.5, 0, 0] moves plate;
    joint d: revolute [0, 0, 1] on plate at [0.4, 0.5, 0] moves bar;
    joint e: revolute [0, 0, 1] at [1.5, 0.2, 0] moves last;
    loop position(plate, [0.7, 0.1, 0])[1] = position(second, [0.5, 0, 0])[1],
        position(plate, [0.7, 0.1, 0])[2] = position(second, [0.5, 0, 0])[2];
    loop position(bar, [0.8, 0, 0])[1] = position(last, [0.9, 0, 0])[1],
        position(bar, [0.8, 0, 0])[2] = position(last, [0.9, 0, 0])[2];
    loop position(plate, [0.3, 0.6, 0])[1] = position(third, [0.5, 0, 0])[1],
        position(plate, [0.3, 0.6, 0])[2] = position(third, [0.5, 0, 0])[2];
    body on first { mass 1.2; com [0.2, 0.1, 0]; inertia diag(0.1, 0.2, 0.3) about com; }
    body on second { mass 0.7; com [0.3, 0, 0]; inertia diag(0.1, 0.1, 0.1) about com; }
    body on third { mass 0.4; com [0.1, 0.2, 0]; inertia diag(0.1, 0.1, 0.2) about com; }
    body on plate { mass 2; com [0.3, 0.2, 0]; inertia diag(0.2, 0.2, 0.4) about com; }
    body on bar { mass 0.6; com [0.3, 0.05, 0]; inertia diag(0.1, 0.2, 0.2) about com; }
    body on last { mass 0.9; com [0.4, 0, 0]; inertia diag(0.1, 0.2, 0.15) about com; }
    start q = 0.8, b ~ 0.8, c ~ 0.8, top ~ -0.8, d ~ 0.3, e ~ 1.5;";

/// Bricard's mechanism of six hinges at right angles, with one redundant equation, and a pendulum on it that is held by
/// a separate equation.
const BRICARD: &str = "
    joint q: revolute [0, 0, 1] moves f1;
    joint r: revolute [0, 0, 1] on f1 at pose(rotx(pi / 2), [1, 0, 0]) moves f2;
    joint s: revolute [0, 0, 1] on f2 at pose(rotx(-pi / 2), [1, 0, 0]) moves f3;
    joint t: revolute [0, 0, 1] on f3 at pose(rotx(pi / 2), [1, 0, 0]) moves f4;
    joint v: revolute [0, 0, 1] on f4 at pose(rotx(-pi / 2), [1, 0, 0]) moves f5;
    joint hung: revolute [0, 1, 0] on f3 at [0.1, 0.2, 0] moves pendulum;
    loop position(f5, [1, 0, 0]) = [-1, 0, 0];
    let axis = f5.R * rotx(pi / 2) * [0, 0, 1];
    loop axis[1] = 0, axis[3] = 0;
    let bob = position(pendulum, [0, 0, 0.4]);
    loop bob[3] = 0.776;
    body on f1 { mass 1; com [0.5, 0, 0]; inertia diag(0.01, 0.1, 0.1) about com; }
    body on f2 { mass 2; com [0.4, 0.1, 0]; inertia diag(0.02, 0.1, 0.1) about com; }
    body on f3 { mass 1; com [0.5, 0, 0.1]; inertia diag(0.02, 0.1, 0.11) about com; }
    body on f4 { mass 1.5; com [0.5, 0, 0]; inertia diag(0.01, 0.1, 0.1) about com; }
    body on f5 { mass 1; com [0.6, 0, 0]; inertia diag(0.01, 0.1, 0.1) about com; }
    body on pendulum { mass 0.5; com [0.02, 0, 0.3]; inertia diag(0.1, 0.15, 0.1) about com; }
    start q = 1.4, r ~ 1.72, s ~ 1.4, t ~ 1.72, v ~ 1.4, hung ~ 0.3;";

/// Returns B of the loops by rows, by differences of φ, where ẋ = ξ.
fn bonds(of: &Generated) -> Vec<Vec<f64>> {
    let model = &of.active;
    let residual = |i: usize, h: f64| {
        let mut x = model.start_x.clone();
        x[i] += h;
        value(of, "constraint", [&x, &[], &[], &[]])
    };
    let h = 1e-3;
    let column = |i: usize| -> Vec<f64> {
        let slope = |h: f64| -> Vec<f64> {
            let sides = residual(i, h).into_iter().zip(residual(i, -h));
            sides.map(|(a, b)| (a - b) / (2.0 * h)).collect()
        };
        let [coarse, middle, fine] = [h, h / 2.0, h / 4.0].map(slope);
        let all = coarse.iter().zip(&middle).zip(&fine);
        all.map(|((a, b), c)| (64.0 * c - 20.0 * b + a) / 45.0)
            .collect()
    };
    let columns: Vec<Vec<f64>> = (0..model.n()).map(column).collect();
    (0..columns[0].len())
        .map(|row| columns.iter().map(|column| column[row]).collect())
        .collect()
}

/// Returns the unknowns of Σ rows[k] λ[k] = right by elimination with the largest pivots; `None` for an unknown
/// that is not determined.
fn eliminated(rows: &[Vec<f64>], right: &[f64]) -> Vec<Option<f64>> {
    let (count, n) = (rows.len(), right.len());
    let mut left: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            let entries = rows.iter().map(|row| row[i]);
            entries.chain([right[i]]).collect()
        })
        .collect();
    let mut pivots: Vec<(usize, usize)> = Vec::new();
    loop {
        let open = (0..n).filter(|i| pivots.iter().all(|(row, _)| row != i));
        let entries = open.flat_map(|i| (0..count).map(move |k| (i, k)));
        let size = |&(i, k): &(usize, usize)| left[i][k].abs();
        let largest = entries.max_by(|a, b| size(a).total_cmp(&size(b)));
        let Some((row, k)) = largest.filter(|place| size(place) > 1e-7) else {
            break;
        };
        let scale = left[row][k];
        left[row].iter_mut().for_each(|entry| *entry /= scale);
        let pivot = left[row].clone();
        for (i, other) in left.iter_mut().enumerate() {
            let factor = if i == row { 0.0 } else { other[k] };
            let pairs = other.iter_mut().zip(&pivot);
            pairs.for_each(|(entry, by)| *entry -= factor * by);
        }
        pivots.push((row, k));
    }
    let value = |k: usize| {
        let (row, _) = pivots.iter().find(|(_, pivot)| *pivot == k)?;
        let mut others = (0..count).filter(|&other| other != k);
        let alone = others.all(|other| left[*row][other].abs() < 1e-7);
        alone.then_some(left[*row][count])
    };
    (0..count).map(value).collect()
}

/// Returns the cranks without the body on the third one.
fn light_cranks() -> String {
    let lines = CRANKS.lines();
    let lines: Vec<&str> = lines
        .filter(|line| !line.contains("body on third"))
        .collect();
    lines.join("\n")
}

/// Returns a mechanism in which the rate of a joint's velocity is prescribed.
fn driven(text: &str, joint: &str) -> Generated {
    generated(&format!(
        "system Driven {{
            {text}
            input more;
            prescribe rate({joint}_dot) = 0.3 + more;
            gravity [1, -9.81, 0.5];
            start q_dot = 0.6;
        }}"
    ))
}

/// With redundant rows and a prescribed rate, unique forces, including that of the drive, agree with an elimination;
/// the others are named, and all forces balance.
#[test]
fn unique_forces_are_given_beside_prescribed_rates() {
    let light = light_cranks();
    for (name, text, drives, unique) in [
        ("cranks", CRANKS, "q", 2),
        ("cranks by the plate's bar", CRANKS, "e", 2),
        ("cranks of which one has no mass", &light, "q", 2),
        ("Bricard", BRICARD, "q", 1),
        ("Bricard by the pendulum", BRICARD, "hung", 1),
    ] {
        let of = driven(text, drives);
        let xi_dot = accel(&of);
        let velocities = of.active.velocities.iter();
        let given = velocities
            .clone()
            .find(|group| group.name == format!("{drives}_dot"));
        let given = given.expect("it is there").offset;
        assert!((xi_dot[given] - 0.3).abs() < 1e-12, "{name}");
        let needed = at_start(&of, "inverse_dynamics", &xi_dot);
        let applied = at_start(&of, "generalized_force", &[]);
        let right: Vec<f64> = needed.iter().zip(&applied).map(|(a, b)| a - b).collect();
        let mut rows = bonds(&of);
        rows.push(
            (0..right.len())
                .map(|i| f64::from(u8::from(i == given)))
                .collect(),
        );
        let expected = eliminated(&rows, &right);
        let found = at_start(&of, "constraint_force", &[]);
        assert_eq!(found.len(), expected.len(), "{name}");
        let scale = found.iter().fold(1.0_f64, |most, v| most.max(v.abs()));
        for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
            if let Some(expected) = expected {
                assert!(
                    (found - expected).abs() < 1e-7 * scale,
                    "{name}, {k}: {found}, {expected}"
                );
            }
        }
        let free: Vec<bool> = expected.iter().map(Option::is_none).collect();
        assert_eq!(undetermined_multipliers(&of.model), free, "{name}");
        let loops = free.iter().rev().skip(1).filter(|free| !**free).count();
        assert_eq!((loops, free.last()), (unique, Some(&false)), "{name}");
        for (i, right) in right.iter().enumerate() {
            let sum: f64 = found
                .iter()
                .zip(&rows)
                .map(|(force, row)| force * row[i])
                .sum();
            assert!(
                (sum - right).abs() < 1e-7 * scale,
                "{name}, {i}: {sum}, {right}"
            );
        }
    }
}

/// The proof detects a wrong sign in the force of any row, also with gears that are eliminated.
#[test]
fn wrong_forces_beside_prescribed_rates_are_refused() {
    let geared = format!(
        "{CRANKS} joint wheel: revolute [0, 0, 1] moves disk; loop wheel = 2 * b; \
         body on disk {{ mass 1; inertia diag(0.1, 0.1, 0.2) about com; }}"
    );
    for text in [CRANKS, &light_cranks(), &geared, BRICARD] {
        let of = driven(text, "q");
        let reduction = reduce(&of.model).expect("it was derived");
        let proved =
            |program: &Program| prove(&of.model, reduction.as_ref(), None, [program; 2]).is_ok();
        assert!(proved(&of.program), "{text}");
        let functions = of.program.functions.iter();
        let place = functions
            .clone()
            .position(|of| of.name == "constraint_force");
        let place = place.expect("it is there");
        for entry in 0..of.program.functions[place].outputs.len() {
            let mut wrong = of.program.clone();
            let output = &mut wrong.functions[place].outputs[entry];
            *output = -*output;
            assert!(!proved(&wrong), "{entry} of {text}");
        }
    }
}
