//! Robots in URDF: an imported robot is derived, and errors point to their origin.

use hamel_codegen::generate::{Generated, available_in, from_text};
use hamel_codegen::syntax::ast::{Expr, ExprKind, ItemKind};
use hamel_codegen::urdf::{Imported, Options, import, refused};

const ARM: &str = r#"<robot name="arm">
  <link name="base"/>
  <joint name="hinge" type="revolute">
    <parent link="base"/> <child link="rod"/> <axis xyz="0 1 0"/>
  </joint>
  <link name="rod">
    <inertial>
      <mass value="MASS"/>
      <inertia ixx="0.2" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.01"/>
    </inertial>
  </link>
</robot>"#;

fn imported() -> (String, Imported) {
    let text = ARM.replace("MASS", "2");
    let imported = import(&text, &Options::default()).expect("a robot");
    (text, imported)
}

/// The printed description gives the same program, with the same hash, as the robot itself.
#[test]
fn a_robot_and_its_text_are_derived_alike() {
    let (_, imported) = imported();
    let (of_robot, left_out) = available_in(&imported.system).expect("a program");
    assert!(left_out.is_none());
    let of_text = from_text(&imported.text()).expect("a program");
    assert_eq!(of_robot.hash, of_text.hash);
    let names = |of: &Generated| -> Vec<String> {
        let functions = of.program.functions.iter();
        functions.map(|function| function.name.clone()).collect()
    };
    assert_eq!(names(&of_robot), names(&of_text));
}

/// Errors about a statement, and about what is derived, are shown in the URDF.
#[test]
fn errors_about_the_description_are_shown_in_the_urdf() {
    let (text, robot) = imported();
    let shown = |wrong: &dyn Fn(&mut ItemKind)| {
        let mut system = robot.system.clone();
        system
            .items
            .iter_mut()
            .for_each(|item| wrong(&mut item.kind));
        let errors = available_in(&system).expect_err("it is wrong");
        refused(&errors, "arm.urdf", &text, false)
    };
    insta::assert_snapshot!(shown(&|kind| if let ItemKind::Body(body) = kind {
        body.mass = Some(renamed(body.mass.take(), "heavy"));
    }), @r#"
    error: nothing is called `heavy`
     --> arm.urdf:7:5
      |
    7 |     <inertial>
      |     ^^^^^^^^^
      |
      = help: known here: `hinge`, `hinge_dot`, `hinge_tau`, `rod`
      = help: the description made from it contains `body on rod { mass 2; inertia diag(0.2, 0.2, 0.01) about com; }`

    1 error
    "#);
    insta::assert_snapshot!(shown(&|kind| if let ItemKind::Gravity(gravity) = kind {
        *gravity = renamed(Some(gravity.clone()), "g");
    }), @r#"
    error: nothing is called `g`
     --> arm.urdf:1:14
      |
    1 | <robot name="arm">
      |              ^^^
      |
      = help: known here: `hinge`, `hinge_dot`, `hinge_tau`, `rod`
      = help: the description made from it contains `gravity [0, 0, -9.81];`

    1 error
    "#);
    insta::assert_snapshot!(shown(&|kind| if let ItemKind::Body(body) = kind {
        body.mass = None;
        body.inertia = None;
    }), @r#"
    error: this body has no mass
     --> arm.urdf:7:5
      |
    7 |     <inertial>
      |     ^^^^^^^^^
      |
      = help: write `mass m;` between its braces
      = help: the description made from it contains `body on rod { mass 2; inertia diag(0.2, 0.2, 0.01) about com; }`

    1 error
    "#);
}

/// An unknown name in place of an expression.
fn renamed(expr: Option<Expr>, name: &str) -> Expr {
    let span = expr.expect("an expression").span;
    let kind = ExprKind::Name(name.to_string());
    Expr { kind, span }
}
