//! Members of sweeps: their states, their ends compared with `hamel simulate`, their kept results, and failing members.

use crate::common::{hamel, text};
use crate::shards::bytes;
use crate::swept::{BALL, run, swept, swept_into};
use crate::table::{Table, fresh};
use hamel::so3;
use std::fs;

fn model(name: &str) -> String {
    format!("{}/../tests/models/{name}.eom", env!("CARGO_MANIFEST_DIR"))
}

/// The last row of a run of `hamel simulate`: t, x, ξ.
fn simulated(name: &str, model: &str, state: &str, options: &[&str]) -> Vec<f64> {
    let folder = fresh(&format!("simulated-{name}"));
    fs::create_dir_all(&folder).expect("a folder");
    let (at, out) = (folder.join(format!("{name}.json")), folder.join("run.csv"));
    fs::write(&at, state).expect("a state");
    let (at, out) = (at.display().to_string(), out.display().to_string());
    let fixed = ["simulate", model, "--at", &at, "--out", &out];
    let output = hamel(&[&fixed[..], options].concat(), "");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let written = fs::read_to_string(&out).expect("samples");
    let last = written.lines().last().expect("a row");
    last.split(',')
        .map(|number| number.parse().expect("a number"))
        .collect()
}

/// The values of `end` are bitwise equal to those of the same run, for every method.
#[test]
fn ends_are_those_of_simulate() {
    let top = model("heavy_top");
    for (name, options) in [
        (
            "steps",
            &["--until", "0.2", "--method", "rkmk4", "--step", "0.01"][..],
        ),
        ("auto", &["--until", "0.2", "--step", "0.01"]),
        (
            "tol",
            &["--until", "0.2", "--method", "rkmk8", "--tol", "1e-9"],
        ),
    ] {
        let vary = "m = uniform(1, 2); start w[2] = uniform(-1, 1); start R = uniform(-1, 1); s[3] = uniform(0.2, 0.4)";
        let members = ["--vary", vary, "--members", "3"];
        let table = swept(
            &format!("ends-{name}"),
            &top,
            &[&members[..], options].concat(),
        );
        let end = table
            .names
            .iter()
            .position(|name| name == "end t")
            .expect("end");
        for row in &table.rows {
            let value: Vec<f64> = row.iter().map(|value| value.expect("a number")).collect();
            let [m, w2, s3] = [value[1], value[2], value[6]];
            let turn = so3::retract(so3::identity(), [value[3], value[4], value[5]]);
            let rows: Vec<&[f64]> = turn.chunks(3).collect();
            let state = format!(
                "{{\"param\": {{\"m\": {m:?}, \"s\": [0.1, -0.2, {s3:?}]}}, \"coord\": {{\"R\": {rows:?}}}, \"velocity\": {{\"w\": [0.3, {w2:?}, 5]}}}}"
            );
            assert_eq!(
                value[end..],
                simulated(name, &top, &state, options),
                "{name}"
            );
        }
    }
}

/// Methods that depend on parameters and on the start use those of the member.
#[test]
fn methods_are_those_of_the_member() {
    let plate = format!("{}/../examples/dzhanibekov.eom", env!("CARGO_MANIFEST_DIR"));
    for method in ["splitting", "free"] {
        let options = ["--until", "0.5", "--step", "0.01", "--method", method];
        let vary = [
            "--vary",
            "J1 = grid(1, 1.5, 2); start w[1] = grid(0.1, 0.5, 2)",
        ];
        let table = swept(
            &format!("plate-{method}"),
            &plate,
            &[&vary[..], &options].concat(),
        );
        for row in &table.rows {
            let value: Vec<f64> = row.iter().map(|value| value.expect("a number")).collect();
            let state = format!(
                "{{\"param\": {{\"J1\": {:?}}}, \"velocity\": {{\"w\": [{:?}, 1, 0]}}}}",
                value[1], value[2]
            );
            // Outputs follow the state.
            let wanted = simulated(&format!("plate-{method}"), &plate, &state, &options);
            assert_eq!(value[3..], wanted[..value.len() - 3], "{method}");
        }
    }
}

/// Values not given are completed to close loops, and inputs by expressions use the parameters of their member.
#[test]
fn members_are_completed_as_states_are() {
    let bar = model("four_bar_loop");
    let options = ["--until", "0.05", "--step", "0.01"];
    let vary = ["--vary", "start q1 = grid(1, 1.5, 2)"];
    let table = swept("loops", &bar, &[&vary[..], &options].concat());
    for row in &table.rows {
        let value: Vec<f64> = row.iter().map(|value| value.expect("a number")).collect();
        let state = format!("{{\"coord\": {{\"q1\": {:?}}}}}", value[1]);
        assert_eq!(value[2..], simulated("loop", &bar, &state, &options));
    }
    let pushed = [
        "--vary",
        "m = grid(1, 2, 2)",
        "--input",
        "F = m * g + m",
        "--until",
        "1",
    ];
    let table = swept("pushed", BALL, &pushed);
    for w in table.column("end w") {
        assert!((w - 5.0).abs() < 1e-9, "{w}");
    }
    let inputs = ["--vary", "input F = grid(0, 40, 2)", "--until", "1"];
    let found = swept("inputs", BALL, &inputs).column("end w");
    assert!(
        (found[0] + 6.0).abs() < 1e-9 && (found[1] - 14.0).abs() < 1e-9,
        "{found:?}"
    );
}

