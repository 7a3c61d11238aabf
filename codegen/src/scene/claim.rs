//! Claims that energy or momentum is constant along the motion.

use super::parts::Frame;
use crate::syntax::ast::{Condition, Conserved, Expr, ExprKind, Ident, ItemKind};
use hamel_language::expression::ident;

/// A claim that energy or momentum is constant. Its name is that of the quantity, unless [`named`](Self::named) gives
/// another one. The claim is proved, or refused with an error that shows the remaining time derivative.
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

    /// Claims that the energy T + V (J) is constant.
    pub fn energy() -> Claim {
        Claim::new("energy", Conserved::Energy)
    }

    /// Claims that the total linear momentum is constant, world axes (kg m/s).
    pub fn linear_momentum() -> Claim {
        let all = Conserved::LinearMomentum {
            of: None,
            along: None,
        };
        Claim::new("linear_momentum", all)
    }

    /// Claims that the total angular momentum about the origin of the world is constant, world axes (kg m²/s).
    pub fn angular_momentum() -> Claim {
        let all = Conserved::AngularMomentum {
            of: None,
            about: None,
            along: None,
        };
        Claim::new("angular_momentum", all)
    }

    /// Restricts a momentum to the bodies of a frame. This has no effect on energy, which is always the total.
    pub fn of(mut self, frame: impl Into<Frame>) -> Claim {
        match &mut self.conserved {
            Conserved::LinearMomentum { of, .. } | Conserved::AngularMomentum { of, .. } => {
                *of = Some(frame.into().ident());
            }
            Conserved::Energy | Conserved::Value(_) => {}
        }
        self
    }

    /// Sets the point of the world about which an angular momentum is taken (m).
    pub fn about(mut self, point: impl Into<Expr>) -> Claim {
        if let Conserved::AngularMomentum { about, .. } = &mut self.conserved {
            *about = Some(point.into());
        }
        self
    }

    /// Restricts a momentum to its component along a direction, world axes.
    pub fn along(mut self, direction: impl Into<Expr>) -> Claim {
        match &mut self.conserved {
            Conserved::LinearMomentum { along, .. } | Conserved::AngularMomentum { along, .. } => {
                *along = Some(direction.into());
            }
            Conserved::Energy | Conserved::Value(_) => {}
        }
        self
    }

    /// Sets the name of the generated function that evaluates the quantity.
    pub fn named(mut self, name: &str) -> Claim {
        self.name = ident(name);
        self
    }

    /// Adds a condition under which the claim holds: the value of an input or a parameter, or of an entry of one.
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

/// Converts an expression to a claimed quantity; the names of energy and momenta stand for these.
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
