//! Search for a function f whose rate is a given velocity coordinate: ∂ᵢf = δᵢᵏ for all i, so that ξᵏ = df/dt.
//!
//! Such an f exists locally if γᵢⱼᵏ = 0 for all i, j (KR18 section 2.5). It is sought among the combinations Σ c_a
//! f_a with rational c_a of coordinates, angles of circles, named expressions of the user, monomials of degree two
//! and three, sines, cosines, logarithms and angles atan2 of pairs; and of all these multiplied or divided by a
//! scalar parameter. The c_a are determined at random points of X modulo p; the result is confirmed symbolically in
//! the graph, where expressions that are equal on X are one node.

use crate::tables::EquationTables;
use hamel_algebra::echelon::solution;
use hamel_algebra::graph::{Edge, Function, Graph, Node};
use hamel_algebra::linear::matrix;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_language::model::layout::{Block, entry_names};
use hamel_language::model::value::Value;
use hamel_language::model::{Model, class};
use hamel_language::syntax::ast::CoordKind;

/// Largest number of plain coordinates for which monomials and functions of them are tried.
const MAX_PLAIN_COORDINATES: usize = 6;
/// Largest number of candidates.
const MAX_CANDIDATES: usize = 150;
/// Largest number of bits of the numerators and denominators of coefficients.
const MAX_COEFFICIENT_BITS: u32 = 16;

/// A candidate f_a, as text and as an expression.
#[derive(Clone, Debug)]
struct Candidate {
    text: String,
    value: Edge,
}

/// Returns, for every ξᵏ of `wanted`, a function whose rate it is, as text, or `None` if none was found.
pub fn find_potentials(geometry: &mut EquationTables, wanted: &[usize]) -> Vec<Option<String>> {
    if wanted.is_empty() {
        return Vec::new();
    }
    let candidates = candidates(&mut geometry.model);
    let n = geometry.model.n();
    // slopes[a][i] = ∂ᵢf_a; functions whose derivatives all vanish are left out.
    let zero = geometry.model.graph.zero();
    let (mut kept, mut slopes) = (Vec::new(), Vec::new());
    for candidate in candidates {
        let graph = &mut geometry.model.graph;
        let row: Vec<Edge> = (0..n)
            .map(|i| geometry.calculus.along(graph, i, candidate.value))
            .collect();
        if row.iter().any(|&slope| slope.abs() != zero) && kept.len() < MAX_CANDIDATES {
            kept.push(candidate);
            slopes.push(row);
        }
    }
    let samples = samples(&geometry.model, &slopes, n);
    wanted
        .iter()
        .map(|&k| {
            let rows = samples.iter().flat_map(|sample| {
                (0..n).map(move |i| {
                    let mut row: Vec<ResiduePair> = sample.iter().map(|slope| slope[i]).collect();
                    row.push(if i == k {
                        ResiduePair::ONE
                    } else {
                        ResiduePair::ZERO
                    });
                    row
                })
            });
            let found = solution(rows.collect())?;
            let terms: Vec<(usize, (i64, i64))> = found
                .iter()
                .enumerate()
                .filter(|(_, c)| !c.is_zero())
                .map(|(a, c)| Some((a, c.to_small_rational(MAX_COEFFICIENT_BITS)?)))
                .collect::<Option<_>>()?;
            is_confirmed(&mut geometry.model.graph, &slopes, &terms, k).then(|| sum(&kept, &terms))
        })
        .collect()
}

/// Evaluates all slopes at sufficiently many random points of X: `[point][a][i]`.
fn samples(model: &Model, slopes: &[Vec<Edge>], n: usize) -> Vec<Vec<Vec<ResiduePair>>> {
    let points = slopes.len() / n.max(1) + 4;
    let roots = slopes.concat();
    let mut samples = Vec::new();
    for seed in 0..4 * points as u64 + 40 {
        if samples.len() == points {
            break;
        }
        let Some(mut lane) = model.points.lane(0x907e + seed) else {
            continue;
        };
        if let Some(values) = evaluate_at(&model.graph, &roots, &mut lane) {
            samples.push(matrix(&values, n));
        }
    }
    samples
}

/// Returns whether Σ c_a ∂ᵢf_a = δᵢᵏ on X.
fn is_confirmed(
    graph: &mut Graph,
    slopes: &[Vec<Edge>],
    terms: &[(usize, (i64, i64))],
    k: usize,
) -> bool {
    let n = slopes.first().map_or(0, Vec::len);
    (0..n).all(|i| {
        let mut sum = graph.zero();
        for &(a, (numerator, denominator)) in terms {
            let factor = graph.ratio(numerator, denominator);
            let product = graph.mul(factor, slopes[a][i]);
            sum = graph.add(sum, product);
        }
        sum == if i == k { graph.one() } else { graph.zero() }
    })
}

fn sum(candidates: &[Candidate], terms: &[(usize, (i64, i64))]) -> String {
    let mut text = String::new();
    for (place, &(a, (numerator, denominator))) in terms.iter().enumerate() {
        text.push_str(match (place, numerator < 0) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        });
        if numerator.abs() != 1 {
            text.push_str(&format!("{} * ", numerator.abs()));
        }
        text.push_str(&candidates[a].text);
        if denominator != 1 {
            text.push_str(&format!(" / {denominator}"));
        }
    }
    text
}

