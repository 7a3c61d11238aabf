//! Validation of the linearisation [A B], and of invariants, at a point modulo p.
//!
//! Derivatives are taken by dual numbers, and M ξ̇ = F is solved in numbers: none of the generator's derivatives is
//! used. If M, inverse dynamics and f are emitted, they have already been compared with the independent derivation, and
//! functions that are equal on X have equal derivatives along X; so the emitted functions are differentiated. Otherwise
//! M, h, ∂V and f are derived once more.

use super::hamel_form;
use super::kernel::dot;
use super::reference::ReferenceQuantities;
use super::violation::Violation;
use super::{centroidal, derivatives, frames, outputs, states};
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Edge;
use hamel_algebra::linear::matrix;
use hamel_algebra::numeric::{evaluate_at, solve};
use hamel_algebra::residue_pair::{Random, ResiduePair};
use hamel_algebra::tangent::tangent_at;
use hamel_dynamics::calculus::Calculus;
use hamel_dynamics::{energy, quantity};
use hamel_language::model::Model;
use hamel_program::{FunctionId, Program};

/// Returns whether ξ̇ as an intermediate result of [A B] is that of `accel`.
fn rates_at(program: &Program, point: &FieldPoint) -> Option<bool> {
    let linearize = program.function(FunctionId::Linearize);
    let Some(linearize) = linearize.filter(|function| !function.rates.is_empty()) else {
        return Some(true);
    };
    let accel = program.function(FunctionId::Accel)?;
    let value = |edges: &[Edge]| evaluate_at(&program.graph, edges, &mut point.clone());
    Some(value(&linearize.rates)? == value(&accel.outputs)?)
}

/// Comparison of the emitted linearisation `[A B]` and invariants with values and dual numbers modulo p, at one point
/// after another.
pub struct DerivativeComparison {
    /// Names of the invariants with their entries in the graph of `model`.
    invariants: Vec<(String, Vec<Edge>)>,
    model: Model,
    /// Functions to differentiate, if the linearisation is wanted.
    source: Option<DifferentiatedFunctions>,
}

/// Functions that are differentiated.
enum DifferentiatedFunctions {
    /// The functions of the program.
    Emitted,
    /// An independent derivation.
    Derived(Box<ReferenceQuantities>),
}

/// Emitted functions that together determine the derivatives of ξ̇.
const EMITTED: [&str; 4] = [
    "accel",
    "mass_matrix",
    "inverse_dynamics",
    "generalized_force",
];

/// M, F = f − h − ∂V, A and A ξ at one point, or their derivatives.
struct SlopeValues {
    mass: Vec<Vec<ResiduePair>>,
    force: Vec<ResiduePair>,
    a: Vec<Vec<ResiduePair>>,
    rate: Vec<ResiduePair>,
}

impl SlopeValues {
    fn roots(reference: &ReferenceQuantities) -> Vec<Edge> {
        let mut roots = reference.mass.concat();
        for part in [&reference.force, &reference.bias, &reference.slope] {
            roots.extend(part);
        }
        roots.extend(reference.model.a.concat());
        roots.extend(&reference.model.rate);
        roots
    }

    fn new(reference: &ReferenceQuantities, values: &[ResiduePair]) -> Self {
        let (n, nu) = (reference.model.n(), reference.model.nu());
        let (mass, rest) = values.split_at(n * n);
        let (forces, rest) = rest.split_at(3 * n);
        let (a, rate) = rest.split_at(nu * n);
        let rows = |flat: &[ResiduePair]| matrix(flat, n);
        SlopeValues {
            mass: rows(mass),
            force: (0..n)
                .map(|i| forces[i] - forces[n + i] - forces[2 * n + i])
                .collect(),
            a: rows(a),
            rate: rate.to_vec(),
        }
    }
}

