//! What the equations of a system are made of, as far as methods of integration ask.

use std::fmt;

/// The structure of a system, decided by algebra for all values of its parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Structure {
    /// Whether it is a product of torque-free rotors and uniform motions, kicked by forces that do
    /// not depend on velocities.
    pub split: Result<Splitting, Vec<Reason>>,
    /// Whether it has momenta p = M ξ of its own, KR18 (30a).
    pub canonical: Result<(), Reason>,
    /// The coordinates on which the mass matrix M(x) in the velocities ξ depends; none where it is
    /// constant.
    pub mass: Vec<String>,
    /// What makes forces depend on velocities; nothing where they do not.
    pub damped: Vec<Reason>,
    /// Whether all forces have a potential: nothing is applied, nothing dissipated.
    pub conservative: bool,
    /// Whether constraints are kept by multipliers, and drift is projected away after every step.
    pub multipliers: bool,
}

/// A system that splits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Splitting {
    /// One rotor for every quaternion and rotation, in their order.
    pub rotors: Vec<RotorForm>,
    /// Whether no force acts, whatever the inputs.
    pub free: bool,
}

/// What is known of a rotor whatever the parameters are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RotorForm {
    /// The coordinate that it is the attitude of.
    pub name: String,
    /// Its inertia J in body axes, about the centre of mass or the fixed point.
    pub inertia: Inertia,
    /// Whether the torque on it, about that point, changes with the configuration.
    pub steered: bool,
}

/// The form of an inertia.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inertia {
    /// Diagonal, the equality of moments known.
    Principal(Symmetry),
    /// Diagonal, three numbers that parameters decide.
    Moments,
    /// A full matrix.
    General,
}

/// How principal moments are equal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// All three.
    Spherical,
    /// The two beside this axis (0, 1, 2).
    Axial(usize),
    /// No two.
    None,
}

impl Inertia {
    /// Numbers that `rotor_inertia` gives for it: J₁, J₂, J₃, or J by rows.
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

/// Why equations of motion do not split; each is a sentence that names what stands in the way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// Constraints on velocities.
    Constrained {
        /// What they are: "`inactive` velocities", ….
        by: String,
    },
    /// The equations depend on the time.
    Time,
    /// There are states of first order, which are no momenta.
    States,
    /// Coordinates that the description ties to one another, or fewer velocities than directions.
    Tied {
        /// Dimension of the coordinates' kinds.
        directions: usize,
        /// n.
        velocities: usize,
    },
    /// ξ does not measure ẋ alike everywhere: the determinant of the map changes with x.
    Rates,
    /// M in the rates of the coordinates changes with these.
    Mass {
        /// Coordinates.
        on: Vec<String>,
    },
    /// A rotor and another coordinate that exchange momentum without any force.
    Coupled {
        /// The rotor.
        rotor: String,
        /// The other one.
        other: String,
    },
    /// Something makes forces depend on velocities.
    Velocities {
        /// What does: "a damper", ….
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
    /// What people read of it, a line for each fact.
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

    /// Which methods fit, for the documentation of a generated type.
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

/// "`a`, `b` and `c`".
pub fn list(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
