//! The numbers of a state.

/// Values of all quantities that a model takes.
#[derive(Clone, Debug)]
pub struct State {
    /// Parameters, in order of their symbols.
    pub params: Vec<f64>,
    /// x.
    pub x: Vec<f64>,
    /// ξ, followed by the states of first order.
    pub xi: Vec<f64>,
    /// The inputs u.
    pub u: Vec<f64>,
}
