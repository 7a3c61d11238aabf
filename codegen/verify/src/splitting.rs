//! Validation of the functions of a system that splits, at a point modulo p.
//!
//! For random p, with ξ(p), and ξ̇ solved from M ξ̇ = f − h − ∂V of the independent derivation:
//!
//! | function | has to be |
//! |---|---|
//! | `split_velocities` | a right inverse of `split_momenta`: p(ξ(p)) = p |
//! | `uncentre` | a left inverse of `centre` |
//! | `centre` | y with ẏ = p for plain coordinates, x itself for all others |
//! | `split_momenta` | θ̇ of circles, J ω of rotors |
//! | `kick` | d/dt p of plain coordinates and circles, d/dt P − P × ω of rotors |

use super::numbers::{FormEvaluator, PointValues};
use super::violation::Violation;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Edge;
use hamel_algebra::numeric::{evaluate_at, solve};
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::tangent::tangent_at;
use hamel_dynamics::kinematics::chart_rates;
use hamel_dynamics::structure::rates::{CoordinateBlock, coordinate_blocks};
use hamel_language::model::Model;
use hamel_program::structure::Structure;
use hamel_program::{FunctionId, Program};

/// Comparison of the emitted functions of a splitting (`kick`, `split_momenta`, `centre` …) with the model, at one
/// point modulo p after another.
pub struct SplittingComparison {
    parts: Vec<CoordinateBlock>,
    /// The model; its graph contains the rates of the coordinates.
    model: Model,
    /// Rates of the coordinates in their charts.
    rates: Vec<Edge>,
    /// Indices of the symbols of x, ξ, p.
    x: Vec<usize>,
    xi: Vec<usize>,
    p: Vec<usize>,
}

impl SplittingComparison {
    /// Prepares the comparison for a program; `None` if the program has no splitting.
    pub fn new(model: &Model, program: &Program) -> Option<Self> {
        program.function(FunctionId::Kick)?;
        let mut model = model.clone();
        let rates = chart_rates(&mut model.graph, &model.blocks, &model.x, &model.rate);
        Some(SplittingComparison {
            parts: coordinate_blocks(&model),
            rates,
            x: model.graph.symbol_places(&model.x),
            xi: model.graph.symbol_places(&model.xi),
            p: model.graph.symbol_places(&model.momenta),
            model,
        })
    }

    /// Compares the functions of the splitting with the reference at one point; `Err` names the first that disagrees,
    /// `None` if something has no value there.
    pub fn at_point(
        &self,
        numbers: &FormEvaluator,
        program: &Program,
        point: &FieldPoint,
    ) -> Option<Result<(), Violation>> {
        let wrong = |identity: &'static str| Some(Err(Violation::Identity(identity)));
        let at = |name: &str, point: &FieldPoint| {
            let function = program.function(name)?;
            evaluate_at(&program.graph, &function.outputs, &mut point.clone())
        };
        let x: Vec<ResiduePair> = self.x.iter().map(|&place| point.symbol(place)).collect();
        let p: Vec<ResiduePair> = self.p.iter().map(|&place| point.symbol(place)).collect();
        let xi = at("split_velocities", point)?;
        let mut moving = point.clone();
        set(&mut moving, &self.xi, &xi);
        if at("split_momenta", &moving)? != p {
            return wrong("p of ξ of p is p, for the emitted momenta");
        }
        if program.function(FunctionId::Centre).is_some() {
            let mut shifted = point.clone();
            set(&mut shifted, &self.x, &at("centre", point)?);
            if at("uncentre", &shifted)? != x {
                return wrong("x of y of x is x, for the emitted centre");
            }
        }
        let kick = at("kick", point)?;
        let spin = evaluate_at(&self.model.graph, &self.rates, &mut moving.clone())?;
        let (p_dot, y_dot) = self.slopes(numbers, program, &moving)?;
        let mut inertia = match program.function(FunctionId::RotorInertia) {
            Some(_) => at("rotor_inertia", point)?.into_iter(),
            None => Vec::new().into_iter(),
        };
        let Structure {
            split: Ok(splitting),
            ..
        } = &program.structure
        else {
            return wrong("a system that splits, for the emitted kick");
        };
        let mut rotors = splitting.rotors.iter();
        for part in &self.parts {
            let here = part.rates();
            let entries = part.first..part.first + part.block.len();
            if !part.is_rotor() {
                let plain = part.block.len() == part.block.dimension();
                let rate = if plain {
                    &y_dot[entries]
                } else {
                    &spin[here.clone()]
                };
                if rate != &p[here.clone()] || p_dot[here.clone()] != kick[here] {
                    return wrong("ẏ = p, ṗ = kick, for the emitted splitting");
                }
                continue;
            }
            let rotor = rotors.next()?;
            let (w, big_p) = (&spin[here.clone()], &p[here.clone()]);
            let j: Vec<ResiduePair> = inertia.by_ref().take(rotor.inertia.entries()).collect();
            let jw: Vec<ResiduePair> = match j.as_slice() {
                [a, b, c] => vec![*a * w[0], *b * w[1], *c * w[2]],
                j => j
                    .chunks(3)
                    .map(|row| row[0] * w[0] + row[1] * w[1] + row[2] * w[2])
                    .collect(),
            };
            if jw != big_p {
                return wrong("P = J ω, for the emitted rotors");
            }
            for i in 0..3 {
                let (a, b) = ((i + 1) % 3, (i + 2) % 3);
                let gyroscopic = big_p[a] * w[b] - big_p[b] * w[a];
                if p_dot[here.start + i] != gyroscopic + kick[here.start + i] {
                    return wrong("Ṗ = P × ω + kick, for the emitted splitting");
                }
            }
        }
        Some(Ok(()))
    }

    /// Returns d/dt of the momenta and of y along the motion.
    fn slopes(
        &self,
        numbers: &FormEvaluator,
        program: &Program,
        moving: &FieldPoint,
    ) -> Option<(Vec<ResiduePair>, Vec<ResiduePair>)> {
        let model = &self.model;
        let PointValues {
            mass,
            force,
            bias,
            slope,
            rate,
            ..
        } = numbers.at(moving)?.ok()?;
        let right = (0..model.n()).map(|i| force[i] - bias[i] - slope[i]);
        let xi_dot = solve(mass, right.collect())?;
        let mut direction = vec![ResiduePair::ZERO; model.graph.symbols().len()];
        let moves = self.x.iter().zip(&rate).chain(self.xi.iter().zip(&xi_dot));
        for (&place, &by) in moves {
            *direction.get_mut(place)? = by;
        }
        let slopes = |edges: &[Edge]| -> Option<Vec<ResiduePair>> {
            let duals = tangent_at(&program.graph, edges, &mut moving.clone(), &direction)?;
            Some(duals.into_iter().map(|dual| dual.1).collect())
        };
        let y = program
            .function(FunctionId::Centre)
            .map_or(&model.x, |f| &f.outputs);
        let momenta = program.function(FunctionId::SplitMomenta)?;
        Some((slopes(&momenta.outputs)?, slopes(y)?))
    }
}

fn set(point: &mut FieldPoint, places: &[usize], values: &[ResiduePair]) {
    for (&place, &value) in places.iter().zip(values) {
        point.set_symbol(place, value);
    }
}
