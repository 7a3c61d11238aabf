//! The functions that a program can have beside the outputs and invariants of its description: one
//! table of their names, arguments and documentation, of what they serve and of what they need.

use Argument::{Accelerations, Coordinates, Inputs, Momenta, Velocities};

/// What a generated function takes, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Argument {
    /// x, ν numbers.
    Coordinates,
    /// ξ, n numbers.
    Velocities,
    /// ξ̇, n numbers.
    Accelerations,
    /// p, n numbers.
    Momenta,
    /// u.
    Inputs,
}

/// What a function is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Serves {
    /// The trait `System` of the runtime: it comes along with `accel` and `linearize`.
    System,
    /// The trait `Split`: it comes along with `splitting`.
    Split,
    /// The trait `Tangent`: it comes along with `linearize`.
    Tangent,
    /// Users who call it.
    Callers,
    /// Users who ask for it by its name.
    Asked,
}

/// What a function returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Returns {
    /// One number.
    Number,
    /// A vector.
    Vector,
    /// A matrix of n rows, n the number of velocities.
    Rows,
    /// A matrix of the rows of h, of δξ and of δz.
    Linear,
}

/// What a function needs of the inertia of a system, least first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Needs {
    /// None: kinematics, loads, potentials.
    Nothing,
    /// Bodies with mass; M may be singular.
    Inertia,
    /// M⁻¹: M has to be positive definite.
    Inverse,
}

/// One row of the table.
#[derive(Debug)]
pub struct Row {
    /// Its name in descriptions and in Rust.
    pub name: &'static str,
    /// What it takes.
    pub arguments: &'static [Argument],
    /// What it returns.
    pub returns: Returns,
    /// Its documentation, line by line.
    pub docs: &'static [&'static str],
    /// What it is wanted for.
    pub serves: Serves,
    /// Requirement on the inertia of the system.
    pub needs: Needs,
    /// Whether `generate` can name it.
    pub named: bool,
}

macro_rules! table {
    ($($id:ident $name:literal ($($argument:ident),*) $returns:ident $serves:ident $needs:ident $named:literal [$($line:literal),* $(,)?])*) => {
        /// A function that the generator knows.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum FunctionId {
            $(#[doc = concat!("`", $name, "`.")] $id,)*
        }

        impl FunctionId {
            /// All of them, in the order of the table.
            pub const ALL: &'static [FunctionId] = &[$(FunctionId::$id),*];

            /// What is known of it.
            pub fn row(self) -> &'static Row {
                match self {
                    $(FunctionId::$id => &Row {
                        name: $name,
                        arguments: &[$($argument),*],
                        returns: Returns::$returns,
                        docs: &[$($line),*],
                        serves: Serves::$serves,
                        needs: Needs::$needs,
                        named: $named,
                    },)*
                }
            }
        }
    };
}

