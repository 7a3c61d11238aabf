//! Methods by their names on the command line, and their requirements.

use crate::baselines::{BaselineMethod, Buss, Slide};
use crate::error::Error;
use crate::mechanism::{Instance, Numbers};
use hamel::flows::Flow;
use hamel::methods::{Gauss4, Gauss6, General, Lgvi, Method, Scheme, Splitting};
use hamel::{Canonical, Energies, Split, State, StepError, System};
use hamel_codegen::derive::structure::choice::choose_method;
use hamel_codegen::program::structure::Structure;
use hamel_files::number::short;

/// Name that leaves the choice to the structure of the system.
pub const AUTO: &str = "auto";

/// Requirements of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Requirement {
    /// Nothing beyond ξ̇.
    Any,
    /// Generalised momenta.
    Momenta,
    /// Free motion in closed form, and kicks.
    Split,
    /// Free motion in closed form, without kicks.
    Free,
}

/// Whether a method is recommended for use, or is a simple or known one, such as `euler`, that comparisons list to show
/// what the others gain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MethodCategory {
    /// One to be used.
    Method,
    /// One that shows what others gain.
    Baseline,
}

/// A row of the table of methods.
struct MethodEntry {
    name: &'static str,
    role: MethodCategory,
    about: &'static str,
    needs: Requirement,
    make: fn(&Instance) -> Stepper,
}

macro_rules! entries {
    ($($name:literal $role:ident $needs:ident $make:expr, $about:literal;)*) => {
        &[$(MethodEntry { name: $name, role: MethodCategory::$role, about: $about, needs: Requirement::$needs, make: $make }),*]
    };
}

fn split(system: &Instance, scheme: Scheme) -> Stepper {
    Stepper::Splitting(Splitting::new(system, scheme))
}

/// The table of methods.
const METHODS: &[MethodEntry] = entries! {
    "rkmk4" Method Any |_| Stepper::General(General::Rkmk4), "any system; order 4, on the manifold";
    "cf4" Method Any |_| Stepper::General(General::Cf4), "any system; order 4, without commutators";
    "rkmk54" Method Any |_| Stepper::General(General::Rkmk54), "any system; order 5, or steps by --tol";
    "rkmk8" Method Any |_| Stepper::General(General::Rkmk8), "any system; order 8, or steps by --tol";
    "splitting" Method Split |s| split(s, Scheme::Nystrom4), "bodies in potentials; order 4, no drift";
    "splitting2" Method Split |s| split(s, Scheme::Strang), "the same; order 2";
    "splitting6" Method Split |s| split(s, Scheme::Nystrom6), "the same; order 6";
    "suzuki" Method Split |s| split(s, Scheme::Suzuki4), "the same; order 4, of steps of order 2";
    "kahan-li" Method Split |s| split(s, Scheme::KahanLi6), "the same; order 6, of steps of order 2";
    "kahan-li8" Method Split |s| split(s, Scheme::KahanLi8), "the same; order 8, of steps of order 2";
    "free" Method Free Stepper::closed_form, "bodies without forces; exact at any time";
    "lgvi" Method Split |_| Stepper::Lgvi, "bodies in potentials; variational, order 2";
    "gauss4" Method Momenta |_| Stepper::Gauss4, "long runs where M depends on x; implicit, order 4, no drift";
    "gauss6" Method Momenta |_| Stepper::Gauss6, "the same; order 6";
    "euler" Baseline Any |_| Stepper::Baseline(BaselineMethod::ForwardEuler), "baseline; order 1";
    "backward-euler" Baseline Any |_| Stepper::General(General::BackwardEuler), "stiff systems; implicit, order 1";
    "semi-implicit-euler" Baseline Any |_| Stepper::General(General::SemiImplicitEuler), "baseline; order 1, as in game engines";
    "rk4" Baseline Any |_| Stepper::General(General::Rk4 { lambda: 0.0 }), "baseline; order 4 on the coordinates, stabilized at the rate --lambda";
    "rk4-projected" Baseline Any |_| Stepper::Baseline(BaselineMethod::Rk4Projected), "baseline; the same, projected after each step";
    "slide" Baseline Split |_| Stepper::Slide, "baseline; order 1, keeps angular momentum";
    "buss1" Baseline Split |_| Stepper::Buss(Buss::First), "baseline; order 1, keeps angular momentum";
    "buss2" Baseline Split |_| Stepper::Buss(Buss::Second), "baseline; the same, order 2";
    "buss-augmented2" Baseline Split |_| Stepper::Buss(Buss::AugmentedSecond), "baseline; the same, order 2";
    "buss4" Baseline Split |_| Stepper::Buss(Buss::Fourth), "baseline; the same, order 4 without torques";
};