impl DerivativeComparison {
    /// Prepares the comparison for a program; `None` if AᵀA is singular.
    pub fn new(model: &Model, program: &Program) -> Option<Self> {
        let claims: Vec<_> = model
            .invariants
            .iter()
            .filter(|claim| program.function(&claim.name).is_some())
            .collect();
        let linear = program.function(FunctionId::Linearize).is_some();
        let mut own = model.clone();
        let mut invariants = Vec::new();
        if !claims.is_empty() {
            let mut calculus = Calculus::new(&own);
            let kinetic = hamel_form::kinetic_energy(&mut own, &mut calculus);
            let energies = (kinetic, energy::potential(&mut own));
            for claim in claims {
                let value =
                    quantity::quantity_value(&mut own, &mut calculus, energies, &claim.quantity);
                invariants.push((claim.name.clone(), value.entries()));
            }
        }
        let emitted = EMITTED.iter().all(|name| program.function(name).is_some());
        let source = match linear {
            false => None,
            true if emitted => Some(DifferentiatedFunctions::Emitted),
            true => Some(DifferentiatedFunctions::Derived(Box::new(
                ReferenceQuantities::new(model)?,
            ))),
        };
        Some(DerivativeComparison {
            invariants,
            model: own,
            source,
        })
    }

    /// Compares the emitted invariants and `[A B]` with the reference at one point; `Err` names the first that
    /// disagrees, `None` if something has no value there.
    pub fn at_point(&self, program: &Program, point: &FieldPoint) -> Option<Result<(), Violation>> {
        let value = |name: &str| {
            let function = program.function(name)?;
            evaluate_at(&program.graph, &function.outputs, &mut point.clone())
        };
        for (name, entries) in &self.invariants {
            if value(name)? != evaluate_at(&self.model.graph, entries, &mut point.clone())? {
                return Some(Err(Violation::Identity("an invariant")));
            }
        }
        if !measured_at(&self.model, program, [point, point])? {
            return Some(Err(Violation::Identity(MEASURE)));
        }
        if !derivatives::hold(&self.model, program, [point, point])? {
            return Some(Err(Violation::Identity(derivatives::SUBJECT)));
        }
        if !frames::hold(&self.model, program, point)? {
            return Some(Err(Violation::Identity(frames::SUBJECT)));
        }
        if !centroidal::holds(&self.model, program, point)? {
            return Some(Err(Violation::Identity(centroidal::SUBJECT)));
        }
        if !rates_at(program, point)? {
            return Some(Err(Violation::Identity("ξ̇ beside its slopes")));
        }
        match &self.source {
            None => Some(Ok(())),
            Some(DifferentiatedFunctions::Emitted) => self.emitted_at(program, point),
            Some(DifferentiatedFunctions::Derived(reference)) => {
                derived_at(reference, program, point)
            }
        }
    }

    /// Compares [A B] with the derivatives of the emitted M, inverse dynamics and f.
    fn emitted_at(&self, program: &Program, point: &FieldPoint) -> Option<Result<(), Violation>> {
        let (model, graph) = (&self.model, &program.graph);
        let (n, nu) = (model.n(), model.nu());
        let outputs = |name: &str| Some(program.function(name)?.outputs.as_slice());
        let value = |name: &str| evaluate_at(graph, outputs(name)?, &mut point.clone());
        let mut xi_dot = value("accel")?;
        xi_dot.truncate(n);
        let mass = value("mass_matrix")?;
        let mass: Vec<Vec<ResiduePair>> = matrix(&mass, n);
        let roots: Vec<Edge> = model
            .a
            .concat()
            .into_iter()
            .chain(model.rate.clone())
            .collect();
        let here = evaluate_at(&model.graph, &roots, &mut point.clone())?;
        let displaced = Displaced::new(model, &here[nu * n..]);
        let moved = displaced.direction(model, &here[..nu * n]);
        let kinematics = |moved: &[ResiduePair]| -> Option<Vec<ResiduePair>> {
            let duals = tangent_at(&model.graph, &roots, &mut point.clone(), moved)?;
            Some(duals.into_iter().map(|dual| dual.1).collect())
        };
        let changed = kinematics(&moved)?;
        let moving = kinematics(&displaced.moving)?;
        let linear = value("linearize")?;
        let found = displaced.emitted_rates(&linear);
        let matrix = |flat: &[ResiduePair]| -> Vec<Vec<ResiduePair>> { matrix(flat, n) };
        let left = difference(
            &changed[nu * n..],
            &product(&matrix(&moving[..nu * n]), &displaced.columns[..n]),
        );
        if product(&matrix(&here[..nu * n]), &found[..n]) != left {
            return Some(Err(Violation::Identity(KINEMATIC)));
        }
        // M δξ̇ = δ(f − F(x, ξ, ξ̇)) with ξ̇ held constant.
        let mut held = point.clone();
        for (place, &value) in model
            .graph
            .symbol_places(&model.xi_dot)
            .into_iter()
            .zip(&xi_dot)
        {
            held.set_symbol(place, value);
        }
        let slopes = |name: &str| -> Option<Vec<ResiduePair>> {
            let duals = tangent_at(graph, outputs(name)?, &mut held.clone(), &moved)?;
            Some(duals.into_iter().map(|dual| dual.1).collect())
        };
        let right = difference(&slopes("generalized_force")?, &slopes("inverse_dynamics")?);
        let (changed, state_rates) = found[n..].split_at(n);
        if product(&mass, changed) != right {
            return Some(Err(Violation::Identity(DYNAMIC)));
        }
        if states::slopes(model, (&xi_dot, changed), point, &moved)? != state_rates {
            return Some(Err(Violation::Identity(states::SUBJECT)));
        }
        let along = (&moved[..], &displaced.columns[..]);
        if !outputs::slopes_hold(model, program, (&xi_dot, changed), point, along)? {
            return Some(Err(Violation::Identity(outputs::SUBJECT)));
        }
        Some(Ok(()))
    }
}

