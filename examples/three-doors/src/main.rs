//! One mechanism through two of the three front ends: the macro and the build script generate the same functions. The
//! third front end is the command line: `hamel emit examples/three-doors/pendulum.eom`.

use hamel::methods::Rkmk4;
use hamel::{Monitor, Run, State};

/// The code written by the build script.
mod built {
    include!(concat!(env!("OUT_DIR"), "/pendulum.rs"));
}

/// The expansion of the macro.
mod expanded {
    hamel::rigid_eom! {
        /// A spherical pendulum.
        pub system Pendulum {
            param m = 1, l = 0.8, J = 0.001, g = 9.81;
            coord R: SO3;
            velocity w: vec3;
            rate R = R * hat(w);
            frame rod = pose(R, [0, 0, 0]);
            body on rod { mass m; com [0, 0, -l]; inertia diag(J, J, J) about com; }
            gravity [0, 0, -g];
            start R = rotx(0.5);
            start w = [0, 1, 0];
            output bob = rod * [0, 0, -l];
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (built, expanded) = (
        built::Pendulum::<f64>::default(),
        expanded::Pendulum::<f64>::default(),
    );
    let state = State::start(&built);
    println!(
        "ξ̇ of the built one    {:?}",
        built.accel(&state.x, &state.xi, &[])?
    );
    println!(
        "ξ̇ of the expanded one {:?}",
        expanded.accel(&state.x, &state.xi, &[])?
    );

    let mut monitor = Monitor::new(&built, &state);
    let end = Run::new(&built)
        .method(Rkmk4)
        .step(1e-3)
        .observe(|state| monitor.observe(&built, state))
        .until(10.0)?;
    println!("after {} s the mass is at {:?}", end.t, built.bob(&end.x));
    println!("energy kept to {:.1e}", monitor.relative_energy_deviation());
    Ok(())
}