/// Returns all values of `--method`.
pub fn names() -> Vec<&'static str> {
    let all = METHODS.iter().map(|entry| entry.name);
    std::iter::once(AUTO).chain(all).collect()
}

/// Returns a line for each method, with its name and purpose.
pub fn descriptions() -> String {
    let width = METHODS.iter().map(|entry| entry.name.len()).max();
    let width = width.unwrap_or(0);
    let lines = METHODS
        .iter()
        .map(|entry| format!("  {:width$}  {}\n", entry.name, entry.about));
    format!("Methods:\n  {AUTO:width$}  what fits the system, with the reason\n")
        + &lines.collect::<String>()
}

/// Method for one system, with the reason if `auto` chose it.
#[derive(Clone, Debug)]
pub struct ChosenMethod {
    /// Name.
    pub name: &'static str,
    /// The method.
    pub stepper: Stepper,
    /// The reason of `auto`.
    pub reason: Option<&'static str>,
}

impl ChosenMethod {
    /// Chooses the method of this name for a run of about `steps` steps. Fails, with reasons from the system's
    /// structure, if it does not fit.
    pub fn new(
        name: &str,
        system: &Instance,
        structure: &Structure,
        steps: u64,
    ) -> Result<Self, Error> {
        let (name, reason) = match name {
            AUTO => {
                let choice = choose_method(structure, Some(steps));
                (choice.method, Some(choice.reason))
            }
            name => (name, None),
        };
        let Some(entry) = METHODS.iter().find(|entry| entry.name == name) else {
            return Err(Error::UnknownMethod { name: name.into() });
        };
        let obstacles = entry.needs.obstacles(structure);
        if !obstacles.is_empty() {
            return Err(Error::Method {
                name: name.into(),
                obstacles,
            });
        }
        Ok(ChosenMethod {
            name: entry.name,
            stepper: (entry.make)(system),
            reason,
        })
    }

    /// Adapts the method to another system of the same structure: with other parameters or another start.
    pub fn adapt(&self, system: &Instance) -> Self {
        let entry = METHODS.iter().find(|entry| entry.name == self.name);
        let stepper = match (&self.stepper, entry) {
            // Keep settings other than the name.
            (Stepper::General(_) | Stepper::Baseline(_), _) | (_, None) => self.stepper.clone(),
            (_, Some(entry)) => (entry.make)(system),
        };
        ChosenMethod {
            stepper,
            ..self.clone()
        }
    }
}

/// Method of a comparison.
#[derive(Clone, Debug)]
pub struct NamedMethod {
    /// Name.
    pub name: &'static str,
    /// Its role in a comparison.
    pub role: MethodCategory,
    /// The method.
    pub stepper: Stepper,
}

/// Method that does not fit a system, with the reasons.
#[derive(Clone, Debug)]
pub struct UnsuitableMethod {
    /// Name.
    pub name: &'static str,
    /// The unmet requirements.
    pub obstacles: Vec<String>,
}

