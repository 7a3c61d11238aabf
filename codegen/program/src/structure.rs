//! Structure of the equations of motion: the properties that decide which integration methods apply.

use std::fmt;

/// Structure of a system, decided by algebra for all values of its parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Structure {
    /// Whether the system is a product of torque-free rotors and uniform motions, kicked by forces that do
    /// not depend on velocities; otherwise the reasons why it is not.
    pub split: Result<Splitting, Vec<Reason>>,
    /// Whether the velocities have conjugate momenta p = M ξ, KR18 (30a); otherwise the reason why not.
    pub canonical: Result<(), Reason>,
    /// Coordinates on which the mass matrix M(x) in the velocities ξ depends; empty if it is constant.
    pub mass: Vec<String>,
    /// Reasons why forces depend on velocities; empty if they do not.
    pub damped: Vec<Reason>,
    /// Whether all forces have a potential: no loads are applied, and nothing dissipates.
    pub conservative: bool,
    /// Whether constraints are kept by multipliers, so that drift is projected away after every step.
    pub multipliers: bool,
}

/// Properties of a system that splits into free motion and kicks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Splitting {
    /// Rotors, one for every quaternion and rotation matrix, in their order.
    pub rotors: Vec<RotorForm>,
    /// Whether no force acts, for any input.
    pub free: bool,
}

/// Properties of a rotor that hold for all parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RotorForm {
    /// Coordinate that describes the attitude of the rotor.
    pub name: String,
    /// Form of the inertia J in body axes, about the centre of mass or the fixed point.
    pub inertia: Inertia,
    /// Whether the torque on the rotor, about that point, changes with the configuration.
    pub steered: bool,
}

/// Form of an inertia matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inertia {
    /// Diagonal; it is known which moments are equal.
    Principal(Symmetry),
    /// Diagonal; parameters decide which moments are equal.
    Moments,
    /// A full matrix.
    General,
}

/// Equalities among principal moments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// All three are equal.
    Spherical,
    /// The two moments about the axes other than this one (0, 1, 2) are equal.
    Axial(usize),
    /// No two are equal.
    None,
}

impl Inertia {
    /// Returns how many numbers `rotor_inertia` gives for this form: J₁, J₂, J₃, or J by rows.
    pub fn entries(self) -> usize {
        match self {
            Inertia::Principal(_) | Inertia::Moments => 3,
            Inertia::General => 9,
        }
    }
}

impl fmt::Display for Inertia {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Inertia::Principal(Symmetry::Spherical) => f.write_str("spherical inertia"),
            Inertia::Principal(Symmetry::Axial(axis)) => {
                write!(f, "inertia symmetric about body axis {}", axis + 1)
            }
            Inertia::Principal(Symmetry::None) => f.write_str("three different principal moments"),
            Inertia::Moments => f.write_str("principal moments given by parameters"),
            Inertia::General => f.write_str("a full inertia matrix"),
        }
    }
}

/// Reason why the equations of motion do not split; displayed as a clause that names the obstacle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The velocities are constrained.
    Constrained {
        /// Kind of the constraints: "`inactive` velocities", ….
        by: String,
    },
    /// The equations depend on time.
    Time,
    /// There are states of first order, which are not momenta.
    States,
    /// The description ties coordinates to one another, or there are fewer velocities than directions of motion.
    Tied {
        /// Sum of the dimensions of the coordinates' kinds.
        directions: usize,
        /// Number n of velocities.
        velocities: usize,
    },
    /// The determinant of the map between ẋ and ξ changes with x.
    Rates,
    /// The mass matrix in the rates of the coordinates changes with these coordinates.
    Mass {
        /// Coordinates on which it depends; empty if the mass matrix is singular.
        on: Vec<String>,
    },
    /// A rotor exchanges momentum with another coordinate without any force.
    Coupled {
        /// Rotor.
        rotor: String,
        /// Other coordinate.
        other: String,
    },
    /// Forces depend on velocities.
    Velocities {
        /// Cause of the dependence: "a damper", ….
        what: String,
    },
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reason::Time => f.write_str("the equations depend on the time"),
            Reason::States => f.write_str("there are states of first order"),
            Reason::Constrained { by } => write!(f, "velocities are constrained by {by}"),
            Reason::Tied {
                directions,
                velocities,
            } => write!(
                f,
                "the coordinates are tied to one another: their kinds have {directions} directions of motion, the system {velocities}"
            ),
            Reason::Rates => f.write_str(
                "the velocities measure the rates of the coordinates by a determinant that changes with x",
            ),
            Reason::Mass { on } if on.is_empty() => f.write_str("the mass matrix is singular"),
            Reason::Mass { on } => write!(
                f,
                "the mass matrix in the rates of the coordinates depends on {}",
                list(on)
            ),
            Reason::Coupled { rotor, other } => write!(
                f,
                "inertia couples the rotation `{rotor}` with `{other}`"
            ),
            Reason::Velocities { what } => write!(f, "{what} makes forces depend on velocities"),
        }
    }
}

impl Structure {
    /// Describes the structure for people, one line per fact.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        match &self.split {
            Ok(splitting) => {
                let what = if splitting.free {
                    "free: no force acts, the motion has a closed form"
                } else {
                    "splits into free motion and kicks that do not depend on velocities"
                };
                lines.push(what.to_string());
                let rotors = splitting.rotors.iter();
                lines.extend(
                    rotors.map(|rotor| format!("rotor `{}`: {}", rotor.name, rotor.inertia)),
                );
            }
            Err(reasons) => lines.extend(
                reasons
                    .iter()
                    .map(|reason| format!("does not split: {reason}")),
            ),
        }
        lines.push(match self.mass.as_slice() {
            [] => "mass matrix constant".into(),
            names => format!("mass matrix depends on {}", list(names)),
        });
        lines
    }

    /// Describes which integration methods fit, for the documentation of a generated type.
    pub fn documentation(&self) -> Vec<String> {
        let mut lines = vec!["Works with all general-purpose integrators.".to_string()];
        match &self.split {
            Ok(splitting) => {
                if splitting.free {
                    lines.push("No force acts: the motion has a closed form (`Free`).".into());
                }
                lines.push("It splits into free motion and kicks (`hamel::Split`).".into());
                for rotor in &splitting.rotors {
                    lines.push(format!("Its rotor `{}` has {}.", rotor.name, rotor.inertia));
                }
            }
            Err(reasons) => lines.extend(
                reasons
                    .iter()
                    .map(|reason| format!("It does not split: {reason}.")),
            ),
        }
        lines
    }
}

/// Joins names as "`a`, `b` and `c`".
pub fn list(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