/// Returns whether the emitted frame of displacements is A without the column of time, and the emitted coframe a Y with
/// Y A = I.
///
/// A of the full model is evaluated at `point`, the emitted functions at the point `inner` of the program.
pub(super) fn measured_at(
    full: &Model,
    program: &Program,
    [point, inner]: [&FieldPoint; 2],
) -> Option<bool> {
    let emitted = |id: FunctionId| match program.function(id) {
        Some(function) => {
            evaluate_at(&program.graph, &function.outputs, &mut inner.clone()).map(Some)
        }
        None => Some(None),
    };
    let frame = emitted(FunctionId::DisplacementFrame)?;
    let coframe = emitted(FunctionId::DisplacementCoframe)?;
    let (Some(frame), Some(coframe)) = (frame, coframe) else {
        return Some(true);
    };
    let a = evaluate_at(&full.graph, &full.a.concat(), &mut point.clone())?;
    let time = full.clock.map(|clock| clock.xi);
    let moved = (0..a.len()).filter(|place| Some(place % full.n()) != time);
    let moved: Vec<ResiduePair> = moved.map(|place| a[place]).collect();
    let (n, nu) = (moved.len() / full.nu(), full.nu());
    // The column of time comes last; Y maps it to 0, as the passing of time alone is no displacement.
    let columns = (0..full.n()).filter(|&j| Some(j) != time).chain(time);
    let identity = columns.enumerate().all(|(j, column)| {
        (0..n).all(|i| {
            let sum = (0..nu).fold(ResiduePair::ZERO, |sum, k| {
                sum + coframe[i * nu + k] * a[k * full.n() + column]
            });
            sum == if i == j {
                ResiduePair::ONE
            } else {
                ResiduePair::ZERO
            }
        })
    });
    Some(frame == moved && identity)
}

/// Names in messages of the parts of the linearisation.
const MEASURE: &str = "Y A = I for the emitted frame of displacements";
const KINEMATIC: &str = "ḣ of the linearisation";
const DYNAMIC: &str = "δξ̇ of the linearisation";

/// Random (h, δξ, δz, δu), which test all columns of [A B] at once: a wrong entry goes unnoticed with probability 1/p.
struct Displaced {
    columns: Vec<ResiduePair>,
    /// ẋ as a direction in the symbols.
    moving: Vec<ResiduePair>,
    x: Vec<usize>,
    others: Vec<usize>,
}