/// Sorts the methods with these names, or all, into those that fit a system and those that do not, with the reasons.
pub fn suitable(
    names: &[String],
    system: &Instance,
    structure: &Structure,
) -> (Vec<NamedMethod>, Vec<UnsuitableMethod>) {
    let (mut fit, mut missing) = (Vec::new(), Vec::new());
    for entry in METHODS {
        let asked = names.iter().any(|name| name.trim() == entry.name);
        if !names.is_empty() && !asked {
            continue;
        }
        let obstacles = entry.needs.obstacles(structure);
        if obstacles.is_empty() {
            fit.push(NamedMethod {
                name: entry.name,
                role: entry.role,
                stepper: (entry.make)(system),
            });
        } else if asked {
            missing.push(UnsuitableMethod {
                name: entry.name,
                obstacles,
            });
        }
    }
    (fit, missing)
}

/// Checks that all names are names of methods.
pub fn check_names(names: &[String]) -> Result<(), Error> {
    let unknown = |name: &&String| METHODS.iter().all(|entry| entry.name != name.trim());
    match names.iter().find(unknown) {
        Some(name) => Err(Error::UnknownMethod {
            name: name.trim().into(),
        }),
        None => Ok(()),
    }
}

/// Returns the methods whose steps can be differentiated by state and inputs: those for any system that stay in a
/// chart.
pub fn with_step_slopes() -> impl Iterator<Item = General> {
    let all = General::ALL.iter().copied();
    all.filter(|method| !matches!(method, General::Rk4 { .. }))
}

impl Requirement {
    /// Returns the unmet requirements.
    fn obstacles(self, structure: &Structure) -> Vec<String> {
        match (self, &structure.split) {
            (Requirement::Any, _) => Vec::new(),
            (Requirement::Momenta, _) => {
                let reason = structure.canonical.as_ref().err();
                reason.map(ToString::to_string).into_iter().collect()
            }
            (Requirement::Split | Requirement::Free, Err(reasons)) => {
                reasons.iter().map(ToString::to_string).collect()
            }
            (Requirement::Free, Ok(splitting)) if !splitting.free => {
                vec!["forces act on the system".into()]
            }
            (Requirement::Split | Requirement::Free, Ok(_)) => Vec::new(),
        }
    }
}

/// Method of any kind, as one type that steps mechanisms.
#[derive(Clone, Debug)]
pub enum Stepper {
    /// A method for any system.
    General(General),
    /// A baseline for any system.
    Baseline(BaselineMethod),
    /// Kicks between free motions.
    Splitting(Splitting),
    /// The free motion from the start, without accumulated errors.
    Closed {
        /// Time, x and ξ of the start.
        start: Box<(Numbers, Numbers)>,
        /// One free motion, whose kicks are zero.
        motion: Splitting,
    },
    /// Variational integrator.
    Lgvi,
    /// Collocation of order 4.
    Gauss4,
    /// Collocation of order 6.
    Gauss6,
    /// Angular momentum of first order.
    Slide,
    /// The methods of Buss.
    Buss(Buss),
}

impl Stepper {
    fn closed_form(system: &Instance) -> Self {
        Stepper::Closed {
            start: Box::new(system.start()),
            motion: Splitting::with_flow(system, Scheme::Strang, Flow::Exact),
        }
    }

    /// Returns the function whose evaluations are counted.
    pub fn evaluated(&self) -> &'static str {
        match self {
            Stepper::General(_) | Stepper::Baseline(_) => "the acceleration",
            Stepper::Gauss4 | Stepper::Gauss6 => "the rates of momenta",
            _ => "the forces",
        }
    }

    /// Returns the text that follows the method's name in a summary: `, lambda 5` for `rk4`, empty for others.
    pub fn settings(&self) -> String {
        match self {
            Stepper::General(General::Rk4 { lambda }) => format!(", lambda {}", short(*lambda)),
            _ => String::new(),
        }
    }
}