// Identifier, name, arguments, what it returns, what it serves, what inertia it needs, whether `generate` names it.
table! {
    Rate "rate" (Coordinates, Velocities) Vector System Nothing true [
        "Rates of the coordinates, ẋ = A(x) ξ (KR18 (5)).",
    ]
    ChartRate "chart_rate" (Coordinates, Velocities) Vector System Nothing false [
        "Rates in the charts of the coordinate kinds: ẋ of plain coordinates, θ̇ of a circle, the body",
        "angular velocity of a quaternion or rotation matrix (KR18 (36)).",
    ]
    Accel "accel" (Coordinates, Velocities, Inputs) Vector System Inverse true [
        "Forward dynamics: ξ̇ from M ξ̇ + Γ ξ ξ + ∂V = f (KR18 (30c)).",
    ]
    InverseDynamics "inverse_dynamics" (Coordinates, Velocities, Accelerations) Vector Callers Inertia true [
        "Inverse dynamics: the generalised force f = M ξ̇ + Γ ξ ξ + ∂V that ξ̇ needs (KR18 (30c)).",
    ]
    MassMatrix "mass_matrix" (Coordinates) Rows Callers Inertia true [
        "Mass matrix M(x) (KR18 (20)), by rows.",
    ]
    Bias "bias" (Coordinates, Velocities) Vector Callers Inertia true [
        "Bias force Γᵢⱼₖ ξʲ ξᵏ (KR18 (30c)): Coriolis, centrifugal and gyroscopic terms.",
    ]
    PotentialForce "potential_force" (Coordinates) Vector Callers Nothing true [
        "Slope of the potential, ∂ᵢV along the columns of A (KR18 (9)); gravity included.",
    ]
    GeneralizedForce "generalized_force" (Coordinates, Velocities, Inputs) Vector Callers Nothing true [
        "Generalised force fᵢ of the applied loads (KR18 (28)).",
    ]
    Momentum "momentum" (Coordinates, Velocities) Vector Callers Inertia true [
        "Generalised momentum p = M ξ = ∂L/∂ξ.",
    ]
    MomentumRate "momentum_rate" (Coordinates, Velocities, Inputs) Vector Callers Inertia true [
        "Rate of the generalised momentum, ṗᵢ = ∂ᵢL − γᵢⱼᵏ ξʲ pₖ + fᵢ with p = M ξ (KR18 (30a)).",
    ]
    VelocityFromMomentum "velocity_from_momentum" (Coordinates, Momenta) Vector Callers Inverse true [
        "Velocity coordinates of a generalised momentum, ξ = M⁻¹ p.",
    ]
    KineticEnergy "kinetic_energy" (Coordinates, Velocities) Number System Inertia true [
        "Kinetic energy T = ½ ξᵀ M ξ (J).",
    ]
    PotentialEnergy "potential_energy" (Coordinates) Number System Nothing true [
        "Potential energy V(x) (J).",
    ]
    Energy "energy" (Coordinates, Velocities) Number Callers Inertia true [
        "Energy T + V (J).",
    ]
    Dissipation "dissipation" (Coordinates, Velocities) Number Callers Nothing true [
        "Rayleigh's dissipation function D(x, ξ) (W), half the power that dampers take: its force is",
        "−∂D/∂ξⁱ, part of the generalised force, and d/dt (T + V) = −2 D + power of all else.",
    ]
    Constraint "constraint" (Coordinates) Vector System Nothing true [
        "Geometric constraint φ(x), zero on the configuration manifold (KR18 (3)).",
    ]
    Correction "correction" (Coordinates) Vector System Nothing false [
        "The stabilising direction −Ψ φ(x) of KR18 (8): ẋ = A ξ − λ Ψ φ makes φ decay like exp(−λ t).",
    ]
    ConstraintForce "constraint_force" (Coordinates, Velocities, Inputs) Vector Callers Inverse true [
        "Multipliers λ of the constraints B(x) ξ = 0, M ξ̇ + Γ ξ ξ + ∂V = f + Bᵀ λ, in their order: the",
        "generalised force that keeps an inactive velocity at zero, a force where B ξ is a speed.",
    ]
    ProjectPosition "project_position" (Coordinates) Vector System Inverse false [
        "The step along A that closes the loops φ(x) = 0 to first order and keeps to every other row of B,",
        "−M⁻¹ Bᵀ S⁻¹ φ with S = B M⁻¹ Bᵀ, where φ of a row that is no loop is 0.",
    ]
    ProjectVelocity "project_velocity" (Coordinates, Velocities) Vector System Inverse false [
        "The velocities with B ξ = 0 that are nearest in kinetic energy, ξ − M⁻¹ Bᵀ S⁻¹ B ξ.",
    ]
    Linearize "linearize" (Coordinates, Velocities, Inputs) Linear Asked Inverse true [
        "The linearisation in displacement coordinates, [A B] with d/dt (h, δξ) = A (h, δξ) + B δu,",
        "where δx = A(x) h: ḣᵏ = δξᵏ − γᵢⱼᵏ ξⁱ hʲ, δξ̇ = ∂ⱼF hʲ + ∂F/∂ξ δξ + ∂F/∂u δu for ξ̇ = F(x, ξ, u).",
    ]
    InverseDynamicsSlopes "inverse_dynamics_slopes" (Coordinates, Velocities, Accelerations) Linear Asked Inertia true [
        "Slopes [∂f/∂h ∂f/∂ξ] of the force f of `inverse_dynamics` by displacements δx = A(x) h and by velocities, by rows;",
        "∂f/∂ξ̇ is the mass matrix.",
    ]
    ParameterSlopes "parameter_slopes" (Coordinates, Velocities, Inputs) Linear Asked Inverse true [
        "Slopes ∂ξ̇/∂p of `accel` at constant x, ξ and u by the parameters, by rows; a column for each number of",
    ]
    Regressor "regressor" (Coordinates, Velocities, Accelerations) Linear Asked Inertia true [
        "Regressor Y(x, ξ, ξ̇), n rows of as many columns as there are base parameters: the force f = Y β that ξ̇ needs,",
        "with that of dampers. Columns are those of these standard parameters, in this order:",
    ]
    BaseParameters "base_parameters" () Vector Asked Inertia true [
        "Base parameters β by the values of the description, in the order of the columns of `regressor`:",
    ]
    CentreOfMass "centre_of_mass" (Coordinates) Vector Asked Inertia true [
        "Centre of mass c (m) of all that moves, world axes.",
    ]
    CentroidalMomentum "centroidal_momentum" (Coordinates, Velocities) Vector Asked Inertia true [
        "Momentum h of all that moves, world axes: linear (kg m/s), then angular about the centre of mass (kg m²/s).",
    ]
    CentroidalMap "centroidal_map" (Coordinates) Linear Asked Inertia true [
        "Centroidal map A_G(x), 6 rows: the momentum about the centre of mass is h = A_G ξ, linear rows first",
        "(Orin and Goswami 2008). Where the time moves bodies, h has a part without ξ in addition.",
    ]
    CentroidalBias "centroidal_bias" (Coordinates, Velocities) Vector Asked Inertia true [
        "Bias Ȧ_G ξ of the momentum about the centre of mass: ḣ = A_G ξ̇ + Ȧ_G ξ, linear rows first.",
    ]
    DisplacementFrame "displacement_frame" (Coordinates) Linear Tangent Nothing false [
        "A(x) without what is there for the time, by rows: displacements h move coordinates by δx = A h (KR18 (5)).",
    ]
    DisplacementCoframe "displacement_coframe" (Coordinates) Linear Tangent Nothing false [
        "Y(x) with Y A = I, by rows: the displacements h = Y δx (KR18 (6)).",
    ]
    Splitting "splitting" () Vector Split Inverse true []
    Centre "centre" (Coordinates) Vector Split Inverse false [
        "Coordinates with plain ones moved to centres of mass, y = r + R s.",
    ]
    Uncentre "uncentre" (Coordinates) Vector Split Inverse false [
        "Coordinates x of those at centres of mass: the inverse of `centre`.",
    ]
    SplitMomenta "split_momenta" (Coordinates, Velocities) Vector Split Inverse false [
        "Momenta of the free motion in the chart: ẏ of plain coordinates at centres of mass, θ̇ of circles,",
        "the angular momentum P = J ω of rotors in body axes. T = ½ ẏᵀ D ẏ + ½ Σ P·J⁻¹P.",
    ]
    SplitVelocities "split_velocities" (Coordinates, Momenta) Vector Split Inverse false [
        "Velocity coordinates ξ of such momenta: the inverse of `split_momenta`.",
    ]
    Kick "kick" (Coordinates, Inputs) Vector Split Inverse false [
        "Rates of these momenta by the forces alone: accelerations of centres of mass and of circles,",
        "torques on rotors in body axes, about the centre of mass or the fixed point.",
    ]
    RotorInertia "rotor_inertia" () Vector Split Inverse false [
        "Inertia J of the rotors: J₁, J₂, J₃ where body axes are principal, else J by rows.",
    ]
}

