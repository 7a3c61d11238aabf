//! Structure of a system, as it matters to integration methods.
//!
//! The question is whether a system splits into torque-free rotors, uniform motions and kicks, in
//! whatever coordinates and velocities it was described.
//!
//! | file | contents |
//! |---|---|
//! | `variation` | dependence of expressions on symbols, modulo p |
//! | `rates` | rates of the coordinates, w = B ξ, ξ = N w |
//! | `constant` | rewriting constant expressions without coordinates |
//! | `centre`, `tetrahedron` | shift to centres of mass |
//! | `inertia` | inertia that remains after the shift: rotors, and one constant block |
//! | `forces` | causes of velocity-dependent forces |
//! | `functions` | centre, momenta, velocities, kicks as functions |
//! | `choice` | choice of the integration method |
//!
//! M_c = Nᵀ M N is the inertia in the rates w. A system splits if, after the shift of plain
//! coordinates that removes their coupling with turning ones, this inertia is constant and consists
//! of one block for each rotor and one for everything else, and if forces do not depend on
//! velocities.

mod centre;
pub mod choice;
mod constant;
mod context;
mod forces;
mod functions;
mod inertia;
pub mod rates;
mod tetrahedron;
mod variation;

pub(super) use functions::SplitFunctions;

use super::accel::parts::EquationTerms;
use context::StructureContext;
use hamel_algebra::graph::{Edge, Graph};
use hamel_language::model::pfaffian::Kind;
use hamel_language::model::{Model, class};
use hamel_program::structure::{Reason, Splitting, Structure};
use rates::{CoordinateBlock, coordinate_blocks};
use variation::Variation;

/// Whether a system splits into free motion and kicks, with its functions if it does.
pub struct StructureAnalysis {
    /// Structure of the system.
    pub structure: Structure,
    /// Functions that the splitting methods call; `None` if the system does not split.
    pub(super) functions: Option<SplitFunctions>,
}

/// Analyses whether a system splits into free motion and kicks, and derives the functions of splitting methods if it
/// does.
///
/// `model` is `full` in the velocities that its constraints leave free; `traced` are its M and
/// forces, in `graph`.
pub fn analyse_structure(
    full: &Model,
    model: &Model,
    graph: &Graph,
    traced: &EquationTerms,
) -> StructureAnalysis {
    let mut graph = graph.clone();
    let blocks = coordinate_blocks(model);
    let force: Vec<Edge> = (0..model.n())
        .map(|i| graph.add(traced.conservative[i], traced.applied[i]))
        .collect();
    let zero = graph.zero();
    let mass: Vec<Edge> = traced.mass.concat();
    let roots: Vec<Edge> = mass.iter().chain(&force).copied().collect();
    let variation = Variation::new(model, &graph, &roots);
    let damped = match &variation {
        Some(variation) => forces::velocity_dependent_loads(full, model, &graph, variation, &force),
        None => Vec::new(),
    };
    let constrained = constrained(full);
    let mut structure = Structure {
        split: Err(Vec::new()),
        canonical: match &constrained {
            Some(reason) => Err(reason.clone()),
            None => Ok(()),
        },
        mass: dependence(model, &graph, &blocks, variation.as_ref(), &mass),
        conservative: traced.applied.iter().all(|&force| force == zero),
        damped,
        multipliers: !model.constraints.is_empty(),
    };
    let directions = model.blocks.iter().map(|block| block.dimension()).sum();
    let found = if let Some(reason) = constrained {
        Err(vec![reason])
    } else if directions != model.n() {
        Err(vec![Reason::Tied {
            directions,
            velocities: model.n(),
        }])
    } else if let Some(variation) = &variation {
        let context = StructureContext {
            model,
            parts: &blocks,
            variation,
        };
        inertia::split_inertia(&context, &mut graph, traced)
    } else {
        Err(vec![Reason::Rates])
    };
    let mut reasons = found.as_ref().err().cloned().unwrap_or_default();
    reasons.extend(structure.damped.iter().cloned());
    let (Ok(separated), Some(variation), true) = (found, &variation, reasons.is_empty()) else {
        structure.split = Err(reasons);
        return StructureAnalysis {
            structure,
            functions: None,
        };
    };
    let context = StructureContext {
        model,
        parts: &blocks,
        variation,
    };
    let functions = SplitFunctions::new(&context, graph, &separated, &force);
    structure.split = match &functions {
        Some(functions) => Ok(Splitting {
            rotors: functions.rotors.clone(),
            free: functions.is_force_free(),
        }),
        None => Err(vec![Reason::Rates]),
    };
    StructureAnalysis {
        structure,
        functions,
    }
}

/// Returns the names of the coordinates on which M depends.
///
/// Coordinates that a description ties to one another cannot be moved one by one; in that case, an
/// entry counts as dependent on those in which it is written.
fn dependence(
    model: &Model,
    graph: &Graph,
    parts: &[CoordinateBlock],
    variation: Option<&Variation>,
    mass: &[Edge],
) -> Vec<String> {
    match variation {
        Some(variation) if model.points.constraints.is_empty() => {
            rates::changing_parts(variation, graph, parts, &model.x, mass)
        }
        _ => {
            let reached = graph.reachable(mass);
            let written = parts.iter().filter(|part| {
                let entries = part.entries(&model.x);
                entries.iter().any(|x| reached.contains(&x.node()))
                    && mass
                        .iter()
                        .any(|edge| graph.class(edge.node()) & class::CONFIGURATION != 0)
            });
            written.map(|part| part.name.clone()).collect()
        }
    }
}

/// Describes the constraints on velocities, if there are any, or else states of first order or the
/// time.
fn constrained(full: &Model) -> Option<Reason> {
    let count = |kind: Kind| {
        let rows = full.constraints.iter();
        rows.filter(|c| c.kind == kind && !c.redundant).count()
    };
    let words = [
        (Kind::Inactive, "inactive velocity", "inactive velocities"),
        (Kind::Nonholonomic, "nonholonomic row", "nonholonomic rows"),
        (Kind::Loop, "row of closed loops", "rows of closed loops"),
        (
            Kind::Drive { position: true },
            "prescribed coordinate",
            "prescribed coordinates",
        ),
        (
            Kind::Drive { position: false },
            "prescribed velocity",
            "prescribed velocities",
        ),
    ];
    let found: Vec<String> = words
        .iter()
        .filter_map(|(kind, one, many)| match count(*kind) {
            0 => None,
            1 => Some(format!("1 {one}")),
            number => Some(format!("{number} {many}")),
        })
        .collect();
    let mut found = found;
    match full.accelerated.len() {
        0 => {}
        1 => found.push("1 prescribed rate".into()),
        number => found.push(format!("{number} prescribed rates")),
    }
    match found.as_slice() {
        [] if !full.states.is_empty() => Some(Reason::States),
        [] => full.clock.map(|_| Reason::Time),
        found => Some(Reason::Constrained {
            by: found.join(" and "),
        }),
    }
}
