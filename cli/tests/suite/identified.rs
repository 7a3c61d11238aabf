//! Bodies found from identified base parameters require the same forces; refused inputs.

use crate::common::{hamel, text};
use hamel_codegen::algebra::residue_pair::Random;
use hamel_codegen::generate::from_text;
use hamel_codegen::program::interpret::Interpreter;
use serde_json::Value;

/// Random numbers in ±1.
fn many(random: &mut Random, count: usize) -> Vec<f64> {
    let number = |_| random.bits() as f64 / u64::MAX as f64 * 2.0 - 1.0;
    (0..count).map(number).collect()
}

/// An arm whose two links have these ten standard parameters each, in frames at their joints.
fn two_links(standard: &[f64]) -> String {
    let body = |ten: &[f64]| {
        let [xx, xy, xz, yy, yz, zz, hx, hy, hz, m] = std::array::from_fn(|k| ten[k]);
        let [x, y, z] = [hx / m, hy / m, hz / m];
        // About the centre of mass (Steiner).
        let [xx, yy, zz] = [
            xx - m * (y * y + z * z),
            yy - m * (x * x + z * z),
            zz - m * (x * x + y * y),
        ];
        let [xy, xz, yz] = [xy + m * x * y, xz + m * x * z, yz + m * y * z];
        format!(
            "mass {m:e}; com [{x:e}, {y:e}, {z:e}]; \
             inertia [[{xx:e}, {xy:e}, {xz:e}], [{xy:e}, {yy:e}, {yz:e}], [{xz:e}, {yz:e}, {zz:e}]] about com;"
        )
    };
    format!(
        "system Two {{
            joint a: revolute [0, 1, 0] moves f {{ armature {:e}; }}
            joint b: revolute [1, 0, 0] on f at translation([0.3, 0, 0.1]) moves g;
            body on f {{ {} }}
            body on g {{ {} }}
            gravity [0, 0, -9.81];
            generate inverse_dynamics;
        }}",
        standard[20],
        body(&standard[..10]),
        body(&standard[10..20])
    )
}

/// Base parameters of other bodies lead to bodies that require the same forces: the ones nearest to the description,
/// not the other ones.
#[test]
fn identified_base_parameters_lead_back_to_bodies() {
    // Four point masses each.
    let described = [
        0.125, 0.01, -0.015, 0.12, 0.025, 0.105, 0.2, -0.05, 0.1, 2.0, //
        0.0325, 0.005, -0.0025, 0.0325, 0.005, 0.035, 0.075, 0.075, 0.0, 1.0, 0.02,
    ];
    let real = [
        0.18825, -0.00975, -0.026, 0.18975, 0.0325, 0.181, 0.285, 0.055, 0.16, 2.6, //
        0.05975, 0.0085, -0.001, 0.0515, 0.0025, 0.05975, 0.095, 0.13, 0.005, 1.3, 0.03,
    ];
    let json = |arguments: &[&str], standard: &[f64]| -> Value {
        let output = hamel(arguments, &two_links(standard));
        assert!(output.status.success(), "{}", text(&output.stderr));
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let base = json(&["regressor", "-", "--format", "json"], &real);
    let beta: Vec<f64> = base["base"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|row| row["value"].as_f64().expect("a number"))
        .collect();
    let named: serde_json::Map<String, Value> = base["base"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|row| {
            (
                row["kept"].as_str().expect("a name").to_string(),
                row["value"].clone(),
            )
        })
        .collect();
    let folder = std::env::temp_dir().join(format!("hamel-identified-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = |name: &str, value: &Value| {
        let path = folder.join(name);
        std::fs::write(&path, value.to_string()).expect("a file");
        path.display().to_string()
    };
    let list = file("list.json", &serde_json::json!(beta));
    let object = file("object.json", &Value::Object(named));
    let ask =
        |path: &str| ["regressor", "-", "--format", "json", "--identified", path].map(String::from);
    let found = |path: &str| -> Vec<f64> {
        let arguments = ask(path);
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let rows = json(&arguments, &described);
        let rows = rows["standard"].as_array().expect("a list");
        let value = |row: &Value| row["identified"].as_f64().expect("a number");
        rows.iter().map(value).collect()
    };
    let identified = found(&list);
    assert_eq!(identified, found(&object));
    assert_eq!(identified.len(), 21);
    assert!(
        (identified[9] - real[9]).abs() > 0.01,
        "the first mass has no effect"
    );
    // The generator refuses impossible inertias, and the forces are those of the real arm.
    let forces = |standard: &[f64]| {
        let generated = from_text(&two_links(standard)).expect("bodies");
        let function = generated
            .program
            .function("inverse_dynamics")
            .expect("a function")
            .clone();
        let defaults = generated.model.defaults.clone();
        let random = &mut Random::new(11);
        let mut all = Vec::new();
        for _ in 0..5 {
            let [x, xi, xi_dot] = [(); 3].map(|()| many(random, 2));
            let inverse = Interpreter::new(&generated.program, &function, &defaults);
            all.extend(inverse.call(&x, &xi, &[], &xi_dot).expect("a force"));
        }
        all
    };
    let (found, wanted) = (forces(&identified), forces(&real));
    for (found, wanted) in found.iter().zip(&wanted) {
        assert!(
            (found - wanted).abs() < 1e-9 * wanted.abs().max(1.0),
            "{found} {wanted}"
        );
    }
    let check = json(&["regressor", "-", "--format", "json"], &identified);
    for link in check["links"].as_array().expect("a list") {
        assert_eq!(link["consistent"], true, "{link}");
    }
    // Unreadable input.
    let refused = |name: &str, value: &Value, status: i32, why: &[&str]| {
        let arguments = ask(&file(name, value));
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let output = hamel(&arguments, &two_links(&described));
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{said}");
        for why in why {
            assert!(said.contains(why), "{why} is not in\n{said}");
        }
    };
    refused("short.json", &serde_json::json!([1.0]), 2, &["found 1"]);
    refused(
        "names.json",
        &serde_json::json!({ "g.Theta_xz": "much", "g.Theta_xq": 0.1 }),
        2,
        &[
            "expected a number, found `\"much\"`",
            "did you mean `g.Theta_x",
            "2 errors",
        ],
    );
    let twice = folder.join("twice.json");
    std::fs::write(&twice, r#"{ "g.h_x": 1, "g.h_x": 2 }"#).expect("a file");
    let arguments = ask(&twice.display().to_string());
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let output = hamel(&arguments, &two_links(&described));
    assert_eq!(output.status.code(), Some(2));
    assert!(
        text(&output.stderr).contains("g.h_x"),
        "{}",
        text(&output.stderr)
    );
    let both = ["regressor", "-", "--identified", "-"];
    let said = text(&hamel(&both, &two_links(&described)).stderr);
    assert!(
        said.contains("cannot both be read from standard input"),
        "{said}"
    );
    refused(
        "number.json",
        &serde_json::json!(3),
        2,
        &["expected a list of numbers"],
    );
    // A negative inertia.
    let mut impossible = beta.clone();
    impossible[0] = -1.0;
    let arguments = ask(&file("impossible.json", &serde_json::json!(impossible)));
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let output = hamel(&arguments, &two_links(&described));
    let said = text(&output.stderr);
    assert!(said.contains("no bodies have exactly these"), "{said}");
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(answer["exact"], false);
    std::fs::remove_dir_all(&folder).expect("a folder");
}