impl FunctionId {
    /// What is told of the momentum of everything.
    pub const CENTROIDAL: [FunctionId; 4] = [
        FunctionId::CentreOfMass,
        FunctionId::CentroidalMomentum,
        FunctionId::CentroidalMap,
        FunctionId::CentroidalBias,
    ];

    /// Its name in descriptions and in Rust.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The function of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|id| id.name() == name)
    }
}

impl AsRef<str> for FunctionId {
    fn as_ref(&self) -> &str {
        self.name()
    }
}

/// What is generated of a frame's kinematics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameFunction {
    /// [R p].
    Pose,
    /// (v, ω).
    Twist,
    /// J.
    Jacobian,
    /// J̇ ξ.
    BiasAcceleration,
}

impl FrameFunction {
    /// All of them, in the order in which they are emitted.
    pub const ALL: &'static [FrameFunction] = &[
        FrameFunction::Pose,
        FrameFunction::Twist,
        FrameFunction::Jacobian,
        FrameFunction::BiasAcceleration,
    ];
}

/// `jacobian f in world`: a frame whose kinematics is asked for, and whose axes its components are in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Jacobian {
    /// The name of the frame.
    pub frame: String,
    /// Whether components are in the axes of the frame itself, and not in those of the world.
    pub own: bool,
}

