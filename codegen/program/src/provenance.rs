//! Provenance of expressions: which quantity a node of the graph is an entry of, by which equation, and which statement
//! of the description it belongs to.
//!
//! Lowering and derivation label the nodes of the quantities that they make. Labels change no operation and no order;
//! generated code is grouped by them, so that it can be reviewed against equations and description.

use hamel_algebra::graph::Label;
use hamel_language::diagnostics::Span;
use hamel_language::functions::FunctionId;
use hamel_language::model::{Frame, Model, Particle, entry};
use std::collections::BTreeMap;

/// List of a model whose entries quantities belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum List {
    /// The system as a whole.
    System,
    /// Named expressions.
    Lets,
    /// Frames.
    Frames,
    /// Frames with the bodies on them.
    Bodies,
    /// Particles, numbered.
    Particles,
    /// Loads on frames.
    Loads,
    /// Entries of x.
    Coordinates,
    /// Entries of ξ.
    Velocities,
    /// Constraints on velocities.
    Constraints,
}

impl List {
    const ALL: [List; 9] = [
        List::System,
        List::Lets,
        List::Frames,
        List::Bodies,
        List::Particles,
        List::Loads,
        List::Coordinates,
        List::Velocities,
        List::Constraints,
    ];
}

macro_rules! quantities {
    ($($name:ident $list:ident $text:literal $equation:literal)*) => {
        /// Quantity that an expression is an entry of.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Quantity {
            $(#[doc = concat!($text, " (", $equation, ").")] $name,)*
        }

        impl Quantity {
            const ALL: &'static [Quantity] = &[$(Quantity::$name),*];

            /// Returns the list whose entries have the quantity, its name and its equation.
            const fn row(self) -> (List, &'static str, &'static str) {
                match self {
                    $(Quantity::$name => (List::$list, $text, $equation),)*
                }
            }
        }
    };
}

