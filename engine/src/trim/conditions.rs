//! The conditions of a trim as equations for a point: residuals, exact slopes along the independent displacements, and
//! retraction.

use super::problem::{TrimOptions, TrimProblem};
use crate::error::Error;
use crate::linearize::minimal::{Tangent, tangent};
use crate::mechanism::{FunctionIndex, Functions, compile_functions, find_function};
use crate::names;
use crate::option_text::Piece;
use crate::source::added_outputs;
use crate::state::State;
use crate::state::given_entries::full_frame_indices;
use hamel_codegen::algebra::dense::{apply, dot, largest, product};
use hamel_codegen::functions::SLOPES;
use hamel_codegen::generate::Generated;
use hamel_codegen::model::loop_closure::LoopClosure;
use hamel_codegen::model::pfaffian::{Kind, Pfaffian};
use hamel_codegen::program::Shape;

/// Displacement of the central differences of d/dt ξ̇, relative to 1 or to the unknown if that is larger.
const DIFFERENCE: f64 = 1e-5;

/// Differences of d/dt ξ̇ below this, relative to its terms, are rounding errors.
const DIFFERENCE_NOISE: f64 = 1e-13;

/// The functions that all conditions need.
const FUNCTIONS: [&str; 3] = ["linearize", "displacement_frame", "accel"];

/// The conditions for a state, which is complete at every point: loops are closed, constraints hold.
pub struct Conditions<'a> {
    pub generated: &'a Generated,
    pub steady: bool,
    functions: Functions,
    linearize: FunctionIndex,
    frame: FunctionIndex,
    accel: FunctionIndex,
    fixes: Vec<Fix>,
    /// Whether all velocities vanish for all time, also those that constraints determine: their rates may be finite where
    /// the independent ones do not determine them.
    rests: bool,
    /// Required values of ξ̇ and ż.
    rates: Vec<f64>,
    /// Whether each entry of (h, δξ, δz, δu) may change.
    is_free: Vec<bool>,
    /// Numbers of displacements, velocities and states of first order.
    pub sizes: [usize; 3],
    /// Names of (h, δξ, δz, δu).
    pub names: Vec<String>,
}

/// An expression that has to be zero.
struct Fix {
    text: String,
    value: FunctionIndex,
    slopes: FunctionIndex,
    entries: Vec<String>,
}

/// A state with the velocities of the full frame.
#[derive(Clone, Debug)]
pub struct Point {
    pub state: State,
    pub full: Vec<f64>,
}

/// The conditions at a point, linearised along (h, δξ, δz, δu) = L y.
pub struct Local {
    /// Numbers of the rows: ξ̇ and ż, then their derivatives, then what is fixed.
    pub rows: Vec<usize>,
    pub residuals: Vec<f64>,
    /// ∂r/∂y by rows.
    pub jacobian: Vec<Vec<f64>>,
    /// Independent entries of (h, δξ, δz).
    pub kept: Vec<usize>,
    /// Those, and inputs, that are the unknowns y.
    pub columns: Vec<usize>,
    /// L, by rows.
    pub lift: Vec<Vec<f64>>,
    /// A(x), by rows, along the displacements.
    pub frame: Vec<Vec<f64>>,
    /// d/dt (η, δζ, δz) along the independent displacements, velocities and states.
    pub motion: Vec<Vec<f64>>,
    pub xi_dot: Vec<f64>,
}

