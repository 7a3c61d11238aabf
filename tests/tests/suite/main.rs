//! Generated systems against physics, and the generator against its own laws; a module alone: `cargo test -p hamel-tests --test suite checks::`.

mod adviser;
mod broken_symbols;
mod checks;
mod circles;
mod derived;
mod described;
mod doors;
mod externals;
mod functions;
mod invariants;
mod lanes;
mod linear_differences;
mod linearization;
mod loads;
mod methods;
#[path = "../../../codegen/tests/suite/common/models.rs"]
mod models;
mod mutations;
mod observed;
mod physics_closed_forms;
mod physics_constraints;
mod physics_errors;
mod physics_flight;
mod physics_frames;
mod physics_functions;
mod physics_geometry;
mod physics_kinematics;
mod physics_laws;
mod physics_loads;
mod physics_long;
mod pivots;
mod public_api;
mod redundant;
mod references;
#[path = "../../../codegen/tests/suite/common/size.rs"]
mod size;
mod snapshots;
#[path = "../../../codegen/tests/suite/common/some.rs"]
mod some;
mod states;
mod step_slopes;
mod structure;
mod tables;
mod time;
mod trace;
mod twins;
mod views;
mod warnings;
