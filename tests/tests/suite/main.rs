//! Compares generated systems with physics, and checks the generator. To run a single module:
//! `cargo test -p hamel-tests --test suite checks::`.

mod adviser;
mod broken_models;
mod broken_symbols;
mod checks;
mod derived;
mod described;
mod externals;
mod front_ends;
mod functions;
mod import_cycles;
mod invariants;
mod lanes;
mod lengths;
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
mod states;
mod step_slopes;
mod structure;
mod tables;
#[path = "../../../codegen/tests/suite/common/thinning.rs"]
mod thinning;
mod time;
mod trace;
mod views;
mod warnings;
#[path = "../../../codegen/tests/suite/common/wrong_descriptions.rs"]
mod wrong_descriptions;
