//! Requests and their answers. A description is opened once; later requests derive or run it with the code behind the
//! commands of `hamel`.

use crate::described::{DescriptionWarnings, described};
use crate::scenes::scenes;
use hamel_cli::{Comparison, Failure, reports};
use hamel_codegen::program::Shape;
use hamel_codegen::tables;
use hamel_engine::{
    Error, Grip, InputOptions, InputSource, OpenOptions, RunArrays, Samples, Session, Simulation,
    Source, State, Stepping,
};
use serde_json::{Value, json};
use std::cell::RefCell;
use std::fmt;
use std::sync::Arc;

thread_local! {
    /// The open description.
    static OPEN: RefCell<Option<Session>> = const { RefCell::new(None) };
}

/// Answers a request, `{ "do": … }`: JSON with the result in `done` or a message in `error`, and the numbers of scenes,
/// which are too many for JSON.
pub fn answer(request: &str) -> (String, Vec<f32>) {
    let mut numbers = Vec::new();
    let answer = match serde_json::from_str::<Value>(request) {
        Ok(request) => answered(&request, &mut numbers),
        Err(error) => Err(Refused(format!("the request is not JSON: {error}"))),
    };
    let text = match answer {
        Ok(done) => json!({ "done": done }),
        Err(error) => json!({ "error": error.to_string() }),
    };
    (text.to_string(), numbers)
}

/// Reason for which a request has no answer, as the page shows it.
struct Refused(String);

impl From<Error> for Refused {
    fn from(error: Error) -> Self {
        Refused(shown(&error))
    }
}

impl From<Failure> for Refused {
    fn from(failure: Failure) -> Self {
        Refused(failure.render(false))
    }
}

impl From<serde_json::Error> for Refused {
    fn from(error: serde_json::Error) -> Self {
        Refused(error.to_string())
    }
}

impl From<&str> for Refused {
    fn from(message: &str) -> Self {
        Refused(message.into())
    }
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Renders an error as the command line shows it, without colours.
fn shown(error: &Error) -> String {
    format!("error: {error}\n")
}

fn answered(request: &Value, numbers: &mut Vec<f32>) -> Result<Value, Refused> {
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

/// Reads and derives a description; its errors are part of the answer.
fn open(request: &Value) -> Value {
    let (text, name) = (text(request, "text"), text(request, "name"));
    // The memory of the old description is freed first.
    OPEN.replace(None);
    let said = Arc::new(DescriptionWarnings::default());
    let read = Session::read(text.clone(), &name, &OpenOptions::default(), said.clone());
    match read {
        Ok(session) => {
            let system = described(&session);
            OPEN.replace(Some(session));
            json!({ "system": system, "marks": said.marks(&[], &text), "said": said.text() })
        }
        Err(error) => {
            let marks = said.marks(error.diagnostics(), &text);
            json!({ "system": null, "marks": marks, "said": shown(&error) })
        }
    }
}

/// Converts a robot in URDF to a description.
fn import(request: &Value) -> Value {
    let options = OpenOptions {
        floating: request["floating"] == true,
        ..OpenOptions::default()
    };
    let said = Arc::new(DescriptionWarnings::default());
    let source = Source::new(text(request, "name"), text(request, "text"), said.clone());
    match source.robot(&options) {
        Ok(source) => json!({ "text": source.text, "said": said.text() }),
        Err(error) => json!({ "text": null, "said": shown(&error) }),
    }
}

fn asked(
    session: &Session,
    what: &str,
    request: &Value,
    numbers: &mut Vec<f32>,
) -> Result<Value, Refused> {
    let name = text(request, "name");
    Ok(match what {
        "tables" => tables::typeset(&session.tables(&texts(request, "of"))?),
        "check" => check(session),
        "operations" => serde_json::from_str(&reports::operations(session)?)?,
        "advice" => serde_json::from_str(&reports::advice(session)?)?,
        "rust" => json!(reports::rust(session, &name)?),
        "c" => {
            let stem = name.strip_suffix(".eom").unwrap_or(&name);
            let files = reports::c(session, &name, stem)?;
            json!({ "header": files.header, "source": files.source })
        }
        "evaluate" => serde_json::to_value(session.evaluate(&state(session, request)?)?)?,
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
            {
                let state = state(session, request)?;
                serde_json::from_str(&reports::compare(session, &state, &asked)?)?
            }
        }
        _ => return Err(Refused(format!("nothing is called `{what}`"))),
    })
}

fn check(session: &Session) -> Value {
    let (identities, remarks) = reports::check(session);
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

/// Returns the start, with x and ξ of the request if given, and the changes of the request.
fn state(session: &Session, request: &Value) -> Result<State, Refused> {
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
            Ok(session.change_state(start, &changes, "the start")?)
        }
    }
}

/// Returns the start after a point is pulled towards a target, with its scene.
fn pull(session: &Session, request: &Value, numbers: &mut Vec<f32>) -> Result<Value, Refused> {
    let vector = |key: &str| {
        <[f64; 3]>::try_from(list(request, key))
            .map_err(|_| Refused(format!("`{key}` has to have three numbers")))
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
    let pulled = session.pull(&state, grip, (vector("target")?, sight))?;
    if let Some(drawn) = scenes(session, &pulled.params, &pulled.x) {
        *numbers = drawn.numbers;
    }
    Ok(json!({ "x": pulled.x, "xi": pulled.xi }))
}

fn simulate(session: &Session, request: &Value, numbers: &mut Vec<f32>) -> Result<Value, Refused> {
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
    let inputs = InputOptions {
        expressions: texts(request, "inputs"),
        ..InputOptions::default()
    };
    let drawn = request["scenes"] == true;
    let mut simulation = Simulation {
        inputs: InputSource::Options(inputs),
        ..Simulation::new(stepping)
    };
    let mut run = RunArrays::of(&session.simulate(&state, &simulation)?);
    // Adaptive steps may be too long to be drawn; the dense output between them is as accurate.
    let stepping = &simulation.stepping;
    if drawn && stepping.step.is_none() && run.t.len() < MOMENTS && run.failure.is_none() {
        simulation.samples = Samples::At(moments(stepping.until));
        run = RunArrays::of(&session.simulate(&state, &simulation)?);
    }
    let named = |list: &[(String, Shape, Vec<f64>)]| -> Vec<Value> {
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
        Ok(drawing) if drawn => drawing.unplaced_parts(),
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
        "failure": run.failure.map(|why| why.to_string()),
    }))
}

/// Smallest number of samples of a drawn run.
const MOMENTS: usize = 600;

/// Equally spaced times from 0 to an end.
fn moments(until: f64) -> Vec<f64> {
    let inner = (0..MOMENTS).map(|k| until * k as f64 / MOMENTS as f64);
    inner.chain([until]).collect()
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
        // The description that was open before is closed.
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
