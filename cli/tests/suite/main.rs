//! Integration tests of the command; run a single module with `cargo test -p hamel-cli --test suite sweep::`.

mod available;
#[cfg(target_os = "linux")]
mod c;
mod cli;
mod clock;
mod common;
mod compare;
mod control;
mod counts;
#[path = "common/described.rs"]
mod described;
mod dialects;
mod draw;
mod drawing;
mod emitted;
mod every;
#[cfg(target_os = "linux")]
mod files;
mod first_run;
mod given;
mod identified;
mod inputs;
#[path = "common/installed.rs"]
mod installed;
mod kept;
mod linear;
mod linearize;
mod massless;
mod methods;
mod misspelt;
#[path = "../../../lab/common/src/pinocchio.rs"]
mod pinocchio;
mod redundant;
mod regressor;
mod report;
mod robots;
mod sampling;
mod shaken;
#[path = "common/shards.rs"]
mod shards;
mod shown;
mod states;
mod steady;
mod sweep;
#[cfg(target_os = "linux")]
mod sweep_folder;
mod sweep_runs;
#[cfg(unix)]
mod sweep_submit;
#[path = "common/swept.rs"]
mod swept;
#[path = "common/table.rs"]
mod table;
mod trim;
#[path = "../../../lab/common/src/undamped.rs"]
mod undamped;
mod urdf;
mod warnings;