// Columns: identifier, list, name, equation. KR18 as in NOTATION.md; RBDA: Featherstone, Rigid Body Dynamics Algorithms (2008).
quantities! {
    Let Lets "named expression" "description"
    Rotation Frames "rotation matrix R" "KR18 (31)"
    Position Frames "position r of the origin, world axes" "KR18 (31)"
    RelativePose Frames "pose in its parent frame" "KR18 (31)"
    Load Loads "load" "KR18 (28)"
    WrittenEnergy System "energy as written" "KR18 (20)"
    WrittenPotential System "potential as written" "KR18 (30)"
    CoordinateRate Coordinates "rate, ẋ = A ξ" "KR18 (5)"
    KinematicMap Coordinates "row of A" "KR18 (5)"
    ConstraintRow Constraints "row of B ξ = 0" "KR18 (3)"
    AngularJacobian Bodies "Jacobian of ω, own axes" "KR18 (38)"
    AngularVelocity Bodies "angular velocity ω, own axes" "KR18 (38)"
    BiasAngularAcceleration Bodies "angular acceleration at ξ̇ = 0, own axes" "KR18 (38)"
    LinearJacobian Bodies "Jacobian of the velocity of the reference point" "KR18 (36)"
    LinearVelocity Bodies "velocity of the reference point" "KR18 (36)"
    BiasAcceleration Bodies "acceleration of the reference point at ξ̇ = 0" "KR18 (36)"
    InertialForce Bodies "inertial force at ξ̇ = 0" "KR18 (30c)"
    InertialTorque Bodies "inertial torque at ξ̇ = 0" "KR18 (30c)"
    Weight Bodies "weight" "KR18 (30c)"
    ParticleJacobian Particles "Jacobian of the velocity, world axes" "KR18 (20)"
    ParticleVelocity Particles "velocity, world axes" "KR18 (20)"
    ParticleAcceleration Particles "acceleration at ξ̇ = 0, world axes" "KR18 (30c)"
    ParticleForce Particles "inertial force at ξ̇ = 0, world axes" "KR18 (30c)"
    ParticleWeight Particles "weight" "KR18 (30c)"
    MassMatrix Velocities "row of the mass matrix M" "KR18 (20)"
    BiasForce Velocities "bias force Γ ξ ξ" "KR18 (30c)"
    PotentialSlope Velocities "slope ∂V of the potential" "KR18 (9)"
    AppliedForce Velocities "applied force f" "KR18 (28)"
    Momentum Velocities "momentum p = M ξ" "KR18 (20)"
    InverseDynamics Velocities "force M ξ̇ + Γ ξ ξ + ∂V" "KR18 (30c)"
    Pivot Velocities "pivot of M = L D Lᵀ" "KR18 (30c)"
    Acceleration Velocities "acceleration ξ̇" "KR18 (30c)"
    KinematicPivot System "pivot of [Y; Φ]" "KR18 (5)"
    Multiplier System "multipliers λ" "M ξ̇ + Γ ξ ξ + ∂V = f + Bᵀ λ"
    LinkRotation Frames "rotation of the link in its parent" "KR18 (31)"
    LinkAngularVelocity Frames "angular velocity ω of the link, link axes" "KR18 (38)"
    LinkAngularAcceleration Frames "angular acceleration α of the link, link axes" "RBDA 5.3"
    LinkBiasAngularAcceleration Frames "angular acceleration α of the link at ξ̇ = 0" "RBDA 5.3"
    LinkTensor Frames "U = α̂ + ω̂ ω̂ of the link" "RBDA 5.3"
    LinkAcceleration Frames "acceleration of the link's origin, less gravity" "RBDA 5.3"
    LinkBiasAcceleration Frames "acceleration of the link's origin at ξ̇ = 0, less gravity" "RBDA 5.3"
    LinkWrench Frames "wrench that the motion of the link takes" "RBDA 5.3"
    LinkBiasWrench Frames "wrench that the motion of the link takes at ξ̇ = 0" "RBDA 5.3"
    JointWrench Frames "wrench through the joint of the link" "RBDA 5.3"
    CompositeInertia Frames "inertia of the link with all that it carries" "RBDA 6.2"
    UnitWrench Frames "wrench of unit joint acceleration on all that the link carries" "RBDA 6.2"
    ArticulatedInertia Frames "articulated inertia of the link" "RBDA 7.2"
    ArticulatedWrench Frames "articulated bias wrench of the link" "RBDA 7.3"
    JointResidual Frames "joint force less bias" "RBDA 7.3"
    JointShare Frames "articulated inertia along the joint over the pivot" "RBDA 7.3"
    JointAcceleration Frames "acceleration of the link due to ξ̇" "RBDA 7.3"
    RelativeMomentum Frames "momentum relative to the link of all that it carries" "Carpentier and Mansard (2018)"
    LinkVariation Frames "change of the link's motion with its joint" "Carpentier and Mansard (2018)"
    JointForceVariation Frames "joint force by changes of the link's motion" "Carpentier and Mansard (2018)"
    WrenchVariation Frames "change of the wrench through the joint" "Carpentier and Mansard (2018)"
    DisplacementDerivative System "derivatives of the rates ḣ" "ḣ = δξ − γ ξ h"
    ForceDerivative Velocities "derivatives of the force less M ξ̇" "δ(M ξ̇ + Γ ξ ξ + ∂V − f)"
    AccelerationDerivative Velocities "derivatives of ξ̇" "δξ̇ = ∂F h + ∂F/∂ξ δξ + ∂F/∂u δu"
}

impl Quantity {
    /// Returns the label of the quantity of an entry of its list; `None` beyond 16 million entries.
    pub fn of(self, entry: usize) -> Option<Label> {
        Label::new(self as u8, entry)
    }
}

/// What an expression is, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Origin {
    /// The quantity, such as `forearm: angular velocity ω, own axes`.
    pub quantity: String,
    /// Equation that defines it, in the notation of NOTATION.md.
    pub equation: &'static str,
    /// Statement of the description that it belongs to.
    pub span: Span,
}

/// Names and places of all that quantities of a model belong to.
#[derive(Clone, Debug, Default)]
pub struct Provenance {
    /// For each list its entries, by name and place.
    lists: Vec<Vec<(String, Span)>>,
    /// Places of the outputs and invariants, by name.
    outputs: BTreeMap<String, Span>,
}

