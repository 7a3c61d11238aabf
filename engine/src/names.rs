//! Names of scalar entries, as the language writes them: `r[1]`, `R[1,2]`, `q.c`.

use hamel_codegen::model::layout::entry_names;
use hamel_codegen::model::{Group, Model};
use hamel_codegen::program::Shape;
use hamel_codegen::syntax::ast::ShapeKind;
use hamel_codegen::syntax::suggest::coordinates_of_rate;

/// The name of the time.
pub const TIME: &str = "t";
/// Suffix of the name of the time if it is taken.
const OF_RUN: &str = "_run";

/// Returns the names of the entries of x.
pub fn coordinates(model: &Model) -> Vec<String> {
    model
        .coordinates
        .iter()
        .flat_map(|coordinate| entry_names(&coordinate.name, coordinate.kind))
        .collect()
}

/// Returns the names of the entries of ξ.
pub fn velocities(model: &Model) -> Vec<String> {
    model.velocities.iter().flat_map(group).collect()
}

/// Returns the coordinates whose rate is a velocity, each with the name of that velocity.
pub fn rates(model: &Model) -> Vec<(String, String)> {
    let velocities = velocities(model);
    let rates = coordinates(model).into_iter().zip(&model.rate);
    let plain = rates.filter_map(|(coordinate, rate)| {
        let place = model.xi.iter().position(|symbol| symbol == rate)?;
        Some((coordinate, velocities.get(place)?.clone()))
    });
    plain.collect()
}

/// Returns advice on a name that seems to denote the rate of one of these coordinates, as `x_dot` does for `x`.
pub fn advice_on_rate(rates: &[(String, String)], name: &str) -> Option<String> {
    let find = |stem: &str| rates.iter().find(|(coordinate, _)| coordinate == stem);
    let (coordinate, velocity) = coordinates_of_rate(name).find_map(find)?;
    Some(format!("the rate of `{coordinate}` is `{velocity}`"))
}

/// Returns the names of the entries of ξ, followed by those of the states of first order.
pub fn velocities_and_states(model: &Model) -> Vec<String> {
    let groups = model.velocities.iter().chain(&model.states);
    groups.flat_map(group).collect()
}

/// Name of the time among the recorded values of a run, and the shift to the time of the description.
#[derive(Clone, Debug, PartialEq)]
pub struct Time {
    /// Name, which is unique.
    pub name: String,
    /// Index in x, if it is the description's time; otherwise it counts from the start of the run.
    pub place: Option<usize>,
}

impl Time {
    /// Names the time of a run `t`. It is the description's time if that declares `time t;`; if another quantity
    /// has this name, including those in `taken`, a suffix is added.
    pub fn of(model: &Model, taken: &[&[String]]) -> Self {
        let mut name = TIME.to_string();
        let own = model.clock.map(|clock| clock.x);
        let place = own.filter(|&place| coordinates(model)[place] == name);
        if place.is_none() {
            let is_taken = |name: &String| taken.iter().any(|list| list.contains(name));
            while is_taken(&name) {
                name.push_str(OF_RUN);
            }
        }
        Time { name, place }
    }

    /// Returns the time at x, where t is the time of the run.
    pub fn at(&self, t: f64, x: &[f64]) -> f64 {
        self.place
            .and_then(|place| x.get(place))
            .copied()
            .unwrap_or(t)
    }
}

/// Returns the names of the entries of a parameter, a velocity or an input.
pub fn group(group: &Group) -> Vec<String> {
    let name = &group.name;
    match group.shape {
        ShapeKind::Scalar => entries(name, Shape::Scalar),
        ShapeKind::Vector(n) => entries(name, Shape::Vector(n)),
        ShapeKind::Matrix(n) => entries(name, Shape::Matrix(n, n)),
        ShapeKind::Symmetric(n) => (1..=n)
            .flat_map(|i| (i..=n).map(move |j| format!("{name}[{i},{j}]")))
            .collect(),
    }
}

/// Returns the names of the entries of an output, matrices by rows.
pub fn entries(name: &str, shape: Shape) -> Vec<String> {
    match shape {
        Shape::Scalar => vec![name.to_string()],
        Shape::Vector(n) => (1..=n).map(|i| format!("{name}[{i}]")).collect(),
        Shape::Matrix(rows, columns) => (1..=rows)
            .flat_map(|i| (1..=columns).map(move |j| format!("{name}[{i},{j}]")))
            .collect(),
    }
}
