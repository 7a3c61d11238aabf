//! Kinematics of the frames requested by `generate jacobian f;`: pose (R, p), twist (v, ω) = J ξ + j, J, and
//! J̇ ξ + j̇, the rate of the twist at ξ̇ = 0. Components are in world axes, (ṗ, ω), or in those of the frame
//! itself, (Rᵀ ṗ, Rᵀ ω). The term j occurs only if the frame's motion depends on time explicitly.
//!
//! There are three routes: from the definitions, with Ṙ and ṗ along ẋ = A ξ; and outwards along the frames that f
//! is placed on, either in world axes or in each frame's own axes, by
//!
//! ω = ω₀ + R₀ w, v = v₀ + ω₀ × (p − p₀) + R₀ q̇,
//!
//! where f₀ is the previous frame, q the position of f in it, and w the angular velocity of f relative to it. The
//! columns of J are those of the joints, (R₀ q̇ₖ + wₖ × (p_f − p), wₖ). Velocities that move none of these frames
//! have zero columns.

mod known;

use super::calculus::Calculus;
use super::candidates::Candidates;
use super::program::ProgramBuilder;
use Argument::{Coordinates, Velocities};
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{
    Mat3, Vec3, add3, apply_transposed, apply3, cross, identity3, multiply3, sub3, transpose3,
    zero3,
};
use hamel_language::functions::FrameFunction;
use hamel_language::model::{Frame, Model};
use hamel_program::{Argument, Function, Shape};
use known::with_known_expressions;

/// Linear and angular part of a velocity, of its rate, or of a column of J.
pub(crate) type Twist = (Vec3, Vec3);

impl ProgramBuilder<'_> {
    /// Adds the functions of the requested frames.
    pub(crate) fn frames(&mut self) {
        let model = self.model;
        for jacobian in &model.asked.jacobians {
            let Some(index) = model.frames.iter().position(|f| f.name == jacobian.frame) else {
                continue;
            };
            let known = with_known_expressions(model, index);
            let sources: Vec<&Model> = [model].into_iter().chain(&known).collect();
            for &of in FrameFunction::ALL {
                let name = jacobian.name_of(of);
                if self.functions.iter().any(|known| known.name == name) {
                    continue;
                }
                let entries = self.frame(&sources, (index, jacobian.own), of);
                let (arguments, shape): (&[Argument], Shape) = match of {
                    FrameFunction::Pose => (&[Coordinates], Shape::Matrix(3, 4)),
                    FrameFunction::Twist | FrameFunction::BiasAcceleration => {
                        (&[Coordinates, Velocities], Shape::Vector(6))
                    }
                    FrameFunction::Jacobian => (&[Coordinates], Shape::Matrix(6, model.n())),
                };
                let function = Function::described(&name, String::new(), arguments, shape, entries);
                self.functions.push(Function {
                    docs: jacobian.docs_of(of),
                    ..function
                });
            }
        }
    }

    /// Returns the cheapest of all routes, after resubstitution if that saves operations.
    fn frame(
        &mut self,
        sources: &[&Model],
        (index, own): (usize, bool),
        of: FrameFunction,
    ) -> Vec<Edge> {
        let mut candidates = Candidates::new(&self.numerical_loss);
        for model in sources {
            for route in Route::all(chain(model, index).len(), of) {
                let mut graph = model.graph.clone();
                let roots = route.entries(model, &mut graph, (index, own), of);
                candidates.offer_polished(graph, roots, &model.graph);
            }
        }
        candidates.cheapest(&mut self.graph)
    }
}

/// Approximate largest number of borders that are tried for a route: places of the chain from which on the levers
/// of a Jacobian's columns are written in the axes of their joints.
const MAX_BORDERS: usize = 8;