impl<'a> Conditions<'a> {
    /// Sets up the conditions for a description to which the expressions of `options` have been added.
    pub fn new(
        generated: &'a Generated,
        options: &TrimOptions,
        params: &[f64],
    ) -> Result<Self, Error> {
        let (full, active, program) = (&generated.model, &generated.active, &generated.program);
        if let Some(clock) = full.clock.filter(|_| options.steady) {
            let time = full.coordinates.iter().find(|c| c.offset == clock.x);
            let time = time.map_or(String::new(), |time| time.name.clone());
            return Err(TrimProblem::TimeDependent(time).into());
        }
        let mut frame = names::velocities(full);
        if let Some(clock) = full.clock {
            frame.remove(clock.xi);
        }
        let velocities = names::velocities_and_states(active);
        let inputs: Vec<String> = active.inputs.iter().flat_map(names::group).collect();
        let sizes = [frame.len(), active.n(), velocities.len() - active.n()];
        let moving = &velocities[..active.n()];
        let mut is_free = vec![true; sizes.iter().sum()];
        is_free[sizes[0]..sizes[0] + sizes[1]].fill(options.steady);
        is_free.resize(is_free.len() + inputs.len(), false);
        let known = [moving, &inputs].concat();
        let groups = active.velocities.iter().map(|group| (group, sizes[0]));
        let groups = groups.chain(
            active
                .inputs
                .iter()
                .map(|group| (group, sizes.iter().sum())),
        );
        let groups: Vec<_> = groups.collect();
        let places_of = |name: &str| -> Option<Vec<usize>> {
            if let Some((group, first)) = groups.iter().find(|(group, _)| group.name == name) {
                return Some((first + group.offset..).take(group.len).collect());
            }
            let place = known.iter().position(|entry| entry == name)?;
            let behind = if place < moving.len() { 0 } else { sizes[2] };
            Some(vec![sizes[0] + behind + place])
        };
        for name in &options.free {
            let Some(places) = places_of(name) else {
                let groups = groups.iter().map(|(group, _)| group.name.as_str());
                return Err(TrimProblem::unknown("--free", name, groups, &known).into());
            };
            places.into_iter().for_each(|place| is_free[place] = true);
        }
        // An equation for an input or a velocity determines it.
        for text in &options.fix {
            let places = Piece { text, start: 0 }
                .sides()
                .first()
                .and_then(|side| places_of(side.text));
            places
                .into_iter()
                .flatten()
                .for_each(|place| is_free[place] = true);
        }
        let mut rates = vec![0.0; velocities.len()];
        for (name, value) in &options.rates {
            match velocities.iter().position(|entry| entry == name) {
                Some(place) => rates[place] = *value,
                None => {
                    let none = std::iter::empty();
                    return Err(TrimProblem::unknown("--rate", name, none, &velocities).into());
                }
            }
        }
        let added = (0..options.fix.len()).map(added_outputs::name);
        let added = added.flat_map(|name| [format!("{name}{SLOPES}"), name]);
        let all: Vec<String> = FUNCTIONS
            .iter()
            .map(ToString::to_string)
            .chain(added)
            .collect();
        let all: Vec<&str> = all.iter().map(String::as_str).collect();
        let compiled = compile_functions(program, &all)?;
        let find = |name: &str| {
            find_function(&compiled, name).ok_or_else(|| Error::MissingFunction {
                system: program.name.clone(),
                name: name.into(),
            })
        };
        let fixes = options.fix.iter().enumerate().map(|(item, text)| {
            let name = added_outputs::name(item);
            let shape = program.function(&name).map_or(Shape::Scalar, |f| f.shape);
            Ok(Fix {
                text: text.clone(),
                value: find(&name)?,
                slopes: find(&format!("{name}{SLOPES}"))?,
                entries: names::entries("", shape),
            })
        });
        let displaced = frame.iter().map(|name| format!("h({name})"));
        let is_driven = |row: &Pfaffian| matches!(row.kind, Kind::Drive { .. });
        let held = !is_free[sizes[0]..sizes[0] + sizes[1]].contains(&true);
        let driven = full.clock.is_some() || full.constraints.iter().any(is_driven);
        Ok(Conditions {
            generated,
            rests: held && !driven && options.rates.is_empty() && full.accelerated.is_empty(),
            steady: options.steady,
            functions: Functions::new(&compiled, params),
            linearize: find("linearize")?,
            frame: find("displacement_frame")?,
            accel: find("accel")?,
            fixes: fixes.collect::<Result<_, Error>>()?,
            rates,
            is_free,
            sizes,
            names: displaced.chain(velocities).chain(inputs).collect(),
        })
    }

    /// Returns the point at which a search from a state begins: velocities that are not free vanish.
    pub fn start(&self, state: &State) -> Option<Point> {
        let mut state = state.clone();
        for (i, speed) in state.xi[..self.sizes[1]].iter_mut().enumerate() {
            *speed = if self.is_free[self.sizes[0] + i] {
                *speed
            } else {
                0.0
            };
        }
        let still = vec![0.0; self.names.len()];
        let columns = self.independent(&state)?.kept;
        self.moved(
            &Point {
                full: Vec::new(),
                state,
            },
            &still,
            &columns,
        )
    }