/// Values not varied are those of the file, even in the other entries of a varied vector.
#[test]
fn members_are_changes_of_a_given_state() {
    let folder = fresh("given");
    fs::create_dir_all(&folder).expect("a folder");
    let at = folder.join("state.json");
    let state = r#"{"param": {"m": 1.5}, "velocity": {"w": [0.1, 0.2, 3]}}"#;
    fs::write(&at, state).expect("a state");
    let (at, top) = (at.display().to_string(), model("heavy_top"));
    let options = ["--until", "0.1", "--step", "0.01"];
    let vary = [
        "--vary",
        "start w[2] = grid(-1, 1, 2); g = grid(m, 9, 2)",
        "--at",
        &at,
    ];
    let table = swept("changed", &top, &[&vary[..], &options].concat());
    assert_eq!(table.column("g"), [1.5, 9.0, 1.5, 9.0]);
    for row in &table.rows {
        let value: Vec<f64> = row.iter().map(|value| value.expect("a number")).collect();
        let state = format!(
            "{{\"param\": {{\"m\": 1.5, \"g\": {:?}}}, \"velocity\": {{\"w\": [0.1, {:?}, 3]}}}}",
            value[2], value[1]
        );
        assert_eq!(value[3..], simulated("given", &top, &state, &options));
    }
    let by_joints = folder.join("joints.json");
    fs::write(&by_joints, r#"{"configuration": {}}"#).expect("a state");
    let (by_joints, out) = (by_joints.display().to_string(), folder.join("runs"));
    let out = out.display().to_string();
    let fixed = ["sweep", &top, "--out", &out, "--at", &by_joints];
    let output = hamel(&[&fixed[..], &vary[..2], &options].concat(), "");
    let said = text(&output.stderr);
    assert!(
        said.contains("a sweep takes a state by coordinates"),
        "{said}"
    );
}

/// z = w t − g t²/2: lands at 2 w/g, reaches its maximum w²/2 g at w/g, and has the mean w t/2 − g t²/6.
#[test]
fn what_is_kept_is_that_of_the_parabola() {
    let keep = "max(height); min(z); mean(z); at(0.3, [y, w]); event(z < 0); event(w <= 0); event(z > 100); event(v > 0); event(2 < z + y)";
    let fixed = [
        "--vary",
        "start w = grid(4, 5, 2)",
        "--until",
        "1",
        "--keep",
        keep,
    ];
    for (name, options, off) in [
        ("steps", &["--method", "rkmk4", "--step", "0.01"][..], 2e-4),
        ("tol", &["--method", "rkmk8", "--tol", "1e-10"], 2e-6),
    ] {
        let table = swept(
            &format!("kept-{name}"),
            BALL,
            &[&fixed[..], options].concat(),
        );
        for (row, w) in [4.0, 5.0].into_iter().enumerate() {
            let at = |name: &str| table.optional(name)[row];
            let near = |name: &str, wanted: f64, off: f64| {
                let found = at(name).expect(name);
                assert!(
                    (found - wanted).abs() <= off,
                    "{name}: {found}, not {wanted}"
                );
            };
            let height = |t: f64| w * t - 5.0 * t * t;
            near("max(height)", height(w / 10.0), off);
            near("min(z)", height(1.0).min(0.0), 1e-12);
            near("mean(z)", w / 2.0 - 10.0 / 6.0, off);
            near("at(0.3, [y, w])[1]", 0.3, 1e-12);
            near("at(0.3, [y, w])[2]", w - 3.0, 1e-12);
            near("event(w <= 0)", w / 10.0, 1e-12);
            assert_eq!(at("event(z > 100)"), None);
            // True from the start on.
            assert_eq!(at("event(v > 0)"), None);
            // y + z = t + w t − 5 t².
            let first = ((w + 1.0) - ((w + 1.0_f64).powi(2) - 40.0).max(0.0).sqrt()) / 10.0;
            match (w + 1.0).powi(2) > 40.0 {
                true => near("event(2 < z + y)", first, 1e-12),
                false => assert_eq!(at("event(2 < z + y)"), None),
            }
            match w < 5.0 {
                true => near("event(z < 0)", w / 5.0, 1e-12),
                // At the end of the run the event occurs only up to rounding.
                false => assert!(at("event(z < 0)").is_none_or(|t| (t - 1.0).abs() < 1e-12)),
            }
        }
    }
}

/// If time is a coordinate, it is part of x, and no column occurs twice.
#[test]
fn no_two_columns_have_one_name() {
    let vary = [
        "--vary",
        "a = grid(0.1, 0.2, 2)",
        "--until",
        "0.1",
        "--keep",
        "end; max(t)",
    ];
    let table = swept("clock", &model("kapitza"), &vary);
    assert_eq!(
        table.names,
        ["index", "a", "end t", "end q", "end w", "max(t)"]
    );
    for name in ["end t", "max(t)"] {
        assert!(
            table.column(name).iter().all(|t| (t - 0.1).abs() < 1e-12),
            "{name}"
        );
    }
    let folder = fresh("twice").display().to_string();
    let options = [
        "--vary",
        "index = grid(0, 1, 2)",
        "--until",
        "1",
        "--out",
        &folder,
    ];
    let named = BALL.replace("drift: vec2 = [0, 0]", "index = 1");
    let output = hamel(&[&["sweep", "-"], &options[..]].concat(), &named);
    let said = text(&output.stderr);
    assert!(
        said.contains("two columns would be called `index`"),
        "{said}"
    );
}

#[test]
fn members_that_fail_are_rows_with_their_reasons() {
    let grid = [
        "--vary",
        "m = grid(-1, 1, 3)",
        "--until",
        "0.1",
        "--keep",
        "end; max(z)",
    ];
    let table = swept("failed", BALL, &grid);
    assert_eq!(table.column("m"), [-1.0, 0.0, 1.0]);
    for (member, error) in table.errors.iter().enumerate() {
        let kept = [
            table.optional("end t")[member],
            table.optional("max(z)")[member],
        ];
        match error {
            Some(error) => {
                assert!(error.starts_with("singular: the mass matrix"), "{error}");
                assert_eq!((member < 2, kept), (true, [None, None]));
            }
            None => assert!(member == 2 && kept.iter().all(Option::is_some), "{member}"),
        }
    }
    let growing = BALL.replace("force w = F", "force w = exp(20 * z) + F");
    let options = [
        "--vary",
        "start w = grid(-4, 40, 2)",
        "--until",
        "1",
        "--method",
        "rkmk4",
        "--step",
        "0.05",
    ];
    let table = swept("diverging", &growing, &options);
    assert_eq!(table.errors[0], None);
    let error = table.errors[1].clone().expect("it diverges");
    assert!(
        error.starts_with("not finite: the run ends at t = "),
        "{error}"
    );
    let options = ["--vary", "start c = grid(0.6, 2, 2)", "--until", "0.1"];
    let table = swept("start", &model("pendulum"), &options);
    assert_eq!(table.errors[0], None);
    let error = table.errors[1].clone().expect("no such start");
    assert!(
        error.starts_with("start: coord: violates constraint 1"),
        "{error}"
    );
}

/// Members run together or alone as threads take them: one thread takes three of these at a time, two take one. Files
/// have the same bytes in any case, even if parts were computed separately or again.
#[test]
fn files_do_not_tell_which_members_ran_side_by_side() {
    let plate = format!("{}/../examples/dzhanibekov.eom", env!("CARGO_MANIFEST_DIR"));
    let sizes = ["--members", "40", "--shard-size", "13"];
    let steps = ["--until", "1", "--step", "1e-3", "--method", "rkmk4"];
    // The last ones overflow.
    let vary = ["--vary", "J1 = latin(1, 2); start w[1] = grid(0, 1e200, 2)"];
    let options = [&vary[..], &sizes, &steps].concat();
    let with = |more: &[&'static str]| [&options[..], more].concat();
    let three = swept_into("side-by-side", &plate, &with(&["--threads", "1"]));
    let one = swept_into("side-by-side-one", &plate, &with(&["--threads", "2"]));
    let all = bytes(&three);
    assert_eq!(all.len(), 4);
    assert!(all == bytes(&one));
    let failed = Table::read(&three).errors;
    assert_eq!(failed.iter().flatten().count(), 20);

    let parts = fresh("side-by-side-parts");
    for part in ["2/3", "1/3", "3/3"] {
        run(&parts, &plate, &with(&["--threads", "1", "--shard", part]));
    }
    assert!(all == bytes(&parts));
    fs::remove_file(&crate::table::shards(&parts)[1]).expect("a shard");
    run(&parts, &plate, &with(&["--threads", "1"]));
    assert!(all == bytes(&parts));
}

/// R₀ exp(ŵ) by Rodrigues' formula.
fn turned(start: [[f64; 3]; 3], [x, y, z]: [f64; 3]) -> [[f64; 3]; 3] {
    let angle = (x * x + y * y + z * z).sqrt();
    let hat = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let product = |a: [[f64; 3]; 3], b: [[f64; 3]; 3]| {
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
    };
    let square: [[f64; 3]; 3] = product(hat, hat);
    let (a, b) = (angle.sin() / angle, (1.0 - angle.cos()) / (angle * angle));
    let entry = |i: usize, j: usize| f64::from(i == j) + a * hat[i][j] + b * square[i][j];
    product(start, [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))))
}

