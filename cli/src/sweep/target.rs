//! Variable targets: parameters, starts and inputs, by their names or those of their entries; written as states in
//! JSON.

use hamel::{s3, so3};
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::model::layout::entry_names;
use hamel_codegen::model::{Coordinate, Group, Model};
use hamel_codegen::syntax::ast::{CoordKind, ShapeKind};
use hamel_codegen::syntax::path::plain;
use hamel_codegen::syntax::suggest::closest;
use hamel_engine::State;
use hamel_engine::names;
use hamel_engine::option_text::Piece;
use serde_json::{Map, Value};

/// The kind of symbol that a name refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Parameters.
    Parameter,
    /// Coordinates, velocities and states of first order.
    Start,
    /// Inputs.
    Input,
}

impl Part {
    /// Returns the keyword before the name, with a space after it.
    pub fn word(self) -> &'static str {
        match self {
            Part::Parameter => "",
            Part::Start => "start ",
            Part::Input => "input ",
        }
    }
}

/// A group of symbols with its values when nothing is varied.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Key of its section in a state in JSON.
    pub part: &'static str,
    /// Plain name.
    pub name: String,
    /// For a pose, which part of it.
    pub of_pose: Option<&'static str>,
    /// Names of the entries, used as column names.
    pub entries: Vec<String>,
    /// Values.
    pub base: Vec<f64>,
    form: Form,
}

/// Form of values in a state.
#[derive(Clone, Debug, PartialEq)]
enum Form {
    Scalar,
    Vector,
    /// A matrix with rows of this length.
    Matrix(usize),
    /// A symmetric matrix, rows from the diagonal on.
    Symmetric(usize),
    /// A rotation from this attitude, by a rotation vector in body axes.
    Rotation(so3::Matrix<f64>),
    /// Likewise for a unit quaternion.
    Quaternion([f64; 4]),
}

impl Target {
    /// Resolves a name, which `piece` contains, to a target and the indices of its entries.
    pub fn find(
        piece: Piece,
        part: Part,
        name: &str,
        model: &Model,
        state: &State,
    ) -> Result<(Self, Vec<usize>), Diagnostic> {
        let all = Target::all(part, model, state);
        let called = |target: &&Target| plain(&target.qualified_name()) == plain(name);
        if let Some(target) = all.iter().find(called) {
            if let Form::Matrix(_) | Form::Symmetric(_) = target.form {
                return Err(piece.wrong(format!(
                    "a matrix is varied by its entries, as in `{}{}`",
                    part.word(),
                    target.entries[0]
                )));
            }
            return Ok((target.clone(), (0..target.entries.len()).collect()));
        }
        for target in &all {
            let meant = |entry: &String| entry == name || plain(entry) == plain(name);
            if let Some(place) = target.entries.iter().position(meant) {
                return Ok((target.clone(), vec![place]));
            }
        }
        if let Some(pose) = model.coordinates.iter().find(|known| {
            part == Part::Start && known.kind == CoordKind::SE3 && known.name == plain(name)
        }) {
            return Err(piece.wrong(format!(
                "`{0}` is a pose: vary its position `start {0}.p`, its rotation `start {0}.R`, or both",
                pose.name
            )));
        }
        let what = match part {
            Part::Parameter => "parameter",
            Part::Start => "coordinate, velocity or state",
            Part::Input => "input",
        };
        let message = format!("no {what} is called `{name}`");
        let names: Vec<String> = all.iter().map(Target::qualified_name).collect();
        let close = closest(name, names.iter().map(String::as_str));
        Err(piece.wrong(match (close, names.as_slice()) {
            (Some(close), _) => format!("{message}: did you mean `{close}`?"),
            (None, []) => format!("{message}: the description has none"),
            (None, names) => format!("{message}: there are {}", names.join(", ")),
        }))
    }