    /// Moves a point along (h, δξ, δz, δu); the velocities in `kept` move as given, those that constraints determine
    /// follow. `None` if loops cannot be closed.
    pub fn moved(&self, from: &Point, step: &[f64], kept: &[usize]) -> Option<Point> {
        let Generated { model, active, .. } = self.generated;
        let [nh, na, nz] = self.sizes;
        let State { params, x, xi, u } = &from.state;
        let sum = |values: &[f64], step: &[f64]| -> Vec<f64> {
            values
                .iter()
                .zip(step)
                .map(|(value, step)| value + step)
                .collect()
        };
        let u = sum(u, &step[nh + na + nz..]);
        let mut x = sum(x, &apply(&self.frame(x)?, &step[..nh]));
        let xi = sum(xi, &step[nh..]);
        let closure = LoopClosure::of(model, params).with_inputs(&u);
        closure.lead_back(&mut x, &[]);
        let none = vec![false; x.len()];
        closure.close_loops(&mut x, &none).ok()?;
        let places = full_frame_indices(self.generated);
        let mut full = vec![0.0; model.n()];
        let mut given = vec![false; model.n()];
        for (i, &place) in places.iter().enumerate() {
            full[place] = xi[i];
            given[place] = kept.contains(&(nh + i));
        }
        if let Some(clock) = model.clock {
            full[clock.xi] = 1.0;
        }
        closure.settle(&x, &mut full, &given).ok()?;
        let settled = places.iter().map(|&place| full[place]);
        let xi = settled.take(active.n()).chain(xi[na..].iter().copied());
        let state = State {
            params: params.clone(),
            xi: xi.collect(),
            x,
            u,
        };
        Some(Point { state, full })
    }

    /// Evaluates a function for x, ξ, u and ξ̇; `None` if it has no value.
    fn call(&self, function: FunctionIndex, [x, xi, u, xi_dot]: [&[f64]; 4]) -> Option<Vec<f64>> {
        let value = self.functions.call(function, [x, xi, u, xi_dot, &[]]);
        Some(value.ok()?.to_vec())
    }

    /// A(x), by rows, along the displacements.
    fn frame(&self, x: &[f64]) -> Option<Vec<Vec<f64>>> {
        let flat = self.call(self.frame, [x, &[], &[], &[]])?;
        Some(rows(&flat, flat.len() / x.len().max(1)))
    }

    fn independent(&self, state: &State) -> Option<Tangent> {
        let frame = self.frame(&state.x)?;
        let all = self.sizes.iter().sum();
        let unit = |i: usize| (0..all).map(|j| f64::from(i == j)).collect();
        Some(
            tangent(self.generated, state, &frame).unwrap_or_else(|| Tangent {
                kept: (0..all).collect(),
                lift: (0..all).map(unit).collect(),
            }),
        )
    }

