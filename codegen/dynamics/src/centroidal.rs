//! Centre of mass c and centroidal momentum.
//!
//! With the mass m_k of each body, its centre of mass c_k and its inertia Θ_k about that, in world
//! axes,
//!
//! m c = Σ m_k c_k, P = Σ m_k ċ_k, L = Σ (c_k − c) × m_k ċ_k + R_k Θ_k ω_k, h = (P, L) = A_G ξ
//!
//! (Orin and Goswami 2008). Bodies that do not move, on frames of the world, do not count. The
//! routes are these sums and, for trees, the recursion L = L₀ − c × P with the momentum about the
//! origin; the columns of A_G are derivatives of h by ξ, or the momenta of composite bodies.

use super::accel::context::DerivationContext;
use super::accel::recursive::TreeRecursion;
use super::calculus::Calculus;
use super::candidates::Candidates;
use super::frames::{Twist, by_velocities, matrix_by_rows, twist_entries, twist_rate};
use super::program::ProgramBuilder;
use super::quantity::{MovingMass, mass_motions};
use super::tree::Placement;
use super::tree::draft::has_more_inertia;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, add3, cross, scale3, sub3, zero3};
use hamel_algebra::transplant::{map_symbols, rebuild};
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::layout::Block;
use hamel_language::model::{Model, class};
use hamel_program::{FunctionId, Shape};
use num_traits::Signed;

impl ProgramBuilder<'_> {
    /// Adds the requested centroidal functions.
    ///
    /// # Errors
    /// Returns a diagnostic if nothing with mass moves, or if there is inertia that is not that of
    /// bodies or particles.
    pub(super) fn centroidal(&mut self, full: &Model) -> Result<(), Diagnostic> {
        let model = self.model;
        let mut asked = FunctionId::CENTROIDAL.into_iter();
        let Some(first) = asked.find(|&id| model.asked.names(id)) else {
            return Ok(());
        };
        let refused = |why: &str, help: &str| {
            let message = format!("`{}` is not known: {why}", first.name());
            Err(Diagnostic::new(model.span, message).help(help))
        };
        let mut bodies = model.clone();
        let found = moving_masses(&mut bodies, &mut Calculus::new(model));
        let mass = mass(&mut bodies.graph, &found);
        let number = bodies.graph.as_rational(mass);
        if number.as_ref().is_some_and(|mass| !mass.is_positive()) {
            return refused(
                "nothing with mass moves",
                "describe masses by `body` or `particle`",
            );
        }
        if has_more_inertia(&mut full.clone()) {
            return refused(
                "`kinetic` gives an energy but no momentum in space",
                "describe all masses by `body` or `particle`",
            );
        }
        // The total mass is a divisor, and run-time parameters may make it zero.
        if number.is_none() {
            let mass = rebuild(&bodies.graph, &mut self.graph, &[mass]);
            self.constant_guards.extend(mass);
        }
        let recursion = TreeRecursion::of(
            &DerivationContext::in_given_velocities(model),
            Placement::Described,
            &self.numerical_loss,
        );
        for id in FunctionId::CENTROIDAL {
            if !model.asked.wants(id) {
                continue;
            }
            let mut candidates = Candidates::new(&self.numerical_loss);
            let mut offer = |graph: Graph, roots: Vec<Edge>| {
                candidates.offer_polished(graph, roots, &model.graph);
            };
            let (graph, roots) = entries(model, id, None);
            offer(graph, roots);
            if let Some(recursion) = &recursion {
                let (graph, linear, angular) = recursion.total_momentum();
                let (graph, roots) = entries(model, id, Some((graph, (linear, angular))));
                offer(graph, roots);
                if let (FunctionId::CentroidalMap, Some((graph, columns))) =
                    (id, recursion.momentum_columns())
                {
                    let (graph, roots) = about_centre(model, graph, columns);
                    offer(graph, roots);
                }
            }
            let outputs = candidates.cheapest(&mut self.graph);
            self.push(id, outputs);
            if let (FunctionId::CentroidalMap, Some(map)) = (id, self.functions.last_mut()) {
                map.shape = Shape::Matrix(6, model.n());
            }
        }
        Ok(())
    }
}

/// Returns the masses that depend on the configuration.
fn moving_masses(model: &mut Model, calculus: &mut Calculus) -> Vec<MovingMass> {
    let all = mass_motions(model, calculus, None);
    let moves = bodies_that_move(model);
    let kept = all.into_iter().zip(moves).filter(|(_, moves)| *moves);
    kept.map(|(motion, _)| motion).collect()
}

/// Returns for each body and then for each particle whether its position depends on the configuration, rather than
/// being fixed in the world.
pub fn bodies_that_move(model: &Model) -> Vec<bool> {
    let depends = |edges: &[Edge]| {
        let class = |class, edge: &Edge| class | model.graph.class(edge.node());
        edges.iter().fold(0, class) & class::CONFIGURATION != 0
    };
    let bodies = model.bodies.iter().map(|body| {
        let frame = &model.frames[body.frame];
        depends(&frame.rotation.concat()) || depends(&frame.position)
    });
    let particles = model.particles.iter().map(|one| depends(&one.position));
    bodies.chain(particles).collect()
}

