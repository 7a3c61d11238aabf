//! What can be varied: parameters, starts and inputs, by their names or by those of their entries; as states in JSON.

use crate::names;
use crate::state::State;
use hamel::{s3, so3};
use hamel_codegen::model::layout::entry_names;
use hamel_codegen::model::{Coordinate, Group, Model};
use hamel_codegen::syntax::ast::{CoordKind, ShapeKind};
use hamel_codegen::syntax::path::plain;
use hamel_codegen::syntax::suggest::closest;
use serde_json::Value;

/// What a name is looked for among.
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
    /// The word before the name, with the space behind it.
    pub fn word(self) -> &'static str {
        match self {
            Part::Parameter => "",
            Part::Start => "start ",
            Part::Input => "input ",
        }
    }
}

/// Something of the description with the numbers that it has where nothing is varied.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Where it stands in a state in JSON.
    pub part: &'static str,
    /// Its plain name.
    pub name: String,
    /// Names of its entries, as columns are called.
    pub entries: Vec<String>,
    /// Its numbers.
    pub base: Vec<f64>,
    form: Form,
}

/// How numbers are written in a state.
#[derive(Clone, Debug, PartialEq)]
enum Form {
    Scalar,
    Vector,
    /// Rows of a matrix.
    Matrix(usize),
    /// Rows from the diagonal on.
    Symmetric(usize),
    /// A turn from this attitude, by the vector of its axis and angle in body axes.
    Rotation(so3::Matrix<f64>),
    /// The same of a unit quaternion.
    Quaternion([f64; 4]),
}

impl Target {
    /// What a name means, with the entries of it that are meant.
    pub fn find(
        part: Part,
        name: &str,
        model: &Model,
        state: &State,
    ) -> Result<(Self, Vec<usize>), String> {
        let all = Target::all(part, model, state);
        if let Some(target) = all.iter().find(|target| target.name == plain(name)) {
            if let Form::Matrix(_) | Form::Symmetric(_) = target.form {
                return Err(format!(
                    "a matrix is varied by its entries, as in `{}{}`",
                    part.word(),
                    target.entries[0]
                ));
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
            return Err(format!(
                "`{}` is a pose, which cannot be varied: describe it as a position of kind R3 and a rotation of kind SO3",
                pose.name
            ));
        }
        let what = match part {
            Part::Parameter => "parameter",
            Part::Start => "coordinate, velocity or state",
            Part::Input => "input",
        };
        let message = format!("no {what} is called `{name}`");
        let names: Vec<&str> = all.iter().map(|target| target.name.as_str()).collect();
        Err(
            match (closest(name, names.iter().copied()), names.as_slice()) {
                (Some(close), _) => format!("{message}: did you mean `{close}`?"),
                (None, []) => format!("{message}: the description has none"),
                (None, names) => format!("{message}: there are {}", names.join(", ")),
            },
        )
    }

    /// All of a part.
    fn all(part: Part, model: &Model, state: &State) -> Vec<Self> {
        let groups = |part: &'static str, groups: &[Group], numbers: &[f64]| -> Vec<Target> {
            let target = |group: &Group| Target {
                part,
                name: group.name.clone(),
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
                let coordinates = coordinates.filter_map(|one| coordinate(one, &state.x));
                let velocities = groups("velocity", &model.velocities, &state.xi);
                let states = groups("state", &model.states_behind(), &state.xi);
                coordinates.chain(velocities).chain(states).collect()
            }
        }
    }

    /// These numbers as a state gives them.
    pub fn json(&self, numbers: &[f64]) -> Value {
        let list = |numbers: &[f64]| Value::from(numbers.to_vec());
        match &self.form {
            Form::Scalar => numbers.first().copied().unwrap_or(f64::NAN).into(),
            Form::Vector => list(numbers),
            Form::Matrix(n) => numbers.chunks(*n).map(list).collect(),
            Form::Symmetric(n) => {
                // Row i begins behind n + (n − 1) + … entries.
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

/// A coordinate; none where it is a pose.
fn coordinate(coordinate: &Coordinate, x: &[f64]) -> Option<Target> {
    let (name, at) = (&coordinate.name, coordinate.offset);
    let turns = || (1..=3).map(|i| format!("{name}[{i}]")).collect();
    let (entries, base, form) = match coordinate.kind {
        CoordKind::Real => (vec![name.clone()], vec![x[at]], Form::Scalar),
        CoordKind::Euclidean(n) => (
            entry_names(name, coordinate.kind),
            x[at..at + n].to_vec(),
            Form::Vector,
        ),
        CoordKind::S1 => (
            vec![name.clone()],
            vec![libm::atan2(x[at + 1], x[at])],
            Form::Scalar,
        ),
        CoordKind::S3 => {
            let start = std::array::from_fn(|i| x[at + i]);
            (turns(), vec![0.0; 3], Form::Quaternion(start))
        }
        CoordKind::SO3 => {
            let start = std::array::from_fn(|i| x[at + i]);
            (turns(), vec![0.0; 3], Form::Rotation(start))
        }
        CoordKind::SE3 => return None,
    };
    Some(Target {
        part: "coord",
        name: name.clone(),
        entries,
        base,
        form,
    })
}
