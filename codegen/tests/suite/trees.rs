//! Random trees of bodies: generated functions are compared with the recursive Newton-Euler algorithm, and with the
//! tables of M and Γ, KR18 (20) and (23).

use crate::common::{Random, difference, generated, size, value};
use crate::tree::{ALL, Kind, Link, Tree, humanoid, text};
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::derive::tables::EquationTables;
use hamel_codegen::generate::Generated;
use hamel_codegen::proof::levi_civita::{contract_connection, explicit_form};

/// Rounding of a few thousand operations, with forces of order 100.
const TOLERANCE: f64 = 1e-10;
/// Rounding where accelerations of light links at the end of a long chain are large.
const LONG_CHAIN_TOLERANCE: f64 = 1e-8;
/// Number of states per tree.
const STATES_PER_TREE: usize = 3;

const SIMPLE_TREES: [Kind; 4] = [
    Kind::Revolute,
    Kind::Revolute,
    Kind::Continuous,
    Kind::Prismatic,
];
const FUNCTIONS: &str =
    "accel, inverse_dynamics, mass_matrix, bias, potential_force, energy, momentum";

/// A state with an input and accelerations.
struct State {
    x: Vec<f64>,
    xi: Vec<f64>,
    u: Vec<f64>,
    dot: Vec<f64>,
}

impl State {
    fn random(random: &mut Random, of: &Generated) -> Self {
        let program = &of.program;
        State {
            x: random.configuration(&program.blocks),
            xi: random.numbers(program.n),
            u: random.numbers(program.m),
            dot: random.numbers(program.n),
        }
    }

    fn value(&self, of: &Generated, name: &str) -> Vec<f64> {
        value(of, name, [&self.x, &self.xi, &self.u, &self.dot])
    }
}