/// Returns the total mass that moves.
fn mass(graph: &mut Graph, moving: &[MovingMass]) -> Edge {
    let masses: Vec<Edge> = moving.iter().map(|motion| motion.mass).collect();
    graph.sum(&masses)
}

/// Returns the centre of mass c; zero if there is no mass.
fn centre(graph: &mut Graph, moving: &[MovingMass]) -> Vec3 {
    let mut first = zero3(graph);
    for motion in moving {
        let part = scale3(graph, motion.mass, motion.centre);
        first = add3(graph, first, part);
    }
    let mass = mass(graph, moving);
    let inverse = graph.div(graph.one(), mass).unwrap_or(graph.zero());
    scale3(graph, inverse, first)
}

/// Returns the entries of a function, by rows.
///
/// `total` is the total momentum about the origin, if it is known.
fn entries(model: &Model, id: FunctionId, total: Option<(Graph, Twist)>) -> (Graph, Vec<Edge>) {
    let mut own = model.clone();
    let mut calculus = Calculus::new(model);
    let known = total.map(|(graph, total)| {
        own.graph = graph;
        total
    });
    let moving = moving_masses(&mut own, &mut calculus);
    let mut graph = own.graph;
    let centre = centre(&mut graph, &moving);
    if id == FunctionId::CentreOfMass {
        return (graph, centre.to_vec());
    }
    let momentum = match known {
        Some((linear, angular)) => {
            let lever = cross(&mut graph, centre, linear);
            (linear, sub3(&mut graph, angular, lever))
        }
        None => {
            let (mut linear, mut angular) = (zero3(&graph), zero3(&graph));
            for motion in &moving {
                let arm = sub3(&mut graph, motion.centre, centre);
                let lever = cross(&mut graph, arm, motion.momentum);
                let moment = add3(&mut graph, lever, motion.spin);
                linear = add3(&mut graph, linear, motion.momentum);
                angular = add3(&mut graph, angular, moment);
            }
            (linear, angular)
        }
    };
    let (mut graph, momenta) = anywhere(model, graph, vec![momentum]);
    let mut calculus = Calculus::new(model);
    let momentum = momenta[0];
    let roots = match id {
        FunctionId::CentroidalMap => {
            matrix_by_rows(by_velocities(model, &mut graph, momentum).into_iter())
        }
        FunctionId::CentroidalBias => {
            twist_entries(twist_rate(&mut graph, &mut calculus, momentum))
        }
        _ => twist_entries(momentum),
    };
    (graph, roots)
}

/// Returns A_G from the columns of the momentum map about the origin.
fn about_centre(model: &Model, graph: Graph, columns: Vec<Twist>) -> (Graph, Vec<Edge>) {
    let mut own = Model {
        graph,
        ..model.clone()
    };
    let moving = moving_masses(&mut own, &mut Calculus::new(model));
    let mut graph = own.graph;
    let centre = centre(&mut graph, &moving);
    let columns = columns.into_iter().map(|(linear, angular)| {
        let lever = cross(&mut graph, centre, linear);
        (linear, sub3(&mut graph, angular, lever))
    });
    let columns: Vec<Twist> = columns.collect();
    let (graph, columns) = anywhere(model, graph, columns);
    (graph, matrix_by_rows(columns.into_iter()))
}

/// Returns the momenta with L rewritten without the coordinates and velocities on which it does not
/// depend.
///
/// L is the same wherever the mechanism is and however fast it moves as a whole, but far from the
/// origin the digits of both would be lost in sums.
fn anywhere(model: &Model, graph: Graph, momenta: Vec<Twist>) -> (Graph, Vec<Twist>) {
    let (linear, angular): (Vec<Vec3>, Vec<Vec3>) = momenta.into_iter().unzip();
    let angular = angular.concat();
    let symbols = model.graph.symbols().iter();
    let mut images: Vec<Edge> = symbols.map(|symbol| Edge::of(symbol.node)).collect();
    let zero = model.graph.zero();
    let mut x = model.x.iter();
    let mut open: Vec<Edge> = Vec::new();
    for block in &model.blocks {
        let own = x.by_ref().take(block.len());
        let flat = matches!(block, Block::Flat(_));
        open.extend(own.filter(|_| flat));
    }
    let mut left = None;
    for edge in open.iter().chain(&model.xi) {
        let Some(place) = images.iter().position(|image| image == edge) else {
            continue;
        };
        let before = std::mem::replace(&mut images[place], zero);
        let mut own = model.graph.clone();
        let moved = map_symbols(&graph, &mut own, &angular, &images);
        let same = |(a, b): (&Edge, &Edge)| own.value(*a) == graph.value(*b);
        if moved.iter().zip(&angular).all(same) {
            left = Some((own, moved));
        } else {
            images[place] = before;
        }
    }
    let whole = |linear: Vec<Vec3>, angular: &[Edge]| {
        let angular = angular.chunks(3).map(|v| [v[0], v[1], v[2]]);
        linear.into_iter().zip(angular).collect()
    };
    match left {
        None => (graph, whole(linear, &angular)),
        Some((mut own, angular)) => {
            let linear = rebuild(&graph, &mut own, &linear.concat());
            let linear = linear.chunks(3).map(|v| [v[0], v[1], v[2]]).collect();
            (own, whole(linear, &angular))
        }
    }
}