impl<Sys> Method<Sys> for Stepper
where
    Sys: Split<Scalar = f64, Coordinates = Numbers, Velocities = Numbers> + Canonical + Energies,
{
    fn order(&self) -> u32 {
        match self {
            Stepper::General(method) => Method::<Sys>::order(method),
            Stepper::Baseline(method) => Method::<Sys>::order(method),
            Stepper::Splitting(method) => Method::<Sys>::order(method),
            Stepper::Closed { .. } => 0,
            Stepper::Lgvi => Method::<Sys>::order(&Lgvi),
            Stepper::Gauss4 => Method::<Sys>::order(&Gauss4),
            Stepper::Gauss6 => Method::<Sys>::order(&Gauss6),
            Stepper::Slide => Method::<Sys>::order(&Slide),
            Stepper::Buss(method) => Method::<Sys>::order(method),
        }
    }

    fn preserves_constraints(&self) -> bool {
        match self {
            Stepper::General(method) => Method::<Sys>::preserves_constraints(method),
            Stepper::Slide | Stepper::Buss(_) => false,
            _ => true,
        }
    }

    fn step<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Numbers, &Numbers) -> Sys::Inputs,
    {
        self.take_step(system, state, h, inputs)
    }

    fn step_reusing_force<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
        force: &mut Option<Sys::Chart>,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Numbers, &Numbers) -> Sys::Inputs,
    {
        self.take_step_reusing_force(system, state, h, inputs, force)
    }
}

/// Type of the inputs that methods take. Every method is compiled for this one type, no matter how a run
/// computes its inputs.
pub type InputFunction<'a, Sys> = &'a dyn Fn(f64, &Numbers, &Numbers) -> <Sys as System>::Inputs;

impl Stepper {
    fn take_step<Sys>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: InputFunction<Sys>,
    ) -> Result<State<Sys>, StepError>
    where
        Sys:
            Split<Scalar = f64, Coordinates = Numbers, Velocities = Numbers> + Canonical + Energies,
    {
        let inputs = &inputs;
        match self {
            Stepper::General(method) => method.step(system, state, h, inputs),
            Stepper::Baseline(method) => method.step(system, state, h, inputs),
            Stepper::Splitting(method) => method.step(system, state, h, inputs),
            Stepper::Closed { start, motion } => {
                let (x, xi) = (**start).clone();
                let start: State<Sys> = State { t: 0.0, x, xi };
                motion.step(system, &start, state.t + h, inputs)
            }
            Stepper::Lgvi => Lgvi.step(system, state, h, inputs),
            Stepper::Gauss4 => Gauss4.step(system, state, h, inputs),
            Stepper::Gauss6 => Gauss6.step(system, state, h, inputs),
            Stepper::Slide => Slide.step(system, state, h, inputs),
            Stepper::Buss(method) => method.step(system, state, h, inputs),
        }
    }

    fn take_step_reusing_force<Sys>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: InputFunction<Sys>,
        force: &mut Option<Sys::Chart>,
    ) -> Result<State<Sys>, StepError>
    where
        Sys:
            Split<Scalar = f64, Coordinates = Numbers, Velocities = Numbers> + Canonical + Energies,
    {
        match self {
            Stepper::Splitting(method) => {
                method.step_reusing_force(system, state, h, &inputs, force)
            }
            Stepper::Lgvi => Lgvi.step_reusing_force(system, state, h, &inputs, force),
            Stepper::Buss(method) => method.step_reusing_force(system, state, h, &inputs, force),
            _ => self.take_step(system, state, h, inputs),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::names;
    use hamel::methods::{General, Scheme};

    #[test]
    fn every_scheme_has_a_name() {
        for scheme in Scheme::ALL {
            assert!(names().contains(&scheme.name()), "{scheme:?}");
        }
    }

    #[test]
    fn every_method_for_any_system_has_a_name() {
        for method in General::ALL {
            assert!(names().contains(&method.name()), "{method:?}");
        }
    }
}
