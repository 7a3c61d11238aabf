//! Entries of a `generate` statement.

use super::Ident;

/// One entry of a `generate` statement.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// A function, by name.
    Function(Ident),
    /// `jacobian f in f`: the kinematics of a frame, and the frame whose axes its components are in.
    Jacobian {
        /// The frame.
        frame: Ident,
        /// Frame whose axes are used, `world` if absent.
        axes: Option<Ident>,
    },
}