impl Provenance {
    /// Collects the names and places of a model's entries.
    pub fn of(model: &Model) -> Self {
        let statements = &model.statements;
        let place =
            |map: &BTreeMap<String, Span>, name: &str| map.get(name).copied().unwrap_or(model.span);
        let written = |name: &str| model.origins.written(name).unwrap_or(name).to_owned();
        let frames = |map: &BTreeMap<String, Span>| -> Vec<(String, Span)> {
            let frames = model.frames.iter();
            let of = |frame: &Frame| {
                let span = map.get(&frame.name).copied();
                let span = span.unwrap_or_else(|| place(&statements.names, &frame.name));
                (written(&frame.name), span)
            };
            frames.map(of).collect()
        };
        let entries = |list: List| -> Vec<(String, Span)> {
            match list {
                List::System => vec![(model.name.clone(), model.span)],
                List::Lets => {
                    let names = model.lets.iter().map(|(name, _)| name);
                    let of = |name: &String| (written(name), place(&statements.names, name));
                    names.map(of).collect()
                }
                List::Frames => frames(&statements.names),
                List::Bodies => frames(&statements.bodies),
                List::Particles => {
                    let particles = model.particles.iter().enumerate();
                    let of = |(index, particle): (usize, &Particle)| {
                        (format!("particle {}", index + 1), particle.span)
                    };
                    particles.map(of).collect()
                }
                List::Loads => {
                    let all = frames(&statements.loads);
                    let wrenches = model.wrenches.iter();
                    wrenches.map(|wrench| all[wrench.frame].clone()).collect()
                }
                List::Coordinates => {
                    let coordinate = |index: usize| {
                        let mut all = model.coordinates.iter().rev();
                        all.find(|coordinate| coordinate.offset <= index)
                    };
                    let all = (0..model.nu()).filter_map(coordinate);
                    all.map(|one| (written(&one.name), one.span)).collect()
                }
                List::Velocities => {
                    let spans = model.velocity_spans.iter();
                    let of = |(index, &span): (usize, &Span)| {
                        (written(&entry(&model.velocities, index)), span)
                    };
                    spans.enumerate().map(of).collect()
                }
                List::Constraints => {
                    let all = model.constraints.iter();
                    all.map(|one| (format!("`{}`", one.label()), one.span))
                        .collect()
                }
            }
        };
        let invariants = model.invariants.iter();
        let invariants = invariants.map(|claim| (claim.name.clone(), claim.span));
        let outputs = model.outputs.iter();
        let outputs = outputs.map(|(name, _)| (name.clone(), place(&statements.names, name)));
        let source = |span: &mut Span| *span = model.origins.source(*span);
        let mut provenance = Provenance {
            lists: List::ALL.map(entries).into(),
            outputs: outputs.chain(invariants).collect(),
        };
        let lists = provenance.lists.iter_mut().flatten();
        lists.for_each(|(_, span)| source(span));
        provenance.outputs.values_mut().for_each(source);
        provenance
    }

    /// Returns what a label stands for.
    pub fn origin(&self, label: Label) -> Option<Origin> {
        let quantity = Quantity::ALL.get(label.kind())?;
        let (list, text, equation) = quantity.row();
        let mut origin = self.entry(list, label.entry(), text, equation)?;
        if list == List::Lets {
            origin.quantity = format!("`{}`", self.name(list, label.entry())?);
        }
        Some(origin)
    }

    /// Returns what a row of the result of a function is; `name` is that of an output or invariant of the description.
    pub fn result(&self, id: Option<FunctionId>, name: &str, row: usize) -> Origin {
        let described = || Origin {
            quantity: format!("`{name}`"),
            equation: "description",
            span: self
                .outputs
                .get(name)
                .copied()
                .unwrap_or_else(|| self.system()),
        };
        let of_row = |id: FunctionId| {
            let (list, text, equation) = result(id);
            let named = self.entry(list, row, text, equation);
            named.or_else(|| self.entry(List::System, 0, text, equation))
        };
        id.and_then(of_row).unwrap_or_else(described)
    }

    fn entry(
        &self,
        list: List,
        index: usize,
        text: &str,
        equation: &'static str,
    ) -> Option<Origin> {
        let (name, span) = self.lists.get(list as usize)?.get(index)?;
        let quantity = match list {
            List::System => text.to_owned(),
            _ => format!("{name}: {text}"),
        };
        Some(Origin {
            quantity,
            equation,
            span: *span,
        })
    }

    fn name(&self, list: List, index: usize) -> Option<&str> {
        let (name, _) = self.lists.get(list as usize)?.get(index)?;
        Some(name)
    }

    /// Returns the place of the name of the system.
    pub fn system(&self) -> Span {
        let system = self.lists.first().and_then(|list| list.first());
        system.map_or(Span::NOWHERE, |(_, span)| *span)
    }
}