    /// Returns ξ̇ with ż, and [A B] by rows.
    fn motion(&self, state: &State) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
        let State { x, xi, u, .. } = state;
        let xi_dot = self.call(self.accel, [x, xi, u, &[]])?;
        let flat = self.call(self.linearize, [x, xi, u, &[]])?;
        let finite = xi_dot.iter().chain(&flat).all(|value| value.is_finite());
        finite.then(|| (xi_dot, rows(&flat, self.names.len())))
    }

    /// Returns d/dt (ξ̇, ż) = A (ξ, ξ̇, ż) with the velocities of the full frame.
    fn change(&self, point: &Point, xi_dot: &[f64], ab: &[Vec<f64>]) -> Vec<f64> {
        let clock = self.generated.model.clock.map(|clock| clock.xi);
        let full = point
            .full
            .iter()
            .enumerate()
            .filter(|(i, _)| Some(*i) != clock);
        let along: Vec<f64> = full
            .map(|(_, v)| *v)
            .chain(xi_dot.iter().copied())
            .collect();
        let rows = ab[self.sizes[0]..].iter();
        rows.map(|row| dot(&row[..along.len()], &along)).collect()
    }

    /// Evaluates the conditions and their slopes; `None` where something has no value.
    pub fn at(&self, point: &Point) -> Option<Local> {
        let state = &point.state;
        let [nh, na, nz] = self.sizes;
        let states = nh + na + nz;
        let (xi_dot, ab) = self.motion(state)?;
        let Tangent { kept, lift } = self.independent(state)?;
        let count = kept.len();
        // L of all independent entries and inputs.
        let mut columns = kept.clone();
        columns.extend(states..self.names.len());
        let mut lift: Vec<Vec<f64>> = lift;
        lift.iter_mut()
            .for_each(|row| row.resize(columns.len(), 0.0));
        for input in states..self.names.len() {
            lift.push(
                (0..columns.len())
                    .map(|k| f64::from(columns[k] == input))
                    .collect(),
            );
        }
        let motion = kept.iter().map(|&row| ab[row].clone()).collect::<Vec<_>>();
        let motion = product(&motion, &lift);
        let free: Vec<usize> = (0..columns.len())
            .filter(|&k| self.is_free[columns[k]])
            .collect();
        let of_free = |row: &[f64]| free.iter().map(|&k| row[k]).collect::<Vec<f64>>();
        let moving: Vec<usize> = kept.iter().filter(|&&k| k >= nh).map(|k| k - nh).collect();
        let mut rows_at: Vec<usize> = if self.rests {
            (0..na + nz).collect()
        } else {
            moving.clone()
        };
        let mut residuals: Vec<f64> = rows_at.iter().map(|&i| xi_dot[i] - self.rates[i]).collect();
        let rates: Vec<Vec<f64>> = rows_at.iter().map(|&i| ab[nh + i].clone()).collect();
        let rates = product(&rates, &lift);
        let mut jacobian: Vec<Vec<f64>> = rates.iter().map(|row| of_free(row)).collect();
        if self.steady {
            let change = self.change(point, &xi_dot, &ab);
            residuals.extend(moving.iter().map(|&i| change[i]));
            rows_at.extend(moving.iter().map(|i| na + nz + i));
            let mut slopes = vec![Vec::new(); moving.len()];
            let fastest = largest(&point.full).max(1.0);
            for &k in &free {
                let size = DIFFERENCE * self.size(state, columns[k]);
                let ends = [size, -size].map(|size| {
                    let step: Vec<f64> = lift.iter().map(|row| size * row[k]).collect();
                    let end = self.moved(point, &step, &kept)?;
                    let (xi_dot, ab) = self.motion(&end.state)?;
                    Some(self.change(&end, &xi_dot, &ab))
                });
                let [Some(after), Some(before)] = ends else {
                    return None;
                };
                for (row, &i) in slopes.iter_mut().zip(&moving) {
                    let difference = after[i] - before[i];
                    let noise = DIFFERENCE_NOISE
                        * ab[nh + i].iter().map(|a| a.abs()).sum::<f64>()
                        * fastest;
                    row.push(if difference.abs() > noise {
                        difference / (2.0 * size)
                    } else {
                        0.0
                    });
                }
            }
            jacobian.extend(slopes);
        }
        let mut number = 2 * (na + nz);
        for fix in &self.fixes {
            let State { x, xi, u, .. } = state;
            residuals.extend(self.call(fix.value, [x, xi, u, &xi_dot])?);
            let slopes = rows(&self.call(fix.slopes, [x, xi, u, &[]])?, self.names.len());
            jacobian.extend(product(&slopes, &lift).iter().map(|row| of_free(row)));
            rows_at.extend(number..number + fix.entries.len());
            number += fix.entries.len();
        }
        let all = residuals.iter().chain(jacobian.iter().flatten());
        if !all.into_iter().all(|value| value.is_finite()) {
            return None;
        }
        Some(Local {
            rows: rows_at,
            kept,
            residuals,
            jacobian,
            motion: motion.iter().map(|row| row[..count].to_vec()).collect(),
            columns: free.iter().map(|&k| columns[k]).collect(),
            lift: lift.iter().map(|row| of_free(row)).collect(),
            frame: self.frame(&state.x)?,
            xi_dot,
        })
    }

    /// Size of an entry of (h, δξ, δz, δu) that counts as large.
    pub fn size(&self, state: &State, place: usize) -> f64 {
        let [nh, na, nz] = self.sizes;
        let value = match place.checked_sub(nh) {
            None => 0.0,
            Some(i) if i < na + nz => state.xi[i],
            Some(i) => state.u[i - na - nz],
        };
        value.abs().max(1.0)
    }

    /// Names a condition by the number of its row.
    pub fn name(&self, row: usize) -> String {
        let [nh, na, nz] = self.sizes;
        let Some(mut entry) = row.checked_sub(2 * (na + nz)) else {
            let name = &self.names[nh + row % (na + nz)];
            return match row < na + nz {
                true => format!("the rate of {name}"),
                false => format!("the second derivative of {name}"),
            };
        };
        for fix in &self.fixes {
            match fix.entries.get(entry) {
                Some(place) if place.is_empty() => return format!("`{}`", fix.text),
                Some(place) => return format!("`{}`, entry {place}", fix.text),
                None => entry -= fix.entries.len(),
            }
        }
        String::new()
    }
}

fn rows(flat: &[f64], columns: usize) -> Vec<Vec<f64>> {
    flat.chunks(columns.max(1)).map(<[f64]>::to_vec).collect()
}
