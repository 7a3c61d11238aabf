//! The numbers of a state.

/// Numbers for everything that a model takes.
#[derive(Clone, Debug)]
pub struct State {
    /// Parameters, in order of their symbols.
    pub params: Vec<f64>,
    /// x.
    pub x: Vec<f64>,
    /// ξ, and behind it the states of first order.
    pub xi: Vec<f64>,
    /// u.
    pub u: Vec<f64>,
}
