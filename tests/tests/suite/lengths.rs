//! Inverses of lengths in the programs of all models.

use crate::derived::models;
use hamel_codegen::algebra::graph::{Function, Node};

/// 1/(−a) = −1/a, by which the graph simplifies, fails where |a| is so small that a large positive number replaces 1/a.
/// No value is wrong by this, since only lengths are inverted, which are not negative.
#[test]
fn only_lengths_are_inverted() {
    let mut found = 0;
    for model in models() {
        let graph = &model.generated().program.graph;
        for id in 0..graph.len() as u32 {
            let Node::Apply(Function::Inverse, length) = graph.node(id) else {
                continue;
            };
            let of = graph.node(length.node());
            assert!(
                matches!(of, Node::Apply(Function::Norm, _)) && !length.is_negative(),
                "{}: {of:?}",
                model.name
            );
            found += 1;
        }
    }
    assert!(found > 0);
}
