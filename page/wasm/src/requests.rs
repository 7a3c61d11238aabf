//! What can be asked, and the answers. A description is opened once; what is asked of it after that is derived or run by
//! the code behind the commands of `hamel`.

use crate::described::{described, marks};
use crate::scenes::scenes;
use hamel_cli::{
    Asked, Comparison, Failure, Grip, RobotOptions, Session, State, Stepping, imported,
};
use serde_json::{Value, json};
use std::cell::RefCell;

thread_local! {
    /// The description that was opened last.
    static OPEN: RefCell<Option<Session>> = const { RefCell::new(None) };
}

/// The answer to a request, `{ "do": … }`: what was asked for under `done`, or what is wrong under `error`; and behind it
/// the numbers of scenes, which are too many for a text.
pub fn answer(request: &str) -> (String, Vec<f32>) {
    let mut numbers = Vec::new();
    let answer = match serde_json::from_str::<Value>(request) {
        Ok(request) => answered(&request, &mut numbers),
        Err(error) => Err(format!("the request is not JSON: {error}")),
    };
    let text = match answer {
        Ok(done) => json!({ "done": done }),
        Err(error) => json!({ "error": error }),
    };
    (text.to_string(), numbers)
}

fn answered(request: &Value, numbers: &mut Vec<f32>) -> Result<Value, String> {
    let what = text(request, "do");
    match what.as_str() {
        "open" => return Ok(open(request)),
        "import" => return Ok(import(request)),
        _ => {}
    }
    OPEN.with_borrow(|session| match session {
        Some(session) => asked(session, &what, request, numbers),
        None => Err("no description is open".into()),
    })
}

/// Reads and derives a description; what is wrong with it is part of the answer.
fn open(request: &Value) -> Value {
    let (text, name) = (text(request, "text"), text(request, "name"));
    // What was open goes first: its memory is needed.
    OPEN.replace(None);
    let (read, said) = Session::marked(text.clone(), &name, &RobotOptions::default());
    let marks = marks(&said, &text);
    match read {
        Ok(session) => {
            let system = described(&session);
            OPEN.replace(Some(session));
            json!({ "system": system, "marks": marks, "said": said.warnings })
        }
        Err(failure) => json!({ "system": null, "marks": marks, "said": failure.text() }),
    }
}

/// A robot in URDF as a description.
fn import(request: &Value) -> Value {
    let options = RobotOptions {
        floating: request["floating"] == true,
        ..RobotOptions::default()
    };
    let (read, said) = imported(text(request, "text"), &text(request, "name"), &options);
    match read {
        Ok(text) => json!({ "text": text, "said": said.warnings }),
        Err(failure) => json!({ "text": null, "said": failure.text() }),
    }
}

fn asked(
    session: &Session,
    what: &str,
    request: &Value,
    numbers: &mut Vec<f32>,
) -> Result<Value, String> {
    let name = text(request, "name");
    Ok(match what {
        "tables" => parsed(session.typeset(&texts(request, "of")))?,
        "check" => check(session),
        "operations" => parsed(session.operations())?,
        "advice" => parsed(session.advice())?,
        "rust" => json!(session.rust(&name).map_err(said)?),
        "c" => {
            let stem = name.strip_suffix(".eom").unwrap_or(&name);
            let files = session.c(&name, stem).map_err(said)?;
            json!({ "header": files.header, "source": files.source })
        }
        "evaluate" => parsed(session.evaluate(&state(session, request)?))?,
        "simulate" => simulate(session, request, numbers)?,
        "pull" => pull(session, request, numbers)?,
        "compare" => {
            let steps = request["steps"].as_array();
            let steps = steps.map(|list| list.iter().filter_map(Value::as_u64).collect());
            let asked = Comparison {
                methods: texts(request, "methods"),
                until: number(request, "until").unwrap_or(1.0),
                steps: steps.unwrap_or_default(),
                repeats: 0,
            };
            parsed(session.compare(&state(session, request)?, &asked))?
        }
        _ => return Err(format!("nothing is called `{what}`")),
    })
}

fn check(session: &Session) -> Value {
    let (identities, remarks) = session.check();
    let identities = identities.iter().map(|identity| {
        json!({
            "label": identity.label,
            "equation": identity.equation,
            "verdict": identity.verdict,
            "told": identity.explanation,
        })
    });
    json!({ "identities": identities.collect::<Vec<Value>>(), "remarks": remarks })
}