impl Jacobian {
    /// The name of a function: `tip_jacobian`, and `tip_body_jacobian` in the frame's own axes.
    pub fn name_of(&self, function: FrameFunction) -> String {
        let what = match function {
            FrameFunction::Pose => return format!("{}_pose", self.frame),
            FrameFunction::Twist => "twist",
            FrameFunction::Jacobian => "jacobian",
            FrameFunction::BiasAcceleration => "bias_acceleration",
        };
        let body = if self.own { "body_" } else { "" };
        format!("{}_{body}{what}", self.frame)
    }

    /// The names of all its functions.
    pub fn names(&self) -> impl Iterator<Item = String> + '_ {
        FrameFunction::ALL.iter().map(|&of| self.name_of(of))
    }

    /// The documentation of a function, line by line.
    pub fn docs_of(&self, function: FrameFunction) -> Vec<String> {
        let frame = &self.frame;
        let (axes, twist) = match self.own {
            true => ("its own axes", "(Rᵀ ṗ, Rᵀ ω)"),
            false => ("world axes", "(ṗ, ω)"),
        };
        match function {
            FrameFunction::Pose => vec![format!(
                "Pose [R p] of the frame `{frame}` in the world: its axes by columns, then its origin (m)."
            )],
            FrameFunction::Twist => vec![format!(
                "Twist {twist} of the frame `{frame}` in {axes}: the velocity of its origin (m/s), its angular velocity (rad/s)."
            )],
            FrameFunction::Jacobian => vec![
                format!("Jacobian J(x) of the frame `{frame}` in {axes}: {twist} = J ξ, linear rows first."),
                "Where the time moves the frame, the twist has a part without ξ in addition to J ξ.".into(),
            ],
            FrameFunction::BiasAcceleration => vec![format!(
                "Bias acceleration J̇ ξ of the frame `{frame}`: d/dt {twist} = J ξ̇ + J̇ ξ, linear rows first."
            )],
        }
    }
}

/// What `generate` asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asked {
    /// Whether everything is asked for that needs not be asked for by its name.
    pub everything: bool,
    /// The most that functions may need that are not asked for by their names.
    pub most: Needs,
    /// Functions that are asked for by name.
    pub functions: Vec<FunctionId>,
    /// Outputs and invariants that are asked for by name.
    pub outputs: Vec<String>,
    /// Outputs whose slopes are asked for.
    pub slopes: Vec<String>,
    /// Frames whose kinematics is asked for.
    pub jacobians: Vec<Jacobian>,
}