/// Way to compute the kinematics of a frame.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Route {
    /// By the rates of its pose.
    Defined,
    /// Outwards along the chain of frames, in world axes; levers of J are in the axes of the joints from this place
    /// of the chain on.
    World(usize),
    /// Like `World`, with all levers in axes of the joints: before this place of the chain, in the axes before the
    /// joint has turned.
    Before(usize),
    /// Outwards along the chain, each frame in its own axes; levers of J as in `World`.
    Own(usize),
}

impl Route {
    /// Returns all routes by which a function of a frame with a chain of this length can be computed.
    fn all(length: usize, of: FrameFunction) -> Vec<Route> {
        let step = length.div_ceil(MAX_BORDERS).max(1);
        let borders: Vec<usize> = match of {
            FrameFunction::Pose => return vec![Route::Defined],
            FrameFunction::Jacobian => (0..=length).rev().step_by(step).collect(),
            FrameFunction::Twist | FrameFunction::BiasAcceleration => vec![length],
        };
        let routes = |route: fn(usize) -> Route| borders.iter().map(move |&at| route(at));
        let (world, own) = (routes(Route::World), routes(Route::Own));
        let before = routes(Route::Before).filter(|_| of == FrameFunction::Jacobian);
        [Route::Defined]
            .into_iter()
            .chain(world)
            .chain(own)
            .chain(before)
            .collect()
    }

    /// Returns the entries of a function, row by row.
    fn entries(
        self,
        model: &Model,
        graph: &mut Graph,
        (index, own): (usize, bool),
        of: FrameFunction,
    ) -> Vec<Edge> {
        let frame = &model.frames[index];
        let mut calculus = Calculus::new(model);
        if of == FrameFunction::Pose {
            let rows = frame.rotation.iter().zip(frame.position);
            return rows
                .flat_map(|(row, p)| [row[0], row[1], row[2], p])
                .collect();
        }
        let (columns, from) = match (of, self) {
            (FrameFunction::Jacobian, Route::Defined) => {
                let twist = twist_by_definition(graph, &mut calculus, frame, own);
                (by_velocities(model, graph, twist), Some(own))
            }
            (FrameFunction::Jacobian, Route::World(_) | Route::Before(_)) => {
                let columns = columns_in_world(model, graph, &mut calculus, (index, self));
                (columns, Some(false))
            }
            (FrameFunction::Jacobian, Route::Own(border)) => {
                let columns = columns_in_frame(model, graph, &mut calculus, (index, border));
                (columns, Some(true))
            }
            _ => (Vec::new(), None),
        };
        if let Some(from) = from {
            let turned = columns.into_iter().map(|column| match (from, own) {
                (false, true) => to_frame(graph, &frame.rotation, column),
                (true, false) => to_world(graph, &frame.rotation, column),
                _ => column,
            });
            return matrix_by_rows(turned);
        }
        let (twist, rates, from) = match self {
            Route::Defined => {
                let twist = twist_by_definition(graph, &mut calculus, frame, own);
                let rates = twist_rate(graph, &mut calculus, twist);
                (twist, rates, own)
            }
            Route::World(_) | Route::Before(_) => {
                let (twist, rates) = outwards_in_world(model, graph, &mut calculus, index);
                (twist, rates, false)
            }
            Route::Own(_) => {
                let (twist, rates) = outwards_in_frames(model, graph, &mut calculus, index);
                (twist, rates, true)
            }
        };
        let rate = of == FrameFunction::BiasAcceleration;
        let lever = cross(graph, twist.1, twist.0);
        twist_entries(match (from, own, rate) {
            (false, true, false) => to_frame(graph, &frame.rotation, twist),
            (true, false, false) => to_world(graph, &frame.rotation, twist),
            // d/dt (Rᵀ v) = Rᵀ (v̇ − ω × v), and d/dt (R v) = R (v̇ + ω × v).
            (false, true, true) => {
                let linear = sub3(graph, rates.0, lever);
                to_frame(graph, &frame.rotation, (linear, rates.1))
            }
            (true, false, true) => {
                let linear = add3(graph, rates.0, lever);
                to_world(graph, &frame.rotation, (linear, rates.1))
            }
            (_, _, false) => twist,
            (_, _, true) => rates,
        })
    }
}