/// A pose is varied by its position, and by a rotation from its unvaried attitude, as a whole or by entries; it remains
/// a pose.
#[test]
fn poses_are_varied_on_their_group() {
    let folder = fresh("posed");
    fs::create_dir_all(&folder).expect("a folder");
    let at = folder.join("state.json");
    let quarter = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    let state = r#"{"coord": {"X": {"p": [1, 2, 3], "R": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]}}}"#;
    fs::write(&at, state).expect("a state");
    let at = at.display().to_string();
    let run = "--members 5 --seed 4 --until 0.01 --keep".split(' ');
    let mut fixed: Vec<&str> = run.collect();
    fixed.push("at(0, X.R); at(0, X.p)");
    for (name, vary, start, place) in [
        (
            "whole",
            &[
                "--vary",
                "start X.p = normal(0, 2); start X.R = uniform(-3, 3)",
            ][..],
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [None; 3],
        ),
        (
            "entries",
            &[
                "--vary",
                "start X.R[2] = latin(-1, 1); start X.p[3] = grid(7, 9, 5)",
                "--at",
                &at,
            ],
            quarter,
            [Some(1.0), Some(2.0), None],
        ),
    ] {
        let body = model("body_with_rotor");
        let table = swept(
            &format!("posed-{name}"),
            &body,
            &[&fixed[..], vary].concat(),
        );
        for row in 0..5 {
            let known = |name: &str| {
                let place = table.names.iter().position(|known| known == name)?;
                table.rows[row][place]
            };
            let turn = [1, 2, 3].map(|i| known(&format!("start X.R[{i}]")).unwrap_or(0.0));
            let wanted = turned(start, turn);
            for (i, wanted) in wanted.iter().enumerate() {
                let name = format!("at(0, X.p)[{}]", i + 1);
                let p = known(&format!("start X.p[{}]", i + 1)).or(place[i]);
                assert_eq!(known(&name), p);
                for (j, wanted) in wanted.iter().enumerate() {
                    let name = format!("at(0, X.R)[{},{}]", i + 1, j + 1);
                    let found = known(&name).unwrap_or_else(|| panic!("{name}: {:?}", table.names));
                    assert!((found - wanted).abs() < 1e-14, "{name}: {found} {wanted}");
                }
            }
        }
    }
    let body = model("body_with_rotor");
    let out = folder.join("none").display().to_string();
    let fixed = [
        "sweep",
        &body,
        "--until",
        "1",
        "--members",
        "2",
        "--out",
        &out,
        "--vary",
    ];
    let output = hamel(
        &[
            &fixed[..],
            &["start X = normal(0, 1); start X.q = normal(0, 1)"],
        ]
        .concat(),
        "",
    );
    let said = text(&output.stderr);
    for message in [
        "`X` is a pose: vary its position `start X.p`, its rotation `start X.R`, or both",
        "no coordinate, velocity or state is called `X.q`: did you mean `X.",
    ] {
        assert!(said.contains(message), "{said}");
    }
}

