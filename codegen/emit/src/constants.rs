//! Expressions of the kept constants, as comments where they are computed.

use super::Emitter;
use hamel_algebra::graph::NodeId;
use hamel_algebra::text::{short, short_with};
use hamel_program::origins::served;
use hamel_program::provenance::Origin;
use hamel_program::statements::Body;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// Largest number of characters of an expression that is written out.
const WIDTH: usize = 80;

/// Returns, for the function that computes the kept constants, the constant that each of its statements serves, by the
/// nodes that the statements define. The quantity of a constant is its expression, such as `k[2] = m * g`.
pub fn constant_origins(emitter: &Emitter, body: &Body) -> FxHashMap<NodeId, Rc<Origin>> {
    let kept = emitter.kept.iter().enumerate();
    let places: FxHashMap<NodeId, usize> = kept.map(|(place, edge)| (edge.node(), place)).collect();
    let origins: Vec<Rc<Origin>> = (0..emitter.kept.len())
        .map(|place| {
            let value = expression(emitter, &places, place);
            let value = value.map_or_else(String::new, |text| format!(" = {text}"));
            Rc::new(Origin {
                quantity: format!("k[{place}]{value}"),
                equation: "parameters",
                span: emitter.program.provenance.system(),
            })
        })
        .collect();
    let served = served(body, |node| places.get(&node).copied());
    let served = served.into_iter();
    served
        .map(|(node, place)| (node, origins[place].clone()))
        .collect()
}

/// Writes a constant in the parameters or, if that is too long, in the parameters and other constants.
fn expression(
    emitter: &Emitter,
    places: &FxHashMap<NodeId, usize>,
    place: usize,
) -> Option<String> {
    let (graph, edge) = (&emitter.program.graph, emitter.kept[place]);
    short(graph, edge, WIDTH).or_else(|| {
        let name = |id: NodeId| places.get(&id).map(|place| format!("k[{place}]"));
        short_with(graph, edge, WIDTH, &name)
    })
}