pub(crate) fn twist_entries((linear, angular): Twist) -> Vec<Edge> {
    [linear, angular].concat()
}

/// Returns the entries of the matrix with these columns, row by row.
pub(crate) fn matrix_by_rows(columns: impl Iterator<Item = Twist>) -> Vec<Edge> {
    let columns: Vec<Vec<Edge>> = columns.map(twist_entries).collect();
    (0..6)
        .flat_map(|row| columns.iter().map(move |column| column[row]))
        .collect()
}

fn to_world(graph: &mut Graph, rotation: &Mat3, (linear, angular): Twist) -> Twist {
    (
        apply3(graph, rotation, linear),
        apply3(graph, rotation, angular),
    )
}

fn to_frame(graph: &mut Graph, rotation: &Mat3, (linear, angular): Twist) -> Twist {
    (
        apply_transposed(graph, rotation, linear),
        apply_transposed(graph, rotation, angular),
    )
}

/// Returns the time derivative of a twist at ξ̇ = 0.
pub(crate) fn twist_rate(
    graph: &mut Graph,
    calculus: &mut Calculus,
    (linear, angular): Twist,
) -> Twist {
    (
        calculus.rate3(graph, linear),
        calculus.rate3(graph, angular),
    )
}

/// Returns the derivatives of a twist by each ξⁱ.
pub(crate) fn by_velocities(
    model: &Model,
    graph: &mut Graph,
    (linear, angular): Twist,
) -> Vec<Twist> {
    let one = graph.one();
    let column = |xi: &Edge| {
        let mut along = Derivation::new([(xi.node(), one)]);
        let mut slope = |v: Vec3| v.map(|entry| along.of(graph, entry));
        (slope(linear), slope(angular))
    };
    model.xi.iter().map(column).collect()
}

/// Returns the twist by definition: (ṗ, ω) with ω̂ = Ṙ Rᵀ, or (Rᵀ ṗ, Rᵀ ω).
fn twist_by_definition(
    graph: &mut Graph,
    calculus: &mut Calculus,
    frame: &Frame,
    own: bool,
) -> Twist {
    let speed = calculus.rate3(graph, frame.position);
    let spin = calculus.spin(graph, &frame.rotation);
    match own {
        true => (apply_transposed(graph, &frame.rotation, speed), spin),
        false => (speed, apply3(graph, &frame.rotation, spin)),
    }
}

/// Returns the chain of frames on which a frame is placed, from the world outwards, and the frame itself.
fn chain(model: &Model, index: usize) -> Vec<usize> {
    let parents = std::iter::successors(Some(index), |&at| model.frames[at].parent);
    let mut chain: Vec<usize> = parents.collect();
    chain.reverse();
    chain
}

/// Returns the velocity of a frame relative to the previous one: (q̇ in axes of the previous frame, w in its own).
fn relative(graph: &mut Graph, calculus: &mut Calculus, frame: &Frame) -> Twist {
    let (rotation, place) = &frame.relative;
    (
        calculus.rate3(graph, *place),
        calculus.spin(graph, rotation),
    )
}