/// Returns the list to which the rows of a function's result belong, the quantity, and its equation.
fn result(id: FunctionId) -> (List, &'static str, &'static str) {
    use List::{Coordinates, System, Velocities};
    match id {
        FunctionId::Rate => Quantity::CoordinateRate.row(),
        FunctionId::ChartRate => (System, "rates in the charts", "KR18 (36)"),
        FunctionId::Accel => Quantity::Acceleration.row(),
        FunctionId::InverseDynamics => Quantity::InverseDynamics.row(),
        FunctionId::MassMatrix => Quantity::MassMatrix.row(),
        FunctionId::Bias => Quantity::BiasForce.row(),
        FunctionId::PotentialForce => Quantity::PotentialSlope.row(),
        FunctionId::GeneralizedForce => Quantity::AppliedForce.row(),
        FunctionId::Momentum | FunctionId::VelocityFromMomentum => Quantity::Momentum.row(),
        FunctionId::MomentumRate => (Velocities, "rate of the momentum, ṗ", "KR18 (30a)"),
        FunctionId::KineticEnergy => (System, "kinetic energy T", "KR18 (20)"),
        FunctionId::PotentialEnergy => (System, "potential energy V", "KR18 (30)"),
        FunctionId::Energy => (System, "energy T + V", "KR18 (20), (30)"),
        FunctionId::Dissipation => (System, "dissipation function D", "d/dt (T + V) = −2 D"),
        FunctionId::Constraint => (System, "constraint φ(x)", "KR18 (3)"),
        FunctionId::Correction => (Coordinates, "stabilising direction −Ψ φ", "KR18 (8)"),
        FunctionId::ConstraintForce => Quantity::Multiplier.row(),
        FunctionId::ProjectPosition => (Velocities, "step that closes loops", "−M⁻¹ Bᵀ S⁻¹ φ"),
        FunctionId::ProjectVelocity => (Velocities, "nearest velocity", "ξ − M⁻¹ Bᵀ S⁻¹ B ξ"),
        FunctionId::Linearize => (
            System,
            "linearisation [A B]",
            "ḣ = δξ − γ ξ h, δξ̇ = ∂F h + ∂F/∂ξ δξ + ∂F/∂u δu",
        ),
        FunctionId::InverseDynamicsSlopes => (Velocities, "slopes of the force", "[∂f/∂h ∂f/∂ξ]"),
        FunctionId::ParameterSlopes => (Velocities, "slopes by the parameters", "∂ξ̇/∂p"),
        FunctionId::Regressor => (Velocities, "row of the regressor Y", "f = Y β"),
        FunctionId::BaseParameters => (System, "base parameters β", "f = Y β"),
        FunctionId::CentreOfMass => (System, "centre of mass c", "c = Σ m r / Σ m"),
        FunctionId::CentroidalMomentum => (System, "centroidal momentum", "h = A_G ξ"),
        FunctionId::CentroidalMap => (System, "centroidal map A_G", "h = A_G ξ"),
        FunctionId::CentroidalBias => (System, "centroidal bias", "ḣ = A_G ξ̇ + Ȧ_G ξ"),
        FunctionId::DisplacementFrame => (Coordinates, "row of A", "KR18 (5)"),
        FunctionId::DisplacementCoframe => (Velocities, "row of Y", "KR18 (6)"),
        FunctionId::Splitting => (System, "splitting", "T(p) + V(x)"),
        FunctionId::Centre => (System, "centred coordinates", "y = r + R s"),
        FunctionId::Uncentre => (System, "coordinates", "r = y − R s"),
        FunctionId::SplitMomenta => (System, "momenta of the free motion", "P = J ω"),
        FunctionId::SplitVelocities => (System, "velocities of the free motion", "ω = J⁻¹ P"),
        FunctionId::Kick => (System, "rates of the momenta by forces", "D⁻¹ f"),
        FunctionId::RotorInertia => (System, "inertia J of rotors", "P = J ω"),
    }
}

/// Labels the expressions of the description: named expressions, poses of frames, loads, rates and constraints.
pub fn label_quantities(model: &mut Model) {
    let graph = &mut model.graph;
    for (index, (_, value)) in model.lets.iter().enumerate() {
        graph.label(&value.entries(), Quantity::Let.of(index));
    }
    for (index, frame) in model.frames.iter().enumerate() {
        let (turn, shift) = &frame.relative;
        graph.label(&frame.rotation.concat(), Quantity::Rotation.of(index));
        graph.label(&frame.position, Quantity::Position.of(index));
        graph.label(&turn.concat(), Quantity::RelativePose.of(index));
        graph.label(shift, Quantity::RelativePose.of(index));
    }
    for (index, wrench) in model.wrenches.iter().enumerate() {
        let both = [wrench.force, wrench.torque, wrench.at].concat();
        graph.label(&both, Quantity::Load.of(index));
    }
    for (index, (&rate, row)) in model.rate.iter().zip(&model.a).enumerate() {
        graph.label(&[rate], Quantity::CoordinateRate.of(index));
        graph.label(row, Quantity::KinematicMap.of(index));
    }
    for (index, constraint) in model.constraints.iter().enumerate() {
        graph.label(&constraint.row, Quantity::ConstraintRow.of(index));
    }
    graph.label(&[model.kinetic], Quantity::WrittenEnergy.of(0));
    graph.label(&[model.potential], Quantity::WrittenPotential.of(0));
}