fn plus(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

fn minus(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// Returns a random tree with this number of links and at least one root.
fn links(seed: u64, count: usize, kinds: &[Kind]) -> Vec<Link> {
    let mut random = Random::new(seed);
    let mut links: Vec<Link> = Vec::new();
    while links.len() < count {
        links.push(Link::random(&mut random, &links, kinds));
    }
    links
}

/// Returns a random tree that has at least one degree of freedom.
fn moving(seed: u64, count: usize, kinds: &[Kind]) -> Vec<Link> {
    let mut links = links(seed, count, kinds);
    if links.iter().all(|link| link.kind == Kind::Fixed) {
        links.push(Link::on(
            &mut Random::new(seed),
            &links,
            Kind::Revolute,
            Some(0),
        ));
    }
    links
}

/// Compares F, M, the bias, gravity and springs, ξ̇, momenta and the energy with the recursive Newton-Euler algorithm.
fn obeys_newton(links: &[Link], seed: u64, close: f64) -> Generated {
    let text = text(links, FUNCTIONS);
    let system = generated(&text);
    let n = system.program.n;
    let mut random = Random::new(seed);
    for _ in 0..STATES_PER_TREE {
        let state = State::random(&mut random, &system);
        let tree = Tree::new(links, &state.x, &state.xi);
        let still = vec![0.0; n];
        let of = |name: &str| state.value(&system, name);
        let same = |what: &str, found: &[f64], wanted: &[f64]| {
            let apart = difference(wanted, found);
            assert!(apart < close, "seed {seed:#x}: {what} {apart:e} of\n{text}");
        };
        let springs = tree.springs();
        let whole = |dot: &[f64]| plus(&tree.needed(dot, 1.0), &springs);
        same(
            "inverse dynamics",
            &of("inverse_dynamics"),
            &whole(&state.dot),
        );
        let bias = tree.needed(&still, 0.0);
        same("bias", &of("bias"), &bias);
        let slope = minus(&whole(&still), &bias);
        same("slope of the potential", &of("potential_force"), &slope);
        same("energy", &of("energy"), &[tree.energy()]);
        let mass = of("mass_matrix");
        for i in 0..n {
            let mut unit = still.clone();
            unit[i] = 1.0;
            let column = minus(&tree.needed(&unit, 0.0), &bias);
            same("mass matrix", &mass[i * n..(i + 1) * n], &column);
        }
        let momentum = minus(&tree.needed(&state.xi, 0.0), &bias);
        same("momentum", &of("momentum"), &momentum);
        // Compares both sides of the equations of motion, relative to the larger of their terms.
        let motion = of("accel");
        let largest = |list: &[f64]| list.iter().fold(1.0, |most: f64, f| most.max(f.abs()));
        let size = largest(&motion) * largest(&mass);
        let left = minus(&whole(&motion), &tree.applied(state.u[0]));
        let apart = largest(&left.iter().map(|f| 1.0 + f.abs()).collect::<Vec<_>>()) - 1.0;
        assert!(
            apart < close * size,
            "seed {seed:#x}: motion {apart:e} of\n{text}"
        );
    }
    system
}

/// Checks that M ξ̇ + Γ ξ ξ + ∂V, assembled from the tables of M, γ and Γ, agrees with the recursion.
fn obeys_the_tables(system: &Generated, seed: u64) {
    let mut geometry =
        EquationTables::new(&system.model).expect("velocities that determine the rates");
    let (mass, connection) = (geometry.mass.clone(), geometry.connection.clone());
    let dot = geometry.model.xi_dot.clone();
    let (model, calculus) = (&mut geometry.model, &mut geometry.calculus);
    let bias = contract_connection(model, &connection);
    let potential = geometry.potential;
    let whole = explicit_form(model, calculus, &mass, &bias, potential, &dot);
    let mut random = Random::new(seed);
    for _ in 0..STATES_PER_TREE {
        let state = State::random(&mut random, system);
        let State { x, xi, u, dot } = &state;
        let numbers = model.numbers(&[], x, xi, u, dot);
        let same = |what: &str, name: &str, wanted: Vec<f64>| {
            let apart = difference(&wanted, &state.value(system, name));
            assert!(apart < TOLERANCE, "seed {seed:#x}: {what} {apart:e}");
        };
        let literal = |edges: &[_]| evaluate(&model.graph, edges, &numbers);
        same("M ξ̇ + Γ ξ ξ + ∂V", "inverse_dynamics", literal(&whole));
        same("Γ ξ ξ", "bias", literal(&bias));
        same("M", "mass_matrix", literal(&mass.concat()));
    }
}

#[test]
fn trees_of_one_freedom_a_joint() {
    for (seed, count) in [(0x51, 2), (0x52, 3), (0x53, 4), (0x54, 6), (0x55, 8)] {
        obeys_newton(&moving(seed, count, &SIMPLE_TREES), seed, TOLERANCE);
    }
}

#[test]
fn trees_of_all_kinds() {
    for (seed, count) in [(0xa1, 2), (0xa2, 2), (0xa3, 3), (0xa4, 4), (0xa5, 5)] {
        obeys_newton(&moving(seed, count, &ALL), seed, TOLERANCE);
    }
    for seed in 0xb0..0xbc {
        obeys_newton(&moving(seed, 6, &ALL), seed, TOLERANCE);
    }
}

/// The trees are small enough for tables of n³ coefficients.
#[test]
fn trees_obey_the_tables_of_the_paper() {
    for seed in 0xc0..0xc5 {
        let count = 2 + (seed % 2) as usize;
        let system = obeys_newton(&moving(seed, count, &ALL), seed, TOLERANCE);
        obeys_the_tables(&system, seed);
    }
}

/// Point masses are not links.
#[test]
fn trees_with_particles() {
    for seed in 0xd0..0xd4 {
        let mut random = Random::new(seed);
        let links = moving(seed, 3, &ALL);
        let links: Vec<Link> = links
            .into_iter()
            .map(|link| link.with_particle(&mut random))
            .collect();
        obeys_newton(&links, seed, TOLERANCE);
    }
}

/// Hinges that carry sliders and hinges: their axes are rotated for the hinges but not for the sliders. Two hundred
/// with `HAMEL_ATTACK=full`.
#[test]
fn sliders_beside_hinges() {
    for seed in 0x1000..0x1000 + size(3, 200) {
        let mut random = Random::new(seed);
        let mut links: Vec<Link> = Vec::new();
        let on = |random: &mut Random, links: &mut Vec<Link>, kind, parent| {
            let link = Link::on(random, links, kind, parent);
            links.push(link);
        };
        on(&mut random, &mut links, Kind::Revolute, None);
        on(&mut random, &mut links, Kind::Revolute, Some(0));
        let first = random.below(2);
        for k in 0..3 {
            let kind = [Kind::Prismatic, Kind::Revolute][(first + k) % 2];
            on(&mut random, &mut links, kind, Some(1));
        }
        obeys_newton(&links, seed, TOLERANCE);
    }
}

/// 32 links in a chain.
#[test]
fn a_long_chain() {
    let mut random = Random::new(0x32);
    let mut links: Vec<Link> = Vec::new();
    while links.len() < 32 {
        let (kind, parent) = (SIMPLE_TREES[random.below(4)], links.len().checked_sub(1));
        links.push(Link::on(&mut random, &links, kind, parent));
    }
    obeys_newton(&links, 0x32, LONG_CHAIN_TOLERANCE);
}

#[test]
fn a_humanoid() {
    let system = obeys_newton(&humanoid(), 0x38, LONG_CHAIN_TOLERANCE);
    assert_eq!(system.program.n, 38);
}