/// Returns the twist and its rate at ξ̇ = 0 in world axes: ω̇ = ω̇₀ + ω₀ × R₀ w + R₀ ẇ and
/// v̇ = v̇₀ + ω̇₀ × r + ω₀ × (ω₀ × r + 2 R₀ q̇) + R₀ q̈, with r = p − p₀.
fn outwards_in_world(
    model: &Model,
    graph: &mut Graph,
    calculus: &mut Calculus,
    index: usize,
) -> (Twist, Twist) {
    let still = (zero3(graph), zero3(graph));
    let (mut twist, mut rates) = (still, still);
    let mut from = None;
    for at in chain(model, index) {
        let frame = &model.frames[at];
        let (slide, turn) = relative(graph, calculus, frame);
        let (slide_rate, turn_rate) = twist_rate(graph, calculus, (slide, turn));
        let arm = match from {
            None => frame.position,
            Some(before) => {
                let before: &Frame = &model.frames[before];
                sub3(graph, frame.position, before.position)
            }
        };
        let outer = from.map(|before: usize| model.frames[before].rotation);
        let place = |graph: &mut Graph, v: Vec3| match &outer {
            Some(rotation) => apply3(graph, rotation, v),
            None => v,
        };
        let slide = place(graph, slide);
        let slide_rate = place(graph, slide_rate);
        let own = apply3(graph, &frame.rotation, turn);
        let own_rate = apply3(graph, &frame.rotation, turn_rate);
        let (v, w) = twist;
        let (a, alpha) = rates;
        // Contribution of the rotation with the previous frame and of the motion relative to it.
        let lever = cross(graph, w, arm);
        let moved = add3(graph, lever, slide);
        let inner = add3(graph, moved, slide);
        let first = cross(graph, alpha, arm);
        let second = cross(graph, w, inner);
        let both = add3(graph, first, second);
        let both = add3(graph, both, slide_rate);
        let gyro = cross(graph, w, own);
        let gyro = add3(graph, gyro, own_rate);
        rates = (add3(graph, a, both), add3(graph, alpha, gyro));
        twist = (add3(graph, v, moved), add3(graph, w, own));
        from = Some(at);
    }
    (twist, rates)
}

/// Returns the twist (Rᵀ ṗ, Rᵀ ω) and the rate of its components at ξ̇ = 0, working in each frame's own axes.
fn outwards_in_frames(
    model: &Model,
    graph: &mut Graph,
    calculus: &mut Calculus,
    index: usize,
) -> (Twist, Twist) {
    let still = (zero3(graph), zero3(graph));
    let (mut twist, mut rates) = (still, still);
    for at in chain(model, index) {
        let frame = &model.frames[at];
        let (rotation, place) = &frame.relative;
        let (slide, turn) = relative(graph, calculus, frame);
        let (slide_rate, turn_rate) = twist_rate(graph, calculus, (slide, turn));
        let (v, w) = twist;
        let (a, alpha) = rates;
        // In the axes of the previous frame: v + ω × q + q̇, and the rates of these components.
        let lever = cross(graph, w, *place);
        let moved = add3(graph, v, lever);
        let moved = add3(graph, moved, slide);
        let first = cross(graph, alpha, *place);
        let second = cross(graph, w, slide);
        let changed = add3(graph, a, first);
        let changed = add3(graph, changed, second);
        let changed = add3(graph, changed, slide_rate);
        // d/dt (R₁ᵀ a) = R₁ᵀ ȧ − w × R₁ᵀ a.
        let (linear, angular) = to_frame(graph, rotation, (moved, w));
        let (linear_rate, angular_rate) = to_frame(graph, rotation, (changed, alpha));
        let drift = cross(graph, turn, linear);
        let gyro = cross(graph, turn, angular);
        let gyro = sub3(graph, turn_rate, gyro);
        rates = (
            sub3(graph, linear_rate, drift),
            add3(graph, angular_rate, gyro),
        );
        twist = (linear, add3(graph, angular, turn));
    }
    (twist, rates)
}

/// Returns the vector from each frame of a chain to the last one, in its own axes and in those of the previous
/// frame, for the frames from place `border` on.
fn levers(model: &Model, graph: &mut Graph, chain: &[usize], border: usize) -> Vec<[Vec3; 2]> {
    let mut lever = zero3(graph);
    let mut levers = vec![[lever; 2]; chain.len()];
    for place in (border..chain.len()).rev() {
        let (rotation, position) = &model.frames[chain[place]].relative;
        let turned = apply3(graph, rotation, lever);
        levers[place] = [lever, turned];
        lever = add3(graph, *position, turned);
    }
    levers
}

