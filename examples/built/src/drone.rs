//! A drone: forces of four rotors along its axis, air drag, and the readings of its sensors.

use hamel_codegen::scene::{
    Body, CoordKind, Expr, Load, Scene, SceneError, ShapeKind, WORLD, call, diagonal, pose,
};

/// Builds the drone of `tests/models/drone.eom`.
pub fn drone() -> Result<Scene, SceneError> {
    let mut drone = Scene::builder("Drone");
    drone.doc(
        "A drone: four rotors' forces along its axis, drag of the air, and the signals of its sensors.",
    );
    let m = drone.param("m", 1.1);
    let g = drone.param("g", 9.81);
    let a = drone.param("a", 0.2);
    let kappa = drone.param("kappa", 0.02);
    let d = drone.param("d", 0.15);
    let vector = ShapeKind::Vector(3);
    // The centre of mass, the inertia about it, and the position of the sensors, in body axes.
    let s = drone.param_of("s", vector, [0.01, 0.0, -0.03]);
    let theta = drone.param_of(
        "Theta",
        ShapeKind::Symmetric(3),
        diagonal([0.012, 0.014, 0.021]),
    );
    let p = drone.param_of("p", vector, [0.04, -0.02, 0.05]);

    let r = drone.coordinate("r", CoordKind::Euclidean(3));
    let rotation = drone.coordinate("R", CoordKind::SO3);
    let v = drone.velocity("v", vector);
    let w = drone.velocity("w", vector);
    drone.rate("r", &rotation * v);
    drone.rate("R", &rotation * call("hat", [w]));

    let hull = drone.frame("hull", WORLD, pose(rotation, r));
    drone.body(Body::on(&hull).mass(m).com(&s).inertia_about_com(theta));
    drone.gravity([0.into(), 0.into(), -&g]);

    // The rotors are ahead, to the left, behind and to the right; neighbours turn in opposite directions.
    let f = drone.input_of("f", ShapeKind::Vector(4));
    let zero = || Expr::from(0);
    let places = [
        [a.clone(), zero(), zero()],
        [zero(), a.clone(), zero()],
        [-&a, zero(), zero()],
        [zero(), -&a, zero()],
    ];
    for (i, place) in (1..).zip(places) {
        drone.load(Load::force([zero(), zero(), f.entry(i)], &hull).at(place));
    }
    let turning = f.entry(1) - f.entry(2) + f.entry(3) - f.entry(4);
    drone.load(Load::torque([zero(), zero(), kappa * turning], &hull).in_axes_of(&hull));

    let speed = drone.define("speed", call("velocity", [hull.pose(), s.clone()]));
    drone.load(Load::force(-d * &speed, &hull).at(s).in_axes_of(WORLD));

    drone.output("place", call("position", [hull.pose(), p.clone()]));
    drone.output("ground_speed", &speed);
    let to_hull = || hull.pose().part("R").part("T");
    let weight = Expr::from([zero(), zero(), g]);
    drone.output(
        "accelerometer",
        to_hull() * call("acceleration", [hull.pose(), p]) + to_hull() * weight,
    );
    drone.output(
        "turning",
        to_hull() * call("angular_acceleration", [hull.pose()]),
    );
    drone.start("w", [0.2, -0.1, 0.3]);
    drone.start("v", [1.0, 0.0, -0.5]);
    drone.build()
}
