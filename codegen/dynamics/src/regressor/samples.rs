//! Columns of Y at random states modulo p. Everything that is constant at run time has the same value at all
//! states: symbols of parameters have one random value each, and functions of constants have those of one lane.

use hamel_algebra::echelon::Echelon;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::{Random, ResiduePair};
use hamel_algebra::tape::Tape;
use hamel_language::model::{Model, class};

/// Number of random choices of the constants that are tried until all expressions have a value.
const MAX_CONSTANT_CHOICES: u64 = 12;
/// Number of states that are tried for the first one at which all columns have values.
const MAX_STATES_TRIED: u64 = 40;
/// Number of states beyond those needed for the rank.
const SPARE_STATES: usize = 10;
/// Smallest number of states; a single joint must be able to distinguish the parameters of two links.
const MIN_STATES: usize = 40;

/// Values of the regressor Y at random states, modulo p, with the rows of all states.
pub struct RegressorSamples {
    /// Rows, with an entry for every column of Y.
    pub rows: Vec<Vec<ResiduePair>>,
    /// A sampled state, with the same values of everything that is constant at run time.
    lane: FieldPoint,
}

impl RegressorSamples {
    /// Evaluates columns of expressions at random states; `None` if too few states have values.
    pub fn new(model: &Model, columns: &[Vec<Edge>]) -> Option<Self> {
        let tape = Tape::new(&model.graph, &columns.concat())?;
        (1..=MAX_CONSTANT_CHOICES)
            .find_map(|seed| RegressorSamples::at(model, &tape, columns.len(), seed))
    }

    fn at(model: &Model, tape: &Tape, columns: usize, seed: u64) -> Option<Self> {
        let n = model.n().max(1);
        let wanted = MIN_STATES.max(2 * columns / n + SPARE_STATES);
        let mut rows = Vec::new();
        let mut last = None;
        let mut tried = 0;
        while rows.len() < wanted * n {
            tried += 1;
            if tried > MAX_STATES_TRIED + 2 * wanted as u64 {
                return None;
            }
            let lane = random_state(model, seed, tried)?;
            let Some(values) = tape.values(&lane) else {
                if rows.is_empty() && tried > MAX_STATES_TRIED {
                    return None;
                }
                continue;
            };
            // Values are ordered by columns, n for each.
            rows.extend((0..n).map(|i| (0..columns).map(|k| values[k * n + i]).collect()));
            last = Some(lane);
        }
        Some(RegressorSamples { rows, lane: last? })
    }

    /// Returns the values of expressions that are constant at run time; `None` if one has no value.
    pub fn constant_values(&self, graph: &Graph, edges: &[Edge]) -> Option<Vec<ResiduePair>> {
        evaluate_at(graph, edges, &mut self.lane.clone())
    }

    /// Returns the columns of these parameters alone, without rows of zeros.
    pub fn columns_of(&self, columns: &[usize]) -> Vec<Vec<ResiduePair>> {
        let rows = self.rows.iter();
        let rows = rows.map(|row| {
            columns
                .iter()
                .map(|&k| row[k])
                .collect::<Vec<ResiduePair>>()
        });
        rows.filter(|row| row.iter().any(|entry| !entry.is_zero()))
            .collect()
    }

    /// Returns a basis of the relations Σ v_k Y_k = 0 between these columns, in which the last columns lead.
    pub fn relations(&self, columns: &[usize]) -> Vec<Vec<ResiduePair>> {
        Echelon::new(self.columns_of(columns)).null_space(columns.len())
    }

    /// Returns whether Σ v_k Y_k = 0 at all states.
    pub fn is_zero_sum(&self, terms: &[(usize, ResiduePair)]) -> bool {
        self.rows.iter().all(|row| {
            let sum = terms
                .iter()
                .fold(ResiduePair::ZERO, |sum, &(k, v)| sum + v * row[k]);
            sum.is_zero()
        })
    }
}

/// Returns a random state with the constants of a seed.
fn random_state(model: &Model, seed: u64, state: u64) -> Option<FieldPoint> {
    let random = &mut Random::new(seed.wrapping_mul(0x6a09_e667) ^ (state << 32));
    let mut values = model.points.choose(random)?;
    let frozen = &mut Random::new(seed ^ 0x3c6e_f372);
    for (value, symbol) in values.iter_mut().zip(model.graph.symbols()) {
        if symbol.class == class::PARAM && *value != ResiduePair::PI {
            *value = frozen.element();
        }
    }
    let mut lane = FieldPoint::new();
    lane.roots = model.points.roots;
    values.into_iter().for_each(|value| lane.push_symbol(value));
    Some(lane)
}