/// Adds a joint's contribution to the columns of J.
///
/// The arguments are the velocities (q̇, w) of its freedoms, in axes of the previous frame and of its own, and the
/// orientation of both frames in the axes in which the columns are written.
fn add_joint(
    graph: &mut Graph,
    columns: &mut [Twist],
    freedoms: Vec<Twist>,
    [outer, own]: [&Mat3; 2],
    arm: &LeverArm,
) {
    for (column, (slide, turn)) in columns.iter_mut().zip(freedoms) {
        let slide = apply3(graph, outer, slide);
        let turned = apply3(graph, own, turn);
        let lever = match arm {
            LeverArm::Placed(arm) => cross(graph, turned, *arm),
            LeverArm::Own(arm) => {
                let lever = cross(graph, turn, *arm);
                apply3(graph, own, lever)
            }
            LeverArm::Before(rotation, arm) => {
                let turn = apply3(graph, rotation, turn);
                let lever = cross(graph, turn, *arm);
                apply3(graph, outer, lever)
            }
        };
        let speed = add3(graph, slide, lever);
        *column = (add3(graph, column.0, speed), add3(graph, column.1, turned));
    }
}

/// Vector from a joint's frame to the frame whose Jacobian is computed.
enum LeverArm<'a> {
    /// In the axes in which columns are written.
    Placed(Vec3),
    /// In the axes of the joint's frame.
    Own(Vec3),
    /// In the axes of the previous frame, with the rotation of the joint's frame relative to it.
    Before(&'a Mat3, Vec3),
}

/// Returns the columns of J in world axes.
fn columns_in_world(
    model: &Model,
    graph: &mut Graph,
    calculus: &mut Calculus,
    (index, route): (usize, Route),
) -> Vec<Twist> {
    let mut columns = vec![(zero3(graph), zero3(graph)); model.n()];
    let tip = model.frames[index].position;
    let chain = chain(model, index);
    let (placed, before) = match route {
        Route::Before(border) => (0, border),
        Route::World(border) | Route::Own(border) => (border, 0),
        Route::Defined => (chain.len(), 0),
    };
    let levers = levers(model, graph, &chain, placed);
    let mut outer = identity3(graph);
    for (place, &at) in chain.iter().enumerate() {
        let frame = &model.frames[at];
        let moved = relative(graph, calculus, frame);
        let freedoms = by_velocities(model, graph, moved);
        let [own, turned] = levers[place];
        let arm = match place {
            _ if place < placed => LeverArm::Placed(sub3(graph, tip, frame.position)),
            _ if place < before => LeverArm::Before(&frame.relative.0, turned),
            _ => LeverArm::Own(own),
        };
        let axes = [&outer, &frame.rotation];
        add_joint(graph, &mut columns, freedoms, axes, &arm);
        outer = frame.rotation;
    }
    columns
}

/// Returns the columns of J in axes of the frame, computed from the frame inwards.
fn columns_in_frame(
    model: &Model,
    graph: &mut Graph,
    calculus: &mut Calculus,
    (index, border): (usize, usize),
) -> Vec<Twist> {
    let mut columns = vec![(zero3(graph), zero3(graph)); model.n()];
    let chain = chain(model, index);
    let levers = levers(model, graph, &chain, border);
    // Axes of the current frame, and the vector from its origin to that of f, both in axes of f.
    let (mut axes, mut way) = (identity3(graph), zero3(graph));
    for (place, &at) in chain.iter().enumerate().rev() {
        let frame = &model.frames[at];
        let (rotation, position) = &frame.relative;
        let moved = relative(graph, calculus, frame);
        let freedoms = by_velocities(model, graph, moved);
        let before = multiply3(graph, &axes, &transpose3(rotation));
        let arm = match place < border {
            true => LeverArm::Placed(way),
            false => LeverArm::Own(levers[place][0]),
        };
        add_joint(graph, &mut columns, freedoms, [&before, &axes], &arm);
        let further = apply3(graph, &before, *position);
        way = add3(graph, way, further);
        axes = before;
    }
    columns
}