/// What the name of the slopes of an output ends with.
pub const SLOPES: &str = "_slopes";

/// What is emitted along with others: values with their slopes, the parameters that a regressor is multiplied by.
const BROUGHT: [(FunctionId, &[FunctionId]); 3] = [
    (FunctionId::BaseParameters, &[FunctionId::Regressor]),
    (
        FunctionId::InverseDynamics,
        &[FunctionId::InverseDynamicsSlopes],
    ),
    (
        FunctionId::CentroidalMomentum,
        &[FunctionId::CentroidalMap, FunctionId::CentroidalBias],
    ),
];

impl Asked {
    /// Everything that needs not be asked for by its name: what a description without `generate` gets.
    pub fn everything() -> Self {
        Asked {
            everything: true,
            most: Needs::Inverse,
            functions: Vec::new(),
            outputs: Vec::new(),
            slopes: Vec::new(),
            jacobians: Vec::new(),
        }
    }

    /// These functions and what they bring along.
    pub fn only(functions: &[FunctionId]) -> Self {
        Asked {
            everything: false,
            functions: functions.to_vec(),
            ..Asked::everything()
        }
    }

    /// Whether a function is asked for by its name.
    pub fn names(&self, id: FunctionId) -> bool {
        self.functions.contains(&id)
    }

    /// Whether a function is wanted: asked for by its name or with everything, or brought along.
    pub fn wants(&self, id: FunctionId) -> bool {
        let row = id.row();
        let named = |ids: &[FunctionId]| ids.iter().any(|&id| self.names(id));
        let mut brought = BROUGHT.iter().filter(|(what, _)| *what == id);
        let along = match row.serves {
            _ if brought.any(|(_, by)| named(by)) => true,
            Serves::System => named(&[
                FunctionId::Accel,
                FunctionId::Linearize,
                FunctionId::ParameterSlopes,
            ]),
            Serves::Split => self.names(FunctionId::Splitting),
            Serves::Tangent => self.names(FunctionId::Linearize),
            Serves::Callers | Serves::Asked => false,
        };
        let whole = self.everything && !matches!(row.serves, Serves::Asked | Serves::Tangent);
        self.names(id) || along || (whole && row.needs <= self.most)
    }

    /// Whether an output or invariant is wanted, the slopes of one, or a function of a frame.
    pub fn wants_output(&self, name: &str) -> bool {
        let frames = || self.jacobians.iter().flat_map(Jacobian::names);
        self.everything
            || self.outputs.iter().any(|output| output == name)
            || self.wants_slopes(name)
            || frames().any(|function| function == name)
    }

    /// Whether the name is that of the slopes of an output that are asked for.
    pub fn wants_slopes(&self, name: &str) -> bool {
        let output = name.strip_suffix(SLOPES);
        output.is_some_and(|output| self.slopes.iter().any(|asked| asked == output))
    }

    /// What the functions that are wanted need of the inertia of the system.
    pub fn needs(&self) -> Needs {
        let wanted = FunctionId::ALL.iter().filter(|&&id| self.wants(id));
        let most = wanted.map(|id| id.row().needs).max();
        most.unwrap_or(Needs::Nothing)
    }

    /// The same but for functions that need this.
    pub fn without(&self, lacking: Needs) -> Self {
        let mut asked = self.clone();
        asked.most = match lacking {
            Needs::Inverse => Needs::Inertia,
            Needs::Inertia | Needs::Nothing => Needs::Nothing,
        };
        asked.functions.retain(|id| id.row().needs <= asked.most);
        asked
    }
}

impl Default for Asked {
    fn default() -> Self {
        Asked::everything()
    }
}
