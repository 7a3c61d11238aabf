//! What a description asks for.

use super::Ident;

/// What `generate` lists.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// A function by its name.
    Function(Ident),
    /// `jacobian f in f`: the kinematics of a frame, and the frame in whose axes components are.
    Jacobian {
        /// The frame.
        frame: Ident,
        /// `world` where absent.
        axes: Option<Ident>,
    },
}