/// A cart with prescribed motion and a pendulum: varied parameters move the cart, and the pendulum starts as in the
/// text.
#[test]
fn members_begin_where_free_coordinates_are_given() {
    let cart = "system CartP {
        param A = 0.3;
        time t;
        joint x: prismatic [1, 0, 0] moves cart;
        joint q: revolute [0, -1, 0] on cart moves rod;
        body on cart { mass 1; }
        particle mass 1 at [0, 0, -0.5] on rod;
        gravity [0, 0, -9.81];
        prescribe x = A * cos(2 * t) + 0.1 * sin(t);
        start q = 0.3, t = 0.25;
    }";
    let vary = [
        "--vary",
        "A = grid(0.3, 1, 3)",
        "--keep",
        "at(0, q); at(0, x); end",
    ];
    let table = swept("began", cart, &[&vary[..], &["--until", "0.5"]].concat());
    for (row, a) in [0.3, 0.65, 1.0].into_iter().enumerate() {
        let x = a * 0.5_f64.cos() + 0.1 * 0.25_f64.sin();
        let near = |name: &str, wanted: f64| {
            let found = table.column(name)[row];
            assert!((found - wanted).abs() < 1e-12, "{name}: {found} {wanted}");
        };
        near("at(0, q)", 0.3);
        near("at(0, x)", x);
        near("end t", 0.75);
    }
}
