//! Commands protect their input and report impossible requests: results over their sources, runs that have lost their
//! motion, comparisons of nothing, pictures without motion but with inputs.

use crate::common::{hamel, text};
use std::fs;
use std::path::{Path, PathBuf};

const CART: &str = "/// A cart.
system Cart {
    input F;
    joint x: prismatic [1, 0, 0] moves cart { force F; }
    body on cart { mass 2; com [0, 0, 0]; }
}";

const ROBOT: &str = r#"<robot name="cart">
  <link name="rail"/>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/></joint>
  <link name="cart"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
</robot>"#;

const KEPLER: &str = "system Kepler {
    coord r: R2;
    velocity v: vec2;
    rate r = v;
    particle mass 1 at [r[1], r[2], 0];
    potential -1 / norm(r);
    start r = [1, 0];
    start v = [0, 0.0001];
}";

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("kept")
        .join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn refused(arguments: &[&str], wanted: &str) {
    let output = hamel(arguments, "");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    assert!(said.contains(wanted), "{arguments:?}: {said}");
}

#[test]
fn nothing_is_written_over_what_is_read() {
    let folder = folder("sources");
    let file = |name: &str, content: &str| {
        let path = folder.join(name);
        fs::write(&path, content).expect("written");
        path.display().to_string()
    };
    let cart = file("cart.eom", CART);
    let svg = file("cart.svg", CART);
    let header = file("c.h", CART);
    let robot = file("cart.urdf", ROBOT);
    let forces = file("forces.csv", "t,F\n0,1\n1,1\n");
    let state = file("state.json", "{}");
    let other = folder.join("../sources/./cart.eom").display().to_string();
    let before: Vec<String> = [&cart, &svg, &header, &robot, &forces, &state]
        .map(|path| fs::read_to_string(path).expect("a file"))
        .into();
    let read = "this file is an input and would be overwritten";
    refused(&["emit", &cart, "-o", &cart], read);
    refused(&["emit", &cart, "-o", &other], read);
    let stem = folder.join("c").display().to_string();
    refused(&["emit", "--language", "c", &header, "-o", &stem], read);
    refused(&["import", &robot, "-o", &robot], read);
    refused(&["draw", &svg, "--out", &svg], read);
    let simulate = ["simulate", &cart, "--until", "1"];
    refused(
        &[&simulate[..], &["--inputs", &forces, "--out", &forces]].concat(),
        read,
    );
    refused(
        &[&simulate[..], &["--times", &forces, "--out", &forces]].concat(),
        read,
    );
    refused(
        &[&simulate[..], &["--at", &state, "--out", &state]].concat(),
        read,
    );
    refused(&["simulate", &svg, "--until", "1", "--plot", &svg], read);
    let both = folder.join("both.svg").display().to_string();
    refused(
        &[&simulate[..], &["--out", &both, "--plot", &both]].concat(),
        "--out already writes this file",
    );
    let runs = folder.join("runs").display().to_string();
    let sweep = [
        "sweep",
        &cart,
        "--vary",
        "input F = grid(0, 1, 2)",
        "--until",
        "1",
        "--out",
        &runs,
    ];
    let picture = "so its name has to end in .svg";
    refused(&[&sweep[..], &["--plot", &cart]].concat(), picture);
    refused(&[&simulate[..], &["--plot", &cart]].concat(), picture);
    refused(&["draw", &cart, "--out", &cart], picture);
    let after: Vec<String> = [&cart, &svg, &header, &robot, &forces, &state]
        .map(|path| fs::read_to_string(path).expect("a file"))
        .into();
    assert_eq!(before, after);
}

/// A description that another one includes is also an input.
#[test]
fn included_files_are_read() {
    let folder = folder("included");
    let table = folder.join("thrust.csv");
    fs::write(&table, "0,0\n1,2\n").expect("written");
    let main = folder.join("main.eom");
    fs::write(
        &main,
        "system M { table thrust = file(\"thrust.csv\"); coord q; velocity w; rate q = w; particle mass 1 at [q, 0, 0]; generalized force w = thrust(q); }",
    )
    .expect("written");
    let (main, table) = (main.display().to_string(), table.display().to_string());
    let output = hamel(&["emit", &main], "");
    if output.status.success() {
        refused(&["emit", &main, "-o", &table], "this file is an input");
    }
}