impl Displaced {
    fn new(model: &Model, rate: &[ResiduePair]) -> Self {
        let x = model.graph.symbol_places(&model.x);
        let (u, z) = model.u.split_at(model.m());
        let others = [&model.xi, z, u]
            .map(|edges| model.graph.symbol_places(edges))
            .concat();
        let columns = model.n() + others.len();
        let mut random = Random::new(rate.iter().fold(columns as u64, |seed, rate| {
            seed.rotate_left(7) ^ rate.bits()
        }));
        let mut moving = vec![ResiduePair::ZERO; model.graph.symbols().len()];
        for (&place, &rate) in x.iter().zip(rate) {
            moving[place] = rate;
        }
        Displaced {
            columns: (0..columns).map(|_| random.element()).collect(),
            moving,
            x,
            others,
        }
    }

    /// Returns (A h, δξ, δz, δu) as a direction in the symbols.
    fn direction(&self, model: &Model, a: &[ResiduePair]) -> Vec<ResiduePair> {
        let n = model.n();
        let (h, rest) = self.columns.split_at(n);
        let a: Vec<Vec<ResiduePair>> = matrix(a, n);
        let mut moved = vec![ResiduePair::ZERO; model.graph.symbols().len()];
        for (&place, value) in self.x.iter().zip(product(&a, h)) {
            moved[place] = value;
        }
        for (&place, &value) in self.others.iter().zip(rest) {
            moved[place] = value;
        }
        moved
    }

    /// Returns (ḣ, δξ̇, δż) by the emitted matrices.
    fn emitted_rates(&self, linear: &[ResiduePair]) -> Vec<ResiduePair> {
        product(&matrix(linear, self.columns.len()), &self.columns)
    }
}

/// Compares [A B] with the derivatives of an independent derivation.
fn derived_at(
    reference: &ReferenceQuantities,
    program: &Program,
    point: &FieldPoint,
) -> Option<Result<(), Violation>> {
    let (model, graph) = (&reference.model, &reference.model.graph);
    let n = model.n();
    let roots = SlopeValues::roots(reference);
    let here = SlopeValues::new(reference, &evaluate_at(graph, &roots, &mut point.clone())?);
    // Derivatives of everything along a direction in the symbols.
    let slope = |direction: &[ResiduePair]| -> Option<SlopeValues> {
        let duals = tangent_at(graph, &roots, &mut point.clone(), direction)?;
        let slopes: Vec<ResiduePair> = duals.into_iter().map(|dual| dual.1).collect();
        Some(SlopeValues::new(reference, &slopes))
    };
    let xi_dot = solve(here.mass.clone(), here.force.clone())?;
    let displaced = Displaced::new(model, &here.rate);
    let moving = slope(&displaced.moving)?;
    let changed = slope(&displaced.direction(model, &here.a.concat()))?;
    let linear = &program.function(FunctionId::Linearize)?.outputs;
    let found = displaced.emitted_rates(&evaluate_at(&program.graph, linear, &mut point.clone())?);
    // A ḣ = D(A ξ)[A h, δξ] − Ȧ h.
    let left = difference(&changed.rate, &product(&moving.a, &displaced.columns[..n]));
    if product(&here.a, &found[..n]) != left {
        return Some(Err(Violation::Identity(KINEMATIC)));
    }
    // M δξ̇ = δF − δM ξ̇.
    let right = difference(&changed.force, &product(&changed.mass, &xi_dot));
    let (changed_rates, state_rates) = found[n..].split_at(n);
    if product(&here.mass, changed_rates) != right {
        return Some(Err(Violation::Identity(DYNAMIC)));
    }
    let moved = displaced.direction(model, &here.a.concat());
    if states::slopes(model, (&xi_dot, changed_rates), point, &moved)? != state_rates {
        return Some(Err(Violation::Identity(states::SUBJECT)));
    }
    let along = (&moved[..], &displaced.columns[..]);
    if !outputs::slopes_hold(model, program, (&xi_dot, changed_rates), point, along)? {
        return Some(Err(Violation::Identity(outputs::SUBJECT)));
    }
    Some(Ok(()))
}

fn difference(a: &[ResiduePair], b: &[ResiduePair]) -> Vec<ResiduePair> {
    a.iter().zip(b).map(|(&a, &b)| a - b).collect()
}

fn product(rows: &[Vec<ResiduePair>], vector: &[ResiduePair]) -> Vec<ResiduePair> {
    rows.iter().map(|row| dot(row, vector)).collect()
}
