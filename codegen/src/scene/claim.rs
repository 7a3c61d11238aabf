//! Claims that energy or momentum is constant along the motion.

use super::parts::Frame;
use crate::syntax::ast::{Condition, Conserved, Expr, ExprKind, Ident, ItemKind};
use hamel_language::expression::ident;

/// A claim about energy or momentum, by the name of that unless [`named`](Self::named) gives another one; proved, or
/// refused with what d/dt leaves.
#[derive(Clone, Debug)]
pub struct Claim {
    name: Ident,
    conserved: Conserved,
    when: Vec<Condition>,
}

impl Claim {
    fn new(name: &str, conserved: Conserved) -> Claim {
        Claim {
            name: ident(name),
            conserved,
            when: Vec::new(),
        }
    }

    /// The energy T + V (J).
    pub fn energy() -> Claim {
        Claim::new("energy", Conserved::Energy)
    }

    /// The momentum of everything, world axes (kg m/s).
    pub fn linear_momentum() -> Claim {
        let all = Conserved::LinearMomentum {
            of: None,
            along: None,
        };
        Claim::new("linear_momentum", all)
    }

    /// The angular momentum of everything about the origin of the world, world axes (kg m²/s).
    pub fn angular_momentum() -> Claim {
        let all = Conserved::AngularMomentum {
            of: None,
            about: None,
            along: None,
        };
        Claim::new("angular_momentum", all)
    }

    /// That of the bodies of a frame alone. Energy is that of everything.
    pub fn of(mut self, frame: impl Into<Frame>) -> Claim {
        match &mut self.conserved {
            Conserved::LinearMomentum { of, .. } | Conserved::AngularMomentum { of, .. } => {
                *of = Some(frame.into().ident());
            }
            Conserved::Energy | Conserved::Value(_) => {}
        }
        self
    }

    /// The point of the world that an angular momentum is about (m).
    pub fn about(mut self, point: impl Into<Expr>) -> Claim {
        if let Conserved::AngularMomentum { about, .. } = &mut self.conserved {
            *about = Some(point.into());
        }
        self
    }

    /// The component of a momentum along a direction, world axes.
    pub fn along(mut self, direction: impl Into<Expr>) -> Claim {
        match &mut self.conserved {
            Conserved::LinearMomentum { along, .. } | Conserved::AngularMomentum { along, .. } => {
                *along = Some(direction.into());
            }
            Conserved::Energy | Conserved::Value(_) => {}
        }
        self
    }

    /// The name of the function that watches it.
    pub fn named(mut self, name: &str) -> Claim {
        self.name = ident(name);
        self
    }

    /// Where it holds: an input or a parameter, or an entry of one, with its value.
    pub fn when(mut self, target: impl Into<Expr>, value: impl Into<Expr>) -> Claim {
        let (target, value) = (target.into(), value.into());
        self.when.push(Condition { target, value });
        self
    }

    pub(super) fn item(self) -> ItemKind {
        ItemKind::Invariant {
            name: self.name,
            conserved: self.conserved,
            when: self.when,
        }
    }
}

/// What an expression stands for as a claim: the names of energy and momenta are theirs.
pub(super) fn claimed(value: Expr) -> Conserved {
    let name = match &value.kind {
        ExprKind::Name(name) => name.as_str(),
        _ => "",
    };
    match name {
        "energy" => Conserved::Energy,
        "linear_momentum" => Claim::linear_momentum().conserved,
        "angular_momentum" => Claim::angular_momentum().conserved,
        _ => Conserved::Value(value),
    }
}
