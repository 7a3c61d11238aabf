//! The description of a robot with four legs.

/// A floating trunk with four legs of three hinges each, mounted at odd angles, with a torque at each hinge. The
/// description requests slopes.
pub fn quadruped() -> String {
    let legs = ["lf", "rf", "lh", "rh"];
    let joints = legs.map(|leg| ["hip", "thigh", "shank"].map(|part| format!("{leg}_{part}")));
    let torques: Vec<String> = joints
        .iter()
        .flatten()
        .map(|joint| format!("{joint}_torque"))
        .collect();
    let mut text = format!(
        "/// A trunk with four legs.\npub system Quadruped {{\n    gravity [0, 0, -9.81];\n    input {};\n    \
         joint base: free moves trunk;\n    \
         body on trunk {{ mass 12; com [0.02, -0.01, 0.03]; inertia diag(0.2, 0.5, 0.6) about com; }}\n",
        torques.join(", ")
    );
    for (number, leg) in joints.iter().enumerate() {
        let forward = if number < 2 { 1.0 } else { -1.0 };
        let left = if number % 2 == 0 { 1.0 } else { -1.0 };
        let mount = |roll: f64, place: [f64; 3]| format!("pose(rpy({roll}, 0.1, 0.2), {place:?})");
        let hinges = [
            (
                "trunk",
                "[1, 0, 0]",
                mount(0.3 * left, [0.3 * forward, 0.1 * left, 0.01]),
            ),
            (
                leg[0].as_str(),
                "[0, 1, 0]",
                mount(-0.2, [0.01, 0.08 * left, -0.02]),
            ),
            (
                leg[1].as_str(),
                "[0, 1, 0]",
                mount(0.1 * forward, [0.0, 0.02 * left, -0.25]),
            ),
        ];
        for (joint, (parent, axis, mount)) in leg.iter().zip(hinges) {
            text += &format!(
                "    joint q_{joint}: revolute {axis} on {parent} at {mount} moves {joint} {{ force {joint}_torque; }}\n    \
                 body on {joint} {{ mass 0.8; com [0.01, 0.02, -0.1]; inertia diag(0.003, 0.004, 0.002) about com; }}\n"
            );
        }
    }
    text + "    generate all, linearize;\n}\n"
}