#[test]
fn a_run_in_equal_steps_that_loses_its_motion_says_so() {
    for (system, options) in [
        (KEPLER, &["--until", "10"][..]),
        (
            KEPLER,
            &["--until", "10", "--method", "rkmk4", "--step", "0.01"],
        ),
    ] {
        let output = hamel(&[&["simulate", "-"], options].concat(), system);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{options:?}: {said}");
        for part in ["lost the motion", "--step", "--tol 1e-9"] {
            assert!(said.contains(part), "{options:?}: {said}");
        }
    }
    // A circular orbit is followed, and methods of order 1 may gain or lose energy.
    let circle = KEPLER.replace("0.0001", "1");
    for method in ["auto", "rkmk4", "euler", "backward-euler"] {
        let asked = [
            "simulate", "-", "--until", "10", "--step", "0.01", "--method", method,
        ];
        let output = hamel(&asked, &circle);
        assert!(
            output.status.success(),
            "{method}: {}",
            text(&output.stderr)
        );
    }
}

#[test]
fn a_comparison_of_nothing_is_none() {
    let pendulum = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models/cart_pole.eom");
    let pendulum = pendulum.display().to_string();
    let compare = ["compare", &pendulum, "--until", "1", "--methods"];
    let output = hamel(&[&compare[..], &["free", "--steps", "10"]].concat(), "");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("nothing to compare") && said.contains("free: "),
        "{said}"
    );
    // Ten steps are too few for an error of 1e-9: no times to reach it are claimed.
    let output = hamel(&[&compare[..], &["rkmk4", "--steps", "10"]].concat(), "");
    assert!(!text(&output.stdout).contains("never more than"));
    refused(
        &[&compare[..], &["rkmk4", "--steps", "10,-1"]].concat(),
        "a whole number from 1 to",
    );
}

#[test]
fn pictures_without_a_motion_take_no_inputs() {
    let folder = folder("pictures");
    let cart = folder.join("cart.eom");
    fs::write(&cart, CART).expect("written");
    let cart = cart.display().to_string();
    for given in [["--inputs", "nowhere.csv"], ["--input", "F = 1"]] {
        refused(
            &[&["draw", cart.as_str()], &given[..]].concat(),
            "--time or --motion",
        );
    }
    refused(&["import", &cart], "this is not URDF");
}

/// A run can start from the file of another run, and files by joints may contain parameters.
#[test]
fn states_of_other_forms() {
    let folder = folder("states");
    let falling = "system Fall {
        param g = 9.81;
        joint z: prismatic [0, 0, 1] moves stone;
        body on stone { mass 1; com [0, 0, 0]; }
        gravity [0, 0, -g];
    }";
    let end = folder.join("end.json").display().to_string();
    let simulate = ["simulate", "-", "--until", "1", "--out", &end];
    assert!(hamel(&simulate, falling).status.success());
    let again = folder.join("again.json").display().to_string();
    let simulate = [
        "simulate", "-", "--until", "1", "--at", &end, "--out", &again,
    ];
    let output = hamel(&simulate, falling);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let value = |path: &str| -> serde_json::Value {
        serde_json::from_str(&fs::read_to_string(path).expect("a file")).expect("JSON")
    };
    let samples = value(&again);
    let last = samples
        .as_array()
        .and_then(|list| list.last())
        .expect("a sample");
    let z = last
        .get("z")
        .and_then(serde_json::Value::as_f64)
        .expect("a number");
    assert!(
        (z + 9.81 / 2.0 * 4.0).abs() < 1e-9,
        "two seconds of free fall, not {z}"
    );
    let state = folder.join("state.json");
    fs::write(&state, r#"{"configuration": {"z": 2}, "param": {"g": 1}}"#).expect("written");
    let output = hamel(
        &["eval", "-", "--at", &state.display().to_string()],
        falling,
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let accel = value
        .pointer("/accel/0")
        .and_then(serde_json::Value::as_f64);
    assert_eq!(accel, Some(-1.0));
}