/// The start, or the x and ξ that are given, changed by what is asked for.
fn state(session: &Session, request: &Value) -> Result<State, String> {
    let mut start = session.start();
    for (entries, key) in [(&mut start.x, "x"), (&mut start.xi, "xi")] {
        let given = list(request, key);
        if given.len() == entries.len() {
            *entries = given;
        }
    }
    match &request["state"] {
        Value::Null => Ok(start),
        changes => {
            let changes = changes.to_string();
            session.changed(start, &changes, "the start").map_err(said)
        }
    }
}

/// The start after a point of it was pulled towards a place, and how it looks.
fn pull(session: &Session, request: &Value, numbers: &mut Vec<f32>) -> Result<Value, String> {
    let vector = |key: &str| {
        <[f64; 3]>::try_from(list(request, key))
            .map_err(|_| format!("`{key}` has to have three numbers"))
    };
    let index = |key: &str| {
        request[key]
            .as_u64()
            .and_then(|index| usize::try_from(index).ok())
    };
    let grip = match (index("frame"), index("particle")) {
        (Some(frame), _) => Grip::Frame(frame, vector("at")?),
        (None, Some(particle)) => Grip::Particle(particle),
        (None, None) => return Err("a pull needs a `frame` or a `particle`".into()),
    };
    let state = state(session, request)?;
    let sight = vector("sight").ok();
    let pulled = session
        .pulled(&state, grip, (vector("target")?, sight))
        .map_err(said)?;
    if let Some(drawn) = scenes(session, &pulled.params, &pulled.x) {
        *numbers = drawn.numbers;
    }
    Ok(json!({ "x": pulled.x, "xi": pulled.xi }))
}

fn simulate(session: &Session, request: &Value, numbers: &mut Vec<f32>) -> Result<Value, String> {
    let stepping = Stepping {
        until: number(request, "until").unwrap_or(10.0),
        step: number(request, "step"),
        method: match text(request, "method") {
            auto if auto.is_empty() => "auto".into(),
            method => method,
        },
        tol: number(request, "tol"),
        lambda: None,
    };
    let state = state(session, request)?;
    let inputs = Asked {
        input: texts(request, "inputs"),
        ..Asked::default()
    };
    let drawn = request["scenes"] == true;
    let run = |times| {
        let run = session.simulate(&state, &stepping, (None, times), (&inputs, None), &[], None);
        run.map_err(said)
    };
    let mut ran = run(None)?;
    // Steps that are chosen by their error may be too long to be drawn; what is between them is known as exactly.
    if drawn && stepping.step.is_none() && ran.t.len() < MOMENTS && ran.failure.is_none() {
        ran = run(Some(moments(stepping.until)))?;
    }
    let run = ran;
    let named = |list: &[(String, hamel_cli::Shape, Vec<f64>)]| -> Vec<Value> {
        let parts = list.iter();
        parts
            .map(|(name, shape, values)| {
                json!({ "name": name, "width": shape.entries(), "values": values })
            })
            .collect()
    };
    let drawing = drawn.then(|| scenes(session, &state.params, &run.x));
    let (scene, width) = match drawing.flatten() {
        Some(drawn) => {
            *numbers = drawn.numbers;
            (drawn.first, drawn.width)
        }
        None => (Value::Null, 0),
    };
    let missing = match session.drawing() {
        Ok(drawing) if drawn => drawing.missing(),
        _ => &[],
    };
    Ok(json!({
        "scene": scene,
        "width": width,
        "missing": missing,
        "t": run.t,
        "x": run.x,
        "xi": run.xi,
        "energy": run.energy,
        "outputs": named(&run.outputs),
        "invariants": named(&run.invariants),
        "method": run.method,
        "reason": run.reason,
        "steps": run.steps,
        "evaluations": run.evaluations,
        "drift": run.energy_deviation,
        "constraint": run.constraint,
        "failure": run.failure,
    }))
}

/// As many samples are drawn at least.
const MOMENTS: usize = 600;

/// Times from 0 to an end.
fn moments(until: f64) -> Vec<f64> {
    let inner = (0..MOMENTS).map(|k| until * k as f64 / MOMENTS as f64);
    inner.chain([until]).collect()
}

/// A text that is JSON already.
fn parsed(written: Result<String, Failure>) -> Result<Value, String> {
    let written = written.map_err(said)?;
    serde_json::from_str(&written).map_err(|error| error.to_string())
}

fn said(failure: Failure) -> String {
    failure.text()
}

fn text(request: &Value, key: &str) -> String {
    request[key].as_str().unwrap_or_default().into()
}

