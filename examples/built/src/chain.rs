//! A chain of any number of links, each connected to the previous one by a hinge.

use hamel_codegen::scene::{
    Body, Expr, Frame, Joint, Scene, SceneError, ShapeKind, diagonal, shifted,
};

/// Builds a chain of `n` links that hangs from the world; the axes of its hinges alternate.
pub fn chain(n: usize) -> Result<Scene, SceneError> {
    let mut chain = Scene::builder("Chain");
    chain.doc(
        "A chain of links, each on a hinge of the one before; the axes of the hinges alternate.",
    );
    let (m, l) = (chain.param("m", 0.5), chain.param("l", 0.3));
    let g = chain.param("g", 9.81);
    let inertia = chain.param_of(
        "J",
        ShapeKind::Symmetric(3),
        diagonal([0.004, 0.004, 0.0002]),
    );
    chain.gravity([0.into(), 0.into(), -g]);

    // The centre of mass of a link is at half its length, and the next hinge at its end.
    let along = |length: Expr| [0.into(), 0.into(), -length];
    let mut last: Option<Frame> = None;
    for i in 1..=n {
        let axis = if i % 2 == 1 { [0, 1, 0] } else { [1, 0, 0] };
        let hinge = Joint::continuous(&format!("hinge[{i}]"), axis)
            .moves(&format!("link[{i}]"))
            .damping(0.01);
        let link = chain.joint(match &last {
            Some(before) => hinge.on(before).at(shifted(along(l.clone()))),
            None => hinge,
        });
        chain.body(
            Body::on(&link)
                .mass(&m)
                .com(along(&l / 2))
                .inertia_about_com(&inertia),
        );
        last = Some(link);
    }
    chain.start("hinge[1]", 0.4);
    if let Some(link) = last {
        let end = Expr::from(along(l));
        chain.output(
            "tip",
            hamel_codegen::scene::call("position", [link.pose(), end]),
        );
    }
    chain.build()
}