/// Returns the functions to try, the simplest first.
fn candidates(model: &mut Model) -> Vec<Candidate> {
    let (mut first, plain) = coordinates(model);
    let moving = |edge: Edge, graph: &Graph| {
        let class = graph.class(edge.node());
        class & class::CONFIGURATION != 0 && class & !(class::CONFIGURATION | class::PARAM) == 0
    };
    for (name, value) in &model.lets {
        let entries = value.entries();
        for (i, &edge) in entries.iter().enumerate() {
            if moving(edge, &model.graph) {
                let text = match value {
                    Value::Scalar(_) => name.clone(),
                    Value::Matrix(rows) => {
                        let width = rows.first().map_or(1, Vec::len).max(1);
                        format!("{name}[{}, {}]", i / width + 1, i % width + 1)
                    }
                    Value::Vector(_) => format!("{name}[{}]", i + 1),
                    Value::Pose(..) => continue,
                };
                first.push(Candidate { text, value: edge });
            }
        }
    }
    if plain.len() <= MAX_PLAIN_COORDINATES {
        first.extend(functions(&mut model.graph, &plain));
    }
    let graph = &mut model.graph;
    let scalars: Vec<(String, Edge)> = graph
        .symbols()
        .iter()
        .filter(|symbol| symbol.class == class::PARAM)
        .map(|symbol| (symbol.name.clone(), Edge::of(symbol.node)))
        .collect();
    let rate = model.a.concat();
    let used = graph.reachable(&rate);
    let mut scaled = Vec::new();
    for (name, parameter) in scalars {
        if used.binary_search(&parameter.node()).is_err() {
            continue;
        }
        for Candidate { text, value } in &first {
            scaled.push(Candidate {
                text: format!("{name} * {text}"),
                value: graph.mul(parameter, *value),
            });
            if let Some(value) = graph.div(*value, parameter) {
                let text = format!("{text} / {name}");
                scaled.push(Candidate { text, value });
            }
        }
    }
    first.extend(scaled);
    first
}

/// Returns the coordinates and the angles of circles; separately, the plain coordinates among them.
fn coordinates(model: &mut Model) -> (Vec<Candidate>, Vec<Candidate>) {
    let (mut simple, mut entries, mut plain) = (Vec::new(), Vec::new(), Vec::new());
    for coordinate in &model.coordinates {
        let names = entry_names(&coordinate.name, coordinate.kind);
        let symbols = model.x.iter().skip(coordinate.offset).copied();
        let mut named: Vec<Candidate> = names
            .into_iter()
            .zip(symbols)
            .map(|(text, value)| Candidate { text, value })
            .collect();
        match (coordinate.kind, named.as_slice()) {
            (CoordKind::Real | CoordKind::Euclidean(_), _) => {
                plain.extend(named.iter().cloned());
                simple.append(&mut named);
            }
            (CoordKind::SE3, _) => {
                let rest = named.split_off(Block::Flat(3).len().min(named.len()));
                simple.append(&mut named);
                entries.extend(rest);
            }
            (CoordKind::S1, [cos, sin]) => {
                let value = model.graph.atan2(sin.value, cos.value);
                let text = format!("angle({})", coordinate.name);
                simple.push(Candidate { text, value });
                entries.append(&mut named);
            }
            _ => entries.append(&mut named),
        }
    }
    simple.extend(entries);
    (simple, plain)
}

/// Returns monomials of degree two and three, sines, cosines, logarithms, and angles of pairs.
fn functions(graph: &mut Graph, plain: &[Candidate]) -> Vec<Candidate> {
    let mut found = Vec::new();
    let power = |a: &str, b: &str| match a == b {
        true => format!("{a}^2"),
        false => format!("{a} * {b}"),
    };
    for (i, a) in plain.iter().enumerate() {
        for b in &plain[i..] {
            let text = power(&a.text, &b.text);
            let value = graph.mul(a.value, b.value);
            found.push(Candidate { text, value });
        }
    }
    for (i, a) in plain.iter().enumerate() {
        for b in &plain[i + 1..] {
            let text = format!("atan2({}, {})", b.text, a.text);
            let value = graph.atan2(b.value, a.value);
            found.push(Candidate { text, value });
        }
    }
    let mut cubes = Vec::new();
    for (i, a) in plain.iter().enumerate() {
        for square in &found {
            let factors = match graph.node(square.value.node()) {
                Node::Mul(x, y) => [x, y],
                _ => continue,
            };
            // Each product once: the third factor must not come after the other two in order.
            let place = |edge: Edge| plain.iter().position(|p| p.value == edge);
            if factors.iter().any(|&f| place(f).is_none_or(|p| p < i)) {
                continue;
            }
            let value = graph.mul(a.value, square.value);
            let text = format!("{} * {}", a.text, square.text);
            cubes.push(Candidate { text, value });
        }
    }
    for a in plain {
        for (name, function) in [
            ("sin", Function::Sin),
            ("cos", Function::Cos),
            ("log", Function::Log),
        ] {
            let value = graph.apply(function, a.value);
            let text = format!("{name}({})", a.text);
            found.push(Candidate { text, value });
        }
    }
    found.extend(cubes);
    found
}

/// Returns whether ξᵏ is integrable: γᵢⱼᵏ = 0 for all i, j (KR18 section 2.5).
pub fn is_integrable(geometry: &EquationTables, k: usize) -> bool {
    // Compare nodes, because a zero of either sign is zero.
    let zero = geometry.model.graph.zero().node();
    let mut rows = geometry.gamma.iter().flatten();
    rows.all(|row| row[k].node() == zero)
}
