//! Expressions of the kept constants, as comments where they are computed.

use super::Emitter;
use super::print::Headings;
use hamel_algebra::graph::NodeId;
use hamel_algebra::text::{short, short_with};
use hamel_program::origins::served;
use hamel_program::statements::Body;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// Largest number of characters of an expression that is written out.
const WIDTH: usize = 80;

/// Returns the headings of the function that computes the constants, such as `k[2] = m * g`.
pub fn headings(emitter: &Emitter, body: &Body) -> Headings {
    let kept = emitter.kept.iter().enumerate();
    let places: FxHashMap<NodeId, usize> = kept.map(|(place, edge)| (edge.node(), place)).collect();
    let texts: Vec<Rc<str>> = (0..emitter.kept.len())
        .map(|place| {
            let value = expression(emitter, &places, place);
            let value = value.map_or_else(String::new, |text| format!(" = {text}"));
            format!("k[{place}]{value}").into()
        })
        .collect();
    let served = served(body, |node| places.get(&node).copied());
    let served = served.into_iter();
    served
        .map(|(node, place)| (node, texts[place].clone()))
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
