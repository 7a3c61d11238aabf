//! Robots in URDF: an imported robot is derived, and errors point to their origin.

use hamel_codegen::generate::from_text;
use hamel_codegen::urdf::{Options, import, refused};

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

#[test]
fn what_is_imported_is_derived() {
    let text = ARM.replace("MASS", "2");
    let imported = import(&text, &Options::default(), "arm.urdf", false).expect("a robot");
    from_text(&imported.text).expect("a description");
}

#[test]
fn errors_about_the_description_are_shown_in_the_urdf() {
    let text = ARM.replace("MASS", "2");
    let mut imported = import(&text, &Options::default(), "arm.urdf", false).expect("a robot");
    imported.text = imported.text.replace("mass 2;", "mass heavy;");
    let errors = from_text(&imported.text).expect_err("`heavy` is nothing");
    let shown = refused(&errors, &imported, "arm.urdf", &text, false);
    assert!(
        shown.contains("arm.urdf:7:") && shown.contains("mass heavy;"),
        "{shown}"
    );
    // The gravity does not come from a line of the URDF.
    imported.text = imported.text.replace("-9.81", "-g");
    let errors = from_text(&imported.text).expect_err("`g` is nothing");
    let shown = refused(&errors, &imported, "arm.urdf", &text, false);
    assert!(shown.contains("arm.urdf, as a description:"), "{shown}");
}
