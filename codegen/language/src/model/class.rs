//! Classes of symbols, one bit each: what the value of an expression depends on is the union of their bits.

/// Run-time parameters: constant while the system moves.
pub const PARAM: u8 = 1;
/// Configuration coordinates x.
pub const COORD: u8 = 2;
/// Velocity coordinates ξ.
pub const VELOCITY: u8 = 4;
/// Inputs u, and first-order states z: forces may depend on both, but the motion does not change them by itself.
pub const INPUT: u8 = 8;
/// Accelerations ξ̇, the argument of inverse dynamics.
pub const ACCEL: u8 = 16;
/// Momenta p, arguments of the functions of momenta.
pub const MOMENTUM: u8 = 32;
/// The time, which is a coordinate, too.
pub const TIME: u8 = 64;
/// Coordinates and time, which determine the configuration.
pub const CONFIGURATION: u8 = COORD | TIME;
/// Rates ẋ, used while definitions of velocities are read; never in a model's graph.
pub const RATE: u8 = 128;