fn texts(request: &Value, key: &str) -> Vec<String> {
    let list = request[key].as_array();
    let texts = list.into_iter().flatten().filter_map(Value::as_str);
    texts.map(String::from).collect()
}

fn list(request: &Value, key: &str) -> Vec<f64> {
    let list = request[key].as_array();
    list.into_iter()
        .flatten()
        .filter_map(Value::as_f64)
        .collect()
}

fn number(request: &Value, key: &str) -> Option<f64> {
    request[key].as_f64()
}

#[cfg(test)]
mod tests {
    use super::answer;
    use serde_json::{Value, json};

    const TEXT: &str =
        "pub system S { coord q; velocity w; rate q = w; kinetic w^2 / 2; start w = 1; }";

    fn asked(request: Value) -> Value {
        let (answer, _) = answer(&request.to_string());
        serde_json::from_str(&answer).expect("answers are JSON")
    }

    #[test]
    fn errors_have_the_words_and_the_place_of_the_description() {
        let text = TEXT.replace("w^2", "v^2");
        let done = asked(json!({ "do": "open", "text": text, "name": "s.eom" }))["done"].take();
        assert_eq!(done["system"], Value::Null);
        let mark = &done["marks"][0];
        let place = text.find("v^2").expect("it is there");
        assert_eq!(mark["range"], json!([place, place + 1]));
        let said = done["said"].as_str().expect("a text");
        assert!(
            said.contains(mark["message"].as_str().expect("a text")),
            "{said}"
        );
        // What was open before is not any more.
        let refused = asked(json!({ "do": "tables", "of": ["M"] }));
        assert_eq!(refused["error"], "no description is open");
    }

    #[test]
    fn what_is_open_is_derived_and_run() {
        let done = asked(json!({ "do": "open", "text": TEXT, "name": "s.eom" }))["done"].take();
        assert_eq!(done["system"]["velocities"]["entries"], json!(["w"]));
        let tables = asked(json!({ "do": "tables", "of": ["M"] }));
        assert_eq!(tables["done"]["tables"][0]["groups"][0]["value"], "1");
        let state = json!({ "velocity": { "w": 2 } });
        let run = asked(json!({ "do": "simulate", "until": 3, "state": state }));
        let x = run["done"]["x"].as_array().expect("a list");
        let end = x.last().and_then(Value::as_f64).expect("a number");
        assert!((end - 6.0).abs() < 1e-12, "{end}");
        let wrong =
            asked(json!({ "do": "simulate", "until": 3, "state": { "velocity": { "v": 2 } } }));
        let wrong = wrong["error"].as_str().expect("an error");
        assert!(wrong.contains("velocity.v"), "{wrong}");
    }

    #[test]
    fn scenes_of_a_run_are_one_list_of_numbers() {
        let text = "pub system P { joint q: revolute [0, 1, 0] moves arm;
            body on arm { mass 2; com [0, 0, -0.5]; inertia diag(0.1, 0.1, 0) about com; }
            gravity [0, 0, -9.81]; start q = 0.5; }";
        asked(json!({ "do": "open", "text": text, "name": "p.eom" }));
        let request = json!({ "do": "simulate", "until": 1, "scenes": true });
        let (answer, numbers) = answer(&request.to_string());
        let answer: Value = serde_json::from_str(&answer).expect("JSON");
        let (done, count) = (
            &answer["done"],
            answer["done"]["t"].as_array().map(Vec::len),
        );
        let width = done["width"].as_u64().expect("a number") as usize;
        assert_eq!(Some(numbers.len()), count.map(|count| count * width));
        // The frame of the arm, the body with its axes, the joint with one axis, and the centre of mass.
        assert_eq!(width, 12 + 12 + 6 + 3);
        let centre = |scene: &[f32]| f64::from(scene[12]).hypot(f64::from(scene[14]));
        assert!(
            numbers
                .chunks(width)
                .all(|scene| (centre(scene) - 0.5).abs() < 1e-6)
        );
        let start = done["scene"]["bodies"][0]["centre"][0].as_f64();
        assert_eq!(start.map(|x| x as f32), Some(numbers[12]));
        assert_ne!(numbers[12], numbers[numbers.len() - width + 12]);
    }

    #[test]
    fn requests_that_make_no_sense_are_refused() {
        for request in ["", "7", "{}", "{\"do\": 3}", "{\"do\": \"fly\"}"] {
            let answer: Value = serde_json::from_str(&answer(request).0).expect("JSON");
            assert!(answer["error"].is_string(), "{request}: {answer}");
        }
    }
}