    /// Returns all targets of a kind.
    fn all(part: Part, model: &Model, state: &State) -> Vec<Self> {
        let groups = |part: &'static str, groups: &[Group], numbers: &[f64]| -> Vec<Target> {
            let target = |group: &Group| Target {
                part,
                name: group.name.clone(),
                of_pose: None,
                entries: names::group(group),
                base: numbers[group.offset..group.offset + group.len].to_vec(),
                form: match group.shape {
                    ShapeKind::Scalar => Form::Scalar,
                    ShapeKind::Vector(_) => Form::Vector,
                    ShapeKind::Matrix(n) => Form::Matrix(n),
                    ShapeKind::Symmetric(n) => Form::Symmetric(n),
                },
            };
            groups.iter().map(target).collect()
        };
        match part {
            Part::Parameter => groups("param", &model.params, &state.params),
            Part::Input => groups("input", &model.inputs, &state.u),
            Part::Start => {
                let coordinates = model.coordinates.iter();
                let coordinates = coordinates.flat_map(|one| coordinate(one, &state.x));
                let velocities = groups("velocity", &model.velocities, &state.xi);
                let states = groups("state", &model.states_behind(), &state.xi);
                coordinates.chain(velocities).chain(states).collect()
            }
        }
    }

    /// Name as in descriptions.
    fn qualified_name(&self) -> String {
        match self.of_pose {
            Some(part) => format!("{}.{part}", self.name),
            None => self.name.clone(),
        }
    }

    /// Returns whether both are the same symbol.
    pub fn is(&self, other: &Target) -> bool {
        let key = |target: &'_ Target| (target.part, target.name.clone(), target.of_pose);
        key(self) == key(other)
    }

    /// Puts values into a state in JSON.
    pub fn set_values(&self, state: &mut Map<String, Value>, numbers: &[f64]) {
        fn within<'a>(
            map: &'a mut Map<String, Value>,
            name: &str,
        ) -> Option<&'a mut Map<String, Value>> {
            let inner = map.entry(name).or_insert_with(|| Map::new().into());
            inner.as_object_mut()
        }
        let Some(part) = within(state, self.part) else {
            return;
        };
        match self.of_pose {
            None => {
                part.insert(self.name.clone(), self.json(numbers));
            }
            Some(of_pose) => {
                if let Some(pose) = within(part, &self.name) {
                    pose.insert(of_pose.into(), self.json(numbers));
                }
            }
        }
    }

    /// Returns the JSON form of values.
    fn json(&self, numbers: &[f64]) -> Value {
        let list = |numbers: &[f64]| Value::from(numbers.to_vec());
        match &self.form {
            Form::Scalar => numbers.first().copied().unwrap_or(f64::NAN).into(),
            Form::Vector => list(numbers),
            Form::Matrix(n) => numbers.chunks(*n).map(list).collect(),
            Form::Symmetric(n) => {
                // Row i begins after n + (n − 1) + … entries.
                let entry = |i: usize, j: usize| {
                    let (i, j) = (i.min(j), i.max(j));
                    numbers[i * n - i * (i + 1) / 2 + j]
                };
                let row = |i| list(&(0..*n).map(|j| entry(i, j)).collect::<Vec<f64>>());
                (0..*n).map(row).collect()
            }
            Form::Rotation(start) => {
                let turned = so3::retract(*start, vector(numbers));
                turned.chunks(3).map(list).collect()
            }
            Form::Quaternion(start) => list(&s3::retract(*start, vector(numbers))),
        }
    }
}

fn vector(numbers: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| numbers.get(i).copied().unwrap_or(0.0))
}

/// Returns the targets of a coordinate; for a pose, its position and its rotation.
fn coordinate(coordinate: &Coordinate, x: &[f64]) -> Vec<Target> {
    let (name, at) = (&coordinate.name, coordinate.offset);
    let target = |of_pose, entries, base, form| Target {
        part: "coord",
        name: name.clone(),
        of_pose,
        entries,
        base,
        form,
    };
    let three = |name: &str| (1..=3).map(|i| format!("{name}[{i}]")).collect();
    let rotation = |at: usize| Form::Rotation(std::array::from_fn(|i| x[at + i]));
    let one = match coordinate.kind {
        CoordKind::Real => target(None, vec![name.clone()], vec![x[at]], Form::Scalar),
        CoordKind::Euclidean(n) => {
            let entries = entry_names(name, coordinate.kind);
            target(None, entries, x[at..at + n].to_vec(), Form::Vector)
        }
        CoordKind::S1 => {
            let angle = libm::atan2(x[at + 1], x[at]);
            target(None, vec![name.clone()], vec![angle], Form::Scalar)
        }
        CoordKind::S3 => {
            let start = std::array::from_fn(|i| x[at + i]);
            target(None, three(name), vec![0.0; 3], Form::Quaternion(start))
        }
        CoordKind::SO3 => target(None, three(name), vec![0.0; 3], rotation(at)),
        CoordKind::SE3 => {
            let [p, turn] = ["p", "R"].map(|part| three(&format!("{name}.{part}")));
            return vec![
                target(Some("p"), p, x[at..at + 3].to_vec(), Form::Vector),
                target(Some("R"), turn, vec![0.0; 3], rotation(at + 3)),
            ];
        }
    };
    vec![one]
}
